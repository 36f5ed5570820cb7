//! Splats strands into the density grid, eight segments at a time.

use super::density::Grid;
use crate::{frame::HairDraw, hair::shade::LANES};
use fearless_simd::{f32x8, i32x8, prelude::*, u32x8};
use glam::Vec3;

/// Fixed-point units per optical depth.
pub(crate) const UNIT: f32 = 65536.0;
/// Maximum distance between two samples of a segment [voxels]. The blur that follows spreads each over two
/// voxels.
pub(crate) const SPACING: f32 = 1.5;
/// Maximum length of a segment [voxels]; longer ones belong to a broken strand and are ignored.
pub(crate) const LONGEST: f32 = 64.0;

/// Adds strands to `sum` at evenly spaced samples, in units of 1 / [`UNIT`]. Must be called inside a
/// `dispatch!`.
#[inline(always)]
pub(super) fn splat<S: Simd>(
    simd: S,
    grid: &Grid,
    hair: &HairDraw,
    strands: impl Iterator<Item = usize>,
    sum: &mut [u32],
) {
    // Length [voxels] times the sum of two radii times this factor is the covered fraction of a voxel's face.
    let scale = hair.width_scale * hair.look.shadow * UNIT / grid.voxel;
    for s in strands {
        let range = hair.range(s);
        let (points, radii) = (&hair.points[range.clone()], &hair.radii[range]);
        for first in (0..points.len().saturating_sub(1)).step_by(LANES) {
            segments(simd, grid, &points[first..], &radii[first..], scale, sum);
        }
    }
}

/// Adds the first eight segments, or as many as there are.
#[inline(always)]
fn segments<S: Simd>(simd: S, grid: &Grid, points: &[Vec3], radii: &[f32], scale: f32, sum: &mut [u32]) {
    // Lanes past the strand's end repeat its last point, so their length is zero.
    let last = points.len() - 1;
    let (mut p, mut radius) = ([[0.0; LANES + 1]; 3], [0.0; LANES + 1]);
    for lane in 0..=LANES {
        let i = lane.min(last);
        let [x, y, z] = points[i].to_array();
        (p[0][lane], p[1][lane], p[2][lane]) = (x, y, z);
        radius[lane] = radii[i];
    }
    // In voxels from the grid's corner; a coordinate in 0..1 is inside the first voxel.
    let per_voxel = 1.0 / grid.voxel;
    let corner = (grid.origin * per_voxel - Vec3::splat(0.5)).to_array();
    let mut from = [f32x8::splat(simd, 0.0); 3];
    let mut step = from;
    for axis in 0..3 {
        let [a, b] = pair(simd, &p[axis]);
        from[axis] = a * per_voxel - corner[axis];
        step[axis] = (b - a) * per_voxel;
    }
    let length = (step[0] * step[0] + step[1] * step[1] + step[2] * step[2]).sqrt();
    let [r0, r1] = pair(simd, &radius);
    let amount = length * (r0 + r1) * scale;
    let zero = f32x8::splat(simd, 0.0);
    // Comparisons with NaN are false.
    let counted = amount.simd_gt(0.0) & length.simd_lt(LONGEST);
    let places = counted.select((length * (1.0 / SPACING)).ceil().max(1.0), zero);
    let share = f32x8::splat(simd, 1.0) / places.max(1.0);
    let each = (amount * share).min(UNIT);
    let step = [step[0] * share, step[1] * share, step[2] * share];
    let [nx, ny, nz] = grid.size;
    let most = places.reduce_max() as usize;
    for k in 0..most {
        let k = k as f32 + 0.5;
        let [x, y, z] = [from[0] + step[0] * k, from[1] + step[1] * k, from[2] + step[2] * k];
        let inside = (x.simd_ge(0.0) & y.simd_ge(0.0) & z.simd_ge(0.0))
            & (x.simd_lt(nx as f32) & y.simd_lt(ny as f32) & z.simd_lt(nz as f32));
        let here = inside & places.simd_gt(k);
        let (x, y, z) = (here.select(x, zero), here.select(y, zero), here.select(z, zero));
        let row = z.to_int::<i32x8<S>>() * ny as i32 + y.to_int::<i32x8<S>>();
        let at = row * nx as i32 + x.to_int::<i32x8<S>>();
        let amounts = here.select(each, zero).to_int::<u32x8<S>>();
        let (mut voxel, mut amount) = ([0; LANES], [0; LANES]);
        at.store_slice(&mut voxel);
        amounts.store_slice(&mut amount);
        for (at, amount) in voxel.into_iter().zip(amount) {
            let to = &mut sum[at as usize];
            *to = to.saturating_add(amount);
        }
    }
}

/// Both ends of eight consecutive segments.
#[inline(always)]
fn pair<S: Simd>(simd: S, row: &[f32; LANES + 1]) -> [f32x8<S>; 2] {
    [f32x8::from_slice(simd, &row[..LANES]), f32x8::from_slice(simd, &row[1..])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::{Level, dispatch};
    use hairspring_scene::HairLook;

    /// The voxels that a strand passes contain its length times its width, wherever it ends and whatever part
    /// of it is broken.
    #[test]
    fn voxels_sum_to_the_covered_area_of_a_strand() {
        let (grid, look) =
            (Grid { origin: Vec3::splat(-0.1), voxel: 0.01, size: [21, 21, 21] }, HairLook::default());
        for n in [2, 5, 9, 10, 30] {
            for broken in [false, true] {
                let at = |i: usize| Vec3::new(0.004 * i as f32 - 0.06, 0.03, 0.001 * i as f32);
                let mut points: Vec<Vec3> = (0..n).map(at).collect();
                // One misplaced point removes two segments.
                let lost = if broken && n > 4 { 2 } else { 0 };
                if lost > 0 {
                    points[2].x = f32::NAN;
                }
                let (offsets, radii) = ([0, n as u32], vec![5e-5; n]);
                let hair = HairDraw {
                    points: &points,
                    offsets: &offsets,
                    radii: &radii,
                    colors: &[],
                    look: &look,
                    width_scale: 1.0,
                    follow: None,
                };
                let mut sum = vec![0; grid.len()];
                let level = Level::new();
                dispatch!(level, simd => splat(simd, &grid, &hair, 0..1, &mut sum));
                let found = sum.iter().map(|s| *s as f32).sum::<f32>() / UNIT;
                let want = (n - 1 - lost) as f32 * at(0).distance(at(1)) * 1e-4 / (0.01 * 0.01);
                assert!((found / want - 1.0).abs() < 1e-2, "{n} points: {found} in place of {want}");
                let middle = (at(0) - grid.origin) / grid.voxel + Vec3::splat(0.5);
                assert!(sum[(middle.z as usize * 21 + middle.y as usize) * 21 + middle.x as usize] > 0);
            }
        }
    }
}
