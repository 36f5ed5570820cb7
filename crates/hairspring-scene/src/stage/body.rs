//! The posed body, and the colliders.

use super::{
    PosedBody,
    charged::StagedCharged,
    joints::Joints,
    rigid_parts,
    surface::{Surface, SurfaceKind},
    thickness::ThinMesh,
};
use crate::{Collider, Scene};
use glam::{Affine3A, Vec3};
use hairspring::{
    body::{self, Body, Cuts, Trs},
    collide::{ColliderPose, ColliderShape, MovingCollider},
    forces::charge::ChargedBall,
    math::RigidTransform,
};

/// Cells along the longest side of the distance field, which covers the part of the body that hair can reach:
/// 4 mm for half a meter.
const CELLS: f32 = 128.0;

/// Maximum length of a rigid part that gets its own field, in cells of the body's field [1]. Its field covers
/// all of it, wherever the hair is.
const PIECE: f32 = 2.0 * CELLS;

/// Current pose and colliders of the scene's body.
pub(super) struct StagedBody {
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
    /// Colliders in this order: those made of meshes, the scene's colliders, its charged bodies, the user's
    /// colliders.
    obstacles: Vec<MovingCollider>,
    /// What moves each collider of the first two kinds.
    carriers: Vec<Carrier>,
    /// Number of colliders of the first kind.
    meshes: usize,
    /// Deforming meshes, whose colliders are rebuilt.
    surfaces: Vec<Deforming>,
    reach: Reach,
    /// See [`StagedBody::thin`].
    thin: Option<ThinMesh>,
    charged: StagedCharged,
    /// Number of user colliders, and their pose in the next step.
    pushed: (usize, RigidTransform),
}

/// What moves a collider.
#[derive(Clone, Copy)]
enum Carrier {
    /// Nothing: it is fixed in the world.
    Fixed,
    /// A joint; the shape is in the space of the rest pose.
    Joint(usize),
    /// The anchor; the shape is in its space.
    Anchor,
}

/// A skinned mesh and the collider made of it.
struct Deforming {
    surface: Surface,
    mesh: Mesh,
    /// The remaining mesh, if rigid parts of it are separate colliders.
    rest: Option<Body>,
    obstacle: usize,
}

impl Deforming {
    /// Returns the body that the collider is made of.
    fn body<'a>(rest: &'a Option<Body>, mesh: Mesh, scene: &'a Scene) -> Option<&'a Body> {
        rest.as_ref().or_else(|| mesh.of(scene))
    }
}

/// A collision mesh of the scene.
#[derive(Clone, Copy)]
enum Mesh {
    /// The closed mesh.
    Closed,
    /// An open mesh, by its index.
    Sheet(usize),
}

impl Mesh {
    fn of(self, scene: &Scene) -> Option<&Body> {
        match self {
            Self::Closed => scene.collision.as_ref().or(scene.body.as_ref()),
            Self::Sheet(k) => scene.sheets.get(k).map(|s| &s.body),
        }
    }
}

/// The region that hair can reach: points no farther from a root than the longest strand.
struct Reach {
    /// Vertices of the skin around the roots.
    vertices: Vec<u32>,
    /// Distance from those to the farthest tip, with a margin for the strain limit [m].
    length: f32,
}

impl Reach {
    fn new(scene: &Scene) -> Self {
        let mut reach = Self { vertices: Vec::new(), length: 0.0 };
        let Some(mesh) = scene.body.as_ref().map(|b| &b.mesh) else { return reach };
        for groom in scene.grooms.iter().map(|g| &g.groom) {
            for (s, root) in groom.roots.iter().enumerate() {
                reach.vertices.extend(mesh.triangles[root.triangle as usize]);
                reach.length = reach.length.max(1.02 * groom.strand_length(s) + root.offset.length());
            }
            if groom.roots.is_empty() && groom.strand_count() > 0 {
                // Roots that are not bound to the skin may be anywhere.
                return Self { vertices: Vec::new(), length: 0.0 };
            }
        }
        reach.vertices.sort_unstable();
        reach.vertices.dedup();
        reach
    }

