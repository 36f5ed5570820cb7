//! Plots of cases: the reference as a curve, with measured points.

use super::{Case, Failure, Method};
use rayon::prelude::*;

/// One axis of a plot.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Label with unit.
    pub label: String,
    /// Whether the axis is logarithmic.
    pub log: bool,
}

/// One quantity of a plot.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Name of the quantity.
    pub name: String,
    /// Reference points, from left to right.
    pub reference: Vec<[f64; 2]>,
    /// Measured points, without those whose measurement failed.
    pub measured: Vec<[f64; 2]>,
}

/// A plot.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Quantities of the plot.
    pub curves: Vec<Curve>,
}

/// The horizontal axis of a case's plot.
pub(super) enum Sweep {
    /// The parameter `index`, from `from` to `to`; the others have their first default.
    Parameter { index: usize, from: f64, to: f64, log: bool },
    /// The index of the quantity, for modes.
    Modes { label: &'static str },
    /// A plot specific to the case.
    Own(fn(Method) -> Plot),
}

/// Number of points at which the reference is computed.
const CURVE: usize = 48;

/// Number of points at which the simulation runs.
const POINTS: usize = 9;

impl Case {
    /// Returns the case's plot. Runs several simulations in parallel.
    pub fn plot(&self, method: Method) -> Plot {
        match &self.sweep {
            Sweep::Own(plot) => plot(method),
            Sweep::Modes { label } => self.plot_modes(method, label),
            &Sweep::Parameter { index, from, to, log } => {
                let values = |x: f64| {
                    let mut values = self.defaults[0].to_vec();
                    values[index] = x;
                    values
                };
                let (reference, measured) = rayon::join(
                    || evaluate(&places(from, to, log, CURVE), |x| (self.reference)(&values(x))),
                    || evaluate(&places(from, to, log, POINTS), |x| self.measured(&values(x), method)),
                );
                let curves = self.quantities.iter().enumerate().map(|(k, quantity)| {
                    let pick = |from: &[(f64, Vec<f64>)]| from.iter().map(|(x, y)| [*x, y[k]]).collect();
                    Curve {
                        name: quantity.name.into(),
                        reference: pick(&reference),
                        measured: pick(&measured),
                    }
                });
                let curves: Vec<Curve> = curves.collect();
                let x = Axis { label: self.parameters[index].symbol.meaning.into(), log };
                Plot { x, y: value_axis(self, &curves), curves }
            }
        }
    }

    fn plot_modes(&self, method: Method, label: &str) -> Plot {
        let outcomes = self.run(&[], method);
        let number = |values: Vec<Option<f64>>| -> Vec<[f64; 2]> {
            let numbered = values.into_iter().enumerate();
            numbered.filter_map(|(k, v)| Some([(k + 1) as f64, v?])).collect()
        };
        let curve = Curve {
            name: label.into(),
            reference: number(outcomes.iter().map(|o| o.reference.ok()).collect()),
            measured: number(outcomes.iter().map(|o| o.measured.ok()).collect()),
        };
        let x = Axis { label: "mode".into(), log: false };
        Plot { x, y: Axis { label: label.into(), log: false }, curves: vec![curve] }
    }
}

/// Returns the vertical axis: its label is the name of the only quantity, and it is logarithmic if the values
/// span more than two decades.
fn value_axis(case: &Case, curves: &[Curve]) -> Axis {
    let values = curves.iter().flat_map(|c| c.reference.iter().map(|p| p[1]));
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
    let label = if let [only] = case.quantities { only.name.into() } else { String::new() };
    Axis { label, log: low > 0.0 && high > 100.0 * low }
}

/// Returns `count` values from `from` to `to`.
pub(super) fn places(from: f64, to: f64, log: bool, count: usize) -> Vec<f64> {
    let between = |k: usize| {
        let t = k as f64 / (count - 1) as f64;
        if log { from * (to / from).powf(t) } else { from + (to - from) * t }
    };
    (0..count).map(between).collect()
}

/// Evaluates `f` at each place, and omits failures.
pub(super) fn evaluate<T: Send>(
    places: &[f64],
    f: impl Fn(f64) -> Result<T, Failure> + Sync,
) -> Vec<(f64, T)> {
    places.par_iter().filter_map(|&x| Some((x, f(x).ok()?))).collect()
}
