//! Promise: contacts between strands carry weight, have Coulomb friction, and hold by stiction up to the
//! given force and not beyond. They keep a squeezed bundle apart, do not disturb a start at rest, and give
//! the same bits on any number of threads.
//!
//! The closed forms are those of ropes and blocks. Over a smooth bar, the tension is the same on both
//! sides, so the bar carries N = |T u₁ − T u₂|. A strand that is pressed with N sticks while a force below
//! μN pulls it sideways, and slides above that. Momentum, which impulses preserve up to rounding, is tested
//! beside the code (`strand_contact/tests.rs`).

use glam::{Mat3, Vec3};
use hairspring::{
    collide::{ColliderShape, MovingCollider},
    groom::Groom,
    material::{Material, Model},
    math::RigidTransform,
    settings::{Neighbours, Solver, Volume, VolumeMethod},
    simulation::{Hold, Simulation},
};
use hairspring_test::{FRAME, REST, farthest, line, on_threads, points, roots, step, translation};
use hairspring_validate::bench::Bench;
use std::sync::Arc;

const ON: Neighbours = Neighbours { on: true, radius: Some(0.001), friction: 0.0, stiction: 0.0 };

/// Strands in still air without other interactions, on fixed roots.
struct Strands {
    groom: Arc<Groom>,
    simulation: Simulation,
    roots: Vec<RigidTransform>,
    colliders: Vec<MovingCollider>,
}

impl Strands {
    fn new(strands: &[Vec<Vec3>], material: Material, gravity: Vec3, neighbours: Neighbours) -> Self {
        let groom = Arc::new(Groom::from_strands(strands, 4e-5));
        let solver = Solver { sag_free: false, ..Solver::default() };
        let mut simulation = Simulation::builder(groom.clone())
            .materials(&[material])
            .solver(solver)
            .gravity(gravity)
            .build()
            .unwrap();
        simulation.set_neighbours(&neighbours).unwrap();
        let roots = roots(&groom, REST);
        Self { groom, simulation, roots, colliders: Vec::new() }
    }

    fn play(&mut self, seconds: f32) {
        for _ in 0..(seconds * 60.0).round() as u32 {
            step(&mut self.simulation, REST, &self.roots, &self.colliders);
        }
    }

    fn points(&self) -> Vec<Vec<Vec3>> {
        let now = points(&self.simulation);
        (0..self.groom.strand_count()).map(|s| now[self.groom.range(s)].to_vec()).collect()
    }

    /// Holds all points of a strand in place.
    fn bar(&self, strand: usize) -> Vec<Hold> {
        let points = self.groom.strand(strand);
        let hold = |i: usize| Hold {
            strand: strand as u32,
            point: i as u32,
            target: Some(points[i]),
            ..Hold::default()
        };
        (2..points.len()).map(hold).collect()
    }
}

/// Hair with very little bending stiffness and little drag in still air.
fn limp() -> Material {
    Material { bend: 0.01, drag: 1.0, model: Model::Curvature, ..Material::default() }
}

/// Hair with the curvature model, which has no twist.
fn hair() -> Material {
    Material { model: Model::Curvature, ..Material::default() }
}

const GRAVITY: Vec3 = Vec3::new(0.0, -9.81, 0.0);

#[test]
fn a_strand_that_lies_over_a_bar_is_supported() {
    // A bar, and a strand with its root beside it that falls over it.
    let bar = line(Vec3::new(0.0, 0.0, -0.035), Vec3::new(0.0, 0.0, 0.035), 8);
    let rope = line(Vec3::new(-0.05, 0.01, 0.0), Vec3::new(0.20, 0.01, 0.0), 26);
    let mut strands = Strands::new(&[bar, rope], limp(), GRAVITY, ON);
    let holds = strands.bar(0);
    strands.simulation.set_holds(&holds);
    strands.play(5.0);
    let rope = &strands.points()[1];
    let report = strands.simulation.neighbours().unwrap();
    // The joint that lies on the bar.
    let k = (2..24).min_by(|a, b| rope[*a].x.abs().total_cmp(&rope[*b].x.abs())).unwrap();
    let side = |i: usize| (rope[i + 1] - rope[i]).normalize() * strands.simulation.tension_at(1, i);
    let weight = GRAVITY * (5.0 * 0.01 * 1300.0 * std::f32::consts::PI * 4e-5 * 4e-5);
    let borne = (side(k + 2) - side(k - 3) + weight).length();
    println!("N is {} N, from tensions {borne} N, depth {} m", report.force, report.depth);
    assert!(
        (report.force / borne - 1.0).abs() < 0.01,
        "the contact force is {} N instead of {borne} N",
        report.force
    );
    assert!(report.depth < 0.01 * 0.001, "the penetration is {} m", report.depth);
    let fastest = (0..26).map(|i| strands.simulation.speed_at(1, i)).fold(0.0, f32::max);
    assert!(fastest < 1e-3, "the strand moves at {fastest} m/s");
}

