//! Promise: `hairspring validate` reports measured and expected values and whether they agree, under stable
//! keys. Its exit code is 1 where a value is outside its tolerance, and its report is one self-contained
//! file.

use crate::common::{fail, json, names, run, succeed};
use std::path::Path;

const KEYS: [&str; 8] =
    ["case", "parameters", "quantity", "measured", "reference", "relative_error", "tolerance", "pass"];

#[test]
fn a_case_at_any_parameter() {
    let arguments =
        ["validate", "heavy-cantilever", "--gamma", "30", "--points", "40", "--model", "rod", "--json"];
    let found = json(&succeed(Path::new("."), &arguments));
    let list = found.as_array().unwrap();
    assert_eq!(list.len(), 3, "drop, reach and their ratio");
    for outcome in list {
        let keys: Vec<&str> = outcome.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(keys, KEYS);
        let number = |key: &str| outcome[key].as_f64().unwrap();
        assert_eq!(outcome["case"], "heavy-cantilever");
        let parameters = &outcome["parameters"];
        assert_eq!((parameters["gamma"].as_f64(), parameters["points"].as_u64()), (Some(30.0), Some(40)));
        assert_eq!(
            (&parameters["model"], &parameters["integrator"]),
            (&"rod".into(), &"backward-euler".into())
        );
        let error = (number("measured") / number("reference") - 1.0).abs();
        assert!((error - number("relative_error")).abs() < 1e-12);
        assert_eq!(outcome["pass"], error <= number("tolerance"));
    }
}

#[test]
fn a_disagreement_is_exit_code_1() {
    // Follow the leader has no bending stiffness.
    let output =
        run(Path::new("."), &["validate", "heavy-cantilever", "--gamma", "1", "--integrator", "ftl"]);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert_eq!(stderr.trim(), "error: 3 of 3 measured values are outside their tolerance");
    assert!(String::from_utf8(output.stdout).unwrap().contains("FAIL"));
}

#[test]
fn too_few_points_are_a_reason_and_exit_code_1() {
    for (case, needed) in [("michell", 6), ("catenary", 4), ("capstan", 8)] {
        let output = run(Path::new("."), &["validate", case, "--points", "3"]);
        let stdout = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(1), "{stdout}");
        let reason = format!("the experiment needs {needed} points or more");
        assert!(stdout.contains(&format!("FAIL: {reason}")), "{stdout}");
        assert!(stdout.contains(&format!("\n{case}: {reason}\n")), "{stdout}");
    }
}

#[test]
fn a_table_has_a_value_or_a_reason_in_each_cell() {
    let found = succeed(Path::new("."), &["validate", "pendulum", "--table"]);
    let rows: Vec<&str> = found.lines().filter(|line| line.starts_with("| pendulum")).collect();
    assert_eq!(rows.len(), 3, "expected one row for each model: {found}");
    for row in rows {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        assert_eq!(cells.len(), 3 + 6, "expected case, model, tolerance, and 32 to 1,024 points: {row}");
        // The damping of the springs model exceeds the tolerance, which its cell states.
        let wanted = if cells[1] == "springs" { "%** (2)" } else { "%" };
        assert!(cells[3].ends_with(wanted), "{row}");
        assert!(cells[4..].iter().all(|cell| *cell == "(1)"), "{row}");
    }
    assert!(found.contains("\n2. pendulum: the springs model is damped more"), "{found}");
    assert!(found.contains("\n1. pendulum applies to a strand of 3 points only\n"), "{found}");
}

#[test]
fn a_report_is_one_file() {
    let folder = tempfile::tempdir().unwrap();
    succeed(folder.path(), &["validate", "end-load", "--alpha", "2", "--report", "report.html"]);
    assert_eq!(names(folder.path()), ["report.html"]);
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    for part in ["<!doctype html>", "<h2>end-load</h2>", "<polyline", "<circle", "tip angle θ", "</html>"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("http") && !page.contains("src="), "the report loads other files");
}

#[test]
fn invalid_parameters_of_a_case_are_refused() {
    for (arguments, code, parts) in [
        (&["validate", "cantilever"][..], 2, ["'cantilever'", "heavy-cantilever"]),
        (&["validate", "greenhill", "--mu", "0.3"], 2, ["--mu", "incline"]),
        (&["validate", "--gamma", "3"], 2, ["--gamma", "heavy-cantilever"]),
        (&["validate", "incline", "--mu", "7"], 2, ["--mu is 7", "0.01 to 1"]),
        (&["validate", "incline", "--mu", "NaN"], 2, ["--mu is NaN", "0.01 to 1"]),
        (&["validate", "pendulum", "--points", "64"], 2, ["pendulum", "3 points"]),
        (&["validate", "incline", "--model", "clay"], 2, ["'clay'", "curvature"]),
        (&["validate", "incline", "--integrator", "magic"], 2, ["'magic'", "backward-euler"]),
        (&["validate", "incline", "--report", "no/where.html"], 5, ["no", "does not exist"]),
        (&["validate", "incline", "--report", "shot.toml"], 2, ["shot.toml", ".html"]),
    ] {
        let stderr = fail(Path::new("."), arguments, code);
        assert_eq!(stderr.lines().count(), 1, "{arguments:?}: {stderr}");
        assert!(parts.iter().all(|p| stderr.contains(p)), "{arguments:?}: {stderr}");
    }
}
