//! A comb: a row of tines that is drawn through hair.
//!
//! ```text
//!    a ●━┯━┯━┯━┯━● b      between the tines, hair slides along its own direction and moves with the comb across it
//!        │ │ │ │
//!
//!    a = w [ (c⊥ − c∥) (I − u uᵀ) + c∥ I ] (V − v)        u along the strand;   w = 1 − (d/r)², d the distance from a–b, its mean over the frame
//! ```
//!
//! Hair across the comb's motion is moved along until it is taut. Hair along the motion is drawn through,
//! with friction, up to its tip. V is the comb's velocity at the point.
//!
//! # Limitations
//! A comb has no single tines: the hair is not divided into locks, one for each gap.

use super::StrandView;
use crate::{math::RigidTransform, settings::define_settings};
use glam::Vec3;

define_settings! {
    /// A capsule that drags hair along, mainly transverse to the strands.
    ///
    /// ```
    /// use glam::Vec3;
    /// use hairspring::forces::{Manipulator, comb::Comb};
    ///
    /// let (a, b) = (Vec3::NEG_X * 0.05, Vec3::X * 0.05);
    /// let comb = Manipulator::Comb(Comb { a, b, radius: 0.01, grip: 1000.0, friction: 3.0 });
    /// assert!(matches!(comb, Manipulator::Comb(Comb { radius: 0.01, .. })));
    /// ```
    #[derive(Clone, Copy, Debug, PartialEq)]
    entry struct Comb {
        /// One end of the row of tines, in the space that it moves with.
        a: Vec3, ["m"], {vector};
        /// The other end of the row of tines.
        b: Vec3, ["m"], {vector};
        /// Radius around the line between the ends: half the length of the tines.
        radius: f32, ["m"], {above 0};
        /// Rate at which hair takes on the comb's velocity transverse to the strand, c⊥. With the default, hair is
        /// rigid within a substep.
        #[serde(default = "firm")]
        grip: f32 = firm(), ["1/s"], {0 to 10000};
        /// Rate at which hair takes on the comb's velocity along the strand, c∥. With the default, hair slides as
        /// on plastic with some friction.
        #[serde(default = "slick")]
        friction: f32 = slick(), ["1/s"], {
            check |comb| (0.0..=comb.grip).contains(&comb.friction) => "0 to `grip`"
        };
    }
}

fn firm() -> f32 {
    1000.0
}

fn slick() -> f32 {
    3.0
}

/// Maximum speed at which a comb moves hair [m/s].
const MAX_SPEED: f32 = 20.0;

/// Smallest squared length of the comb that is divided by [m²].
const MIN_SQUARED_LENGTH: f32 = 1e-12;

/// Maximum number of samples on a point's path through the comb in a frame.
const MAX_SAMPLES: f32 = 16.0;

impl Comb {
    /// Returns the weight w at `p` [m], in the comb's space.
    fn weight(&self, p: Vec3) -> f32 {
        let axis = self.b - self.a;
        let t = ((p - self.a).dot(axis) / axis.length_squared().max(MIN_SQUARED_LENGTH)).clamp(0.0, 1.0);
        (1.0 - p.distance_squared(self.a + axis * t) / (self.radius * self.radius)).max(0.0)
    }

    /// Returns the mean weight along the path from `from` to `to` [m], in the comb's space.
    fn mean_weight(&self, from: Vec3, to: Vec3) -> f32 {
        let places = (2.0 * from.distance(to) / self.radius).ceil().clamp(1.0, MAX_SAMPLES);
        let at = |k: u32| from.lerp(to, (k as f32 + 0.5) / places);
        (0..places as u32).map(|k| self.weight(at(k))).sum::<f32>() / places
    }

    /// Applies the drag to a strand's points, while the comb moves between two `poses`.
    pub(super) fn act(&self, poses: [RigidTransform; 2], strand: &mut StrandView, points: usize) {
        let root = strand.roots()[0].translation;
        let dt = strand.frame.dt;
        let mut x = root + strand.segment(1).0;
        for i in 2..points {
            let (edge, v) = strand.segment(i);
            x += edge;
            let [from, to] =
                [poses[0].inverse_transform_point(x), poses[1].inverse_transform_point(x + v * dt)];
            let weight = self.mean_weight(from, to);
            if weight > 0.0 {
                let at = from.midpoint(to);
                let velocity = ((poses[1].transform_point(at) - poses[0].transform_point(at)) / dt)
                    .clamp_length_max(MAX_SPEED);
                strand.add_transverse_drag(i, velocity, (self.grip - self.friction).max(0.0) * weight);
                strand.add_velocity_drag(i, velocity, self.friction * weight);
            }
        }
    }
}
