//! Settings of a scene that both code and scene files set; each field's default is the value that a file may leave out.

use crate::collide::{ColliderShape, Hull};
use glam::{Mat3, Vec3};
use serde::{Deserialize, Serialize};
use std::{path::PathBuf, sync::Arc};

/// Which strands of a groom are simulated; the others follow them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Guides {
    /// The strands that the groom file names as guides; 2,000 chosen ones where it names none. The default.
    #[default]
    FromGroom,
    /// So many strands, spread over the scalp per group.
    Count(u32),
    /// Every strand.
    All,
}

/// What is laid over follow hairs after the guides have placed them. All off by default.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Effects {
    /// How far tips are drawn to their first guide, 0 (not) to 1 (wholly); grows from root to tip.
    pub clump: f32,
    /// Radius of curls added to follow hairs [m], 0 to 1,000,000.
    pub curl_radius: f32,
    /// Length of hair in one turn of those curls [m], above 0. Default 0.03.
    pub curl_length: f32,
    /// Amplitude of the flyaway noise at the tip [m], 0 to 1,000,000.
    pub noise: f32,
}

impl Default for Effects {
    fn default() -> Self {
        Self { clump: 0.0, curl_radius: 0.0, curl_length: 0.03, noise: 0.0 }
    }
}

/// Moving air, the same everywhere but for gusts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Wind {
    /// Mean velocity of the air [m/s]. Default 0.
    pub velocity: Vec3,
    /// How much gusts add and take, as a fraction of the mean, 0 to 1. Default 0.
    pub gust: f32,
    /// Gusts a second [Hz]. 0: none.
    pub gust_rate: f32,
}

/// Time steps and contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Solver {
    /// Substeps in a frame of 1/60 s, 1 to 64. Default 4: the substep is 1/240 s whatever the frame rate.
    pub substeps: u32,
    /// Whether rest shapes are solved so that the groom starts in balance under gravity. Default true.
    pub sag_free: bool,
    /// How long hair falls from where its groom has it before the scene begins [s], 0 to 60. Where it lies then is its groom from there on: what
    /// [`Solver::sag_free`] puts in balance, and what a reset goes back to. Default 0: grooms are as they are made. For hair that is grown by a rule, 3: it stands
    /// off the skin, and long hair lies still by then.
    pub preroll: f32,
    /// Whether hair collides with the body's mesh. Default true.
    pub collide_body: bool,
    /// What keeps hair out of colliders. Default `both`.
    pub contact: Response,
    /// Whether segments are held out of colliders between their points as well. Default true; where none of them is longer than what it collides with is
    /// round, points alone do.
    pub segment_contacts: bool,
    /// Iterations of fast projection a substep (Goldenthal 2007), 0 to 20; strands of more than 32 points for each may take one for every
    /// 32. Default 3. For the implicit integrators.
    pub projection_iterations: u32,
    /// How a substep is made. Default `backward-euler`.
    pub integrator: Integrator,
    /// How exactly its equations are solved. Default `normal`.
    pub quality: Quality,
    /// How much of the head's motion hair feels, 0 (none: it moves as if the head stood still) to 1 (all of it, the default): for art direction.
    pub inertia: f32,
    /// A head that moves farther than this in a frame, over how it moved before, has jumped, and hair is carried along as it is [m], above 0. Default 1:
    /// what moves so in 1/24 s is accelerated by 60 g.
    pub teleport_distance: f32,
    /// Whether materials' global shapes pull. Default true; no material has one by default.
    pub global_shape: bool,
}

/// What answers a point, or a segment, that is inside of a collider (Sams 2014, §3.3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Response {
    /// A force that is part of the solve, and what is inside after it moves to the nearest free position: the force carries weight and tension without a
    /// jerk, the projection stops what lands.
    #[default]
    Both,
    /// The force alone, implicit: soft, what lands goes in and comes out again. Integrators without a solve that knows of contact (all but
    /// backward Euler and BDF2) project.
    Penalty,
    /// The projection alone: the inward motion ends, the point moves to the nearest free position (Liu 2013).
    Projection,
}

impl Response {
    /// All of them.
    pub const ALL: [Response; 3] = [Self::Both, Self::Penalty, Self::Projection];
}

