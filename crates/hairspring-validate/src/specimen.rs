//! Test specimens: one strand of human hair with a controlled root.

use super::{Failure, Method};
use glam::{DQuat, DVec3, Mat3, Vec3};
use hairspring::{
    air::Air,
    collide::{ColliderPose, ColliderShape, MovingCollider},
    groom::Groom,
    material::Material,
    math::RigidTransform,
    settings::{Solver, Wind},
    simulation::{Hold, Simulation, StepInput},
};
use std::{
    f64::consts::{FRAC_PI_4, PI},
    sync::Arc,
};

/// Radius of every specimen [m]: a typical hair.
pub const RADIUS: f64 = 35e-6;

/// Default length of a specimen [m].
pub const LENGTH: f64 = 0.2;

/// Density of every specimen [kg/m³].
pub const DENSITY: f64 = 1310.0;

/// Young's modulus of human hair along the fiber [Pa].
pub const YOUNG: f64 = 3.9e9;

/// Bending stiffness EI of human hair [N m²].
pub const BENDING: f64 = YOUNG * FRAC_PI_4 * RADIUS * RADIUS * RADIUS * RADIUS;

/// Bending stiffness of a limp strand relative to that of hair [1].
///
/// It is not 0, because the equations of a strand without bending stiffness are unstable under wind or load along the
/// strand. In a wind U along the strand that is faster than its transverse waves, √(T/ρA), the strand flutters:
/// m ÿ + C (ẏ + U y′) = (T y′)′ − EI y⁗ has growing solutions for EI = 0 (Whitham 1974, *Linear and Nonlinear
/// Waves*, §3.1). From a ten-thousandth of hair's EI on it has none, for 0.25 m in 5 m/s at 256 points. Under
/// compression, a strand without EI buckles at any length.
const LIMP: f32 = 1e-3;

/// Mass of a specimen over its length, ρA [kg/m].
pub const LINE_DENSITY: f64 = DENSITY * PI * RADIUS * RADIUS;

/// Gravity [m/s²].
pub const GRAVITY: f64 = 9.81;

/// Length of a frame [s], with `Method::substeps` substeps.
const FRAME: f64 = 1.0 / 60.0;

/// Longest time in which a strand must come to rest [s].
const PATIENCE: f64 = 60.0;

/// Motion in [`WATCH`], over the strand's length, below which the strand is at rest.
const STILL: f64 = 3e-5;

/// Time for which a strand must stay at rest [s].
const WATCH: f64 = 0.5;

/// Properties and pose of a specimen.
pub struct Setup {
    /// The natural shape of the strand [m]. The first segment is held.
    pub points: Vec<Vec3>,
    /// The material; radius and density are the specimen's.
    pub material: Material,
    /// Gravity [m/s²].
    pub gravity: DVec3,
    /// Optional collider.
    pub collider: Option<ColliderShape>,
    /// Velocity of the air [m/s].
    pub wind: DVec3,
    /// Whether `points` are in balance under gravity, as those of a groom, instead of a natural shape.
    pub in_balance: bool,
}

impl Setup {
    /// A strand with [`RADIUS`], [`DENSITY`] and these properties, under [`GRAVITY`].
    fn new(points: Vec<Vec3>, material: Material) -> Self {
        Self {
            points,
            material: Material { radius: Some(RADIUS as f32), density: DENSITY as f32, ..material },
            gravity: DVec3::NEG_Y * GRAVITY,
            collider: None,
            wind: DVec3::ZERO,
            in_balance: false,
        }
    }

    /// A strand of natural shape `points` with the weight `gamma` = ρgAL³/EI under [`GRAVITY`], and `ratio` =
    /// GJ/EI.
    ///
    /// Still air brings it to rest with nearly critical damping: its drag is higher than that of a lone
    /// fiber, and it has no internal damping. Neither changes its rest position.
    pub fn heavy(points: Vec<Vec3>, gamma: f64, ratio: f64) -> Self {
        let length: f64 = points.windows(2).map(|p| p[0].as_dvec3().distance(p[1].as_dvec3())).sum();
        // Γ = ρ g πr² L³ / (E πr⁴/4), and GJ/EI = 2G/E of a round fiber.
        let young = 4.0 * DENSITY * GRAVITY * length.powi(3) / (gamma * RADIUS * RADIUS);
        let material = Material {
            young: young as f32,
            shear: (0.5 * ratio * young) as f32,
            damping: 0.0,
            drag: 2.5,
            ..Material::default()
        };
        Self::new(points, material)
    }

