//! Promise: input that is not finite or out of range does not panic. It is refused with an error, or strands
//! that become non-finite are reset and counted.

use crate::support::{groom, simulation};
use glam::{Quat, Vec3};
use hairspring::{
    air::{Air, Flow, Source, Turbulence, WindOcclusion},
    collide::{ColliderShape, MovingCollider},
    forces::{Manipulator, comb::Comb, grab::Grab, tie::Tie},
    material::Material,
    math::RigidTransform,
    settings::{Neighbours, OutOfRange, Solver, Volume, VolumeMethod, Wind},
    simulation::{DebugRenderMode, Simulation, StepError, StepInput},
};
use hairspring_test::{FRAME, points};

const BAD: [f32; 6] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 0.0, 1e30];

/// Hair of two strands, and its roots.
fn hair() -> (Simulation, Vec<RigidTransform>) {
    let groom = groom(2);
    let root = |s| RigidTransform { translation: groom.strand(s)[0], rotation: Quat::IDENTITY };
    (simulation(2, Material::default(), Solver::default()), (0..2).map(root).collect())
}

fn broken() -> RigidTransform {
    RigidTransform { translation: Vec3::X * f32::NAN, ..RigidTransform::default() }
}

#[test]
fn a_step_names_its_broken_input() {
    let (mut hair, roots) = hair();
    let (anchor, air) = (RigidTransform::default(), Air::default());
    let before = points(&hair);
    let input = StepInput { dt: FRAME, anchor, roots: &roots, colliders: &[], air };
    let bad_roots = [roots[0], broken()];
    let ball = ColliderShape::Sphere { center: Vec3::ZERO, radius: 0.01 };
    let colliders =
        [MovingCollider::at_rest(ball.clone(), anchor), MovingCollider::new(ball, anchor, broken())];
    let wind = Wind { velocity: Vec3::Y * f32::INFINITY, ..Wind::default() };
    for (input, error) in [
        (StepInput { roots: &roots[..1], ..input }, StepError::RootCount { roots: 1, strands: 2 }),
        (StepInput { dt: 0.0, ..input }, StepError::Dt(0.0)),
        (StepInput { dt: f32::INFINITY, ..input }, StepError::Dt(f32::INFINITY)),
        (StepInput { anchor: broken(), ..input }, StepError::Anchor),
        (StepInput { roots: &bad_roots, ..input }, StepError::Root(1)),
        (StepInput { colliders: &colliders, ..input }, StepError::Collider(1)),
        (StepInput { air: Air { wind, ..air }, ..input }, StepError::Wind),
    ] {
        assert_eq!(hair.try_step(&input), Err(error));
    }
    assert_eq!(points(&hair), before);
    assert_eq!(hair.try_step(&input).map(|report| report.reset_strands), Ok(0));
}