/// How positions and velocities come out of a substep; all on the same strands, to be compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// x⁺ = x + h v, v⁺ = v + h a with the fibre's own stiffness: the baseline that blows up.
    ExplicitEuler,
    /// Position Verlet with the fibre's own stiffness (Müller 2008).
    Verlet,
    /// The banded direct solver, linearised once, then fast projection and a strain limit (Baraff & Witkin 1998; Goldenthal 2007).
    #[default]
    BackwardEuler,
    /// The same with the backward differentiation formula of second order: swings keep their amplitude (Choi & Ko 2002).
    Bdf2,
    /// A constant matrix and a projection of every spring by itself (Liu 2013); always by the curvature model.
    LocalGlobal,
    /// Follow the leader: inextensible, no bending.
    Ftl,
    /// Follow the leader with corrected velocities (Müller 2012).
    Dftl,
}

impl Integrator {
    /// All of them, in the order of the page that compares them.
    pub const ALL: [Integrator; 7] = [
        Self::ExplicitEuler,
        Self::Verlet,
        Self::BackwardEuler,
        Self::Bdf2,
        Self::LocalGlobal,
        Self::Ftl,
        Self::Dftl,
    ];

    /// Its name in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::ExplicitEuler => "explicit-euler",
            Self::Verlet => "verlet",
            Self::BackwardEuler => "backward-euler",
            Self::Bdf2 => "bdf2",
            Self::LocalGlobal => "local-global",
            Self::Ftl => "ftl",
            Self::Dftl => "dftl",
        }
    }

    /// Whether no segment leaves a substep more than 1 % longer or shorter than at rest; the others are shown as they are.
    pub fn limits_strain(self) -> bool {
        matches!(self, Self::BackwardEuler | Self::Bdf2)
    }
}

/// How exactly a substep's equations are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// One linear solve (10 iterations of local–global).
    #[default]
    Normal,
    /// Newton iterations with a line search, to the end (40 iterations of local–global).
    High,
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            substeps: 4,
            sag_free: true,
            preroll: 0.0,
            collide_body: true,
            contact: Response::Both,
            segment_contacts: true,
            projection_iterations: 3,
            integrator: Integrator::default(),
            quality: Quality::default(),
            inertia: 1.0,
            teleport_distance: 1.0,
            global_shape: true,
        }
    }
}

/// How hair meets hair: the simulated strands of all grooms, each weighing what the hairs weigh that follow it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Volume {
    /// What keeps hair from crowding. Default `off`: strands pass through each other.
    pub method: VolumeMethod,
    /// Edge of a cell [m], above 0; it grows where there would be more than two million. `None`, the default: the smallest in which a cell
    /// with hair holds eight points at rest, so that its density is more than chance.
    pub cell: Option<f32>,
    /// How fast hair takes on the velocity of the hair around it [1/s], 0 or more. Default 3: strands lose a twentieth of what
    /// is between their velocities in 1/60 s; as a PIC/FLIP blend, 0.95 FLIP. What goes across other hair is stopped besides, see `volume/crossing.rs`.
    pub friction: f32,
    /// Speed with which a crowd spreads, for `density` [m/s], 0 or more; it counts as at most half a cell in 1/240 s, beyond which a step
    /// would overshoot. Default 0.5.
    pub pressure: f32,
    /// How fast lost volume is regained, for `incompressible`: the share a second [1/s], 0 or more, and at most all of it in 1/240 s.
    /// Default 30: hair that falls from standing out and is shaken keeps nine tenths of its volume so, three quarters with 10, and a
    /// quarter without a method (`hairspring bench --hair-hair`).
    pub recovery_rate: f32,
}

impl Default for Volume {
    fn default() -> Self {
        Self { method: VolumeMethod::Off, cell: None, friction: 3.0, pressure: 0.5, recovery_rate: 30.0 }
    }
}

