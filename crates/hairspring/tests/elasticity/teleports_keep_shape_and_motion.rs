//! Promise: hair follows its head through every kind of motion.
//!
//! A teleport preserves shape and motion: hair then moves as it would have without the teleport, at the new
//! place. A head that jumps is teleported automatically, and its colliders do not sweep through the hair.
//! Inertia scales how much of the head's motion hair feels, down to none. A reset restores the start, bit
//! for bit.

use glam::{Quat, Vec3};
use hairspring::{
    collide::{ColliderShape, MovingCollider},
    groom::Groom,
    material::{Material, Model},
    math::RigidTransform,
    settings::{Integrator, Solver, Volume, VolumeMethod},
    simulation::Simulation,
};
use hairspring_test::{FRAME, REST, farthest, points, roots, step, translation};
use std::sync::Arc;

/// Radius of the head [m].
const HEAD: f32 = 0.09;
const POINTS: usize = 16;

/// Curved strands of 20 cm around a head.
fn groom() -> Groom {
    Groom::from_strands(
        (0..24).map(|k| {
            let rotation_of_strand = Quat::from_rotation_y(k as f32 * 0.7);
            let out = rotation_of_strand * Vec3::new(0.8, 0.6, 0.0);
            (0..POINTS)
                .map(|i| {
                    let s = i as f32 / (POINTS - 1) as f32;
                    out * (HEAD + 0.2 * s) - Vec3::Y * (0.1 * s * s)
                })
                .collect::<Vec<_>>()
        }),
        35e-6,
    )
}

/// A head with its hair.
struct Head {
    groom: Arc<Groom>,
    simulation: Simulation,
    pose: RigidTransform,
}

impl Head {
    fn new(model: Model, solver: Solver, volume: VolumeMethod) -> Self {
        let groom = Arc::new(groom());
        let mut simulation = Simulation::builder(groom.clone())
            .materials(&[Material { model, drag: 0.1, ..Material::default() }])
            .solver(solver)
            .colliders_at_rest(&[MovingCollider::at_rest(ball(), REST).end_pose()])
            .build()
            .unwrap();
        simulation.set_volume(&Volume { method: volume, ..Volume::default() }).unwrap();
        Self { groom, simulation, pose: REST }
    }

    /// Simulates a frame in which the head moves to `pose`.
    fn step(&mut self, pose: RigidTransform) {
        let collider = MovingCollider::new(ball(), self.pose, pose);
        step(&mut self.simulation, pose, &roots(&self.groom, pose), &[collider]);
        self.pose = pose;
    }

    /// The points in the frame of the head [m].
    fn local_points(&self) -> Vec<Vec3> {
        points(&self.simulation).iter().map(|p| self.pose.inverse_transform_point(*p)).collect()
    }
}

fn ball() -> ColliderShape {
    ColliderShape::Sphere { center: Vec3::ZERO, radius: HEAD }
}

/// A head that sways by 10 cm and turns, as in a walk.
fn sway(frame: u32) -> RigidTransform {
    let t = frame as f32 * FRAME;
    RigidTransform {
        translation: Vec3::new(0.05 * (9.0 * t).sin(), 0.02 * (5.0 * t).sin(), 0.6 * t),
        rotation: Quat::from_rotation_y(0.5 * (7.0 * t).sin()),
    }
}

/// A rotation about the vertical, which does not change the effect of gravity.
fn other_place() -> RigidTransform {
    RigidTransform { rotation: Quat::from_rotation_y(2.0), translation: Vec3::new(5.0, 1.0, -3.0) }
}

const CASES: [(Model, Integrator, VolumeMethod); 5] = [
    (Model::Rod, Integrator::BackwardEuler, VolumeMethod::Off),
    (Model::Rod, Integrator::Bdf2, VolumeMethod::Off),
    (Model::Curvature, Integrator::BackwardEuler, VolumeMethod::Incompressible),
    (Model::Springs, Integrator::BackwardEuler, VolumeMethod::Density),
    (Model::Rod, Integrator::Dftl, VolumeMethod::Off),
];

#[test]
fn motion_continues_after_a_teleport() {
    for (model, integrator, volume) in CASES {
        let solver = Solver { integrator, ..Solver::default() };
        let [mut here, mut there] = [0; 2].map(|_| Head::new(model, solver, volume));
        let mut moved = REST;
        for frame in 1..60 {
            if frame == 30 {
                moved = other_place();
                there.simulation.teleport(moved);
                there.pose = moved * there.pose;
            }
            here.step(sway(frame));
            there.step(moved * sway(frame));
        }
        // Rounding changes hair that makes and breaks contact by less than 0.1 mm in half a second.
        let difference = farthest(&here.local_points(), &there.local_points());
        assert!(difference < 1e-4, "{model:?}, {integrator:?}, {volume:?}: hair differs by {difference} m");
    }
}

