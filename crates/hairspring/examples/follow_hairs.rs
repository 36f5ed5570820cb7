//! Follow hairs: 20 strands of 200 are simulated, and the others are interpolated from them.

use hairspring::prelude::*;
use std::sync::Arc;

/// Runs the example.
pub fn main() {
    let strand = |s: usize| {
        let root = Vec3::new(0.003 * (s % 20) as f32, 0.0, 0.003 * (s / 20) as f32);
        (0..16).map(move |i| root - Vec3::Y * (0.015 * i as f32)).collect::<Vec<_>>()
    };
    let groom = Arc::new(Groom::from_strands((0..200).map(strand), 40e-6));
    // Guides are spread over the scalp; every other hair follows up to three of them.
    let guides = choose_guides(&groom, 20);
    let weights = assign_guides(&groom, &guides);
    let mut simulation =
        Simulation::builder(groom.clone()).strands(&guides).build().expect("the groom is valid");
    let mut follow = Follow::new(groom.clone(), &guides, &weights, Effects::default(), &[]);

    // Roots do not rotate against the anchor here.
    let turns = vec![Quat::IDENTITY; guides.len()];
    let mut of_guides = vec![Vec3::ZERO; simulation.point_count()];
    let mut all = vec![Vec3::ZERO; groom.point_count()];
    for frame in 1..=30 {
        let anchor = RigidTransform::from_translation(Vec3::X * (0.05 * (0.3 * frame as f32).sin()));
        simulation.step(&StepInput::new(1.0 / 60.0, anchor, &simulation.rigid_roots(anchor)));
        simulation.write_points(&mut of_guides);
        follow.update_guide_transforms(&of_guides, &turns);
        follow.interpolation(&of_guides, &[]).place(&mut all);
    }
    let lowest = all.iter().map(|p| p.y).fold(0.0, f32::min);
    println!(
        "{} hairs follow {} guides; the lowest tip hangs at {lowest} m",
        200 - guides.len(),
        guides.len()
    );
    assert!(all.iter().all(|p| p.is_finite()) && lowest < -0.2);
}
