//! One groom of the scene: its simulated strands and the hairs that follow them.

use super::{FrameReport, Strands, body::StagedBody};
use crate::{
    around::Tool,
    collide::{ObstaclePose, Rigid},
    follow::{Follow, Followed, assign_guides, choose_guides, split_by},
    groom::Groom,
    material::Material,
    scene::{Guides, HairLook, Scene, SceneGroom},
    simulation::{Air, Drive, Simulation, ToolId},
};
use glam::{Quat, Vec3};
use rayon::prelude::*;
use std::{sync::Arc, time::Instant};

/// Guides of a groom that names none and a scene that asks for no number.
const DEFAULT_GUIDES: usize = 2_000;

pub(super) struct StagedHair {
    groom: Arc<Groom>,
    materials: Vec<Material>,
    look: HairLook,
    simulation: Simulation,
    /// `None` where every strand is simulated.
    follow: Option<Follow>,
    /// Orientation of each simulated root's triangle at rest, inverted; empty while the roots are bound to nothing.
    rest_frames: Vec<Quat>,
    triangles: Vec<[u32; 3]>,
    roots: Vec<Rigid>,
    turns: Vec<Quat>,
    /// Points of the simulated strands; of use where others follow them.
    guide_points: Vec<Vec3>,
    points: Vec<Vec3>,
    /// Whether the follow hairs among `points` are left to who draws them, and not up to date.
    left: bool,
}

impl StagedHair {
    pub(super) fn new(groom: SceneGroom, scene: &Scene, body: &StagedBody) -> Self {
        let SceneGroom { groom, materials, guides, effects, look } = groom;
        let groom = Arc::new(groom);
        let (simulated, weights) = roles(&groom, guides);
        let obstacles = body.poses();
        let simulation = simulation(&groom, &simulated, &materials, scene, body.anchor(), &obstacles);
        let follow = weights.map(|w| Follow::new(groom.clone(), &simulated, &w, effects, &obstacles));
        let mesh = scene.body.as_ref().map(|b| &b.mesh).filter(|_| !groom.roots.is_empty());
        let rest_frames = mesh.map_or(Vec::new(), |mesh| {
            let frame = |s: &u32| {
                let root = &groom.roots[*s as usize];
                root.frame(mesh.corners(root.triangle as usize)).inverse()
            };
            simulated.iter().map(frame).collect()
        });
        let triangles = mesh.map_or(Vec::new(), |mesh| {
            simulated.iter().map(|s| mesh.triangles[groom.roots[*s as usize].triangle as usize]).collect()
        });
        let roots = simulated
            .iter()
            .map(|s| Rigid { translation: groom.strand(*s as usize)[0], rotation: Quat::IDENTITY })
            .collect();
        Self {
            turns: vec![Quat::IDENTITY; simulated.len()],
            guide_points: vec![Vec3::ZERO; simulation.point_count()],
            points: groom.points.clone(),
            groom,
            materials,
            look,
            simulation,
            follow,
            rest_frames,
            triangles,
            roots,
            left: false,
        }
    }

    /// See [`super::Stage::leave_follow_hairs`].
    pub(super) fn leave(&mut self, left: bool, body: &StagedBody) {
        if std::mem::replace(&mut self.left, left) && !left {
            self.place_followers(body);
        }
    }

    /// Takes up other settings in the midst of the play; `fresh`: the scene's own are others than before.
    pub(super) fn retune(&mut self, settings: SceneGroom, scene: &Scene, body: &StagedBody, fresh: bool) {
        self.look = settings.look;
        if fresh || settings.materials != self.materials {
            let strands: Vec<u32> = self.simulation.strands().collect();
            let mut new =
                simulation(&self.groom, &strands, &settings.materials, scene, body.rest_anchor(), &[]);
            new.take_over(&self.simulation);
            self.simulation = new;
            self.materials = settings.materials;
        }
        if let Some(follow) = &mut self.follow
            && follow.set_effects(settings.effects)
        {
            self.show(body);
        }
    }

