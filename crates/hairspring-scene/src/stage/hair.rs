//! One groom of the scene: which of its strands are simulated, where their roots are, and the hairs that follow them.

use super::{Strands, body::StagedBody};
use crate::{Guides, HairLook, Scene, SceneGroom};
use glam::{Quat, Vec3};
use hairspring::{
    body::Mesh,
    collide::ColliderPose,
    follow::{Follow, HairInterpolation, assign_guides, choose_guides, split_by},
    groom::{Groom, GuideWeights},
    material::Material,
    math::RigidTransform,
    settings::Effects,
    simulation::Simulation,
};
use rayon::prelude::*;
use std::sync::Arc;

/// Guides of a groom that names none and a scene that asks for no number.
const DEFAULT_GUIDES: usize = 2_000;

pub(super) struct StagedHair {
    groom: Arc<Groom>,
    materials: Vec<Material>,
    look: HairLook,
    /// The simulated strands, as indices of the groom.
    strands: Vec<u32>,
    /// The first of them among those of all grooms.
    first: usize,
    /// `None` where every strand is simulated.
    follow: Option<Follow>,
    /// Orientation of each simulated root's triangle at rest, inverted; empty while the roots are bound to nothing.
    rest_frames: Vec<Quat>,
    triangles: Vec<[u32; 3]>,
    roots: Vec<RigidTransform>,
    turns: Vec<Quat>,
    /// Points of the simulated strands; of use where others follow them.
    guide_points: Vec<Vec3>,
    points: Vec<Vec3>,
    /// Whether the follow hairs among `points` are left to who draws them, and not up to date.
    left: bool,
}

impl StagedHair {
    /// The hair of `groom` at rest on the body as it is at the start; its first simulated strand is the `first` of those of all grooms.
    pub(super) fn new(groom: SceneGroom, first: usize, scene: &Scene, body: &StagedBody) -> Self {
        let SceneGroom { groom, materials, guides, effects, look } = groom;
        let mesh = scene.body.as_ref().map(|b| &b.mesh).filter(|_| !groom.roots.is_empty());
        let groom = Arc::new(match mesh {
            Some(mesh) if body.stands_apart() => stand(groom, body, mesh),
            _ => groom,
        });
        let (strands, weights) = roles(&groom, guides);
        let follow = weights.map(|w| Follow::new(groom.clone(), &strands, &w, effects, &body.poses()));
        let triangle = |s: &u32| groom.roots[*s as usize].triangle as usize;
        let rest_frames = mesh.map_or(Vec::new(), |mesh| {
            let frame =
                |s: &u32| groom.roots[*s as usize].frame(body.first_corners(mesh, triangle(s))).inverse();
            strands.iter().map(frame).collect()
        });
        let triangles =
            mesh.map_or(Vec::new(), |mesh| strands.iter().map(|s| mesh.triangles[triangle(s)]).collect());
        let roots = strands
            .iter()
            .map(|s| RigidTransform { translation: groom.strand(*s as usize)[0], rotation: Quat::IDENTITY })
            .collect();
        Self {
            turns: vec![Quat::IDENTITY; strands.len()],
            guide_points: vec![Vec3::ZERO; strands.iter().map(|s| groom.range(*s as usize).len()).sum()],
            points: groom.points.clone(),
            groom,
            materials,
            look,
            strands,
            first,
            follow,
            rest_frames,
            triangles,
            roots,
            left: false,
        }
    }

    /// See [`super::Stage::set_external_interpolation`].
    pub(super) fn leave(&mut self, left: bool, body: &StagedBody) {
        if std::mem::replace(&mut self.left, left) && !left {
            self.place_followers(body);
        }
    }

    /// Takes up other settings in the midst of the play; whether the materials, and whether the effects are others than before.
    pub(super) fn update_settings(&mut self, settings: SceneGroom) -> (bool, bool) {
        let SceneGroom { materials, effects, look, .. } = settings;
        self.look = look;
        let laid = self.follow.as_mut().is_some_and(|follow| follow.set_effects(effects) != effects);
        let made = materials != self.materials;
        self.materials = materials;
        (made, laid)
    }

