//! Promise: a body that is fast takes hair along: an arm at 5 m/s all of it, a hand at 5 m/s and a rod of 1 cm at 20 m/s (83 mm
//! in a substep) more than half; and what it took along moves with it.
//!
//! A curtain of strands hangs from a rail; the body comes at full speed from behind, goes 20 cm beyond the curtain and stops. Strands that are
//! behind it then have let it pass: without the parts of a substep nearly all have. Where thin bodies should let none pass, as many as the
//! table below says may.

use glam::{Mat3, Vec3};
use hairspring::{
    collide::{Obstacle, Rigid},
    groom::Groom,
    material::{Material, Model},
    scene::Solver,
    simulation::{Air, Drive, MovingObstacle, Simulation},
};
use std::sync::Arc;

const FRAME: f32 = 1.0 / 60.0;
const POINTS: usize = 32;

/// A body, and what is asked of it.
struct Fast {
    name: &'static str,
    shape: Obstacle,
    /// Half of the width in which strands cannot slip off sideways [m].
    width: f32,
    /// [m/s]
    speed: f32,
    /// Share of those strands that may be behind it in the end [1].
    passed: f32,
}

fn bodies() -> [Fast; 4] {
    let rod = |radius: f32| Obstacle::Capsule { a: Vec3::X * -0.15, b: Vec3::X * 0.15, radius };
    let hand = |axes| Obstacle::Cuboid { center: Vec3::ZERO, half: Vec3::new(0.1, 0.05, 0.015), axes };
    let fast = |name, shape, width, speed, passed| Fast { name, shape, width, speed, passed };
    [
        fast("arm", rod(0.03), 0.1, 5.0, 0.0),
        fast("hand", hand(Mat3::IDENTITY), 0.08, 5.0, 0.4),
        fast("hand aslant", hand(Mat3::from_rotation_x(0.5)), 0.08, 5.0, 0.5),
        fast("rod of 1 cm", rod(0.005), 0.1, 20.0, 0.45),
    ]
}

/// A curtain 19 cm wide and 60 cm long in the plane of X and Y, its middle at the origin.
struct Curtain {
    simulation: Simulation,
    roots: Vec<Rigid>,
    points: Vec<Vec3>,
}

impl Curtain {
    fn new(model: Model) -> Self {
        let strands = (0..48).map(|s| {
            let x = (s as f32 - 23.5) * 0.004;
            // Points at other heights in every strand: a rod meets some of them and some segments.
            let length = 0.58 + 0.04 * (s as f32 * 0.618).fract();
            (0..POINTS)
                .map(move |i| Vec3::new(x, 0.3 - length * i as f32 / (POINTS - 1) as f32, 0.0))
                .collect::<Vec<_>>()
        });
        let groom = Arc::new(Groom::from_strands(strands, 40e-6));
        let all: Vec<u32> = (0..groom.strand_count() as u32).collect();
        let roots = all.iter().map(|s| groom.strand(*s as usize)[0]);
        let roots = roots.map(|translation| Rigid { translation, ..Rigid::default() }).collect();
        let simulation = Simulation::new(
            groom.clone(),
            &all,
            &[Material { model, ..Material::default() }],
            Solver::default(),
            Vec3::NEG_Y * 9.81,
            Rigid::default(),
            &[],
        );
        Self { simulation, roots, points: groom.points.clone() }
    }

    /// A frame in which `shape` goes from `start` to `end` along Z.
    fn step(&mut self, shape: &Obstacle, [start, end]: [f32; 2]) -> MovingObstacle {
        let at = |z: f32| Rigid { translation: Vec3::Z * z, ..Rigid::default() };
        let obstacle = MovingObstacle { shape: shape.clone(), start: at(start), end: at(end) };
        self.simulation.step(&Drive {
            dt: FRAME,
            anchor: Rigid::default(),
            roots: &self.roots,
            obstacles: std::slice::from_ref(&obstacle),
            air: Air::default(),
        });
        self.simulation.write_points(&mut self.points);
        obstacle
    }

    /// Strands within `width` of the middle that are behind a body at `z`, where they first come down to its height.
    fn behind(&self, width: f32, z: f32) -> usize {
        let strands = self.points.chunks(POINTS).filter(|s| s[0].x.abs() < width);
        strands
            .filter(|s| {
                let crossing = s.windows(2).find(|w| w[1].y <= 0.0 && w[0].y > 0.0);
                crossing.is_some_and(|w| w[0].lerp(w[1], w[0].y / (w[0].y - w[1].y)).z < z)
            })
            .count()
    }
}

#[test]
fn they_take_it_along() {
    for Fast { name, shape, width, speed, passed } in bodies() {
        for model in Model::ALL {
            let mut curtain = Curtain::new(model);
            let strands = curtain.roots.iter().filter(|root| root.translation.x.abs() < width).count();
            let at = |frame: i32| (-0.1 + speed * FRAME * frame as f32).min(0.2);
            let (mut deepest, mut longest) = (0.0f64, 0.0f64);
            for frame in 0..60 {
                let obstacle = curtain.step(&shape, [at(frame), at(frame + 1)]);
                let measure = curtain.simulation.measure(&[obstacle]);
                assert_eq!(measure.non_finite, 0, "{name}, {model:?}, frame {frame}");
                deepest = deepest.max(measure.max_depth);
                longest = longest.max(measure.stretch_max);
            }
            let behind = curtain.behind(width, 0.2);
            let front = curtain.points.iter().map(|p| p.z).fold(0.0, f32::max);
            println!(
                "{name}, {model:?}: {behind} of {strands} strands behind it; {:.3} mm deep; {longest:.4} longer; {front} m ahead",
                deepest * 1e3,
            );
            assert!(
                behind as f32 <= passed * strands as f32,
                "{name}, {model:?}: {behind} of {strands} passed"
            );
            assert!(longest < 0.011, "{name}, {model:?}: a segment {longest} longer");
            assert!(front > 0.15, "{name}, {model:?}: nothing was taken along");
        }
    }
}

#[test]
fn what_it_took_along_moves_with_it() {
    let arm = Obstacle::Capsule { a: Vec3::X * -0.15, b: Vec3::X * 0.15, radius: 0.03 };
    for (speed, frames) in [(1.0, 12), (5.0, 2), (5.0, 3)] {
        let mut curtain = Curtain::new(Model::Auto);
        let from = -0.045;
        let at = |frame: i32| from + speed * FRAME * frame as f32;
        let mut before = Vec::new();
        for frame in 0..frames {
            before.clone_from(&curtain.points);
            curtain.step(&arm, [at(frame), at(frame + 1)]);
        }
        // What touches it: within 5 mm of its surface.
        let axis = Vec3::Z * at(frames);
        let radius = 0.03;
        let touching = curtain.points.iter().zip(&before).filter(|(p, _)| {
            let off = **p - axis;
            off.y.abs() < radius && off.z > 0.0 && off.y.hypot(off.z) < radius + 5e-3
        });
        let speeds: Vec<f32> = touching.map(|(p, q)| (p.z - q.z) / FRAME).collect();
        let mean = speeds.iter().sum::<f32>() / speeds.len().max(1) as f32;
        println!("{speed} m/s: {} points touch it, {mean} m/s in the mean", speeds.len());
        assert!(speeds.len() > 20, "{speed} m/s: {} points touch it", speeds.len());
        assert!((0.8..1.5).contains(&(mean / speed)), "{speed} m/s: hair has {mean} m/s");
    }
}
