//! Runs all tests, those of the Python package included, and prints one line with the totals at the end.

use crate::{python, run};
use std::{
    io::{BufRead, BufReader},
    process::Stdio,
};

/// Seed of the tests' random input. It is fixed, so that only the commit decides whether CI passes. `cargo
/// test` uses a new seed each time.
const ALWAYS_THE_SAME: (&str, &str) = ("PROPTEST_RNG_SEED", "1");

/// Runs every test of the workspace in release, the profile of the program, so that both share one build.
pub fn all() -> Result<(), String> {
    // With this feature, the build without SIMD is tested, and the bench table has its row.
    let arguments =
        ["test", "--release", "--workspace", "--no-fail-fast", "--features", "hairspring-cli/scalar"];
    println!("$ cargo {}", arguments.join(" "));
    let mut child = run::command(&arguments, &[ALWAYS_THE_SAME])
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|e| e.to_string())?;
    let output = child.stdout.take().ok_or("cargo test has no output")?;
    let mut sum = [0u64; 3];
    for line in BufReader::new(output).lines() {
        let line = line.map_err(|e| e.to_string())?;
        println!("{line}");
        add(&mut sum, &line);
    }
    let status = child.wait().map_err(|e| e.to_string())?;
    // After the library and the program are built, which the package shares.
    let in_python = python::test();
    if let Ok(more) = &in_python {
        sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
    }
    let [passed, failed, skipped] = sum;
    println!("{passed} passed, {failed} failed, {skipped} skipped");
    in_python?;
    match (status.success(), passed, failed) {
        (true, 1.., 0) => Ok(()),
        (true, 0, _) => Err("no test ran".into()),
        (true, ..) => Err("a test of the Python package failed".into()),
        (false, ..) => Err(format!("cargo test ended with {status}")),
    }
}

/// Adds a line `test result: ok. 3 passed; 0 failed; 1 ignored; …` to passed, failed and skipped.
fn add(sum: &mut [u64; 3], line: &str) {
    let Some(counts) = line.strip_prefix("test result: ") else { return };
    for part in counts.split([';', '.']) {
        let mut words = part.split_whitespace();
        let (Some(count), Some(what)) = (words.next().and_then(|w| w.parse::<u64>().ok()), words.next())
        else {
            continue;
        };
        match what {
            "passed" => sum[0] += count,
            "failed" => sum[1] += count,
            "ignored" => sum[2] += count,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn summary_lines_add_up() {
        let mut sum = [0; 3];
        super::add(
            &mut sum,
            "test result: ok. 12 passed; 0 failed; 1 ignored; 0 measured; 3 filtered out; finished in 0.5s",
        );
        super::add(
            &mut sum,
            "test result: FAILED. 2 passed; 3 failed; 0 ignored; 0 measured; 0 filtered out",
        );
        super::add(&mut sum, "test something ... ok");
        assert_eq!(sum, [14, 3, 1]);
    }
}
