//! Static charge: bodies that attract and repel charged hair, and hair that repels itself.
//!
//! ```text
//!   ( + )  ← − −      F = λ l E(x),   E = k Q d / max(r, R)³,   d = x − center, r = |d|        (Coulomb 1785; Jackson 1999, §1.1)
//!  balloon    hair    λ: charge per length of hair [C/m],  l: length of hair that the point represents [m]
//! ```
//!
//! Outside a ball, the field is that of a point charge. Inside, it is that of a uniformly charged ball: 0 at
//! the center and largest at the surface. Air breaks down above 3 MV/m, so a larger charge is clamped to that
//! field. This bounds all forces.
//!
//! Attraction is an implicit spring to the center, whose stiffness gives the force at the point's position.
//! Along the pull the true force is softer than this spring, so a step cannot overshoot. Repulsion is a
//! constant acceleration during the frame. If its stiffness 2F/r exceeds what explicit steps can handle, the
//! excess is implicit. The repulsion of hair by hair is in [`HairField`].
//!
//! # Limitations
//! Charge does not move: it does not flow along hair or to a body in contact, and it is not displaced in an
//! uncharged body.

use super::{HairField, StrandView};
use crate::material::profile_at;
use crate::math::{RigidTransform, find_keys, nearer_start};
use crate::settings::define_settings;
use glam::Vec3;

/// 1/4πε₀ of air [N m²/C²].
pub(crate) const COULOMB: f32 = 8.99e9;

/// Maximum field in air [V/m]: its breakdown strength at sea level (Paschen 1889; 3 MV/m over gaps of
/// centimeters).
pub(crate) const BREAKDOWN: f32 = 3e6;

define_settings! {
    /// A charged ball: a balloon, a hand, a head.
    ///
    /// ```
    /// use glam::Vec3;
    /// use hairspring::forces::charge::{Charged, Waypoint};
    ///
    /// // A balloon that approaches within a second.
    /// let path = vec![Waypoint { time: 1.0, center: Vec3::Y * 0.2 }];
    /// let (center, radius) = (Vec3::Y, 0.13);
    /// let balloon = Charged { joint: None, center, radius, charge: -1e-7, solid: true, path };
    /// assert!(balloon.center(0.5).distance(Vec3::Y * 0.6) < 1e-6);
    /// ```
    #[derive(Clone, Debug, PartialEq)]
    entry struct Charged {
        /// Name of the body joint that carries the ball.
        #[serde(default)]
        joint: Option<String>, "none", {text "the name of a joint of the body"},
            default "fixed in the world, except for its path";
        /// Center of the ball at the start, in the space of the body's rest pose or of the world.
        center: Vec3, ["m"], {vector};
        /// Radius of the ball, R.
        radius: f32, ["m"], {above 0};
        /// Charge of the ball, Q. Hair of the opposite sign is attracted, and hair of the same sign is repelled. A
        /// rubbed balloon has about -1e-7.
        ///
        /// The field at the surface is clamped to 3 MV/m: 5.6e-6 for a radius of 13 cm.
        charge: f32, ["C"], {-1e-3 to 1e-3};
        /// Whether hair collides with the ball.
        ///
        /// Set it to false for a ball that represents the charge of a body, such as the head's.
        #[serde(default = "yes")]
        solid: bool = true, "none", {switch};
        /// Positions of its center in order of time. The center moves linearly between them and rests after the
        /// last.
        #[serde(default)]
        path: Vec<Waypoint> = Vec::new(), "s, m", {
            check |ball| ball.path_is_valid()
                => "finite positions [m] at times above 0 [s], each later than the one before"
        };
    }
}

#[cfg(feature = "serde")]
fn yes() -> bool {
    true
}

define_settings! {
    /// A waypoint of a [`Charged`] ball.
    ///
    /// For an example, see [`Charged`].
    #[derive(Clone, Copy, Debug, PartialEq)]
    entry struct Waypoint {
        /// Time at which the ball is there, later than that of the previous waypoint.
        time: f32, ["s"], {above 0};
        /// Position of the ball's center, in the same space as that at the start.
        center: Vec3, ["m"], {vector};
    }
}

