//! Keeps follow hairs out of the colliders: each point inside is moved to the surface, eight points at a
//! time.

use crate::{
    collide::{ColliderPose, contact},
    simd::lanes::{LANES, Row, Simd, V3, load},
};
use glam::Vec3;

/// Moves the points of one strand that are deeper inside a collider than their `clearance` (0 or less) [m] to
/// that depth. The root, the first point, is not moved.
#[inline(always)]
pub(super) fn keep_out<S: Simd>(simd: S, colliders: &[ColliderPose], points: &mut [Vec3], clearance: &[f32]) {
    let (Some((_, points)), Some((_, clearance))) = (points.split_first_mut(), clearance.split_first())
    else {
        return;
    };
    for (points, clearance) in points.chunks_mut(LANES).zip(clearance.chunks(LANES)) {
        // Lanes past the end repeat the last point.
        let mut rows = [Row::default(); 4];
        for lane in 0..LANES {
            let k = lane.min(points.len() - 1);
            let p = points[k];
            for (row, v) in rows.iter_mut().zip([p.x, p.y, p.z, clearance[k]]) {
                row.0[lane] = v;
            }
        }
        let mut p = V3::load(simd, &rows[..3]);
        let allowed = load(simd, &rows[3]);
        let mut moved = false;
        for pose in colliders {
            if !pose.broadphase_test(simd, p).any_true() {
                continue;
            }
            let (distance, normal) = contact(simd, pose, p);
            let out = (allowed - distance).max(0.0);
            if out.simd_gt(0.0).any_true() {
                p += normal * out;
                moved = true;
            }
        }
        if moved {
            p.store(&mut rows[..3]);
            for (lane, p) in points.iter_mut().enumerate() {
                *p = Vec3::new(rows[0].0[lane], rows[1].0[lane], rows[2].0[lane]);
            }
        }
    }
}
