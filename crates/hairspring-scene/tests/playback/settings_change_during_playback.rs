//! Promise: settings can change during playback, and hair continues from its current position and velocity.
//!
//! Applying the same settings changes no bit, even if all rest shapes are solved again. Every elastic model
//! and integrator can take over from every other during a swing: positions are unchanged, tips keep their
//! velocity, and no value is non-finite. Gravity, stiffness, wind, colliders and hands can be added and
//! removed. Refused settings change nothing.

use crate::support::{play, points};
use glam::Vec3;
use hairspring::{
    air::{Air, Flow, Turbulence, WindOcclusion, WindSource},
    forces::{Manipulator, grab::Grab},
    groom::Groom,
    material::{Material, Model},
    settings::{Effects, Integrator, Solver, Volume, VolumeMethod, Wind},
    simulation::{Simulation, StepInput},
};
use hairspring_scene::{
    Collider, Guides, Hand, InitialContact, Scene, SceneGroom, Shape,
    builtin::{self, BuiltinOptions},
    stage::{Stage, StageError},
};
use hairspring_test::{FRAME, REST, farthest, roots, translation};
use std::sync::Arc;

const GRAVITY: Vec3 = Vec3::new(0.0, -9.81, 0.0);

/// The argument of `update_settings`: the settings without geometry.
fn settings_of(scene: &Scene) -> Scene {
    let bare = |groom: &SceneGroom| SceneGroom { groom: Groom::default(), ..groom.clone() };
    Scene {
        grooms: scene.grooms.iter().map(bare).collect(),
        body: None,
        collision: None,
        sheets: Vec::new(),
        clip: None,
        ..scene.clone()
    }
}

/// The nodding head, with every effect that a scene can have.
fn head() -> Scene {
    let mut scene = builtin::scene(&BuiltinOptions {
        strands: 400,
        guides: Guides::Count(60),
        ..BuiltinOptions::default()
    });
    scene.wind = Wind { velocity: Vec3::X, gust: 0.5, gust_rate: 1.0 };
    let fan = Flow::Fan { center: Vec3::Z, axis: Vec3::NEG_Z, radius: 0.1, speed: 3.0, spread: 11.8 };
    scene.wind_sources = vec![WindSource { joint: None, shape: fan, gust: 0.0, gust_rate: 0.0 }];
    scene.turbulence = Turbulence { strength: 0.3, ..Turbulence::default() };
    scene.wind_occlusion = WindOcclusion { hair: 20.0, ..WindOcclusion::default() };
    scene.volume = Volume { method: VolumeMethod::Density, ..Volume::default() };
    scene.colliders = vec![Collider {
        joint: None,
        initial: InitialContact::Keep,
        shape: Shape::Sphere { center: Vec3::ZERO, radius: 0.05 },
    }];
    scene
}

#[test]
fn the_same_settings_change_nothing() {
    let scene = head();
    let settings = settings_of(&scene);
    let mut stages = [0; 3].map(|_| Stage::new(scene.clone()).unwrap());
    let hold = Manipulator::Grab(Grab {
        center: Vec3::new(0.08, -0.05, 0.0),
        radius: 0.05,
        pull: 60.0,
        damping: 1.0,
    });
    for stage in &mut stages {
        play(stage, 20);
        let id = stage.add_manipulator(hold, REST);
        stage.set_manipulator_pose(id, translation(Vec3::X * 0.01));
        play(stage, 5);
    }
    let [untouched, same, fresh] = &mut stages;
    same.update_settings(settings.clone()).unwrap();
    assert_eq!(same.scene(), untouched.scene());
    // No material has a global shape, so the switch only causes the rest shapes to be solved again.
    let solver = Solver { global_shape: false, ..settings.solver };
    fresh.update_settings(Scene { solver, ..settings }).unwrap();
    for frame in 0..30 {
        [&mut *untouched, &mut *same, &mut *fresh].into_iter().for_each(|stage| play(stage, 1));
        let expected = points(untouched);
        assert!(expected == points(same), "frame {frame}: the same settings changed the result");
        let difference = farthest(&expected, &points(fresh));
        assert!(
            expected == points(fresh),
            "frame {frame}: {difference} m apart after rest shapes were solved again"
        );
    }
}

