//! glTF animations, resampled at a fixed rate (glTF 2.0 §3.11 and appendix C: step, linear, cubic spline).

use super::{
    accessor::{Buffers, components},
    animation_name,
    json::{Animation, Document, Interpolation, Path},
    late::Late,
    morph::{self, ClipWeights, Morphs, Object},
    sampling::{Place, Rates, Sampling},
    scales::Scales,
    skeleton::Skeleton,
};
use crate::{Problem, bytes::with_room, motion::MAX_SAMPLES};
use glam::{Quat, Vec3, Vec4};
use hairspring::body::{Clip, Trs};
use std::{
    collections::{HashMap, HashSet},
    rc::Rc,
};

/// Joint samples that a file of any size may make: three minutes of a hundred joints.
const SAMPLES: usize = 1_200_000;

/// Joint samples for each byte of a file, in addition. Two keys may be far apart in time.
const SAMPLES_PER_BYTE: usize = 4;

/// Keys of one property.
struct Keys {
    interpolation: Interpolation,
    times: Vec<f32>,
    /// Those that have a sample at each of the times.
    rates: Rates,
    /// Vectors of three or four components. For cubic splines there are three per key: in-tangent, value,
    /// out-tangent.
    values: Vec<Vec4>,
}

/// The keys of one property of one joint. Joints may share them.
struct Track {
    joint: usize,
    property: Path,
    keys: Rc<Keys>,
}

/// Reads keys. Each pair of accessors is read once.
struct Reader<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    read: HashMap<(usize, usize, Interpolation, bool), Rc<Keys>>,
}

/// Channels that are not read.
#[derive(Default)]
struct LeftOut {
    /// Weights of an object without morph targets.
    morphs: usize,
    /// Without a joint, or of a property that an extension defines.
    others: usize,
    /// Of a property that a later channel of the same animation moves, too.
    repeated: usize,
    /// Keys of rotations of zero length, which are no channels.
    zero_rotations: usize,
    /// Keys at the time of the key before.
    repeated_times: usize,
}

/// Converts every animation to a clip of the skeleton's joints, and to weights of the morph targets of `objects`.
pub(super) fn clips(
    document: &Document,
    buffers: &Buffers<'_>,
    skeleton: &Skeleton,
    objects: Vec<Object>,
    notes: &mut Vec<String>,
) -> Result<(Vec<Clip>, Morphs), Problem> {
    let mut reader = Reader { document, buffers, read: HashMap::new() };
    let mut morphs = morph::Reader::new(document, buffers, objects);
    let (mut left_out, mut late) = (LeftOut::default(), Late::default());
    let mut clips = Vec::new();
    let most = buffers.size().saturating_mul(SAMPLES_PER_BYTE).saturating_add(SAMPLES).min(MAX_SAMPLES);
    let mut samples_so_far = 0usize;
    for (index, animation) in document.animations.iter().enumerate() {
        let name = animation_name((index, animation));
        let mut weights = ClipWeights::default();
        let tracks =
            reader.tracks((animation, &name), skeleton, (&mut morphs, &mut weights), &mut left_out)?;
        let of_weights = || weights.tracks.iter().map(|(_, keys)| morphs.times(*keys));
        let times = || tracks.iter().map(|t| &t.keys.times[..]).chain(of_weights());
        let first = times().filter_map(|t| t.first()).copied().fold(f32::INFINITY, f32::min);
        let last = times().filter_map(|t| t.last()).copied().fold(f32::NEG_INFINITY, f32::max);
        if !(last - first).is_finite() {
            continue;
        }
        let of_joints = tracks.iter().map(|track| track.keys.rates);
        let of_weights = weights.tracks.iter().map(|(_, keys)| morphs.rates(*keys));
        let rates = of_joints.chain(of_weights).fold(Rates::ALL, Rates::and);
        let joint_count = skeleton.joints.len();
        let left = most.saturating_sub(samples_so_far).checked_div(joint_count).unwrap_or(usize::MAX);
        let sampling = Sampling::new(first, last, rates, left);
        let Sampling { start, rate, frames, on_key } = sampling;
        samples_so_far = frames.saturating_mul(joint_count).saturating_add(samples_so_far);
        if samples_so_far > most {
            let text = format!(
                "animation {name:?} lasts {:.0} s and has {joint_count} joints, which is above the limit of {most} samples for a file of this size; shorten it, or export fewer animations",
                last - start
            );
            return Err(Problem::limit(crate::Place::Whole, text));
        }
        late.add(&name, first, &sampling);
        let mut samples = with_room(frames * joint_count)?;
        let mut scales = Scales::default();
        for frame in 0..frames {
            let time = sampling.time(frame);
            let offset = samples.len();
            samples.extend_from_slice(&skeleton.defaults);
            for track in &tracks {
                track.apply((time, on_key), &mut samples[offset + track.joint]);
            }
            scales.check(&mut samples, &skeleton.joints, time);
        }
        notes.extend(scales.notes(&name, skeleton));
        clips.push(Clip { name, rate, joint_count, samples });
        morphs.push(ClipWeights { start, on_key, ..weights });
    }
    left_out.note(notes);
    late.note(notes);
    Ok((clips, morphs.morphs))
}

