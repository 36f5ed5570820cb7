//! `hairspring validate`: the simulation held against closed forms.

mod report;
mod table;

use crate::{
    console::{Console, say},
    fault::Fault,
    interrupt, output,
    report::number,
};
use clap::Parser;
use hairspring::{material::Model, settings::Integrator};
use hairspring_validate::{CASES, Case, Method, Outcome, SYMBOLS, case};
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// Holds the simulation against closed forms of mechanics.
///
/// Each case is an experiment with one strand whose outcome is known: how far a cantilever droops, at which weight a standing
/// strand gives way, how long a wide swing lasts. The reference is computed for any parameter from the differential equation,
/// an elliptic integral or an eigenvalue in f64; the measured value is read off a simulation. Without CASE, all run at their
/// default parameters.
#[derive(Parser)]
#[command(after_help = after_help())]
pub struct Options {
    /// The experiment, one of those below [default: all]
    case: Option<String>,

    /// Γ = ρgAL³/EI, weight over bending stiffness
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    gamma: Option<f64>,

    /// α = PL²/EI, tip load over bending stiffness
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    alpha: Option<f64>,

    /// κL, natural turn of the whole strand [rad]
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    kappa_l: Option<f64>,

    /// GJ/EI, twisting over bending stiffness
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    gj_over_ei: Option<f64>,

    /// Turns of a helix
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    turns: Option<f64>,

    /// H/L, height of a clamp over a plane
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    height: Option<f64>,

    /// Radius of a rod [mm]
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    rod_radius_mm: Option<f64>,

    /// Amplitude of a swing [degrees]
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    amplitude_deg: Option<f64>,

    /// L/span, length over the distance of the supports
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    length_over_span: Option<f64>,

    /// μ, coefficient of friction
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    mu: Option<f64>,

    /// U, speed of the wind [m/s]
    #[arg(long, value_name = "X", help_heading = "Parameters of a case")]
    wind_speed: Option<f64>,

    /// Points of the strand, 3 to 1024 [default: 64; helix-spring: 32; pendulum: always 3]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(3..=1024), help_heading = "How it is simulated")]
    points: Option<u32>,

    /// Substeps of a frame of 1/60 s, 1 to 64 [default: 4 at rest, 8 in motion]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64), help_heading = "How it is simulated")]
    substeps: Option<u32>,

    /// Elastic model: auto, springs, curvature, rod [default: auto; michell: rod]
    #[arg(long, value_name = "NAME", help_heading = "How it is simulated")]
    model: Option<String>,

    /// How time is stepped: explicit-euler, verlet, backward-euler, bdf2, local-global, ftl, dftl [default: backward-euler]
    #[arg(long, value_name = "NAME", help_heading = "How it is simulated")]
    integrator: Option<String>,

    /// Write a page with a plot of each case: the reference as a curve, measured points over it
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,

    /// Print a Markdown table of the worst error of each case with every model at 32 to 1,024 points, and why where there is none
    #[arg(long, conflicts_with_all = ["points", "model", "substeps", "integrator", "report", "json"])]
    table: bool,

    /// Print the results as JSON
    #[arg(long)]
    json: bool,
}

/// The cases, from their own words.
fn after_help() -> String {
    let mut text = String::from("Cases, and the parameters that each takes:\n");
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

The exit code is 1 where a measured value is out of its tolerance."
}

/// The values, each once.
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
        output::try_folder(path)?;
    }
    let jobs = jobs(options)?;
    if options.table {
        let mut cases: Vec<&'static Case> = jobs.iter().map(|job| job.case).collect();
        cases.dedup_by_key(|case| case.name);
        interrupt::listen();
        return table::run(&cases, console);
    }
    let outcomes: Vec<Outcome> =
        jobs.par_iter().flat_map_iter(|job| job.case.run(&job.values, job.method)).collect();
    if options.json {
        say(Value::Array(outcomes.iter().map(as_json).collect()));
    } else {
        print_table(&outcomes);
    }
    if let Some(path) = &options.report {
        let page = report::page(&jobs, &outcomes);
        output::write_whole(path, page.as_bytes())?;
        console.doing(format_args!("the report is {}", path.display()));
    }
    let failed = outcomes.iter().filter(|o| !o.pass()).count();
    match failed {
        0 => Ok(()),
        _ => Err(Fault::Invalid(format!(
            "{failed} of {} measured values are out of tolerance",
            outcomes.len()
        ))),
    }
}

