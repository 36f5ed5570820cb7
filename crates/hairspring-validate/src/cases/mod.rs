//! The experiments, one in each file: setup, measurement and tolerance.

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

/// Simulation method of an experiment: the defaults of a user's scene.
const USUAL: Method =
    Method { points: 64, substeps: 4, model: Model::Auto, integrator: Integrator::BackwardEuler };

/// Method of an experiment that twists a straight, round strand: `auto` would omit twist.
const TWISTED: Method = Method { model: Model::Rod, ..USUAL };

/// GJ/EI of human hair, for experiments that do not depend on it.
const HAIR: f64 = 0.458;

/// Tolerance of static shapes: relative error.
const STATIC: f64 = 0.02;

/// Tolerance of frequencies: relative error.
const FREQUENCY: f64 = 0.02;

/// Tolerance of stability thresholds: relative error.
const THRESHOLD: f64 = 0.05;

/// Tolerance of friction: relative error.
const FRICTION: f64 = 0.03;

/// Tolerance of angles in the wind: relative error.
const AIR: f64 = 0.03;

/// Returns how many times as long a segment is as one of 64 points.
fn times_as_long(method: &Method) -> f64 {
    63.0 / f64::from(method.points - 1)
}

/// Why the springs model does not pass where joints are stiff and short.
pub(super) const HELD_BACK: &str = "the springs model is solved in single precision, which cannot represent the fiber's joint stiffness at this number of points";

/// Why the springs model swings with a smaller amplitude and a lower frequency.
const SPRINGS_ARE_BRAKED: &str = "the springs model is damped more than the other models, because its swing would otherwise leave its plane";

/// Why the curvature model does not pass where a strand twists.
const NO_TWIST: &str = "the model has no twist";