/// A strand across a bar, loaded at two joints by `press` downward and by `pull` along the bar [N]. Returns
/// how far the segment slides in a second under the full pull.
fn rubbed(press: f32, pull: f32, friction: f32) -> f32 {
    let bar = line(Vec3::new(0.0, 0.0, -0.035), Vec3::new(0.0, 0.0, 0.035), 8);
    let rope = line(Vec3::new(-0.105, 0.002, 0.0), Vec3::new(0.105, 0.002, 0.0), 22);
    let mut strands = Strands::new(&[bar, rope], hair(), Vec3::ZERO, Neighbours { friction, ..ON });
    let bar = strands.bar(0);
    let loads = |pull: f32| {
        let at = |point: u32| Hold {
            strand: 1,
            point,
            force: Vec3::new(0.0, -press, pull) * 0.5,
            ..Hold::default()
        };
        [&bar[..], &[at(10), at(11)]].concat()
    };
    strands.simulation.set_holds(&loads(0.0));
    strands.play(0.5);
    // The force grows slowly, so that it does not act as an impact.
    for k in 1..=60 {
        strands.simulation.set_holds(&loads(pull * k as f32 / 60.0));
        strands.play(FRAME);
    }
    strands.play(0.5);
    let before = strands.points()[1][10].z;
    strands.play(1.0);
    strands.points()[1][10].z - before
}

#[test]
fn a_strand_sticks_below_the_friction_limit() {
    let (press, friction) = (2e-5, 0.4);
    let stuck = rubbed(press, 0.95 * friction * press, friction);
    let slid = rubbed(press, 1.10 * friction * press, friction);
    assert!(stuck.abs() < 2e-5, "below μN the strand moved by {stuck} m");
    assert!(slid > 2e-3, "above μN the strand moved by only {slid} m");
}

/// The distance of a strand from a bar that it was pressed against, a quarter of a second after a force [N]
/// pulls it away, and the number of bonds.
fn torn(stiction: f32, pull: f32) -> (f32, usize) {
    let bar = line(Vec3::new(0.0, 0.0, -0.035), Vec3::new(0.0, 0.0, 0.035), 8);
    let rope = line(Vec3::new(-0.105, 0.0021, 0.0), Vec3::new(0.105, 0.0021, 0.0), 22);
    let mut strands = Strands::new(&[bar, rope], hair(), Vec3::ZERO, Neighbours { stiction, ..ON });
    let bar = strands.bar(0);
    let loads = |force: f32| {
        let at = |point: u32| Hold { strand: 1, point, force: Vec3::Y * (0.5 * force), ..Hold::default() };
        [&bar[..], &[at(10), at(11)]].concat()
    };
    strands.simulation.set_holds(&loads(-5e-6));
    strands.play(0.5);
    assert!(
        stiction == 0.0 || strands.simulation.neighbours().unwrap().stuck_pairs > 0,
        "{:?}",
        strands.simulation.neighbours()
    );
    // The force grows slowly, so that it does not act as an impact.
    for k in 1..=60 {
        strands.simulation.set_holds(&loads(pull * k as f32 / 60.0));
        strands.play(FRAME);
    }
    strands.play(0.25);
    (strands.points()[1][10].y - 0.002, strands.simulation.neighbours().unwrap().stuck_pairs)
}

#[test]
fn a_bond_breaks_at_its_force() {
    let stiction = 1e-5;
    let (held, bonds) = torn(stiction, 0.93 * stiction);
    assert!(held < 1e-4 && bonds == 1, "below its force the bond: {held} m away, {bonds} bonds");
    let (distance, bonds) = torn(stiction, 1.07 * stiction);
    assert!(distance > 1e-3 && bonds == 0, "above its force the bond: {distance} m away, {bonds} bonds");
    assert!(torn(0.0, 0.1 * stiction).0 > 1e-3, "the strand was held without stiction");
}

