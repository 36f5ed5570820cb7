//! A grab: a hand that holds all points in a ball and moves them rigidly.
//!
//! ```text
//!      │││                │││
//!     ╭┼┼┼╮               │╲╲╲
//!      │●●●│      ──►      │ ╲╲╲╭───╮        points that were inside keep their offset from the ball
//!     ╰┼┼┼╯               │    │●●●│
//!      │││                │    ╰┼┼┼╯
//! ```
//!
//! Held points lag by g/ω² times the ratio of the load they carry to their own mass.
//!
//! # Limitations
//! A hand has no fingers: hair does not slide through the ball. Use a collider for a hand that strokes the hair.

use super::bond::{Bond, Spring};
use crate::settings::define_settings;
use glam::Vec3;

define_settings! {
    /// A ball that holds the points that were inside. If it does not move, it is a pin.
    ///
    /// For an example, see [`forces`](crate::forces).
    #[derive(Clone, Copy, Debug, PartialEq)]
    entry struct Grab {
        /// Center of the ball, in the space that it moves with.
        center: Vec3, ["m"], {vector};
        /// Radius of the ball.
        radius: f32, ["m"], {above 0};
        /// Natural frequency of a free point, f. With the default, points sag by 0.07 mm under their own weight.
        #[serde(default = "firm")]
        pull: f32 = firm(), ["Hz"], {0 to 1000};
        /// Damping ratio, relative to critical, ζ. With the default, held points do not oscillate.
        #[serde(default = "critical")]
        damping: f32 = critical(), "damping ratio", {0 to 10};
    }
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

    /// Attaches those of a strand's `points` [m], in the space of the ball, that are inside it and not driven
    /// by the root.
    pub(super) fn bind(&self, [strand, place]: [u32; 2], points: &[Vec3], bonds: &mut Vec<Bond>) {
        let inside = |p: &Vec3| p.distance(self.center) <= self.radius;
        let held = points.iter().enumerate().skip(2).filter(|(_, p)| inside(p));
        bonds.extend(held.map(|(i, p)| Bond { strand, place, point: i as u32, from: *p, to: *p }));
    }
}
