//! A motion as a file holds it: a skeleton and a clip for it.

use crate::{Place, Problem};
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

/// Largest number of positions of the vertices of a body over time: 1,500 frames of 100,000 vertices.
pub(crate) const MAX_POSITIONS: usize = 150_000_000;
