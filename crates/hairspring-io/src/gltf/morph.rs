//! Morph targets that animations move: what each target adds to the vertices, and its weight over time.

use super::{
    Character,
    accessor::{Buffers, components},
    animation::{check_count, not_in_order},
    json::{Animation, Document, Interpolation, Primitive},
    mesh::vectors,
    sampling::{Place, Rates},
};
use crate::{Problem, motion::MAX_POSITIONS};
use glam::{Quat, Vec3};
use hairspring::body::Trs;
use hairspring_scene::VertexCache;
use std::collections::HashMap;

/// Additions of a target to a vertex that one clip may make: a minute of a face of 20,000 vertices with 28 targets.
const MAX_ADDITIONS: usize = 2_000_000_000;

/// The morph targets of a body that animations of its file move.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Morphs {
    /// In the order of their nodes.
    objects: Vec<Object>,
    keys: Vec<Keys>,
    /// Shape `[clips]`.
    clips: Vec<ClipWeights>,
}

/// The targets of the mesh of one node.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Object {
    pub node: usize,
    pub targets: Vec<Target>,
}

/// One target.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Target {
    /// The weight with which the rest pose already contains the target.
    pub default: f32,
    /// Vertices and what a weight of 1 adds to them in the rest pose [m].
    pub added: Vec<(u32, Vec3)>,
}

/// The weights of all targets of an object over time.
#[derive(Clone, Debug, PartialEq)]
struct Keys {
    interpolation: Interpolation,
    times: Vec<f32>,
    /// Those that have a sample at each of the times.
    rates: Rates,
    /// Shape `[keys][targets]`. For cubic splines `[keys][3][targets]`: in-tangent, value, out-tangent.
    values: Vec<f32>,
    targets: usize,
}

/// The weights that a clip moves.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ClipWeights {
    /// Time of the first frame [s].
    pub start: f32,
    /// Distance of a key from a frame at which the frame has its value [s].
    pub on_key: f32,
    /// Indices of an object and of its keys.
    pub tracks: Vec<(usize, usize)>,
}

/// Adds the morph targets of a primitive to `targets`. Its place in a sentence, its default weights, its first vertex and their number are given.
/// `rest` moves a vector of a vertex to the rest pose.
pub(super) fn add_targets(
    targets: &mut Vec<Target>,
    (document, buffers): (&Document, &Buffers<'_>),
    (primitive, place, defaults): (&Primitive, &str, &[f32]),
    (first, count): (usize, usize),
    rest: impl Fn(usize, Vec3) -> Vec3,
) -> Result<(), Problem> {
    if targets.len() < primitive.targets.len() {
        targets.resize_with(primitive.targets.len(), Default::default);
    }
    for (k, (target, slot)) in primitive.targets.iter().zip(targets).enumerate() {
        slot.default = defaults.get(k).copied().unwrap_or(0.0);
        let Some(accessor) = target.position else { continue };
        let added = vectors(document, accessor, buffers, "positions of a morph target")?;
        if added.len() != count || !added.iter().all(|by| by.is_finite()) {
            return Err(Problem::whole(format!(
                "morph target {k} of {place} has {} positions for {count} vertices, or they are not finite; export it again",
                added.len()
            )));
        }
        // Targets that share an array are kept one by one.
        let nonzero = added.iter().filter(|by| **by != Vec3::ZERO).count();
        buffers.spend(nonzero)?;
        slot.added.reserve_exact(nonzero);
        let moved = added.into_iter().enumerate().filter(|(_, by)| *by != Vec3::ZERO);
        slot.added.extend(moved.map(|(v, by)| ((first + v) as u32, rest(v, by))));
    }
    Ok(())
}

/// Reads the weights of animations. Each pair of accessors is read once.
pub(super) struct Reader<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    read: HashMap<(usize, usize, Interpolation, usize), usize>,
    pub morphs: Morphs,
}

impl<'a> Reader<'a> {
    pub(super) fn new(document: &'a Document, buffers: &'a Buffers<'a>, objects: Vec<Object>) -> Self {
        let morphs = Morphs { objects, ..Morphs::default() };
        Self { document, buffers, read: HashMap::new(), morphs }
    }

    /// Reads the weights that a channel gives the targets of `node`, as indices of the object and its keys; `None` if the
    /// node has no targets.
    pub(super) fn track(
        &mut self,
        (animation, name): (&Animation, &str),
        sampler: usize,
        node: usize,
    ) -> Result<Option<(usize, usize)>, Problem> {
        let Ok(object) = self.morphs.objects.binary_search_by_key(&node, |o| o.node) else { return Ok(None) };
        let targets = self.morphs.objects[object].targets.len();
        let missing = || Problem::whole("an animation channel refers to a missing object");
        let sampler = animation.samplers.get(sampler).ok_or_else(missing)?;
        let key = (sampler.input, sampler.output, sampler.interpolation, targets);
        if let Some(keys) = self.read.get(&key) {
            return Ok(Some((object, *keys)));
        }
        let read = |index: usize, what: &str| -> Result<Vec<f32>, Problem> {
            let read = components::<1>(self.document, index, self.buffers, what)?;
            Ok(read.into_iter().map(|[x]| x as f32).collect())
        };
        let times = read(sampler.input, "times of an animation")?;
        let values = read(sampler.output, "weights of an animation")?;
        let interpolation = sampler.interpolation;
        let what = format!("weights of {targets} morph targets");
        check_count(name, interpolation, times.len(), (values.len(), targets), &what)?;
        if !times.iter().chain(&values).all(|x| x.is_finite()) || !times.is_sorted() {
            return Err(not_in_order(name));
        }
        let rates = Rates::of(&times);
        self.morphs.keys.push(Keys { interpolation, times, rates, values, targets });
        self.read.insert(key, self.morphs.keys.len() - 1);
        Ok(Some((object, self.morphs.keys.len() - 1)))
    }

