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
use crate::settings::{Check, Validate, define_settings};
use glam::Vec3;

define_settings! {
    /// A source of wind.
    ///
    /// For an example, see [`air`](crate::air).
    #[derive(Clone, Debug, PartialEq)]
    entry struct WindSource {
        /// Name of the body joint that the source is attached to.
        #[serde(default)]
        joint: Option<String>, "none", {text "the name of a joint of the body"}, default "fixed in the world";
        /// The velocity field, in the space of the body's rest pose or of the world.
        shape: Flow, "none", {table};
        /// Amplitude of this source's gusts, as a fraction of its mean speed.
        #[serde(default)]
        gust: f32 = 0.0, "fraction", {0 to 1};
        /// Number of gusts of this source per second. Every source has its own gust phase.
        #[serde(default)]
        gust_rate: f32 = 0.0, ["Hz"], {0 to 1000};
    }
}

impl WindSource {
    /// Returns the source at `time` [s], moved by `pose` relative to its rest pose. `number` is the index of
    /// the source in the scene; it selects the gust phase.
    pub fn at_time(&self, number: usize, pose: RigidTransform, time: f64) -> Source {
        // Multiples of the golden angle, so that all phases differ.
        let gust = Gust { amount: self.gust, rate: self.gust_rate, phase: 2.4 * (number + 1) as f32 };
        Source { flow: self.shape, pose, factor: gust.factor(time) }
    }
}

define_settings! {
    /// The velocity field of a [`WindSource`].
    ///
    /// For an example, see [`air`](crate::air).
    #[derive(Clone, Copy, Debug, PartialEq)]
    #[non_exhaustive]
    entry enum Flow {
        /// Flow out of a ball in all directions, or into it.
        Point = "point" {
            /// Center of the ball.
            center: Vec3, ["m"], {vector -1000000 to 1000000};
            /// Radius of the ball, R.
            radius: f32, ["m"], {above 0};
            /// Speed of the air at the surface of the ball, U. Negative: inward.
            speed: f32, ["m/s"], {-1000 to 1000};
        }
        /// Rotation about an infinite axis.
        Vortex = "vortex" {
            /// A point on the axis.
            center: Vec3, ["m"], {vector -1000000 to 1000000};
            /// Direction of the axis. The rotation follows the right-hand rule.
            axis: Vec3, "direction", {direction};
            /// Distance from the axis at which the flow is fastest, R.
            radius: f32, ["m"], {above 0};
            /// Speed of the air at that distance, U.
            speed: f32, ["m/s"], {-1000 to 1000};
        }
        /// A jet from a round opening.
        Fan = "fan" {
            /// Center of the opening.
            center: Vec3, ["m"], {vector -1000000 to 1000000};
            /// Direction of the jet.
            axis: Vec3, "direction", {direction};
            /// Radius of the opening, R.
            radius: f32, ["m"], {above 0};
            /// Speed of the air at the opening, U.
            speed: f32, ["m/s"], {-1000 to 1000};
            /// Half-angle of the jet's cone, between its axis and its edge. The default is the angle of every free
            /// turbulent jet: its radius grows by a fifth of the distance (Pope 2000, §5.1).
            #[serde(default = "free_jet")]
            spread: f32 = free_jet(), ["degrees"], {0 to 80};
        }
    }
}

/// Half-angle of a free turbulent jet [degrees].
fn free_jet() -> f32 {
    11.8
}

/// Lower bound of a radius [m].
const MIN_RADIUS: f32 = 1e-6;

impl Flow {
    /// Returns the velocity of the air at `p` [m/s].
    pub fn velocity(&self, p: Vec3) -> Vec3 {
        match *self {
            Self::Point { center, radius, speed } => {
                let d = p - center;
                let radius = radius.max(MIN_RADIUS);
                let far = d.length().max(radius) / radius;
                d * (speed / (radius * far * far * far))
            }
            Self::Vortex { center, axis, radius, speed } => {
                let axis = axis.normalize_or_zero();
                let around = axis.cross(p - center) / radius.max(MIN_RADIUS);
                around * (2.0 * speed / (1.0 + around.length_squared()))
            }
            Self::Fan { center, axis, radius, speed, spread } => {
                let axis = axis.normalize_or_zero();
                let d = p - center;
                let along = d.dot(axis);
                if along < 0.0 {
                    return Vec3::ZERO;
                }
                let radius = radius.max(MIN_RADIUS);
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
        self.pose.rotation * (self.flow.velocity(self.pose.inverse_transform_point(place)) * self.factor)
    }
}

impl Validate for Flow {
    fn checks(&self) -> Vec<Check> {
        self.range_checks()
    }
}