    /// Returns the bounding box (min, max) of the hair, in the space that `to` maps the skin's `positions`
    /// to; `None` if there is no bound.
    fn bounds(&self, positions: &[Vec3], to: impl Fn(Vec3) -> Vec3) -> Option<(Vec3, Vec3)> {
        let mut roots = self.vertices.iter().map(|v| to(positions[*v as usize]));
        let first = roots.next()?;
        let (lo, hi) = roots.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)));
        Some((lo - self.length, hi + self.length))
    }
}

impl StagedBody {
    /// Creates the body in the pose in which hair is built on it: at rest, with separate props where they are
    /// initially. Attaches colliders and charged bodies to the joints in `joints`.
    pub(super) fn new(scene: &Scene, joints: &Joints) -> Self {
        let rest = scene.body.as_ref().map(|b| b.world(&b.rest_pose())).unwrap_or_default();
        let anchor = scene.body.as_ref().map_or(0, |b| anchor_joint(b, scene));
        let world = scene.body.as_ref().map(|b| first_pose(b, anchor, scene)).unwrap_or_default();
        let mut staged = Self {
            apart: world != rest,
            world,
            rest,
            moved: RigidTransform::default(),
            anchor,
            cuts: Cuts::default(),
            positions: Vec::new(),
            normals: Vec::new(),
            obstacles: Vec::new(),
            carriers: Vec::new(),
            meshes: 0,
            surfaces: Vec::new(),
            reach: Reach::new(scene),
            thin: None,
            charged: StagedCharged::default(),
            pushed: (0, RigidTransform::default()),
        };
        if let Some(body) = &scene.body {
            body.skinned(&staged.world, &mut staged.positions, &mut staged.normals);
        }
        staged.find_cuts(scene);
        staged.add_surface(scene);
        for (k, sheet) in scene.sheets.iter().enumerate() {
            staged.add_mesh(scene, Mesh::Sheet(k), SurfaceKind::Sheet(sheet.thickness));
        }
        staged.meshes = staged.obstacles.len();
        staged.rebuild_surfaces(scene, None);
        staged.add_colliders(&scene.colliders, joints);
        staged.add_charged(scene, joints);
        staged.repose(scene, 0.0);
        staged.stand_still();
        staged
    }

    /// Finds the cuts of the scene's clip with the current settings.
    pub(super) fn find_cuts(&mut self, scene: &Scene) {
        if let (Some(body), Some(clip)) = (&scene.body, &scene.clip) {
            self.cuts = Cuts::new(body, clip, self.anchor, scene.solver.teleport_distance);
        }
    }

    /// Sets the start pose of all colliders to their end pose, so that they have no velocity.
    fn stand_still(&mut self) {
        self.charged.rest();
        self.obstacles.iter_mut().for_each(|obstacle| obstacle.start = obstacle.end);
    }

    fn add(&mut self, shape: ColliderShape, carrier: Carrier) {
        self.obstacles.push(MovingCollider::at_rest(shape, RigidTransform::default()));
        self.carriers.push(carrier);
    }

    /// Adds the scene's colliders. Must be called after the mesh colliders have been added.
    fn add_colliders(&mut self, colliders: &[Collider], joints: &Joints) {
        for (collider, joint) in colliders.iter().zip(&joints.colliders) {
            let carrier = joint.map_or(self.carrier(self.anchor), Carrier::Joint);
            // A hull whose points span no volume is ignored.
            if let Some(shape) = collider.shape.obstacle() {
                self.add(shape, carrier);
            }
        }
    }

    /// Adds the charged bodies. Must be called after all other colliders except the user's, because they move
    /// by themselves.
    fn add_charged(&mut self, scene: &Scene, joints: &Joints) {
        self.charged = StagedCharged::new(&scene.charged, joints.charged.clone());
        self.obstacles.extend(self.charged.obstacles(&scene.charged));
    }

