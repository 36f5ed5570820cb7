//! Motion clips: the local transform of every joint, sampled at a fixed rate.

use glam::{Affine3A, Quat, Vec3};

/// A joint's transform relative to its parent: scale, then rotate, then translate.
///
/// For an example, see [`body`](crate::body).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trs {
    /// Translation [m].
    pub translation: Vec3,
    /// Unit rotation.
    pub rotation: Quat,
    /// Scale; 1 is none.
    pub scale: Vec3,
}

impl Default for Trs {
    fn default() -> Self {
        Self { translation: Vec3::ZERO, rotation: Quat::IDENTITY, scale: Vec3::ONE }
    }
}

impl Trs {
    /// Returns the transform as a matrix.
    pub fn to_affine(&self) -> Affine3A {
        Affine3A::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }

    /// Interpolates between `self` (`t` = 0) and `other` (`t` = 1): linearly, with the rotation along the
    /// shorter arc.
    pub fn lerp(&self, other: &Trs, t: f32) -> Trs {
        Trs {
            translation: self.translation.lerp(other.translation, t),
            rotation: self.rotation.slerp(other.rotation, t),
            scale: self.scale.lerp(other.scale, t),
        }
    }
}

/// A time this close to a frame counts as being at that frame [frames].
const ON_FRAME: f64 = 1e-6;

/// A motion clip: for every frame and joint, the joint's local transform.
///
/// For an example, see [`body`](crate::body).
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// Name of the clip in the file.
    pub name: String,
    /// Frame rate [Hz], above 0.
    pub rate: f64,
    /// Number of joints in each frame.
    pub joint_count: usize,
    /// Local transforms, one frame after the other; shape `[frames][joints]`.
    pub samples: Vec<Trs>,
}

impl Clip {
    /// Returns the number of frames.
    pub fn frame_count(&self) -> usize {
        self.samples.len().checked_div(self.joint_count).unwrap_or(0)
    }

    /// Returns the time from the first frame to the last [s].
    pub fn duration(&self) -> f64 {
        self.frame_count().saturating_sub(1) as f64 / self.rate
    }

    /// Returns the clip starting at frame `first`, or only the last frame if `first` is beyond it.
    pub fn from_frame(mut self, first: usize) -> Self {
        let first = first.min(self.frame_count().saturating_sub(1));
        self.samples.drain(..first * self.joint_count);
        self
    }

    /// Returns the local transforms at `time` [s], clamped to the first and last frame; shape `[joints]`.
    ///
    /// # Panics
    /// If the clip has joints but no frame.
    pub fn sample(&self, time: f64) -> Vec<Trs> {
        let (i, t) = self.place(time);
        self.frame(i).iter().zip(self.frame(i + 1)).map(|(a, b)| a.lerp(b, t)).collect()
    }

    /// Returns the local transforms of a frame, or of the last frame if `frame` is beyond it; shape
    /// `[joints]`.
    pub(crate) fn frame(&self, frame: usize) -> &[Trs] {
        let last = self.frame_count().saturating_sub(1);
        &self.samples[frame.min(last) * self.joint_count..][..self.joint_count]
    }

    /// Returns the frame at or before `time` [s] and the fraction of the way to the next frame, 0 to below 1.
    /// A time that differs from a frame only by rounding counts as being at that frame.
    pub(crate) fn place(&self, time: f64) -> (usize, f32) {
        let last = self.frame_count().saturating_sub(1);
        let at = (time * self.rate).clamp(0.0, last as f64);
        let near = at.round();
        if (at - near).abs() < ON_FRAME { (near as usize, 0.0) } else { (at as usize, at.fract() as f32) }
    }
}
