//! Whether the simulation is physics: what it does, held against what closed forms say.
//!
//! A [`Case`] is one experiment with a strand whose outcome is known: a cantilever's droop, the weight at which a standing strand
//! gives way, the period of a swing. Its reference is computed for any parameter in f64, without a line of the simulation
//! (`reference/`); its measurement is taken on the real [`hairspring::simulation::Simulation`], as a user would set it up (`cases/`).
//!
//! Data goes one way: `reference` and `specimen` (a strand on the bench) know nothing of cases, `southwell` and `ring_down` are
//! what several experiments measure with, and [`Case::run`] puts the two numbers side by side.

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

/// All cases, in the order of the closed forms' page.
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

/// The case of this name, as in [`Case::name`].
pub fn case(name: &str) -> Option<&'static Case> {
    CASES.into_iter().find(|c| c.name == name)
}

/// A parameter of a closed form.
#[derive(Debug)]
pub struct Symbol {
    /// Its name on a command line, as `gamma`.
    pub name: &'static str,
    /// What it stands for, as `Γ = ρgAL³/EI`.
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

/// How a case's parameter may be chosen.
#[derive(Debug)]
pub struct Parameter {
    /// What it is.
    pub symbol: &'static Symbol,
    /// Least and greatest value that the experiment is meant for.
    pub range: (f64, f64),
}

/// A number that a case measures.
#[derive(Debug)]
pub struct Quantity {
    /// Its name, as `drop H/L`.
    pub name: &'static str,
    /// Largest relative error that passes; where the reference is 0, the largest value.
    pub tolerance: f64,
}

/// How the strand of an experiment is simulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// Points of the strand, 3 to 1,024.
    pub points: u32,
    /// Substeps of a frame of 1/60 s, 1 to 64.
    pub substeps: u32,
    /// Elastic model.
    pub model: Model,
    /// Integrator.
    pub integrator: Integrator,
}

/// An experiment with a known outcome.
pub struct Case {
    /// Its name, as `heavy-cantilever`.
    pub name: &'static str,
    /// The experiment in a sentence.
    pub about: &'static str,
    /// Its parameters, in the order of the values in `defaults`.
    pub parameters: &'static [Parameter],
    /// The values that it runs with unless told others, one set of parameters after the other; `&[&[]]` without parameters.
    pub defaults: &'static [&'static [f64]],
    /// What it measures.
    pub quantities: &'static [Quantity],
    /// How it is simulated unless told otherwise.
    pub method: Method,
    /// Whether it is about so many points and no others.
    pub points_fixed: bool,
    /// Why it does not pass at its defaults with an elastic model, or with so few points, where it does not.
    pub out_of_reach: fn(Method) -> Option<&'static str>,
    reference: fn(&[f64]) -> Result<Vec<f64>, Failure>,
    measure: fn(&[f64], Method) -> Result<Vec<f64>, Failure>,
    sweep: plot::Sweep,
}

/// One number held against its reference.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name of the case.
    pub case: &'static str,
    /// Values of the case's parameters, by symbol.
    pub parameters: Vec<(&'static str, f64)>,
    /// How it was simulated.
    pub method: Method,
    /// Name of the quantity.
    pub quantity: &'static str,
    /// What the simulation did; or why it gave no number.
    pub measured: Result<f64, Failure>,
    /// What the closed form says; or why it says nothing.
    pub reference: Result<f64, Failure>,
    /// Largest relative error that passes; where the reference is 0, the largest value.
    pub tolerance: f64,
}

impl Outcome {
    /// |measured − reference| / |reference|, where there are both and the reference is not 0.
    pub fn relative_error(&self) -> Option<f64> {
        match (&self.measured, &self.reference) {
            (_, Ok(0.0)) => None,
            (Ok(measured), Ok(reference)) => Some((measured - reference).abs() / reference.abs()),
            _ => None,
        }
    }

    /// Why it fails, where that is known of the elastic model or of so few points.
    pub fn reason(&self) -> Option<&'static str> {
        let of = |case: &Case| (case.out_of_reach)(self.method);
        // Of all cases alike, at more points than each has by default.
        let held_back = self.method.model == Model::Springs && self.method.points >= 128;
        let any = held_back.then_some(cases::HELD_BACK);
        if self.pass() { None } else { case(self.case).and_then(of).or(any) }
    }

    /// Whether the error is within the tolerance; what could not be measured does not pass.
    pub fn pass(&self) -> bool {
        match (&self.measured, &self.reference) {
            (Ok(measured), Ok(0.0)) => measured.abs() <= self.tolerance,
            _ => self.relative_error().is_some_and(|e| e <= self.tolerance),
        }
    }
}

impl Case {
    /// Runs the experiment at `values` of its parameters, in their order; one outcome for each quantity.
    ///
    /// # Panics
    /// If `values` is not as long as the case's parameters.
    pub fn run(&self, values: &[f64], method: Method) -> Vec<Outcome> {
        assert_eq!(values.len(), self.parameters.len(), "one value for each parameter of {}", self.name);
        let (reference, measured) =
            rayon::join(|| (self.reference)(values), || (self.measure)(values, method));
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

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Case").field("name", &self.name).finish_non_exhaustive()
    }
}
