//! `hairspring validate --table`: every case with every model at 32 to 1,024 points, as the Markdown table of
//! docs/validation.md.

use crate::{
    console::{Console, print_line},
    fault::Fault,
    interrupt,
    totals::counted,
};
use hairspring::material::Model;
use hairspring_validate::{Case, Method, Outcome};
use rayon::prelude::*;
use std::{
    sync::atomic::{AtomicU32, Ordering::Relaxed},
    time::Instant,
};

/// The elastic models of a strand; `auto` selects one of them.
const MODELS: [Model; 3] = [Model::Curvature, Model::Rod, Model::Springs];

/// Numbers of points per strand.
const POINTS: [u32; 6] = [32, 64, 128, 256, 512, 1024];

/// All measurements for one cell of the table.
struct Cell {
    case: &'static Case,
    method: Method,
}

impl Cell {
    /// The outcomes with all default parameters; empty if the case does not apply to this number of points.
    fn run(&self) -> Vec<Outcome> {
        if self.case.points_fixed && self.method.points != POINTS[0] {
            return Vec::new();
        }
        let method = match self.case.points_fixed {
            true => Method { points: self.case.method.points, ..self.method },
            false => self.method,
        };
        self.case.defaults.par_iter().flat_map_iter(|values| self.case.run(values, method)).collect()
    }
}

/// Runs `cases` and prints the table of everything that was measured before an interrupt.
pub(super) fn run(cases: &[&'static Case], console: Console) -> Result<(), Fault> {
    let began = Instant::now();
    let rows: Vec<(&'static Case, Model)> =
        cases.iter().flat_map(|case| MODELS.map(|model| (*case, model))).collect();
    // The slowest cells come first, so that no thread is left alone with one at the end.
    let cells: Vec<Cell> = POINTS
        .iter()
        .rev()
        .flat_map(|&points| {
            rows.iter()
                .map(move |&(case, model)| Cell { case, method: Method { points, model, ..case.method } })
        })
        .collect();
    let progress = std::sync::Mutex::new(console.progress_in("measuring", cells.len() as u32, "cells"));
    let done = AtomicU32::new(0);
    // `None` for cells that had not started when the user interrupted the run.
    let found: Vec<Option<Vec<Outcome>>> = cells
        .par_iter()
        .with_max_len(1)
        .map(|cell| {
            let outcomes = (!interrupt::stop_requested()).then(|| cell.run());
            let done = done.fetch_add(1, Relaxed) + 1;
            if let Ok(mut progress) = progress.lock() {
                let Method { points, model, .. } = cell.method;
                progress.step(|| format!("{done}: {} {} {points}", cell.case.name, model.name()));
            }
            outcomes
        })
        .collect();
    drop(progress);
    let heads: Vec<String> = POINTS.iter().map(|points| format!(" {points} |")).collect();
    print_line(format_args!("| case | model | within |{}", heads.concat()));
    print_line(format_args!("| --- | --- | --: |{}", " --: |".repeat(POINTS.len())));
    let mut notes: Vec<String> = Vec::new();
    for (r, (case, model)) in rows.iter().enumerate() {
        let of_columns = (0..POINTS.len()).rev().map(|c| &found[c * rows.len() + r]);
        let texts = of_columns.map(|outcomes| match outcomes {
            Some(outcomes) => cell(case, outcomes, &mut notes),
            None => note(&mut notes, "not measured: the run was interrupted".into()),
        });
        let texts: Vec<String> = texts.collect();
        print_line(format_args!(
            "| {} | {} | {} | {} |",
            case.name,
            model.name(),
            bound(found[(POINTS.len() - 1) * rows.len() + r].as_deref().unwrap_or_default()),
            texts.join(" | ")
        ));
    }
    print_line("");
    notes.iter().enumerate().for_each(|(k, note)| print_line(format_args!("{}. {note}", k + 1)));
    print_line("");
    print_line(format_args!(
        "{} cells in {:.0} s on {}.",
        found.iter().flatten().count(),
        began.elapsed().as_secs_f64(),
        counted(rayon::current_num_threads(), "thread")
    ));
    match found.iter().filter(|found| found.is_none()).count() {
        0 => Ok(()),
        left => Err(Fault::Interrupted(format!(
            "interrupted: {left} of {} cells were not measured and are marked in the table",
            cells.len()
        ))),
    }
}

/// The tolerances of a case's quantities.
fn bound(outcomes: &[Outcome]) -> String {
    let mut all: Vec<String> = Vec::new();
    for outcome in outcomes {
        let text = match outcome.reference {
            Ok(0.0) => format!("{}", outcome.tolerance),
            _ => format!("{} %", outcome.tolerance * 100.0),
        };
        if !all.contains(&text) {
            all.push(text);
        }
    }
    all.join(", ")
}

/// Text of a cell: the outcome that is farthest outside its tolerance, and the reason if it is outside.
fn cell(case: &Case, outcomes: &[Outcome], notes: &mut Vec<String>) -> String {
    let Some(worst) = outcomes.iter().max_by(|a, b| share(a).total_cmp(&share(b))) else {
        return note(
            notes,
            format!("{} applies to a strand of {} points only", case.name, case.method.points),
        );
    };
    let value = match (&worst.measured, worst.relative_error()) {
        (Ok(_), Some(error)) => format!("{:.2} %", error * 100.0),
        (Ok(value), None) => format!("{value:.3}"),
        (Err(_), _) => "–".into(),
    };
    if worst.pass() {
        return value;
    }
    let why = worst.reason().unwrap_or_default();
    format!("**{value}** {}", note(notes, format!("{}: {why}", case.name)))
}

/// The error relative to the tolerance. An outcome that could not be measured counts as the largest.
fn share(outcome: &Outcome) -> f64 {
    match (&outcome.measured, outcome.relative_error()) {
        (Ok(_), Some(error)) => error / outcome.tolerance,
        (Ok(value), None) => value.abs() / outcome.tolerance,
        (Err(_), _) => f64::INFINITY,
    }
}

/// The number of a note in brackets. Each note is listed once.
fn note(notes: &mut Vec<String>, text: String) -> String {
    let k = notes.iter().position(|note| *note == text).unwrap_or_else(|| {
        notes.push(text);
        notes.len() - 1
    });
    format!("({})", k + 1)
}