/// How strands meet their neighbours, one by one: the reference for the volume, for guides and small scenes. Between the simulated strands of all grooms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Neighbours {
    /// Whether they do. Default false: strands pass through each other.
    pub on: bool,
    /// Radius of a strand where it meets others [m], above 0: a strand stands for the hairs around it. It is nowhere more than half of the way to the nearest
    /// other strand at rest, so that nothing touches there. `None`, the default: half of that way in the mean, at most half a segment.
    pub radius: Option<f32>,
    /// Coulomb friction of strands on each other [1], 0 or more. Default 0.3: scales let hair slide more easily toward the tip than toward the root, and it is
    /// between the two.
    pub friction: f32,
    /// Force that two segments which have been pressed together hold with, along and across, besides friction; it breaks when more pulls [N], 0 or more.
    /// Default 0. A hair of 25 cm weighs 1.6e-5 N.
    pub stiction: f32,
}

impl Default for Neighbours {
    fn default() -> Self {
        Self { on: false, radius: None, friction: 0.3, stiction: 0.0 }
    }
}

/// What keeps hair from crowding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VolumeMethod {
    /// Nothing.
    #[default]
    Off,
    /// Pressure down the gradient of density, where hair is denser than at rest (Petrovic 2005): cheap, and gives way.
    Density,
    /// Velocities that close in on full cells are taken out, and lost volume is regained (McAdams 2009): firm, for a linear solve each 1/240 s.
    Incompressible,
}

impl VolumeMethod {
    /// All of them.
    pub const ALL: [VolumeMethod; 3] = [Self::Off, Self::Density, Self::Incompressible];

    /// Its name in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Density => "density",
            Self::Incompressible => "incompressible",
        }
    }
}

/// A simple shape that hair collides with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Collider {
    /// Name of the body's joint that moves it; `None`: joint 0, or fixed without a body.
    #[serde(default)]
    pub joint: Option<String>,
    /// The shape, in the space of the body's rest pose [m].
    pub shape: Shape,
}

/// The shapes of a [`Collider`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Shape {
    /// A ball.
    Sphere {
        /// Middle [m].
        center: Vec3,
        /// Radius [m], above 0.
        radius: f32,
    },
    /// All places nearer than `radius` to the line from `a` to `b`.
    Capsule {
        /// One end of the axis [m].
        a: Vec3,
        /// The other end [m].
        b: Vec3,
        /// Radius [m], above 0.
        radius: f32,
    },
    /// A box.
    Box {
        /// Middle [m].
        center: Vec3,
        /// Lengths of its edges [m], above 0.
        size: Vec3,
        /// How it is turned: about X, then Y, then Z [degrees]. Default 0.
        #[serde(default)]
        rotation: Vec3,
    },
    /// All of space on the side of a plane that `normal` points away from: a floor, a wall, a slope.
    Plane {
        /// A point of the plane [m].
        point: Vec3,
        /// Direction out of the solid, of any length above 0.
        normal: Vec3,
    },
    /// The convex hull of points: a shoulder, a stone, a brush.
    Hull {
        /// Points that span it [m], four or more. Default: the vertices of `file`.
        #[serde(default)]
        points: Vec<Vec3>,
        /// A mesh file whose vertices a reader of scene files puts in place of `points`; nothing here opens it.
        #[serde(default)]
        file: Option<PathBuf>,
        /// Metres in one unit of `file` [m], above 0. Default: by the format, or guessed and said.
        #[serde(default)]
        scale: Option<f32>,
    },
}

impl Shape {
    /// The collider of this shape; `None` for the hull of points that span no volume.
    pub fn obstacle(&self) -> Option<ColliderShape> {
        Some(match *self {
            Self::Sphere { center, radius } => ColliderShape::Sphere { center, radius },
            Self::Capsule { a, b, radius } => ColliderShape::Capsule { a, b, radius },
            Self::Box { center, size, rotation } => {
                let [x, y, z] = rotation.to_array().map(f32::to_radians);
                let axes = Mat3::from_rotation_z(z) * Mat3::from_rotation_y(y) * Mat3::from_rotation_x(x);
                ColliderShape::Cuboid { center, half: 0.5 * size, axes }
            }
            Self::Plane { point, normal } => {
                ColliderShape::Plane { point, normal: normal.normalize_or(Vec3::Y) }
            }
            Self::Hull { ref points, .. } => ColliderShape::Hull(Arc::new(Hull::new(points)?)),
        })
    }
}
