//! Promise: hair that is authored more than 5 mm inside a mesh does not touch that mesh. It comes to rest (1 mm/s) and is
//! not counted as deeper than authored.
//!
//! Such hair used to rest on a surface inside the mesh, at its authored depth. Where the nearest skin changes sides, the
//! normal of that surface jumps, and the hair trembled.

use glam::Vec3;
use hairspring::{
    collide::{ColliderShape, MovingCollider, voxelize},
    groom::Groom,
    material::preset,
    settings::Solver,
    simulation::Simulation,
};
use hairspring_test::{REST, roots, step};
use std::sync::Arc;

/// Half the side of the body, a cube [m].
const HALF: f32 = 0.08;

/// The cube as the distance field of its mesh. In its middle, the nearest face is one of six.
fn cube() -> ColliderShape {
    let side = |bit: u32| if bit & 1 == 1 { HALF } else { -HALF };
    let corners: Vec<Vec3> = (0..8).map(|k| Vec3::new(side(k), side(k >> 1), side(k >> 2))).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    let triangles: Vec<[u32; 3]> = faces.into_iter().flat_map(halves).collect();
    ColliderShape::Field(Arc::new(voxelize(&corners, &triangles, 0.004)))
}

/// Strands of 9.2 cm that grow from the top of the cube to its middle, each at another place and in another direction:
/// the additive recurrence R₄ (Roberts 2018).
fn groom() -> Arc<Groom> {
    const STEPS: [f32; 4] = [0.856_674_9, 0.733_891_9, 0.628_706_7, 0.538_597_3];
    let strand = |k: usize| -> Vec<Vec3> {
        let [a, b, c, d] = STEPS.map(|step| (0.5 + step * (k + 1) as f32).fract() * 2.0 - 1.0);
        let way = Vec3::new(0.5 * c, -1.0, 0.5 * d).normalize();
        (0..24).map(|i| Vec3::new(0.5 * a, 1.0, 0.5 * b) * HALF + way * (0.004 * i as f32)).collect()
    };
    Arc::new(Groom::from_strands((0..300).map(strand), 40e-6))
}

fn simulation(colliders: &[MovingCollider]) -> Simulation {
    let poses: Vec<_> = colliders.iter().map(MovingCollider::end_pose).collect();
    Simulation::builder(groom())
        .materials(&[preset("straight").unwrap()])
        .solver(Solver { sag_free: false, ..Solver::default() })
        .colliders_at_rest(&poses)
        .build()
        .unwrap()
}

#[test]
fn it_comes_to_rest() {
    let colliders = [MovingCollider::at_rest(cube(), REST)];
    let mut simulation = simulation(&colliders);
    let roots = roots(&groom(), REST);
    let mut fastest = 0.0f64;
    for frame in 0..600 {
        step(&mut simulation, REST, &roots, &colliders);
        let measure = simulation.measure(&colliders);
        if frame >= 540 {
            fastest = fastest.max(measure.speed_max);
        }
        assert!(measure.max_depth < 1e-3, "frame {frame}: {} m deeper than authored", measure.max_depth);
    }
    println!("fastest point {:.4} mm/s", fastest * 1e3);
    assert!(fastest < 1e-3, "{fastest} m/s after 10 s");
}
