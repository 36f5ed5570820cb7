//! A collider of one's own: a torus, given by its signed distance.

use hairspring::prelude::*;

/// A torus around Y.
#[derive(Debug)]
struct Torus {
    major: f32,
    minor: f32,
}

impl Collider for Torus {
    fn distance_and_normal(&self, p: Vec3) -> (f32, Vec3) {
        let ring = Vec3::new(p.x, 0.0, p.z).normalize_or(Vec3::X) * self.major;
        ((p - ring).length() - self.minor, (p - ring).normalize_or(Vec3::Y))
    }

    fn bounds(&self) -> (Vec3, f32) {
        (Vec3::ZERO, self.major + self.minor)
    }

    fn half_thickness(&self) -> f32 {
        self.minor
    }
}

/// Runs the example.
pub fn main() {
    // Strands that stand off to the side, above the ring, and fall on it.
    let strand = |s: i32| {
        let root = Vec3::new(0.03, 0.05, 0.01 * s as f32);
        (0..20).map(|i| root + Vec3::X * (0.01 * i as f32)).collect::<Vec<_>>()
    };
    let groom = Groom::from_strands((-3..=3).map(strand), 40e-6);
    let solver = Solver { sag_free: false, ..Default::default() };
    let mut simulation = Simulation::builder(groom).solver(solver).build().expect("the groom is valid");
    let anchor = RigidTransform::IDENTITY;
    let roots = simulation.rigid_roots(anchor);
    let torus = ColliderShape::custom(Torus { major: 0.1, minor: 0.02 });
    let colliders = [MovingCollider::at_rest(torus, anchor)];
    for _ in 0..120 {
        simulation.step(&StepInput::new(1.0 / 60.0, anchor, &roots).with_colliders(&colliders));
    }
    let (found, measure) = (simulation.contacts(&colliders), simulation.measure(&colliders));
    let contacts = found.points + found.segments;
    println!(
        "{contacts} points and segments touch the torus, {:.3} mm deep at most",
        1e3 * measure.max_depth
    );
    assert!(contacts > 0 && measure.max_depth < 1e-4);
}
