//! What a camera that is set automatically shows: the box that hair and head stay in, and the path that they take.

use super::{
    Stage,
    body_pose::Pose,
    rehearsal::{self, Rehearsal},
    subject_path::SubjectPath,
};
use crate::Scene;
use glam::{Affine3A, Quat, Vec3};
use hairspring::{body::Body, groom::Groom, math::RigidTransform};
use rayon::prelude::*;

/// Maximum number of poses of the clip that are measured.
const POSES: usize = 240;

/// Maximum number of strands of a groom, and of vertices of the body, that are measured in each pose.
const SAMPLES: usize = 2_000;

/// Rate at which the path of the subject is sampled [Hz], and the maximum number of samples: the rate is lower for a longer
/// motion.
const PATH_RATE: f64 = 30.0;
const PATH_SAMPLES: f64 = 6_000.0;

/// Bisection steps that find the time of a cut between two samples.
const HALVINGS: usize = 24;

/// Maximum number of roots whose mean is the path of the subject.
const ROOTS: usize = 64;

/// The part of the body that belongs to the subject: distance from the hair's box, relative to its diagonal.
const NEARBY: f32 = 0.15;

/// Margin around the subject, relative to the diagonal of the hair at rest.
const MARGIN: f32 = 0.06;

/// Size of the box of the whole motion, relative to that of the subject alone, above which it travels.
const TRAVELS: f32 = 1.5;

/// A box (min, max) [m].
type Bounds = (Vec3, Vec3);

/// The subject of a scene: the hair, and the part of the body near it.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// The box (min, max) [m] that holds the subject over the whole motion, with a margin.
    pub bounds: (Vec3, Vec3),
    /// The box (min, max) [m] at the start that holds the subject at all times, if it moves along the path.
    pub moving_bounds: (Vec3, Vec3),
    /// The path of the subject.
    pub path: SubjectPath,
}

impl Subject {
    /// Returns whether the subject goes so far that it would be small in a picture of its whole motion.
    pub fn travels(&self) -> bool {
        let size = |(low, high): Bounds| (high - low).max_element();
        size(self.bounds) > TRAVELS * size(self.moving_bounds)
    }
}

impl Stage {
    /// Returns the subject over the whole motion. It depends on the scene only, not on the current time. `None` if no point
    /// is finite.
    ///
    /// A few strands are simulated once through the first 20 s, without colliders. Where they swing out of the box of the
    /// rigidly moving hair, the box gets larger, at all times.
    pub fn subject(&self) -> Option<Subject> {
        let points = self.hair.iter().flat_map(|hair| &hair.groom().points).copied();
        let rest = points.fold(None, around)?;
        let size = rest.0.distance(rest.1);
        let samples = Samples::new(self, rest, size * NEARBY);
        let path = samples.path();
        let (beyond, swung) = samples.rehearse();
        let times = times(&self.scene);
        let rigid: Vec<(f64, Bounds)> =
            times.into_par_iter().filter_map(|time| Some((time, samples.bounds(time)?))).collect();
        // The part of the motion that is not rehearsed.
        let long = self.scene.clip.as_ref().is_some_and(|clip| clip.duration() > rehearsal::LONGEST);
        let bounds = |path: &SubjectPath| {
            let moved = |bounds: Bounds, (time, at): &(f64, Bounds)| {
                let offset = path.offset(*time);
                join(bounds, (at.0 - offset, at.1 - offset))
            };
            let rigid = rigid.iter().fold(rest, moved);
            let (low, high) = swung.iter().fold(rigid, moved);
            let (low, high) =
                if long { join((low, high), (rigid.0 - beyond.0, rigid.1 + beyond.1)) } else { (low, high) };
            let room = Vec3::splat(size * MARGIN);
            (low - room, high + room)
        };
        Some(Subject { bounds: bounds(&SubjectPath::default()), moving_bounds: bounds(&path), path })
    }
}

/// The times of the clip at which poses are measured [s]; only the start without a clip.
fn times(scene: &Scene) -> Vec<f64> {
    let Some(clip) = scene.clip.as_ref().filter(|clip| clip.frame_count() > 1) else { return vec![0.0] };
    let count = clip.frame_count().min(POSES);
    (0..count).map(|k| clip.duration() * k as f64 / (count - 1) as f64).collect()
}

/// The body in one pose, of which only some vertices are needed.
struct Posed<'a> {
    body: &'a Body,
    /// The transform of each joint from the rest pose; one for a body without a skin.
    matrices: Vec<Affine3A>,
    /// See [`Pose::shape`].
    shape: Option<Vec<Vec3>>,
}

