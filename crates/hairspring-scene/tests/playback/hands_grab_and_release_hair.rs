//! Promise: grabbed hair follows the hand with the lag of a closed form, and swings freely when it is
//! released.
//!
//! A lock of strands without bending stiffness hangs from a rail. A grab sphere holds it half-way down and
//! moves. In steady motion a point lags only by the load on it: (g + a)/ω² times the ratio of the mass it
//! carries to its own. A released lock starts with the speed of the hand, and hangs in its old place after
//! it has come to rest.

use glam::{Quat, Vec3};
use hairspring::{
    forces::{Manipulator, grab::Grab},
    groom::Groom,
    material::{Material, Model},
    math::RigidTransform,
    settings::{Integrator, Solver},
    simulation::{ManipulatorId, Simulation},
};
use hairspring_scene::{Guides, Hand, Scene, SceneGroom, stage::Stage};
use hairspring_test::{FRAME, REST, farthest, points, roots, step, translation};

const POINTS: usize = 32;
const SEGMENT: f32 = 0.01;
const GRAVITY: f32 = 9.81;

/// Strands that hang from a rail.
struct Lock {
    simulation: Simulation,
    roots: Vec<RigidTransform>,
    points: Vec<Vec3>,
}

impl Lock {
    fn new(material: Material, solver: Solver) -> Self {
        let strands = (0..12).map(|s| {
            let x = (s as f32 - 5.5) * 0.002;
            (0..POINTS).map(move |i| Vec3::new(x, -SEGMENT * i as f32, 0.0)).collect::<Vec<_>>()
        });
        let groom = Groom::from_strands(strands, 40e-6);
        let (roots, points) = (roots(&groom, REST), groom.points.clone());
        let simulation = Simulation::builder(groom).materials(&[material]).solver(solver).build().unwrap();
        Self { simulation, roots, points }
    }

    fn step(&mut self) {
        step(&mut self.simulation, REST, &self.roots, &[]);
        self.points = points(&self.simulation);
    }

    fn step_with_hand(&mut self, id: ManipulatorId, hand: Vec3) {
        self.simulation.set_manipulator_pose(id, translation(hand));
        self.step();
    }
}

fn chain() -> Material {
    Material { bend: 0.0, drag: 0.0, ..Material::default() }
}

/// A grab sphere around the points 12 to 16 of every strand.
fn grab(pull: f32) -> Manipulator {
    let center = Vec3::NEG_Y * (14.0 * SEGMENT);
    Manipulator::Grab(Grab { center, radius: 2.5 * SEGMENT, pull, damping: 1.0 })
}

#[test]
fn a_grabbed_lock_lags_by_the_closed_form() {
    for (pull, model) in [(60.0, Model::Curvature), (30.0, Model::Rod), (60.0, Model::Springs)] {
        let mut lock = Lock::new(Material { model, ..chain() }, Solver::default());
        let id = lock.simulation.add_manipulator(grab(pull), REST);
        let held: Vec<_> = lock.simulation.attached_points(id).collect();
        assert_eq!(held.len(), 12 * 5, "{model:?}: the grab does not hold five points of each strand");
        // The hand moves up by 6 cm and out by 3 cm, so that it carries the held hair, and then sideways at
        // 0.3 m/s.
        let lift = |frame: u32| 0.06 * (frame as f32 / 60.0).min(1.0);
        let side = |frame: u32| 0.3 * (frame.saturating_sub(180) as f32 * FRAME);
        let omega = std::f32::consts::TAU * pull;
        // The five held points carry the strand from the middle of the slack part above them to the tip, of
        // 32 points in all.
        let sag = |carried: f32| carried / 5.0 * GRAVITY / (omega * omega);
        let (least, most) = (sag(16.0), sag(26.0));
        let mut worst = 0.0f32;
        for frame in 1..=195u32 {
            let way = Vec3::new(side(frame), lift(frame), 0.5 * lift(frame));
            lock.step_with_hand(id, way);
            let lag = |(s, i): &(u32, u32)| {
                let at = lock.points[*s as usize * POINTS + *i as usize];
                let home = Vec3::new((*s as f32 - 5.5) * 0.002, -SEGMENT * *i as f32, 0.0) + way;
                home - at
            };
            let mean = held.iter().map(lag).sum::<Vec3>() / held.len() as f32;
            let largest = held.iter().map(lag).map(Vec3::length).fold(0.0, f32::max);
            if frame == 175 {
                println!("{model:?}, {pull} Hz: the lag at rest is {mean} m, closed form {least} to {most}");
                assert!(
                    (least..most).contains(&mean.y),
                    "{model:?}: {mean} m, closed form {least} to {most}"
                );
            }
            worst = worst.max(largest);
        }
        println!("{model:?}, {pull} Hz: the largest lag is {worst} m");
        assert!(worst < 3.0 * most, "{model:?}: the lag in motion is {worst} m");
        assert!(lock.simulation.measure(&[]).stretch_max < 0.011);
    }
}