impl LeftOut {
    fn note(&self, notes: &mut Vec<String>) {
        if self.morphs > 0 {
            let (channels, they_move) = left_out(self.morphs);
            notes.push(format!(
                "{channels}, because {they_move} morph targets that their object does not have; export the targets, too"
            ));
        }
        if self.others > 0 {
            let (channels, they_move) = left_out(self.others);
            notes.push(format!(
                "{channels}, because {they_move} no joint of the scene; animate joints instead"
            ));
        }
        if self.repeated > 0 {
            let (channels, _) = left_out(self.repeated);
            notes.push(format!("{channels}, because a later one moves the same joint; export each once"));
        }
        if self.zero_rotations > 0 {
            notes.push(format!(
                "{} keys of rotations are 0, 0, 0, 0, which is no rotation; the key before each is used; export the animation again",
                self.zero_rotations
            ));
        }
        if self.repeated_times > 0 {
            notes.push(format!(
                "{} keys of animations are at the time of the key before, so the motion jumps to them; export one key for each time",
                self.repeated_times
            ));
        }
    }
}

/// A number of animation channels that are left out, and "they move" for it.
fn left_out(count: usize) -> (String, &'static str) {
    match count {
        1 => ("1 animation channel is left out".into(), "it moves"),
        n => (format!("{n} animation channels are left out"), "they move"),
    }
}

impl Reader<'_> {
    /// Reads the channels that move a joint: one for each property of a joint. Those of weights are added to `weights`.
    fn tracks(
        &mut self,
        (animation, name): (&Animation, &str),
        skeleton: &Skeleton,
        (morphs, weights): (&mut morph::Reader<'_>, &mut ClipWeights),
        left_out: &mut LeftOut,
    ) -> Result<Vec<Track>, Problem> {
        let mut tracks = Vec::new();
        let mut moved = HashSet::new();
        // From the last to the first, since the last one of a property counts.
        for channel in animation.channels.iter().rev() {
            let property = channel.target.path;
            let node = channel.target.node;
            if node.is_some_and(|node| node >= self.document.nodes.len()) {
                return Err(Problem::whole("an animation channel refers to a missing object"));
            }
            let joint = node.and_then(|node| skeleton.joint_of(node));
            match (property, joint) {
                (Path::Other, _) | (_, None) => left_out.others += 1,
                (_, Some(joint)) if !moved.insert((joint, property)) => left_out.repeated += 1,
                (Path::Weights, _) => {
                    match morphs.track((animation, name), channel.sampler, node.unwrap_or_default())? {
                        Some(track) => {
                            left_out.repeated_times += repeated(morphs.times(track.1));
                            weights.tracks.push(track);
                        }
                        None => left_out.morphs += 1,
                    }
                }
                (_, Some(joint)) => {
                    let keys = self.keys((animation, name), channel.sampler, property, left_out)?;
                    tracks.push(Track { joint: joint as usize, property, keys });
                }
            }
        }
        tracks.reverse();
        Ok(tracks)
    }

    /// Reads the keys of a sampler.
    fn keys(
        &mut self,
        (animation, name): (&Animation, &str),
        sampler: usize,
        property: Path,
        left_out: &mut LeftOut,
    ) -> Result<Rc<Keys>, Problem> {
        let sampler = animation.samplers.get(sampler);
        let sampler =
            sampler.ok_or_else(|| Problem::whole("an animation channel refers to a missing object"))?;
        let is_rotation = property == Path::Rotation;
        let key = (sampler.input, sampler.output, sampler.interpolation, is_rotation);
        if let Some(keys) = self.read.get(&key) {
            return Ok(keys.clone());
        }
        let (document, buffers) = (self.document, self.buffers);
        let times: Vec<f32> = components::<1>(document, sampler.input, buffers, "times of an animation")?
            .iter()
            .map(|t| t[0] as f32)
            .collect();
        let mut values: Vec<Vec4> = if is_rotation {
            let values = components::<4>(document, sampler.output, buffers, "rotations of an animation")?;
            values.iter().map(|v| Vec4::from(v.map(|x| x as f32))).collect()
        } else {
            let values = components::<3>(document, sampler.output, buffers, "values of an animation")?;
            values.iter().map(|v| Vec3::from(v.map(|x| x as f32)).extend(0.0)).collect()
        };
        let interpolation = sampler.interpolation;
        check_count(name, interpolation, times.len(), (values.len(), 1), "values")?;
        if !times.iter().all(|t| t.is_finite()) || !times.is_sorted() || !values.iter().all(|v| v.is_finite())
        {
            return Err(not_in_order(name));
        }
        if is_rotation {
            left_out.zero_rotations += fill_zero_rotations(&mut values, interpolation);
        }
        left_out.repeated_times += repeated(&times);
        let keys = Rc::new(Keys { interpolation, rates: Rates::of(&times), times, values });
        self.read.insert(key, keys.clone());
        Ok(keys)
    }
}

