//! A force of one's own: a vortex that lifts hair, as a velocity that hair takes on.

use hairspring::prelude::*;

/// Hair near the axis takes on the velocity of a rotation about it.
struct Vortex {
    center: Vec3,
    /// Rotation vector [rad/s].
    spin: Vec3,
    /// How fast hair takes on the velocity [1/s].
    rate: f32,
}

impl ForceField for Vortex {
    fn apply(&self, strand: &mut StrandView) {
        let [root, _] = strand.roots();
        // The root drives the first two points.
        for (i, (offset, _)) in strand.points().enumerate().skip(2) {
            let place = root.translation + offset;
            strand.add_velocity_drag(i, self.spin.cross(place - self.center), self.rate);
        }
    }
}

/// Runs the example.
pub fn main() {
    let strand = (0..16).map(|i| Vec3::new(0.01 * i as f32, 0.0, 0.0)).collect::<Vec<_>>();
    let mut simulation =
        Simulation::builder(Groom::from_strands([strand], 40e-6)).build().expect("the groom is valid");
    let vortex = Vortex { center: Vec3::ZERO, spin: Vec3::Y * 20.0, rate: 30.0 };
    let id = simulation.add_force(vortex);

    let anchor = RigidTransform::IDENTITY;
    let roots = simulation.rigid_roots(anchor);
    let step = |simulation: &mut Simulation| {
        simulation.step(&StepInput::new(1.0 / 60.0, anchor, &roots));
        let mut points = [Vec3::ZERO; 16];
        simulation.write_points(&mut points);
        points[15]
    };
    let blown = (0..60).map(|_| step(&mut simulation)).last().unwrap_or_default();
    simulation.remove_force(id);
    let hanging = (0..120).map(|_| step(&mut simulation)).last().unwrap_or_default();
    println!("the tip is at {blown} in the vortex and at {hanging} without it");
    assert!(blown.z < -0.01 && hanging.z.abs() < 0.01);
}
