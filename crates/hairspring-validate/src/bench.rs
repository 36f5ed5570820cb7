//! The standard bench scene, shared by `hairspring bench`, the tests and the profiler: a shaken ball of hair.
//!
//! A spherical scalp of radius 0.1 m has strands of 0.25 m, evenly spread over its upper half. All strands
//! are simulated at 60 Hz and collide with the sphere, which is shaken by 5 cm at 2 Hz. Optionally the sphere
//! is the distance field of a mesh, and wind blows.

use glam::{Mat3, Vec3};
use hairspring::settings::{Solver, Wind};
use hairspring::{
    air::Air,
    collide::{ColliderPose, ColliderShape, MovingCollider, voxelize},
    groom::Groom,
    material::Material,
    math::RigidTransform,
    simulation::{Measure, Simulation, StepInput, StepReport},
};
use std::sync::Arc;

/// Radius of the scalp [m].
pub const RADIUS: f32 = 0.1;
/// Length of a strand [m].
pub const LENGTH: f32 = 0.25;
/// Duration of a frame [s].
pub const FRAME: f32 = 1.0 / 60.0;
/// Amplitude of the shake [m].
pub const AMPLITUDE: f32 = 0.05;
/// Frequency of the shake [Hz].
pub const RATE: f32 = 2.0;

/// Cells of the distance field along the scalp's diameter. This gives 5 mm, the cell of a scene's body.
const FIELD_CELLS: f32 = 40.0;

/// Quads of the scalp's mesh from pole to pole; there are twice as many around it.
const MESH_QUADS: u32 = 48;

/// The collider of the scalp.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Head {
    /// The sphere itself.
    #[default]
    Sphere,
    /// The distance field of the sphere's mesh, which is how a scene's body is represented.
    Field,
}

impl Head {
    /// All variants.
    pub const ALL: [Self; 2] = [Self::Sphere, Self::Field];

    /// Returns the name: `sphere` or `sdf`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Field => "sdf",
        }
    }

    fn shape(self) -> ColliderShape {
        match self {
            Self::Sphere => ColliderShape::Sphere { center: Vec3::ZERO, radius: RADIUS },
            Self::Field => {
                let (positions, triangles) = ball();
                ColliderShape::Field(Arc::new(voxelize(&positions, &triangles, 2.0 * RADIUS / FIELD_CELLS)))
            }
        }
    }
}

/// Returns the scalp as a mesh: rings of quads split into triangles. At the poles, two corners of each quad
/// coincide.
fn ball() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (rows, columns) = (MESH_QUADS, 2 * MESH_QUADS);
    let step = std::f32::consts::PI / rows as f32;
    let positions = (0..=rows).flat_map(|r| {
        (0..columns).map(move |c| {
            let (across, up) = (r as f32 * step).sin_cos();
            let (z, x) = (c as f32 * step).sin_cos();
            Vec3::new(across * x, up, across * z) * RADIUS
        })
    });
    let triangles = (0..rows).flat_map(|r| {
        (0..columns).flat_map(move |c| {
            let at = |r: u32, c: u32| r * columns + c % columns;
            let [a, b, d, e] = [at(r, c), at(r, c + 1), at(r + 1, c), at(r + 1, c + 1)];
            [[a, b, e], [a, e, d]]
        })
    });
    (positions.collect(), triangles.collect())
}

/// The running bench scene.
pub struct Bench {
    /// The strands.
    pub simulation: Simulation,
    /// The wind. Default: still air.
    pub wind: Wind,
    roots: Vec<Vec3>,
    poses: Vec<RigidTransform>,
    collider: MovingCollider,
    frame: u32,
}

