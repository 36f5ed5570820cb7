//! Promise: friction holds. Hair at rest on a slope of 20° that is rougher than steep (μ = 0.4, tan 20° = 0.364) creeps by less than 0.1 mm in ten seconds, and
//! slides down where the slope is smoother (μ = 0.3).
//!
//! Strands lie across the slope, so that their roots hold nothing of them but what is near; limp ones and human ones, every model. The slope stays level and
//! gravity tilts.

use glam::Vec3;
use hairspring::{
    collide::{Obstacle, Rigid},
    groom::Groom,
    material::{Material, Model},
    scene::Solver,
    simulation::{Air, Drive, MovingObstacle, Simulation},
};
use std::sync::Arc;

/// How far any point goes in the first two seconds, and in the ten after them [m].
fn moved(model: Model, friction: f32, bend: f32) -> [f32; 2] {
    let strands = (0..8).map(|s| {
        let root = Vec3::Z * (0.02 * s as f32);
        (0..25).map(move |i| root + Vec3::X * (0.01 * i as f32)).collect::<Vec<_>>()
    });
    let groom = Arc::new(Groom::from_strands(strands, 40e-6));
    let all: Vec<u32> = (0..8).collect();
    let roots: Vec<Rigid> =
        all.iter().map(|s| Rigid { translation: groom.strand(*s as usize)[0], ..Rigid::default() }).collect();
    let material = Material { model, friction, bend, ..Material::default() };
    let solver = Solver { sag_free: false, ..Solver::default() };
    let gravity = Vec3::new(0.0, -20f32.to_radians().cos(), 20f32.to_radians().sin()) * 9.81;
    let anchor = Rigid::default();
    let mut simulation = Simulation::new(groom, &all, &[material], solver, gravity, anchor, &[]);
    let slope = Obstacle::Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let obstacles = [MovingObstacle::at_rest(slope, Rigid::default())];
    let mut seconds = |seconds: usize| {
        for _ in 0..60 * seconds {
            let (dt, air) = (1.0 / 60.0, Air::default());
            simulation.step(&Drive { dt, anchor, roots: &roots, obstacles: &obstacles, air });
        }
        let mut points = vec![Vec3::ZERO; simulation.point_count()];
        simulation.write_points(&mut points);
        points
    };
    let [start, before, after] = [0, 2, 10].map(&mut seconds);
    let farthest = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    [farthest(&start, &before), farthest(&before, &after)]
}

#[test]
fn a_rough_slope_holds_hair_and_a_smooth_one_does_not() {
    for model in Model::ALL {
        for bend in [0.01, 1.0] {
            let [lay, crept] = moved(model, 0.4, bend).map(|d| d * 1e3);
            let [slid, _] = moved(model, 0.3, bend).map(|d| d * 1e3);
            println!(
                "{model:?}, bend {bend}: {lay:.4} mm at first, {crept:.4} crept; {slid:.1} slid where smooth"
            );
            assert!(lay + crept < 0.1, "{model:?}, bend {bend}: {lay} mm, then {crept} mm");
            assert!(slid > 100.0, "{model:?}, bend {bend}: {slid} mm");
        }
    }
}
