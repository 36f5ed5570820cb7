//! Promise: strands agree with closed-form mechanics.
//!
//! Every case of `hairspring validate` at its default parameters: static shapes within 2 % of the elastica
//! and the catenary, buckling loads and coils of 8 segments a turn within 5 %, frequencies within 2 %,
//! friction within 3 %, self-motion below 1 mm/s. All run at the user's 4 substeps, nearly all at 64
//! points, with the default elastic model and with each of the others. The references share no code with
//! the simulation, and `validate/reference/tests.rs` compares them with printed tables.
//!
//! A case that a model cannot pass lists the model in `fails_with`, and must fail: when it passes, the model must be
//! removed. The values on docs/validation.md must match this build, so that the page is never out of date.

use hairspring::material::Model;
use hairspring_validate::{CASES, Case, Method, Outcome};
use rayon::prelude::*;

fn run_all(method: impl Fn(&Case) -> Method + Sync) -> Vec<Outcome> {
    let jobs: Vec<(&Case, &[f64])> =
        CASES.iter().flat_map(|case| case.defaults.iter().map(|values| (*case, *values))).collect();
    jobs.into_par_iter().flat_map_iter(|(case, values)| case.run(values, method(case))).collect()
}

fn check(outcomes: &[Outcome]) {
    let mut wrong = Vec::new();
    for case in CASES {
        let of_case: Vec<&Outcome> = outcomes.iter().filter(|o| o.case == case.name).collect();
        let model = of_case[0].method.model;
        let failed: Vec<&&Outcome> = of_case.iter().filter(|o| !o.pass()).collect();
        match case.fails_with.contains(&model) {
            false => wrong.extend(failed.iter().map(|o| format!("{o:?}"))),
            true if failed.is_empty() => {
                wrong.push(format!("{} passes now with the model {}", case.name, model.name()))
            }
            true => assert!(failed.iter().all(|o| o.reason().is_some())),
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// The largest difference of a measured value from the page, in units of the tolerance [1]. Instruction
/// sets differ in rounding, most where a strand buckles.
const SAME: f64 = 0.2;

/// Compares the outcomes with the table on docs/validation.md that follows the line beginning with `after`.
fn is_on_the_page(after: &str, outcomes: &[Outcome]) {
    let page =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/validation.md")).unwrap();
    let part = page.split_once(&format!("\n{after}")).expect("the page does not have the line").1;
    let table = part.split("```").nth(1).expect("no table follows");
    // Skips "text" and the heading.
    let mut rows = table.lines().skip(2);
    for outcome in outcomes {
        let row = rows.next().expect("a row is missing");
        let cell = row.split_once(outcome.quantity).and_then(|(_, rest)| rest.split_whitespace().next());
        let documented = cell
            .unwrap_or_else(|| panic!("'{row}' is not a row of {}", outcome.quantity))
            .parse::<f64>()
            .ok();
        assert!(row.starts_with(outcome.case), "'{row}' is not a row of {}", outcome.case);
        let same = match (documented, outcome.measured.as_ref().ok(), outcome.reference.as_ref().ok()) {
            (Some(documented), Some(measured), Some(reference)) => {
                let scale = if *reference == 0.0 { 1.0 } else { reference.abs() };
                (documented - measured).abs() < SAME * outcome.tolerance * scale
            }
            (documented, measured, _) => documented.is_none() && measured.is_none(),
        };
        assert!(same, "docs/validation.md has '{row}', but measured is {:?}", outcome.measured);
    }
}

#[test]
fn default_model_agrees() {
    let outcomes = run_all(|case| case.method);
    check(&outcomes);
    is_on_the_page("`hairspring validate`, default model", &outcomes);
}

#[test]
fn rod_model_agrees() {
    check(&run_all(|case| Method { model: Model::Rod, ..case.method }));
}

#[test]
fn springs_model_agrees_within_its_stated_limits() {
    let outcomes = run_all(|case| Method { model: Model::Springs, ..case.method });
    check(&outcomes);
    is_on_the_page("`hairspring validate --model springs`", &outcomes);
}

#[test]
fn curvature_model_agrees_except_for_twist() {
    check(&run_all(|case| Method { model: Model::Curvature, ..case.method }));
}

/// The results do not depend on the discretization: other point and substep counts than the defaults.
#[test]
fn other_point_and_substep_counts_agree() {
    for (name, values, points, substeps) in [
        ("heavy-cantilever", &[30.0][..], 32, 4),
        ("heavy-cantilever", &[30.0], 64, 16),
        ("end-load", &[3.0], 128, 4),
        ("catenary", &[1.5], 33, 8),
        ("greenhill", &[], 48, 8),
        ("incline", &[0.2], 24, 8),
        ("capstan", &[0.2], 32, 4),
    ] {
        let case = hairspring_validate::case(name).unwrap();
        for outcome in case.run(values, Method { points, substeps, ..case.method }) {
            assert!(outcome.pass(), "{points} points, {substeps} substeps: {outcome:?}");
        }
    }
}

/// Runs that cannot pass: too few points, and parameters that need more. Each failing value has a reason with the numbers
/// of the run.
#[test]
fn a_failing_run_states_its_cause() {
    for (name, values, points, part) in [
        ("michell", &[0.458][..], 3, "needs 6 points or more"),
        ("catenary", &[1.25], 3, "needs 4 points or more"),
        ("capstan", &[0.1], 3, "needs 8 points or more"),
        ("hanging-chain", &[], 3, "needs 6 points or more"),
        ("heavy-cantilever", &[1.0], 3, "bends within 1.00 of its length, in only 2.0 segments"),
        ("heavy-cantilever", &[1000.0], 64, "at Γ = 1000 and 64 points, the strand bends within 0.10"),
        ("beam-modes", &[], 3, "3 points are 2 segments, too few"),
        ("end-load", &[1.0], 4, "4 points are 3 segments, too few"),
        ("bend-twist", &[8.0, 0.458], 4, "a turn of the curl has only 2.4 segments"),
        ("helix-spring", &[6.0], 32, "a turn has only 5.2 segments"),
        (
            "thin-rod",
            &[0.25],
            64,
            "a segment of 3.2 mm may cut a corner by 1.5 % of its length, 19 % of the radius",
        ),
        ("pendulum", &[170.0], 3, "the wider the swing (170°)"),
    ] {
        let case = hairspring_validate::case(name).unwrap();
        let outcomes = case.run(values, Method { points, ..case.method });
        let reasons: Vec<String> = outcomes.iter().filter_map(Outcome::reason).collect();
        assert_eq!(reasons.len(), outcomes.iter().filter(|o| !o.pass()).count());
        assert!(!reasons.is_empty(), "{name} passes with {values:?} and {points} points");
        assert!(
            reasons.iter().all(|reason| reason.contains(part)),
            "{name}, {values:?}, {points} points: {reasons:?}"
        );
    }
}

/// A cantilever of any number of points, from one that hardly bends to one that hangs.
#[test]
fn a_cantilever_of_32_to_1024_points() {
    let case = hairspring_validate::case("heavy-cantilever").unwrap();
    let jobs: Vec<(u32, f64)> = [1024, 512, 256, 128, 64, 32]
        .into_iter()
        .flat_map(|points| [0.1, 1.0, 10.0, 100.0, 1000.0].map(|gamma| (points, gamma)))
        .collect();
    let wrong: Vec<String> = jobs
        .into_par_iter()
        .with_max_len(1)
        .flat_map_iter(|(points, gamma)| case.run(&[gamma], Method { points, ..case.method }))
        // With Γ = 1000 the strand bends within a tenth of its length. There, 32 points have three
        // segments, which resolve the drop but not the reach.
        .filter(|outcome| {
            let steep = outcome.parameters[0].1 == 1000.0 && outcome.method.points < 128;
            !(outcome.pass() || steep && outcome.quantity != "drop H/L")
        })
        .map(|outcome| format!("{outcome:?}"))
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}
