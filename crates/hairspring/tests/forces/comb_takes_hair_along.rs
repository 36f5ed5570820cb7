//! Promise: a comb moves hair across itself, slides along hair, and releases it at the tip, without
//! stretching it.
//!
//! A curtain of strands hangs from a rail. A comb moves through it at 0.3 m/s, across the strands and down
//! along them.

use glam::Vec3;
use hairspring::{
    forces::{Manipulator, comb::Comb},
    groom::Groom,
    material::{Material, Model},
    math::RigidTransform,
    simulation::Simulation,
};
use hairspring_test::{FRAME, REST, farthest, points, roots, step, translation};

const POINTS: usize = 32;
const SEGMENT: f32 = 0.008;
const STRANDS: usize = 24;
const SPEED: f32 = 0.3;

struct Curtain {
    simulation: Simulation,
    roots: Vec<RigidTransform>,
    points: Vec<Vec3>,
    before: Vec<Vec3>,
}

impl Curtain {
    fn new(model: Model) -> Self {
        let strands = (0..STRANDS).map(|s| {
            let x = (s as f32 - 11.5) * 0.004;
            (0..POINTS).map(move |i| Vec3::new(x, -SEGMENT * i as f32, 0.0)).collect::<Vec<_>>()
        });
        let groom = Groom::from_strands(strands, 40e-6);
        let (roots, points) = (roots(&groom, REST), groom.points.clone());
        let material = Material { model, drag: 0.1, ..Material::default() };
        let simulation = Simulation::builder(groom).materials(&[material]).build().unwrap();
        Self { simulation, roots, before: points.clone(), points }
    }

    fn step(&mut self) {
        step(&mut self.simulation, REST, &self.roots, &[]);
        self.before = std::mem::replace(&mut self.points, points(&self.simulation));
        let stretch = self.simulation.measure(&[]).stretch_max;
        assert!(stretch < 0.011, "the stretch of a segment is {stretch}");
    }

    /// The mean position of point `i` over all strands, and its velocity in the last frame.
    fn mean(&self, i: usize) -> (Vec3, Vec3) {
        let mean =
            |points: &[Vec3]| (0..STRANDS).map(|s| points[s * POINTS + i]).sum::<Vec3>() / STRANDS as f32;
        (mean(&self.points), (mean(&self.points) - mean(&self.before)) / FRAME)
    }
}

fn comb(at: Vec3) -> Manipulator {
    let half = Vec3::X * 0.08;
    Manipulator::Comb(Comb { a: at - half, b: at + half, radius: 0.015, grip: 1000.0, friction: 3.0 })
}

#[test]
fn a_comb_across_hair_takes_it_along() {
    for model in [Model::Curvature, Model::Rod, Model::Springs] {
        let mut curtain = Curtain::new(model);
        let home = curtain.points.clone();
        let start = Vec3::new(0.0, -0.16, -0.05);
        let id = curtain.simulation.add_manipulator(comb(start), REST);
        let mut way = 0.0;
        let mut carried = false;
        while way < 0.6 {
            way += SPEED * FRAME;
            curtain.simulation.set_manipulator_pose(id, translation(Vec3::Z * way));
            curtain.step();
            let comb = start.z + way;
            if (0.04..0.045).contains(&comb) {
                carried = true;
                let (at, velocity) = curtain.mean(20);
                // Hair may slide along its own direction. Across, it moves with the comb, except that it
                // rotates about its root: a point 6 mm nearer to the root is slower.
                let along = (curtain.mean(21).0 - curtain.mean(19).0).normalize();
                let slip = (velocity - Vec3::Z * SPEED).reject_from_normalized(along).length();
                println!(
                    "{model:?}: comb at {comb} m, hair at {at}, velocity {velocity} m/s, slip {slip} m/s"
                );
                assert!((at.z - comb).abs() < 0.015, "{model:?}: the comb is at {comb}, hair at {at}");
                assert!(slip < 0.2 * SPEED, "{model:?}: hair slips through the comb at {slip} m/s");
            }
        }
        assert!(carried, "the comb was not measured in the hair");
        // The comb is out of reach and has released the tips.
        for _ in 0..480 {
            curtain.step();
        }
        let offset = farthest(&curtain.points, &home);
        println!("{model:?}: offset {offset} m eight seconds later");
        assert!(offset < 0.002, "{model:?}: the offset is {offset} m");
    }
}

#[test]
fn a_comb_along_hair_slides() {
    let mut curtain = Curtain::new(Model::Curvature);
    let home = curtain.points.clone();
    let id = curtain.simulation.add_manipulator(comb(Vec3::new(0.0, 0.03, 0.0)), REST);
    let mut fastest = 0.0f64;
    for frame in 1..=72 {
        let way = SPEED * FRAME * frame as f32;
        curtain.simulation.set_manipulator_pose(id, translation(Vec3::NEG_Y * way));
        curtain.step();
        fastest = fastest.max(curtain.simulation.measure(&[]).speed_max);
    }
    let offset = farthest(&curtain.points, &home);
    println!("at most {fastest} m/s, offset {offset} m");
    assert!(fastest < 0.1 * f64::from(SPEED), "straight hair moves with the comb at {fastest} m/s");
    assert!(offset < 0.001, "the offset is {offset} m");
}
