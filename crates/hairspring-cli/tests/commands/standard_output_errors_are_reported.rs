//! Promise: an error of standard output (a closed pipe, a full disk, no output at all) ends a command with exit code 5 and
//! one sentence. The files that the command writes are complete.
#![cfg(unix)]

use crate::common::{names, program, write_groom};
use std::{
    fs::OpenOptions,
    path::Path,
    process::{Command, Output, Stdio},
};

fn refuse(folder: &Path, arguments: &[&str], stdout: impl Into<Stdio>) {
    let output = program(folder, arguments).stdout(stdout).stderr(Stdio::piped()).output().unwrap();
    check_refused(arguments, output);
}

fn check_refused(arguments: &[&str], output: Output) {
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(5), "{arguments:?}: {stderr}");
    let errors: Vec<&str> = stderr.lines().filter(|l| l.starts_with("error: ")).collect();
    assert!(errors.len() == 1 && errors[0].contains("standard output"), "{arguments:?}: {stderr}");
    assert!(!stderr.contains("internal error"), "{stderr}");
}

const COMMANDS: [&[&str]; 6] = [
    &["info", "groom.hair"],
    &["info", "groom.hair", "--json"],
    &["convert", "groom.hair", "copy.data"],
    &["bake", "groom.hair", "-o", "x.#.hair", "--frames", "1-2"],
    &["--help"],
    &["--version"],
];

#[test]
fn a_closed_pipe() {
    let folder = tempfile::tempdir().unwrap();
    write_groom(folder.path(), 5);
    for arguments in COMMANDS {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        refuse(folder.path(), arguments, writer);
    }
    let left = names(folder.path());
    assert_eq!(left, ["copy.data", "groom.hair", "x.1.hair", "x.2.hair", "x.bake.hair.json"]);
}

/// Runs the program with a redirection of the shell.
fn redirected(folder: &Path, arguments: &[&str], redirection: &str) -> Output {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("exec \"$@\" {redirection}"), "sh", env!("CARGO_BIN_EXE_hairspring")]);
    shell.current_dir(folder).args(arguments).output().unwrap()
}

#[test]
fn a_closed_output() {
    let folder = tempfile::tempdir().unwrap();
    write_groom(folder.path(), 5);
    for arguments in COMMANDS {
        check_refused(arguments, redirected(folder.path(), arguments, ">&-"));
    }
    assert!(names(folder.path()).contains(&"copy.data".into()));
    // Notes and errors may be lost. The exit code tells what happened.
    for (file, code) in [("groom.hair", 0), ("missing.hair", 3)] {
        let output = redirected(folder.path(), &["info", file], "2>&-");
        assert_eq!(output.status.code(), Some(code), "{file}");
    }
    // A program may be started with an output that nobody reads.
    let null = program(folder.path(), &["info", "groom.hair"]).stdout(Stdio::null()).status().unwrap();
    assert!(null.success());
}

#[test]
fn a_full_disk() {
    if !Path::new("/dev/full").exists() {
        return println!("skipped: there is no /dev/full");
    }
    let folder = tempfile::tempdir().unwrap();
    write_groom(folder.path(), 5);
    for arguments in COMMANDS {
        refuse(folder.path(), arguments, OpenOptions::new().write(true).open("/dev/full").unwrap());
    }
}
