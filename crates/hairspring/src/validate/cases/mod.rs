//! The experiments, one file each: what is set up, what is read off, and how near it must come.

pub(super) mod beam_modes;
pub(super) mod bend_twist;
pub(super) mod greenhill;
pub(super) mod hanging_chain;
pub(super) mod heavy_cantilever;
pub(super) mod incline;
pub(super) mod pendulum;

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