/// Two walls press a bundle to two thirds of its width. Returns the mean distance of its tips to the
/// nearest other tip, relative to that at rest.
fn squeezed(neighbours: Neighbours) -> f32 {
    let (side, step) = (6, 0.003);
    let place = |k: usize| (k as f32 - 0.5 * (side - 1) as f32) * step;
    let strand = |s: usize| {
        let root = Vec3::new(place(s % side), 0.0, place(s / side));
        line(root, root + Vec3::NEG_Y * 0.15, 16)
    };
    let all: Vec<Vec<Vec3>> = (0..side * side).map(strand).collect();
    let mut strands = Strands::new(&all, Material::default(), GRAVITY, neighbours);
    for frame in 0..120 {
        let wall = |side: f32| {
            let at = |frame: i32| {
                let inward = 0.003 * (frame as f32 / 60.0).min(1.0);
                translation(Vec3::X * (side * (0.009 - inward)))
            };
            let (center, half) = (Vec3::new(side * 0.02, -0.13, 0.0), Vec3::new(0.02, 0.04, 0.1));
            MovingCollider::new(
                ColliderShape::Cuboid { center, half, axes: Mat3::IDENTITY },
                at(frame),
                at(frame + 1),
            )
        };
        strands.colliders = vec![wall(-1.0), wall(1.0)];
        strands.play(FRAME);
    }
    let tips: Vec<Vec3> = strands.points().iter().map(|s| s[15]).collect();
    let nearest = |a: usize| {
        let others = (0..tips.len()).filter(|b| *b != a);
        others.map(|b| tips[a].distance(tips[b])).fold(f32::MAX, f32::min)
    };
    (0..tips.len()).map(nearest).sum::<f32>() / tips.len() as f32 / step
}

#[test]
fn a_squeezed_bundle_stays_apart() {
    let without = squeezed(Neighbours::default());
    let with = squeezed(Neighbours { on: true, ..Neighbours::default() });
    println!("nearest tips: {without} of the distance at rest without contact, {with} with it");
    assert!(without < 0.75, "without contact {without}");
    assert!(with > 0.9, "with contact {with}");
}

#[test]
fn contacts_do_not_disturb_hair_at_rest() {
    // Straight hair, and curls that pass through each other.
    let curl = |s: usize| {
        let root = Vec3::new(0.004 * (s % 5) as f32, 0.0, 0.004 * (s / 5) as f32);
        let turn = |i: usize| 0.5 * i as f32 + s as f32;
        (0..32)
            .map(|i| root + Vec3::new(0.004 * turn(i).sin(), -0.004 * i as f32, 0.004 * turn(i).cos()))
            .collect()
    };
    let straight = |s: usize| {
        let root = Vec3::new(0.002 * (s % 5) as f32, 0.0, 0.002 * (s / 5) as f32);
        line(root, root + Vec3::NEG_Y * 0.2, 24)
    };
    for (name, all) in [
        ("straight", (0..25).map(straight).collect::<Vec<_>>()),
        ("curls", (0..25).map(curl).collect::<Vec<_>>()),
    ] {
        let groom = Arc::new(Groom::from_strands(&all, 4e-5));
        let roots = roots(&groom, REST);
        let played = |neighbours: Neighbours| {
            let mut simulation = Simulation::builder(groom.clone()).build().unwrap();
            simulation.set_neighbours(&neighbours).unwrap();
            step(&mut simulation, REST, &roots, &[]);
            let first = points(&simulation);
            (1..60).for_each(|_| _ = step(&mut simulation, REST, &roots, &[]));
            (first, points(&simulation))
        };
        let (first, last) = played(Neighbours::default());
        let (contact_first, contact_last) =
            played(Neighbours { on: true, stiction: 1e-6, ..Neighbours::default() });
        let difference = farthest(&contact_last, &last);
        println!("{name}: {difference} m from the result without contact after a second");
        assert!(contact_first == first, "{name}: contact moved hair at rest");
        assert!(difference < 1e-4, "{name}: {difference} m from the result without contact");
    }
}

/// Shaken hair on a ball, with many contacts.
fn shaken(neighbours: Neighbours, threads: usize, frames: u32) -> (Vec<Vec3>, Bench) {
    on_threads(threads, || {
        let mut bench = Bench::new(150, 16, Solver::default());
        bench.simulation.set_neighbours(&neighbours).unwrap();
        (0..frames).for_each(|_| assert_eq!(bench.step().reset_strands, 0));
        (points(&bench.simulation), bench)
    })
}

#[test]
fn contacts_are_independent_of_threads() {
    let neighbours = Neighbours { on: true, radius: Some(0.002), stiction: 1e-6, ..Neighbours::default() };
    let (one, bench) = shaken(neighbours, 1, 60);
    let report = bench.simulation.neighbours().unwrap();
    println!("{report:?}");
    assert!(report.touching_pairs > 50, "too few strands are in contact: {report:?}");
    for threads in [2, 7] {
        assert!(shaken(neighbours, threads, 60).0 == one, "other bits on {threads} threads");
    }
}

