//! Settings of the solver: time steps, integrator, contact.

use serde::{Deserialize, Serialize};

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