    /// Replaces the colliders and charged bodies at `time` [s] while the scene is running. The new ones start
    /// without velocity.
    pub(super) fn update_settings(&mut self, scene: &Scene, joints: &Joints, time: f64) {
        let pushed = self.obstacles.split_off(self.obstacles.len() - self.pushed.0);
        self.obstacles.truncate(self.meshes);
        self.carriers.truncate(self.meshes);
        self.add_colliders(&scene.colliders, joints);
        self.add_charged(scene, joints);
        self.repose(scene, time);
        self.charged.rest();
        for obstacle in &mut self.obstacles[self.meshes..] {
            obstacle.start = obstacle.end;
        }
        self.obstacles.extend(pushed);
    }

    /// See [`super::Stage::move_body`].
    pub(super) fn move_to(&mut self, by: RigidTransform) {
        self.moved = by;
    }

    /// See [`super::Stage::set_user_colliders`].
    pub(super) fn set_user_colliders<'a>(
        &mut self,
        shapes: impl Iterator<Item = &'a ColliderShape> + Clone,
        pose: RigidTransform,
    ) {
        let (count, first) = (shapes.clone().count(), self.obstacles.len() - self.pushed.0);
        if count == self.pushed.0 {
            // The same shapes, perhaps of another size, keep their motion.
            self.obstacles[first..].iter_mut().zip(shapes).for_each(|(o, shape)| o.shape.clone_from(shape));
        } else {
            self.obstacles.truncate(first);
            self.obstacles.extend(shapes.map(|shape| MovingCollider::at_rest(shape.clone(), pose)));
        }
        self.pushed = (count, pose);
    }

    /// Returns a joint of the body as a carrier, if the body has joints.
    fn carrier(&self, joint: usize) -> Carrier {
        if self.rest.is_empty() { Carrier::Fixed } else { Carrier::Joint(joint) }
    }

    fn add_surface(&mut self, scene: &Scene) {
        let Some(body) =
            scene.collision.as_ref().or(scene.body.as_ref().filter(|_| scene.solver.collide_body))
        else {
            return;
        };
        let Some((lo, hi)) = body.mesh.bounds() else { return };
        let within = scene.body.as_ref().and_then(|b| self.reach.bounds(&b.mesh.positions, |p| p));
        let (lo, hi) = within.map_or((lo, hi), |(a, b)| (lo.max(a), hi.min(b)));
        // If the hair cannot reach the body, the field has only one cell.
        let cell = (hi - lo).max_element().max(1e-3) / CELLS;
        self.thin = ThinMesh::find(&body.mesh, cell, within);
        self.add_mesh(scene, Mesh::Closed, SurfaceKind::Field(cell));
    }

    /// Adds the collider of one of the scene's meshes. A rigid one is built once, in the space of the rest
    /// pose.
    fn add_mesh(&mut self, scene: &Scene, mesh: Mesh, making: SurfaceKind) {
        let Some(body) = mesh.of(scene) else { return };
        if body.skin.is_none() {
            let within = scene.body.as_ref().and_then(|b| self.reach.bounds(&b.mesh.positions, |p| p));
            self.add(making.rigid(body, within), self.carrier(0));
            return;
        }
        let mut rest = body.clone();
        let pieces = match making {
            SurfaceKind::Field(cell) => rigid_parts::take(&mut rest, self.anchor, PIECE * cell),
            SurfaceKind::Sheet(_) => Vec::new(),
        };
        let surface = Surface::new(making, &rest);
        let rest = (!pieces.is_empty()).then_some(rest);
        let obstacle = self.obstacles.len();
        self.surfaces.push(Deforming { surface, mesh, rest, obstacle });
        self.add(making.nothing(), Carrier::Anchor);
        for piece in pieces {
            self.add(making.rigid(&piece.body, None), Carrier::Joint(piece.joint));
        }
    }

    /// Rebuilds the colliders of skinned meshes, in the anchor's space. `since` is the time [s] of the pose
    /// that they moved from and the current time, or `None` if they did not move.
    fn rebuild_surfaces(&mut self, scene: &Scene, since: Option<(f64, f64)>) {
        let anchor = self.anchor();
        let within = self.reach.bounds(&self.positions, |p| anchor.inverse_point(p));
        let parts = |Deforming { surface, mesh, rest, .. }: &Deforming| {
            let body = Deforming::body(rest, *mesh, scene);
            body.map_or(1, |body| surface.parts(body, (&self.world, anchor), within))
        };
        let mut poses = Vec::new();
        let mut shares = vec![1; self.surfaces.len()];
        if let (Some((from, to)), Some(body), Some(clip)) = (since, &scene.body, &scene.clip) {
            shares = self.surfaces.iter().map(parts).collect();
            let most = shares.iter().copied().max().unwrap_or(1);
            if shares.iter().any(|share| *share != 1 && *share != most) {
                // Make each number of slices a divisor of the largest.
                shares.iter_mut().for_each(|share| *share = share.next_power_of_two());
            }
            let parts = shares.iter().copied().max().unwrap_or(1);
            // The motion of the whole body has no effect here, because the colliders are in the anchor's
            // space.
            poses.extend((1..parts).map(|part| {
                let time = from + (to - from) * (part as f64 / parts as f64);
                let world = body.world(&self.cuts.sample(clip, time));
                let anchor = RigidTransform::from_affine(&world[self.anchor]);
                (world, anchor)
            }));
        }
        poses.push((self.world.clone(), anchor));
        for (Deforming { surface, mesh, rest, obstacle }, share) in self.surfaces.iter_mut().zip(shares) {
            let Some(body) = Deforming::body(rest, *mesh, scene) else { continue };
            let every = poses.len() / share;
            let poses = poses.iter().skip(every - 1).step_by(every);
            surface.update(&mut self.obstacles[*obstacle].shape, body, poses, within, since.is_none());
        }
    }

    /// Poses the body for the time `to` [s]; `from` is the time of the last pose. The motion in between is
    /// that of the colliders in this frame. Returns the rigid motion of the hair if the clip has a cut. A cut
    /// is not a motion: colliders that it moves start the frame at their new pose.
    pub(super) fn advance(&mut self, scene: &Scene, (from, to): (f64, f64)) -> Option<RigidTransform> {
        self.stand_still();
        let cut = self.cut(scene, (from, to));
        self.pose(scene, to);
        // A surface that was cut has no motion in this frame.
        self.rebuild_surfaces(scene, cut.is_none().then_some((from, to)));
        self.repose(scene, to);
        cut
    }

    /// Moves colliders on joints that have a cut between the times `from` and `to` [s] across the cut.
    /// Returns the rigid motion of the anchor.
    fn cut(&mut self, scene: &Scene, times: (f64, f64)) -> Option<RigidTransform> {
        let (Some(body), Some(clip)) = (&scene.body, &scene.clip) else { return None };
        let cut = self.cuts.between(body, clip, times);
        let moved = self.moved;
        let by = |joint: usize| {
            let by = cut.get(joint).copied().flatten()?;
            Some(moved.after(&by.after(&moved.inverse())))
        };
        for (obstacle, carrier) in self.obstacles.iter_mut().zip(&self.carriers) {
            let joint = match *carrier {
                Carrier::Fixed => None,
                Carrier::Joint(joint) => Some(joint),
                Carrier::Anchor => Some(self.anchor),
            };
            if let Some(by) = joint.and_then(by) {
                obstacle.start = by.after(&obstacle.start);
            }
        }
        self.charged.cut(&scene.charged, by, &mut self.obstacles[self.carriers.len()..]);
        by(self.anchor)
    }

    /// Poses the body for time `time` [s] without velocity.
    pub(super) fn place(&mut self, scene: &Scene, time: f64) {
        self.moved = RigidTransform::default();
        self.pose(scene, time);
        self.rebuild_surfaces(scene, None);
        self.repose(scene, time);
        self.stand_still();
    }

    fn pose(&mut self, scene: &Scene, time: f64) {
        if let (Some(body), Some(clip)) = (&scene.body, &scene.clip) {
            let pose: Vec<Trs> = self.cuts.sample(clip, time);
            self.world = body.world(&pose);
        } else {
            self.world.clone_from(&self.rest);
        }
        if self.moved != RigidTransform::default() {
            let moved = Affine3A::from_rotation_translation(self.moved.rotation, self.moved.translation);
            self.world.iter_mut().for_each(|joint| *joint = moved * *joint);
        }
        if let Some(body) = &scene.body {
            body.skinned(&self.world, &mut self.positions, &mut self.normals);
        }
    }

    /// Updates the poses of colliders and charged bodies from the current body pose, at `time` [s], and that
    /// of the user colliders.
    fn repose(&mut self, scene: &Scene, time: f64) {
        let anchor = self.anchor();
        let Self { world, rest, obstacles, carriers, charged, pushed: (count, pose), .. } = self;
        let carried = |joint: Option<usize>| carried(world, rest, joint);
        for (obstacle, carrier) in obstacles.iter_mut().zip(&*carriers) {
            obstacle.end = match *carrier {
                Carrier::Fixed => RigidTransform::default(),
                Carrier::Joint(j) => carried(Some(j)),
                Carrier::Anchor => anchor,
            };
        }
        charged.advance(&scene.charged, time, carried, &mut obstacles[carriers.len()..]);
        obstacles.iter_mut().rev().take(*count).for_each(|pushed| pushed.end = *pose);
    }

    /// Returns the motion since rest of what `joint` carries; the identity without a joint.
    pub(super) fn carried(&self, joint: Option<usize>) -> RigidTransform {
        carried(&self.world, &self.rest, joint)
    }

    /// Returns a report if parts of the collision mesh are too thin for its field.
    pub(super) fn thin(&self) -> Option<ThinMesh> {
        self.thin
    }

    /// Returns the charged bodies in the last frame.
    pub(super) fn charged(&self) -> &[ChargedBall] {
        self.charged.balls()
    }

    /// Returns whether separate props are at a different pose initially than at rest.
    pub(super) fn stands_apart(&self) -> bool {
        self.apart
    }

    /// Returns the corners of a triangle of the skin in the initial pose. Must be called before the body
    /// moves.
    pub(super) fn first_corners(&self, mesh: &body::Mesh, triangle: usize) -> [Vec3; 3] {
        match self.apart {
            true => mesh.triangles[triangle].map(|i| self.positions[i as usize]),
            false => mesh.corners(triangle),
        }
    }

    /// Returns the frame that roots move with.
    pub(super) fn anchor(&self) -> RigidTransform {
        self.world.get(self.anchor).map_or(RigidTransform::default(), RigidTransform::from_affine)
    }

    /// Returns the anchor at rest.
    pub(super) fn rest_anchor(&self) -> RigidTransform {
        self.rest.get(self.anchor).map_or(RigidTransform::default(), RigidTransform::from_affine)
    }

    /// Returns the colliders with their motion in the last frame.
    pub(super) fn obstacles(&self) -> &[MovingCollider] {
        &self.obstacles
    }

    /// Returns the colliders listed in the scene.
    pub(super) fn colliders(&self) -> &[MovingCollider] {
        &self.obstacles[self.meshes..self.carriers.len()]
    }

    /// Returns the current poses of the colliders.
    pub(super) fn poses(&self) -> Vec<ColliderPose> {
        self.obstacles.iter().map(MovingCollider::now).collect()
    }

    /// Returns the current vertex positions [m]; empty without a body.
    pub(super) fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    pub(super) fn posed<'a>(&'a self, scene: &'a Scene) -> Option<PosedBody<'a>> {
        let mesh = &scene.body.as_ref()?.mesh;
        Some(PosedBody { mesh, positions: &self.positions, normals: &self.normals })
    }
}

/// Returns the motion since `rest` of what `joint` carries, with joints currently at `world`; the identity
/// without a joint.
fn carried(world: &[Affine3A], rest: &[Affine3A], joint: Option<usize>) -> RigidTransform {
    joint.map_or(RigidTransform::default(), |j| RigidTransform::from_affine(&(world[j] * rest[j].inverse())))
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
