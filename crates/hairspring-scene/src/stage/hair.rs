//! One groom of the scene: its simulated strands, their roots, and the hairs that follow them.

use super::{Strands, body::StagedBody};
use crate::{Guides, HairLook, Scene, SceneGroom};
use glam::{Quat, Vec3};
use hairspring::{
    body::Mesh,
    collide::ColliderPose,
    follow::{Follow, HairInterpolation, assign_guides, split_by},
    groom::{Groom, GuideWeights},
    material::Material,
    math::RigidTransform,
    settings::Effects,
    simulation::Simulation,
};
use rayon::prelude::*;
use std::sync::Arc;

pub(super) struct StagedHair {
    groom: Arc<Groom>,
    materials: Vec<Material>,
    look: HairLook,
    guides: Guides,
    /// Simulated strands, as indices of the groom.
    strands: Vec<u32>,
    /// Index of the first of them among the simulated strands of all grooms.
    first: usize,
    /// `None` if every strand is simulated.
    follow: Option<Follow>,
    /// Inverse orientation of each simulated root's triangle at rest; empty while the roots are unbound.
    rest_frames: Vec<Quat>,
    triangles: Vec<[u32; 3]>,
    roots: Vec<RigidTransform>,
    turns: Vec<Quat>,
    /// Points of the simulated strands; used if other strands follow them.
    guide_points: Vec<Vec3>,
    points: Vec<Vec3>,
    /// Whether the renderer interpolates the follow hairs, so that those in `points` are not up to date.
    left: bool,
}

impl StagedHair {
    /// Creates the hair of `groom` at rest, on the body in its initial pose. `first` is the index of its
    /// first simulated strand among those of all grooms.
    pub(super) fn new(groom: SceneGroom, first: usize, scene: &Scene, body: &StagedBody) -> Self {
        let SceneGroom { name: _, groom, materials, guides, effects, look } = groom;
        let mesh = scene.body.as_ref().map(|b| &b.mesh).filter(|_| !groom.roots.is_empty());
        let groom = Arc::new(match mesh {
            Some(mesh) if body.pose().stands_apart() => stand(groom, body, mesh),
            _ => groom,
        });
        let (strands, weights) = roles(&groom, guides);
        let follow =
            weights.map(|w| Follow::new(groom.clone(), &strands, &w, effects, &body.keeping_poses()));
        let triangle = |s: &u32| groom.roots[*s as usize].triangle as usize;
        let rest_frames = mesh.map_or(Vec::new(), |mesh| {
            let frame = |s: &u32| {
                groom.roots[*s as usize].frame(body.pose().first_corners(mesh, triangle(s))).inverse()
            };
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
            guides,
            strands,
            first,
            follow,
            rest_frames,
            triangles,
            roots,
            left: false,
        }
    }

    /// Returns a note if more strands are simulated than the scene asks for.
    pub(super) fn more_than_asked(&self) -> Option<String> {
        self.guides.more_than_asked(&self.groom, self.strands.len())
    }

    /// See [`super::Stage::set_external_interpolation`].
    pub(super) fn leave(&mut self, left: bool, body: &StagedBody) {
        if std::mem::replace(&mut self.left, left) && !left {
            self.place_followers(body);
        }
    }

    /// Replaces the settings while the scene is running. Returns whether the materials and whether the
    /// styling changed.
    pub(super) fn update_settings(&mut self, settings: SceneGroom) -> (bool, bool) {
        let SceneGroom { materials, effects, look, .. } = settings;
        self.look = look;
        let laid = self.follow.as_mut().is_some_and(|follow| follow.set_effects(effects) != effects);
        let made = materials != self.materials;
        self.materials = materials;
        (made, laid)
    }

    /// Updates the roots from the posed body.
    pub(super) fn pose_roots(&mut self, body: &StagedBody) {
        if self.rest_frames.is_empty() {
            return;
        }
        for (k, s) in self.strands.iter().enumerate() {
            let root = &self.groom.roots[*s as usize];
            let corners = self.triangles[k].map(|i| body.pose().positions()[i as usize]);
            self.roots[k] = RigidTransform {
                translation: root.position(corners),
                rotation: (root.frame(corners) * self.rest_frames[k]).normalize(),
            };
        }
    }

    /// Updates the points of all strands, except for follow hairs that the renderer interpolates.
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
        follow.update_guide_transforms(&self.guide_points, &self.turns);
        if !self.left {
            self.place_followers(body);
        }
    }

    /// See [`super::Stage::place_follow_hairs`].
    pub(super) fn place_followers(&mut self, body: &StagedBody) {
        if let Some(follow) = &self.follow {
            follow.interpolation(&self.guide_points, body.colliders()).place(&mut self.points);
        }
    }

    /// Returns the data that places the follow hairs in the current frame, if there are any.
    fn followed<'a>(&'a self, body: &'a StagedBody) -> Option<HairInterpolation<'a>> {
        Some(self.follow.as_ref()?.interpolation(&self.guide_points, body.colliders()))
    }

    /// Calls `look` with the current points of each strand, in parallel. This includes follow hairs that the
    /// renderer interpolates.
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