    /// A strand with human hair's Young's modulus and `ratio` = GJ/EI, without gravity.
    pub fn weightless(points: Vec<Vec3>, ratio: f64) -> Self {
        let mut setup = Self::heavy(points, 1.0, ratio);
        setup.gravity = DVec3::ZERO;
        setup.material.young = YOUNG as f32;
        setup.material.shear = (0.5 * ratio * YOUNG) as f32;
        setup
    }

    /// A chain: a strand without bending stiffness, damping or drag.
    pub fn chain(points: Vec<Vec3>) -> Self {
        Self::new(points, Material { bend: 0.0, damping: 0.0, drag: 0.0, ..Material::default() })
    }

    /// A chain with [`LIMP`] times the bending stiffness of hair.
    pub fn limp(points: Vec<Vec3>) -> Self {
        let mut setup = Self::chain(points);
        setup.material.bend = LIMP;
        setup
    }
}

/// Returns `n` points along a helix that starts along the unit vector `direction` and rotates by `turn` (axis
/// times angle [rad]) from end to end. It is an arc where the two are at right angles. Each segment has the
/// direction at its center; the held first one has that of the clamp.
pub fn helix(n: u32, length: f64, direction: DVec3, turn: DVec3) -> Vec<Vec3> {
    let segments = (n - 1) as f64;
    let mut at = DVec3::ZERO;
    let mut points = vec![Vec3::ZERO];
    for i in 0..n - 1 {
        let s = if i == 0 { 0.0 } else { (i as f64 + 0.5) / segments };
        at += DQuat::from_scaled_axis(turn * s) * direction * (length / segments);
        points.push(at.as_vec3());
    }
    points
}

/// Returns `n` points along a straight line.
pub fn straight(n: u32, length: f64, direction: DVec3) -> Vec<Vec3> {
    helix(n, length, direction, DVec3::ZERO)
}

/// Returns `n` points along a straight line of `length`, after a held segment as short as a follicle. For a
/// chain, only the end is thereby held.
pub fn pinned(n: u32, length: f64, held: DVec3, direction: DVec3) -> Vec<Vec3> {
    let follicle = held * (FOLLICLE * length);
    let free = |i: u32| follicle + direction * (length * i as f64 / (n - 2) as f64);
    std::iter::once(Vec3::ZERO).chain((0..n - 1).map(|i| free(i).as_vec3())).collect()
}

/// Length of the held segment of a pinned chain, over the chain's length.
pub const FOLLICLE: f64 = 1e-3;

/// A simulated strand.
pub struct Specimen {
    simulation: Simulation,
    root: RigidTransform,
    colliders: Vec<MovingCollider>,
    wind: Vec3,
    substep: f64,
    at: Vec<Vec3>,
}

impl Specimen {
    /// Sets up the strand in its natural shape and at rest.
    pub fn new(setup: Setup, method: Method) -> Self {
        let root = RigidTransform { translation: setup.points[0], ..RigidTransform::default() };
        let count = setup.points.len();
        let groom = Arc::new(Groom::from_strands([setup.points], RADIUS as f32));
        let at = groom.points.clone();
        let solver = Solver {
            sag_free: setup.in_balance,
            substeps: method.substeps,
            integrator: method.integrator,
            ..Solver::default()
        };
        let material = Material { model: method.model, ..setup.material };
        let rest = (Mat3::IDENTITY, Vec3::ZERO);
        let colliders: Vec<MovingCollider> = setup
            .collider
            .into_iter()
            .map(|shape| MovingCollider::at_rest(shape, RigidTransform::default()))
            .collect();
        let poses: Vec<ColliderPose> =
            colliders.iter().map(|o| ColliderPose::new(o.shape.clone(), rest, rest, 1.0)).collect();
        let gravity = setup.gravity.as_vec3();
        let simulation = Simulation::builder(groom)
            .strands(&[0])
            .materials(&[material])
            .solver(solver)
            .gravity(gravity)
            .colliders_at_rest(&poses)
            .build()
            .unwrap();
        debug_assert_eq!(simulation.point_count(), count);
        let (wind, substep) = (setup.wind.as_vec3(), FRAME / method.substeps as f64);
        Self { simulation, root, colliders, wind, substep, at }
    }