    /// Where the roots are on the posed body.
    fn pose_roots(&mut self, body: &StagedBody) {
        if self.rest_frames.is_empty() {
            return;
        }
        for (k, s) in self.simulation.strands().enumerate() {
            let root = &self.groom.roots[s as usize];
            let corners = self.triangles[k].map(|i| body.positions()[i as usize]);
            self.roots[k] = Rigid {
                translation: root.position(corners),
                rotation: (root.frame(corners) * self.rest_frames[k]).normalize(),
            };
        }
    }

    /// Puts the hair at rest on the posed body.
    pub(super) fn place(&mut self, body: &StagedBody) {
        self.pose_roots(body);
        self.simulation.place(body.anchor(), &self.roots);
        self.show(body);
    }

    /// Plays one frame of `dt` [s] of the simulated strands.
    pub(super) fn step(&mut self, dt: f32, body: &StagedBody, air: Air, report: &mut FrameReport) {
        let began = Instant::now();
        self.pose_roots(body);
        self.simulation.set_charged(body.charged().iter().copied());
        let step = self.simulation.step(&Drive {
            dt,
            anchor: body.anchor(),
            roots: &self.roots,
            obstacles: body.obstacles(),
            air,
        });
        report.step.substeps = report.step.substeps.max(step.substeps);
        report.step.reset_strands += step.reset_strands;
        report.simulate += began.elapsed();
    }

    /// Brings the points of all strands up to date, but for follow hairs that are left to who draws them.
    pub(super) fn show(&mut self, body: &StagedBody) {
        let Some(follow) = &mut self.follow else {
            self.simulation.write_points(&mut self.points);
            return;
        };
        self.simulation.write_points(&mut self.guide_points);
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
    fn followed<'a>(&'a self, body: &'a StagedBody) -> Option<Followed<'a>> {
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

    /// See [`Simulation::take`].
    pub(super) fn take(&mut self, tool: Tool, pose: Rigid) -> ToolId {
        self.simulation.take(tool, pose)
    }

    /// See [`Simulation::carry`].
    pub(super) fn carry(&mut self, id: ToolId, pose: Rigid) {
        self.simulation.carry(id, pose);
    }

    /// See [`Simulation::let_go`].
    pub(super) fn let_go(&mut self, id: ToolId) {
        self.simulation.let_go(id);
    }

    /// See [`Simulation::let_go_all`].
    pub(super) fn let_go_all(&mut self) {
        self.simulation.let_go_all();
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
        let strands: Vec<usize> = self.simulation.strands().map(|s| s as usize).collect();
        let mut offsets = vec![0];
        for s in &strands {
            offsets.push(offsets[offsets.len() - 1] + self.groom.range(*s).len() as u32);
        }
        let mut of_guides = vec![0.0; self.simulation.point_count()];
        let pieces = split_by(&mut of_guides, &offsets).into_par_iter().zip(&strands).enumerate();
        pieces.with_min_len(16).for_each(|(k, (piece, s))| of_guide(k, *s, piece));
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

    pub(super) fn simulation(&self) -> &Simulation {
        &self.simulation
    }
}

/// The `simulated` strands of a groom at rest, where the anchor is at `anchor` and colliders are as `obstacles`.
fn simulation(
    groom: &Arc<Groom>,
    simulated: &[u32],
    materials: &[Material],
    scene: &Scene,
    anchor: Rigid,
    obstacles: &[ObstaclePose],
) -> Simulation {
    let mut simulation =
        Simulation::new(groom.clone(), simulated, materials, scene.solver, scene.gravity, anchor, obstacles);
    simulation.set_volume(&scene.volume);
    simulation.set_shelter(&scene.shelter);
    simulation.set_neighbours(&scene.neighbours);
    simulation
}

/// Which strands are simulated, and what the others follow (`None`: there are no others).
fn roles(groom: &Groom, guides: Guides) -> (Vec<u32>, Option<Vec<crate::groom::GuideWeights>>) {
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
