//! Promise: the profiles of a material multiply its parameters along the strand.
//!
//! Closed forms: the sag of a cantilever whose stiffness or radius changes linearly from root to tip; the first
//! acceleration of each point of a limp strand in a wind; the pull of a charged ball. A profile of one value is the
//! same as the parameter times that value.

use glam::Vec3;
use hairspring::{
    air::Air,
    collide::{ColliderShape, MovingCollider},
    forces::charge::ChargedBall,
    groom::{Groom, StrandScale},
    material::{Material, Model, profile_at},
    settings::{Solver, Wind},
    simulation::{Simulation, StepInput},
};
use hairspring_test::{REST, points};

const RADIUS: f64 = 40e-6;
const LENGTH: f64 = 0.05;
const POINTS: usize = 65;
/// The springs model holds its shape less exactly; only the last tests include it.
const MODELS: [Model; 2] = [Model::Curvature, Model::Rod];

/// A strand along X, whose first segment is held.
fn strand(material: &Material, gravity: f32) -> Simulation {
    let solver = Solver { sag_free: false, substeps: 8, ..Solver::default() };
    scaled(material, solver, Vec3::NEG_Y * gravity, StrandScale::default())
}

fn scaled(material: &Material, solver: Solver, gravity: Vec3, scale: StrandScale) -> Simulation {
    spaced(1.0, material, solver, gravity, scale)
}

/// Fraction of the length at point `i`; points are closer to each other near the root for a `power` above 1.
fn fraction(i: usize, power: f64) -> f64 {
    (i as f64 / (POINTS - 1) as f64).powf(power)
}

fn spaced(power: f64, material: &Material, solver: Solver, gravity: Vec3, scale: StrandScale) -> Simulation {
    let along = (0..POINTS).map(|i| Vec3::X * (LENGTH * fraction(i, power)) as f32);
    let mut groom = Groom::from_strands([along.collect::<Vec<_>>()], RADIUS as f32);
    groom.scales = vec![scale];
    let builder = Simulation::builder(groom).materials(std::slice::from_ref(material)).solver(solver);
    builder.gravity(gravity).build().unwrap()
}

fn step(simulation: &mut Simulation, wind: Vec3) -> Vec<Vec3> {
    step_on(simulation, wind, &[])
}

fn step_on(simulation: &mut Simulation, wind: Vec3, colliders: &[MovingCollider]) -> Vec<Vec3> {
    let air = Air { wind: Wind { velocity: wind, ..Wind::default() }, ..Air::default() };
    simulation.step(&StepInput { dt: 1.0 / 60.0, anchor: REST, roots: &[REST], colliders, air });
    points(simulation)
}

/// Sag of the tip of a cantilever of stiffness `ei` [N m²] under its weight `line` [N/m], both at the distance s from
/// its clamped root [m]: ∫ M (L − s) / EI ds with M the moment of the weight beyond s.
fn sag(ei: impl Fn(f64) -> f64, line: impl Fn(f64) -> f64) -> f64 {
    let n = 4000;
    let ds = LENGTH / n as f64;
    let (mut weight, mut moment, mut sag) = (0.0, 0.0, 0.0);
    for k in (0..n).rev() {
        let s = (k as f64 + 0.5) * ds;
        weight += line(s) * ds;
        moment += weight * ds;
        sag += moment * (LENGTH - s) / ei(s) * ds;
    }
    sag
}

/// Sag of the simulated tip at rest [m].
fn rests_at(material: &Material, gravity: f32) -> f64 {
    rests_along(material, Vec3::NEG_Y * gravity)
}

/// Displacement of the simulated tip at rest along gravity [m].
fn rests_along(material: &Material, gravity: Vec3) -> f64 {
    let solver = Solver { sag_free: false, substeps: 8, ..Solver::default() };
    let mut simulation = scaled(material, solver, gravity, StrandScale::default());
    let mut now = Vec::new();
    for _ in 0..240 {
        now = step(&mut simulation, Vec3::ZERO);
    }
    f64::from(now[POINTS - 1].dot(gravity.normalize()))
}

