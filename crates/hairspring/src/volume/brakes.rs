//! Values that points interpolate from each node: the acceleration by pressure, and the drag by friction and
//! crossing hair.

use super::{
    crossing::Crossing,
    field::{BRAKE, Field, PUSH},
};
use crate::parallel::prelude::*;
use crate::settings;
use glam::Vec3;

/// Returns β of full cells for intervals of `dt` [s] [1/s].
pub fn friction(settings: &settings::Volume, dt: f32) -> f32 {
    -(-settings.friction * dt).exp_m1() / dt
}

/// Writes the values that points interpolate from each node: `acceleration`, given a node's index and mass,
/// and the drag by friction and crossing hair.
pub fn fill_push(
    field: &mut Field,
    (friction, crossing): (f32, Crossing),
    acceleration: impl Fn(usize, f32) -> Vec3 + Sync,
) {
    let (bounds, nodes, spread, fill) = (field.bounds, &field.nodes, &field.spread, &field.fill);
    let (slab, corners) = (bounds.slab(), bounds.corners());
    field.push.par_chunks_mut(slab).enumerate().for_each(|(z, push)| {
        for (k, push) in push.iter_mut().enumerate() {
            let n = z * slab + k;
            let [x, y, z, mass] = nodes[n];
            *push = [0.0; PUSH];
            if mass > 0.0 {
                // Friction is proportional to the fill, up to 1: a single strand has none.
                let full: f32 = corners.iter().map(|corner| fill[n - corner]).sum();
                let [tx, ty, tz, differ] = spread[n];
                let met = crossing.rate(mass, differ);
                let beta = friction * (0.125 * full).min(1.0) + met;
                // There is no drag by crossing along the direction of the strands.
                let (t, v) = (Vec3::new(tx, ty, tz), Vec3::new(x, y, z));
                let brake = [0, 1, 2].map(|k| Vec3::AXES[k] * beta - t * (met * t[k]));
                let a = acceleration(n, mass) + Vec3::from(brake.map(|row| row.dot(v)));
                push[..3].copy_from_slice(&a.to_array());
                for (row, at) in brake.iter().zip(BRAKE) {
                    (0..3).for_each(|k| push[at[k]] = row[k]);
                }
            }
        }
    });
}
