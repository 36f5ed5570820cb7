//! The posed body: joints, skin or vertex cache, and the cuts of its clip.

use super::PosedBody;
use crate::{Scene, SceneGroom, VertexCache};
use glam::{Affine3A, Vec3};
use hairspring::{
    body::{Body, Cuts, Mesh},
    math::RigidTransform,
};

/// The pose of a body at one time.
#[derive(Clone, Default)]
pub(super) struct Pose {
    /// Model-space matrix of each joint.
    pub(super) world: Vec<Affine3A>,
    /// The frame that roots move with, in whose space colliders of deforming meshes are.
    pub(super) anchor: RigidTransform,
    /// Vertices of a body without a skin that deforms, in the space of joint 0 [m].
    pub(super) shape: Option<Vec<Vec3>>,
}

impl Pose {
    /// Returns the function that maps a vertex of `body` to its position [m].
    pub(super) fn vertices<'a>(&'a self, body: &'a Body) -> impl Fn(usize) -> Vec3 + 'a {
        let matrices = body.skin.as_ref().map(|skin| skin.matrices(&self.world));
        let first = self.world.first().copied().unwrap_or(Affine3A::IDENTITY);
        move |v| match (&body.skin, &matrices, &self.shape) {
            (Some(skin), Some(matrices), _) => skin.place(v, body.mesh.positions[v], matrices),
            (_, _, Some(shape)) => first.transform_point3(shape[v]),
            _ => first.transform_point3(body.mesh.positions[v]),
        }
    }

    /// Returns whether the vertices of `body` move relative to each other.
    pub(super) fn deforms(&self, body: &Body) -> bool {
        body.skin.is_some() || self.shape.is_some()
    }
}

/// Current pose of the scene's body.
pub(super) struct BodyPose {
    /// Model-space matrix of each joint at rest.
    rest: Vec<Affine3A>,
    current: Pose,
    /// Deformation of a body without a skin, in the space of joint 0.
    cache: Option<VertexCache>,
    /// Whether separate props are at a different pose initially than at rest.
    apart: bool,
    /// Rigid motion of the whole body in addition to its clip.
    moved: RigidTransform,
    /// The joint that most of the head moves with. Hair and fields are stored in its space.
    anchor: usize,
    /// Cuts of the clip.
    cuts: Cuts,
    /// The mesh in the current pose.
    posed: Mesh,
}

impl BodyPose {
    /// Creates the pose in which hair is built on the body: at rest, with separate props where they are
    /// initially.
    pub(super) fn new(scene: &Scene, cache: Option<VertexCache>) -> Self {
        let rest = scene.body.as_ref().map(|b| b.world(&b.rest_pose())).unwrap_or_default();
        let anchor = scene.body.as_ref().map_or(0, |b| anchor_joint(b, &scene.grooms));
        let mut pose = Self {
            apart: false,
            current: Pose::default(),
            rest,
            cache,
            moved: RigidTransform::default(),
            anchor,
            cuts: Cuts::default(),
            posed: scene.body.as_ref().map_or_else(Mesh::default, |body| body.mesh.clone()),
        };
        pose.current.world = pose.first_world(scene);
        pose.apart = pose.current.world != pose.rest;
        pose.current.anchor = pose.anchor_of(&pose.current.world);
        // A body with a vertex cache is at rest in its first pose.
        pose.place_vertices(scene);
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
        self.current =
            self.at(scene, time).unwrap_or_else(|| Pose { world: self.rest.clone(), ..Pose::default() });
        if self.moved != RigidTransform::default() {
            let moved = Affine3A::from_rotation_translation(self.moved.rotation, self.moved.translation);
            self.current.world.iter_mut().for_each(|joint| *joint = moved * *joint);
        }
        self.current.anchor = self.anchor_of(&self.current.world);
        self.place_vertices(scene);
    }

    /// Updates the posed mesh.
    fn place_vertices(&mut self, scene: &Scene) {
        let Some(body) = &scene.body else { return };
        let Mesh { positions, normals, .. } = &mut self.posed;
        if self.current.shape.is_none() {
            body.skinned(&self.current.world, positions, normals);
            return;
        }
        let place = self.current.vertices(body);
        positions.iter_mut().enumerate().for_each(|(v, p)| *p = place(v));
        self.posed.compute_normals();
    }

