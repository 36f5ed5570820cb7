//! glTF animations, resampled at a fixed rate (glTF 2.0 §3.11 and appendix C: step, linear, cubic spline).

use super::{
    accessor::{Buffers, components},
    skeleton::Skeleton,
};
use crate::{Place, Problem, motion::check_samples};
use glam::{Quat, Vec3, Vec4};
use gltf::animation::{Interpolation, Property};
use hairspring::body::{Clip, Trs};

/// Rate at which animations are resampled [Hz]: that of a display, and higher than hand-made or captured
/// motion needs.
const RATE: f32 = 60.0;

/// Keys of one property of one joint.
struct Track {
    joint: usize,
    property: Property,
    interpolation: Interpolation,
    times: Vec<f32>,
    /// Vectors of three or four components. For cubic splines there are three per key: in-tangent, value,
    /// out-tangent.
    values: Vec<Vec4>,
}

/// Converts every animation to a clip of the skeleton's joints.
pub(super) fn clips(
    document: &gltf::Document,
    buffers: &Buffers,
    skeleton: &Skeleton,
    notes: &mut Vec<String>,
) -> Result<Vec<Clip>, Problem> {
    let mut clips = Vec::new();
    let mut samples_so_far = 0usize;
    for animation in document.animations() {
        let name = animation.name().map_or_else(|| format!("animation{}", animation.index()), str::to_owned);
        let mut tracks = Vec::new();
        for channel in animation.channels() {
            let target = channel.target();
            match (skeleton.joint_of(target.node().index()), target.property()) {
                (_, Property::MorphTargetWeights) => {
                    notes.push(format!("morph targets of {name:?} are not read"))
                }
                (None, _) => {}
                (Some(joint), property) => {
                    tracks.push(Track::read(joint as usize, property, &channel, buffers)?)
                }
            }
        }
        let start = tracks.iter().filter_map(|t| t.times.first()).copied().fold(f32::INFINITY, f32::min);
        let end = tracks.iter().filter_map(|t| t.times.last()).copied().fold(f32::NEG_INFINITY, f32::max);
        if !(end - start).is_finite() {
            continue;
        }
        // A quarter of a frame of slack: keys at frame 12.999 belong to frame 13.
        let frames = ((end - start) * RATE + 0.25).floor() as usize;
        let frames = frames.saturating_add(1);
        let joint_count = skeleton.joints.len();
        samples_so_far = frames.saturating_mul(joint_count).saturating_add(samples_so_far);
        check_samples(samples_so_far, 1, Place::Whole)?;
        let mut samples = Vec::with_capacity(frames * joint_count);
        for frame in 0..frames {
            let time = start + frame as f32 / RATE;
            let first = samples.len();
            samples.extend_from_slice(&skeleton.defaults);
            for track in &tracks {
                track.apply(time, &mut samples[first + track.joint]);
            }
        }
        clips.push(Clip { name, rate: f64::from(RATE), joint_count, samples });
    }
    Ok(clips)
}

impl Track {
    fn read(
        joint: usize,
        property: Property,
        channel: &gltf::animation::Channel<'_>,
        buffers: &Buffers,
    ) -> Result<Self, Problem> {
        let sampler = channel.sampler();
        let times: Vec<f32> = components::<1>(&sampler.input(), buffers, "times of an animation")?
            .iter()
            .map(|t| t[0] as f32)
            .collect();
        let values: Vec<Vec4> = if property == Property::Rotation {
            let values = components::<4>(&sampler.output(), buffers, "rotations of an animation")?;
            values.iter().map(|v| Vec4::from(v.map(|x| x as f32))).collect()
        } else {
            let values = components::<3>(&sampler.output(), buffers, "values of an animation")?;
            values.iter().map(|v| Vec3::from(v.map(|x| x as f32)).extend(0.0)).collect()
        };
        let interpolation = sampler.interpolation();
        let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        if times.is_empty() || values.len() != times.len() * per_key {
            let text = format!("an animation has {} keys but {} values", times.len(), values.len());
            return Err(Problem::whole(text));
        }
        if !times.iter().all(|t| t.is_finite()) || !times.is_sorted() || !values.iter().all(|v| v.is_finite())
        {
            return Err(Problem::whole("the keys of an animation are not finite, or not in order of time"));
        }
        Ok(Self { joint, property, interpolation, times, values })
    }

    /// Sets this track's property of `local` to its value at `time` [s].
    fn apply(&self, time: f32, local: &mut Trs) {
        let value = self.at(time);
        match self.property {
            Property::Translation => local.translation = value.truncate(),
            Property::Scale => local.scale = value.truncate(),
            _ => {
                if let Some(unit) = value.try_normalize() {
                    local.rotation = Quat::from_vec4(unit);
                }
            }
        }
    }

    fn at(&self, time: f32) -> Vec4 {
        let last = self.times.len() - 1;
        let after = self.times.partition_point(|t| *t <= time);
        let (i, j) = (after.saturating_sub(1), after.min(last));
        let span = self.times[j] - self.times[i];
        let t = if span > 0.0 { ((time - self.times[i]) / span).clamp(0.0, 1.0) } else { 0.0 };
        match self.interpolation {
            Interpolation::Step => self.values[i],
            Interpolation::Linear if self.property == Property::Rotation => {
                let (a, b) = (self.values[i].try_normalize(), self.values[j].try_normalize());
                match a.zip(b) {
                    Some((a, b)) => Quat::from_vec4(a).slerp(Quat::from_vec4(b), t).into(),
                    None => self.values[i],
                }
            }
            Interpolation::Linear => self.values[i].lerp(self.values[j], t),
            Interpolation::CubicSpline => {
                let (t2, t3) = (t * t, t * t * t);
                let (out, into) = (self.values[3 * i + 2] * span, self.values[3 * j] * span);
                self.values[3 * i + 1] * (2.0 * t3 - 3.0 * t2 + 1.0)
                    + out * (t3 - 2.0 * t2 + t)
                    + self.values[3 * j + 1] * (3.0 * t2 - 2.0 * t3)
                    + into * (t3 - t2)
            }
        }
    }
}
