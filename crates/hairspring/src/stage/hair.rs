//! One groom of the scene: its simulated strands and the hairs that follow them.

use super::{Strands, body::StagedBody};
use crate::{
    collide::Rigid,
    follow::{Follow, assign_guides, choose_guides},
    groom::Groom,
    neighbours::Member,
    scene::{Guides, HairLook, Scene, SceneGroom},
    simulation::{Air, Drive, Simulation, StepReport},
};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Guides of a groom that names none and a scene that asks for no number.
const DEFAULT_GUIDES: usize = 2_000;

pub(super) struct StagedHair {
    groom: Arc<Groom>,
    look: HairLook,
    simulation: Simulation,
    /// `None` where every strand is simulated.
    follow: Option<Follow>,
    /// Orientation of each simulated root's triangle at rest, inverted; empty while the roots are bound to nothing.
    rest_frames: Vec<Quat>,
    triangles: Vec<[u32; 3]>,
    roots: Vec<Rigid>,
    turns: Vec<Quat>,
    guide_points: Vec<Vec3>,
    points: Vec<Vec3>,
}

impl StagedHair {
    pub(super) fn new(groom: SceneGroom, scene: &Scene, body: &StagedBody) -> Self {
        let SceneGroom { groom, materials, guides, effects, look } = groom;
        let groom = Arc::new(groom);
        let (simulated, weights) = roles(&groom, guides);
        let obstacles = body.poses();
        let mut simulation = Simulation::new(
            groom.clone(),
            &simulated,
            &materials,
            scene.solver,
            scene.gravity,
            body.anchor(),
            &obstacles,
        );
        simulation.set_volume(&scene.volume);
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
            look,
            simulation,
            follow,
            rest_frames,
            triangles,
            roots,
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

    /// Its part in a frame of `dt` [s].
    pub(super) fn member<'a>(&'a mut self, dt: f32, body: &'a StagedBody, air: Air) -> Member<'a> {
        self.pose_roots(body);
        let drive = Drive { dt, anchor: body.anchor(), roots: &self.roots, obstacles: body.obstacles(), air };
        Member { simulation: &mut self.simulation, drive, report: StepReport::default() }
    }

    /// Brings the points of all strands up to date.
    pub(super) fn show(&mut self, body: &StagedBody) {
        let Some(follow) = &mut self.follow else {
            self.simulation.write_points(&mut self.points);
            return;
        };
        self.simulation.write_points(&mut self.guide_points);
        for (turn, root) in self.turns.iter_mut().zip(&self.roots) {
            *turn = root.rotation;
        }
        follow.place(&self.guide_points, &self.turns, &body.poses(), &mut self.points);
    }

    pub(super) fn strands(&self) -> Strands<'_> {
        Strands { points: &self.points, groom: &self.groom, look: &self.look }
    }

    pub(super) fn simulation(&self) -> &Simulation {
        &self.simulation
    }
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
