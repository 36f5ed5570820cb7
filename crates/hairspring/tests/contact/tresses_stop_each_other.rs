//! Promise: two tresses that swing into each other stop each other, with the volume methods as with strand
//! contact, at any frame rate and with cells of twice the size.
//!
//! The center of a tress is the mean of its points. With a volume method it stays on its side of the
//! middle. It stops within a tenth of the tress's width of where it stops with strand contact
//! (`neighbours`). A shaken bundle has the same width, within a tenth, at 24, 60 and 240 Hz, with cells of
//! twice the size, and with strand contact. Common motion is not slowed: a single tress swings as far as
//! without a volume method.

use glam::Vec3;
use hairspring::{
    groom::Groom,
    material::{Material, Model},
    settings::{Neighbours, Solver, Volume, VolumeMethod},
    simulation::Simulation,
};
use hairspring_test::{REST, points, roots, step_by, translation};
use std::sync::Arc;

const METHODS: [VolumeMethod; 2] = [VolumeMethod::Density, VolumeMethod::Incompressible];

/// Golden angle [rad]: with it, points of a disc at r = R √k are evenly spread.
const TURN: f32 = 2.399_963;

/// How strands interact.
#[derive(Clone, Copy, Debug, Default)]
struct Interaction {
    method: VolumeMethod,
    /// Edge of a cell [m].
    cell: Option<f32>,
    /// Whether strand contact is on.
    neighbours: bool,
}

impl Interaction {
    fn volume(method: VolumeMethod) -> Self {
        Self { method, ..Self::default() }
    }

    fn set(&self, simulation: &mut Simulation) {
        simulation.set_volume(&Volume { method: self.method, cell: self.cell, ..Volume::default() }).unwrap();
        simulation.set_neighbours(&Neighbours { on: self.neighbours, ..Neighbours::default() }).unwrap();
    }
}

/// Evenly spread points in a disc.
fn disc(count: usize, radius: f32) -> impl Iterator<Item = (f32, f32)> {
    (0..count).map(move |k| {
        let (sin, cos) = (TURN * k as f32).sin_cos();
        let r = radius * ((k as f32 + 0.5) / count as f32).sqrt();
        (r * cos, r * sin)
    })
}

/// A straight strand of about `length`; lengths of adjacent strands differ.
fn strand(k: usize, root: Vec3, direction: Vec3, length: f32, points: usize) -> Vec<Vec3> {
    let length = length * (0.95 + 0.1 * (k * 7919 % 1000) as f32 / 1000.0);
    (0..points).map(|i| root + direction * (length * i as f32 / (points - 1) as f32)).collect()
}

fn simulation(groom: &Arc<Groom>, material: Material, sag_free: bool) -> Simulation {
    let solver = Solver { sag_free, ..Solver::default() };
    Simulation::builder(groom.clone()).materials(&[material]).solver(solver).build().unwrap()
}

/// Two tresses side by side. They hang from discs that touch, and are released far apart.
#[derive(Clone, Copy)]
struct Tresses {
    strands: usize,
    points: usize,
    /// Radius of the disc [m].
    radius: f32,
    /// Length of a strand [m].
    length: f32,
    /// Angle above the horizontal [rad].
    raised: f32,
}

/// 150 strands each, 20 cm long and 24 mm wide; they collide at 3 m/s.
const TRESSES: Tresses = Tresses { strands: 150, points: 24, radius: 0.012, length: 0.2, raised: -0.3 };

impl Tresses {
    fn strands(&self, side: f32) -> Vec<Vec<Vec3>> {
        let direction = Vec3::new(side * self.raised.cos(), self.raised.sin(), 0.0);
        let strand = |(k, (x, z)): (usize, (f32, f32))| {
            let root = Vec3::new(side * (self.radius + 0.001 - x), 0.0, z);
            strand(k, root, direction, self.length, self.points)
        };
        disc(self.strands, self.radius).enumerate().map(strand).collect()
    }

