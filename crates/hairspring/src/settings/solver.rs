//! Settings of the solver: time steps, integrator, contact.

use super::{When, define_settings};

define_settings! {
    /// Settings of time steps and contact.
    ///
    /// Fields may be added: write `..Default::default()`. For an example, see [`settings`](crate::settings).
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Solver {
        /// Number of substeps in a frame of 1/60 s. The default gives substeps of 1/240 s at any frame rate.
        substeps: u32 = 4, "substeps per frame of 1/60 s", {1 to 1024};
        /// Whether rest shapes are computed so that the groom starts in static balance under gravity.
        sag_free: bool = true, "none", {switch};
        /// Pre-roll: time that hair falls from its authored pose before the scene begins. The resulting pose
        /// becomes the groom: `sag_free` puts it in balance, and a reset returns to it. For grown hair that stands
        /// off the skin, use 3; long hair is at rest by then.
        preroll: f32 = 0.0, ["s"], {0 to 60};
        /// Whether hair collides with the body's mesh.
        collide_body: bool = true, "none", {switch};
        /// How hair is kept out of colliders. `penalty`: a force in the solve (soft). `projection`: a move to the
        /// nearest free position (hard). `both`: the two together.
        contact: Response = Response::Both, "none", {words};
        /// Whether segments are also kept out of colliders between their points. Points alone are enough if no
        /// segment is longer than the radius of curvature of the colliders.
        segment_contacts: bool = true, "none", {switch};
        /// Iterations of fast projection in a substep, which keep segments at their length.
        ///
        /// The method is that of Goldenthal 2007. Strands of more than 32 points may take one iteration for every
        /// 32 points in place of each.
        projection_iterations: u32 = 3, "iterations", {0 to 20},
            when When::Is("solver.integrator", &["backward-euler", "bdf2"]);
        /// Time integrator of a substep. The explicit ones become unstable; they are for comparison.
        integrator: Integrator = Integrator::BackwardEuler, "none", {words};
        /// Accuracy of the solve in each substep. `normal`: one linear solve. `high`: Newton iterations until
        /// convergence.
        quality: Quality = Quality::Normal, "none", {words},
            when When::Is("solver.integrator", &["backward-euler", "bdf2", "local-global"]);
        /// Fraction of the head's motion that acts on the hair, for art direction: 0 (none, as if the head stood
        /// still) to 1 (all).
        inertia: f32 = 1.0, "fraction", {0 to 1};
        /// Teleport threshold. If the head moves farther than this in one frame, or rotates by more than 90°, in
        /// excess of its previous motion, the hair is moved rigidly with it.
        ///
        /// With the default, such a motion within 1/24 s would be an acceleration of 60 g. For frames longer than
        /// 1/24 s, both thresholds grow in proportion to the length.
        teleport_distance: f32 = 1.0, ["m"], {above 0};
        /// Whether the global shapes of the materials are applied. By default, no material has one.
        global_shape: bool = true, "none", {switch};
    }
}

define_settings! {
    /// Contact method for points and segments inside a collider (Sams 2014, §3.3).
    ///
    /// For an example, see [`settings`](crate::settings).
    #[non_exhaustive]
    choice Response {
        /// An implicit force in the solve, followed by projection of what is still inside to the nearest free
        /// position. The force carries weight and tension without jerks; the projection stops impacts.
        #[default]
        Both = "both",
        /// Only the implicit force. It is soft: hair that hits a surface sinks in and comes out again. Only
        /// backward Euler and BDF2 have contact in their solve; the other integrators project.
        Penalty = "penalty",
        /// Only the projection: inward motion is removed, and the point moves to the nearest free position (Liu
        /// 2013).
        Projection = "projection",
    }
}

define_settings! {
    /// Time integration method. All methods act on the same strands, for comparison.
    ///
    /// For an example, see [`settings`](crate::settings).
    #[non_exhaustive]
    choice Integrator {
        /// x⁺ = x + h v, v⁺ = v + h a with the fiber's own stiffness: a baseline that is unstable.
        ExplicitEuler = "explicit-euler",
        /// Position Verlet with the fiber's own stiffness (Müller 2008).
        Verlet = "verlet",
        /// The direct banded solver, linearized once, followed by fast projection and a strain limit (Baraff &
        /// Witkin 1998; Goldenthal 2007).
        #[default]
        BackwardEuler = "backward-euler",
        /// Like backward Euler, with the second-order backward differentiation formula: swings keep their
        /// amplitude (Choi & Ko 2002).
        Bdf2 = "bdf2",
        /// Local-global solver: a constant matrix, and a separate projection of every spring (Liu 2013). Always
        /// uses the curvature model.
        LocalGlobal = "local-global",
        /// Follow the leader: inextensible, without bending.
        Ftl = "ftl",
        /// Dynamic follow the leader, with corrected velocities (Müller 2012).
        Dftl = "dftl",
    }
}

impl Integrator {
    /// Returns whether the strain limit applies: no segment leaves a substep more than 1 % longer or shorter
    /// than at rest. The other integrators have no such limit.
    pub fn limits_strain(self) -> bool {
        matches!(self, Self::BackwardEuler | Self::Bdf2)
    }
}

define_settings! {
    /// Accuracy of the solve in each substep.
    ///
    /// For an example, see [`settings`](crate::settings).
    #[non_exhaustive]
    choice Quality {
        /// One linear solve (10 iterations of local-global).
        #[default]
        Normal = "normal",
        /// Newton iterations with a line search until convergence (40 iterations of local-global).
        High = "high",
    }
}
