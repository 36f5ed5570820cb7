//! `hairspring validate`: compares the simulation with closed-form solutions.

mod report;
mod table;

use crate::{
    console::{Console, print_json, print_line},
    fault::Fault,
    interrupt, output,
    report::number,
    totals::counted,
};
use clap::Parser;
use hairspring::{material::Model, settings::Integrator};
use hairspring_validate::{CASES, Case, Method, Outcome, SYMBOLS, case};
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// Compares the simulation with closed-form solutions of mechanics.
///
/// Each case is an experiment with one strand whose result is known: how far a cantilever droops, at which
/// weight a standing strand buckles, how long the period of a wide swing is. The reference is computed in f64
/// for any parameter, from the differential equation, an elliptic integral or an eigenvalue. The measured
/// value is taken from a simulation. Without CASE, all cases run with their default parameters.
#[derive(Parser)]
#[command(after_help = after_help())]
pub struct Options {
    /// Case to run, one of those below [default: all]
    case: Option<String>,

    /// Γ = ρgAL³/EI, weight over bending stiffness
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    gamma: Option<f64>,

    /// α = PL²/EI, tip load over bending stiffness
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    alpha: Option<f64>,

    /// κL, natural rotation over the whole strand [rad]
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    kappa_l: Option<f64>,

    /// GJ/EI, twisting stiffness over bending stiffness
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    gj_over_ei: Option<f64>,

    /// Number of turns of a helix
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    turns: Option<f64>,

    /// H/L, height of a clamp above a plane
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    height: Option<f64>,

    /// Radius of a rod [mm]
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    rod_radius_mm: Option<f64>,

    /// Amplitude of a swing [degrees]
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    amplitude_deg: Option<f64>,

    /// L/span, length over the distance between the supports
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    length_over_span: Option<f64>,

    /// μ, coefficient of friction
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    mu: Option<f64>,

    /// U, wind speed [m/s]
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    wind_speed: Option<f64>,

    /// Points of the strand, 3 to 1024 [default: 64; helix-spring: 32; pendulum: always 3]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(3..=1024), help_heading = "How it is simulated")]
    points: Option<u32>,

    /// Substeps per frame of 1/60 s, 1 to 1024 [default: 4; pendulum: 8]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024), help_heading = "How it is simulated")]
    substeps: Option<u32>,

    /// Elastic model: auto, springs, curvature, rod [default: auto; michell: rod]
    #[arg(long, value_name = "NAME", help_heading = "How it is simulated")]
    model: Option<String>,

    /// Time integrator: explicit-euler, verlet, backward-euler, bdf2, local-global, ftl, dftl [default:
    /// backward-euler]
    #[arg(long, value_name = "NAME", help_heading = "How it is simulated")]
    integrator: Option<String>,

    /// Write an HTML page with a plot of each case: the reference as a curve and measured points
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,

    /// Print a Markdown table of the largest error of each case, for every model at 32 to 1,024 points, and
    /// the reason where there is no value
    #[arg(long, conflicts_with_all = ["points", "model", "substeps", "integrator", "report", "json"])]
    table: bool,

    /// Print the results as JSON
    #[arg(long)]
    json: bool,
}

/// Lists the cases with their descriptions and parameters.
fn after_help() -> String {
    let mut text = String::from("Cases and their parameters:\n");
    for case in CASES {
        text += &format!("  {:<18}{}\n", case.name, case.about);
        for (k, p) in case.parameters.iter().enumerate() {
            let defaults: Vec<String> = case.defaults.iter().map(|d| number(d[k])).collect();
            let (low, high) = p.range;
            text += &format!(
                "  {:<18}--{} {} to {} [default: {}]\n",
                "",
                p.symbol.name,
                number(low),
                number(high),
                distinct(defaults).join(", ")
            );
        }
    }
    text + "
Examples:
  hairspring validate
  hairspring validate heavy-cantilever --gamma 30 --points 128
  hairspring validate bend-twist --kappa-l 12 --json
  hairspring validate --report validation.html

The exit code is 1 if a measured value is outside its tolerance."
}

/// The values without duplicates.
fn distinct(mut values: Vec<String>) -> Vec<String> {
    let mut seen = Vec::new();
    values.retain(|v| {
        !seen.contains(v) && {
            seen.push(v.clone());
            true
        }
    });
    values
}

/// One run of a case.
struct Job {
    case: &'static Case,
    values: Vec<f64>,
    method: Method,
}

