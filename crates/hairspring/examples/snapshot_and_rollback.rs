//! Rollback, as network games need it: keep a state, go on, return to it, and play again with other inputs.

use hairspring::prelude::*;

/// Runs the example.
pub fn main() {
    let strand = (0..16).map(|i| Vec3::NEG_Y * (0.01 * i as f32)).collect::<Vec<_>>();
    let mut simulation =
        Simulation::builder(Groom::from_strands([strand], 40e-6)).build().expect("the groom is valid");
    let anchor = RigidTransform::IDENTITY;
    let roots = simulation.rigid_roots(anchor);
    let play = |simulation: &mut Simulation, frames: u32, wind: f32| {
        for _ in 0..frames {
            let wind = Wind { velocity: Vec3::X * wind, ..Wind::default() };
            let air = Air { wind, ..Air::default() };
            simulation.step(&StepInput::new(1.0 / 60.0, anchor, &roots).with_air(air));
        }
        let mut points = [Vec3::ZERO; 16];
        simulation.write_points(&mut points);
        points[15]
    };

    play(&mut simulation, 30, 2.0);
    let snapshot = simulation.snapshot();
    let predicted = play(&mut simulation, 10, 2.0);
    // The inputs were others: return, and play the ten frames again.
    simulation.restore(&snapshot).expect("the same simulation");
    let corrected = play(&mut simulation, 10, -2.0);
    // The same inputs give the same bits.
    simulation.restore(&snapshot).expect("the same simulation");
    assert_eq!(play(&mut simulation, 10, 2.0), predicted);
    println!("predicted {predicted}, corrected {corrected}");
    assert!(corrected.x < predicted.x);
}
