//! A hair tie: a ring that gathers strands and holds them where they pass through it.
//!
//! ```text
//!   ╲  ╲ │ ╱  ╱                ╲ ╲│╱ ╱
//!    ╲  ╲│╱  ╱     gathered     ╲│││╱
//!  ───●──●──●───     ──►      ───●●●───  radius          axis: the direction in which hair leaves the ring
//!     ╎  ╎  ╎                    │││ │                 ↓
//!   ╰─ reach ─╯                  │││ │   hangs free
//! ```
//!
//! Every strand that comes within reach is attached at its segment nearest to the center. The segment is
//! aligned with the axis and moved toward it: its distance from the axis is scaled by radius over reach. The
//! motion takes the gathering time. If the hair between root and ring is too short, the strand slips through
//! the ring: the next segment is attached in place of the last.
//!
//! # Limitations
//! Strands do not push each other apart in the ring, so its radius must match the thickness of the hair. It
//! does not slide off the hair. Only guides are gathered, and follow hairs keep their distance from their
//! guides. If guides are far apart, more guides or clumping make the tie tight.

use super::{
    bond::{Bond, Spring},
    grab::{critical, firm},
};
use crate::settings::define_settings;
use glam::Vec3;

define_settings! {
    /// A ring that gathers strands.
    ///
    /// ```
    /// use glam::Vec3;
    /// use hairspring::forces::{Manipulator, tie::Tie};
    ///
    /// let ring = Tie {
    ///     center: Vec3::ZERO, axis: Vec3::NEG_Y, radius: 0.01, reach: 0.1, gather: 0.5, pull: 60.0, damping: 1.0,
    /// };
    /// assert!(matches!(Manipulator::Tie(ring), Manipulator::Tie(Tie { reach: 0.1, .. })));
    /// ```
    #[derive(Clone, Copy, Debug, PartialEq)]
    entry struct Tie {
        /// Center of the ring, in the space that it moves with.
        center: Vec3, ["m"], {vector};
        /// Direction in which hair leaves the ring.
        axis: Vec3, "direction", {direction};
        /// Radius of the gathered hair.
        radius: f32, ["m"], {above 0};
        /// Maximum distance from the center at which a strand is gathered.
        reach: f32, ["m"], {above 0};
        /// Duration of gathering. The default avoids a jerk.
        #[serde(default = "half")]
        gather: f32 = half(), ["s"], {0 or more};
        /// Natural frequency of a free point, f.
        #[serde(default = "firm")]
        pull: f32 = firm(), ["Hz"], {0 to 1000};
        /// Damping ratio, relative to critical, ζ.
        #[serde(default = "critical")]
        damping: f32 = critical(), "damping ratio", {0 to 10};
    }
}

fn half() -> f32 {
    0.5
}

/// Time after gathering during which hair may still slip through [s].
const SETTLING_TIME: f32 = 1.0;

/// Hair slips if its offset from the target exceeds this fraction of its segment [1].
const MAX_OFFSET: f32 = 0.5;

impl Tie {
    pub(super) fn spring(&self) -> Spring {
        Spring { pull: self.pull, damping: self.damping }
    }

    /// Attaches a strand with these `points` [m], in the space of the ring, if it comes within reach.
    pub(super) fn bind(&self, [strand, place]: [u32; 2], points: &[Vec3], bonds: &mut Vec<Bond>) {
        let axis = self.axis.normalize_or(Vec3::NEG_Y);
        let middle = |i: usize| points[i].midpoint(points[i + 1]) - self.center;
        let segments = 2..points.len() - 1;
        let Some(i) =
            segments.min_by(|a, b| middle(*a).length_squared().total_cmp(&middle(*b).length_squared()))
        else {
            return;
        };
        let reached = middle(i).length() <= self.reach;
        if !reached {
            return;
        }
        let aside = middle(i).reject_from_normalized(axis) * (self.radius / self.reach.max(self.radius));
        let half = 0.5 * points[i].distance(points[i + 1]) * axis;
        for (point, along) in [(i, -half), (i + 1, half)] {
            let to = self.center + aside + along;
            bonds.push(Bond { strand, place, point: point as u32, from: points[point], to });
        }
    }

    /// Returns the completed fraction of gathering at `time` [s] after it began. Its rate is zero at both
    /// ends.
    pub(super) fn gathered(&self, time: f32) -> f32 {
        let t = if self.gather > 0.0 { (time / self.gather).min(1.0) } else { 1.0 };
        t * t * (3.0 - 2.0 * t)
    }

    /// Returns whether hair may still slip through at `time` [s] after gathering began.
    pub(super) fn settles(&self, time: f32) -> bool {
        time < self.gather + SETTLING_TIME
    }

    /// If the attached segment of a strand lags behind, attaches the next segment instead. `points` are those
    /// of the strand in the space of the ring [m]. Returns false if no segment is left, so the strand is out
    /// of the ring. `out` moves a target outside of bodies.
    pub(super) fn slip(
        &self,
        time: f32,
        points: &[Vec3],
        out: impl Fn(Vec3) -> Vec3,
        bonds: &mut [Bond],
    ) -> bool {
        let share = self.gathered(time);
        let first = bonds[0].point as usize;
        let length = points[first].distance(points[first + 1]);
        if points[first].distance(out(bonds[0].at(share))) <= MAX_OFFSET * length {
            return true;
        }
        if first + 2 >= points.len() {
            return false;
        }
        let axis = self.axis.normalize_or(Vec3::NEG_Y);
        let middle = bonds[0].to.midpoint(bonds[1].to);
        let half = 0.5 * points[first + 1].distance(points[first + 2]) * axis;
        for (bond, along) in bonds.iter_mut().zip([-half, half]) {
            bond.point += 1;
            bond.to = middle + along;
        }
        true
    }
}
