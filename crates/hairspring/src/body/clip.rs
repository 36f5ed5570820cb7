//! Motion: the local transform of every joint, sampled at a fixed rate.

use glam::{Affine3A, Quat, Vec3};

/// A joint's transform relative to its parent: scale, then rotate, then translate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trs {
    /// Translation [m].
    pub translation: Vec3,
    /// Unit rotation.
    pub rotation: Quat,
    /// Scale, 1 for none.
    pub scale: Vec3,
}

impl Default for Trs {
    fn default() -> Self {
        Self { translation: Vec3::ZERO, rotation: Quat::IDENTITY, scale: Vec3::ONE }
    }
}

impl Trs {
    /// The transform as a matrix.
    pub fn to_affine(&self) -> Affine3A {
        Affine3A::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }

    /// Between `self` (`t` = 0) and `other` (`t` = 1): linear, rotation on the shorter arc.
    pub fn lerp(&self, other: &Trs, t: f32) -> Trs {
        Trs {
            translation: self.translation.lerp(other.translation, t),
            rotation: self.rotation.slerp(other.rotation, t),
            scale: self.scale.lerp(other.scale, t),
        }
    }
}

/// How near a time is to a frame that it counts as being on [frames].
const ON_FRAME: f64 = 1e-6;

/// A motion: for every frame and joint, the joint's local transform.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// The file's name for it.
    pub name: String,
    /// Frames a second [Hz], above 0.
    pub rate: f64,
    /// Joints a frame.
    pub joint_count: usize,
    /// Local transforms, frame after frame; shape `[frames][joints]`.
    pub samples: Vec<Trs>,
}

impl Clip {
    /// Number of frames.
    pub fn frame_count(&self) -> usize {
        self.samples.len().checked_div(self.joint_count).unwrap_or(0)
    }

    /// From the first frame to the last [s].
    pub fn duration(&self) -> f64 {
        self.frame_count().saturating_sub(1) as f64 / self.rate
    }

    /// The clip from frame `first` on; the last frame alone where there is no such frame.
    pub fn from_frame(mut self, first: usize) -> Self {
        let first = first.min(self.frame_count().saturating_sub(1));
        self.samples.drain(..first * self.joint_count);
        self
    }

    /// Local transforms at `time` [s], held at the ends; shape `[joints]`.
    pub fn sample(&self, time: f64) -> Vec<Trs> {
        let (i, t) = self.place(time);
        self.frame(i).iter().zip(self.frame(i + 1)).map(|(a, b)| a.lerp(b, t)).collect()
    }

    /// Local transforms of a frame, the last one's beyond it; shape `[joints]`.
    pub(crate) fn frame(&self, frame: usize) -> &[Trs] {
        let last = self.frame_count().saturating_sub(1);
        &self.samples[frame.min(last) * self.joint_count..][..self.joint_count]
    }

    /// The frame at or before `time` [s], and how far it is from there to the next, 0 to below 1. A time that is on a frame but for rounding is on it.
    pub(crate) fn place(&self, time: f64) -> (usize, f32) {
        let last = self.frame_count().saturating_sub(1);
        let at = (time * self.rate).clamp(0.0, last as f64);
        let near = at.round();
        if (at - near).abs() < ON_FRAME { (near as usize, 0.0) } else { (at as usize, at.fract() as f32) }
    }
}
