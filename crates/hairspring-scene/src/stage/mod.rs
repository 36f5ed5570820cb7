//! A scene being played: the body posed, the guides stepped, the follow hairs placed, frame after frame.

mod body;
mod charged;
mod clock;
mod fast_surface;
mod hair;
mod join_grooms;
mod joints;
mod manipulators;
mod preroll;
mod rigid_parts;
mod surface;
mod thickness;
mod update_settings;
mod values;
mod wind;

pub use clock::FrameRate;
pub use thickness::ThinMesh;
pub use values::{Picked, StrandFigures, Value};

use crate::{HairLook, Scene};
use body::StagedBody;
use clock::Clock;
use glam::Vec3;
use hair::StagedHair;
use hairspring::{
    air::Air,
    collide::{ColliderShape, MovingCollider},
    follow::HairInterpolation,
    forces::Manipulator,
    groom::{Groom, Imprecise, MAX_COORDINATE, bind_roots, first_imprecise},
    math::RigidTransform,
    simulation::{
        Contacts, Energy, ManipulatorId, Measure, NeighboursReport, Simulation, Start, StepInput, StepReport,
        VolumeReport,
    },
};
use joints::Joints;
use manipulators::StagedHands;
use std::time::{Duration, Instant};
use wind::StagedWind;

/// Why a scene cannot be played.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StageError {
    /// The scene has no strands at all.
    #[error("the scene has no hair: add a groom with at least one strand")]
    NoHair,
    /// A strand cannot be simulated.
    #[error(
        "strand {strand} of groom {groom} has {points} points, and 3 are needed: run `groom::sanitize` first"
    )]
    ShortStrand {
        /// Index of the groom in the scene.
        groom: usize,
        /// Index of the strand.
        strand: usize,
        /// How many points it has.
        points: usize,
    },
    /// The clip does not belong to the body.
    #[error(
        "the clip '{clip}' moves {clip_joints} joints, and the body has {body_joints}: retarget it to the body"
    )]
    JointCount {
        /// Name of the clip.
        clip: String,
        /// Joints a frame of the clip.
        clip_joints: usize,
        /// Joints of the body.
        body_joints: usize,
    },
    /// Settings for another number of grooms than are on the stage.
    #[error(
        "there are settings for {settings} grooms, and {grooms} are on the stage: their hair needs a stage of its own"
    )]
    GroomCount {
        /// Grooms of the settings.
        settings: usize,
        /// Grooms on the stage.
        grooms: usize,
    },
    /// A strand is too far from the origin for single precision.
    #[error("groom {groom}: {why}")]
    TooFar {
        /// Index of the groom in the scene.
        groom: usize,
        /// Which strand, and how far.
        why: Imprecise,
    },
    /// A length that no frame could hold.
    #[error("{what} is not finite or exceeds {MAX_COORDINATE} m, the largest length that is simulated")]
    OutOfRange {
        /// What has it.
        what: String,
    },
    /// Something is to follow a joint that is not there.
    #[error("{what} follows the joint '{joint}', and the body has none of that name")]
    NoSuchJoint {
        /// What follows it.
        what: &'static str,
        /// The name.
        joint: String,
    },
}

/// What a frame did and took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameReport {
    /// Of the simulated strands.
    pub step: StepReport,
    /// Posing the body and rebuilding its distance field.
    pub body: Duration,
    /// Stepping the simulated strands.
    pub simulate: Duration,
    /// Placing the follow hairs.
    pub follow: Duration,
}

/// One groom as it is now, to draw or to write.
#[derive(Clone, Copy)]
pub struct Strands<'a> {
    /// Points of all strands [m]; where `follow` is there, those of follow hairs are as they were when they were last placed here.
    pub points: &'a [Vec3],
    /// The groom they belong to: offsets, radii, colours.
    pub groom: &'a Groom,
    /// How it is drawn.
    pub look: &'a HairLook,
    /// What places its follow hairs, where that is left to who draws them ([`Stage::set_external_interpolation`]).
    pub follow: Option<HairInterpolation<'a>>,
}

/// The body as it is now, to draw.
#[derive(Clone, Copy)]
pub struct PosedBody<'a> {
    /// Triangles and parts.
    pub mesh: &'a hairspring::body::Mesh,
    /// Vertex positions [m].
    pub positions: &'a [Vec3],
    /// Unit vertex normals.
    pub normals: &'a [Vec3],
}

