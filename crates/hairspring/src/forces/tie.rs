//! A hair tie: a ring that gathers the strands around it, and holds them where they pass through it.
//!
//! ```text
//!   ╲  ╲ │ ╱  ╱                ╲ ╲│╱ ╱
//!    ╲  ╲│╱  ╱     gathered     ╲│││╱
//!  ───●──●──●───     ──►      ───●●●───  radius          axis: the way in which hair leaves the ring
//!     ╎  ╎  ╎                    │││ │                 ↓
//!   ╰─ reach ─╯                  │││ │   hangs free
//! ```
//!
//! Every strand that comes within reach is bound at its segment nearest to the middle. The segment is laid along the axis, as far aside of it as the
//! strand was, scaled by radius over reach; it is taken there in the time that gathering takes. Hair that is too short from the root to get there
//! slips through the ring until it does: the next segment is bound in place of the last.
//!
//! # Missing
//! Strands do not push each other apart in the ring: it must be as wide as the hair is thick. It does not slide off the hair. Guides are gathered, and
//! follow hairs keep their distance from their guides: where guides are far apart, more of them, or a clump, makes the tie tight.

use super::{
    bond::{Bond, Spring},
    grab::{critical, firm},
};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A ring that gathers strands.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tie {
    /// Middle of the ring [m], in the space that it moves with.
    pub center: Vec3,
    /// Direction in which hair leaves the ring, of any length above 0.
    pub axis: Vec3,
    /// Radius of the gathered hair [m], above 0.
    pub radius: f32,
    /// How far from the middle a strand may pass to be gathered [m], above 0.
    pub reach: f32,
    /// How long gathering takes [s], 0 or more. Default 0.5: at once it would be a jerk.
    #[serde(default = "half")]
    pub gather: f32,
    /// How fast a lone point would swing about its place, f [Hz], 0 to 1000. Default 60.
    #[serde(default = "firm")]
    pub pull: f32,
    /// Damping over the critical, ζ, 0 to 10. Default 1.
    #[serde(default = "critical")]
    pub damping: f32,
}

fn half() -> f32 {
    0.5
}

/// How long after gathering hair may still slip through [s].
const SETTLES: f32 = 1.0;

/// Hair slips where it is off its place by more than this share of its segment [1].
const SLIPS: f32 = 0.5;

impl Tie {
    pub(super) fn spring(&self) -> Spring {
        Spring { pull: self.pull, damping: self.damping }
    }

    /// Binds a strand with these `points` [m], in the space of the ring, if it comes within reach.
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

    /// Share of gathering that is done `time` after it began [s]: at rest at both ends.
    pub(super) fn gathered(&self, time: f32) -> f32 {
        let t = if self.gather > 0.0 { (time / self.gather).min(1.0) } else { 1.0 };
        t * t * (3.0 - 2.0 * t)
    }

    /// Whether hair may still slip through `time` after gathering began [s].
    pub(super) fn settles(&self, time: f32) -> bool {
        time < self.gather + SETTLES
    }

    /// Lets the next segment of `points`, which are those of the strand in the space of the ring [m], take the place of the bound one where that is held
    /// back; false where the strand has none left and is out of the ring. `out` says where a place is that hair is pulled to, outside of bodies.
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
        if points[first].distance(out(bonds[0].at(share))) <= SLIPS * length {
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