#[test]
fn a_released_lock_has_the_speed_of_the_hand() {
    let mut lock = Lock::new(Material { damping: 0.02, drag: 0.0, ..Material::default() }, Solver::default());
    let id = lock.simulation.add_manipulator(grab(60.0), REST);
    // The hand moves like a pendulum about the rail, so that hair is neither slack nor stretched: slowly
    // aside, then back to the lowest point at 0.25 m/s.
    let turn = 0.03;
    let at = |frame: u32| {
        let angle = if frame < 90 { 0.3 * frame as f32 / 90.0 } else { 0.3 - turn * (frame - 90) as f32 };
        RigidTransform { rotation: Quat::from_rotation_x(angle), translation: Vec3::ZERO }
    };
    let speed = turn / FRAME * 14.0 * SEGMENT;
    for frame in 1..=100 {
        lock.simulation.set_manipulator_pose(id, at(frame));
        lock.step();
    }
    let before = lock.points.clone();
    let released = lock.simulation.energy();
    lock.simulation.remove_manipulator(id);
    assert_eq!(lock.simulation.attached_points(id).count(), 0);
    lock.simulation.set_manipulator_pose(id, at(400));
    lock.step();
    let mean = |points: &[Vec3]| (0..12).map(|s| points[s * POINTS + 14]).sum::<Vec3>() / 12.0;
    let after = (mean(&lock.points) - mean(&before)) / FRAME;
    println!("hand {speed} m/s, lock {after} m/s");
    assert!((after.length() / speed - 1.0).abs() < 0.15, "hand {speed} m/s, lock {after} m/s");
    // The lock's energy comes from the hand only, so it does not increase after the release.
    for frame in 0..300 {
        let now = lock.simulation.energy();
        let gain = (now.total() - released.total()) / released.kinetic;
        assert!(gain < 0.02, "frame {frame}: the energy grew by {gain} of that at the release");
        lock.step();
    }
}

#[test]
fn a_released_lock_returns_to_rest() {
    let mut lock = Lock::new(Material { damping: 0.02, ..Material::default() }, Solver::default());
    let rest = lock.points.clone();
    let id = lock.simulation.add_manipulator(grab(60.0), REST);
    for frame in 1..=60 {
        lock.step_with_hand(id, Vec3::new(0.05, 0.06, 0.08) * (frame as f32 / 60.0));
    }
    let offset = |lock: &Lock| farthest(&lock.points, &rest);
    let held = offset(&lock);
    lock.simulation.remove_manipulator(id);
    for _ in 0..600 {
        lock.step();
    }
    println!("offset while held: {held} m, ten seconds after the release: {} m", offset(&lock));
    assert!(held > 0.05 && offset(&lock) < 0.002, "the lock is {} m from its old place", offset(&lock));
}

#[test]
fn a_pinned_lock_is_held_while_its_roots_move() {
    let mut lock = Lock::new(chain(), Solver::default());
    let id = lock.simulation.add_manipulator(grab(60.0), REST);
    let held: Vec<_> = lock.simulation.attached_points(id).collect();
    let homes = lock.points.clone();
    for frame in 0..120 {
        let way = 0.03 * (std::f32::consts::TAU * 2.0 * frame as f32 * FRAME).sin();
        lock.roots.iter_mut().enumerate().for_each(|(s, root)| {
            root.translation = Vec3::new((s as f32 - 5.5) * 0.002, -0.05, way);
        });
        lock.step();
    }
    let offset_of = |(s, i): &(u32, u32)| {
        let k = *s as usize * POINTS + *i as usize;
        lock.points[k].distance(homes[k])
    };
    let worst = held.iter().map(offset_of).fold(0.0, f32::max);
    println!("the largest offset is {worst} m");
    assert!(worst < 0.003, "the largest offset is {worst} m");
}