/// A scene in motion. Settings are the scene's; state is the pose, the strands and the time.
pub struct Stage {
    scene: Scene,
    body: StagedBody,
    wind: StagedWind,
    hair: Vec<StagedHair>,
    /// The simulated strands of all grooms, groom after groom.
    simulation: Simulation,
    /// Their roots.
    roots: Vec<RigidTransform>,
    hands: StagedHands,
    clock: Clock,
}

impl Stage {
    /// Sets the scene up at time 0: the body in the first pose of its clip, the hair at rest on it. Roots without a binding are
    /// bound to the nearest place of the body. With `solver.preroll`, hair falls here, and this takes as long as to play so much of the scene.
    pub fn new(mut scene: Scene) -> Result<Self, StageError> {
        check(&scene)?;
        if let Some(body) = &scene.body {
            scene.grooms.iter_mut().for_each(|g| bind_roots(&mut g.groom, &body.mesh));
        }
        let joints = Joints::new(&scene, scene.body.as_ref())?;
        let body = StagedBody::new(&scene, &joints);
        let grooms = std::mem::take(&mut scene.grooms);
        let mut hair: Vec<StagedHair> = Vec::with_capacity(grooms.len());
        for groom in grooms {
            let first = hair.last().map_or(0, |hair| hair.first() + hair.simulated_strands().len());
            hair.push(StagedHair::new(groom, first, &scene, &body));
        }
        if scene.solver.preroll > 0.0 {
            preroll::settle(&mut hair, &scene, &body);
        }
        let simulation = join_grooms::simulation(&hair, &scene, scene.solver, body.anchor(), &body.poses());
        let (wind, hands) = (StagedWind::new(joints.wind), StagedHands::new(joints.hands));
        let mut stage =
            Self { body, wind, hair, simulation, roots: Vec::new(), hands, clock: Clock::ZERO, scene };
        stage.reset();
        Ok(stage)
    }

    /// Back to time 0; no tool is in use, and the body goes by its clip alone. What [`Stage::set_user_colliders`] brought stays where it is.
    pub fn reset(&mut self) {
        self.clock = Clock::ZERO;
        self.body.place(&self.scene, 0.0);
        self.hands.reset();
        self.simulation.remove_all_manipulators();
        self.pose_roots();
        self.simulation.place(self.body.anchor(), &self.roots);
        self.update_render_points();
    }

    /// Where the roots are on the posed body.
    fn pose_roots(&mut self) {
        self.roots.clear();
        for hair in &mut self.hair {
            hair.pose_roots(&self.body);
            self.roots.extend_from_slice(hair.roots());
        }
    }

    /// Takes a tool to the hair of all grooms as it is now, its space being at `pose` in the world, besides what the scene's hands do. It acts in every
    /// step until it is let go of, or until a reset.
    pub fn add_manipulator(&mut self, tool: Manipulator, pose: RigidTransform) -> ManipulatorId {
        self.simulation.add_manipulator(tool, pose)
    }

    /// Moves a tool: its space goes to `pose` in the next step.
    pub fn set_manipulator_pose(&mut self, id: ManipulatorId, pose: RigidTransform) {
        self.simulation.set_manipulator_pose(id, pose);
    }

    /// Lets go of a tool, and of what it holds.
    pub fn remove_manipulator(&mut self, id: ManipulatorId) {
        self.simulation.remove_manipulator(id);
    }

    /// Carries the whole body by `by` besides its clip, from the next step on: a rotation about the world's origin, then a translation [m]. The last
    /// call counts, from where the clip has the body and not from the call before. What moves farther than `Solver::jump` in a step takes its hair along as
    /// it is. Hair without a body stays.
    pub fn move_body(&mut self, by: RigidTransform) {
        self.body.move_to(by);
    }

    /// A body in the world that an app moves, a ball or a hand: closed shapes in a space of its own, which is at `pose`. They are colliders of all hair, the last of
    /// [`Stage::obstacles`], and drawn by nobody here. It goes from where it was to `pose` in the next step and passes on that velocity; it has none where it
    /// appears, which it does with another number of shapes. What is not finite or has no inside is left out; without shapes, there is nothing.
    pub fn set_user_colliders(&mut self, shapes: &[ColliderShape], pose: RigidTransform) {
        let place = pose.translation.is_finite() && pose.rotation.is_finite();
        let solid = |shape: &&ColliderShape| {
            let (center, radius) = shape.bounds();
            place && center.is_finite() && radius.is_finite() && shape.half_thickness() > 0.0
        };
        self.body.set_user_colliders(shapes.iter().filter(solid), pose);
    }

