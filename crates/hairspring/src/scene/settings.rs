//! Scene settings that can be set in code and in scene files. A field's default applies if a file omits it.

use crate::collide::{ColliderShape, Hull};
use glam::{Mat3, Vec3};
use serde::{Deserialize, Serialize};
use std::{path::PathBuf, sync::Arc};

/// Selects the simulated strands of a groom; the others follow them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Guides {
    /// The strands that the groom file marks as guides, or 2,000 chosen ones if it marks none. The default.
    #[default]
    FromGroom,
    /// This many strands, spread over the scalp per group.
    Count(u32),
    /// Every strand.
    All,
}

/// Styling of follow hairs, applied after interpolation from the guides. All off by default.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Effects {
    /// How far tips are drawn to their first guide, 0 (not at all) to 1 (fully); grows from root to tip.
    pub clump: f32,
    /// Radius of the curls [m], 0 to 1,000,000.
    pub curl_radius: f32,
    /// Length of hair in one turn of a curl [m], above 0. Default 0.03.
    pub curl_length: f32,
    /// Amplitude of the flyaway noise at the tip [m], 0 to 1,000,000.
    pub noise: f32,
}

impl Default for Effects {
    fn default() -> Self {
        Self { clump: 0.0, curl_radius: 0.0, curl_length: 0.03, noise: 0.0 }
    }
}

/// Directional wind, the same everywhere, with gusts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Wind {
    /// Mean velocity of the air [m/s]. Default 0.
    pub velocity: Vec3,
    /// Gust amplitude as a fraction of the mean, 0 to 1. Default 0.
    pub gust: f32,
    /// Gust frequency [Hz]. 0: no gusts.
    pub gust_rate: f32,
}

/// Settings of time steps and contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Solver {
    /// Number of substeps in a frame of 1/60 s, 1 to 64. Default 4: substeps of 1/240 s at any frame rate.
    pub substeps: u32,
    /// Whether rest shapes are computed so that the groom starts in static balance under gravity. Default
    /// true.
    pub sag_free: bool,
    /// Pre-roll: time that hair falls from its authored pose before the scene begins [s], 0 to 60. The
    /// resulting pose becomes the groom: [`Solver::sag_free`] puts it in balance, and a reset returns to it.
    /// Default 0: grooms as authored. For procedurally grown hair that stands off the skin, use 3; long hair
    /// is at rest by then.
    pub preroll: f32,
    /// Whether hair collides with the body's mesh. Default true.
    pub collide_body: bool,
    /// Contact method. Default `both`.
    pub contact: Response,
    /// Whether segments are also kept out of colliders between their points. Default true. Points alone are
    /// enough if no segment is longer than the radius of curvature of the colliders.
    pub segment_contacts: bool,
    /// Iterations of fast projection in a substep (Goldenthal 2007), 0 to 20. Strands of more than 32 points
    /// may take one for every 32 points in place of each. Default 3. Only for the implicit integrators.
    pub projection_iterations: u32,
    /// Time integrator. Default `backward-euler`.
    pub integrator: Integrator,
    /// Accuracy of the solve in each substep. Default `normal`.
    pub quality: Quality,
    /// Fraction of the head's motion that acts on the hair, for art direction: 0 (none, as if the head stood
    /// still) to 1 (all, the default).
    pub inertia: f32,
    /// Teleport threshold [m], above 0. If the head moves farther than this in one frame, in excess of its
    /// previous motion, the hair is moved rigidly with it. Default 1: such a motion within 1/24 s would be an
    /// acceleration of 60 g.
    pub teleport_distance: f32,
    /// Whether the materials' global shapes are enabled. Default true; by default, no material has one.
    pub global_shape: bool,
}

/// Contact method for points and segments inside a collider (Sams 2014, §3.3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Response {
    /// An implicit force in the solve, followed by projection of what is still inside to the nearest free
    /// position. The force carries weight and tension without jerks; the projection stops impacts.
    #[default]
    Both,
    /// Only the implicit force. It is soft: hair that hits a surface sinks in and comes out again. Only
    /// backward Euler and BDF2 have contact in their solve; the other integrators project.
    Penalty,
    /// Only the projection: inward motion is removed, and the point moves to the nearest free position (Liu
    /// 2013).
    Projection,
}

impl Response {
    /// All methods.
    pub const ALL: [Response; 3] = [Self::Both, Self::Penalty, Self::Projection];
}

/// Time integration method. All methods act on the same strands, for comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// x⁺ = x + h v, v⁺ = v + h a with the fiber's own stiffness: a baseline that is unstable.
    ExplicitEuler,
    /// Position Verlet with the fiber's own stiffness (Müller 2008).
    Verlet,
    /// The direct banded solver, linearized once, followed by fast projection and a strain limit (Baraff &
    /// Witkin 1998; Goldenthal 2007).
    #[default]
    BackwardEuler,
    /// Like backward Euler, with the second-order backward differentiation formula: swings keep their
    /// amplitude (Choi & Ko 2002).
    Bdf2,
    /// Local-global solver: a constant matrix, and a separate projection of every spring (Liu 2013). Always
    /// uses the curvature model.
    LocalGlobal,
    /// Follow the leader: inextensible, without bending.
    Ftl,
    /// Dynamic follow the leader, with corrected velocities (Müller 2012).
    Dftl,
}

impl Integrator {
    /// All integrators, in the order of the page that compares them.
    pub const ALL: [Integrator; 7] = [
        Self::ExplicitEuler,
        Self::Verlet,
        Self::BackwardEuler,
        Self::Bdf2,
        Self::LocalGlobal,
        Self::Ftl,
        Self::Dftl,
    ];