#[test]
fn stiffness_and_radius_follow_their_profiles() {
    let round =
        |r: f64| (3.9e9 * std::f64::consts::FRAC_PI_4 * r.powi(4), 1310.0 * std::f64::consts::PI * r * r);
    // A small load, so that the beam is linear; damping and drag so that it comes to rest.
    let gravity = 0.5f64;
    for model in MODELS {
        let base = Material { model, damping: 0.1, radius: Some(RADIUS as f32), ..Material::default() };
        let profile = [1.0f32, 0.4, 2.0];
        let at = |s: f64| profile_at(&profile, s / LENGTH);
        let (ei, line) = round(RADIUS);
        let bends = rests_at(&Material { bend_profile: profile.to_vec(), ..base.clone() }, gravity as f32);
        let want = sag(|s| ei * at(s), |_| line * gravity);
        let plain = sag(|_| ei, |_| line * gravity);
        println!("{model:?}: bend profile {bends} m, closed form {want} m, without {plain} m");
        assert!((bends / want - 1.0).abs() < 0.03 && (want / plain - 1.0).abs() > 0.3);
        let tapered = rests_at(&Material { radius_profile: vec![1.0, 0.5], ..base }, gravity as f32);
        let taper = |s: f64| round(RADIUS * (1.0 - 0.5 * s / LENGTH));
        let want = sag(|s| taper(s).0, |s| taper(s).1 * gravity);
        println!("{model:?}: tapered {tapered} m, closed form {want} m");
        assert!((tapered / want - 1.0).abs() < 0.03 && (want / plain - 1.0).abs() > 0.1, "{tapered}, {want}");
    }
}

/// The long axis is along Y: a flat strand is stiffer along Y and softer along Z than a round one.
#[test]
fn flatness_follows_its_profile() {
    let ei = 3.9e9 * std::f64::consts::FRAC_PI_4 * RADIUS.powi(4);
    let line = 1310.0 * std::f64::consts::PI * RADIUS * RADIUS;
    let profile = [1.0f32, 0.3, 0.6];
    // At most 1: the ratio is 1 at the root, 0.36 in the middle and 0.72 at the tip.
    let flatness = |s: f64| (1.2 * profile_at(&profile, s / LENGTH)).min(1.0);
    let base =
        Material { damping: 0.1, radius: Some(RADIUS as f32), model: Model::Rod, ..Material::default() };
    // The material's own flatness is at most 1, so that of the strand makes it 1.2 times the profile.
    let flat =
        Material { flatness: 0.8, flatness_profile: profile.map(|f| 1.5 * f).to_vec(), ..base.clone() };
    for (toward, power) in [(Vec3::Y, -1), (Vec3::Z, 1)] {
        let gravity = 0.5f64;
        let bends = rests_along(&flat, toward * gravity as f32);
        let want = sag(|s| ei * flatness(s).powi(power), |_| line * gravity);
        let round = rests_along(&base, toward * gravity as f32);
        println!("along {toward}: {bends} m, closed form {want} m, round {round} m");
        assert!((bends / want - 1.0).abs() < 0.03 && (want / round - 1.0).abs() > 0.15, "{bends}, {want}");
    }
}

#[test]
fn drag_and_charge_follow_their_profiles() {
    let profile = vec![0.0f32, 1.0, 3.0];
    // So little drag that no point takes on the velocity of the air.
    let limp = Material { bend: 1e-3, damping: 0.0, drag: 5e-3, ..Material::default() };
    let ball = |simulation: &mut Simulation| {
        simulation.set_charged([ChargedBall {
            centers: [Vec3::new(0.025, 5.0, 0.0); 2],
            radius: 0.1,
            charge: -1e-4,
        }]);
    };
    let moved = |material: Material, power: f64, wind: f32| {
        let solver = Solver { sag_free: false, substeps: 8, ..Solver::default() };
        let mut simulation = spaced(power, &material, solver, Vec3::ZERO, StrandScale::default());
        ball(&mut simulation);
        step(&mut simulation, Vec3::Y * wind).iter().map(|p| p.y).collect::<Vec<_>>()
    };
    for model in MODELS {
        let limp = Material { model, ..limp.clone() };
        // A displacement so small that no point pulls on another.
        let cases = [
            ("drag", Material { drag_profile: profile.clone(), ..limp.clone() }, limp.clone(), 1e-3),
            (
                "charge",
                Material { charge: 1e-12, drag: 0.0, charge_profile: profile.clone(), ..limp.clone() },
                Material { charge: 1e-12, drag: 0.0, ..limp.clone() },
                0.0,
            ),
        ];
        // Profiles follow the arc length, however the points are spaced.
        for ((name, with, without, wind), power) in cases.iter().flat_map(|case| [(case, 1.0), (case, 1.4)]) {
            let (with, without) = (moved(with.clone(), power, *wind), moved(without.clone(), power, *wind));
            // Not near the root, which the held segment keeps, nor at the kink of the profile.
            let free = |i: &usize| {
                let along = fraction(*i, power);
                (0.3..0.42).contains(&along) || (0.6..0.95).contains(&along)
            };
            for i in (0..POINTS).filter(free) {
                let want = profile_at(&profile, fraction(i, power)) as f32;
                let ratio = with[i] / without[i];
                assert!(
                    (ratio - want).abs() < 0.03 * want,
                    "{model:?}, {name}, spacing {power}, point {i}: {ratio}, not {want}"
                );
            }
        }
    }
}

