//! The experiments, one file each: what is set up, what is read off, and how near it must come.

pub(super) mod beam_modes;
pub(super) mod bend_twist;
pub(super) mod capstan;
pub(super) mod catenary;
pub(super) mod end_load;
pub(super) mod greenhill;
pub(super) mod hanging_chain;
pub(super) mod heavy_cantilever;
pub(super) mod helix_spring;
pub(super) mod incline;
pub(super) mod lateral_buckling;
pub(super) mod michell;
pub(super) mod pendulum;
pub(super) mod pressed_elastica;
pub(super) mod rest;
pub(super) mod thin_rod;
pub(super) mod wind_angle;

use super::Method;
use hairspring::{material::Model, settings::Integrator};

/// How an experiment is simulated: as a user's scene is by default.
const USUAL: Method =
    Method { points: 64, substeps: 4, model: Model::Auto, integrator: Integrator::BackwardEuler };

/// How one at rest is in which a straight, round strand is twisted: `auto` would leave twist out.
const TWISTED: Method = Method { model: Model::Rod, ..USUAL };

/// Human hair's GJ/EI, where an experiment does not depend on it.
const HAIR: f64 = 0.458;

/// Relative error of a static shape that passes.
const STATIC: f64 = 0.02;

/// Relative error of a frequency that passes.
const FREQUENCY: f64 = 0.02;

/// Relative error of a threshold of stability that passes.
const THRESHOLD: f64 = 0.05;

/// Relative error of friction that passes.
const FRICTION: f64 = 0.03;

/// Relative error of an angle in the wind that passes.
const AIR: f64 = 0.03;

/// Why springs do not pass where joints are stiff and short.
pub(super) const HELD_BACK: &str = "springs are solved in single precision, which cannot hold joints as stiff as the fiber's in a strand of so many points";

/// Why springs swing less and slower than they ought to.
const SPRINGS_ARE_BRAKED: &str =
    "a truss is braked more than the other models, or its swing would leave its plane";

/// Why the curvature model does not pass where a strand twists.
const NO_TWIST: &str = "the model knows no twist";