    /// Returns the name used in scene files and on the command line.
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

    /// Returns whether the strain limit applies: no segment leaves a substep more than 1 % longer or shorter
    /// than at rest. The other integrators have no such limit.
    pub fn limits_strain(self) -> bool {
        matches!(self, Self::BackwardEuler | Self::Bdf2)
    }
}

/// Accuracy of the solve in each substep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// One linear solve (10 iterations of local-global).
    #[default]
    Normal,
    /// Newton iterations with a line search until convergence (40 iterations of local-global).
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

/// Settings of the hair volume, which acts between the simulated strands of all grooms. Each strand has the
/// mass of the hairs that follow it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Volume {
    /// Volume method. Default `off`: strands pass through each other.
    pub method: VolumeMethod,
    /// Edge of a cell [m], above 0; it is enlarged if there would be more than two million cells. `None`, the
    /// default: the smallest cell in which cells with hair contain eight points at rest, so that the density
    /// is statistically meaningful.
    pub cell: Option<f32>,
    /// Rate at which hair takes on the velocity of the surrounding hair [1/s], 0 or more. Default 3: strands
    /// lose a twentieth of their relative velocity in 1/60 s, which corresponds to a PIC/FLIP blend of 0.95
    /// FLIP. Motion across other hair is stopped separately, see `volume/crossing.rs`.
    pub friction: f32,
    /// Speed at which compressed hair spreads, for `density` [m/s], 0 or more. It is limited to half a cell
    /// in 1/240 s, to prevent overshoot. Default 0.5.
    pub pressure: f32,
    /// Rate at which lost volume is recovered, for `incompressible`, as a fraction per second [1/s], 0 or
    /// more; at most all of it in 1/240 s. Default 30. For hair that falls from standing out and is shaken,
    /// this keeps nine tenths of the volume; 10 keeps three quarters, and no method a quarter (`hairspring
    /// bench --hair-hair`).
    pub recovery_rate: f32,
}

impl Default for Volume {
    fn default() -> Self {
        Self { method: VolumeMethod::Off, cell: None, friction: 3.0, pressure: 0.5, recovery_rate: 30.0 }
    }
}

/// Settings of contact between individual strands, for guides and small scenes. It is the reference for the
/// volume methods, and acts between the simulated strands of all grooms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Neighbours {
    /// Whether strands collide. Default false: they pass through each other.
    pub on: bool,
    /// Contact radius of a strand [m], above 0: a strand represents the hairs around it. It is limited
    /// everywhere to half the distance to the nearest other strand at rest, so that nothing touches at rest.
    /// `None`, the default: half the mean of that distance, and at most half a segment.
    pub radius: Option<f32>,
    /// Coulomb friction coefficient between strands [1], 0 or more. Default 0.3, a mean value: because of the
    /// scales, hair slides more easily toward the tip than toward the root.
    pub friction: f32,
    /// Stiction: normal and tangential force that two segments in contact resist, in addition to friction,
    /// before they separate [N], 0 or more. Default 0. A hair of 25 cm weighs 1.6e-5 N.
    pub stiction: f32,
}

impl Default for Neighbours {
    fn default() -> Self {
        Self { on: false, radius: None, friction: 0.3, stiction: 0.0 }
    }
}

/// Method that keeps hair from being compressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VolumeMethod {
    /// None.
    #[default]
    Off,
    /// A force along the negative density gradient where hair is denser than at rest (Petrovic 2005). Cheap,
    /// but soft.
    Density,
    /// Velocities that converge on full cells are projected out, and lost volume is recovered (McAdams 2009).
    /// Firm, at the cost of a linear solve every 1/240 s.
    Incompressible,
}

impl VolumeMethod {
    /// All methods.
    pub const ALL: [VolumeMethod; 3] = [Self::Off, Self::Density, Self::Incompressible];

    /// Returns the name used in scene files and on the command line.
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
    /// Name of the body joint that moves it; `None`: joint 0, or fixed without a body.
    #[serde(default)]
    pub joint: Option<String>,
    /// The shape, in the space of the body's rest pose [m].
    pub shape: Shape,
}

/// The shapes of a [`Collider`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Shape {
    /// A sphere.
    Sphere {
        /// Center [m].
        center: Vec3,
        /// Radius [m], above 0.
        radius: f32,
    },
    /// All points nearer than `radius` to the segment from `a` to `b`.
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
        /// Center [m].
        center: Vec3,
        /// Lengths of its edges [m], above 0.
        size: Vec3,
        /// Rotation about X, then Y, then Z [degrees]. Default 0.
        #[serde(default)]
        rotation: Vec3,
    },
    /// A half-space, on the side of a plane that `normal` points away from: a floor, a wall, a slope.
    Plane {
        /// A point on the plane [m].
        point: Vec3,
        /// Direction out of the solid, of any length above 0.
        normal: Vec3,
    },
    /// The convex hull of points: a shoulder, a stone, a brush.
    Hull {
        /// Points of the hull [m], four or more. Default: the vertices of `file`.
        #[serde(default)]
        points: Vec<Vec3>,
        /// A mesh file. The scene reader replaces `points` with its vertices; this crate does not open it.
        #[serde(default)]
        file: Option<PathBuf>,
        /// Meters per unit of `file` [m], above 0. Default: given by the format, or guessed and reported.
        #[serde(default)]
        scale: Option<f32>,
    },
}

impl Shape {
    /// Returns the collider shape; `None` for a hull whose points span no volume.
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