    /// The colliders as they are now, and how they moved in the last step.
    pub fn obstacles(&self) -> &[MovingCollider] {
        self.body.obstacles()
    }

    /// Those of them that are the scene's own colliders, in its order; hulls that span no volume are left out.
    pub fn colliders(&self) -> &[MovingCollider] {
        self.body.colliders()
    }

    /// What of the mesh that hair collides with is thinner than its distance field can tell.
    pub fn thin_mesh(&self) -> Option<ThinMesh> {
        self.body.thin()
    }

    /// Where what the body's joint of this name carries has gone since rest; nowhere without a joint of that name.
    pub fn carried(&self, joint: Option<&str>) -> RigidTransform {
        let joint = joint.and_then(|name| self.scene.body.as_ref()?.joint(name));
        self.body.carried(joint)
    }

    /// Where the frame is now that roots and fields move with: the joint that carries most of the skin around the roots (the head); the identity without a
    /// body.
    pub fn body_anchor(&self) -> RigidTransform {
        self.body.anchor()
    }

    /// Plays `dt` [s] (above 0) of the scene. For frames at a fixed rate, [`Stage::step_frame`] keeps exact time.
    pub fn step(&mut self, dt: f32) -> FrameReport {
        let mut report = self.advance(dt);
        report.follow = self.update_render_points();
        report
    }

    /// Plays one frame at `rate`. Time is a count of such frames, so that it is exact after any number of them.
    pub fn step_frame(&mut self, rate: FrameRate) -> FrameReport {
        let mut report = self.advance_frame(rate);
        report.follow = self.update_render_points();
        report
    }

    /// Plays `dt` [s] (above 0) of what is simulated alone: what [`Stage::strands`] shows stays as it is until [`Stage::show`], and costs nothing in frames that
    /// nobody looks at. No result depends on which frames are shown.
    pub fn advance(&mut self, dt: f32) -> FrameReport {
        self.advance_to(self.clock.after(f64::from(dt)), dt)
    }

    /// Plays one frame at `rate` of what is simulated alone, as [`Stage::advance`] does.
    pub fn advance_frame(&mut self, rate: FrameRate) -> FrameReport {
        self.advance_to(self.clock.after_frame(rate), rate.frame_length() as f32)
    }