    /// The farthest position of the left tress's center in `seconds` [m]; a positive value is past the
    /// middle.
    fn farthest(&self, interaction: Interaction, fps: f32, seconds: f32, alone: bool) -> f32 {
        let mut strands = self.strands(-1.0);
        if !alone {
            strands.extend(self.strands(1.0));
        }
        let material = Material { bend: 0.05, drag: 0.1, ..Material::default() };
        let groom = Arc::new(Groom::from_strands(&strands, 35e-6));
        let mut simulation = simulation(&groom, material, false);
        interaction.set(&mut simulation);
        let roots = roots(&groom, REST);
        let mut farthest = f32::NEG_INFINITY;
        for _ in 0..(seconds * fps).round() as u32 {
            step_by(&mut simulation, 1.0 / fps, REST, &roots, &[]);
            let now = points(&simulation);
            let left = &now[..self.strands * self.points];
            farthest = farthest.max(left.iter().map(|p| p.x).sum::<f32>() / left.len() as f32);
        }
        farthest
    }
}

#[test]
fn tresses_stop_as_with_strand_contact_at_any_frame_rate_and_cell() {
    let bound = 0.1 * 2.0 * TRESSES.radius;
    let through = TRESSES.farthest(Interaction::default(), 60.0, 0.5, false);
    let strands =
        TRESSES.farthest(Interaction { neighbours: true, ..Interaction::default() }, 60.0, 0.5, false);
    println!(
        "{:.1} mm past the middle without interaction, {:.1} mm with strand contact",
        1e3 * through,
        1e3 * strands
    );
    assert!(
        through > 0.02 && strands < 0.0,
        "{through} m past the middle without interaction, {strands} m with strand contact"
    );
    for method in METHODS {
        let interaction = Interaction::volume(method);
        let position = |cell: Option<f32>, fps: f32| {
            TRESSES.farthest(Interaction { cell, ..interaction }, fps, 0.5, false)
        };
        let at_60 = position(None, 60.0);
        println!("{method:?}: {:.1} mm past the middle", 1e3 * at_60);
        assert!((at_60 - strands).abs() < bound, "{method:?}: {at_60} m, with strand contact {strands} m");
        for fps in [24.0, 30.0, 240.0] {
            let other = position(None, fps);
            println!("{method:?}: {:.1} mm at {fps} Hz", 1e3 * other);
            assert!(other < 0.0 && (other - at_60).abs() < 0.5 * bound, "{method:?}: {other} m at {fps} Hz");
        }
        // The default cell is 8.7 mm.
        for cell in [0.006, 0.0174] {
            let other = position(Some(cell), 60.0);
            println!("{method:?}: {:.1} mm in cells of {cell} m", 1e3 * other);
            assert!(
                other < 0.0 && (other - at_60).abs() < bound,
                "{method:?}: {other} m in cells of {cell} m"
            );
        }
    }
}

#[test]
fn tresses_do_not_pass_through_each_other() {
    let thin = Tresses { strands: 40, radius: 0.005, ..TRESSES };
    let few = Tresses { strands: 20, points: 12, ..thin };
    let wide = Tresses { strands: 60, radius: 0.02, ..TRESSES };
    let fast = Tresses { length: 0.4, points: 40, raised: 0.9, ..TRESSES };
    let dense = Tresses { strands: 500, ..TRESSES };
    for (name, tresses) in [("thin", thin), ("few", few), ("wide", wide), ("fast", fast), ("dense", dense)] {
        for method in METHODS {
            for fps in [24.0, 240.0] {
                let farthest = tresses.farthest(Interaction::volume(method), fps, 0.7, false);
                println!("{name}, {method:?}, {fps} Hz: {:.1} mm past the middle", 1e3 * farthest);
                assert!(farthest < 0.0, "{name}, {method:?}, {fps} Hz: {farthest} m past the middle");
            }
        }
    }
}

