//! The posed body: joints, skin, and the cuts of its clip.

use super::PosedBody;
use crate::Scene;
use glam::{Affine3A, Vec3};
use hairspring::{
    body::{Body, Cuts, Mesh},
    math::RigidTransform,
};

/// Current pose of the scene's body.
pub(super) struct BodyPose {
    /// Model-space matrix of each joint, at rest and currently.
    rest: Vec<Affine3A>,
    world: Vec<Affine3A>,
    /// Whether separate props are at a different pose initially than at rest.
    apart: bool,
    /// Rigid motion of the whole body in addition to its clip.
    moved: RigidTransform,
    /// The joint that most of the head moves with. Hair and fields are stored in its space.
    anchor: usize,
    /// Cuts of the clip.
    cuts: Cuts,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
}

impl BodyPose {
    /// Creates the pose in which hair is built on the body: at rest, with separate props where they are
    /// initially.
    pub(super) fn new(scene: &Scene) -> Self {
        let rest = scene.body.as_ref().map(|b| b.world(&b.rest_pose())).unwrap_or_default();
        let anchor = scene.body.as_ref().map_or(0, |b| anchor_joint(b, scene));
        let mut pose = Self {
            apart: false,
            world: Vec::new(),
            rest,
            moved: RigidTransform::default(),
            anchor,
            cuts: Cuts::default(),
            positions: Vec::new(),
            normals: Vec::new(),
        };
        pose.world = pose.first_world(scene);
        pose.apart = pose.world != pose.rest;
        if let Some(body) = &scene.body {
            body.skinned(&pose.world, &mut pose.positions, &mut pose.normals);
        }
        pose.find_cuts(scene);
        pose
    }

    /// Finds the cuts of the scene's clip with the current settings.
    pub(super) fn find_cuts(&mut self, scene: &Scene) {
        if let (Some(body), Some(clip)) = (&scene.body, &scene.clip) {
            self.cuts = Cuts::new(body, clip, self.anchor, scene.solver.teleport_distance);
        }
    }

    /// Moves the whole body rigidly, in addition to its clip, from the next pose on.
    pub(super) fn move_to(&mut self, by: RigidTransform) {
        self.moved = by;
    }

    /// Returns the rigid motion of the whole body in addition to its clip.
    pub(super) fn moved(&self) -> RigidTransform {
        self.moved
    }

    /// Poses the body for `time` [s].
    pub(super) fn set(&mut self, scene: &Scene, time: f64) {
        match self.at(scene, time) {
            Some((world, _)) => self.world = world,
            None => self.world.clone_from(&self.rest),
        }
        if self.moved != RigidTransform::default() {
            let moved = Affine3A::from_rotation_translation(self.moved.rotation, self.moved.translation);
            self.world.iter_mut().for_each(|joint| *joint = moved * *joint);
        }
        if let Some(body) = &scene.body {
            body.skinned(&self.world, &mut self.positions, &mut self.normals);
        }
    }

    /// Returns the joints and the anchor at `time` [s] by the clip alone; `None` without a clip.
    pub(super) fn at(&self, scene: &Scene, time: f64) -> Option<(Vec<Affine3A>, RigidTransform)> {
        let (body, clip) = (scene.body.as_ref()?, scene.clip.as_ref()?);
        let world = body.world(&self.cuts.sample(clip, time));
        let anchor = RigidTransform::from_affine(&world[self.anchor]);
        Some((world, anchor))
    }

    /// Returns the joints in the pose in which hair is built on the body; empty without a body.
    pub(super) fn first_world(&self, scene: &Scene) -> Vec<Affine3A> {
        scene.body.as_ref().map(|body| first_pose(body, self.anchor, scene)).unwrap_or_default()
    }

    /// Returns the rigid motion of each joint that has a cut between two times [s].
    pub(super) fn cut(&self, scene: &Scene, times: (f64, f64)) -> Vec<Option<RigidTransform>> {
        let (Some(body), Some(clip)) = (&scene.body, &scene.clip) else { return Vec::new() };
        let moved = self.moved;
        let in_world = |by: RigidTransform| moved.after(&by.after(&moved.inverse()));
        self.cuts.motion_between(body, clip, times).into_iter().map(|by| by.map(in_world)).collect()
    }

    /// Returns whether the body has no joints, because there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// Returns the motion since rest of what `joint` carries; the identity without a joint.
    pub(super) fn carried(&self, joint: Option<usize>) -> RigidTransform {
        let of = |j: usize| RigidTransform::from_affine(&(self.world[j] * self.rest[j].inverse()));
        joint.map_or(RigidTransform::default(), of)
    }

    /// Returns whether separate props are at a different pose initially than at rest.
    pub(super) fn stands_apart(&self) -> bool {
        self.apart
    }

    /// Returns the corners of a triangle of the skin in the initial pose. Must be called before the body
    /// moves.
    pub(super) fn first_corners(&self, mesh: &Mesh, triangle: usize) -> [Vec3; 3] {
        match self.apart {
            true => mesh.triangles[triangle].map(|i| self.positions[i as usize]),
            false => mesh.corners(triangle),
        }
    }

    /// Returns the joint that roots move with.
    pub(super) fn anchor_joint(&self) -> usize {
        self.anchor
    }

    /// Returns the frame that roots move with.
    pub(super) fn anchor(&self) -> RigidTransform {
        self.world.get(self.anchor).map_or(RigidTransform::default(), RigidTransform::from_affine)
    }

    /// Returns the anchor at rest.
    pub(super) fn rest_anchor(&self) -> RigidTransform {
        self.rest.get(self.anchor).map_or(RigidTransform::default(), RigidTransform::from_affine)
    }

    /// Returns the current joints.
    pub(super) fn world(&self) -> &[Affine3A] {
        &self.world
    }

    /// Returns the current vertex positions [m]; empty without a body.
    pub(super) fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Returns what a renderer draws.
    pub(super) fn posed<'a>(&'a self, scene: &'a Scene) -> Option<PosedBody<'a>> {
        let mesh = &scene.body.as_ref()?.mesh;
        Some(PosedBody { mesh, positions: &self.positions, normals: &self.normals })
    }
}

/// Returns the model-space matrix of each joint in the initial pose. Joints connected with `anchor` are at
/// rest. All others are separate props, which are placed where the clip begins, because at rest they may
/// intersect.
fn first_pose(body: &Body, anchor: usize, scene: &Scene) -> Vec<Affine3A> {
    let mut pose = body.rest_pose();
    let top = |mut joint: usize| {
        while let Some(parent) = body.joints[joint].parent {
            joint = parent as usize;
        }
        joint
    };
    if let Some(clip) = &scene.clip {
        let begin = clip.sample(0.0);
        let others = (0..pose.len()).filter(|joint| top(*joint) != top(anchor));
        others.for_each(|joint| pose[joint] = begin[joint]);
    }
    body.world(&pose)
}

/// Returns the joint that carries most of the vertices near the roots; joint 0 for a rigid body.
fn anchor_joint(body: &Body, scene: &Scene) -> usize {
    let Some(skin) = &body.skin else { return 0 };
    let mut weight = vec![0.0; body.joints.len()];
    for groom in &scene.grooms {
        for root in &groom.groom.roots {
            for v in body.mesh.triangles[root.triangle as usize] {
                for (j, w) in skin.joints[v as usize].iter().zip(skin.weights[v as usize]) {
                    weight[*j as usize] += w;
                }
            }
        }
    }
    (0..weight.len()).max_by(|a, b| weight[*a].total_cmp(&weight[*b]).then(b.cmp(a))).unwrap_or(0)
}