#[test]
fn a_profile_of_one_value_multiplies_the_parameter() {
    let base = Material { radius: Some(RADIUS as f32), charge: 1e-10, ..Material::default() };
    let twice = vec![2.0];
    let cases: [(&str, Material, Material); 7] = [
        (
            "flatness",
            Material { flatness_profile: vec![0.5], ..base.clone() },
            Material { flatness: 0.5, ..base.clone() },
        ),
        (
            "bend",
            Material { bend_profile: twice.clone(), ..base.clone() },
            Material { bend: 2.0, ..base.clone() },
        ),
        (
            "drag",
            Material { drag_profile: twice.clone(), ..base.clone() },
            Material { drag: 2.0, ..base.clone() },
        ),
        (
            "damping",
            Material { damping_profile: twice.clone(), ..base.clone() },
            Material { damping: 0.02, ..base.clone() },
        ),
        (
            "friction",
            Material { friction_profile: twice.clone(), ..base.clone() },
            Material { friction: 0.6, ..base.clone() },
        ),
        (
            "charge",
            Material { charge_profile: twice.clone(), ..base.clone() },
            Material { charge: 2e-10, ..base.clone() },
        ),
        (
            "radius",
            Material { radius_profile: twice, ..base.clone() },
            Material { radius: Some(2.0 * RADIUS as f32), ..base.clone() },
        ),
    ];
    // So does the groom's multiplier of a strand.
    let thick = |scale, material: &Material| {
        let mut simulation = scaled(material, Solver::default(), Vec3::NEG_Y * 9.81, scale);
        (0..30).map(|k| step(&mut simulation, Vec3::Z * (k % 5) as f32)).last().unwrap()
    };
    let scale = StrandScale { radius: 2.0, charge: 3.0, flatness: 0.5, ..StrandScale::default() };
    let by_groom = thick(scale, &base);
    let by_material =
        Material { radius: Some(2.0 * RADIUS as f32), charge: 3e-10, flatness: 0.5, ..base.clone() };
    assert_eq!(by_groom, thick(StrandScale::default(), &by_material));
    for model in [Model::Curvature, Model::Rod, Model::Springs] {
        for (name, profiled, multiplied) in &cases {
            let run = |material: &Material| {
                let mut simulation = strand(&Material { model, ..material.clone() }, 9.81);
                simulation.set_charged([ChargedBall {
                    centers: [Vec3::new(0.05, 0.5, 0.1); 2],
                    radius: 0.1,
                    charge: -1e-6,
                }]);
                (0..30).map(|k| step(&mut simulation, Vec3::Z * (k % 5) as f32)).last().unwrap()
            };
            let (a, b, plain) = (run(profiled), run(multiplied), run(&base));
            let off = hairspring_test::farthest(&a, &b);
            assert!(off < 2e-6, "{model:?}, {name}: {off} m");
            let changed = hairspring_test::farthest(&a, &plain);
            assert!(*name == "friction" || changed > 1e-4, "{model:?}, {name} has no effect: {changed} m");
        }
    }
}

/// A limp strand lies across a slope of tangent 0.3. It slips where the coefficient of friction is below that.
#[test]
fn friction_follows_its_profile() {
    let floor = MovingCollider::at_rest(
        ColliderShape::Plane { point: Vec3::ZERO, normal: Vec3::Y },
        hairspring::math::RigidTransform::default(),
    );
    let slid = |friction: f32, profile: &[f32], scale: f32| {
        let material = Material {
            friction,
            friction_profile: profile.to_vec(),
            bend: 0.0,
            drag: 0.0,
            ..Material::default()
        };
        let scale = StrandScale { friction: scale, ..StrandScale::default() };
        let mut simulation = scaled(
            &material,
            Solver { sag_free: false, ..Solver::default() },
            Vec3::new(0.0, -1.0, 0.3) * 9.4,
            scale,
        );
        let mut now = Vec::new();
        for _ in 0..4 {
            now = step_on(&mut simulation, Vec3::ZERO, std::slice::from_ref(&floor));
        }
        [16, 48, 64].map(|i| f64::from(now[i].z) / LENGTH)
    };
    // Points settle into the floor in the first frame.
    let holds = |z: f64| z.abs() < 5e-3;
    let [near, .., tip] = slid(0.6, &[1.0, 0.0], 1.0);
    println!("rough root: {near} near the root, {tip} at the tip");
    assert!(holds(near) && tip > 0.02, "rough root: {near}, {tip}");
    let rough_tip = slid(0.6, &[0.0, 1.0], 1.0);
    println!("rough tip: {rough_tip:?}");
    assert!(rough_tip[0] > 0.02 && holds(rough_tip[2]), "rough tip: {rough_tip:?}");
    assert!(slid(0.6, &[1.0], 1.0).into_iter().all(holds) && slid(0.6, &[1.0], 0.25)[2] > 0.02);
    // The coefficient is at most 1.
    assert_eq!(slid(0.6, &[5.0, 5.0], 1.0), slid(1.0, &[1.0], 1.0));
}