#[test]
fn a_single_tress_is_not_slowed() {
    let free = TRESSES.farthest(Interaction::default(), 60.0, 0.5, true);
    for method in METHODS {
        let braked = TRESSES.farthest(Interaction::volume(method), 60.0, 0.5, true);
        println!(
            "{method:?}: {:.1} mm past the middle, {:.1} mm without interaction",
            1e3 * braked,
            1e3 * free
        );
        assert!(braked > 0.85 * free, "{method:?}: {braked} m past the middle, {free} m without interaction");
    }
}

/// Mean distance of the points of a hanging bundle from its axis after three seconds of shaking [m].
fn shaken(strands: usize, interaction: Interaction, fps: f32) -> f32 {
    let (count, radius) = (24, 0.02 * (strands as f32 / 300.0).sqrt());
    let strands = disc(strands, radius)
        .enumerate()
        .map(|(k, (x, z))| strand(k, Vec3::new(x, 0.0, z), Vec3::NEG_Y, 0.2, count));
    let groom = Arc::new(Groom::from_strands(strands, 35e-6));
    let material = Material { model: Model::Curvature, ..Material::default() };
    let mut simulation = simulation(&groom, material, true);
    interaction.set(&mut simulation);
    for frame in 1..=(3.0 * fps).round() as u32 {
        let t = frame as f32 / fps;
        // 5 cm to each side at 2.5 Hz, from rest.
        let offset = 0.05 * (2.0 * t).min(1.0).powi(2) * (std::f32::consts::TAU * 2.5 * t).sin();
        let head = translation(Vec3::X * offset);
        step_by(&mut simulation, 1.0 / fps, head, &roots(&groom, head), &[]);
    }
    let now = points(&simulation);
    let mut sum = 0.0;
    for i in 0..count {
        let slice: Vec<Vec3> = now.iter().skip(i).step_by(count).copied().collect();
        let middle = slice.iter().sum::<Vec3>() / slice.len() as f32;
        sum += slice.iter().map(|p| (*p - middle).with_y(0.0).length()).sum::<f32>() / slice.len() as f32;
    }
    sum / count as f32
}

#[test]
fn width_of_a_shaken_bundle_is_independent_of_frame_rate_and_cell() {
    for method in METHODS {
        let interaction = Interaction::volume(method);
        let at_60 = shaken(300, interaction, 60.0);
        println!("{method:?}: {:.2} mm at 60 Hz", 1e3 * at_60);
        for fps in [24.0, 240.0] {
            let other = shaken(300, interaction, fps);
            println!("{method:?}: {:.2} mm at {fps} Hz", 1e3 * other);
            assert!(
                (other / at_60 - 1.0).abs() < 0.05,
                "{method:?}: {other} m at {fps} Hz, {at_60} m at 60 Hz"
            );
        }
        // The default cell is 8.7 mm.
        for cell in [0.006, 0.0174] {
            let other = shaken(300, Interaction { cell: Some(cell), ..interaction }, 60.0);
            println!("{method:?}: {:.2} mm in cells of {cell} m", 1e3 * other);
            assert!(
                (other / at_60 - 1.0).abs() < 0.1,
                "{method:?}: {other} m in cells of {cell} m, {at_60} m"
            );
        }
    }
}

#[test]
fn width_of_a_shaken_bundle_matches_strand_contact() {
    let strands = shaken(100, Interaction { neighbours: true, ..Interaction::default() }, 60.0);
    println!("{:.2} mm with strand contact", 1e3 * strands);
    for method in METHODS {
        let grid = shaken(100, Interaction::volume(method), 60.0);
        println!("{method:?}: {:.2} mm", 1e3 * grid);
        assert!((grid / strands - 1.0).abs() < 0.1, "{method:?}: {grid} m, {strands} m with strand contact");
    }
}