    /// Returns the points of a simulated strand [m]. `k` is its index among the simulated strands, `strand`
    /// that in the groom.
    pub(super) fn guide_points(&self, k: usize, strand: usize) -> &[Vec3] {
        match &self.follow {
            Some(follow) => &self.guide_points[follow.guide_range(k)],
            None => &self.points[self.groom.range(strand)],
        }
    }

    /// Returns the current points of each simulated strand [m].
    pub(super) fn simulated_points(&self) -> impl Iterator<Item = &[Vec3]> {
        self.strands.iter().enumerate().map(|(k, strand)| self.guide_points(k, *strand as usize))
    }

    /// Returns the points of each simulated strand as authored [m].
    pub(super) fn authored_points(&self) -> impl Iterator<Item = &[Vec3]> {
        self.strands.iter().map(|strand| self.groom.strand(*strand as usize))
    }

    /// Returns the index of a strand among the simulated ones, or `None` if it is not simulated.
    pub(super) fn simulated(&self, strand: usize) -> Option<usize> {
        self.follow.as_ref().map_or(Some(strand), |follow| follow.guide(strand))
    }

    /// Returns the index among the simulated strands of the first guide of a strand, or its own if it is
    /// simulated.
    pub(super) fn first_guide(&self, strand: usize) -> usize {
        self.follow.as_ref().map_or(strand, |follow| follow.first_guide(strand))
    }

    /// Writes one value for each point of all strands. `of_guide` writes those of a simulated strand, given
    /// its index among the simulated strands and in the groom. Follow hairs take the values of their first
    /// guide.
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
                follow.interpolate_values(&of_guides, out);
            }
        }
    }

    /// Computes the angle of each joint of a simulated strand from that of the groom, after transport from
    /// the root [rad]. `k` is its index among the simulated strands, `strand` that in the groom.
    pub(super) fn turns(&self, k: usize, strand: usize, out: &mut [f32]) {
        let (rest, now) = (self.groom.strand(strand), self.guide_points(k, strand));
        let mut turn = self.roots[k].rotation;
        out.fill(0.0);
        for (i, angle) in out.iter_mut().enumerate().take(rest.len() - 1) {
            let was = (turn * (rest[i + 1] - rest[i])).try_normalize();
            if let (Some(was), Some(is)) = (was, (now[i + 1] - now[i]).try_normalize()) {
                // The first segment has no joint: it rotates with the root.
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

    /// Returns the transforms of the simulated roots since rest.
    pub(super) fn roots(&self) -> &[RigidTransform] {
        &self.roots
    }

    /// Returns the simulated strands, as indices of the groom.
    pub(super) fn simulated_strands(&self) -> &[u32] {
        &self.strands
    }

    /// Returns the index of the first of them among the simulated strands of all grooms.
    pub(super) fn first(&self) -> usize {
        self.first
    }

    /// Returns the multiplicity of each simulated strand: how many hairs it represents.
    pub(super) fn hairs(&self) -> impl Iterator<Item = f32> + use<> {
        let hairs = self.groom.strand_count() as f32 / self.strands.len() as f32;
        std::iter::repeat_n(hairs, self.strands.len())
    }

    /// Makes the current state of the hair in `simulation` its groom. `colliders` are where the colliders are. Styling
    /// of follow hairs is not included.
    pub(super) fn rest_as(&mut self, simulation: &Simulation, body: &StagedBody, colliders: &[ColliderPose]) {
        let effects = self.follow.as_mut().map(|follow| follow.set_effects(Effects::default()));
        self.show(simulation, body);
        let groom = Arc::new(Groom { points: self.points.clone(), ..(*self.groom).clone() });
        if let (Some(follow), Some(effects)) = (&mut self.follow, effects) {
            *follow = follow.with_rest_pose(groom.clone(), colliders);
            follow.set_effects(effects);
        }
        self.groom = groom;
    }
}

/// Moves the strands of a groom to the initial pose of the body, which may differ from the rest pose.
fn stand(groom: Groom, body: &StagedBody, mesh: &Mesh) -> Groom {
    let mut points = groom.points.clone();
    for (s, root) in groom.roots.iter().enumerate() {
        let triangle = root.triangle as usize;
        let (rest, now) = (mesh.corners(triangle), body.pose().first_corners(mesh, triangle));
        let turn = root.frame(now) * root.frame(rest).inverse();
        let (from, to) = (root.position(rest), root.position(now));
        points[groom.range(s)].iter_mut().for_each(|p| *p = to + turn * (*p - from));
    }
    Groom { points, ..groom }
}

/// Returns the simulated strands, and the guides of the others; `None` if there are no others.
fn roles(groom: &Groom, guides: Guides) -> (Vec<u32>, Option<Vec<GuideWeights>>) {
    let simulated = guides.simulated(groom);
    let weights = match guides {
        Guides::FromGroom if !groom.guides.is_empty() => Some(groom.guides.clone()),
        _ if simulated.len() == groom.strand_count() => None,
        _ => Some(assign_guides(groom, &simulated)),
    };
    (simulated, weights)
}
