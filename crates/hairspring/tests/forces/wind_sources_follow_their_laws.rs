//! Promise: a wind source follows its law and blows nowhere else. Bodies and hair shelter what is behind
//! them. Hair out of reach keeps its bits.
//!
//! Laws are tested by their conserved quantity: the momentum of a fan's jet, the volume flow of a point
//! source. Sheltered hair is compared with the same hair in the open.

use glam::{Quat, Vec3};
use hairspring::{
    air::{Air, Flow, Source, Turbulence, WindOcclusion},
    collide::{ColliderPose, ColliderShape, MovingCollider},
    groom::Groom,
    math::RigidTransform,
    settings::Wind,
    simulation::{Simulation, StepInput},
};
use hairspring_test::{FRAME, REST, line, on_threads, points, roots};
use std::{f32::consts::PI, sync::Arc};

const FAN: Flow = Flow::Fan { center: Vec3::ZERO, axis: Vec3::Z, radius: 0.1, speed: 4.0, spread: 11.8 };

/// A source at rest, without gusts.
fn still(flow: Flow) -> Source {
    Source { flow, pose: REST, factor: 1.0 }
}

/// The integral of `f` over a disc of `radius` across the z axis at `z`.
fn over_disc(radius: f32, z: f32, f: impl Fn(Vec3) -> f32) -> f32 {
    let rings = 4000;
    let width = radius / rings as f32;
    (0..rings).map(|k| (k as f32 + 0.5) * width).map(|r| f(Vec3::new(r, 0.0, z)) * 2.0 * PI * r * width).sum()
}

#[test]
fn a_fan_conserves_momentum_and_blows_only_forward() {
    for x in [0.0, 0.03, 0.055] {
        assert_eq!(FAN.velocity(Vec3::new(x, 0.0, 0.0)), Vec3::Z * 4.0);
    }
    for behind in [Vec3::new(0.0, 0.0, -0.001), Vec3::new(0.05, 0.02, -1.0)] {
        assert_eq!(FAN.velocity(behind), Vec3::ZERO);
    }
    assert!(FAN.velocity(Vec3::new(0.3, 0.0, 0.05)).length() < 0.01, "the air beside the jet moves");
    // Beyond the core of the jet.
    for z in [0.5, 1.0, 3.0] {
        let momentum = over_disc(4.0, z, |p| FAN.velocity(p).length_squared());
        let mouth = 16.0 * PI * 0.01;
        assert!((momentum / mouth - 1.0).abs() < 1e-3, "{momentum} of {mouth} at {z} m");
    }
    let turned = Source {
        flow: FAN,
        pose: RigidTransform { rotation: Quat::from_rotation_y(PI / 2.0), translation: Vec3::Y },
        factor: 0.5,
    };
    assert!(turned.velocity(Vec3::new(0.2, 1.0, 0.0)).distance(Vec3::X * 2.0) < 1e-5);
}

#[test]
fn a_point_conserves_volume_and_a_vortex_rotates() {
    let point = |speed: f32| Flow::Point { center: Vec3::X, radius: 0.05, speed };
    let way = Vec3::new(0.6, -0.8, 0.0);
    for r in [0.05_f32, 0.1, 2.0] {
        let v = point(3.0).velocity(Vec3::X + way * r);
        assert!((v.dot(way) * r * r / (3.0 * 0.05 * 0.05) - 1.0).abs() < 1e-5, "{v} at {r} m");
        assert_eq!(point(-3.0).velocity(Vec3::X + way * r), -v);
    }
    assert_eq!(point(3.0).velocity(Vec3::X), Vec3::ZERO);
    let vortex = Flow::Vortex { center: Vec3::ZERO, axis: Vec3::Y * 7.0, radius: 0.2, speed: 2.0 };
    let at = |r: f32| vortex.velocity(Vec3::new(r, 3.0, 0.0));
    assert!(at(0.2).distance(Vec3::NEG_Z * 2.0) < 1e-5, "the velocity at the radius is {}", at(0.2));
    assert!(at(0.19).length() < 2.0 && at(0.21).length() < 2.0 && at(0.0) == Vec3::ZERO);
}

/// Strands that hang down from `roots`.
fn hanging(roots: &[Vec3]) -> Arc<Groom> {
    Arc::new(Groom::from_strands(roots.iter().map(|root| line(*root, *root - Vec3::Y * 0.2, 16)), 4e-5))
}

/// The points of these strands after `frames` in moving air.
fn blown(
    groom: &Arc<Groom>,
    air: Air,
    occlusion: &WindOcclusion,
    colliders: &[MovingCollider],
    frames: u32,
) -> Vec<Vec3> {
    let poses: Vec<ColliderPose> = colliders.iter().map(MovingCollider::end_pose).collect();
    let mut simulation = Simulation::builder(groom.clone()).colliders_at_rest(&poses).build().unwrap();
    simulation.set_wind_occlusion(occlusion).unwrap();
    let roots = roots(groom, REST);
    for frame in 0..frames {
        let air = Air { time: frame as f64 / 60.0, ..air };
        simulation.step(&StepInput { dt: FRAME, anchor: REST, roots: &roots, colliders, air });
    }
    points(&simulation)
}

/// How far along z the tip of strand `s` was blown [m].
fn tip(groom: &Groom, points: &[Vec3], s: usize) -> f32 {
    let last = groom.range(s).end - 1;
    points[last].z - groom.points[last].z
}