    /// Times of the keys with this index [s].
    pub(super) fn times(&self, keys: usize) -> &[f32] {
        &self.morphs.keys[keys].times
    }

    /// The rates that have a sample at each of the keys with this index.
    pub(super) fn rates(&self, keys: usize) -> Rates {
        self.morphs.keys[keys].rates
    }

    /// Adds the weights of the next clip.
    pub(super) fn push(&mut self, clip: ClipWeights) {
        self.morphs.clips.push(clip);
    }
}

impl Keys {
    /// Weight of `target` at a place between two keys.
    fn weight(&self, place: &Place, target: usize) -> f32 {
        let value = |key: usize| self.values[key * self.targets + target];
        let (i, j, t) = (place.before, place.after, place.fraction);
        match self.interpolation {
            Interpolation::Step => value(i),
            Interpolation::Linear => value(i) + (value(j) - value(i)) * t,
            Interpolation::CubicSpline => {
                let factors = place.cubic();
                let parts = [value(3 * i + 1), value(3 * i + 2), value(3 * j + 1), value(3 * j)];
                parts.into_iter().zip(factors).map(|(value, factor)| value * factor).sum()
            }
        }
    }
}

impl Morphs {
    /// Whether the clip with this index moves a target.
    pub fn moves(&self, clip: usize) -> bool {
        self.clips.get(clip).is_some_and(|clip| !clip.tracks.is_empty())
    }

    /// Converts what the targets add to meters and Y up.
    pub(crate) fn convert(&mut self, scale: f32, turn: Quat) {
        let added = self.objects.iter_mut().flat_map(|o| &mut o.targets).flat_map(|t| &mut t.added);
        added.for_each(|(_, by)| *by = turn * (*by * scale));
    }

    /// Removes the vertices for which `kept` is false, and renumbers the others.
    pub(crate) fn keep(&mut self, kept: &[bool]) {
        let mut next = 0;
        let numbers = kept.iter().map(|kept| {
            next += u32::from(*kept);
            kept.then(|| next - 1)
        });
        let numbers: Vec<Option<u32>> = numbers.collect();
        for target in self.objects.iter_mut().flat_map(|o| &mut o.targets) {
            let number = |v: u32| numbers.get(v as usize).copied().flatten();
            target.added = target.added.iter().filter_map(|(v, by)| Some((number(*v)?, *by))).collect();
        }
    }

    /// Adds the targets at `time` [s] to `positions`, which are those of the rest pose.
    fn add(&self, clip: &ClipWeights, time: f32, positions: &mut [Vec3]) {
        for (object, keys) in &clip.tracks {
            let keys = &self.keys[*keys];
            let place = Place::new(&keys.times, time, clip.on_key);
            for (k, target) in self.objects[*object].targets.iter().enumerate() {
                let weight = keys.weight(&place, k) - target.default;
                if weight != 0.0 {
                    for (vertex, by) in &target.added {
                        positions[*vertex as usize] += *by * weight;
                    }
                }
            }
        }
    }

    /// Number of additions in one frame of a clip.
    fn additions(&self, clip: &ClipWeights) -> usize {
        let targets = clip.tracks.iter().flat_map(|(object, _)| &self.objects[*object].targets);
        targets.map(|target| target.added.len() + 1).sum()
    }
}

impl Character {
    /// Returns the vertices of the body in the frames of a clip that moves morph targets; `None` for other clips. Joints
    /// of the clip move them, too.
    ///
    /// # Errors
    /// Returns a sentence if the clip is too long for so many vertices or targets.
    pub fn morphed(&self, clip: usize) -> Result<Option<VertexCache>, String> {
        let Some(weights) = self.morphs.clips.get(clip).filter(|_| self.morphs.moves(clip)) else {
            return Ok(None);
        };
        let (body, clip) = (&self.body, &self.clips[clip]);
        let (count, vertices) = (clip.frame_count(), body.mesh.positions.len());
        let additions = self.morphs.additions(weights);
        if count.saturating_mul(vertices) > MAX_POSITIONS || count.saturating_mul(additions) > MAX_ADDITIONS {
            return Err(format!(
                "the motion {:?} has {count} frames of {vertices} vertices and {additions} vertices of morph targets, which is above the limit; shorten it",
                clip.name
            ));
        }
        let rest = body.rest_pose();
        let frames = (0..count).map(|frame| {
            let mut positions = body.mesh.positions.clone();
            self.morphs.add(weights, weights.start + (frame as f64 / clip.rate) as f32, &mut positions);
            let mut pose: Vec<Trs> = clip.samples[frame * clip.joint_count..][..clip.joint_count].to_vec();
            // Other files of the body may have added joints.
            pose.extend(rest.iter().skip(pose.len()));
            let world = body.world(&pose);
            match &body.skin {
                Some(skin) => {
                    let matrices = skin.matrices(&world);
                    positions.iter_mut().enumerate().for_each(|(v, p)| *p = skin.place(v, *p, &matrices));
                }
                None => {
                    let first = world.first().copied().unwrap_or_default();
                    positions.iter_mut().for_each(|p| *p = first.transform_point3(*p));
                }
            }
            positions
        });
        Ok(Some(VertexCache { rate: clip.rate, frames: frames.collect() }))
    }
}
