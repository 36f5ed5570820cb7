//! Global shape: a weak spring from every point to its position in the rest shape, which moves rigidly with
//! the root.
//!
//! ```text
//! a = ω² (T − x) + 2ζω (Ṫ − v)        ω = 2πf c(s),   c the profile at the arc length s
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
    let displacement = end.translation - start.translation;
    let inv_dt = 1.0 / strand.frame.dt;
    let whole: f32 = authored.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut along = authored[0].distance(authored[1]);
    for (i, p) in authored.iter().enumerate().skip(2) {
        along += p.distance(authored[i - 1]);
        let curve = profile_at(&shape.profile, f64::from(along / whole)) as f32;
        let omega = std::f32::consts::TAU * shape.pull * scale * curve;
        let [from, to] = [start, end].map(|root| root.rotation * (*p - authored[0]));
        strand.add_position_spring(i, [from, to], omega * omega);
        strand.add_velocity_drag(i, (displacement + (to - from)) * inv_dt, 2.0 * shape.damping * omega);
    }
}
