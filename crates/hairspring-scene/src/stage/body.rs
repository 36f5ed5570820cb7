//! The colliders of a scene, and the body that moves them.

use super::{
    body_pose::{BodyPose, Pose},
    charged::StagedCharged,
    joints::Joints,
    reach::Reach,
    rigid_parts,
    surface::{Surface, SurfaceKind},
    thickness::ThinMesh,
};
use crate::{Collider, InitialContact, Scene, Shape, VertexCache};
use glam::Vec3;
use hairspring::{
    body::Body,
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

/// The posed body of a scene, and its colliders.
pub(super) struct StagedBody {
    pose: BodyPose,
    /// Colliders in this order: those made of meshes, the scene's colliders, its charged bodies, the user's
    /// colliders.
    colliders: Vec<MovingCollider>,
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
    /// Colliders that push hair out before the scene begins.
    initial_pushes: Vec<InitialPush>,
    /// Number of user colliders, and their pose in the next step.
    pushed: (usize, RigidTransform),
}

/// A collider that pushes hair out before the scene begins.
pub(super) struct InitialPush {
    /// Its index among the colliders.
    pub(super) collider: usize,
    /// Its shape; `None` for a sheet.
    pub(super) shape: Option<Shape>,
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
    collider: usize,
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

impl StagedBody {
    /// Creates the body in the pose in which hair is built on it. Attaches colliders and charged bodies to the
    /// joints in `joints`.
    pub(super) fn new(scene: &Scene, joints: &Joints, cache: Option<VertexCache>) -> Self {
        let mut staged = Self {
            pose: BodyPose::new(scene, cache),
            colliders: Vec::new(),
            carriers: Vec::new(),
            meshes: 0,
            surfaces: Vec::new(),
            reach: Reach::new(scene),
            thin: None,
            charged: StagedCharged::default(),
            initial_pushes: Vec::new(),
            pushed: (0, RigidTransform::default()),
        };
        staged.add_surface(scene);
        for (k, sheet) in scene.sheets.iter().enumerate() {
            if sheet.initial == InitialContact::Push {
                staged.initial_pushes.push(InitialPush { collider: staged.colliders.len(), shape: None });
            }
            staged.add_mesh(scene, Mesh::Sheet(k), SurfaceKind::Sheet(sheet.thickness));
        }
        staged.meshes = staged.colliders.len();
        staged.rebuild_surfaces(scene, None);
        staged.add_colliders(&scene.colliders, joints);
        staged.add_charged(scene, joints);
        staged.repose(scene, 0.0);
        staged.stand_still();
        staged
    }

    /// Sets the start pose of all colliders to their end pose, so that they have no velocity.
    fn stand_still(&mut self) {
        self.charged.rest();
        self.colliders.iter_mut().for_each(|collider| collider.start = collider.end);
    }

    fn add(&mut self, shape: ColliderShape, carrier: Carrier) {
        self.colliders.push(MovingCollider::at_rest(shape, RigidTransform::default()));
        self.carriers.push(carrier);
    }

    /// Adds the scene's colliders. Must be called after the mesh colliders have been added.
    fn add_colliders(&mut self, colliders: &[Collider], joints: &Joints) {
        for (collider, joint) in colliders.iter().zip(&joints.colliders) {
            let carrier = joint.map_or(self.carrier(self.pose.anchor_joint()), Carrier::Joint);
            // A hull whose points span no volume is ignored.
            let Some(shape) = collider.shape.collider_shape() else { continue };
            if collider.initial == InitialContact::Push {
                let (collider, shape) = (self.colliders.len(), Some(collider.shape.clone()));
                self.initial_pushes.push(InitialPush { collider, shape });
            }
            self.add(shape, carrier);
        }
    }

    /// Adds the charged bodies. Must be called after all other colliders except the user's, because they move
    /// by themselves.
    fn add_charged(&mut self, scene: &Scene, joints: &Joints) {
        self.charged = StagedCharged::new(&scene.charged, joints.charged.clone());
        self.colliders.extend(self.charged.colliders(&scene.charged));
    }

    /// Replaces the colliders and charged bodies at `time` [s] while the scene is running. The new ones start
    /// without velocity.
    pub(super) fn update_settings(&mut self, scene: &Scene, joints: &Joints, time: f64) {
        let pushed = self.colliders.split_off(self.colliders.len() - self.pushed.0);
        self.colliders.truncate(self.meshes);
        self.carriers.truncate(self.meshes);
        self.initial_pushes.retain(|push| push.collider < self.meshes);
        self.add_colliders(&scene.colliders, joints);
        self.add_charged(scene, joints);
        self.repose(scene, time);
        self.charged.rest();
        for collider in &mut self.colliders[self.meshes..] {
            collider.start = collider.end;
        }
        self.colliders.extend(pushed);
    }

    /// See [`super::Stage::set_user_colliders`].
    pub(super) fn set_user_colliders<'a>(
        &mut self,
        shapes: impl Iterator<Item = &'a ColliderShape> + Clone,
        pose: RigidTransform,
    ) {
        let (count, first) = (shapes.clone().count(), self.colliders.len() - self.pushed.0);
        if count == self.pushed.0 {
            // The same shapes, perhaps of another size, keep their motion.
            self.colliders[first..].iter_mut().zip(shapes).for_each(|(o, shape)| o.shape.clone_from(shape));
        } else {
            self.colliders.truncate(first);
            self.colliders.extend(shapes.map(|shape| MovingCollider::at_rest(shape.clone(), pose)));
        }
        self.pushed = (count, pose);
    }

    /// Returns a joint of the body as a carrier, if the body has joints.
    fn carrier(&self, joint: usize) -> Carrier {
        if self.pose.is_empty() { Carrier::Fixed } else { Carrier::Joint(joint) }
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
        let cached = matches!(mesh, Mesh::Closed) && scene.collision.is_none() && self.pose.has_cache();
        if body.skin.is_none() && !cached {
            let within = scene.body.as_ref().and_then(|b| self.reach.bounds(&b.mesh.positions, |p| p));
            self.add(making.rigid(body, within), self.carrier(0));
            return;
        }
        let mut rest = body.clone();
        let pieces = match making {
            SurfaceKind::Field(cell) if !cached => {
                rigid_parts::take(&mut rest, self.pose.anchor_joint(), PIECE * cell)
            }
            _ => Vec::new(),
        };
        let surface = Surface::new(making, &rest);
        let rest = (!pieces.is_empty()).then_some(rest);
        let collider = self.colliders.len();
        self.surfaces.push(Deforming { surface, mesh, rest, collider });
        self.add(making.nothing(), Carrier::Anchor);
        for piece in pieces {
            self.add(making.rigid(&piece.body, None), Carrier::Joint(piece.joint));
        }
    }

    /// Rebuilds the colliders of skinned meshes, in the anchor's space. `since` is the time [s] of the pose
    /// that they moved from and the current time, or `None` if they did not move.
    fn rebuild_surfaces(&mut self, scene: &Scene, since: Option<(f64, f64)>) {
        let anchor = self.pose.anchor();
        let within = self.reach.bounds(self.pose.positions(), |p| anchor.inverse_transform_point(p));
        let parts = |Deforming { surface, mesh, rest, .. }: &Deforming| {
            let body = Deforming::body(rest, *mesh, scene);
            body.map_or(1, |body| surface.parts(body, self.pose.current(), within))
        };
        let mut poses: Vec<Pose> = Vec::new();
        let mut shares = vec![1; self.surfaces.len()];
        if let (Some((from, to)), Some(_)) = (since, &scene.clip) {
            shares = self.surfaces.iter().map(parts).collect();
            let most = shares.iter().copied().max().unwrap_or(1);
            if shares.iter().any(|share| *share != 1 && *share != most) {
                // Make each number of slices a divisor of the largest.
                shares.iter_mut().for_each(|share| *share = share.next_power_of_two());
            }
            let parts = shares.iter().copied().max().unwrap_or(1);
            // The motion of the whole body has no effect here, because the colliders are in the anchor's
            // space.
            poses.extend((1..parts).filter_map(|part| {
                let time = from + (to - from) * (part as f64 / parts as f64);
                self.pose.at(scene, time)
            }));
        }
        poses.push(self.pose.current().clone());
        for (Deforming { surface, mesh, rest, collider }, share) in self.surfaces.iter_mut().zip(shares) {
            let Some(body) = Deforming::body(rest, *mesh, scene) else { continue };
            let every = poses.len() / share;
            let poses = poses.iter().skip(every - 1).step_by(every);
            surface.update(&mut self.colliders[*collider].shape, body, poses, within, since.is_none());
        }
    }

    /// Poses the body for the time `to` [s]; `from` is the time of the last pose. The motion in between is
    /// that of the colliders in this frame. Returns the rigid motion of the hair if the clip has a cut. A cut
    /// is not a motion: colliders that it moves start the frame at their new pose.
    pub(super) fn advance(&mut self, scene: &Scene, (from, to): (f64, f64)) -> Option<RigidTransform> {
        self.stand_still();
        let cut = self.cut(scene, (from, to));
        self.pose.set(scene, to);
        // A surface that was cut has no motion in this frame.
        self.rebuild_surfaces(scene, cut.is_none().then_some((from, to)));
        self.repose(scene, to);
        cut
    }

    /// Moves colliders on joints that have a cut between two times [s] across the cut. Returns the rigid motion
    /// of the anchor.
    fn cut(&mut self, scene: &Scene, times: (f64, f64)) -> Option<RigidTransform> {
        let cut = self.pose.cut(scene, times);
        let by = |joint: usize| cut.get(joint).copied().flatten();
        let anchor = self.pose.anchor_joint();
        for (collider, carrier) in self.colliders.iter_mut().zip(&self.carriers) {
            let joint = match *carrier {
                Carrier::Fixed => None,
                Carrier::Joint(joint) => Some(joint),
                Carrier::Anchor => Some(anchor),
            };
            if let Some(by) = joint.and_then(by) {
                collider.start = by * collider.start;
            }
        }
        self.charged.cut(&scene.charged, by, &mut self.colliders[self.carriers.len()..]);
        by(anchor)
    }

    /// Poses the body for time `time` [s] without velocity.
    pub(super) fn place(&mut self, scene: &Scene, time: f64) {
        self.pose.set(scene, time);
        self.rebuild_surfaces(scene, None);
        self.repose(scene, time);
        self.stand_still();
    }

    /// Updates the poses of colliders and charged bodies from the current body pose, at `time` [s], and that
    /// of the user colliders.
    fn repose(&mut self, scene: &Scene, time: f64) {
        let anchor = self.pose.anchor();
        let Self { pose: body, colliders, carriers, charged, pushed: (count, pose), .. } = self;
        let carried = |joint: Option<usize>| body.carried(joint);
        for (collider, carrier) in colliders.iter_mut().zip(&*carriers) {
            collider.end = match *carrier {
                Carrier::Fixed => RigidTransform::default(),
                Carrier::Joint(j) => carried(Some(j)),
                Carrier::Anchor => anchor,
            };
        }
        charged.advance(&scene.charged, time, carried, &mut colliders[carriers.len()..]);
        colliders.iter_mut().rev().take(*count).for_each(|pushed| pushed.end = *pose);
    }

    /// Returns a report if parts of the collision mesh are too thin for its field.
    pub(super) fn thin(&self) -> Option<ThinMesh> {
        self.thin
    }

    /// Returns the charged bodies in the last frame.
    pub(super) fn charged(&self) -> &[ChargedBall] {
        self.charged.balls()
    }

    /// Returns the colliders with their motion in the last frame.
    pub(super) fn colliders(&self) -> &[MovingCollider] {
        &self.colliders
    }

    /// Returns the colliders listed in the scene.
    pub(super) fn scene_colliders(&self) -> &[MovingCollider] {
        &self.colliders[self.meshes..self.carriers.len()]
    }

    /// Returns the colliders that push hair out before the scene begins.
    pub(super) fn initial_pushes(&self) -> &[InitialPush] {
        &self.initial_pushes
    }

    /// Returns whether collider `k` pushes hair out before the scene begins.
    fn pushes(&self, k: usize) -> bool {
        self.initial_pushes.iter().any(|push| push.collider == k)
    }

    /// Returns the current poses of the colliders in which hair may stay as deep as it is authored. Each of the others is
    /// a point, so that all keep their index.
    pub(super) fn keeping_poses(&self) -> Vec<ColliderPose> {
        let point = ColliderShape::Sphere { center: Vec3::ZERO, radius: 0.0 };
        let mut poses = self.poses();
        for push in &self.initial_pushes {
            let point = MovingCollider::at_rest(point.clone(), RigidTransform::default());
            poses[push.collider] = point.end_pose();
        }
        poses
    }

    /// Returns the colliders of the scene's sheets and those listed in the scene, without the body's meshes: those that
    /// push hair out before the scene begins, or the others.
    pub(super) fn sheets_and_colliders(&self, pushing: bool) -> Vec<MovingCollider> {
        let sheet = |collider: &MovingCollider| matches!(collider.shape, ColliderShape::Sheet(_));
        let all = self.colliders[..self.carriers.len()].iter().enumerate();
        let own = all.filter(|(k, collider)| *k >= self.meshes || sheet(collider));
        own.filter(|(k, _)| self.pushes(*k) == pushing).map(|(_, collider)| collider.clone()).collect()
    }

    /// Returns the current poses of the colliders.
    pub(super) fn poses(&self) -> Vec<ColliderPose> {
        self.colliders.iter().map(MovingCollider::end_pose).collect()
    }

    /// Returns the posed body.
    pub(super) fn pose(&self) -> &BodyPose {
        &self.pose
    }

    /// Returns the posed body, to move it or to find its cuts again.
    pub(super) fn pose_mut(&mut self) -> &mut BodyPose {
        &mut self.pose
    }
}