#[test]
fn a_jump_is_teleported_automatically() {
    for (model, integrator, volume) in CASES {
        let solver = Solver { integrator, ..Solver::default() };
        let [mut here, mut there] = [0; 2].map(|_| Head::new(model, solver, volume));
        for frame in 1..30 {
            here.step(sway(frame));
            there.step(sway(frame));
        }
        // Hair continues to swing, as if the head had stopped.
        here.step(sway(29));
        there.step(other_place() * sway(29));
        let difference = farthest(&here.local_points(), &there.local_points());
        assert!(difference < 1e-4, "{model:?}, {integrator:?}, {volume:?}: {difference} m in the jump");
    }
}

#[test]
fn fast_motion_is_not_mistaken_for_a_jump() {
    // A ride at 50 m/s and 24 frames per second moves by 2 m in a frame. It starts in one frame, and only
    // in that frame is hair carried along; afterward hair feels the motion.
    let [mut carried, mut felt] = [1.0, f32::MAX].map(|jump| {
        Head::new(Model::Rod, Solver { teleport_distance: jump, ..Solver::default() }, VolumeMethod::Off)
    });
    let ride = |frame: u32| translation(Vec3::Z * (50.0 / 24.0 * frame as f32));
    for head in [&mut carried, &mut felt] {
        head.step(ride(1));
    }
    assert!(
        farthest(&carried.local_points(), &felt.local_points()) > 0.05,
        "hair was not carried along in the jump"
    );
    let swaying = |frame: u32| ride(frame) * sway(frame);
    for frame in 2..120 {
        carried.step(swaying(frame));
        felt.step(swaying(frame));
    }
    // After the other head's hair has settled from the start, both sway alike.
    let most = farthest(&carried.local_points(), &felt.local_points());
    assert!(most < 0.02, "the two heads differ by {most} m");
}

#[test]
fn inertia_scales_the_effect_of_head_motion() {
    let swing = |inertia: f32| {
        let mut head = Head::new(Model::Rod, Solver { inertia, ..Solver::default() }, VolumeMethod::Off);
        let rest = head.local_points();
        let mut most = 0.0f32;
        for frame in 1..120 {
            let t = frame as f32 * FRAME;
            // A small motion, so that the response of hair is linear.
            head.step(translation(Vec3::X * (0.004 * (8.0 * t).sin())));
            most = most.max(farthest(&rest, &head.local_points()));
        }
        most
    };
    let [none, half, all] = [0.0, 0.5, 1.0].map(swing);
    assert!(none < 2e-5, "without inertia hair moved by {none} m on the head");
    assert!((half / all - 0.5).abs() < 0.1, "half: {half} m of {all} m");
    // The same holds for a rotation.
    let mut head = Head::new(Model::Rod, Solver { inertia: 0.0, ..Solver::default() }, VolumeMethod::Off);
    let rest = head.local_points();
    for frame in 1..60 {
        head.step(RigidTransform { rotation: Quat::from_rotation_y(0.1 * frame as f32), ..REST });
    }
    let turned = farthest(&rest, &head.local_points());
    assert!(turned < 1e-4, "{turned} m after turning");
}

#[test]
fn a_reset_restores_the_start() {
    for (model, integrator, volume) in CASES {
        let solver = Solver { integrator, ..Solver::default() };
        let mut head = Head::new(model, solver, volume);
        let roots = roots(&head.groom, REST);
        let run = |head: &mut Head| {
            head.simulation.place(REST, &roots);
            head.pose = REST;
            (1..30).for_each(|frame| head.step(sway(frame)));
            head.local_points()
        };
        let [first, again] = [run(&mut head), run(&mut head)];
        assert!(
            first == again,
            "{model:?}, {integrator:?}, {volume:?}: the second run differs by {} m",
            farthest(&first, &again)
        );
        // A reset without new poses puts every strand in its authored place.
        head.simulation.reset();
        let authored = farthest(&head.local_points(), &head.groom.points);
        assert!(
            authored < 1e-6,
            "{model:?}, {integrator:?}: points are {authored} m from their authored place"
        );
    }
}
