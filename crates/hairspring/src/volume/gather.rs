//! Interpolates the grid at the points: one acceleration for each point, constant for the interval.

use super::{
    field::{BRAKE, PUSH, VALUES_PER_PUSH},
    grid_bounds::{GridBounds, GridTransform, Placed},
    splat::Tiles,
};
use crate::{
    simd::lanes::{LANES, Row},
    strand::tile::state,
};

/// Number of tiles that one task processes.
const TILES_PER_TASK: usize = 32;

/// Accelerations of the points in the last interval, and the sum of all external accelerations; shape
/// `[points]` of some tiles [m/s²].
type Points<'a> = (&'a mut [[Row; 3]], &'a mut [[Row; 3]]);

/// Replaces the last interval's acceleration of every point by the new one, also in the sum, in parallel. It
/// is 0 outside the grid bounds.
pub fn all(
    tiles: &Tiles,
    transform: &GridTransform,
    bounds: &GridBounds,
    field: &[[f32; PUSH]],
    (taken, push): Points<'_>,
) {
    let count = tiles.count();
    if count <= TILES_PER_TASK {
        return gather(tiles, transform, bounds, field, (taken, push));
    }
    let (a, b) = (tiles.part(0, 2), tiles.part(1, 2));
    let at = (b.firsts[0] - a.firsts[0]) as usize;
    let ((low, high), (low_push, high_push)) = (taken.split_at_mut(at), push.split_at_mut(at));
    crate::parallel::join(
        || all(&a, transform, bounds, field, (low, low_push)),
        || all(&b, transform, bounds, field, (high, high_push)),
    );
}

/// [`all`] on one thread.
#[expect(clippy::needless_range_loop, reason = "a lane is one point, in several rows")]
fn gather(
    tiles: &Tiles,
    transform: &GridTransform,
    bounds: &GridBounds,
    field: &[[f32; PUSH]],
    (acceleration, push): Points<'_>,
) {
    let [_, _, row, _, slab, _, both, _] = bounds.corners();
    let mut points = acceleration.iter_mut().zip(push);
    for (roots, state, _) in tiles.iter() {
        let mut places = transform.roots(roots, bounds.lo);
        for (at, (acceleration, push)) in state.iter().zip(&mut points) {
            transform.advance(&mut places, at);
            let placed = Placed::new(&places, bounds);
            let mut taken = [[0.0; LANES]; VALUES_PER_PUSH];
            for lane in 0..LANES {
                let cell = placed.cell[lane] as usize;
                let mut sum = [0.0; PUSH];
                for (k, corner) in [0, row, slab, both].into_iter().enumerate() {
                    let [a, b] = [placed.weights[2 * k][lane], placed.weights[2 * k + 1][lane]];
                    let Some([low, high]) = field[cell + corner..].first_chunk::<2>() else { continue };
                    for c in 0..PUSH {
                        sum[c] += low[c] * a + high[c] * b;
                    }
                }
                (0..VALUES_PER_PUSH).for_each(|c| taken[c][lane] = sum[c]);
            }
            let (mut sound, mut now) = (placed.inside, [Row::default(); 3]);
            let [Row(vx), Row(vy), Row(vz)] = &at[state::V..].first_chunk::<3>().expect("three rows");
            for k in 0..3 {
                let [x, y, z] = BRAKE[k];
                for lane in 0..LANES {
                    let braked =
                        taken[x][lane] * vx[lane] + taken[y][lane] * vy[lane] + taken[z][lane] * vz[lane];
                    let a = taken[k][lane] - braked;
                    // 0 for finite numbers, else NaN.
                    sound[lane] = if a * 0.0 == 0.0 { sound[lane] } else { 0.0 };
                    now[k].0[lane] = a;
                }
            }
            for ((row, acceleration), push) in now.iter().zip(acceleration).zip(push) {
                for lane in 0..LANES {
                    let a = if sound[lane] > 0.0 { row.0[lane] } else { 0.0 };
                    push.0[lane] += a - acceleration.0[lane];
                    acceleration.0[lane] = a;
                }
            }
        }
    }
}
