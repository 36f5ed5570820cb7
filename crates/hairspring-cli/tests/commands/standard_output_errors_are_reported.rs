//! Promise: an error of standard output (a closed pipe, a full disk) ends a command with exit code 5 and one
//! sentence. The files that the command writes are complete.
#![cfg(unix)]

use crate::common::{names, program, write_groom};
use std::{fs::OpenOptions, path::Path, process::Stdio};

fn refuse(folder: &Path, arguments: &[&str], stdout: impl Into<Stdio>) {
    let output = program(folder, arguments).stdout(stdout).stderr(Stdio::piped()).output().unwrap();
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
