//! Promise: hair does not stretch, does not penetrate the head, and does not explode.
//!
//! The standard bench scene is a sphere of hair shaken 5 cm at 2 Hz, with every strand simulated and four
//! substeps. Its mean stretch is under 0.05 %, and the worst under 1.1 % in every frame. No point is deeper
//! in the sphere than 0.1 mm, no value is non-finite, and memory is under 120 bytes a point. Strands of
//! other lengths, substep counts and shakes keep the bounds that do not depend on them.

use glam::{Quat, Vec2, Vec3};
use hairspring::{
    air::Air,
    collide::{ColliderShape, MovingCollider},
    groom::Groom,
    material::{Material, Model, PRESETS, preset},
    math::RigidTransform,
    settings::{Solver, Volume, VolumeMethod},
    simulation::{Simulation, StepInput},
};
use hairspring_test::{FRAME, REST, line, points, step, translation};
use hairspring_validate::bench::Bench;
use rayon::prelude::*;
use std::sync::Arc;

#[test]
fn standard_scene_keeps_its_bounds() {
    let bench = standard_scene(Material::default(), 600, 5e-4);
    let bytes = bench.simulation.bytes() as f64 / bench.simulation.point_count() as f64;
    assert!(bytes < 120.0, "{bytes} bytes a point");
}

/// The springs model keeps the same bounds, except memory (it has an extra particle for each segment) and a
/// mean twice as large.
#[test]
fn standard_scene_of_springs_keeps_its_bounds() {
    standard_scene(Material { model: Model::Springs, ..Material::default() }, 200, 1e-3);
}

fn standard_scene(material: Material, strands: u32, mean: f64) -> Bench {
    let mut bench = Bench::with_material(strands, 32, material, Solver::default());
    for frame in 0..300 {
        let report = bench.step();
        assert_eq!(report.reset_strands, 0, "a strand turned non-finite in frame {frame}");
        let m = bench.measure();
        assert!(
            m.stretch_max < 0.011,
            "the length of a segment is wrong by {} of it in frame {frame}",
            m.stretch_max
        );
        assert!(m.max_depth < 1e-4, "a point is {} m deep in frame {frame}", m.max_depth);
        assert_eq!(m.non_finite, 0);
    }
    let end = bench.measure();
    assert!(end.stretch_mean < mean, "mean stretch {}", end.stretch_mean);
    assert!(end.speed_max > 0.5, "the hair hardly moves: {} m/s", end.speed_max);
    bench
}

/// Without bending stiffness, only the segments preserve a strand's length.
#[test]
fn limp_hair_keeps_its_length() {
    let root = Vec3::new(0.0, 1.0, 0.0);
    let strand = line(root, root + Vec3::X * 0.2, 64);
    let groom = Arc::new(Groom::from_strands([strand], 35e-6));
    for model in Model::ALL {
        let material = Material { model, bend: 0.0, ..Material::default() };
        let solver = Solver { sag_free: false, ..Solver::default() };
        let mut simulation =
            Simulation::builder(groom.clone()).materials(&[material]).solver(solver).build().unwrap();
        for frame in 0..300 {
            step(&mut simulation, REST, &[translation(root)], &[]);
            let points = points(&simulation);
            // Compares the stretch of the output points with the stretch that the simulation reports.
            let worst = points.windows(2).map(|w| (w[0].distance(w[1]) * 63.0 / 0.2 - 1.0).abs());
            let worst = worst.fold(0.0, f32::max);
            assert!(
                worst < 0.011,
                "{model:?}, frame {frame}: the length of a segment is wrong by {worst} of it"
            );
            let measured = simulation.measure(&[]).stretch_max as f32;
            assert!((measured - worst).abs() < 1e-4, "{model:?}: measured {measured}, output {worst}");
        }
    }
}

#[test]
fn other_counts_and_substeps_stay_bounded() {
    for (points, substeps) in [(3, 4), (4, 1), (16, 2), (100, 4), (200, 8)] {
        let mut bench = Bench::new(40, points, Solver { substeps, ..Solver::default() });
        for frame in 0..120 {
            assert_eq!(bench.step().reset_strands, 0, "{points} points, {substeps} substeps, frame {frame}");
        }
        let m = bench.measure();
        assert!(m.stretch_max < 0.011, "{points} points, {substeps} substeps: {m:?}");
    }
}

