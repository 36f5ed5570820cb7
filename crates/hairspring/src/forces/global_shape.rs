//! Global shape: a weak spring from every point to its position in the rest shape, which moves rigidly with
//! the root.
//!
//! ```text
//! a = ω² (T − x) + 2ζω (Ṫ − v)        ω = 2πf c(s),   c the profile, linear in the index between its values
//! ```
//!
//! This is the global shape of *Augmented Mass-Spring* (AMS 2025), also found in game engines. It is not
//! physical: it holds a style that the fiber alone would not.

use super::StrandView;
use crate::material::{GlobalShape, profile_at};
use glam::Vec3;

/// Applies the springs to a strand with the authored points `authored` [m]. The frequency is multiplied by
/// `scale`.
pub(crate) fn apply(shape: &GlobalShape, scale: f32, authored: &[Vec3], strand: &mut StrandView) {
    let [start, end] = strand.roots();
    let way = end.translation - start.translation;
    let inv_dt = 1.0 / strand.frame.dt;
    let last = (authored.len() - 1) as f64;
    for (i, p) in authored.iter().enumerate().skip(2) {
        let curve = profile_at(&shape.profile, i as f64 / last) as f32;
        let omega = std::f32::consts::TAU * shape.pull * scale * curve;
        let [from, to] = [start, end].map(|root| root.rotation * (*p - authored[0]));
        strand.add_position_spring(i, [from, to], omega * omega);
        strand.add_velocity_drag(i, (way + (to - from)) * inv_dt, 2.0 * shape.damping * omega);
    }
}
