//! Comparison of the simulation with closed-form solutions.
//!
//! A [`Case`] is one experiment with a strand whose outcome is known: a cantilever's droop, the weight at
//! which an upright strand buckles, the period of a swing. Its reference is computed in f64 for any
//! parameter, without code of the simulation (`reference/`). Its measurement uses the actual
//! [`hairspring::simulation::Simulation`], as a user would set it up (`cases/`).
//!
//! `reference` and `specimen` (a test strand) do not depend on cases. `southwell` and `ring_down` are
//! measurement methods that several experiments share. [`Case::run`] compares the two numbers.

pub mod bench;
mod cases;
mod failure;
mod plot;
mod reference;
mod ring_down;
mod southwell;
mod specimen;
pub mod swing;

pub use failure::Failure;
pub use plot::{Axis, Curve, Plot};
pub use reference::cylinder::drag_coefficient;

use hairspring::{material::Model, settings::Integrator};
use std::fmt;

/// All cases, in the order of the documentation's page on closed forms.
pub const CASES: [&Case; 17] = [
    &cases::heavy_cantilever::CASE,
    &cases::end_load::CASE,
    &cases::pressed_elastica::CASE,
    &cases::helix_spring::CASE,
    &cases::bend_twist::CASE,
    &cases::greenhill::CASE,
    &cases::michell::CASE,
    &cases::lateral_buckling::CASE,
    &cases::hanging_chain::CASE,
    &cases::beam_modes::CASE,
    &cases::pendulum::CASE,
    &cases::catenary::CASE,
    &cases::incline::CASE,
    &cases::capstan::CASE,
    &cases::thin_rod::CASE,
    &cases::wind_angle::CASE,
    &cases::rest::CASE,
];

/// Returns the case with this name, as in [`Case::name`].
pub fn case(name: &str) -> Option<&'static Case> {
    CASES.into_iter().find(|c| c.name == name)
}

/// A parameter of a closed form.
#[derive(Debug)]
pub struct Symbol {
    /// Name on a command line, such as `gamma`.
    pub name: &'static str,
    /// Meaning, such as `Γ = ρgAL³/EI`.
    pub meaning: &'static str,
}

/// Γ.
pub const GAMMA: Symbol = Symbol { name: "gamma", meaning: "weight over bending stiffness, Γ = ρgAL³/EI" };
/// α.
pub const ALPHA: Symbol = Symbol { name: "alpha", meaning: "tip load over bending stiffness, α = PL²/EI" };
/// κL.
pub const KAPPA_L: Symbol =
    Symbol { name: "kappa-l", meaning: "natural turn of the whole strand, κL [rad]" };
/// GJ/EI.
pub const GJ_OVER_EI: Symbol =
    Symbol { name: "gj-over-ei", meaning: "twisting over bending stiffness, GJ/EI" };
/// Turns.
pub const TURNS: Symbol = Symbol { name: "turns", meaning: "turns of a helix" };
/// H/L.
pub const HEIGHT: Symbol = Symbol { name: "height", meaning: "height of the clamp over the plane, H/L" };
/// R.
pub const ROD_RADIUS_MM: Symbol = Symbol { name: "rod-radius-mm", meaning: "radius of a rod [mm]" };
/// θ₀.
pub const AMPLITUDE_DEG: Symbol = Symbol { name: "amplitude-deg", meaning: "amplitude of a swing [degrees]" };
/// L/span.
pub const LENGTH_OVER_SPAN: Symbol =
    Symbol { name: "length-over-span", meaning: "length over the distance of the supports, L/span" };
/// μ.
pub const MU: Symbol = Symbol { name: "mu", meaning: "coefficient of friction, μ" };
/// U.
pub const WIND_SPEED: Symbol = Symbol { name: "wind-speed", meaning: "speed of the wind, U [m/s]" };

/// All symbols.
pub const SYMBOLS: [&Symbol; 11] = [
    &GAMMA,
    &ALPHA,
    &KAPPA_L,
    &GJ_OVER_EI,
    &TURNS,
    &HEIGHT,
    &ROD_RADIUS_MM,
    &AMPLITUDE_DEG,
    &LENGTH_OVER_SPAN,
    &MU,
    &WIND_SPEED,
];

/// A parameter of a case and its range.
#[derive(Debug)]
pub struct Parameter {
    /// The parameter.
    pub symbol: &'static Symbol,
    /// Smallest and largest value that the experiment is meant for.
    pub range: (f64, f64),
}

/// A number that a case measures.
#[derive(Debug)]
pub struct Quantity {
    /// Name, such as `drop H/L`.
    pub name: &'static str,
    /// Largest relative error that passes; if the reference is 0, the largest absolute value.
    pub tolerance: f64,
}

/// Simulation method of an experiment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// Points of the strand, 3 to 1,024.
    pub points: u32,
    /// Substeps of a frame of 1/60 s, 1 to 1024.
    pub substeps: u32,
    /// Elastic model.
    pub model: Model,
    /// Integrator.
    pub integrator: Integrator,
}