#[test]
fn folded_strands_in_a_heap_stay_finite_and_keep_their_lengths() {
    // Random walks in a box of 5 cm fall, with their roots shaken for eight of ten seconds.
    let mut seed = 7_u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32 - 0.5
    };
    let mut vector = || Vec3::new(random(), random(), random());
    let all: Vec<Vec<Vec3>> = (0..40)
        .map(|_| {
            let mut at = vector() * 0.05;
            (0..20)
                .map(|_| {
                    at += vector().normalize_or(Vec3::Y) * 0.008;
                    at
                })
                .collect()
        })
        .collect();
    let neighbours = Neighbours { on: true, radius: Some(0.003), stiction: 1e-6, ..Neighbours::default() };
    let mut strands = Strands::new(&all, Material::default(), GRAVITY, neighbours);
    let rest: Vec<Vec3> = strands.roots.iter().map(|r| r.translation).collect();
    let mut worst = 0.0_f32;
    for frame in 0..600 {
        let shift = 0.05 * (0.2 * frame as f32).sin() * if frame < 480 { 1.0 } else { 0.0 };
        for (root, at) in strands.roots.iter_mut().zip(&rest) {
            root.translation = *at + Vec3::X * shift;
        }
        strands.play(FRAME);
        for s in 0..40 {
            for i in 0..19 {
                worst = worst.max(strands.simulation.stretch_at(s, i).abs());
            }
        }
    }
    let finite = strands.points().iter().flatten().all(|p| p.is_finite());
    let speeds = (0..800).map(|k| strands.simulation.speed_at(k / 20, k % 20));
    let mean = speeds.sum::<f32>() / 800.0;
    println!("stretch {worst}, {mean} m/s, {:?}", strands.simulation.neighbours().unwrap());
    assert!(finite && worst < 0.011, "stretch {worst}");
    assert!(mean < 0.05, "two seconds after the shake the mean speed of points is {mean} m/s");
}

#[test]
fn strand_contact_keeps_volume_of_a_shaken_head() {
    let measured =
        Volume { method: VolumeMethod::Density, friction: 0.0, pressure: 0.0, ..Volume::default() };
    let kept = |volume: Volume, neighbours: Neighbours| {
        let mut bench = Bench::new(300, 20, Solver::default());
        bench.simulation.set_volume(&volume).unwrap();
        bench.simulation.set_neighbours(&neighbours).unwrap();
        let mut sum = 0.0;
        for frame in 0..180 {
            assert_eq!(bench.step().reset_strands, 0);
            if frame >= 120 {
                sum += bench.simulation.volume().unwrap().volume_ratio / 60.0;
            }
        }
        sum
    };
    let none = Neighbours::default();
    let without = kept(measured, none);
    let strands = kept(measured, Neighbours { on: true, ..none });
    println!("kept: without {without}, strands {strands}");
    assert!(
        strands > without + 0.1,
        "strand contact keeps {strands} of the volume, and {without} is left without it"
    );
}

/// A strand falls across a web of strands stretched side by side; returns its tip two seconds later [m].
fn dropped_on_a_web(volume: VolumeMethod, on: bool) -> Vec3 {
    let web = (0..16).map(|k| {
        let x = 0.004 * (k as f32 - 7.5);
        line(Vec3::new(x, 0.0, -0.05), Vec3::new(x, 0.0, 0.05), 11)
    });
    let fallen = line(Vec3::new(-0.06, 0.005, 0.0), Vec3::new(0.14, 0.005, 0.0), 21);
    let neighbours = Neighbours { on, radius: Some(0.001), ..Neighbours::default() };
    let mut strands = Strands::new(&web.chain([fallen]).collect::<Vec<_>>(), limp(), GRAVITY, neighbours);
    strands.simulation.set_volume(&Volume { method: volume, ..Volume::default() }).unwrap();
    // The web is fixed at both of its sides.
    let held = |strand: u32| Hold {
        strand,
        point: 10,
        target: Some(strands.groom.strand(strand as usize)[10]),
        ..Hold::default()
    };
    let holds: Vec<Hold> = (0..16).map(held).collect();
    strands.simulation.set_holds(&holds);
    strands.play(2.0);
    strands.points()[16][20]
}

#[test]
fn a_web_with_strand_contact_holds_a_falling_strand() {
    for volume in VolumeMethod::ALL {
        let [through, held] = [false, true].map(|on| dropped_on_a_web(volume, on));
        println!("{volume:?}: the tip is at {through} without strand contact, at {held} with it");
        assert!(
            through.x < -0.03,
            "{volume:?}: without strand contact the strand did not fall through: {through}"
        );
        assert!(held.x > 0.02, "{volume:?}: with strand contact the strand fell through the web: {held}");
    }
}