    /// Where the roots are on the posed body.
    pub(super) fn pose_roots(&mut self, body: &StagedBody) {
        if self.rest_frames.is_empty() {
            return;
        }
        for (k, s) in self.strands.iter().enumerate() {
            let root = &self.groom.roots[*s as usize];
            let corners = self.triangles[k].map(|i| body.positions()[i as usize]);
            self.roots[k] = RigidTransform {
                translation: root.position(corners),
                rotation: (root.frame(corners) * self.rest_frames[k]).normalize(),
            };
        }
    }

    /// Brings the points of all strands up to date, but for follow hairs that are left to who draws them.
    pub(super) fn show(&mut self, simulation: &Simulation, body: &StagedBody) {
        let own = self.first..self.first + self.strands.len();
        let Some(follow) = &mut self.follow else {
            simulation.write_points_of(own, &mut self.points);
            return;
        };
        simulation.write_points_of(own, &mut self.guide_points);
        for (turn, root) in self.turns.iter_mut().zip(&self.roots) {
            *turn = root.rotation;
        }
        follow.carry(&self.guide_points, &self.turns);
        if !self.left {
            self.place_followers(body);
        }
    }

    /// See [`super::Stage::place_follow_hairs`].
    pub(super) fn place_followers(&mut self, body: &StagedBody) {
        if let Some(follow) = &self.follow {
            follow.now(&self.guide_points, body.obstacles()).place(&mut self.points);
        }
    }

    /// What places the follow hairs as they are now, where there are any.
    fn followed<'a>(&'a self, body: &'a StagedBody) -> Option<HairInterpolation<'a>> {
        Some(self.follow.as_ref()?.now(&self.guide_points, body.obstacles()))
    }

    /// Looks at each strand's points as they are now, those left to who draws them too, on many threads.
    pub(super) fn each_strand<'a, T: Send + 'a>(
        &'a self,
        body: &'a StagedBody,
        strands: std::ops::Range<usize>,
        look: impl Fn(usize, &[Vec3]) -> T + Sync + Send + 'a,
    ) -> impl ParallelIterator<Item = T> + 'a {
        let left = if self.left { self.followed(body) } else { None };
        let poses = left.map_or(Vec::new(), |_| body.poses());
        let of_strand = move |own: &mut Vec<Vec3>, s: usize| {
            let range = self.groom.range(s);
            let Some(left) = left else { return look(s, &self.points[range]) };
            own.resize(range.len(), Vec3::ZERO);
            left.place_strand(s, &poses, own);
            look(s, own)
        };
        strands.into_par_iter().with_min_len(256).map_init(Vec::new, of_strand)
    }

    /// Points of a simulated strand, by its place among them and its number in the groom [m].
    pub(super) fn guide_points(&self, k: usize, strand: usize) -> &[Vec3] {
        match &self.follow {
            Some(follow) => &self.guide_points[follow.guide_range(k)],
            None => &self.points[self.groom.range(strand)],
        }
    }

    /// The place of a strand among the simulated ones, if it is one.
    pub(super) fn simulated(&self, strand: usize) -> Option<usize> {
        self.follow.as_ref().map_or(Some(strand), |follow| follow.guide(strand))
    }

    /// The same of the first guide that a strand follows; its own where it is simulated.
    pub(super) fn first_guide(&self, strand: usize) -> usize {
        self.follow.as_ref().map_or(strand, |follow| follow.first_guide(strand))
    }

    /// Writes one number a point of all strands: what `of_guide` writes for each simulated strand (its place among them, its number in the groom), and
    /// follow hairs by their first guide.
    pub(super) fn values(&self, of_guide: impl Fn(usize, usize, &mut [f32]) + Sync, out: &mut Vec<f32>) {
        let mut offsets = vec![0];
        for s in &self.strands {
            offsets.push(offsets[offsets.len() - 1] + self.groom.range(*s as usize).len() as u32);
        }
        let mut of_guides = vec![0.0; offsets[self.strands.len()] as usize];
        let pieces = split_by(&mut of_guides, &offsets).into_par_iter().zip(&self.strands).enumerate();
        pieces.with_min_len(16).for_each(|(k, (piece, s))| of_guide(k, *s as usize, piece));
        match &self.follow {
            None => *out = of_guides,
            Some(follow) => {
                out.resize(self.groom.point_count(), 0.0);
                follow.spread(&of_guides, out);
            }
        }
    }

    /// How far each joint of a simulated strand (its place among them, its number in the groom) is turned from the groom's, carried along by the root [rad].
    pub(super) fn turns(&self, k: usize, strand: usize, out: &mut [f32]) {
        let (rest, now) = (self.groom.strand(strand), self.guide_points(k, strand));
        let mut turn = self.roots[k].rotation;
        out.fill(0.0);
        for (i, angle) in out.iter_mut().enumerate().take(rest.len() - 1) {
            let was = (turn * (rest[i + 1] - rest[i])).try_normalize();
            if let (Some(was), Some(is)) = (was, (now[i + 1] - now[i]).try_normalize()) {
                // The first segment has no joint: the root turns it.
                *angle = if i == 0 { 0.0 } else { was.cross(is).length().atan2(was.dot(is)) };
                turn = (Quat::from_rotation_arc(was, is) * turn).normalize();
            }
        }
    }

    pub(super) fn strands<'a>(&'a self, body: &'a StagedBody) -> Strands<'a> {
        let follow = if self.left { self.followed(body) } else { None };
        Strands { points: &self.points, groom: &self.groom, look: &self.look, follow }
    }

    pub(super) fn groom(&self) -> &Groom {
        &self.groom
    }

    pub(super) fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// Where the simulated roots are, and how they have turned since rest.
    pub(super) fn roots(&self) -> &[RigidTransform] {
        &self.roots
    }

    /// The simulated strands, as indices of the groom.
    pub(super) fn simulated_strands(&self) -> &[u32] {
        &self.strands
    }

    /// The first of them among those of all grooms.
    pub(super) fn first(&self) -> usize {
        self.first
    }

    /// How many hairs each of them stands for.
    pub(super) fn hairs(&self) -> impl Iterator<Item = f32> + use<> {
        let hairs = self.groom.strand_count() as f32 / self.strands.len() as f32;
        std::iter::repeat_n(hairs, self.strands.len())
    }

    /// Takes the hair as it is in `simulation`, among `obstacles`, for its groom. Nothing is laid over follow hairs for that.
    pub(super) fn rest_as(&mut self, simulation: &Simulation, body: &StagedBody, obstacles: &[ColliderPose]) {
        let effects = self.follow.as_mut().map(|follow| follow.set_effects(Effects::default()));
        self.show(simulation, body);
        let groom = Arc::new(Groom { points: self.points.clone(), ..(*self.groom).clone() });
        if let (Some(follow), Some(effects)) = (&mut self.follow, effects) {
            *follow = follow.of(groom.clone(), obstacles);
            follow.set_effects(effects);
        }
        self.groom = groom;
    }
}

