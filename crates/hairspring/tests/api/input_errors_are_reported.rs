//! Promise: input that is not finite or out of range does not panic. It is refused with an error, or strands
//! that become non-finite are reset and counted.

use crate::support::{groom, simulation};
use glam::{Quat, Vec3};
use hairspring::{
    air::{Air, Flow, Source, Turbulence, WindOcclusion},
    body::Mesh,
    collide::{ColliderShape, MovingCollider},
    follow::{Follow, assign_guides},
    forces::{Manipulator, comb::Comb, grab::Grab, tie::Tie},
    groom::{Groom, GuideWeights, bind_roots, cut},
    material::Material,
    math::RigidTransform,
    settings::{Effects, Neighbours, OutOfRange, Solver, Volume, VolumeMethod, Wind},
    simulation::{DebugRenderMode, Simulation, StepError, StepInput},
};
use hairspring_test::{FRAME, points};
use std::sync::Arc;

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
    for shape in broken_shapes() {
        let colliders =
            [colliders[0].clone(), MovingCollider::at_rest(shape.clone(), RigidTransform::default())];
        let input = StepInput { colliders: &colliders, ..input };
        assert_eq!(hair.try_step(&input), Err(StepError::Shape(1)), "{shape:?}");
    }
    for (broken, error) in broken_air() {
        let input = StepInput { air: broken, ..input };
        assert_eq!(hair.try_step(&input), Err(error));
    }
    for source in broken_sources() {
        let sources = [source];
        let input = StepInput { air: Air { sources: &sources, ..air }, ..input };
        assert_eq!(hair.try_step(&input), Err(StepError::Source(0)), "{source:?}");
    }
    assert_eq!(points(&hair), before);
    assert_eq!(hair.try_step(&input).map(|report| report.reset_strands), Ok(0));
}

/// Shapes with one number that is not finite.
fn broken_shapes() -> Vec<ColliderShape> {
    let (zero, bad, axes) = (Vec3::ZERO, Vec3::X * f32::NAN, glam::Mat3::IDENTITY);
    vec![
        ColliderShape::Sphere { center: bad, radius: 0.01 },
        ColliderShape::Sphere { center: zero, radius: f32::NAN },
        ColliderShape::Capsule { a: zero, b: bad, radius: 0.01 },
        ColliderShape::Capsule { a: zero, b: Vec3::X, radius: f32::INFINITY },
        ColliderShape::Cuboid { center: zero, half: bad, axes },
        ColliderShape::Plane { point: zero, normal: bad },
    ]
}

/// Moving air with one number that is not finite. Times are infinite, because NaN does not equal itself.
fn broken_air() -> Vec<(Air<'static>, StepError)> {
    let (wind, turbulence) = (Wind::default(), Turbulence::default());
    let with = |wind| Air { wind, ..Air::default() };
    let stirred = |turbulence| Air { turbulence, ..Air::default() };
    vec![
        (with(Wind { gust: f32::NAN, ..wind }), StepError::Wind),
        (with(Wind { gust_rate: f32::INFINITY, ..wind }), StepError::Wind),
        (Air { time: f64::INFINITY, ..Air::default() }, StepError::Time(f64::INFINITY)),
        (stirred(Turbulence { strength: f32::NAN, ..turbulence }), StepError::Turbulence),
        (stirred(Turbulence { size: f32::NAN, ..turbulence }), StepError::Turbulence),
    ]
}

/// Wind sources with one number that is not finite.
fn broken_sources() -> Vec<Source> {
    let (center, axis, bad) = (Vec3::ZERO, Vec3::X, Vec3::X * f32::NAN);
    let pose = RigidTransform::default();
    let of = |flow| Source { flow, pose, factor: 1.0 };
    let flow = Flow::Point { center, radius: 0.1, speed: 1.0 };
    vec![
        of(Flow::Point { center: bad, radius: 0.1, speed: 1.0 }),
        of(Flow::Vortex { center, axis: bad, radius: 0.1, speed: 1.0 }),
        of(Flow::Fan { center, axis, radius: 0.1, speed: 1.0, spread: f32::NAN }),
        of(Flow::Point { center, radius: 0.1, speed: f32::INFINITY }),
        Source { flow, pose: broken(), factor: 1.0 },
        Source { flow, pose, factor: f32::NAN },
    ]
}