/// Duration of the violent motion [s], and the time after it when all lengths must be right again [s].
const VIOLENCE: f32 = 60.0;
const FORGOTTEN: f32 = 0.5;

/// Strands of mixed lengths and point counts, of each of these `materials`. One is folded onto itself, and
/// one has a segment of zero length and one of nearly zero length. Their root moves by `motion` for a
/// minute, in frames of the durations that `frames` gives, and then rests. With a volume method the root is
/// on a head, a ball of 20 cm, and each material has its own place there. Without one, strands do not interact.
fn shaken(
    what: &str,
    (materials, method): (&[Material], VolumeMethod),
    gravity: f32,
    frames: impl Fn(u32) -> f32,
    motion: impl Fn(f32) -> RigidTransform,
) -> Simulation {
    let alone = method == VolumeMethod::Off;
    let root = Vec3::new(0.3, 1.0, 0.0);
    let center = Vec3::Y * -HEAD;
    let strands = |group: u16| {
        let aside = if alone { Vec2::ZERO } else { PLACES[usize::from(group)] * 0.2 };
        let out = Vec3::new(aside.x, 1.0, aside.y).normalize();
        let root = root + center + out * HEAD;
        let line = |count: usize, length: f32| line(root, root + out * length, count);
        let mut folded = line(12, 0.2);
        folded.extend(line(12, 0.2).into_iter().rev().skip(1));
        let mut uneven = line(16, 0.2);
        uneven[5] = uneven[4];
        uneven[9] = uneven[8] + out * 1e-7;
        [line(3, 0.01), line(24, 0.3), line(64, 1.0), folded, uneven].map(|strand| (group, strand))
    };
    let (groups, strands): (Vec<u16>, Vec<_>) = (0..materials.len() as u16).flat_map(strands).unzip();
    let mut groom = Groom::from_strands(strands, 35e-6);
    groom.groups = groups;
    let count = groom.strand_count();
    let head = ColliderShape::Sphere { center, radius: HEAD };
    let at_rest = translation(root);
    let rest = MovingCollider::at_rest(head.clone(), at_rest).end_pose();
    let mut simulation = Simulation::builder(groom)
        .materials(materials)
        // The solver itself must survive the jump, so teleports are disabled.
        .solver(Solver { teleport_distance: f32::MAX, ..Solver::default() })
        .gravity(Vec3::NEG_Y * gravity)
        .colliders_at_rest(if alone { &[] } else { std::slice::from_ref(&rest) })
        .build()
        .unwrap();
    simulation.set_volume(&Volume { method, ..Volume::default() }).unwrap();
    let mut before = at_rest;
    let (mut time, mut frame) = (0.0, 0);
    while time < VIOLENCE + FORGOTTEN {
        let dt = if time < VIOLENCE { frames(frame) } else { FRAME };
        time += dt;
        frame += 1;
        let pose = motion(time.min(VIOLENCE));
        let pose = RigidTransform { translation: pose.translation + root, rotation: pose.rotation };
        let body = [MovingCollider::new(head.clone(), before, pose)];
        before = pose;
        let (roots, air) = (vec![pose; count], Air::default());
        let colliders: &[MovingCollider] = if alone { &[] } else { &body };
        let report = simulation.step(&StepInput { dt, anchor: pose, roots: &roots, colliders, air });
        assert_eq!(report.reset_strands, 0, "{what}, {method:?}, {time} s: one of {materials:?}");
    }
    simulation
}

/// Radius of a head [m].
const HEAD: f32 = 0.1;

/// Directions from the top of a head to the places of the materials, which are 2 cm away.
const PLACES: [Vec2; PRESETS.len()] = [Vec2::ZERO, Vec2::X, Vec2::NEG_X, Vec2::Y, Vec2::NEG_Y];

