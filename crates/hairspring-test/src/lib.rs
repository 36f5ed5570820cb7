//! Helpers that the integration tests of several crates share: poses, roots, steps, distances, threads and the
//! folder of real data.

use glam::Vec3;
use hairspring::{
    collide::MovingCollider,
    groom::Groom,
    math::RigidTransform,
    simulation::{Simulation, StepInput, StepReport},
};
use std::path::PathBuf;

/// Duration of a frame [s].
pub const FRAME: f32 = 1.0 / 60.0;

/// The pose of a head that has not moved.
pub const REST: RigidTransform = RigidTransform::IDENTITY;

/// Returns a translation without rotation.
pub fn translation(translation: Vec3) -> RigidTransform {
    RigidTransform::from_translation(translation)
}

/// Returns `count` evenly spaced points from `start` to `end`.
pub fn line(start: Vec3, end: Vec3, count: usize) -> Vec<Vec3> {
    (0..count).map(|i| start.lerp(end, i as f32 / (count - 1) as f32)).collect()
}

/// Returns the root pose of every strand for a head with this pose.
pub fn roots(groom: &Groom, head: RigidTransform) -> Vec<RigidTransform> {
    let root = |s| RigidTransform::new(head.transform_point(groom.strand(s)[0]), head.rotation);
    (0..groom.strand_count()).map(root).collect()
}

/// Advances by one frame in still air.
///
/// # Panics
/// If a strand becomes non-finite and is reset.
pub fn step(
    simulation: &mut Simulation,
    head: RigidTransform,
    roots: &[RigidTransform],
    colliders: &[MovingCollider],
) -> StepReport {
    step_by(simulation, FRAME, head, roots, colliders)
}

/// Advances by `dt` [s] in still air.
///
/// # Panics
/// If a strand becomes non-finite and is reset.
pub fn step_by(
    simulation: &mut Simulation,
    dt: f32,
    head: RigidTransform,
    roots: &[RigidTransform],
    colliders: &[MovingCollider],
) -> StepReport {
    let report = simulation.step(&StepInput::new(dt, head, roots).with_colliders(colliders));
    assert_eq!(report.reset_strands, 0, "strands became non-finite and were reset");
    report
}

/// Returns the positions of all simulated points [m].
pub fn points(simulation: &Simulation) -> Vec<Vec3> {
    let mut points = vec![Vec3::ZERO; simulation.point_count()];
    simulation.write_points(&mut points);
    points
}

/// Returns the largest distance of corresponding points [m].
///
/// # Panics
/// If the numbers of points differ, or if a point is not finite. A distance that is not a number would pass as
/// 0, because `f32::max` ignores it.
pub fn farthest(a: &[Vec3], b: &[Vec3]) -> f32 {
    assert_eq!(a.len(), b.len(), "the numbers of points differ");
    let distance = |(i, (a, b)): (usize, (&Vec3, &Vec3))| {
        assert!(a.is_finite() && b.is_finite(), "point {i} is not finite: {a}, {b}");
        a.distance(*b)
    };
    a.iter().zip(b).enumerate().map(distance).fold(0.0, f32::max)
}

/// Runs `work` on a pool of `threads` threads.
pub fn on_threads<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("a thread pool can be made")
        .install(work)
}

/// Returns the path of a file of the real data, or `None` after printing the reason where it is missing.
///
/// The folder is `HAIRSPRING_DATA`, or `shared/data` beside the repository.
pub fn data(relative: &str) -> Option<PathBuf> {
    let root = std::env::var_os("HAIRSPRING_DATA").map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")),
        PathBuf::from,
    );
    let path = root.join(relative);
    if path.exists() {
        return Some(path);
    }
    println!("skipped: {relative} is not under {} (set HAIRSPRING_DATA)", root.display());
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[should_panic(expected = "point 1 is not finite")]
    fn distances_of_non_finite_points_are_refused() {
        farthest(&[Vec3::X, Vec3::NAN], &[Vec3::ZERO, Vec3::ZERO]);
    }

    #[test]
    #[should_panic(expected = "the numbers of points differ")]
    fn distances_of_different_numbers_of_points_are_refused() {
        farthest(&[Vec3::X], &[]);
    }

    #[test]
    fn the_largest_distance_is_returned() {
        assert_eq!(
            farthest(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[Vec3::ZERO, Vec3::X * 4.0, Vec3::Y * 2.0]),
            3.0
        );
    }
}
