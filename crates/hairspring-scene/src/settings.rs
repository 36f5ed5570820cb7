//! Settings of a scene that both code and scene files set; each field's default is the value that a file may leave out.

use glam::{Mat3, Vec3};
use hairspring::collide::{ColliderShape, Hull};
use serde::{Deserialize, Serialize};
use std::{path::PathBuf, sync::Arc};

/// Which strands of a groom are simulated; the others follow them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Guides {
    /// The strands that the groom file names as guides; 2,000 chosen ones where it names none. The default.
    #[default]
    FromGroom,
    /// So many strands, spread over the scalp per group.
    Count(u32),
    /// Every strand.
    All,
}

/// A simple shape that hair collides with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Collider {
    /// Name of the body's joint that moves it; `None`: joint 0, or fixed without a body.
    #[serde(default)]
    pub joint: Option<String>,
    /// The shape, in the space of the body's rest pose [m].
    pub shape: Shape,
}

/// The shapes of a [`Collider`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Shape {
    /// A ball.
    Sphere {
        /// Middle [m].
        center: Vec3,
        /// Radius [m], above 0.
        radius: f32,
    },
    /// All places nearer than `radius` to the line from `a` to `b`.
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
        /// Middle [m].
        center: Vec3,
        /// Lengths of its edges [m], above 0.
        size: Vec3,
        /// How it is turned: about X, then Y, then Z [degrees]. Default 0.
        #[serde(default)]
        rotation: Vec3,
    },
    /// All of space on the side of a plane that `normal` points away from: a floor, a wall, a slope.
    Plane {
        /// A point of the plane [m].
        point: Vec3,
        /// Direction out of the solid, of any length above 0.
        normal: Vec3,
    },
    /// The convex hull of points: a shoulder, a stone, a brush.
    Hull {
        /// Points that span it [m], four or more. Default: the vertices of `file`.
        #[serde(default)]
        points: Vec<Vec3>,
        /// A mesh file whose vertices a reader of scene files puts in place of `points`; nothing here opens it.
        #[serde(default)]
        file: Option<PathBuf>,
        /// Metres in one unit of `file` [m], above 0. Default: by the format, or guessed and said.
        #[serde(default)]
        scale: Option<f32>,
    },
}

impl Shape {
    /// The collider of this shape; `None` for the hull of points that span no volume.
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