/// What the command line asks for: the named case, or all of them, at the given parameters or their defaults.
fn jobs(options: &Options) -> Result<Vec<Job>, Fault> {
    let cases: Vec<&'static Case> = match &options.case {
        None => CASES.to_vec(),
        Some(name) => vec![case(name).ok_or_else(|| {
            let names: Vec<&str> = CASES.iter().map(|c| c.name).collect();
            Fault::Usage(format!("there is no case '{name}'; there is: {}", names.join(", ")))
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
            let text =
                format!("the case {} has no --{symbol}; it belongs to: {}", cases[0].name, takers.join(", "));
            return Err(Fault::Usage(text));
        }
    }
    let mut jobs = Vec::new();
    for case in cases {
        let asked = options.points.filter(|_| !case.points_fixed || options.case.is_some());
        if case.points_fixed && asked.is_some_and(|points| points != case.method.points) {
            let text = format!("the case {} is about a strand of {} points", case.name, case.method.points);
            return Err(Fault::Usage(text));
        }
        let method = Method {
            points: asked.unwrap_or(case.method.points),
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
                            "--{} is {x}; the case {} is meant for {low} to {high}",
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

/// The setting among `all` that was asked for by its `name`.
fn chosen<T: Copy>(
    what: &str,
    asked: &Option<String>,
    all: &[T],
    name: fn(T) -> &'static str,
) -> Result<Option<T>, Fault> {
    let Some(asked) = asked else { return Ok(None) };
    let found = all.iter().copied().find(|t| name(*t) == asked);
    let there: Vec<&str> = all.iter().map(|t| name(*t)).collect();
    found.map(Some).ok_or_else(|| {
        Fault::Usage(format!("there is no {what} '{asked}' here; there is: {}", there.join(", ")))
    })
}

/// The parameters on the command line.
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

/// An outcome under the documented keys; what could not be measured is null.
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

/// The table that a person reads.
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
            // Numbers stand right.
            if (3..6).contains(&c) { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
        });
        say(cells.collect::<Vec<_>>().join("  ").trim_end());
    }
    let passed = outcomes.iter().filter(|o| o.pass()).count();
    say(format_args!("{passed} of {} pass", outcomes.len()));
    // Why, once a case.
    let mut reasons: Vec<(&str, &str)> =
        outcomes.iter().filter_map(|o| Some((o.case, o.reason()?))).collect();
    reasons.dedup();
    for (case, reason) in reasons {
        say(format_args!("{case}: {reason}"));
    }
}

/// An outcome in the words of the table.
fn row(outcome: &Outcome) -> [String; 7] {
    let told = |value: &Result<f64, _>| value.map_or("-".into(), number);
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
        told(&outcome.measured),
        told(&outcome.reference),
        outcome.relative_error().map_or("-".into(), |e| format!("{:.2} %", e * 100.0)),
        verdict,
    ]
}

/// How an outcome was simulated.
fn how(outcome: &Outcome) -> String {
    let Method { points, substeps, model, integrator } = outcome.method;
    let (model, integrator) = (model.name(), integrator.name());
    format!("{points} points, {substeps} substeps a frame, model {model}, {integrator}")
}

/// The parameters of an outcome, as on the command line.
fn parameters(outcome: &Outcome) -> String {
    let one = |(name, value): &(&str, f64)| format!("{name} {}", number(*value));
    outcome.parameters.iter().map(one).collect::<Vec<_>>().join(", ")
}
