//! The box that hair and head stay in over the whole motion, for a camera that is set automatically.

use super::{Stage, body_pose::Pose, hair::StagedHair};
use crate::Scene;
use glam::{Affine3A, Quat, Vec3};
use hairspring::{body::Body, groom::Groom};
use rayon::prelude::*;

/// Maximum number of poses of the clip that are measured.
const POSES: usize = 240;

/// Maximum number of strands of a groom, and of vertices of the body, that are measured in each pose.
const SAMPLES: usize = 2_000;

/// The part of the body that belongs to the subject: distance from the hair's box, relative to its diagonal.
const NEARBY: f32 = 0.15;

/// Margin around the subject for hair that swings, relative to the diagonal of the hair at rest. Where the
/// body moves, hair swings farther.
const MARGIN: [f32; 2] = [0.06, 0.12];

/// Wind speed at which long hair is nearly horizontal [m/s].
const STRONG_WIND: f32 = 2.0;

/// Time over which the acceleration of a root is measured [s].
const INTERVAL: f64 = 1.0 / 15.0;

/// Acceleration that throws hair to its length [m/s²].
const STANDARD_GRAVITY: f32 = 9.81;

/// A box (min, max) [m].
type Bounds = (Vec3, Vec3);

impl Stage {
    /// Returns the box (min, max) [m] of the subject over the whole motion, with a margin for hair that
    /// swings: the hair, and the part of the body near it. It depends on the scene only, not on the current
    /// time. `None` if no point is finite.
    ///
    /// Nothing is simulated: hair moves rigidly with its root, is blown in the direction of the wind at the height of
    /// a gust, is thrown against the acceleration of its root, and falls if it starts out of balance.
    pub fn subject_bounds(&self) -> Option<Bounds> {
        let points = self.hair.iter().flat_map(|hair| &hair.groom().points).copied();
        let rest = points.fold(None, around)?;
        let size = rest.0.distance(rest.1);
        let times = times(&self.scene);
        let subject = Subject::new(self, rest, size * NEARBY);
        let moving = times.len() > 1;
        let moved = times.into_par_iter().filter_map(|time| subject.bounds(time)).reduce_with(join);
        let (low, high) = moved.map_or(rest, |moved| join(rest, moved));
        let room = Vec3::splat(size * MARGIN[usize::from(moving)]);
        Some((low - room, high + room))
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

/// What the camera shows: all hair, and the part of the body near it.
struct Subject<'a> {
    stage: &'a Stage,
    /// The body in the pose in which hair is built on it.
    first: Option<Posed<'a>>,
    /// Vertices of the body near the hair.
    vertices: Vec<u32>,
    /// Displacement of a tip from its root due to wind, relative to the length of the hair.
    blown: Vec3,
    /// The same due to gravity, if hair starts out of balance.
    fallen: Vec3,
}

impl<'a> Subject<'a> {
    /// `hair`: the box of the hair at rest. Vertices belong to the subject within `reach` [m] of it.
    fn new(stage: &'a Stage, hair: Bounds, reach: f32) -> Self {
        let Scene { body, wind, gravity, solver, .. } = &stage.scene;
        let first = body.as_ref().map(|body| {
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
        let gust = wind.velocity.length() * (1.0 + wind.gust);
        let blown = wind.velocity.normalize_or_zero() * (gust / STRONG_WIND).min(1.0);
        let falls = !solver.sag_free && solver.preroll == 0.0;
        let fallen = if falls { gravity.normalize_or_zero() } else { Vec3::ZERO };
        Self { stage, first, vertices, blown, fallen }
    }

    /// The box in the pose at `time` [s].
    fn bounds(&self, time: f64) -> Option<Bounds> {
        let end = self.stage.scene.clip.as_ref().map_or(0.0, |clip| clip.duration());
        let poses = [-INTERVAL, 0.0, INTERVAL].map(|later| self.posed((time + later).clamp(0.0, end)));
        let poses = poses.each_ref().map(|pose| pose.as_ref().or(self.first.as_ref()));
        let skin = poses[1].into_iter().flat_map(|now| self.vertices.iter().map(|v| now.vertex(*v)));
        let skin = skin.fold(None, around);
        self.stage.hair.iter().fold(skin, |bounds, hair| self.hair_bounds(hair, poses, bounds))
    }

    /// The body at `time` [s]; `None` without a motion.
    fn posed(&self, time: f64) -> Option<Posed<'a>> {
        let Stage { scene, body, .. } = self.stage;
        Some(Posed::new(scene.body.as_ref()?, body.pose().at(scene, time)?))
    }

    /// Extends `bounds` by the hair of a groom, with the body in the second of three poses, one [`INTERVAL`] apart.
    fn hair_bounds(
        &self,
        hair: &StagedHair,
        poses: [Option<&Posed>; 3],
        bounds: Option<Bounds>,
    ) -> Option<Bounds> {
        let groom = hair.groom();
        let every = groom.strand_count().div_ceil(SAMPLES).max(1);
        (0..groom.strand_count()).step_by(every).fold(bounds, |bounds, s| {
            let strand = groom.strand(s);
            let [(before, _), (root, turn), (after, _)] = poses.map(|pose| self.root(groom, s, pose));
            let length: f32 = strand.windows(2).map(|w| w[0].distance(w[1])).sum();
            let carried = strand.iter().map(|p| root + turn * (*p - strand[0]));
            // An acceleration like that of gravity throws hair to its length, in the wind and without it.
            let acceleration = (after - 2.0 * root + before) / (INTERVAL * INTERVAL) as f32;
            let thrown = (-acceleration / STANDARD_GRAVITY).clamp_length_max(1.0);
            let pulls = [self.blown, thrown, (self.blown + thrown).clamp_length_max(1.0), self.fallen];
            let pulled =
                pulls.into_iter().filter(|pull| *pull != Vec3::ZERO).map(|pull| root + pull * length);
            carried.chain(pulled).fold(bounds, around)
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