#[test]
fn a_step_with_numbers_that_are_not_finite_does_not_panic() {
    let bad = BAD.map(Vec3::splat);
    for (value, at) in BAD.into_iter().zip(bad) {
        let pose = RigidTransform { translation: at, ..RigidTransform::default() };
        let shapes = [
            ColliderShape::Sphere { center: at, radius: value },
            ColliderShape::Capsule { a: at, b: Vec3::ZERO, radius: value },
            ColliderShape::Cuboid { center: Vec3::ZERO, half: at, axes: glam::Mat3::from_diagonal(at) },
            ColliderShape::Plane { point: at, normal: at },
        ];
        let colliders = shapes.map(|shape| MovingCollider::new(shape, pose, RigidTransform::default()));
        let flow = Flow::Vortex { center: at, axis: at, radius: value, speed: value };
        let sources = [Source { flow, pose, factor: value }];
        let wind = Wind { velocity: at, gust: value, gust_rate: value };
        let turbulence = Turbulence { strength: value, size: value, ..Turbulence::default() };
        let air = Air { wind, sources: &sources, turbulence, ..Air::default() };
        let (mut hair, roots) = hair();
        let anchor = RigidTransform::default();
        let input = StepInput { dt: FRAME, anchor, roots: &roots, colliders: &[], air: Air::default() };
        let tools = [
            Manipulator::Grab(Grab { center: at, radius: value, pull: value, damping: value }),
            Manipulator::Comb(Comb { a: at, b: Vec3::ZERO, radius: value, grip: value, friction: value }),
            Manipulator::Tie(Tie {
                center: at,
                axis: at,
                radius: value,
                reach: value,
                gather: value,
                pull: value,
                damping: value,
            }),
        ];
        for input in [
            StepInput { anchor: pose, ..input },
            StepInput { roots: &[pose, roots[1]], ..input },
            StepInput { colliders: &colliders, ..input },
            StepInput { air, ..input },
        ] {
            hair.step(&input);
            hair.contacts(input.colliders);
            hair.measure(input.colliders);
            let lines = hair.debug_lines(&input, DebugRenderMode::ALL);
            assert!(lines.iter().all(|line| line.a.is_finite() && line.b.is_finite()));
        }
        for tool in tools {
            let id = hair.add_manipulator(tool, pose);
            hair.step(&input);
            hair.remove_manipulator(id);
        }
        // The strands are finite again.
        hair.step(&input);
        assert!(points(&hair).iter().all(|p| p.is_finite()), "{value}");
    }
}

#[test]
fn settings_out_of_range_are_refused() {
    let key = |result: Result<(), OutOfRange>| result.unwrap_err().key;
    let (mut hair, _) = hair();
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0] {
        let volume = Volume { method: VolumeMethod::Density, ..Volume::default() };
        for (wrong, name) in [
            (Volume { cell: Some(value), ..volume }, "cell"),
            (Volume { friction: value, ..volume }, "friction"),
            (Volume { pressure: value, ..volume }, "pressure"),
            (Volume { recovery_rate: value, ..volume }, "recovery_rate"),
        ] {
            assert_eq!(key(hair.set_volume(&wrong)), name, "{value}");
        }
        let neighbours = Neighbours { on: true, ..Neighbours::default() };
        for (wrong, name) in [
            (Neighbours { radius: Some(value), ..neighbours }, "radius"),
            (Neighbours { friction: value, ..neighbours }, "friction"),
            (Neighbours { stiction: value, ..neighbours }, "stiction"),
        ] {
            assert_eq!(key(hair.set_neighbours(&wrong)), name, "{value}");
        }
        let occlusion = WindOcclusion { body: value, ..WindOcclusion::default() };
        assert_eq!(key(hair.set_wind_occlusion(&occlusion)), "body", "{value}");
        // Nothing has changed.
        assert!(hair.volume().is_none() && hair.neighbours().is_none());
    }
}

#[test]
fn extreme_settings_do_not_panic() {
    for value in [0.0, 1e-30, 1e30] {
        for method in VolumeMethod::ALL {
            let (mut hair, roots) = hair();
            let volume = Volume {
                method,
                friction: value,
                pressure: value,
                recovery_rate: value,
                ..Volume::default()
            };
            hair.set_volume(&volume).unwrap();
            let cell = Some(value).filter(|cell| *cell > 0.0);
            hair.set_volume(&Volume { cell, ..volume }).unwrap();
            let neighbours =
                Neighbours { on: true, friction: value, stiction: value, ..Neighbours::default() };
            hair.set_neighbours(&Neighbours { radius: cell, ..neighbours }).unwrap();
            let reach = value.max(1e-30);
            hair.set_wind_occlusion(&WindOcclusion { body: value, hair: value, reach }).unwrap();
            let wind = Wind { velocity: Vec3::X, ..Wind::default() };
            let air = Air { wind, ..Air::default() };
            let anchor = RigidTransform::default();
            for _ in 0..3 {
                hair.step(&StepInput { dt: FRAME, anchor, roots: &roots, colliders: &[], air });
            }
        }
    }
}