/// Creates strands of equal length that stand out from the upper half of a sphere, evenly spread (a Fibonacci
/// spiral).
pub fn groom(strands: u32, points: u32) -> Groom {
    let golden = std::f32::consts::PI * (3.0 - 5f32.sqrt());
    Groom::from_strands(
        (0..strands).map(|s| {
            let y = 1.0 - (s as f32 + 0.5) / strands as f32;
            let r = (1.0 - y * y).sqrt();
            // Uses f64, because the angles of the last strands are large.
            let angle = (s as f64 * golden as f64) % std::f64::consts::TAU;
            let out = Vec3::new(r * angle.cos() as f32, y, r * angle.sin() as f32);
            (0..points).map(|i| out * (RADIUS + LENGTH * i as f32 / (points - 1) as f32)).collect::<Vec<_>>()
        }),
        hairspring::groom::DEFAULT_RADIUS,
    )
}

impl Bench {
    /// Creates the scene at rest with the hair standing out; `points` per strand, 3 or more.
    pub fn new(strands: u32, points: u32, solver: Solver) -> Self {
        Self::with_material(strands, points, Material::default(), solver)
    }

    /// Creates the scene with this hair material.
    pub fn with_material(strands: u32, points: u32, material: Material, solver: Solver) -> Self {
        Self::with_head(Head::Sphere, strands, points, material, solver)
    }

    /// Creates the scene with this hair material and head.
    pub fn with_head(head: Head, strands: u32, points: u32, material: Material, solver: Solver) -> Self {
        let groom = Arc::new(groom(strands, points));
        let shape = head.shape();
        let rest = (Mat3::IDENTITY, Vec3::ZERO);
        let pose = ColliderPose::new(shape.clone(), rest, rest, 1.0);
        let roots: Vec<Vec3> = (0..strands as usize).map(|s| groom.strand(s)[0]).collect();
        let all: Vec<u32> = (0..strands).collect();
        // The hair falls from standing out. No fiber could hold that shape in balance, so the sag-free start
        // is off.
        let solver = Solver { sag_free: false, ..solver };
        let simulation = Simulation::builder(groom)
            .strands(&all)
            .materials(&[material])
            .solver(solver)
            .colliders_at_rest(&[pose])
            .build()
            .unwrap();
        Self {
            simulation,
            wind: Wind::default(),
            poses: roots
                .iter()
                .map(|p| RigidTransform { translation: *p, ..RigidTransform::default() })
                .collect(),
            roots,
            collider: MovingCollider::at_rest(shape, RigidTransform::default()),
            frame: 0,
        }
    }

    /// Advances by one frame of 1/60 s.
    pub fn step(&mut self) -> StepReport {
        self.frame += 1;
        let at = |frame: u32| {
            let phase = std::f32::consts::TAU * RATE * frame as f32 * FRAME;
            RigidTransform { translation: Vec3::X * (AMPLITUDE * phase.sin()), ..RigidTransform::default() }
        };
        let (start, end) = (at(self.frame - 1), at(self.frame));
        for (pose, root) in self.poses.iter_mut().zip(&self.roots) {
            pose.translation = end.transform_point(*root);
        }
        self.collider = MovingCollider { start, end, ..self.collider.clone() };
        self.simulation.step(&StepInput {
            dt: FRAME,
            anchor: end,
            roots: &self.poses,
            colliders: std::slice::from_ref(&self.collider),
            air: Air { wind: self.wind, time: f64::from(self.frame - 1) / 60.0, ..Air::default() },
        })
    }

    /// Returns the measurements at the end of the last frame.
    pub fn measure(&self) -> Measure {
        self.simulation.measure(std::slice::from_ref(&self.collider))
    }
}

#[cfg(test)]
mod tests {
    use crate::bench::*;

    #[test]
    fn the_field_is_the_sphere() {
        let shape = Head::Field.shape();
        for k in 0..200 {
            let out = Vec3::new((k as f32).sin(), (k as f32 * 0.7).cos(), (k as f32 * 1.3).sin()).normalize();
            for at in [0.9, 1.0, 1.02] {
                let distance = shape.distance(out * (at * RADIUS));
                assert!((distance - (at - 1.0) * RADIUS).abs() < 5e-4, "{distance} at {at} radii");
            }
        }
    }
}
