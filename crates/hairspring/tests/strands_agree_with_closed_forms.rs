//! Promise: a strand does what mechanics says that it does.
//!
//! Every case of `hairspring validate` at its default parameters: static shapes within 2 % of the elastica and the catenary,
//! loads at which a strand gives way within 5 %, frequencies within 2 %, friction within 3 %, all at 64 points, with the
//! elastic model that a user gets and with the rod. The references are computed without a line of the simulation, and are
//! themselves held against the printed tables in `validate/reference/tests.rs`.

use hairspring::{
    material::Model,
    validate::{CASES, Case, Method, Outcome},
};
use rayon::prelude::*;

fn run_all(method: impl Fn(&Case) -> Method + Sync) -> Vec<Outcome> {
    let jobs: Vec<(&Case, &[f64])> =
        CASES.iter().flat_map(|case| case.defaults.iter().map(|values| (*case, *values))).collect();
    jobs.into_par_iter().flat_map_iter(|(case, values)| case.run(values, method(case))).collect()
}

fn check(outcomes: &[Outcome]) {
    let mut wrong = Vec::new();
    for outcome in outcomes {
        let line = format!(
            "{} {:?} {}: {:?}, reference {:?}",
            outcome.case, outcome.parameters, outcome.quantity, outcome.measured, outcome.reference
        );
        println!("{line}");
        if !outcome.pass() {
            wrong.push(line);
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn as_a_user_gets_them() {
    check(&run_all(|case| case.method));
}

#[test]
fn with_the_rod() {
    check(&run_all(|case| Method { model: Model::Rod, ..case.method }));
}

/// A model without twist cannot know that a heavy curl winds out of its plane.
#[test]
fn without_twist_a_curl_stays_in_its_plane() {
    let case = hairspring::validate::case("bend-twist").unwrap();
    let outcome = case.run(&[8.0, 0.458], Method { model: Model::Curvature, ..case.method });
    assert!(!outcome[0].pass(), "{outcome:?}");
}

/// What is measured is the strand's, not the step's: other points and substeps than the defaults.
#[test]
fn with_other_points_and_substeps() {
    for (name, values, points, substeps) in [
        ("heavy-cantilever", &[30.0][..], 32, 4),
        ("heavy-cantilever", &[30.0], 64, 16),
        ("end-load", &[3.0], 128, 4),
        ("catenary", &[1.5], 33, 8),
        ("greenhill", &[], 48, 8),
        ("incline", &[0.2], 24, 8),
        ("capstan", &[0.2], 32, 4),
    ] {
        let case = hairspring::validate::case(name).unwrap();
        for outcome in case.run(values, Method { points, substeps, ..case.method }) {
            assert!(outcome.pass(), "{points} points, {substeps} substeps: {outcome:?}");
        }
    }
}
