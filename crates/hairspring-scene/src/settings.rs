//! Colliders of a scene. A field's default applies if a file omits it.

use glam::{Mat3, Vec3};
use hairspring::{
    collide::{ColliderShape, Hull},
    settings::{Check, Validate, check, define_settings},
};
use std::{path::PathBuf, sync::Arc};

define_settings! {
    /// What happens to hair that is authored inside a collider.
    choice InitialContact {
        /// Hair may stay as deep as it is authored. The collider never pushes it out.
        #[default]
        Keep = "keep",
        /// The collider pushes hair out before the scene begins. A shape grows to its size inside the hair. A sheet
        /// closes in on the hair from outside, so that hair that passed through it lies under it.
        Push = "push",
    }
}

define_settings! {
    /// A simple shape that hair collides with.
    #[derive(Clone, Debug, PartialEq)]
    entry struct Collider {
        /// Name of the body joint that moves the collider.
        #[serde(default)]
        joint: Option<String>, "none", {text "the name of a joint of the body"}, default "the body's first";
        /// What happens to hair that is inside the collider before the scene begins. `keep`: it may stay as deep as it
        /// is. `push`: it is pushed out in a pre-roll of two seconds, or of `solver.preroll` if that is longer.
        #[serde(default)]
        initial: InitialContact = InitialContact::Keep, "none", {words};
        /// The shape, in the space of the body's rest pose [m].
        shape: Shape, "none", {table};
    }
}

define_settings! {
    /// The shapes of a [`Collider`].
    #[derive(Clone, Debug, PartialEq)]
    entry enum Shape {
        /// A sphere.
        Sphere = "sphere" {
            /// Center of the sphere.
            center: Vec3, ["m"], {vector};
            /// Radius of the sphere.
            radius: f32, ["m"], {above 0};
        }
        /// All points nearer than `radius` to the segment from `a` to `b`.
        Capsule = "capsule" {
            /// One end of the axis.
            a: Vec3, ["m"], {vector};
            /// The other end of the axis.
            b: Vec3, ["m"], {vector};
            /// Radius around the axis.
            radius: f32, ["m"], {above 0};
        }
        /// A box.
        Box = "box" {
            /// Center of the box.
            center: Vec3, ["m"], {vector};
            /// Lengths of the edges of the box.
            size: Vec3, ["m"], {vector above 0};
            /// Rotation of the box about X, then Y, then Z.
            #[serde(default)]
            rotation: Vec3 = Vec3::ZERO, ["degrees"], {vector};
        }
        /// A half-space, on the side of a plane that `normal` points away from: a floor, a wall, a slope.
        Plane = "plane" {
            /// A point on the plane.
            point: Vec3, ["m"], {vector};
            /// Direction out of the solid.
            normal: Vec3, "direction", {direction};
        }
        /// The convex hull of points: a shoulder, a stone, a brush.
        Hull = "hull" {
            /// Points of the hull.
            #[serde(default)]
            points: Vec<Vec3>, ["m"], {text "4 to 2048 that span a volume"}, default "the vertices of `file`";
            /// A mesh file. The scene reader replaces `points` with its vertices; this crate does not open it.
            #[serde(default)]
            file: Option<PathBuf>, "none", {text "a mesh: `.glb`, `.gltf`, `.vrm`, `.obj` or `.tfxmesh`"}, default "the `points`";
            /// Size of one unit of `file`.
            #[serde(default)]
            scale: Option<f32>, ["m"], {above 0}, default "from the format, or guessed and reported";
        }
    }
}

impl Shape {
    /// Maximum number of points of a hull: the cost of making it grows with the square of their number.
    pub const MAX_POINTS: usize = 2048;

    /// Returns the shape with its surface moved inward by `depth` [m], 0 or more. If the shape is thinner than that,
    /// almost nothing is left of it.
    pub fn shrunk(&self, depth: f32) -> Self {
        let rest = |size: f32, depth: f32| (size - depth).max(1e-6 * size);
        match *self {
            Self::Sphere { center, radius } => Self::Sphere { center, radius: rest(radius, depth) },
            Self::Capsule { a, b, radius } => Self::Capsule { a, b, radius: rest(radius, depth) },
            Self::Box { center, size, rotation } => {
                let size = Vec3::from(size.to_array().map(|edge| rest(edge, 2.0 * depth)));
                Self::Box { center, size, rotation }
            }
            Self::Plane { point, normal } => {
                Self::Plane { point: point - normal.normalize_or(Vec3::Y) * depth, normal }
            }
            Self::Hull { ref points, .. } => {
                // Each face moves inward by at least `depth`, because none is nearer to the center.
                let hull = Hull::new(points);
                let Some((center, half)) = hull.map(|hull| {
                    let center = points.iter().sum::<Vec3>() / points.len() as f32;
                    (center, -hull.distance_and_normal(center).0)
                }) else {
                    return self.clone();
                };
                let points =
                    points.iter().map(|p| center + (*p - center) * (rest(half, depth) / half)).collect();
                Self::Hull { points, file: None, scale: None }
            }
        }
    }

    /// Returns the collider shape; `None` for a hull whose points span no volume.
    pub fn collider_shape(&self) -> Option<ColliderShape> {
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

impl Validate for Shape {
    /// The fields are in range, and the shape has an inside. For a plane only its own extent counts, not its
    /// half-space.
    fn checks(&self) -> Vec<Check> {
        let mut checks = self.range_checks();
        if let Self::Hull { points, file, .. } = self {
            let few = points.len() <= Self::MAX_POINTS;
            let finite = few && points.iter().all(|p| p.is_finite());
            let spans =
                if file.is_some() { points.is_empty() } else { finite && self.collider_shape().is_some() };
            checks.push(check(
                spans,
                "hull",
                "given at most 2048 `points` that span a volume, or a `file` of them",
            ));
        }
        checks
    }
}