/// Strands that extend to the side: straight ones, and curls of two sizes.
fn stuck_out() -> Groom {
    Groom::from_strands(
        (0..6).map(|k| {
            (0..20)
                .map(|i| {
                    let s = i as f32 / 19.0;
                    let (sin, cos) = (9.0 * s).sin_cos();
                    let curl = 0.004 * (k % 3) as f32;
                    Vec3::new(0.2 * s, curl * (cos - 1.0), 0.02 * k as f32 + curl * sin)
                })
                .collect::<Vec<_>>()
        }),
        40e-6,
    )
}

/// Strands that fall from a horizontal pose, with one model and integrator.
fn falling(groom: &Arc<Groom>, model: Model, integrator: Integrator) -> Simulation {
    let explicit = matches!(integrator, Integrator::ExplicitEuler | Integrator::Verlet);
    let substeps = if explicit { 400 } else { 4 };
    let solver = Solver { integrator, substeps, sag_free: false, ..Solver::default() };
    let material = Material { model, drag: 0.1, ..Material::default() };
    Simulation::builder(groom.clone()).materials(&[material]).solver(solver).build().unwrap()
}

/// Simulates a frame; returns how many strands were reset because they were not finite.
fn fall(simulation: &mut Simulation, groom: &Groom) -> usize {
    let (roots, air) = (roots(groom, REST), Air::default());
    simulation.step(&StepInput { dt: FRAME, anchor: REST, roots: &roots, colliders: &[], air }).reset_strands
}

#[test]
fn every_model_and_integrator_takes_over_from_every_other() {
    let groom = Arc::new(stuck_out());
    let ways: Vec<(Model, Integrator)> = [Model::Springs, Model::Curvature, Model::Rod]
        .into_iter()
        .flat_map(|model| Integrator::ALL.map(|integrator| (model, integrator)))
        .chain([(Model::Auto, Integrator::BackwardEuler)])
        .collect();
    // Explicit methods may lose a strand to an unstable step.
    let bears = |way: &(Model, Integrator)| !matches!(way.1, Integrator::ExplicitEuler | Integrator::Verlet);
    let (mut most, mut worst) = (0.0f32, None);
    for from in &ways {
        let mut old = falling(&groom, from.0, from.1);
        let mut before = Vec::new();
        let mut here = hairspring_test::points(&old);
        for _ in 0..12 {
            let lost = fall(&mut old, &groom);
            assert!(lost == 0 || !bears(from), "{from:?}: {lost} strands lost");
            before = std::mem::replace(&mut here, hairspring_test::points(&old));
        }
        // Tips moved from `before` to `here` in the last frame. The jump is the distance in the next frame
        // from the position extrapolated at constant velocity.
        let tips = || groom.offsets[1..].iter().map(|end| *end as usize - 1);
        let jump =
            |next: &[Vec3]| tips().map(|i| next[i].distance(2.0 * here[i] - before[i])).fold(0.0, f32::max);
        let mut unchanged = None;
        for to in std::iter::once(from).chain(&ways) {
            let mut new = falling(&groom, to.0, to.1);
            new.take_over(&old);
            let moved = farthest(&hairspring_test::points(&new), &here);
            assert!(moved < 1e-6, "{from:?} to {to:?}: {moved} m at the switch");
            for frame in 0..4 {
                let lost = fall(&mut new, &groom);
                assert!(lost == 0 || !bears(to), "{from:?} to {to:?}: {lost} strands lost");
                assert_eq!(new.measure(&[]).non_finite, 0, "{from:?} to {to:?}, {frame} frames later");
                if frame > 0 || !bears(from) || !bears(to) {
                    continue;
                }
                let jump = jump(&hairspring_test::points(&new));
                // The jump without a change of model or integrator.
                let unchanged = *unchanged.get_or_insert(jump);
                println!("{from:?} to {to:?}: {jump} m, {unchanged} m without a change");
                if jump - unchanged > most {
                    (most, worst) = (jump - unchanged, Some((*from, *to)));
                }
            }
        }
    }
    println!("at most {most} m: {worst:?}");
    // Corresponds to 7 g: strands of the follow-the-leader methods whip, and a method with damping stops
    // them.
    assert!(most < 0.02, "a change adds {most} m to the jump of a tip: {worst:?}");
}

