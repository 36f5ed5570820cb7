//! A hand that takes hold of all points in a ball, and pulls them along as they lie in it.
//!
//! ```text
//!      │││                │││
//!     ╭┼┼┼╮               │╲╲╲
//!     │●●●│      ──►      │ ╲╲╲╭───╮        what was inside keeps its offset from the ball
//!     ╰┼┼┼╯               │    │●●●│
//!      │││                │    ╰┼┼┼╯
//! ```
//!
//! In steady motion points lag by nothing but what hangs on them: g/ω² for every one, times the mass that they carry over their own.
//!
//! # Missing
//! Fingers: hair does not slide through the ball, and a hand that is to stroke it is a collider.

use super::bond::{Bond, Spring};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A ball that holds what was in it. Where it does not move, a pin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grab {
    /// Middle of the ball [m], in the space that it moves with.
    pub center: Vec3,
    /// Radius of the ball [m], above 0.
    pub radius: f32,
    /// How fast a lone point would swing about its place, f [Hz], 0 to 1000. Default 60: points give way by 0.07 mm under their own weight.
    #[serde(default = "firm")]
    pub pull: f32,
    /// Damping over the critical, ζ, 0 to 10. Default 1: what is held does not swing.
    #[serde(default = "critical")]
    pub damping: f32,
}

pub(super) fn firm() -> f32 {
    60.0
}

pub(super) fn critical() -> f32 {
    1.0
}

impl Grab {
    pub(super) fn spring(&self) -> Spring {
        Spring { pull: self.pull, damping: self.damping }
    }

    /// Binds those of a strand's `points` [m], in the space of the ball, that are in it and not driven by the root.
    pub(super) fn bind(&self, [strand, place]: [u32; 2], points: &[Vec3], bonds: &mut Vec<Bond>) {
        let inside = |p: &Vec3| p.distance(self.center) <= self.radius;
        let held = points.iter().enumerate().skip(2).filter(|(_, p)| inside(p));
        bonds.extend(held.map(|(i, p)| Bond { strand, place, point: i as u32, from: *p, to: *p }));
    }
}
