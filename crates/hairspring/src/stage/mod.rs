//! A scene being played: the body posed, the guides stepped, the follow hairs placed, frame after frame.

mod body;
mod hair;

use crate::{
    groom::{Groom, bind_roots},
    neighbours::{Member, Neighbours, NeighboursReport},
    scene::{HairLook, Scene},
    simulation::{Air, Measure, Simulation, Start, StepReport, VolumeReport},
};
use body::StagedBody;
use glam::Vec3;
use hair::StagedHair;
use std::time::{Duration, Instant};

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
    /// A collider is to follow a joint that is not there.
    #[error("a collider follows the joint '{joint}', and the body has none of that name")]
    NoSuchJoint {
        /// The name.
        joint: String,
    },
}

/// What a frame did and took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameReport {
    /// Sums over the grooms.
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
    /// Points of all strands [m].
    pub points: &'a [Vec3],
    /// The groom they belong to: offsets, radii, colours.
    pub groom: &'a Groom,
    /// How it is drawn.
    pub look: &'a HairLook,
}

/// The body as it is now, to draw.
#[derive(Clone, Copy)]
pub struct PosedBody<'a> {
    /// Triangles and parts.
    pub mesh: &'a crate::body::Mesh,
    /// Vertex positions [m].
    pub positions: &'a [Vec3],
    /// Unit vertex normals.
    pub normals: &'a [Vec3],
}

/// A scene in motion. Settings are the scene's; state is the pose, the strands and the time.
pub struct Stage {
    scene: Scene,
    body: StagedBody,
    hair: Vec<StagedHair>,
    /// `None`: strands do not meet each other one by one.
    neighbours: Option<Neighbours>,
    time: f32,
}

impl Stage {
    /// Sets the scene up at time 0: the body in the first pose of its clip, the hair at rest on it. Roots without a binding are
    /// bound to the nearest place of the body.
    pub fn new(mut scene: Scene) -> Result<Self, StageError> {
        check(&scene)?;
        if let Some(body) = &scene.body {
            scene.grooms.iter_mut().for_each(|g| bind_roots(&mut g.groom, &body.mesh));
        }
        let body = StagedBody::new(&scene)?;
        let grooms = std::mem::take(&mut scene.grooms);
        let hair = grooms.into_iter().map(|groom| StagedHair::new(groom, &scene, &body)).collect();
        let mut stage = Self { body, hair, neighbours: None, time: 0.0, scene };
        stage.reset();
        // As hair lies in the first pose is how near strands may be.
        let simulations: Vec<&Simulation> = stage.hair.iter().map(StagedHair::simulation).collect();
        stage.neighbours = Neighbours::new(&stage.scene.neighbours, &simulations);
        Ok(stage)
    }

    /// Back to time 0.
    pub fn reset(&mut self) {
        self.time = 0.0;
        self.body.place(&self.scene, 0.0);
        for hair in &mut self.hair {
            hair.place(&self.body);
        }
        if let Some(neighbours) = &mut self.neighbours {
            neighbours.reset();
        }
    }

    /// Plays `dt` [s] (above 0) of the scene.
    pub fn step(&mut self, dt: f32) -> FrameReport {
        let mut report = FrameReport::default();
        let began = Instant::now();
        self.body.advance(&self.scene, self.time + dt);
        report.body = began.elapsed();
        let air = Air { wind: self.scene.wind, time: self.time };
        let began = Instant::now();
        let mut members: Vec<Member> =
            self.hair.iter_mut().map(|hair| hair.member(dt, &self.body, air)).collect();
        match &mut self.neighbours {
            Some(neighbours) => neighbours.step(&mut members),
            None => members.iter_mut().for_each(|m| m.report = m.simulation.step(&m.drive)),
        }
        for step in members.iter().map(|m| m.report) {
            report.step.substeps = report.step.substeps.max(step.substeps);
            report.step.reset_strands += step.reset_strands;
        }
        let stepped = Instant::now();
        report.simulate = stepped - began;
        self.hair.iter_mut().for_each(|hair| hair.show(&self.body));
        report.follow = stepped.elapsed();
        self.time += dt;
        report
    }

    /// Time played since the start [s].
    pub fn time(&self) -> f32 {
        self.time
    }

    /// The scene's settings; its grooms have moved into the stage.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// All grooms as they are now.
    pub fn strands(&self) -> impl ExactSizeIterator<Item = Strands<'_>> {
        self.hair.iter().map(StagedHair::strands)
    }

    /// The body as it is now; `None` for a scene without one.
    pub fn body(&self) -> Option<PosedBody<'_>> {
        self.body.posed(&self.scene)
    }

    /// Strands that are simulated, of how many there are.
    pub fn simulated_strands(&self) -> (usize, usize) {
        let all = self.hair.iter().map(|h| h.strands().groom.strand_count()).sum();
        (self.hair.iter().map(|h| h.simulation().strand_count()).sum(), all)
    }

    /// Points that are simulated, of how many there are.
    pub fn simulated_points(&self) -> (usize, usize) {
        let all = self.hair.iter().map(|h| h.strands().groom.point_count()).sum();
        (self.hair.iter().map(|h| h.simulation().point_count()).sum(), all)
    }

    /// Joints that the sag-free start had to make stiffer than the fibre, and those that are softer than they should be.
    pub fn start(&self) -> Start {
        self.hair.iter().map(|h| h.simulation().start()).sum()
    }

    /// What is known of the volume of each groom's hair; `None` where its strands pass through each other.
    pub fn volumes(&self) -> impl ExactSizeIterator<Item = Option<VolumeReport>> {
        self.hair.iter().map(|h| h.simulation().volume())
    }

    /// What is known of the strands that meet each other one by one; `None` where none do.
    pub fn neighbours(&self) -> Option<NeighboursReport> {
        self.neighbours.as_ref().map(Neighbours::report)
    }

    /// Name of the instruction set that strands are simulated with.
    pub fn instruction_set(&self) -> String {
        self.hair.first().map_or(String::new(), |h| h.simulation().instruction_set())
    }

    /// Figures over all simulated strands at the end of the last step.
    pub fn measure(&self) -> Measure {
        let parts: Vec<(Measure, f64)> = self
            .hair
            .iter()
            .map(|h| (h.simulation().measure(self.body.obstacles()), h.simulation().point_count() as f64))
            .collect();
        let points: f64 = parts.iter().map(|p| p.1).sum();
        parts.iter().fold(Measure::default(), |sum, (m, n)| Measure {
            stretch_mean: sum.stretch_mean + m.stretch_mean * n / points.max(1.0),
            stretch_max: sum.stretch_max.max(m.stretch_max),
            inside_points: sum.inside_points + m.inside_points,
            max_depth: sum.max_depth.max(m.max_depth),
            non_finite: sum.non_finite + m.non_finite,
            speed_max: sum.speed_max.max(m.speed_max),
        })
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