/// A lock that hangs from fixed roots, with follow hairs.
fn lock() -> Scene {
    let strands = (0..24).map(|k| {
        (0..24)
            .map(|i| {
                let s = i as f32 / 23.0;
                Vec3::new(0.002 * k as f32 + 0.02 * s * s, -0.25 * s, 0.01 * (6.0 * s).sin())
            })
            .collect::<Vec<_>>()
    });
    Scene {
        grooms: vec![SceneGroom {
            groom: Groom::from_strands(strands, 40e-6),
            materials: vec![Material { drag: 0.1, ..Material::default() }],
            guides: Guides::Count(8),
            ..SceneGroom::default()
        }],
        gravity: GRAVITY,
        ..Scene::default()
    }
}

/// The lock in a gust of wind, and its settings.
fn in_the_wind() -> (Stage, Scene) {
    let mut scene = lock();
    scene.wind.velocity = Vec3::X * 4.0;
    let mut stage = Stage::new(scene.clone()).unwrap();
    play(&mut stage, 15);
    (stage, settings_of(&scene))
}

/// Updates the settings, and asserts that points keep their position and velocity.
fn changed_smoothly(stage: &mut Stage, settings: &Scene, what: &str, bound: f32) {
    let before = points(stage);
    play(stage, 1);
    let here = points(stage);
    stage.update_settings(settings.clone()).unwrap();
    assert!(points(stage) == here, "{what}: the update moved points");
    play(stage, 1);
    let jump = points(stage)
        .iter()
        .zip(here.iter().zip(&before))
        .map(|(next, (here, before))| next.distance(2.0 * here - before))
        .fold(0.0, f32::max);
    println!("{what}: {jump} m");
    assert!(jump < bound, "{what}: a point is {jump} m from its extrapolated position");
}

#[test]
fn gravity_and_stiffness_change_smoothly() {
    let (mut stage, settings) = in_the_wind();
    let mut stiff = settings.clone();
    stiff.grooms[0].materials[0].bend *= 100.0;
    let light = Scene { gravity: Vec3::ZERO, ..settings.clone() };
    // Hair that the wind has bent springs back when it becomes stiff, with an acceleration of 5 g.
    for (what, settings, bound) in [
        ("no gravity", &light, 0.01),
        ("gravity", &settings, 0.01),
        ("stiffer", &stiff, 0.02),
        ("as it was", &settings, 0.01),
    ] {
        changed_smoothly(&mut stage, settings, what, bound);
        play(&mut stage, 40);
    }
    // At rest it hangs like a lock whose settings never changed.
    let still = Scene { wind: Wind::default(), ..settings };
    stage.update_settings(still).unwrap();
    play(&mut stage, 600);
    let difference = farthest(&points(&stage), &lock().grooms[0].groom.points);
    assert!(difference < 2e-3, "the final offset is {difference} m");
}

#[test]
fn wind_and_effects_can_be_added() {
    let scene = lock();
    let mut stage = Stage::new(scene.clone()).unwrap();
    play(&mut stage, 10);
    let mut settings = settings_of(&scene);
    settings.wind.velocity = Vec3::Z * 5.0;
    changed_smoothly(&mut stage, &settings, "wind", 0.01);
    let lee = points(&stage);
    play(&mut stage, 30);
    let blown = points(&stage).iter().zip(&lee).map(|(now, was)| now.z - was.z).fold(0.0, f32::max);
    assert!(blown > 0.02, "the wind moved hair by only {blown} m");
    // Effects apply at once, because they are not simulated.
    let before = points(&stage);
    settings.grooms[0].effects = Effects { clump: 1.0, ..Effects::default() };
    settings.grooms[0].look.variation = 0.9;
    stage.update_settings(settings).unwrap();
    assert!(farthest(&points(&stage), &before) > 1e-3);
    assert_eq!(stage.strands().next().unwrap().look.variation, 0.9);
}

