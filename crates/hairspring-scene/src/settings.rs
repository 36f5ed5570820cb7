//! Colliders of a scene, and the choice of its guides. A field's default applies if a file omits it.

use glam::{Mat3, Vec3};
use hairspring::{
    collide::{ColliderShape, Hull},
    settings::{Check, Validate, above_0, check},
};
use serde::{Deserialize, Serialize};
use std::{path::PathBuf, sync::Arc};

/// Selects the simulated strands of a groom; the others follow them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Guides {
    /// The strands that the groom file marks as guides, or 2,000 chosen ones if it marks none. The default.
    #[default]
    FromGroom,
    /// This many strands, spread over the scalp per group.
    Count(u32),
    /// Every strand.
    All,
}

/// A simple shape that hair collides with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Collider {
    /// Name of the body joint that moves it; `None`: joint 0, or fixed without a body.
    #[serde(default)]
    pub joint: Option<String>,
    /// The shape, in the space of the body's rest pose [m].
    pub shape: Shape,
}

/// The shapes of a [`Collider`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Shape {
    /// A sphere.
    Sphere {
        /// Center [m].
        center: Vec3,
        /// Radius [m], above 0.
        radius: f32,
    },
    /// All points nearer than `radius` to the segment from `a` to `b`.
    Capsule {
        /// One end of the axis [m].
        a: Vec3,
        /// The other end [m].
        b: Vec3,
        /// Radius [m], above 0.
        radius: f32,
    },
    /// A box.
    Box {
        /// Center [m].
        center: Vec3,
        /// Lengths of its edges [m], above 0.
        size: Vec3,
        /// Rotation about X, then Y, then Z [degrees]. Default 0.
        #[serde(default)]
        rotation: Vec3,
    },
    /// A half-space, on the side of a plane that `normal` points away from: a floor, a wall, a slope.
    Plane {
        /// A point on the plane [m].
        point: Vec3,
        /// Direction out of the solid, of any length above 0.
        normal: Vec3,
    },
    /// The convex hull of points: a shoulder, a stone, a brush.
    Hull {
        /// Points of the hull [m], four to [`MAX_POINTS`](Shape::MAX_POINTS). Default: the vertices of `file`.
        #[serde(default)]
        points: Vec<Vec3>,
        /// A mesh file. The scene reader replaces `points` with its vertices; this crate does not open it.
        #[serde(default)]
        file: Option<PathBuf>,
        /// Meters per unit of `file` [m], above 0. Default: given by the format, or guessed and reported.
        #[serde(default)]
        scale: Option<f32>,
    },
}

impl Shape {
    /// Maximum number of points of a hull: the cost of making it grows with the square of their number.
    pub const MAX_POINTS: usize = 2048;

    /// Returns the collider shape; `None` for a hull whose points span no volume.
    pub fn obstacle(&self) -> Option<ColliderShape> {
        Some(match *self {
            Self::Sphere { center, radius } => ColliderShape::Sphere { center, radius },
            Self::Capsule { a, b, radius } => ColliderShape::Capsule { a, b, radius },
            Self::Box { center, size, rotation } => {
                let [x, y, z] = rotation.to_array().map(f32::to_radians);
                let axes = Mat3::from_rotation_z(z) * Mat3::from_rotation_y(y) * Mat3::from_rotation_x(x);
                ColliderShape::Cuboid { center, half: 0.5 * size, axes }
            }
            Self::Plane { point, normal } => {
                ColliderShape::Plane { point, normal: normal.normalize_or(Vec3::Y) }
            }
            Self::Hull { ref points, .. } => ColliderShape::Hull(Arc::new(Hull::new(points)?)),
        })
    }
}

/// Describes a valid shape, for error messages.
const SOUND: &str = "finite, with a radius or edges above 0 [m], a normal that is not 0, or at most 2048 `points` that span a volume or a `file` of them";

impl Validate for Shape {
    /// The shape is finite and has an inside. For a plane only its own extent counts, not its half-space.
    fn checks(&self) -> Vec<Check> {
        let sound = match *self {
            Shape::Hull { ref points, ref file, scale } => {
                let few = points.len() <= Self::MAX_POINTS;
                let given = if file.is_some() { points.is_empty() } else { few && self.obstacle().is_some() };
                given && points.iter().all(|p| p.is_finite()) && above_0(scale)
            }
            Shape::Sphere { center, radius } => center.is_finite() && above_0(Some(radius)),
            Shape::Capsule { a, b, radius } => a.is_finite() && b.is_finite() && above_0(Some(radius)),
            Shape::Box { center, size, rotation } => {
                center.is_finite() && size.is_finite() && size.min_element() > 0.0 && rotation.is_finite()
            }
            Shape::Plane { point, normal } => point.is_finite() && normal.try_normalize().is_some(),
        };
        vec![check(sound, "shape", SOUND)]
    }
}