/// An experiment with a known outcome.
pub struct Case {
    /// Name, such as `heavy-cantilever`.
    pub name: &'static str,
    /// The experiment in a sentence.
    pub about: &'static str,
    /// Its parameters, in the order of the values in `defaults`.
    pub parameters: &'static [Parameter],
    /// Default values: one set of parameters after the other; `&[&[]]` without parameters.
    pub defaults: &'static [&'static [f64]],
    /// The measured quantities.
    pub quantities: &'static [Quantity],
    /// Default simulation method.
    pub method: Method,
    /// Whether the number of points is fixed.
    pub points_fixed: bool,
    /// Smallest number of points with which the experiment can be set up.
    pub min_points: u32,
    /// Number of points at which the case passes its defaults with the default method.
    pub enough_points: u32,
    /// Elastic models with which the case does not pass its defaults, at the default number of points.
    pub fails_with: &'static [Model],
    /// Returns why a run with these parameter values and this method fails, if it does and the cause is special to the case.
    reason: fn(&[f64], &Method) -> Option<String>,
    reference: fn(&[f64]) -> Result<Vec<f64>, Failure>,
    measure: fn(&[f64], Method) -> Result<Vec<f64>, Failure>,
    sweep: plot::Sweep,
}

/// One measured number and its reference.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name of the case.
    pub case: &'static str,
    /// Values of the case's parameters, by symbol.
    pub parameters: Vec<(&'static str, f64)>,
    /// Simulation method.
    pub method: Method,
    /// Name of the quantity.
    pub quantity: &'static str,
    /// The measured value, or why there is none.
    pub measured: Result<f64, Failure>,
    /// The reference value, or why there is none.
    pub reference: Result<f64, Failure>,
    /// Largest relative error that passes; if the reference is 0, the largest absolute value.
    pub tolerance: f64,
}

impl Outcome {
    /// Returns |measured − reference| / |reference|, if both exist and the reference is not 0.
    pub fn relative_error(&self) -> Option<f64> {
        match (&self.measured, &self.reference) {
            (_, Ok(0.0)) => None,
            (Ok(measured), Ok(reference)) => Some((measured - reference).abs() / reference.abs()),
            _ => None,
        }
    }

    /// Returns why the outcome fails, in one sentence; `None` if it passes.
    pub fn reason(&self) -> Option<String> {
        let case = case(self.case).filter(|_| !self.pass())?;
        let Method { points, substeps, model, integrator } = self.method;
        if let Err(why @ Failure::TooFewPoints(_)) = self.measured {
            return Some(why.to_string());
        }
        if integrator != case.method.integrator {
            return Some(format!(
                "the tolerance is for the integrator {}, and {} was used",
                case.method.integrator.name(),
                integrator.name()
            ));
        }
        let values: Vec<f64> = self.parameters.iter().map(|(_, value)| *value).collect();
        let special = (case.reason)(&values, &self.method);
        Some(special.unwrap_or_else(|| match (&self.measured, &self.reference) {
            // Applies to all cases, at more points than each has by default.
            _ if model == Model::Springs && points >= 128 => cases::HELD_BACK.into(),
            _ if points < case.enough_points => format!(
                "{points} points are {} segments, too few for the strand's shape and motion; with {} points the default \
                 parameters pass",
                points - 1,
                case.enough_points
            ),
            _ if substeps < case.method.substeps => format!(
                "the tolerance is for {} substeps per frame, and {substeps} were used",
                case.method.substeps
            ),
            (Err(why), _) | (_, Err(why)) => why.to_string(),
            _ => format!("no cause is known for {points} points and {substeps} substeps per frame with these parameters"),
        }))
    }

    /// Returns whether the error is within the tolerance. A failed measurement does not pass.
    pub fn pass(&self) -> bool {
        match (&self.measured, &self.reference) {
            (Ok(measured), Ok(0.0)) => measured.abs() <= self.tolerance,
            _ => self.relative_error().is_some_and(|e| e <= self.tolerance),
        }
    }
}

impl Case {
    /// Runs the experiment with the parameter values `values`, in the order of the parameters. Returns one
    /// outcome for each quantity.
    ///
    /// # Panics
    /// If `values` is not as long as the case's parameters.
    pub fn run(&self, values: &[f64], method: Method) -> Vec<Outcome> {
        assert_eq!(values.len(), self.parameters.len(), "one value for each parameter of {}", self.name);
        let (reference, measured) =
            rayon::join(|| (self.reference)(values), || self.measured(values, method));
        let pick = |from: &Result<Vec<f64>, Failure>, k: usize| match from {
            Ok(all) if all[k].is_finite() => Ok(all[k]),
            Ok(_) => Err(Failure::NotFinite),
            Err(why) => Err(*why),
        };
        let parameters = self.parameters.iter().map(|p| p.symbol.name).zip(values.iter().copied());
        let parameters: Vec<_> = parameters.collect();
        let outcome = |(k, quantity): (usize, &Quantity)| Outcome {
            case: self.name,
            parameters: parameters.clone(),
            method,
            quantity: quantity.name,
            measured: pick(&measured, k),
            reference: pick(&reference, k),
            tolerance: quantity.tolerance,
        };
        self.quantities.iter().enumerate().map(outcome).collect()
    }
}

impl Case {
    /// Measures the quantities if the experiment can be set up with this number of points.
    fn measured(&self, values: &[f64], method: Method) -> Result<Vec<f64>, Failure> {
        match method.points < self.min_points {
            true => Err(Failure::TooFewPoints(self.min_points)),
            false => (self.measure)(values, method),
        }
    }
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Case").field("name", &self.name).finish_non_exhaustive()
    }
}