#[test]
fn numbers_of_hairs_must_be_above_0() {
    for wrong in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let set = || hair().0.set_hair_multiplicity(vec![3.0, wrong]);
        assert!(std::panic::catch_unwind(set).is_err(), "{wrong}");
    }
    hair().0.set_hair_multiplicity(vec![3.0, 0.5]);
}

#[test]
fn one_broken_root_leaves_the_other_strands_bound_and_all_with_guides() {
    for value in [f32::NAN, f32::INFINITY, 1e38] {
        let mut broken = groom(6);
        broken.points[16] = Vec3::splat(value);
        for weights in assign_guides(&broken, &[0, 3, 5]) {
            assert!((weights.weights.iter().sum::<f32>() - 1.0).abs() < 1e-5, "{value}: {weights:?}");
        }
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Z];
        let mesh = Mesh { positions, triangles: vec![[0, 2, 1]], ..Mesh::default() };
        bind_roots(&mut broken, &mesh);
        let mut whole = groom(6);
        bind_roots(&mut whole, &mesh);
        let bound = broken.roots[1];
        assert!(bound.barycentric.is_finite() && bound.offset.is_finite(), "{value}: {bound:?}");
        for s in [0, 2, 3, 4, 5] {
            assert_eq!(broken.roots[s], whole.roots[s], "{value}");
        }
    }
}

#[test]
fn strands_without_a_length_are_not_cut() {
    let mut short = Groom::from_strands([&[][..], &[Vec3::X], &[Vec3::ZERO, Vec3::Y]], 40e-6);
    cut(&mut short, &[0.5; 3]);
    assert_eq!(short.points, [Vec3::X, Vec3::ZERO, Vec3::Y * 0.5]);
}

#[test]
fn weights_of_guides_are_normalized_or_refused() {
    let rest = Arc::new(groom(2));
    let place = |weights| {
        let weights = [GuideWeights { guides: [0; 3], weights }; 2];
        let mut follow = Follow::new(rest.clone(), &[0], &weights, Effects::default(), &[]);
        follow.update_guide_transforms(rest.strand(0), &[Quat::IDENTITY]);
        let mut points = vec![Vec3::ZERO; 32];
        follow.interpolation(rest.strand(0), &[]).place(&mut points);
        points
    };
    for weights in [[1.0, 0.0, 0.0], [2.0, 1.0, 1.0], [0.0; 3]] {
        let far = place(weights).iter().zip(&rest.points).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(far < 1e-5, "{weights:?}: {far} m");
    }
    for weights in [[f32::NAN, 0.0, 0.0], [2.0, -1.0, 0.0], [f32::INFINITY; 3]] {
        assert!(std::panic::catch_unwind(|| place(weights)).is_err(), "{weights:?}");
    }
    let point = Arc::new(Groom::from_strands([[Vec3::ZERO]], 40e-6));
    let one = [GuideWeights { guides: [0; 3], weights: [1.0, 0.0, 0.0] }];
    let of_a_point = || Follow::new(point.clone(), &[0], &one, Effects::default(), &[]);
    assert!(std::panic::catch_unwind(of_a_point).is_err());
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
            let radius = Some(value).filter(|radius| *radius > 0.0);
            let cell = radius.filter(|cell| *cell <= 1.0);
            hair.set_volume(&Volume { cell, ..volume }).unwrap();
            let neighbours =
                Neighbours { on: true, friction: value, stiction: value, ..Neighbours::default() };
            hair.set_neighbours(&Neighbours { radius, ..neighbours }).unwrap();
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