    /// Length of a substep [s].
    pub fn substep(&self) -> f64 {
        self.substep
    }

    /// Positions of the points [m].
    pub fn points(&self) -> &[Vec3] {
        &self.at
    }

    /// Vector from the root to the free end [m].
    pub fn tip(&self) -> DVec3 {
        self.at[self.at.len() - 1].as_dvec3() - self.at[0].as_dvec3()
    }

    /// Speed of the fastest point [m/s].
    pub fn fastest(&self) -> f64 {
        self.simulation.measure(&self.colliders).speed_max
    }

    /// Contact force of the collider on the strand [N].
    pub fn contact_force(&self) -> f64 {
        self.simulation.contacts(&self.colliders).force
    }

    /// Holds or loads these points from now on, and releases all others.
    pub fn hold(&mut self, holds: &[Hold]) {
        self.simulation.set_holds(holds);
    }

    /// Rotates the root by `turn` (axis times angle [rad]) in its next step.
    pub fn turn_root(&mut self, turn: DVec3) {
        let turn = DQuat::from_scaled_axis(turn) * self.root.rotation.as_dquat();
        self.root.rotation = turn.normalize().as_quat();
    }

    /// Advances by one frame.
    pub fn frame(&mut self) -> Result<(), Failure> {
        self.advance(FRAME)
    }

    /// Advances by one substep, with the root at `root` [m] at its end.
    pub fn small_step(&mut self, root: DVec3) -> Result<(), Failure> {
        self.root.translation = root.as_vec3();
        self.advance(self.substep)
    }

    fn advance(&mut self, dt: f64) -> Result<(), Failure> {
        let report = self.simulation.step(&StepInput {
            dt: dt as f32,
            anchor: RigidTransform::default(),
            roots: &[self.root],
            colliders: &self.colliders,
            air: Air { wind: Wind { velocity: self.wind, ..Wind::default() }, ..Air::default() },
        });
        if report.reset_strands > 0 {
            return Err(Failure::NotFinite);
        }
        self.simulation.write_points(&mut self.at);
        Ok(())
    }

    /// Advances until the strand is at rest. Returns the positions of its points relative to the root [m].
    ///
    /// The mean over an interval is compared with the mean over the interval before, because positions in f32
    /// fluctuate by some 10⁻⁵ of the length without motion.
    pub fn settle(&mut self) -> Result<Vec<DVec3>, Failure> {
        let length: f64 = self.at.windows(2).map(|p| p[0].distance(p[1]) as f64).sum();
        self.settle_within(STILL * length)
    }

    /// The same, where all points stay within `still` [m].
    pub fn settle_within(&mut self, still: f64) -> Result<Vec<DVec3>, Failure> {
        let moved = |a: &[DVec3], b: &[DVec3]| {
            a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) < still
        };
        self.settle_where(moved)
    }

    /// Advances until the means of two consecutive intervals are alike. Returns the last one, relative to the
    /// root [m].
    pub fn settle_where(
        &mut self,
        alike: impl Fn(&[DVec3], &[DVec3]) -> bool,
    ) -> Result<Vec<DVec3>, Failure> {
        let frames = (WATCH / FRAME).round() as u32;
        let mut before: Option<Vec<DVec3>> = None;
        for _ in 0..(PATIENCE / WATCH) as u32 {
            let mut mean = vec![DVec3::ZERO; self.at.len()];
            for _ in 0..frames {
                self.frame()?;
                let root = self.at[0].as_dvec3();
                mean.iter_mut().zip(&self.at).for_each(|(m, p)| *m += (p.as_dvec3() - root) / frames as f64);
            }
            if before.is_some_and(|before| alike(&before, &mean)) {
                return Ok(mean);
            }
            before = Some(mean);
        }
        Err(Failure::NotAtRest)
    }
}
