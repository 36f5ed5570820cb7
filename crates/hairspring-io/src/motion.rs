//! A motion as a file holds it: a skeleton and a clip for it.

use crate::{Place, Problem};
use glam::Vec3;
use hairspring::body::{Clip, Joint};

/// A skeleton and a clip for its joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Joints, parents before children.
    pub joints: Vec<Joint>,
    /// The clip that moves them.
    pub clip: Clip,
}

/// Maximum number of joint samples (frames × joints) of a clip: 15 minutes of a hundred joints at 120 Hz.
pub(crate) const MAX_SAMPLES: usize = 12_000_000;

/// Checks `frames` × `joints` against [`MAX_SAMPLES`].
pub(crate) fn check_samples(frames: usize, joints: usize, place: Place) -> Result<(), Problem> {
    if frames.saturating_mul(joints) > MAX_SAMPLES {
        let text = format!(
            "{frames} frames of {joints} joints are above the limit of {MAX_SAMPLES} samples; cut the motion"
        );
        return Err(Problem::limit(place, text));
    }
    Ok(())
}

/// Checks the positions of vertices over time; shape `[samples][vertices]`.
pub(crate) fn check_positions(samples: &[Vec<Vec3>]) -> Result<(), Problem> {
    if samples.is_empty() {
        return Err(Problem::whole("the file has no samples of the vertices; export the motion again"));
    }
    for (k, sample) in samples.iter().enumerate() {
        if let Some(vertex) = sample.iter().position(|p| !p.is_finite()) {
            let text =
                format!("vertex {vertex} of sample {k} is not finite; correct the mesh and export it again");
            return Err(Problem::whole(text));
        }
    }
    Ok(())
}

/// Largest number of positions of the vertices of a body over time: 1,500 frames of 100,000 vertices.
pub(crate) const MAX_POSITIONS: usize = 150_000_000;
