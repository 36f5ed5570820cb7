//! Sources of wind besides the wind of all points, and the law of each.
//!
//! ```text
//! point     ↖ ↑ ↗      u = U (R/r)² away from the middle; U r/R inside of R. The flow of a source in a fluid that keeps its volume
//!           ← • →          (Lamb 1932, Hydrodynamics, §56); below 0 it sucks in
//!
//! vortex     ⟲         u = 2U (r/R) / (1 + (r/R)²) about the axis, U at R (Kaufmann 1962; Vatistas 1991, n = 1)
//!
//! fan      ║⇉⇉⇉ → →    u = min(U, 2U (R/b) e^(−2 (r/b)²)) along the axis, b = R + z tan(spread); nothing behind. The round turbulent jet
//!                          (Pope 2000, Turbulent Flows, §5.1): a core at full speed, which the mixing around it has used up where b = 2R;
//!                          from there on each cross-section has the momentum of the mouth, ∫ u² = U² π R²
//! ```

use super::gust::Gust;
use crate::math::RigidTransform;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Something that blows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindSource {
    /// Name of the body's joint that carries it; `None`: it is fixed in the world.
    #[serde(default)]
    pub joint: Option<String>,
    /// How it blows, in the space of the body's rest pose or of the world.
    pub shape: Flow,
    /// How much gusts add and take, as a fraction of the mean, 0 to 1. Default 0.
    #[serde(default)]
    pub gust: f32,
    /// Gusts a second [Hz]. Default 0: none. No two sources gust at the same moments.
    #[serde(default)]
    pub gust_rate: f32,
}

impl WindSource {
    /// The source as it blows at `time` [s], carried by `pose` since rest; `number`: which of the scene's it is, so that each has its own gusts.
    pub fn at(&self, number: usize, pose: RigidTransform, time: f64) -> Source {
        // Golden angles: no two begin alike.
        let gust = Gust { amount: self.gust, rate: self.gust_rate, phase: 2.4 * (number + 1) as f32 };
        let factor = if self.gust_rate > 0.0 { gust.factor(time) } else { 1.0 };
        Source { flow: self.shape, pose, factor }
    }
}

/// The shapes of a [`WindSource`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Flow {
    /// Out of a ball to all sides, or into it.
    Point {
        /// Middle [m].
        center: Vec3,
        /// Radius of the ball, R [m], above 0.
        radius: f32,
        /// Speed at the ball, U [m/s]; below 0: inward.
        speed: f32,
    },
    /// Around an axis without end.
    Vortex {
        /// A point of the axis [m].
        center: Vec3,
        /// Direction of the axis, of any length above 0; it turns by the right hand.
        axis: Vec3,
        /// Where it is fastest, from the axis, R [m], above 0.
        radius: f32,
        /// Speed there, U [m/s].
        speed: f32,
    },
    /// A jet out of a round mouth.
    Fan {
        /// Middle of the mouth [m].
        center: Vec3,
        /// Where it blows, of any length above 0.
        axis: Vec3,
        /// Radius of the mouth, R [m], above 0.
        radius: f32,
        /// Speed at the mouth, U [m/s].
        speed: f32,
        /// How wide the jet opens: angle between its axis and its edge [degrees], 0 to 80. Default 11.8: every free turbulent jet's, a fifth of
        /// the way (Pope 2000, §5.1).
        #[serde(default = "free_jet")]
        spread: f32,
    },
}

/// Degrees between a free jet's axis and its edge.
fn free_jet() -> f32 {
    11.8
}

/// A radius that is 0 counts as this [m].
const LEAST: f32 = 1e-6;

impl Flow {
    /// Velocity of the air at `p` [m/s].
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

/// A source of wind as it blows in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// How it blows, at rest.
    pub flow: Flow,
    /// Where what carries it has gone since rest.
    pub pose: RigidTransform,
    /// Its speed over the mean, by gusts [1].
    pub factor: f32,
}

impl Source {
    /// Velocity of its air at `place` in the world [m/s].
    pub fn velocity(&self, place: Vec3) -> Vec3 {
        self.pose.rotation * (self.flow.velocity(self.pose.inverse_point(place)) * self.factor)
    }
}