/// Checks the number of values of an animation's keys: `each` for a key, or three times as many for cubic splines.
pub(super) fn check_count(
    animation: &str,
    interpolation: Interpolation,
    keys: usize,
    (values, each): (usize, usize),
    what: &str,
) -> Result<(), Problem> {
    let (factor, of) =
        if interpolation == Interpolation::CubicSpline { (3, " of a CUBICSPLINE") } else { (1, "") };
    let per_key = each.saturating_mul(factor);
    if keys > 0 && keys.checked_mul(per_key) == Some(values) {
        return Ok(());
    }
    Err(Problem::whole(format!(
        "animation {animation:?} has {keys} keys but {values} {what}{of}: expected {per_key} per key; export it again"
    )))
}

/// The error for keys that are not finite, or not in order of time.
pub(super) fn not_in_order(animation: &str) -> Problem {
    Problem::whole(format!(
        "the keys of animation {animation:?} are not finite, or not in order of time; export it again"
    ))
}

/// Number of times that are the same as the one before.
fn repeated(times: &[f32]) -> usize {
    times.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

/// Gives keys of rotations of zero length the rotation of the key before, or of the first other one. Returns their
/// number.
fn fill_zero_rotations(values: &mut [Vec4], interpolation: Interpolation) -> usize {
    // The value of a cubic spline is between its tangents.
    let (first, step) = if interpolation == Interpolation::CubicSpline { (1, 3) } else { (0, 1) };
    let other = values.iter().skip(first).step_by(step).find(|v| v.try_normalize().is_some()).copied();
    let mut before = other.unwrap_or(Vec4::W);
    let mut count = 0;
    for value in values.iter_mut().skip(first).step_by(step) {
        if value.try_normalize().is_none() {
            *value = before;
            count += 1;
        }
        before = *value;
    }
    count
}

impl Track {
    /// Sets this track's property of `local` to its value at a time [s], or at a key that is as near as the second number
    /// [s].
    fn apply(&self, time: (f32, f32), local: &mut Trs) {
        let value = self.at(time);
        match self.property {
            Path::Translation => local.translation = value.truncate(),
            Path::Scale => local.scale = value.truncate(),
            _ => {
                if let Some(unit) = value.try_normalize() {
                    local.rotation = Quat::from_vec4(unit);
                }
            }
        }
    }

    fn at(&self, (time, on_key): (f32, f32)) -> Vec4 {
        let Keys { interpolation, times, values, .. } = &*self.keys;
        let place = Place::new(times, time, on_key);
        let (i, j, t) = (place.before, place.after, place.fraction);
        match interpolation {
            Interpolation::Step => values[i],
            Interpolation::Linear if self.property == Path::Rotation => {
                let (a, b) = (values[i].try_normalize(), values[j].try_normalize());
                match a.zip(b) {
                    Some((a, b)) => Quat::from_vec4(a).slerp(Quat::from_vec4(b), t).into(),
                    None => values[i],
                }
            }
            Interpolation::Linear => values[i].lerp(values[j], t),
            Interpolation::CubicSpline => {
                let parts = [values[3 * i + 1], values[3 * i + 2], values[3 * j + 1], values[3 * j]];
                parts.into_iter().zip(place.cubic()).map(|(value, factor)| value * factor).sum()
            }
        }
    }
}