#[test]
fn violent_motion_leaves_no_trace() {
    violence(&[VolumeMethod::Off], &[1e-4, 1.0, 1e4]);
}

#[test]
fn violent_motion_with_a_head_and_volume_leaves_no_trace() {
    violence(&[VolumeMethod::Density, VolumeMethod::Incompressible], &[1.0]);
}

/// Shakes every preset with every model and these multiples of its stiffness. The materials of one model share tiles of
/// eight strands, and a head, which takes a third of the time.
fn violence(methods: &[VolumeMethod], stiffnesses: &[f32]) {
    let materials = |model: Model| -> Vec<Material> {
        let presets = PRESETS.iter().map(|name| Material { model, ..preset(name).unwrap() });
        let multiples = |base: Material| {
            stiffnesses.iter().map(move |by| Material { bend: base.bend * by, ..base.clone() })
        };
        presets.flat_map(multiples).collect()
    };
    let cases: Vec<_> =
        methods.iter().flat_map(|method| Model::ALL.map(|model| (materials(model), *method))).collect();
    let even = |_: u32| FRAME;
    // From 1 to 100 ms.
    let uneven = |f: u32| 0.001 + 0.099 * ((f.wrapping_mul(0x9E37_79B9) >> 8) as f32 / (1 << 24) as f32);
    // 5 m in one frame, there and back.
    let teleport = |t: f32| translation(Vec3::X * if t.fract() < 0.5 { 5.0 } else { 0.0 });
    let spin =
        |t: f32| RigidTransform { rotation: Quat::from_rotation_y((t * 720.0 % 360.0).to_radians()), ..REST };
    let shake = |t: f32| translation(Vec3::X * (0.2 * (std::f32::consts::TAU * 2.0 * t).sin()));
    type Motion<'a> =
        (&'a str, f32, &'a (dyn Fn(u32) -> f32 + Sync), &'a (dyn Fn(f32) -> RigidTransform + Sync));
    let motions: [Motion; 5] = [
        ("teleport", 9.81, &even, &teleport),
        ("spin", 9.81, &even, &spin),
        ("shake", 9.81, &even, &shake),
        ("uneven frames", 9.81, &uneven, &shake),
        ("gravity x 20", 196.2, &even, &shake),
    ];
    cases.par_iter().for_each(|(materials, method)| {
        motions.par_iter().for_each(|&(what, gravity, frames, motion)| {
            let end = shaken(what, (materials, *method), gravity, frames, motion).measure(&[]);
            assert!(end.stretch_max < 0.011, "{what}, {method:?}: {end:?} of {materials:?}");
        });
    });
}

#[test]
fn a_non_finite_strand_is_reset_and_counted_without_affecting_others() {
    let strand = |x: f32| (0..16).map(|i| Vec3::new(x, 0.0, 0.01 * i as f32)).collect::<Vec<_>>();
    let groom = Arc::new(Groom::from_strands([strand(0.0), strand(0.1)], 35e-6));
    let start = || {
        Simulation::builder(groom.clone())
            .solver(Solver { sag_free: false, ..Solver::default() })
            .build()
            .unwrap()
    };
    let pose = |x: f32| translation(Vec3::X * x);
    let run = |poisoned: Option<u32>| {
        let mut simulation = start();
        let mut resets = 0;
        for frame in 0..60 {
            let bad = if Some(frame) == poisoned { f32::NAN } else { 0.1 };
            let (roots, air) = ([pose(0.0), pose(bad)], Air::default());
            let input = StepInput { dt: FRAME, anchor: REST, roots: &roots, colliders: &[], air };
            resets += simulation.step(&input).reset_strands;
        }
        assert_eq!(simulation.measure(&[]).non_finite, 0);
        (points(&simulation), resets)
    };
    let (clean, none) = run(None);
    let (poisoned, some) = run(Some(20));
    assert_eq!(none, 0);
    assert!(
        (1..=2).contains(&some),
        "{some} resets instead of one or two: in the invalid frame and in the one after it"
    );
    assert_eq!(clean[..16], poisoned[..16], "the other strand changed");
    assert!(poisoned.iter().all(|p| p.is_finite()));
}