    /// Plays to the time `end`, which is `dt` [s] after now.
    fn advance_to(&mut self, end: Clock, dt: f32) -> FrameReport {
        let mut report = FrameReport::default();
        let began = Instant::now();
        let (from, to) = (self.clock.time(), end.time());
        self.hands.begin(&self.scene.hands, from, &self.body, &mut self.simulation);
        // Sources are where they are at the start, as points are.
        self.wind.advance(&self.scene, from.midpoint(to), &self.body);
        if let Some(cut) = self.body.advance(&self.scene, (from, to)) {
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
            anchor: self.body.anchor(),
            roots: &self.roots,
            obstacles: self.body.obstacles(),
            air,
        });
        report.simulate = began.elapsed();
        self.clock = end;
        report
    }

    /// Brings the points of all strands up to date after [`Stage::advance`]; how long it took.
    pub fn update_render_points(&mut self) -> Duration {
        let began = Instant::now();
        self.hair.iter_mut().for_each(|hair| hair.show(&self.simulation, &self.body));
        began.elapsed()
    }

    /// Time played since the start [s].
    pub fn time(&self) -> f64 {
        self.clock.time()
    }

    /// The scene's settings; its grooms have moved into the stage.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// All grooms as they are now.
    pub fn strands(&self) -> impl ExactSizeIterator<Item = Strands<'_>> {
        self.hair.iter().map(|h| h.strands(&self.body))
    }

    /// Leaves follow hairs to who draws them, a viewer that places them on a graphics card: a step then finds no more than how guides carry them, which
    /// [`Strands::follow`] gives, and their points stay behind. Off at the start; turned off, they are placed at once.
    pub fn set_external_interpolation(&mut self, left: bool) {
        self.hair.iter_mut().for_each(|h| h.leave(left, &self.body));
    }

    /// Places follow hairs that are left to who draws them, for once.
    pub fn place_follow_hairs(&mut self) {
        self.hair.iter_mut().for_each(|h| h.place_followers(&self.body));
    }

    /// The body as it is now; `None` for a scene without one.
    pub fn body(&self) -> Option<PosedBody<'_>> {
        self.body.posed(&self.scene)
    }

    /// Strands that are simulated, of how many there are.
    pub fn simulated_strands(&self) -> (usize, usize) {
        let all = self.hair.iter().map(|h| h.groom().strand_count()).sum();
        (self.simulation.strand_count(), all)
    }

    /// Points that are simulated, of how many there are.
    pub fn simulated_points(&self) -> (usize, usize) {
        let all = self.hair.iter().map(|h| h.groom().point_count()).sum();
        (self.simulation.point_count(), all)
    }

    /// Joints that the sag-free start had to make stiffer than the fibre, and those that are softer than they should be.
    pub fn start(&self) -> Start {
        self.simulation.start()
    }

    /// What is known of the hair's volume; `None` where strands pass through each other.
    pub fn volume(&self) -> Option<VolumeReport> {
        self.simulation.volume()
    }

    /// What is known of strands that meet each other one by one; `None` where none do.
    pub fn neighbours(&self) -> Option<NeighboursReport> {
        self.simulation.neighbours()
    }

    /// Name of the instruction set that strands are simulated with.
    pub fn instruction_set(&self) -> String {
        self.simulation.instruction_set()
    }

    /// Energy of all simulated strands at the end of the last step.
    pub fn energy(&self) -> Energy {
        self.simulation.energy()
    }

    /// What colliders hold out now, and how many points had one looked up.
    pub fn contacts(&self) -> Contacts {
        self.simulation.contacts(self.body.obstacles())
    }

    /// Figures over all simulated strands at the end of the last step.
    pub fn measure(&self) -> Measure {
        self.simulation.measure(self.body.obstacles())
    }
}

fn check(scene: &Scene) -> Result<(), StageError> {
    if scene.grooms.iter().all(|g| g.groom.strand_count() == 0) {
        return Err(StageError::NoHair);
    }
    for (g, groom) in scene.grooms.iter().enumerate() {
        let groom = &groom.groom;
        if let Some(strand) = (0..groom.strand_count()).find(|s| groom.range(*s).len() < 3) {
            let points = groom.range(strand).len();
            return Err(StageError::ShortStrand { groom: g, strand, points });
        }
        if let Some(why) = first_imprecise(groom) {
            return Err(StageError::TooFar { groom: g, why });
        }
        in_range(&format!("a point of groom {g}"), &groom.points)?;
    }
    check_effects(scene)?;
    if let Some(body) = &scene.body {
        in_range("a vertex of the body", &body.mesh.positions)?;
    }
    if let Some(clip) = &scene.clip {
        let translations = clip.samples.iter().map(|joint| &joint.translation);
        in_range("a translation of the clip", translations)?;
    }
    if let (Some(clip), Some(body)) = (&scene.clip, &scene.body)
        && clip.joint_count != body.joints.len()
    {
        return Err(StageError::JointCount {
            clip: clip.name.clone(),
            clip_joints: clip.joint_count,
            body_joints: body.joints.len(),
        });
    }
    Ok(())
}

/// Refuses effects that would displace follow hairs beyond what is simulated.
fn check_effects(scene: &Scene) -> Result<(), StageError> {
    for (g, effects) in scene.grooms.iter().map(|groom| groom.effects).enumerate() {
        let lengths = Vec3::new(effects.curl_radius, effects.curl_length, effects.noise);
        in_range(&format!("an effect of groom {g}"), [&lengths])?;
    }
    Ok(())
}

/// Refuses coordinates that are not finite or beyond [`MAX_COORDINATE`].
fn in_range<'a>(what: &str, coordinates: impl IntoIterator<Item = &'a Vec3>) -> Result<(), StageError> {
    let inside = |p: &Vec3| p.abs().cmple(Vec3::splat(MAX_COORDINATE)).all();
    match coordinates.into_iter().all(inside) {
        true => Ok(()),
        false => Err(StageError::OutOfRange { what: what.into() }),
    }
}
