//! The object that the pointer pushes through hair, a sphere or a hand: its colliders and its mesh.

use glam::Vec3;
use hairspring::{
    body::{Mesh, Part},
    collide::ColliderShape,
    math::RigidTransform,
};
use hairspring_scene::builtin::{Hand, hand};
use hairspring_view::MeshDraw;
use std::{f32::consts::PI, sync::LazyLock};

/// Vertices of the sphere from pole to pole, and around.
const ROWS: u32 = 24;
const COLUMNS: u32 = 48;

/// A pushed object in its own space: the sphere around the origin, the hand as in [`hand`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pushed {
    /// A sphere of this radius [m].
    Ball(f32),
    /// An open hand of this length [m].
    Hand(f32),
}

/// A sphere of radius 1.
static BALL: LazyLock<Mesh> = LazyLock::new(|| {
    let corner = |k: u32| {
        let (row, column) = (k / COLUMNS, k % COLUMNS);
        let (down, around) = (PI * row as f32 / ROWS as f32, 2.0 * PI * column as f32 / COLUMNS as f32);
        Vec3::new(down.sin() * around.sin(), down.cos(), down.sin() * around.cos())
    };
    let square = |k: u32| {
        let (row, column) = (k / COLUMNS, k % COLUMNS);
        let at = |down: u32, right: u32| (row + down) * COLUMNS + (column + right) % COLUMNS;
        [[at(0, 0), at(1, 0), at(1, 1)], [at(0, 0), at(1, 1), at(0, 1)]]
    };
    let triangles: Vec<_> = (0..ROWS * COLUMNS).flat_map(square).collect();
    // Pale and matte, so that hair is visible in front of it.
    let (color, all) = (Vec3::new(0.5, 0.52, 0.55), 0..triangles.len() as u32);
    let parts = vec![Part { name: "ball".into(), triangles: all, color, roughness: 0.6 }];
    let corners: Vec<Vec3> = (0..(ROWS + 1) * COLUMNS).map(corner).collect();
    Mesh { normals: corners.clone(), positions: corners, triangles, parts, ..Mesh::default() }
});

/// A hand of natural size.
static HAND: LazyLock<Hand> = LazyLock::new(|| hand(Hand::CELL));

impl Pushed {
    /// The mesh at its natural size, and the scale factor.
    fn made(self) -> (&'static Mesh, f32) {
        match self {
            Self::Ball(radius) => (&BALL, radius),
            Self::Hand(length) => (&HAND.mesh, length / Hand::LENGTH),
        }
    }

    /// The colliders of the object.
    pub fn shapes(self) -> Vec<ColliderShape> {
        match self {
            Self::Ball(radius) => vec![ColliderShape::Sphere { center: Vec3::ZERO, radius }],
            Self::Hand(_) => {
                let scale = self.made().1;
                let capsule = |(a, b, radius): &(Vec3, Vec3, f32)| ColliderShape::Capsule {
                    a: *a * scale,
                    b: *b * scale,
                    radius: radius * scale,
                };
                HAND.capsules.iter().map(capsule).collect()
            }
        }
    }

    /// The mesh with its space at `pose`, for drawing.
    pub fn placed(self, pose: RigidTransform) -> Placed {
        let (mesh, scale) = self.made();
        Placed {
            mesh,
            positions: mesh.positions.iter().map(|p| pose.transform_point(*p * scale)).collect(),
            normals: mesh.normals.iter().map(|n| pose.rotation * *n).collect(),
        }
    }
}

/// A pushed object at a pose.
pub struct Placed {
    mesh: &'static Mesh,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
}

impl Placed {
    /// The mesh to draw.
    pub fn mesh(&self) -> MeshDraw<'_> {
        MeshDraw {
            positions: &self.positions,
            normals: &self.normals,
            triangles: &self.mesh.triangles,
            parts: &self.mesh.parts,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;

    #[test]
    fn the_triangles_of_the_ball_face_outward_and_enclose_its_volume() {
        let place = RigidTransform { translation: Vec3::X, ..RigidTransform::default() };
        let ball = Pushed::Ball(0.5).placed(place);
        let mut volume = 0.0;
        for t in &ball.mesh.triangles {
            let [a, b, c] = t.map(|i| ball.positions[i as usize] - Vec3::X);
            volume += a.dot(b.cross(c)) / 6.0;
        }
        let round = 4.0 / 3.0 * PI * 0.125;
        assert!(volume > 0.98 * round && volume < round, "{volume} of {round}");
    }

    #[test]
    fn drawn_surface_lies_on_the_colliders() {
        let pose =
            RigidTransform { rotation: Quat::from_rotation_x(1.0), translation: Vec3::new(0.3, -0.2, 1.0) };
        for pushed in [Pushed::Ball(0.02), Pushed::Ball(2.0), Pushed::Hand(0.019), Pushed::Hand(1.9)] {
            let (scale, shapes) = (pushed.made().1, pushed.shapes());
            let most = if let Pushed::Hand(_) = pushed { 4e-3 * scale } else { 1e-5 * scale };
            for p in &pushed.placed(pose).positions {
                let p = pose.inverse_transform_point(*p);
                let off = shapes.iter().map(|s| s.distance(p)).fold(f32::MAX, f32::min);
                assert!(off.abs() < most, "{pushed:?}: {off} m");
            }
        }
    }
}
