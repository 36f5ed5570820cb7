//! Promise: hair stays outside of every shape of collider, at rest and swept through the hair at 1 m/s, and lets go of it again.
//!
//! A curtain of strands hangs from a rail, the shape goes through it and comes to rest in it. No point is deeper than 0.1 mm in any frame, no
//! segment longer than 1.1 %, and the hair that the shape took along hangs where it hung five seconds after the shape has gone.

use glam::{Mat3, Quat, Vec3};
use hairspring::{
    collide::{Obstacle, Rigid},
    groom::Groom,
    material::{Material, Model},
    scene::Solver,
    simulation::{Air, Drive, MovingObstacle, Simulation},
};
use std::sync::Arc;

const FRAME: f32 = 1.0 / 60.0;

fn shapes() -> [(&'static str, Obstacle); 4] {
    let turned = Mat3::from_quat(Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.8, 0.2));
    [
        ("sphere", Obstacle::Sphere { center: Vec3::ZERO, radius: 0.06 }),
        ("capsule", Obstacle::Capsule { a: Vec3::X * -0.1, b: Vec3::X * 0.1, radius: 0.03 }),
        (
            "box",
            Obstacle::Cuboid { center: Vec3::ZERO, half: Vec3::new(0.08, 0.05, 0.06), axes: Mat3::IDENTITY },
        ),
        ("box on its corner", Obstacle::Cuboid { center: Vec3::ZERO, half: Vec3::splat(0.05), axes: turned }),
    ]
}

#[test]
fn a_shape_goes_through_a_curtain() {
    let strands = (0..48).map(|s| {
        let x = (s as f32 - 23.5) * 0.004;
        (0..32).map(move |i| Vec3::new(x, 0.3 - 0.6 * i as f32 / 31.0, 0.0)).collect::<Vec<_>>()
    });
    let groom = Arc::new(Groom::from_strands(strands, 40e-6));
    let all: Vec<u32> = (0..groom.strand_count() as u32).collect();
    let roots: Vec<Rigid> = all
        .iter()
        .map(|s| Rigid { translation: groom.strand(*s as usize)[0], rotation: Quat::IDENTITY })
        .collect();
    for ((name, shape), model) in
        shapes().into_iter().flat_map(|s| Model::ALL.map(|model| (s.clone(), model)))
    {
        let mut simulation = Simulation::new(
            groom.clone(),
            &all,
            &[Material { model, ..Material::default() }],
            Solver::default(),
            Vec3::new(0.0, -9.81, 0.0),
            Rigid::default(),
            &[],
        );
        // In at 1 m/s, a second in the hair, and away to where no strand reaches.
        let at = |frame: u32| {
            let t = frame as f32 * FRAME;
            let z = if t < 1.3 { (t - 0.3).min(0.15) } else { 0.15 + 10.0 * (t - 1.3) };
            Rigid { translation: Vec3::Z * z, ..Rigid::default() }
        };
        let (mut deepest, mut longest, mut pushed) = (0.0f32, 0.0f64, 0.0f32);
        let mut points = vec![Vec3::ZERO; simulation.point_count()];
        for frame in 0..400 {
            let obstacles = [MovingObstacle { shape: shape.clone(), start: at(frame), end: at(frame + 1) }];
            simulation.step(&Drive {
                dt: FRAME,
                anchor: Rigid::default(),
                roots: &roots,
                obstacles: &obstacles,
                air: Air::default(),
            });
            let measure = simulation.measure(&obstacles);
            assert_eq!(measure.non_finite, 0, "{name}, {model:?}, frame {frame}");
            deepest = deepest.max(measure.max_depth as f32);
            longest = longest.max(measure.stretch_max);
            simulation.write_points(&mut points);
            pushed = points.iter().fold(pushed, |most, p| most.max(p.z));
        }
        let off = points.iter().zip(&groom.points).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        println!(
            "{name}, {model:?}: {deepest} m deep, {longest} longer, pushed {pushed} m, {off} m off in the end"
        );
        assert!(deepest < 1e-4, "{name}, {model:?}: a point {deepest} m deep");
        assert!(longest < 0.011, "{name}, {model:?}: a segment {longest} longer");
        assert!(pushed > 0.1, "{name}, {model:?}: the shape went through hair without touching it");
        assert!(off < 0.02, "{name}, {model:?}: {off} m off after five seconds");
    }
}
