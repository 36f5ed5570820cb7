//! Runs every fuzz target for a while, on stable Rust. libFuzzer needs no sanitizer to find a panic or a
//! hang.

use crate::run;
use std::{
    path::{Path, PathBuf},
    process::Child,
};

/// Number of targets that run at the same time.
const AT_ONCE: usize = 2;

/// Seed of the search in CI. It is fixed, so that only the commit decides whether CI passes.
pub const ALWAYS_THE_SAME: Option<u32> = Some(1);

/// Builds all targets, fills their corpora with generated seeds, and runs each target for `seconds`. Without
/// a `seed` every run is a different search.
pub fn all(seconds: u32, seed: Option<u32>) -> Result<(), String> {
    // Uses the features of the whole workspace, as the tests do. For the example's package alone, libraries
    // have fewer features, and the kernels would be compiled twice.
    run::cargo(&["build", "--release", "--workspace", "--example", "fuzz_seeds"], &[])?;
    let built = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| "target".into(), PathBuf::from);
    run::program(&built.join("release/examples/fuzz_seeds"), &["fuzz/corpus"])?;
    let unstable = [("RUSTC_BOOTSTRAP", "1")];
    run::cargo(&["fuzz", "build", "-s", "none"], &unstable)?;
    let mut running: Vec<(String, Child)> = Vec::new();
    let mut failed = Vec::new();
    for target in targets()? {
        if running.len() == AT_ONCE {
            finish(running.remove(0), &mut failed)?;
        }
        println!("fuzzing {target} for {seconds} s");
        let time = format!("-max_total_time={seconds}");
        // 0, libFuzzer's default, is a new seed each time.
        let seed = format!("-seed={}", seed.unwrap_or(0));
        // No reader may take more than one gibibyte of memory and ten seconds for one input.
        let arguments = [
            "fuzz",
            "run",
            "-s",
            "none",
            &target,
            "--",
            &time,
            &seed,
            "-timeout=10",
            "-rss_limit_mb=1024",
            "-verbosity=0",
            "-print_funcs=0",
        ];
        let child = run::command(&arguments, &unstable).spawn().map_err(|e| e.to_string())?;
        running.push((target, child));
    }
    for last in running {
        finish(last, &mut failed)?;
    }
    if failed.is_empty() {
        Ok(())
    } else {
        Err(format!("inputs that break a reader were found for: {}", failed.join(", ")))
    }
}

fn finish((target, mut child): (String, Child), failed: &mut Vec<String>) -> Result<(), String> {
    let status = child.wait().map_err(|e| e.to_string())?;
    if !status.success() {
        failed.push(target);
    }
    Ok(())
}

fn targets() -> Result<Vec<String>, String> {
    let folder = Path::new("fuzz/fuzz_targets");
    let files = std::fs::read_dir(folder)
        .map_err(|e| format!("{}: {e}; run this in the root of the checkout", folder.display()))?;
    let mut names: Vec<String> = files
        .flatten()
        .filter_map(|f| f.path().file_stem().map(|s| s.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    Ok(names)
}
