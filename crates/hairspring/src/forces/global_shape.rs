//! The global shape: a weak pull of every point to where its strand's rest shape would have it, carried rigidly by the root.
//!
//! ```text
//! a = ω² (T − x) + 2ζω (Ṫ − v)        ω = 2πf c(s),   c from 1 at the root to `tip` at the tip, linear in the index
//! ```
//!
//! The global shape of *Augmented Mass-Spring* (AMS 2025) and of the engines' tools. It is not physics: it holds a style that the fibre would not.

use super::StrandView;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A pull to the rest shape.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GlobalShape {
    /// How fast a lone point would swing about its place, f [Hz], 0 to 60. Default 0: there is no global shape. Hair keeps its style in a walk from
    /// about 1, and looks set from about 4.
    pub pull: f32,
    /// The same at the tip, over that at the root, 0 or more. Default 1.
    pub tip: f32,
    /// Damping over the critical, ζ, 0 to 10. Default 0.5.
    pub damping: f32,
}

impl Default for GlobalShape {
    fn default() -> Self {
        Self { pull: 0.0, tip: 1.0, damping: 0.5 }
    }
}

impl GlobalShape {
    /// Whether it pulls at all.
    pub fn is_on(&self) -> bool {
        self.pull > 0.0
    }

    /// Pulls a strand, whose authored points are `authored` [m], `scale` times as fast.
    pub(crate) fn add(&self, scale: f32, authored: &[Vec3], strand: &mut StrandView) {
        let [start, end] = strand.roots();
        let way = end.translation - start.translation;
        let inv_dt = 1.0 / strand.frame.dt;
        let last = (authored.len() - 1) as f32;
        for (i, p) in authored.iter().enumerate().skip(2) {
            let curve = 1.0 + (self.tip - 1.0) * (i as f32 / last);
            let omega = std::f32::consts::TAU * self.pull * scale * curve;
            let [from, to] = [start, end].map(|root| root.rotation * (*p - authored[0]));
            strand.add_position_spring(i, [from, to], omega * omega);
            strand.add_velocity_drag(i, (way + (to - from)) * inv_dt, 2.0 * self.damping * omega);
        }
    }
}
