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

/// A motion: for every frame and joint, the joint's local transform.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// The file's name for it.
    pub name: String,
    /// Frames a second [Hz], above 0.
    pub rate: f32,
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
    pub fn duration(&self) -> f32 {
        self.frame_count().saturating_sub(1) as f32 / self.rate
    }

    /// The clip from frame `first` on; the last frame alone where there is no such frame.
    pub fn from_frame(mut self, first: usize) -> Self {
        let first = first.min(self.frame_count().saturating_sub(1));
        self.samples.drain(..first * self.joint_count);
        self
    }

    /// Local transforms at `time` [s], held at the ends; shape `[joints]`.
    pub fn sample(&self, time: f32) -> Vec<Trs> {
        let last = self.frame_count().saturating_sub(1);
        let at = (time * self.rate).clamp(0.0, last as f32);
        let (i, t) = (at as usize, at.fract());
        let frame = |f: usize| &self.samples[f.min(last) * self.joint_count..][..self.joint_count];
        frame(i).iter().zip(frame(i + 1)).map(|(a, b)| a.lerp(b, t)).collect()
    }
}