#[test]
fn a_jumping_hand_keeps_the_simulation_stable() {
    // Explicit integrators are unstable with such segments even at rest.
    for integrator in &Integrator::ALL[2..] {
        let mut lock =
            Lock::new(Material::default(), Solver { integrator: *integrator, ..Solver::default() });
        let id = lock.simulation.add_manipulator(grab(1000.0), REST);
        for frame in 0..60 {
            let away = if frame / 10 % 2 == 0 { 0.0 } else { 5.0 };
            lock.step_with_hand(id, Vec3::new(away, away, 0.0));
            let measure = lock.simulation.measure(&[]);
            assert_eq!(measure.non_finite, 0, "{integrator:?}, frame {frame}");
            if matches!(integrator, Integrator::BackwardEuler | Integrator::Bdf2) {
                assert!(
                    measure.stretch_max < 0.011,
                    "{integrator:?}: the stretch is {}",
                    measure.stretch_max
                );
            }
        }
        lock.simulation.remove_manipulator(id);
        for _ in 0..300 {
            lock.step();
        }
        let measure = lock.simulation.measure(&[]);
        println!("{integrator:?}: {measure:?} five seconds after the release");
        assert!(measure.speed_max < 3.0, "{integrator:?}: hair does not come to rest: {measure:?}");
    }
}

#[test]
fn hands_of_a_scene_follow_their_timing_and_path() {
    let strand = (0..POINTS).map(|i| Vec3::new(0.0, -SEGMENT * i as f32, 0.0)).collect::<Vec<_>>();
    let groom =
        SceneGroom { groom: Groom::from_strands([strand], 40e-6), guides: Guides::All, ..Default::default() };
    let Manipulator::Grab(ball) = grab(60.0) else { unreachable!() };
    let hand = Hand {
        path: vec![[0.5, 0.0, 0.0, 0.0], [1.0, 0.08, 0.03, 0.0]],
        from: 0.5,
        until: Some(1.5),
        ..Hand::new(Manipulator::Grab(ball))
    };
    let scene =
        Scene { grooms: vec![groom], gravity: Vec3::NEG_Y * GRAVITY, hands: vec![hand], ..Scene::default() };
    let mut stage = Stage::new(scene).unwrap();
    let held = |stage: &Stage| stage.strands().next().unwrap().points[14];
    let home = held(&stage);
    let mut played = Vec::new();
    for round in 0..2 {
        stage.reset();
        let mut places = Vec::new();
        for _ in 0..180 {
            stage.step(FRAME);
            places.push(held(&stage));
        }
        assert!(places[28].distance(home) < 1e-6, "round {round}: hair moved before the hand began");
        let (middle, end) = (home + Vec3::new(0.04, 0.015, 0.0), home + Vec3::new(0.08, 0.03, 0.0));
        println!(
            "offset in the middle: {} m, at the end: {} m",
            places[44].distance(middle),
            places[80].distance(end)
        );
        assert!(places[44].distance(middle) < 1e-3 && places[80].distance(end) < 1e-3);
        assert!(places[179].distance(end) > 0.03, "round {round}: the hand did not release");
        played.push(places);
    }
    let difference = farthest(&played[0], &played[1]);
    assert!(difference < 1e-5, "after a reset the motion differs by {difference} m");
    // A hand that an app moves gives the same result.
    stage.reset();
    let id = stage.add_manipulator(Manipulator::Grab(ball), REST);
    for frame in 1..=20 {
        stage.set_manipulator_pose(id, translation(Vec3::new(0.004, 0.0015, 0.0) * frame as f32));
        stage.step(FRAME);
    }
    assert!(
        held(&stage).distance(home + Vec3::new(0.08, 0.03, 0.0)) < 2e-3,
        "the held point is at {}",
        held(&stage)
    );
    stage.remove_manipulator(id);
}