/// Runs the command.
pub fn run(options: &Options, console: Console) -> Result<(), Fault> {
    if let Some(path) = &options.report {
        output::check_report(path)?;
    }
    let jobs = jobs(options)?;
    if options.table {
        let mut cases: Vec<&'static Case> = jobs.iter().map(|job| job.case).collect();
        cases.dedup_by_key(|case| case.name);
        interrupt::finish_current("the current cells");
        return table::run(&cases, console);
    }
    let outcomes: Vec<Outcome> =
        jobs.par_iter().flat_map_iter(|job| job.case.run(&job.values, job.method)).collect();
    if options.json {
        print_json(&Value::Array(outcomes.iter().map(as_json).collect()));
    } else {
        print_table(&outcomes);
    }
    if let Some(path) = &options.report {
        let page = report::page(&jobs, &outcomes);
        output::write_whole(path, page.as_bytes())?;
        console.doing(format_args!("wrote the report {}", path.display()));
    }
    let failed = outcomes.iter().filter(|o| !o.pass()).count();
    match failed {
        0 => Ok(()),
        _ => Err(Fault::Invalid(format!(
            "{failed} of {} measured values are outside their tolerance",
            outcomes.len()
        ))),
    }
}

/// Returns the runs that the command line requests: the named case or all cases, with the given parameters or
/// their defaults.
fn jobs(options: &Options) -> Result<Vec<Job>, Fault> {
    let cases: Vec<&'static Case> = match &options.case {
        None => CASES.to_vec(),
        Some(name) => vec![case(name).ok_or_else(|| {
            let names: Vec<&str> = CASES.iter().map(|c| c.name).collect();
            Fault::Usage(format!("unknown case '{name}'; expected one of: {}", names.join(", ")))
        })?],
    };
    for (symbol, _) in given(options) {
        let takers = CASES.iter().filter(|c| c.parameters.iter().any(|p| p.symbol.name == symbol));
        let takers: Vec<&str> = takers.map(|c| c.name).collect();
        if options.case.is_none() {
            let text = format!("--{symbol} needs a case that has it: {}", takers.join(", "));
            return Err(Fault::Usage(text));
        }
        if !takers.contains(&cases[0].name) {
            let text = format!(
                "the case {} has no --{symbol}; cases that have it: {}",
                cases[0].name,
                takers.join(", ")
            );
            return Err(Fault::Usage(text));
        }
    }
    let mut jobs = Vec::new();
    for case in cases {
        let requested = options.points.filter(|_| !case.points_fixed || options.case.is_some());
        if case.points_fixed && requested.is_some_and(|points| points != case.method.points) {
            let text = format!("the case {} needs a strand of {} points", case.name, case.method.points);
            return Err(Fault::Usage(text));
        }
        let method = Method {
            points: requested.unwrap_or(case.method.points),
            substeps: options.substeps.unwrap_or(case.method.substeps),
            model: chosen("model", &options.model, &Model::ALL, Model::name)?.unwrap_or(case.method.model),
            integrator: chosen("integrator", &options.integrator, &Integrator::ALL, Integrator::name)?
                .unwrap_or(case.method.integrator),
        };
        let mut sets: Vec<Vec<f64>> = Vec::new();
        for default in case.defaults {
            let mut values = default.to_vec();
            for (value, parameter) in values.iter_mut().zip(case.parameters) {
                if let Some((_, x)) = given(options).find(|(s, _)| *s == parameter.symbol.name) {
                    let (low, high) = parameter.range;
                    if !(low..=high).contains(&x) {
                        return Err(Fault::Usage(format!(
                            "--{} is {x}; the case {} accepts {low} to {high}",
                            parameter.symbol.name, case.name
                        )));
                    }
                    *value = x;
                }
            }
            if !sets.contains(&values) {
                sets.push(values);
            }
        }
        jobs.extend(sets.into_iter().map(|values| Job { case, values, method }));
    }
    Ok(jobs)
}

/// Finds the setting called `requested` in `all`.
fn chosen<T: Copy>(
    what: &str,
    requested: &Option<String>,
    all: &[T],
    name: fn(T) -> &'static str,
) -> Result<Option<T>, Fault> {
    let Some(requested) = requested else { return Ok(None) };
    let found = all.iter().copied().find(|t| name(*t) == requested);
    let there: Vec<&str> = all.iter().map(|t| name(*t)).collect();
    found.map(Some).ok_or_else(|| {
        Fault::Usage(format!("unknown {what} '{requested}'; expected one of: {}", there.join(", ")))
    })
}

