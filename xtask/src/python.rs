//! Builds the Python package in a virtual environment, and runs its tests with the real readers of other formats.

use crate::run;
use std::{
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// Folder of the virtual environment.
const ENVIRONMENT: &str = "target/python";

/// Clients that the tests use: Blender, Open Job Description, a checker of the type stubs, plots of the tutorial, and Ray. Not every version of Python and not
/// every system has each of them; without one, its tests are skipped.
const CLIENTS: [&str; 5] = ["bpy==5.0.1", "openjd-cli>=0.8", "mypy>=1.11", "matplotlib>=3.9", "ray>=2.40"];

/// Passed, failed and skipped tests.
pub type Counts = [u64; 3];

/// Installs the package with its extras, and runs its tests. Returns the counts; all 0 without Python.
pub fn test() -> Result<Counts, String> {
    let Some(python) = environment()? else {
        println!(
            "skipped the tests of the Python package: python3, 3.11 or later, with the module venv was not found"
        );
        return Ok([0, 0, 1]);
    };
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
    run::program(&python, &[&pip[..], &[".[usd,alembic,wedge]", "pytest>=8"]].concat())?;
    for client in CLIENTS {
        if let Err(why) = run::program(&python, &[&pip[..], &[client]].concat()) {
            println!("skipped the tests with {client}: {why}");
        }
    }
    let arguments = ["-m", "pytest", "-q", "-rs", "python/tests"];
    println!("$ {} {}", python.display(), arguments.join(" "));
    let output = Command::new(&python)
        .args(arguments)
        .stdin(Stdio::null())
        .stderr(Stdio::inherit())
        .output()
        .map_err(|why| format!("pytest: {why}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    print!("{text}");
    let counts = counts(&text);
    match output.status.success() || counts[1] > 0 {
        true => Ok(counts),
        false => Err(format!("pytest ended with {}", output.status)),
    }
}

/// Creates the environment if it does not exist. Returns its interpreter; `None` without Python 3.11.
fn environment() -> Result<Option<PathBuf>, String> {
    let python = Path::new(ENVIRONMENT).join("bin/python");
    if python.exists() {
        return Ok(Some(python));
    }
    let suits = "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))";
    let runs = |command: &mut Command| command.stdin(Stdio::null()).status().is_ok_and(|s| s.success());
    if !runs(Command::new("python3").args(["-c", suits]).stderr(Stdio::null())) {
        return Ok(None);
    }
    run::program(Path::new("python3"), &["-m", "venv", ENVIRONMENT])?;
    Ok(Some(python))
}

/// Reads the summary of pytest: `1 failed, 20 passed, 2 skipped in 3.50s`.
fn counts(text: &str) -> Counts {
    let mut sum = [0; 3];
    let Some(line) =
        text.lines().rev().find(|l| l.contains(" in ") && l.contains(|c: char| c.is_ascii_digit()))
    else {
        return sum;
    };
    let words: Vec<&str> = line.split([' ', ',', '=']).filter(|w| !w.is_empty()).collect();
    for pair in words.windows(2) {
        let Ok(count) = pair[0].parse::<u64>() else { continue };
        match pair[1] {
            "passed" => sum[0] += count,
            "failed" | "error" | "errors" => sum[1] += count,
            "skipped" => sum[2] += count,
            _ => {}
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_summary_of_pytest_is_read() {
        assert_eq!(super::counts("..\n20 passed, 2 skipped, 1 warning in 3.50s\n"), [20, 0, 2]);
        assert_eq!(super::counts("=== 1 failed, 3 passed in 0.1s ===\n"), [3, 1, 0]);
        assert_eq!(super::counts("no tests ran in 0.01s\n"), [0, 0, 0]);
    }
}