impl<'a> Posed<'a> {
    fn new(body: &'a Body, Pose { world, shape, .. }: Pose) -> Self {
        let matrices = body.skin.as_ref().map_or_else(|| world.clone(), |skin| skin.matrices(&world));
        Self { body, matrices, shape }
    }

    /// Position of a vertex [m].
    fn vertex(&self, vertex: u32) -> Vec3 {
        let rest = self.shape.as_ref().unwrap_or(&self.body.mesh.positions)[vertex as usize];
        match &self.body.skin {
            Some(skin) => skin.place(vertex as usize, rest, &self.matrices),
            None => self.matrices.first().map_or(rest, |by| by.transform_point3(rest)),
        }
    }

    /// Corners of a triangle [m].
    fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.body.mesh.triangles[triangle as usize].map(|v| self.vertex(v))
    }
}

/// The parts of the subject that are measured: strands, and vertices of the body near them.
struct Samples<'a> {
    stage: &'a Stage,
    /// The body in the pose in which hair is built on it.
    first: Option<Posed<'a>>,
    /// Vertices of the body near the hair.
    vertices: Vec<u32>,
}

impl<'a> Samples<'a> {
    /// `hair`: the box of the hair at rest. Vertices belong to the subject within `reach` [m] of it.
    fn new(stage: &'a Stage, hair: Bounds, reach: f32) -> Self {
        let first = stage.scene.body.as_ref().map(|body| {
            let world = stage.body.pose().first_world(&stage.scene);
            Posed::new(body, Pose { world, ..Pose::default() })
        });
        let mut vertices = Vec::new();
        if let Some(first) = &first {
            let near = |p: Vec3| p.cmpge(hair.0 - reach).all() && p.cmple(hair.1 + reach).all();
            let all = 0..first.body.mesh.positions.len() as u32;
            vertices.extend(all.filter(|v| near(first.vertex(*v))));
            let every = vertices.len().div_ceil(SAMPLES).max(1);
            vertices = vertices.into_iter().step_by(every).collect();
        }
        Self { stage, first, vertices }
    }

    /// The box at `time` [s], if hair moves rigidly with its roots.
    fn bounds(&self, time: f64) -> Option<Bounds> {
        let posed = self.posed(time);
        let now = posed.as_ref().or(self.first.as_ref());
        let skin = now.into_iter().flat_map(|now| self.vertices.iter().map(|v| now.vertex(*v)));
        let skin = skin.fold(None, around);
        self.stage.hair.iter().fold(skin, |bounds, hair| self.hair_bounds(hair.groom(), now, bounds))
    }

