//! Lattice to points: one acceleration a point, frozen for the interval.

use super::{
    splat::Tiles,
    window::{Chart, Placed, Window},
};
use crate::strand::{
    lanes::{LANES, Row},
    tile::state,
};

/// Tiles that one task runs.
const TILES_PER_TASK: usize = 32;

/// Writes the acceleration of every point [m/s²], shape `[points]` of these tiles, on all threads; 0 outside of the window.
pub fn all(tiles: &Tiles, chart: &Chart, window: &Window, field: &[[f32; 4]], push: &mut [[Row; 3]]) {
    let count = tiles.count();
    if count <= TILES_PER_TASK {
        return gather(tiles, chart, window, field, push);
    }
    let (a, b) = (tiles.part(0, 2), tiles.part(1, 2));
    let (low, high) = push.split_at_mut((b.firsts[0] - a.firsts[0]) as usize);
    rayon::join(|| all(&a, chart, window, field, low), || all(&b, chart, window, field, high));
}

/// The same on one thread.
#[expect(clippy::needless_range_loop, reason = "a lane is one point, in several rows")]
fn gather(tiles: &Tiles, chart: &Chart, window: &Window, field: &[[f32; 4]], push: &mut [[Row; 3]]) {
    let [_, _, row, _, slab, _, both, _] = window.corners();
    let mut push = push.iter_mut();
    for (strand, state, _) in tiles.iter() {
        let mut places = chart.roots(strand, window.lo);
        for (at, push) in state.iter().zip(&mut push) {
            chart.walk(&mut places, at);
            let placed = Placed::new(&places, window);
            let mut taken = [[0.0; LANES]; 4];
            for lane in 0..LANES {
                let cell = placed.cell[lane] as usize;
                let mut sum = [0.0; 4];
                for (k, corner) in [0, row, slab, both].into_iter().enumerate() {
                    let [a, b] = [placed.weights[2 * k][lane], placed.weights[2 * k + 1][lane]];
                    let Some([low, high]) = field[cell + corner..].first_chunk::<2>() else { continue };
                    for c in 0..4 {
                        sum[c] += low[c] * a + high[c] * b;
                    }
                }
                (0..4).for_each(|c| taken[c][lane] = sum[c]);
            }
            let mut sound = placed.inside;
            for k in 0..3 {
                let Row(v) = &at[state::V + k];
                for lane in 0..LANES {
                    let a = taken[k][lane] - taken[3][lane] * v[lane];
                    // 0 for finite numbers, else NaN.
                    sound[lane] = if a * 0.0 == 0.0 { sound[lane] } else { 0.0 };
                    push[k].0[lane] = a;
                }
            }
            for row in push {
                for lane in 0..LANES {
                    row.0[lane] = if sound[lane] > 0.0 { row.0[lane] } else { 0.0 };
                }
            }
        }
    }
}
