//! Bodies that deform by any means: the positions of all vertices over time.

use glam::{Quat, Vec3};
use hairspring::{
    body::{Clip, Trs},
    math::RigidTransform,
};

/// Positions of the vertices of a body in each frame, in world space [m].
///
/// It takes the place of a skeleton and a clip. Between frames, positions are interpolated linearly in the space of the rigid
/// motion of the skin under the roots.
///
/// ```
/// use glam::Vec3;
/// use hairspring_scene::VertexCache;
///
/// let frames = vec![vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![Vec3::Z, Vec3::X + Vec3::Z, Vec3::Y + Vec3::Z]];
/// let cache = VertexCache { rate: 24.0, frames };
/// assert_eq!(cache.duration(), 1.0 / 24.0);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexCache {
    /// Frame rate [Hz], above 0.
    pub rate: f64,
    /// Positions [m]; shape `[frames][vertices]`, the vertices of the body's mesh in their order.
    pub frames: Vec<Vec<Vec3>>,
}

/// A time this close to a frame counts as being at that frame [frames].
const ON_FRAME: f64 = 1e-6;

/// Largest number of iterations of the rotation's fit, and the angle at which it ends [rad].
const FIT_ITERATIONS: usize = 60;
const FIT_ANGLE: f32 = 1e-7;

impl VertexCache {
    /// Returns the time from the first frame to the last [s].
    pub fn duration(&self) -> f64 {
        self.frames.len().saturating_sub(1) as f64 / self.rate
    }

    /// Returns the frame at or before `time` [s], and the fraction of the way to the next, 0 to below 1.
    pub(crate) fn place(&self, time: f64) -> (usize, f32) {
        let last = self.frames.len().saturating_sub(1);
        let at = (time * self.rate).clamp(0.0, last as f64);
        let near = at.round();
        if (at - near).abs() < ON_FRAME { (near as usize, 0.0) } else { (at as usize, at.fract() as f32) }
    }

    /// Returns the positions at the fraction `t` of the way from `frame` to the next [m].
    pub(crate) fn at(&self, (frame, t): (usize, f32)) -> Vec<Vec3> {
        let (a, b) = (&self.frames[frame], self.frames.get(frame + 1));
        match b.filter(|_| t > 0.0) {
            None => a.clone(),
            Some(b) => a.iter().zip(b).map(|(a, b)| a.lerp(*b, t)).collect(),
        }
    }

    /// Splits the motion into that of a rigid joint at `rest`'s origin and the remaining deformation. `rest` holds the positions
    /// at rest [m], and `vertices` those that the joint moves with. Afterwards the frames are in the joint's space.
    pub(crate) fn split_rigid_motion(&mut self, rest: &[Vec3], vertices: &[u32]) -> Clip {
        let mut rotation = Quat::IDENTITY;
        let mut samples = Vec::with_capacity(self.frames.len());
        for frame in &mut self.frames {
            let pairs = || vertices.iter().map(|v| (rest[*v as usize], frame[*v as usize]));
            let motion = fit(pairs, rotation);
            rotation = motion.rotation;
            for p in frame.iter_mut() {
                *p = motion.inverse_transform_point(*p);
            }
            samples.push(Trs { translation: motion.translation, rotation, ..Trs::default() });
        }
        Clip { name: "vertex cache".into(), rate: self.rate, joint_count: 1, samples }
    }
}

/// Returns the rigid motion that best maps the first points of the pairs to the second ones. The rotation is found from
/// `rotation` by fixed-point iteration (Müller et al. 2016, "A Robust Method to Extract the Rotational Part of Deformations").
fn fit<I: Iterator<Item = (Vec3, Vec3)>>(pairs: impl Fn() -> I, mut rotation: Quat) -> RigidTransform {
    let count = pairs().count().max(1) as f32;
    let (from, to) = pairs().fold((Vec3::ZERO, Vec3::ZERO), |(a, b), (p, q)| (a + p, b + q));
    let (from, to) = (from / count, to / count);
    // The columns of the sum of (q − to) (p − from)ᵀ.
    let columns = pairs().fold([Vec3::ZERO; 3], |mut columns, (p, q)| {
        let (p, q) = (p - from, q - to);
        columns.iter_mut().zip(p.to_array()).for_each(|(column, p)| *column += q * p);
        columns
    });
    for _ in 0..FIT_ITERATIONS {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| rotation * axis);
        let turn: Vec3 = axes.iter().zip(columns).map(|(axis, column)| axis.cross(column)).sum();
        let scale: f32 = axes.iter().zip(columns).map(|(axis, column)| axis.dot(column)).sum();
        let omega = turn / (scale.abs() + f32::MIN_POSITIVE);
        if !(omega.is_finite() && omega.length() > FIT_ANGLE) {
            break;
        }
        rotation = (Quat::from_scaled_axis(omega) * rotation).normalize();
    }
    RigidTransform { rotation, translation: to - rotation * from }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rigid_motion_leaves_no_deformation() {
        let rest: Vec<Vec3> =
            (0..8).map(|k| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32 * 0.3)).collect();
        let motion = |f: usize| RigidTransform {
            rotation: Quat::from_euler(glam::EulerRot::XYZ, 0.2 * f as f32, -0.1 * f as f32, 0.3),
            translation: Vec3::new(f as f32, -1.0, 0.5),
        };
        let frames = (0..12).map(|f| rest.iter().map(|p| motion(f).transform_point(*p)).collect()).collect();
        let mut cache = VertexCache { rate: 24.0, frames };
        let vertices: Vec<u32> = (0..8).collect();
        let clip = cache.split_rigid_motion(&rest, &vertices);
        for (f, frame) in cache.frames.iter().enumerate() {
            assert!((clip.samples[f].translation - motion(f).translation).length() < 1e-4, "frame {f}");
            assert!(frame.iter().zip(&rest).all(|(a, b)| a.distance(*b) < 1e-4), "frame {f}: {frame:?}");
        }
    }
}
