//! A running scene: in every frame, the body is posed, the guides are simulated, and the follow hairs are
//! placed.

mod body;
mod body_pose;
mod charged;
mod check;
mod clock;
mod fast_surface;
mod figures;
mod forces;
mod hair;
mod initial_push;
mod join_grooms;
mod joints;
mod manipulators;
mod notes;
mod preroll;
mod reach;
mod rehearsal;
mod rigid_parts;
mod starts_inside;
mod state;
mod subject;
mod subject_path;
mod surface;
mod thickness;
mod update_settings;
mod values;
mod wind;

pub use check::StageError;
pub use clock::FrameRate;
pub use starts_inside::StartsInside;
pub use state::StageState;
pub use subject::Subject;
pub use subject_path::SubjectPath;
pub use thickness::ThinMesh;
pub use values::{Picked, StrandFigures, Value};

use crate::{HairLook, Scene};
use body::StagedBody;
use check::{check, check_anchor, check_motion};
use clock::Clock;
use glam::Vec3;
use hair::StagedHair;
use hairspring::{
    air::Air,
    collide::{ColliderShape, MovingCollider},
    follow::HairInterpolation,
    forces::Manipulator,
    groom::{Groom, bind_roots},
    math::RigidTransform,
    simulation::{ManipulatorId, Simulation, StepInput, StepReport},
};
use joints::Joints;
use manipulators::StagedHands;
use std::time::{Duration, Instant};
use wind::StagedWind;

/// Results and timings of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameReport {
    /// Report of the simulated strands.
    pub step: StepReport,
    /// Time to pose the body and rebuild its colliders.
    pub body: Duration,
    /// Time to simulate the strands.
    pub simulate: Duration,
    /// Time to place the follow hairs.
    pub follow: Duration,
}

/// One groom in its current state, for drawing or writing.
#[derive(Clone, Copy)]
pub struct Strands<'a> {
    /// Points of all strands [m]. If `follow` is present, those of follow hairs are as they were last placed
    /// here.
    pub points: &'a [Vec3],
    /// The groom that they belong to: offsets, radii, colors.
    pub groom: &'a Groom,
    /// Color and shading.
    pub look: &'a HairLook,
    /// Data for placing its follow hairs, if the renderer interpolates them
    /// ([`Stage::set_external_interpolation`]).
    pub follow: Option<HairInterpolation<'a>>,
}

/// The body in its current pose, for drawing.
#[derive(Clone, Copy)]
pub struct PosedBody<'a> {
    /// Triangles and parts.
    pub mesh: &'a hairspring::body::Mesh,
    /// Vertex positions [m].
    pub positions: &'a [Vec3],
    /// Unit vertex normals.
    pub normals: &'a [Vec3],
}

/// A running scene. The settings are those of the scene; the state is the pose, the strands and the time.
pub struct Stage {
    scene: Scene,
    body: StagedBody,
    wind: StagedWind,
    hair: Vec<StagedHair>,
    /// The simulated strands of all grooms, groom after groom.
    simulation: Simulation,
    /// The roots of the simulated strands.
    roots: Vec<RigidTransform>,
    hands: StagedHands,
    clock: Clock,
    /// See [`Stage::cut`].
    cut: bool,
}

impl Stage {
    /// Sets the scene up at time 0: the body is in the first pose of its clip, with the hair at rest on it.
    /// Roots without a binding are bound to the nearest point of the body. With `solver.preroll`, or a collider
    /// that pushes hair out ([`crate::InitialContact::Push`]), this includes the pre-roll, which takes as long as
    /// simulating that much of the scene.
    ///
    /// # Errors
    /// If a setting is out of range, a joint does not exist, or hair is too far from the origin: see [`StageError`].
    pub fn new(scene: Scene) -> Result<Self, StageError> {
        Self::with_preroll_progress(scene, &mut |_, _| {})
    }

