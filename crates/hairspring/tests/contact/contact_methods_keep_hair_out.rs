//! Promise: every contact method keeps hair out of a body, each in its way (Sams 2014, §3.3). With
//! projection no point is ever inside. With the penalty method landing hair penetrates for a moment and
//! comes out. With both no point is ever inside.
//!
//! A curtain falls on a ball, with every model; groom, body and duration are the same.

use glam::Vec3;
use hairspring::{
    collide::{ColliderShape, MovingCollider},
    groom::Groom,
    material::{Material, Model},
    settings::{Response, Solver},
    simulation::Simulation,
};
use hairspring_test::{REST, roots, step};

/// The number of frames, and of the last frames over which the fastest point's speed is averaged. Creeping
/// and trembling points are fast only in some frames.
const FRAMES: [u32; 2] = [240, 30];

/// The largest penetration while hair lands on the ball [m], that at the end [m], and the mean speed of the
/// fastest point in the last half second [m/s].
fn land(model: Model, contact: Response) -> [f32; 3] {
    let strands = (0..16).map(|s| {
        let root = Vec3::new(-0.1, 0.11, 0.01 * (s as f32 - 7.5));
        (0..25).map(move |i| root + Vec3::X * (0.01 * i as f32)).collect::<Vec<_>>()
    });
    let groom = Groom::from_strands(strands, 40e-6);
    let roots = roots(&groom, REST);
    let mut simulation = Simulation::builder(groom)
        .materials(&[Material { model, ..Material::default() }])
        .solver(Solver { contact, sag_free: false, ..Solver::default() })
        .build()
        .unwrap();
    let shape = ColliderShape::Sphere { center: Vec3::ZERO, radius: 0.1 };
    let colliders = [MovingCollider::at_rest(shape, REST)];
    let mut deepest = 0.0f32;
    let mut last = [0.0f32; 2];
    for frame in 0..FRAMES[0] {
        step(&mut simulation, REST, &roots, &colliders);
        let measure = simulation.measure(&colliders);
        assert_eq!(measure.non_finite, 0);
        assert!(measure.stretch_max < 0.011, "{model:?}, {contact:?}: a segment is too long: {measure:?}");
        deepest = deepest.max(measure.max_depth as f32);
        last[0] = measure.max_depth as f32;
        if frame >= FRAMES[0] - FRAMES[1] {
            last[1] += measure.speed_max as f32 / FRAMES[1] as f32;
        }
    }
    [deepest, last[0], last[1]]
}

#[test]
fn every_contact_method_keeps_hair_out() {
    for model in Model::ALL {
        let [both, penalty, projection] = Response::ALL.map(|contact| land(model, contact));
        println!("{model:?}: both {both:?}, penalty {penalty:?}, projection {projection:?}");
        assert!(both[0] < 2e-5 && both[1] < 2e-6, "{model:?}, both: a point is too deep: {both:?}");
        assert!(projection[0] < 2e-5, "{model:?}, projection: a point is too deep: {projection:?}");
        // At most the distance of a substep at the landing speed of 1.5 m/s; at rest, points are on the
        // surface.
        assert!(
            penalty[0] > 1e-4 && penalty[0] < 7e-3,
            "{model:?}, penalty: unexpected depth of landing: {penalty:?}"
        );
        assert!(penalty[1] < 5e-5, "{model:?}, penalty: a point is too deep at rest: {penalty:?}");
        // The speed at rest. Joints of the springs model tremble under contact.
        let still = if model == Model::Springs { 0.1 } else { 0.01 };
        assert!(
            both[2] < still && penalty[2] < still,
            "{model:?}: hair is not at rest: both {both:?}, penalty {penalty:?}"
        );
    }
}