    /// Returns the pose at `time` [s] by the clip alone; `None` without a clip.
    pub(super) fn at(&self, scene: &Scene, time: f64) -> Option<Pose> {
        let (body, clip) = (scene.body.as_ref()?, scene.clip.as_ref()?);
        let world = body.world(&self.cuts.sample(clip, time));
        let shape = self.cache.as_ref().map(|cache| {
            let (frame, t) = cache.place(time);
            // The shape changes at a cut at once, as the joint does.
            let next = [frame, frame + 1].map(|frame| frame as f64 / cache.rate);
            let cut = self.cuts.motion_between(body, clip, next.into()).iter().any(Option::is_some);
            cache.at((frame, if cut { 0.0 } else { t }))
        });
        Some(Pose { anchor: self.anchor_of(&world), world, shape })
    }

    /// Returns the frame that roots move with if the joints are at `world`.
    fn anchor_of(&self, world: &[Affine3A]) -> RigidTransform {
        world.get(self.anchor).map_or(RigidTransform::default(), RigidTransform::from_affine)
    }

    /// Returns the joints in the pose in which hair is built on the body; empty without a body.
    pub(super) fn first_world(&self, scene: &Scene) -> Vec<Affine3A> {
        scene.body.as_ref().map(|body| first_pose(body, self.anchor, scene)).unwrap_or_default()
    }

    /// Returns the rigid motion of each joint that has a cut between two times [s].
    pub(super) fn cut(&self, scene: &Scene, times: (f64, f64)) -> Vec<Option<RigidTransform>> {
        let (Some(body), Some(clip)) = (&scene.body, &scene.clip) else { return Vec::new() };
        let moved = self.moved;
        let in_world = |by: RigidTransform| moved * (by * moved.inverse());
        self.cuts.motion_between(body, clip, times).into_iter().map(|by| by.map(in_world)).collect()
    }

    /// Returns whether the body has no joints, because there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// Returns the motion since rest of what `joint` carries; the identity without a joint.
    pub(super) fn carried(&self, joint: Option<usize>) -> RigidTransform {
        let of = |j: usize| RigidTransform::from_affine(&(self.current.world[j] * self.rest[j].inverse()));
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
            true => mesh.triangles[triangle].map(|i| self.posed.positions[i as usize]),
            false => mesh.corners(triangle),
        }
    }

    /// Returns the joint that roots move with.
    pub(super) fn anchor_joint(&self) -> usize {
        self.anchor
    }

    /// Returns the frame that roots move with.
    pub(super) fn anchor(&self) -> RigidTransform {
        self.current.anchor
    }

    /// Returns the anchor at rest.
    pub(super) fn rest_anchor(&self) -> RigidTransform {
        self.anchor_of(&self.rest)
    }

    /// Returns the current pose.
    pub(super) fn current(&self) -> &Pose {
        &self.current
    }

    /// Returns whether the scene's body deforms by a vertex cache.
    pub(super) fn has_cache(&self) -> bool {
        self.cache.is_some()
    }

    /// Returns the current vertex positions [m]; empty without a body.
    pub(super) fn positions(&self) -> &[Vec3] {
        &self.posed.positions
    }

    /// Returns what a renderer draws.
    pub(super) fn posed<'a>(&'a self, scene: &'a Scene) -> Option<PosedBody<'a>> {
        let mesh = &scene.body.as_ref()?.mesh;
        Some(PosedBody { mesh, positions: &self.posed.positions, normals: &self.posed.normals })
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

/// Returns the joint that carries most of the vertices near the roots of `grooms`; joint 0 for a rigid body.
pub(super) fn anchor_joint(body: &Body, grooms: &[SceneGroom]) -> usize {
    let Some(skin) = &body.skin else { return 0 };
    let mut weight = vec![0.0; body.joints.len()];
    for groom in grooms {
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

/// Takes the vertex cache out of the scene. Its rigid motion, that of the skin under the roots, becomes the scene's clip.
pub(super) fn take_vertex_cache(scene: &mut Scene) -> Option<VertexCache> {
    let mut cache = scene.vertex_cache.take()?;
    let mesh = &scene.body.as_ref()?.mesh;
    let roots = scene.grooms.iter().flat_map(|g| &g.groom.roots);
    let mut vertices: Vec<u32> = roots.flat_map(|root| mesh.triangles[root.triangle as usize]).collect();
    vertices.sort_unstable();
    vertices.dedup();
    // A few vertices in a plane still define a motion, but none at all do not.
    if vertices.is_empty() {
        vertices = (0..mesh.positions.len() as u32).collect();
    }
    scene.clip = Some(cache.split_rigid_motion(&mesh.positions, &vertices));
    Some(cache)
}