    /// Like [`Stage::new`]. Calls `progress` when the pre-roll begins and after each of its frames, with the number of
    /// finished frames and of all; never without a pre-roll.
    ///
    /// # Errors
    /// See [`Stage::new`].
    pub fn with_preroll_progress(
        mut scene: Scene,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, StageError> {
        check(&scene)?;
        if let Some(body) = &scene.body {
            scene.grooms.iter_mut().for_each(|g| bind_roots(&mut g.groom, &body.mesh));
        }
        let joints = Joints::new(&scene, scene.body.as_ref())?;
        let cache = body_pose::take_vertex_cache(&mut scene);
        check_anchor(&scene)?;
        check_motion(&scene)?;
        let body = StagedBody::new(&scene, &joints, cache);
        let grooms = std::mem::take(&mut scene.grooms);
        let mut hair: Vec<StagedHair> = Vec::with_capacity(grooms.len());
        for groom in grooms {
            let first = hair.last().map_or(0, |hair| hair.first() + hair.simulated_strands().len());
            hair.push(StagedHair::new(groom, first, &scene, &body));
        }
        preroll::settle(&mut hair, &scene, &body, progress);
        let simulation =
            join_grooms::simulation(&hair, &scene, scene.solver, body.pose().anchor(), &body.poses());
        let (wind, hands) = (StagedWind::new(joints.wind), StagedHands::new(joints.hands));
        let mut stage = Self {
            body,
            wind,
            hair,
            simulation,
            roots: Vec::new(),
            hands,
            clock: Clock::ZERO,
            cut: false,
            scene,
        };
        stage.reset();
        Ok(stage)
    }

    /// Resets to time 0. All manipulators are removed, and [`Stage::move_body`] is undone. Colliders of
    /// [`Stage::set_user_colliders`] stay where they are.
    pub fn reset(&mut self) {
        self.clock = Clock::ZERO;
        self.body.pose_mut().move_to(RigidTransform::default());
        self.cut = false;
        self.body.place(&self.scene, 0.0);
        self.hands.reset();
        self.simulation.remove_all_manipulators();
        self.pose_roots();
        self.simulation.place(self.body.pose().anchor(), &self.roots);
        self.update_render_points();
    }

    /// Updates the roots from the posed body.
    fn pose_roots(&mut self) {
        self.roots.clear();
        for hair in &mut self.hair {
            hair.pose_roots(&self.body);
            self.roots.extend_from_slice(hair.roots());
        }
    }

    /// Adds a manipulator to the hair of all grooms in its current state, with its space at `pose` in the
    /// world, in addition to the scene's hands. It acts in every step until it is removed or the stage is
    /// reset.
    pub fn add_manipulator(&mut self, tool: Manipulator, pose: RigidTransform) -> ManipulatorId {
        self.simulation.add_manipulator(tool, pose)
    }

    /// Moves a manipulator: its space is at `pose` at the end of the next step.
    pub fn set_manipulator_pose(&mut self, id: ManipulatorId, pose: RigidTransform) {
        self.simulation.set_manipulator_pose(id, pose);
    }

    /// Removes a manipulator and releases the points that it holds.
    pub fn remove_manipulator(&mut self, id: ManipulatorId) {
        self.simulation.remove_manipulator(id);
    }

    /// Sets a rigid motion `by` of the whole body in addition to its clip, from the next step on: a rotation
    /// about the world's origin, then a translation [m]. It replaces that of the previous call. If the motion
    /// exceeds `Solver::teleport_distance` in a step, the hair is moved rigidly with it. Hair without a body
    /// does not move.
    pub fn move_body(&mut self, by: RigidTransform) {
        self.body.pose_mut().move_to(by);
    }

    /// Sets the user colliders: a body that the app moves, such as a ball or a hand, made of closed shapes in
    /// their own space, which is at `pose`. They collide with all hair and are the last of
    /// [`Stage::colliders`]; the stage does not draw them. They move from their previous pose to `pose`
    /// during the next step. New colliders start with zero velocity; this includes calls with a different
    /// number of shapes. Shapes that are not finite or have no interior are ignored. An empty slice removes
    /// all of them.
    pub fn set_user_colliders(&mut self, shapes: &[ColliderShape], pose: RigidTransform) {
        let place = pose.translation.is_finite() && pose.rotation.is_finite();
        let solid = |shape: &&ColliderShape| {
            let (center, radius) = shape.bounds();
            place && center.is_finite() && radius.is_finite() && shape.half_thickness() > 0.0
        };
        self.body.set_user_colliders(shapes.iter().filter(solid), pose);
    }

    /// Returns the colliders in their current state, with their motion in the last step.
    pub fn colliders(&self) -> &[MovingCollider] {
        self.body.colliders()
    }

    /// Returns those of them that are the scene's own colliders, in its order, without hulls that span no
    /// volume.
    pub fn scene_colliders(&self) -> &[MovingCollider] {
        self.body.scene_colliders()
    }

    /// Returns a report if parts of the collision mesh are thinner than its distance field can resolve.
    pub fn thin_mesh(&self) -> Option<ThinMesh> {
        self.body.thin()
    }

    /// Returns the motion since rest of what the joint with this name carries; the identity if there is no
    /// such joint.
    pub fn carried(&self, joint: Option<&str>) -> RigidTransform {
        let joint = joint.and_then(|name| self.scene.body.as_ref()?.joint(name));
        self.body.pose().carried(joint)
    }

    /// Returns the current transform of the anchor, which roots and fields move with. It is the joint that
    /// carries most of the skin around the roots (the head), or the identity without a body.
    pub fn body_anchor(&self) -> RigidTransform {
        self.body.pose().anchor()
    }

    /// Advances the scene by `dt` [s] (above 0). For frames at a fixed rate, [`Stage::step_frame`] keeps
    /// exact time.
    ///
    /// # Panics
    /// If `dt` is not above 0.
    pub fn step(&mut self, dt: f32) -> FrameReport {
        let mut report = self.advance(dt);
        report.follow = self.update_render_points();
        report
    }

    /// Advances the scene by one frame at `rate`. Time is a count of such frames, so it stays exact.
    pub fn step_frame(&mut self, rate: FrameRate) -> FrameReport {
        let mut report = self.advance_frame(rate);
        report.follow = self.update_render_points();
        report
    }

    /// Advances only the simulation by `dt` [s] (above 0). The points of [`Stage::strands`] do not change
    /// until [`Stage::update_render_points`], which saves their cost in frames that are not drawn. The
    /// results do not depend on which frames are drawn.
    ///
    /// # Panics
    /// If `dt` is not above 0.
    pub fn advance(&mut self, dt: f32) -> FrameReport {
        self.advance_to(self.clock.after(f64::from(dt)), dt)
    }

    /// Advances only the simulation by one frame at `rate`, like [`Stage::advance`].
    pub fn advance_frame(&mut self, rate: FrameRate) -> FrameReport {
        self.advance_to(self.clock.after_frame(rate), rate.frame_length() as f32)
    }

    /// Advances to the time `end`, which is `dt` [s] after the current time.
    fn advance_to(&mut self, end: Clock, dt: f32) -> FrameReport {
        let mut report = FrameReport::default();
        let began = Instant::now();
        let (from, to) = (self.clock.time(), end.time());
        self.hands.begin(&self.scene.hands, from, &self.body, &mut self.simulation);
        // Sources are at their poses at the start of the frame, as points are.
        self.wind.advance(&self.scene, from.midpoint(to), &self.body);
        let cut = self.body.advance(&self.scene, (from, to));
        self.cut = cut.is_some();
        if let Some(cut) = cut {
            self.simulation.teleport(cut);
        }
        self.hands.advance(&self.scene.hands, to, &self.body, &mut self.simulation);
        report.body = began.elapsed();
        let began = Instant::now();
        self.pose_roots();
        let Scene { wind, turbulence, .. } = self.scene;
        let air = Air { wind, time: from, sources: self.wind.sources(), turbulence };
        self.simulation.set_charged(self.body.charged().iter().copied());
        report.step = self.simulation.step(&StepInput {
            dt,
            anchor: self.body.pose().anchor(),
            roots: &self.roots,
            colliders: self.body.colliders(),
            air,
        });
        report.simulate = began.elapsed();
        self.clock = end;
        report
    }

    /// Updates the points of all strands after [`Stage::advance`]. Returns the time that this took.
    pub fn update_render_points(&mut self) -> Duration {
        let began = Instant::now();
        self.hair.iter_mut().for_each(|hair| hair.show(&self.simulation, &self.body));
        began.elapsed()
    }

    /// Returns the time since the start of the scene [s].
    pub fn time(&self) -> f64 {
        self.clock.time()
    }

    /// Returns whether the body and its hair were placed elsewhere in the last step instead of moving there.
    pub fn cut(&self) -> bool {
        self.cut
    }

    /// Returns the scene's settings, without its grooms, which have moved into the stage.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns all grooms in their current state.
    pub fn strands(&self) -> impl ExactSizeIterator<Item = Strands<'_>> {
        self.hair.iter().map(|h| h.strands(&self.body))
    }

    /// Sets whether the renderer interpolates the follow hairs, for example on the GPU. If so, a step only
    /// computes the guides' transforms, which are in [`Strands::follow`], and the points of follow hairs are
    /// not updated. Off by default. Turning it off places them at once.
    pub fn set_external_interpolation(&mut self, left: bool) {
        self.hair.iter_mut().for_each(|h| h.leave(left, &self.body));
    }

    /// Places the follow hairs once, even if the renderer interpolates them.
    pub fn place_follow_hairs(&mut self) {
        self.hair.iter_mut().for_each(|h| h.place_followers(&self.body));
    }

    /// Returns the body in its current pose; `None` for a scene without one.
    pub fn body(&self) -> Option<PosedBody<'_>> {
        self.body.pose().posed(&self.scene)
    }
}
