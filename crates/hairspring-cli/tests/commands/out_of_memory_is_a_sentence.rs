//! Promise: a run that needs more memory than there is ends with one sentence and exit code 8, and leaves no partial
//! file.
#![cfg(target_os = "linux")]

use crate::common::{names, program};
use std::process::Command;

#[test]
fn a_run_without_enough_memory_is_reported_and_leaves_no_partial_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("large.toml"), "[builtin]\nstrands = 2000000\nguides = 10\n").unwrap();
    std::fs::create_dir(folder.path().join("out")).unwrap();
    let bake = program(
        folder.path(),
        &["bake", "large.toml", "-o", "out/f.####.hair", "--frames", "1-2", "--threads", "1"],
    );
    // 700 MB of address space: enough for the program, and not for two million hairs.
    let limited = "ulimit -v 700000; exec \"$0\" \"$@\"";
    let output = Command::new("sh")
        .arg("-c")
        .arg(limited)
        .arg(bake.get_program())
        .args(bake.get_args())
        .current_dir(folder.path())
        .env("RUST_BACKTRACE", "0")
        .output()
        .unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(8), "{text}");
    let last = text.lines().last().unwrap();
    assert!(last.starts_with("error: out of memory: use fewer strands"), "{text}");
    let left = names(&folder.path().join("out"));
    assert!(left.iter().all(|name| !name.starts_with(".hairspring")), "{left:?}");
}