/// The parameters that the command line sets.
fn given(options: &Options) -> impl Iterator<Item = (&'static str, f64)> {
    let of = |name| match name {
        "gamma" => options.gamma,
        "alpha" => options.alpha,
        "kappa-l" => options.kappa_l,
        "gj-over-ei" => options.gj_over_ei,
        "turns" => options.turns,
        "height" => options.height,
        "rod-radius-mm" => options.rod_radius_mm,
        "amplitude-deg" => options.amplitude_deg,
        "length-over-span" => options.length_over_span,
        "mu" => options.mu,
        "wind-speed" => options.wind_speed,
        _ => None,
    };
    let all: Vec<_> = SYMBOLS.iter().filter_map(|s| Some((s.name, of(s.name)?))).collect();
    all.into_iter()
}

/// An outcome as JSON with the documented keys. Values that could not be measured are null.
fn as_json(outcome: &Outcome) -> Value {
    let mut parameters = Map::new();
    for (name, value) in &outcome.parameters {
        parameters.insert((*name).into(), json!(value));
    }
    let Method { points, substeps, model, integrator } = outcome.method;
    let how: [(&str, Value); 4] = [
        ("points", json!(points)),
        ("substeps", json!(substeps)),
        ("model", json!(model.name())),
        ("integrator", json!(integrator.name())),
    ];
    parameters.extend(how.map(|(key, value)| (key.into(), value)));
    json!({
        "case": outcome.case,
        "parameters": parameters,
        "quantity": outcome.quantity,
        "measured": outcome.measured.ok(),
        "reference": outcome.reference.ok(),
        "relative_error": outcome.relative_error(),
        "tolerance": outcome.tolerance,
        "pass": outcome.pass(),
    })
}

/// Prints the outcomes as a table.
fn print_table(outcomes: &[Outcome]) {
    let rows: Vec<[String; 7]> = std::iter::once(
        ["case", "parameters", "quantity", "measured", "reference", "error", ""].map(String::from),
    )
    .chain(outcomes.iter().map(row))
    .collect();
    let width = |c: usize| rows.iter().map(|r| r[c].chars().count()).max().unwrap_or(0);
    let widths: [usize; 7] = std::array::from_fn(width);
    for row in &rows {
        let cells = row.iter().zip(widths).enumerate().map(|(c, (cell, width))| {
            // Numbers are right-aligned.
            if (3..6).contains(&c) { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
        });
        print_line(cells.collect::<Vec<_>>().join("  ").trim_end());
    }
    let passed = outcomes.iter().filter(|o| o.pass()).count();
    print_line(format_args!("{passed} of {} pass", outcomes.len()));
    let reasons = outcomes.iter().filter_map(|o| Some(format!("{}: {}", o.case, o.reason()?)));
    for reason in distinct(reasons.collect()) {
        print_line(reason);
    }
}

/// An outcome as a row of the table.
fn row(outcome: &Outcome) -> [String; 7] {
    let formatted = |value: &Result<f64, _>| value.map_or("-".into(), number);
    let verdict = match (&outcome.measured, &outcome.reference) {
        (_, Ok(0.0)) if outcome.pass() => format!("pass (below {})", number(outcome.tolerance)),
        (Ok(_), Ok(0.0)) => format!("FAIL (over {})", number(outcome.tolerance)),
        _ if outcome.pass() => format!("pass (within {} %)", number(outcome.tolerance * 100.0)),
        (Err(why), _) => format!("FAIL: {why}"),
        (_, Err(why)) => format!("FAIL: no reference, {why}"),
        _ => format!("FAIL (over {} %)", number(outcome.tolerance * 100.0)),
    };
    [
        outcome.case.into(),
        parameters(outcome),
        outcome.quantity.into(),
        formatted(&outcome.measured),
        formatted(&outcome.reference),
        outcome.relative_error().map_or("-".into(), |e| format!("{:.2} %", e * 100.0)),
        verdict,
    ]
}

/// Describes how an outcome was simulated.
fn how(outcome: &Outcome) -> String {
    let Method { points, substeps, model, integrator } = outcome.method;
    let (model, integrator) = (model.name(), integrator.name());
    format!(
        "{points} points, {} per frame, model {model}, {integrator}",
        counted(substeps as usize, "substep")
    )
}

/// The parameters of an outcome, as on the command line.
fn parameters(outcome: &Outcome) -> String {
    let one = |(name, value): &(&str, f64)| format!("{name} {}", number(*value));
    outcome.parameters.iter().map(one).collect::<Vec<_>>().join(", ")
}
