//! Wind sources, and the velocity field of each kind.
//!
//! ```text
//! point     ↖ ↑ ↗      u = U (R/r)² away from the center; U r/R inside R. The flow of a point source in an incompressible
//!           ← • →          fluid (Lamb 1932, Hydrodynamics, §56); negative speeds give a sink
//!
//! vortex     ⟲         u = 2U (r/R) / (1 + (r/R)²) about the axis, U at R (Kaufmann 1962; Vatistas 1991, n = 1)
//!
//! fan      ║⇉⇉⇉ → →    u = min(U, 2U (R/b) e^(−2 (r/b)²)) along the axis, b = R + z tan(spread); 0 behind the opening. The
//!                          round turbulent jet (Pope 2000, Turbulent Flows, §5.1): a core at full speed, which mixing has
//!                          consumed where b = 2R; beyond, each cross-section has the momentum flux of the opening,
//!                          ∫ u² = U² π R²
//! ```

use super::gust::Gust;
use crate::math::RigidTransform;
use crate::settings::{Check, Validate, above_0, check, gusts};
use glam::Vec3;

/// A source of wind.
///
/// For an example, see [`air`](crate::air).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct WindSource {
    /// Name of the body joint that the source is attached to. `None`: the source is fixed in the world.
    #[cfg_attr(feature = "serde", serde(default))]
    pub joint: Option<String>,
    /// The velocity field, in the space of the body's rest pose or of the world.
    pub shape: Flow,
    /// Gust amplitude as a fraction of the mean speed, 0 to 1. Default 0.
    #[cfg_attr(feature = "serde", serde(default))]
    pub gust: f32,
    /// Gust frequency [Hz]. Default 0: none. Every source has its own gust phase.
    #[cfg_attr(feature = "serde", serde(default))]
    pub gust_rate: f32,
}

impl WindSource {
    /// Returns the source at `time` [s], moved by `pose` relative to its rest pose. `number` is the index of
    /// the source in the scene; it selects the gust phase.
    pub fn at_time(&self, number: usize, pose: RigidTransform, time: f64) -> Source {
        // Multiples of the golden angle, so that all phases differ.
        let gust = Gust { amount: self.gust, rate: self.gust_rate, phase: 2.4 * (number + 1) as f32 };
        let factor = if self.gust_rate > 0.0 { gust.factor(time) } else { 1.0 };
        Source { flow: self.shape, pose, factor }
    }
}

/// The velocity field of a [`WindSource`].
///
/// For an example, see [`air`](crate::air).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
#[non_exhaustive]
pub enum Flow {
    /// Flow out of a ball in all directions, or into it.
    Point {
        /// Center [m].
        center: Vec3,
        /// Radius of the ball, R [m], above 0.
        radius: f32,
        /// Speed at the surface of the ball, U [m/s]. Negative: inward.
        speed: f32,
    },
    /// Rotation about an infinite axis.
    Vortex {
        /// A point on the axis [m].
        center: Vec3,
        /// Direction of the axis, of any length above 0. The rotation follows the right-hand rule.
        axis: Vec3,
        /// Distance from the axis at which the flow is fastest, R [m], above 0.
        radius: f32,
        /// Speed at that distance, U [m/s].
        speed: f32,
    },
    /// A jet from a round opening.
    Fan {
        /// Center of the opening [m].
        center: Vec3,
        /// Direction of the jet, of any length above 0.
        axis: Vec3,
        /// Radius of the opening, R [m], above 0.
        radius: f32,
        /// Speed at the opening, U [m/s].
        speed: f32,
        /// Half-angle of the jet's cone, between its axis and its edge [degrees], 0 to 80. Default 11.8, the
        /// angle of every free turbulent jet: its radius grows by a fifth of the distance (Pope 2000, §5.1).
        #[cfg_attr(feature = "serde", serde(default = "free_jet"))]
        spread: f32,
    },
}

/// Half-angle of a free turbulent jet [degrees].
#[cfg(feature = "serde")]
fn free_jet() -> f32 {
    11.8
}

/// Lower bound of a radius [m].
const LEAST: f32 = 1e-6;

impl Flow {
    /// Returns the velocity of the air at `p` [m/s].
    pub fn velocity(&self, p: Vec3) -> Vec3 {
        match *self {
            Self::Point { center, radius, speed } => {
                let d = p - center;
                let radius = radius.max(LEAST);
                let far = d.length().max(radius) / radius;
                d * (speed / (radius * far * far * far))
            }
            Self::Vortex { center, axis, radius, speed } => {
                let axis = axis.normalize_or_zero();
                let around = axis.cross(p - center) / radius.max(LEAST);
                around * (2.0 * speed / (1.0 + around.length_squared()))
            }
            Self::Fan { center, axis, radius, speed, spread } => {
                let axis = axis.normalize_or_zero();
                let d = p - center;
                let along = d.dot(axis);
                if along < 0.0 {
                    return Vec3::ZERO;
                }
                let radius = radius.max(LEAST);
                let width = radius + along * spread.to_radians().tan();
                let across = (d - axis * along).length_squared() / (width * width);
                axis * (speed * (2.0 * radius / width * (-2.0 * across).exp()).min(1.0))
            }
        }
    }
}

/// A wind source as it is in one frame.
///
/// For an example, see [`air`](crate::air).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// The velocity field, at rest.
    pub flow: Flow,
    /// Motion since rest of the joint that carries the source.
    pub pose: RigidTransform,
    /// Speed relative to the mean, from gusts [1].
    pub factor: f32,
}

impl Source {
    /// Returns the velocity of the air at `place` in world space [m/s].
    pub fn velocity(&self, place: Vec3) -> Vec3 {
        self.pose.rotation * (self.flow.velocity(self.pose.inverse_point(place)) * self.factor)
    }
}

impl Validate for WindSource {
    fn checks(&self) -> Vec<Check> {
        let mut checks = gusts(self.gust, self.gust_rate).to_vec();
        checks.push(self.shape.check());
        checks
    }
}

impl Flow {
    /// Returns the rule of a flow: it is finite and has a valid radius, axis and spread.
    fn check(&self) -> Check {
        let sound = |center: Vec3, radius: f32, speed: f32| {
            center.is_finite() && above_0(Some(radius)) && speed.is_finite()
        };
        let points = |axis: Vec3| axis.try_normalize().is_some();
        let holds = match *self {
            Flow::Point { center, radius, speed } => sound(center, radius, speed),
            Flow::Vortex { center, axis, radius, speed } => sound(center, radius, speed) && points(axis),
            Flow::Fan { center, axis, radius, speed, spread } => {
                sound(center, radius, speed) && points(axis) && (0.0..=80.0).contains(&spread)
            }
        };
        check(
            holds,
            "shape",
            "finite, with a radius above 0 [m], an axis that is not 0 and a spread of 0 to 80 [degrees]",
        )
    }
}