/// The strands of a groom where the body has their roots at the start, where it has other things than at rest.
fn stand(groom: Groom, body: &StagedBody, mesh: &Mesh) -> Groom {
    let mut points = groom.points.clone();
    for (s, root) in groom.roots.iter().enumerate() {
        let triangle = root.triangle as usize;
        let (rest, now) = (mesh.corners(triangle), body.first_corners(mesh, triangle));
        let turn = root.frame(now) * root.frame(rest).inverse();
        let (from, to) = (root.position(rest), root.position(now));
        points[groom.range(s)].iter_mut().for_each(|p| *p = to + turn * (*p - from));
    }
    Groom { points, ..groom }
}

/// Which strands are simulated, and what the others follow (`None`: there are no others).
fn roles(groom: &Groom, guides: Guides) -> (Vec<u32>, Option<Vec<GuideWeights>>) {
    let all = || (0..groom.strand_count() as u32).collect::<Vec<_>>();
    let simulated = match guides {
        Guides::All => return (all(), None),
        Guides::FromGroom if !groom.guides.is_empty() => {
            let mut used: Vec<u32> = groom
                .guides
                .iter()
                .flat_map(|g| g.guides.iter().zip(g.weights).filter(|(_, w)| *w > 0.0).map(|(g, _)| *g))
                .collect();
            used.sort_unstable();
            used.dedup();
            return (used, Some(groom.guides.clone()));
        }
        Guides::FromGroom => choose_guides(groom, DEFAULT_GUIDES),
        Guides::Count(n) => choose_guides(groom, (n as usize).max(1)),
    };
    if simulated.len() == groom.strand_count() {
        return (simulated, None);
    }
    let weights = assign_guides(groom, &simulated);
    (simulated, Some(weights))
}