    /// The path of the mean of some roots.
    fn path(&self) -> SubjectPath {
        let Stage { scene, hair, body, .. } = self.stage;
        let Some(clip) = &scene.clip else { return SubjectPath::default() };
        let all =
            || hair.iter().flat_map(|hair| (0..hair.groom().strand_count()).map(move |s| (hair.groom(), s)));
        let roots: Vec<_> = all().step_by(all().count().div_ceil(ROOTS).max(1)).collect();
        let rate = (PATH_SAMPLES / clip.duration().max(1e-3)).min(PATH_RATE);
        let time = |sample: usize| (sample as f64 / rate).min(clip.duration());
        let last = (clip.duration() * rate).ceil() as usize;
        let mean = |sample: usize| {
            let posed = self.posed(time(sample));
            let now = posed.as_ref().or(self.first.as_ref());
            let root = |(groom, strand): &(&Groom, usize)| self.root(groom, *strand, now).0;
            roots.iter().map(root).sum::<Vec3>() / roots.len() as f32
        };
        let positions: Vec<Vec3> = (0..=last).into_par_iter().map(mean).collect();
        let anchor = body.pose().anchor_joint();
        let cut =
            |from: f64, to: f64| body.pose().cut(scene, (from, to)).get(anchor).is_some_and(Option::is_some);
        let time_of_cut = |sample: usize| {
            let (mut from, mut to) = (time(sample - 1), time(sample));
            cut(from, to).then(|| {
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (from + to);
                    *(if cut(from, middle) { &mut to } else { &mut from }) = middle;
                }
                to
            })
        };
        SubjectPath::new(&positions, rate, &(1..=last).filter_map(time_of_cut).collect::<Vec<_>>())
    }

    /// Returns how far strands swing out of the box of the same strands that move rigidly, on its lower and upper sides [m],
    /// and their box at each time [s].
    fn rehearse(&self) -> (Bounds, Vec<(f64, Bounds)>) {
        let (mut beyond, mut swung) = ((Vec3::ZERO, Vec3::ZERO), Vec::new());
        let Stage { scene, hair, body, .. } = self.stage;
        let frames = Rehearsal::frames(scene);
        let Some(mut rehearsal) = (frames > 0).then(|| Rehearsal::new(self.stage)).flatten() else {
            return (beyond, swung);
        };
        let strands = rehearsal.strands().to_vec();
        let end = scene.clip.as_ref().map_or(0.0, |clip| clip.duration());
        let at = |frame: usize| (frame as f64 / rehearsal::RATE).min(end);
        for frame in 0..=frames {
            let (from, to) = (at(frame.saturating_sub(1)), at(frame));
            let pose = body.pose().at(scene, to);
            let anchor = pose.as_ref().map_or(body.pose().rest_anchor(), |pose| pose.anchor);
            let posed = scene.body.as_ref().zip(pose).map(|(body, pose)| Posed::new(body, pose));
            let now = posed.as_ref().or(self.first.as_ref());
            let root = |&(groom, strand): &(usize, usize)| {
                let (translation, rotation) = self.root(hair[groom].groom(), strand, now);
                RigidTransform { translation, rotation }
            };
            let roots: Vec<RigidTransform> = strands.iter().map(root).collect();
            if frame == 0 {
                rehearsal.place(anchor, &roots);
                continue;
            }
            if let Some(Some(cut)) = body.pose().cut(scene, (from, to)).get(body.pose().anchor_joint()) {
                rehearsal.teleport(*cut);
            }
            let time = (frame - 1) as f64 / rehearsal::RATE;
            let box_of_points = rehearsal.step(time, anchor, &roots).iter().copied().fold(None, around);
            let rigid = strands.iter().zip(&roots).fold(None, |bounds, (&(groom, strand), root)| {
                carried(hair[groom].groom().strand(strand), root).fold(bounds, around)
            });
            if let (Some(points), Some(rigid)) = (box_of_points, rigid) {
                beyond = (beyond.0.max(rigid.0 - points.0), beyond.1.max(points.1 - rigid.1));
                swung.push((to, points));
            }
        }
        (beyond, swung)
    }

    /// The body at `time` [s]; `None` without a motion.
    fn posed(&self, time: f64) -> Option<Posed<'a>> {
        let Stage { scene, body, .. } = self.stage;
        Some(Posed::new(scene.body.as_ref()?, body.pose().at(scene, time)?))
    }

    /// Extends `bounds` by the hair of a groom that moves rigidly with its roots on the body `now`.
    fn hair_bounds(&self, groom: &Groom, now: Option<&Posed>, bounds: Option<Bounds>) -> Option<Bounds> {
        let every = groom.strand_count().div_ceil(SAMPLES).max(1);
        (0..groom.strand_count()).step_by(every).fold(bounds, |bounds, s| {
            let (translation, rotation) = self.root(groom, s, now);
            carried(groom.strand(s), &RigidTransform { translation, rotation }).fold(bounds, around)
        })
    }

    /// Position of a strand's root, and its rotation since the first pose.
    fn root(&self, groom: &Groom, strand: usize, now: Option<&Posed>) -> (Vec3, Quat) {
        let (Some(first), Some(now), Some(root)) = (&self.first, now, groom.roots.get(strand)) else {
            return (groom.strand(strand)[0], Quat::IDENTITY);
        };
        let (before, now) = (first.corners(root.triangle), now.corners(root.triangle));
        (root.position(now), (root.frame(now) * root.frame(before).inverse()).normalize())
    }
}

/// The points of a strand that moves rigidly with its root.
fn carried<'a>(strand: &'a [Vec3], root: &'a RigidTransform) -> impl Iterator<Item = Vec3> + 'a {
    strand.iter().map(|p| root.translation + root.rotation * (*p - strand[0]))
}

/// Extends a box by a point, if the point is finite.
fn around(bounds: Option<Bounds>, p: Vec3) -> Option<Bounds> {
    if !p.is_finite() {
        return bounds;
    }
    let (low, high) = bounds.unwrap_or((p, p));
    Some((low.min(p), high.max(p)))
}

fn join(a: Bounds, b: Bounds) -> Bounds {
    (a.0.min(b.0), a.1.max(b.1))
}
