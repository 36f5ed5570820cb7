//! Lines for an engine's debug view: what each kind shows, and in which color.

use hairspring::prelude::*;

/// Runs the example.
pub fn main() {
    // Strands that fall on a ball.
    let strand = |s: usize| {
        let root = Vec3::new(0.0, 0.05, 0.005 * s as f32);
        (0..16).map(|i| root + Vec3::X * (0.01 * i as f32)).collect::<Vec<_>>()
    };
    let groom = Groom::from_strands((0..10).map(strand), 40e-6);
    let solver = Solver { sag_free: false, ..Default::default() };
    let mut simulation = Simulation::builder(groom).solver(solver).build().expect("the groom is valid");
    let ball = ColliderShape::Sphere { center: Vec3::new(0.05, -0.02, 0.02), radius: 0.05 };
    // The engine's entity, which contacts report.
    let anchor = RigidTransform::IDENTITY;
    let colliders = [MovingCollider::at_rest(ball, anchor).with_user_data(42)];
    let roots = simulation.rigid_roots(anchor);
    let input = StepInput::new(1.0 / 60.0, anchor, &roots).with_colliders(&colliders);
    for _ in 0..60 {
        simulation.try_step(&input).expect("the input is finite");
    }

    let mode = DebugRenderMode::SEGMENTS | DebugRenderMode::CONTACT_NORMALS | DebugRenderMode::COLLIDERS;
    let lines = simulation.debug_lines(&input, mode);
    for kind in [DebugLineKind::Segment, DebugLineKind::ContactNormal, DebugLineKind::Collider] {
        let count = lines.iter().filter(|line| line.kind == kind).count();
        println!("{count} lines of {kind:?}, in the color {:?}", kind.color());
        assert!(count > 0);
    }
    assert!(simulation.contact_points(&colliders).iter().all(|contact| contact.user_data == 42));
}