#[test]
fn colliders_can_be_added_and_removed() {
    let scene = lock();
    let mut stage = Stage::new(scene.clone()).unwrap();
    play(&mut stage, 5);
    let settings = settings_of(&scene);
    let ball = Shape::Sphere { center: Vec3::new(0.02, -0.15, -0.02), radius: 0.03 };
    let colliders = vec![Collider { joint: None, initial: InitialContact::Keep, shape: ball.clone() }];
    stage.update_settings(Scene { colliders, ..settings.clone() }).unwrap();
    assert_eq!(stage.colliders().len(), 1);
    play(&mut stage, 60);
    let ball = ball.collider_shape().unwrap();
    let inside = |stage: &Stage| points(stage).iter().map(|p| -ball.distance(*p)).fold(0.0, f32::max);
    assert!(inside(&stage) < 1e-4, "hair penetrates the ball by {} m", inside(&stage));
    stage.update_settings(settings).unwrap();
    assert!(stage.colliders().is_empty());
    play(&mut stage, 600);
    let difference = farthest(&points(&stage), &scene.grooms[0].groom.points);
    assert!(difference < 2e-3, "the final offset is {difference} m");
}

#[test]
fn a_hand_persists_while_its_settings_exist() {
    let mut scene = lock();
    let grab = Grab { center: Vec3::new(0.03, -0.2, 0.0), radius: 0.05, pull: 60.0, damping: 1.0 };
    let mut hand = Hand::new(Manipulator::Grab(grab));
    hand.path = vec![[0.0; 4], [0.2, 0.0, 0.1, 0.1]];
    scene.hands = vec![hand];
    let mut stage = Stage::new(scene.clone()).unwrap();
    play(&mut stage, 60);
    let held = points(&stage);
    let mut settings = settings_of(&scene);
    settings.grooms[0].materials[0].model = Model::Springs;
    stage.update_settings(settings.clone()).unwrap();
    play(&mut stage, 30);
    let slipped = points(&stage)[23].distance(held[23]);
    assert!(slipped < 0.03, "held hair slipped by {slipped} m after a change of model");
    settings.hands.clear();
    stage.update_settings(settings).unwrap();
    play(&mut stage, 300);
    let difference = farthest(&points(&stage), &scene.grooms[0].groom.points);
    assert!(difference < 0.01, "the offset after the release is {difference} m");
}

#[test]
fn refused_settings_change_nothing() {
    let scene = head();
    let [mut untouched, mut refused] = [0; 2].map(|_| Stage::new(scene.clone()).unwrap());
    let settings = settings_of(&scene);
    [&mut untouched, &mut refused].into_iter().for_each(|stage| play(stage, 5));
    let tail = Some("tail".to_owned());
    let joint = |what: &'static str| StageError::NoSuchJoint { what, joint: "tail".into() };
    let mut collider = Scene { gravity: Vec3::ZERO, ..settings.clone() };
    collider.colliders[0].joint = tail.clone();
    let mut source = Scene { wind: Wind::default(), ..settings.clone() };
    source.wind_sources[0].joint = tail;
    let none = Scene { grooms: Vec::new(), ..settings };
    for (wrong, error) in [
        (collider, joint("a collider")),
        (source, joint("a source of wind")),
        (none, StageError::GroomCount { settings: 0, grooms: 2 }),
    ] {
        assert_eq!(refused.update_settings(wrong), Err(error));
        assert_eq!(refused.scene(), untouched.scene());
    }
    for frame in 0..10 {
        [&mut untouched, &mut refused].into_iter().for_each(|stage| play(stage, 1));
        assert!(points(&untouched) == points(&refused), "frame {frame}");
    }
}
