//! Static charge: bodies that attract and repel charged hair, and hair that repels itself.
//!
//! ```text
//!   ( + )  ← − −      F = λ l E(x),   E = k Q d / max(r, R)³,   d = x − middle, r = |d|        (Coulomb 1785; Jackson 1999, §1.1)
//!  balloon    hair    λ: charge of a length of hair [C/m],  l: length of hair that is the point's [m]
//! ```
//!
//! Outside, a ball's field is that of a point; inside, as if charge filled it: 0 in its middle and largest at its surface, where air can bear no
//! more than 3 MV/m: what is charged more sparks, and has lost the rest. So no force is without bound.
//!
//! Attraction is an implicit spring to the middle, of the stiffness that gives the force where the point is: along the pull it is softer than that in
//! truth, and cannot overshoot so. Repulsion is a frozen push; where it changes within a frame by more than explicit steps bear,
//! what is more of its stiffness, 2F/r, is implicit. How hair repels itself is in [`HairField`].
//!
//! # Missing
//! Charge stays where it is: it does not flow along hair or over to a body that it touches, nor is it drawn to one side of an uncharged body. Hair of
//! one groom does not repel another's.

use super::{HairField, StrandView};
use crate::math::{RigidTransform, between};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// 1/4πε₀ of air [N m²/C²].
pub(crate) const COULOMB: f32 = 8.99e9;

/// Field that air insulates [V/m]: its breakdown strength at sea level (Paschen 1889; 3 MV/m over gaps of centimetres).
pub(crate) const BREAKDOWN: f32 = 3e6;

/// A charged ball: a balloon, a hand, a head.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Charged {
    /// Name of the body's joint that carries it; `None`: it is fixed in the world, but for its `path`.
    #[serde(default)]
    pub joint: Option<String>,
    /// Its middle at the start, in the space of the body's rest pose or of the world [m].
    pub center: Vec3,
    /// Its radius, R [m], above 0.
    pub radius: f32,
    /// Its charge, Q [C], −1e-3 to 1e-3. A rubbed balloon has about −1e-7. What is above 3 MV/m at the surface counts as that: 5.6e-6 for 13 cm.
    pub charge: f32,
    /// Whether hair collides with it. Default true; false for a ball that stands for the charge of a body, such as the head's.
    #[serde(default = "yes")]
    pub solid: bool,
    /// Where its middle is later, in the order of time; between them it goes straight on, after the last it rests. Default: it stays.
    #[serde(default)]
    pub path: Vec<Waypoint>,
}

fn yes() -> bool {
    true
}

/// A place on the way of a [`Charged`] ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Waypoint {
    /// When it is there [s], above 0.
    pub time: f32,
    /// Where, as `center` [m].
    pub center: Vec3,
}

impl Charged {
    /// Its middle at `time` [s], where what carries it is at rest [m].
    pub fn center(&self, time: f64) -> Vec3 {
        let start = Waypoint { time: 0.0, center: self.center };
        let key = |k: usize| k.checked_sub(1).map_or(start, |k| self.path[k]);
        let way = between(1 + self.path.len(), |k| key(k).time, time);
        way.map_or(self.center, |(a, b, share)| key(a).center.lerp(key(b).center, share))
    }
}

/// A charged ball in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ChargedBall {
    /// Its middle at the start and at the end of the frame, in the world [m].
    pub centers: [Vec3; 2],
    /// Its radius [m], above 0.
    pub radius: f32,
    /// Its charge [C].
    pub charge: f32,
}

impl ChargedBall {
    /// Where it starts for hair that was carried along by `by` before the frame: it was too, or it was not, whichever leaves it less far to go.
    pub(crate) fn carry(&mut self, by: Option<&RigidTransform>) {
        let [start, end] = self.centers;
        let carried = by.map_or(start, |by| by.point(start));
        if carried.distance_squared(end) < start.distance_squared(end) {
            self.centers[0] = carried;
        }
    }

    /// k Q, as much of it as air insulates [V m].
    fn strength(&self) -> f32 {
        let most = BREAKDOWN * self.radius * self.radius;
        (COULOMB * self.charge).clamp(-most, most)
    }
}

/// All charge around hair in a frame.
pub(crate) struct Charges<'a> {
    pub balls: &'a [ChargedBall],
    /// The hair's own.
    pub hair: &'a HairField,
}

impl Charges<'_> {
    /// Lets them act on a strand with `charge` on its length [C/m].
    pub fn add(&self, charge: f32, strand: &mut StrandView) {
        let [start, end] = strand.roots().map(|root| root.translation);
        let explicit = 1.0 / (strand.frame.dt * strand.frame.dt);
        for (i, (x, _)) in strand.points().enumerate().skip(2) {
            // Acceleration in a field of 1 V/m.
            let per_field = charge * strand.length(i) / strand.mass(i);
            for ball in self.balls {
                let d = start + x - ball.centers[0];
                let r = d.length().max(ball.radius);
                // The force over the distance; below 0 it attracts.
                let rate = per_field * ball.strength() / (r * r * r);
                if rate < 0.0 {
                    strand.add_position_spring(i, [ball.centers[0] - start, ball.centers[1] - end], -rate);
                } else {
                    strand.accelerate(i, d * rate);
                    strand.add_position_spring(i, [x; 2], (2.0 * rate - explicit).max(0.0));
                }
            }
            strand.accelerate(i, self.hair.field(start + x) * per_field);
        }
    }
}