#[test]
fn a_fan_moves_only_hair_in_front_of_it() {
    let groom = hanging(&[Vec3::new(0.0, 0.1, -0.3), Vec3::new(0.0, 0.1, 0.3)]);
    let wind = Wind { velocity: Vec3::new(0.5, 0.0, 0.1), gust: 0.5, gust_rate: 1.0 };
    let alone = blown(&groom, Air { wind, ..Air::default() }, &WindOcclusion::default(), &[], 60);
    let sources = [still(FAN)];
    let both =
        blown(&groom, Air { wind, sources: &sources, ..Air::default() }, &WindOcclusion::default(), &[], 60);
    assert!(alone[groom.range(0)] == both[groom.range(0)], "the fan changed hair behind it");
    let [before, after] = [&alone, &both].map(|points| tip(&groom, points, 1));
    println!("the tip in front of the fan is blown by {after} m, {before} m without it");
    assert!(after > before + 0.03, "{after} m with the fan, {before} m without it");
}

/// A ball in a wind along z.
fn ball() -> MovingCollider {
    let shape = ColliderShape::Sphere { center: Vec3::ZERO, radius: 0.06 };
    MovingCollider::at_rest(shape, REST)
}

#[test]
fn a_body_shelters_only_hair_behind_it() {
    let groom = hanging(&[Vec3::new(0.0, 0.1, -0.1), Vec3::new(0.0, 0.1, 0.15), Vec3::new(0.3, 0.1, 0.15)]);
    let air = Air { wind: Wind { velocity: Vec3::Z * 0.12, ..Wind::default() }, ..Air::default() };
    let open = blown(&groom, air, &WindOcclusion::default(), &[ball()], 120);
    let lee = blown(&groom, air, &WindOcclusion { body: 200.0, ..WindOcclusion::default() }, &[ball()], 120);
    let tips = [0, 1, 2].map(|s| [&open, &lee].map(|points| tip(&groom, points, s)));
    println!("tips in the open and with shelter, in front, behind and beside: {tips:?} m");
    assert!(open[groom.range(0)] == lee[groom.range(0)], "in front of the ball: {:?} m", tips[0]);
    assert!(open[groom.range(2)] == lee[groom.range(2)], "beside the ball: {:?} m", tips[2]);
    assert!(tips[1][1] < 0.7 * tips[1][0], "behind the ball: {:?} m", tips[1]);
    // A shorter reach ends the wake. Gravity and drag are the same, so the damping in the lee is too.
    let short_reach = WindOcclusion { body: 200.0, reach: 0.05, ..WindOcclusion::default() };
    let past_the_wake = blown(&groom, air, &short_reach, &[ball()], 120);
    assert!((tip(&groom, &past_the_wake, 1) / tips[1][0] - 1.0).abs() < 0.02, "the wake does not end");
}

#[test]
fn deep_hair_is_sheltered() {
    let roots: Vec<Vec3> = (0..240).map(|k| Vec3::new((k % 8) as f32, 0.0, (k / 8) as f32) * 0.005).collect();
    let groom = hanging(&roots);
    let air = Air { wind: Wind { velocity: Vec3::Z * 0.12, ..Wind::default() }, ..Air::default() };
    let open = blown(&groom, air, &WindOcclusion::default(), &[], 60);
    let inside = blown(&groom, air, &WindOcclusion { hair: 50.0, ..WindOcclusion::default() }, &[], 60);
    let row = |points: &[Vec3], z: usize| (0..8).map(|x| tip(&groom, points, z * 8 + x)).sum::<f32>() / 8.0;
    let tips: Vec<[f32; 2]> = (0..30).step_by(5).map(|z| [row(&open, z), row(&inside, z)]).collect();
    println!("tips in the open and with shelter, from the first row to the last: {tips:?} m");
    assert!(tips.windows(2).all(|w| w[1][1] < 1.02 * w[0][1]), "deeper hair is blown farther: {tips:?}");
    assert!(tips[0][1] > 0.5 * tips[0][0], "the first row is sheltered: {:?}", tips[0]);
    assert!(tips[4][1] < 0.2 * tips[4][0], "10 cm deep: {:?}", tips[4]);
}

#[test]
fn hair_in_moving_air_is_independent_of_threads() {
    let roots: Vec<Vec3> =
        (0..600).map(|k| Vec3::new((k % 20) as f32, 10.0, (k / 20) as f32) * 0.01 - Vec3::X * 0.1).collect();
    let groom = hanging(&roots);
    let sources =
        [still(FAN), still(Flow::Vortex { center: Vec3::ZERO, axis: Vec3::Y, radius: 0.1, speed: 1.0 })];
    let air = Air {
        wind: Wind { velocity: Vec3::X, gust: 0.3, gust_rate: 1.0 },
        sources: &sources,
        turbulence: Turbulence { strength: 0.5, ..Turbulence::default() },
        ..Air::default()
    };
    let occlusion = WindOcclusion { body: 100.0, hair: 50.0, ..WindOcclusion::default() };
    let play = |threads| on_threads(threads, || blown(&groom, air, &occlusion, &[ball()], 30));
    let one = play(1);
    assert!(one.iter().all(|p| p.is_finite()));
    assert!(one == play(2), "two threads give other bits than one");
    assert!(one == play(7), "seven threads give other bits than one");
}
