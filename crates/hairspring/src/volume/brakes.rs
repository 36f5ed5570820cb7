//! What points take from each node: what pressure does, and what brakes them against the hair around, friction and crossing.

use super::{
    crossing::Crossing,
    field::{BRAKE, Field, PUSH},
};
use crate::settings;
use glam::Vec3;
use rayon::prelude::*;

/// β of full cells for intervals of `dt` [s] [1/s].
pub fn friction(settings: &settings::Volume, dt: f32) -> f32 {
    -(-settings.friction * dt).exp_m1() / dt
}

/// Writes what points take from each node: `acceleration` by index and mass, and what brakes them: friction and crossing.
pub fn fill_push(
    field: &mut Field,
    (friction, crossing): (f32, Crossing),
    acceleration: impl Fn(usize, f32) -> Vec3 + Sync,
) {
    let (window, nodes, spread, fill) = (field.window, &field.nodes, &field.spread, &field.fill);
    let (slab, corners) = (window.slab(), window.corners());
    field.push.par_chunks_mut(slab).enumerate().for_each(|(z, push)| {
        for (k, push) in push.iter_mut().enumerate() {
            let n = z * slab + k;
            let [x, y, z, mass] = nodes[n];
            *push = [0.0; PUSH];
            if mass > 0.0 {
                // Hair rubs as far as there is hair: a lone strand meets none.
                let full: f32 = corners.iter().map(|corner| fill[n - corner]).sum();
                let [tx, ty, tz, differ] = spread[n];
                let met = crossing.rate(mass, differ);
                let beta = friction * (0.125 * full).min(1.0) + met;
                // Along the strands nothing is met.
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
