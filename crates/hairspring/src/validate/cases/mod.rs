//! The experiments, one file each: what is set up, what is read off, and how near it must come.

pub(super) mod beam_modes;
pub(super) mod bend_twist;
pub(super) mod capstan;
pub(super) mod catenary;
pub(super) mod end_load;
pub(super) mod greenhill;
pub(super) mod hanging_chain;
pub(super) mod heavy_cantilever;
pub(super) mod incline;
pub(super) mod lateral_buckling;
pub(super) mod michell;
pub(super) mod pendulum;

use super::Method;
use crate::{material::Model, scene::Integrator};

/// How an experiment at rest is simulated.
const STILL: Method =
    Method { points: 64, substeps: 4, model: Model::Auto, integrator: Integrator::BackwardEuler };

/// How one at rest is in which a straight, round strand is twisted: `auto` would leave twist out.
const TWISTED: Method = Method { model: Model::Rod, ..STILL };

/// How one in motion is: half the substep, because what swings fast is damped by the substep.
const MOVING: Method = Method { substeps: 8, ..STILL };

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

/// Why the curvature model does not pass where a strand twists.
const NO_TWIST: &str = "the model knows no twist";