impl Charged {
    /// Returns whether the positions are finite, and the times above 0 and increasing.
    fn path_is_valid(&self) -> bool {
        let times = || self.path.iter().map(|p| p.time);
        let before = std::iter::once(0.0).chain(times());
        let finite = self.path.iter().all(|p| p.center.is_finite() && p.time.is_finite());
        finite && times().zip(before).all(|(time, before)| time > before)
    }

    /// Returns its center at `time` [s], with the joint that carries it at rest [m].
    pub fn center(&self, time: f64) -> Vec3 {
        let start = Waypoint { time: 0.0, center: self.center };
        let key = |k: usize| k.checked_sub(1).map_or(start, |k| self.path[k]);
        let way = find_keys(1 + self.path.len(), |k| key(k).time, time);
        way.map_or(self.center, |(a, b, share)| key(a).center.lerp(key(b).center, share))
    }
}

/// A charged ball in a frame.
///
/// ```
/// use hairspring::{forces::charge::ChargedBall, prelude::*};
///
/// let strand: Vec<Vec3> = (0..8).map(|i| Vec3::NEG_Y * (0.01 * i as f32)).collect();
/// let mut simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).build()?;
/// simulation.set_charged([ChargedBall { centers: [Vec3::X; 2], radius: 0.13, charge: -1e-7 }]);
/// # Ok::<(), hairspring::simulation::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ChargedBall {
    /// Its center at the start and at the end of the frame, in world space [m].
    pub centers: [Vec3; 2],
    /// Its radius [m], above 0.
    pub radius: f32,
    /// Its charge [C].
    pub charge: f32,
}

impl ChargedBall {
    /// Adjusts the start position after hair was teleported by `by`. The ball may or may not have been teleported
    /// with the hair. Of the two start positions, the one nearer to the end is used.
    pub(crate) fn carry(&mut self, by: Option<&RigidTransform>) {
        let [start, end] = self.centers;
        let carried = by.map_or(start, |by| by.transform_point(start));
        self.centers[0] = nearer_start(start, carried, |center| center.distance_squared(end));
    }

    /// Returns k Q, limited by the breakdown field [V m].
    fn strength(&self) -> f32 {
        let most = BREAKDOWN * self.radius * self.radius;
        (COULOMB * self.charge).clamp(-most, most)
    }
}

/// The charge of a strand.
pub(crate) struct LineCharge<'a> {
    /// Charge per length [C/m].
    pub per_length: f32,
    /// Its multiplier from root to tip.
    pub profile: &'a [f32],
}

impl<'p> LineCharge<'p> {
    /// The charge per length [C/m] and the length of hair [m] of each point of the strand.
    pub fn at_points<'s, 'a>(
        &'s self,
        strand: &StrandView<'a>,
    ) -> impl Iterator<Item = (f32, f32)> + use<'s, 'a, 'p> {
        let total: f32 = strand.lengths().sum();
        let mut before = 0.0;
        strand.lengths().map(move |length| {
            let fraction = (before + 0.5 * length) / total;
            before += length;
            (self.per_length * profile_at(self.profile, f64::from(fraction)) as f32, length)
        })
    }
}

/// All charges that act on hair in a frame.
pub(crate) struct Charges<'a> {
    pub balls: &'a [ChargedBall],
    /// The field of the charged hair.
    pub hair: &'a HairField,
}

impl Charges<'_> {
    /// Applies the forces to a strand.
    pub fn add(&self, charge: &LineCharge, strand: &mut StrandView) {
        let [start, end] = strand.roots().map(|root| root.translation);
        let explicit = 1.0 / (strand.frame.dt * strand.frame.dt);
        let charges = charge.at_points(strand);
        for (i, ((x, _), (per_length, length))) in strand.points().zip(charges).enumerate().skip(2) {
            // Acceleration in a field of 1 V/m.
            let per_field = per_length * length / strand.mass(i);
            for ball in self.balls {
                let d = start + x - ball.centers[0];
                let r = d.length().max(ball.radius);
                // Acceleration per distance; negative for attraction.
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
