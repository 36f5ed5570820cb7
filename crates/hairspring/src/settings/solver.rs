//! Settings of the solver: time steps, integrator, contact.

use super::check::{Check, Validate, above_0, check};

/// Settings of time steps and contact.
///
/// Fields may be added: write `..Default::default()`. For an example, see [`settings`](crate::settings).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Solver {
    /// Number of substeps in a frame of 1/60 s, 1 to 1024. Default 4: substeps of 1/240 s at any frame rate.
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
///
/// For an example, see [`settings`](crate::settings).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
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
///
/// For an example, see [`settings`](crate::settings).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
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
///
/// For an example, see [`settings`](crate::settings).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
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

impl Validate for Solver {
    fn checks(&self) -> Vec<Check> {
        vec![
            check((1..=1024).contains(&self.substeps), "substeps", "1 to 1024"),
            check((0..=20).contains(&self.projection_iterations), "projection_iterations", "0 to 20"),
            check((0.0..=60.0).contains(&self.preroll), "preroll", "0 to 60 [s]"),
            check((0.0..=1.0).contains(&self.inertia), "inertia", "0 to 1"),
            check(above_0(Some(self.teleport_distance)), "teleport_distance", "above 0 [m]"),
        ]
    }
}
