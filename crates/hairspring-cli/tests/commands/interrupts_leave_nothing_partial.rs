//! Promise: Ctrl-C and SIGTERM end every command with exit code 130, also while it reads and during the
//! pre-roll. No file is left that is not complete, neither under its final name nor under a temporary one.
#![cfg(unix)]

use crate::common::{contents, names, program, write_groom, write_scene};
use std::{
    io::{BufRead, BufReader, Read},
    path::Path,
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

/// Longest time from a signal to the end [s].
const SOON: f64 = 20.0;

fn start(folder: &Path, arguments: &[&str]) -> Child {
    program(folder, arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

fn signal(child: &Child, name: &str) {
    let name = format!("-{name}");
    assert!(Command::new("kill").args([&name, &child.id().to_string()]).status().unwrap().success());
}

/// Waits until the program handles signals.
fn wait_for_handler(child: &Child) {
    let status = format!("/proc/{}/status", child.id());
    if !Path::new(&status).exists() {
        return std::thread::sleep(Duration::from_secs(2));
    }
    // SIGINT is bit 1 of the mask of caught signals.
    let caught = |text: String| {
        let mask = text.lines().find_map(|l| l.strip_prefix("SigCgt:")).map(str::trim).map(str::to_owned);
        mask.and_then(|m| u64::from_str_radix(&m, 16).ok()).is_some_and(|m| m & 2 != 0)
    };
    while !std::fs::read_to_string(&status).is_ok_and(caught) {
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn wait_for(path: &Path) {
    while !path.exists() {
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// The program must end soon with code 130. Returns standard error.
fn ended(mut child: Child) -> String {
    let began = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if began.elapsed().as_secs_f64() > SOON {
            child.kill().unwrap();
            panic!("still running {SOON} s after the signal");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    stderr
}

fn no_temporary(folder: &Path) {
    let left = names(folder);
    assert!(left.iter().all(|name| !name.starts_with('.')), "{left:?}");
}

#[test]
fn while_reading_and_during_the_preroll() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 4000);
    let scene = "[[groom]]\nfile = \"groom.hair\"\nscale = 1.0\nguides = \"all\"\n[solver]\npreroll = 60.0\n";
    std::fs::write(f.join("scene.toml"), scene).unwrap();
    let before = contents(f);
    for (name, delay) in [("INT", 0), ("TERM", 0), ("INT", 900), ("TERM", 900)] {
        for arguments in [
            &["bake", "scene.toml", "-o", "x.#.hair", "--frames", "1-2"][..],
            &["render", "scene.toml", "-o", "x.mp4", "--frames", "1-2", "--size", "64x36"],
        ] {
            let child = start(f, arguments);
            wait_for_handler(&child);
            std::thread::sleep(Duration::from_millis(delay));
            signal(&child, name);
            let stderr = ended(child);
            assert!(stderr.contains("interrupted; no partial file is left"), "{arguments:?}: {stderr}");
            assert!(contents(f) == before, "{arguments:?} left something behind");
        }
    }
}

#[test]
fn between_frames_of_every_kind() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 60);
    std::fs::create_dir(f.join("out")).unwrap();
    let size = ["--size", "64x36"];
    for (arguments, first, kept) in [
        (&["bake", "scene.toml", "-o", "out/x.#.hair", "--frames", "1-900000"][..], "x.2.hair", true),
        (&["render", "scene.toml", "-o", "out/x.#.png", "--frames", "1-900000"], "x.2.png", true),
        (&["render", "scene.toml", "-o", "out/x.mp4", "--frames", "1-900000"], "", false),
    ] {
        let more = if arguments[0] == "render" { &size[..] } else { &[] };
        let child = start(f, &[arguments, more].concat());
        match kept {
            true => wait_for(&f.join("out").join(first)),
            false => {
                while !names(&f.join("out")).iter().any(|n| n.starts_with('.')) {
                    std::thread::sleep(Duration::from_millis(2));
                }
            }
        }
        signal(&child, "TERM");
        ended(child);
        no_temporary(&f.join("out"));
        let left = names(&f.join("out"));
        assert!(left.iter().all(|n| kept && !n.ends_with(".mp4")), "{left:?}");
        std::fs::remove_dir_all(f.join("out")).unwrap();
        std::fs::create_dir(f.join("out")).unwrap();
    }
}

#[test]
fn a_second_signal_ends_a_long_frame_immediately() {
    // A first signal between two frames ends the bake before the second: another attempt.
    let ended = (0..10).any(|_| two_signals().contains("interrupted before the end of the current frame"));
    assert!(ended, "the second signal never met a frame");
}

/// `timeout` sends a signal to the program and one to its group.
#[test]
fn two_signals_at_once_count_as_one() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 6000);
    let arguments =
        ["bake", "groom.hair", "-o", "x.#.hair", "--guides", "all", "--substeps", "1024", "--fps", "1"];
    let child = start(f, &arguments);
    wait_for(&f.join("x.1.hair"));
    let id = child.id().to_string();
    let both = "kill -TERM $0; sleep 0.02; kill -TERM $0";
    assert!(Command::new("sh").args(["-c", both, &id]).status().unwrap().success());
    let stderr = ended(child);
    assert!(stderr.contains("stopped after frame"), "{stderr}");
    no_temporary(f);
}

/// Sends two signals to a bake of long frames, the first after frame 1, and returns what it prints after the first.
fn two_signals() -> String {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 6000);
    // A second of simulation for each frame, in 1,024 substeps.
    let arguments =
        ["bake", "groom.hair", "-o", "x.#.hair", "--guides", "all", "--substeps", "1024", "--fps", "1"];
    let mut child = start(f, &arguments);
    wait_for(&f.join("x.1.hair"));
    signal(&child, "INT");
    let mut stderr = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("stopping after the current frame") {
        line.clear();
        assert!(stderr.read_line(&mut line).unwrap() > 0, "the first signal was not reported");
    }
    // Signals within 0.2 s count as one.
    std::thread::sleep(Duration::from_millis(300));
    signal(&child, "INT");
    ended(child);
    let mut rest = String::new();
    stderr.read_to_string(&mut rest).unwrap();
    let stopped = "stopped after frame 1 of 5";
    assert!(
        rest.contains("interrupted before the end of the current frame") || rest.contains(stopped),
        "{rest}"
    );
    no_temporary(f);
    assert!(!f.join("x.2.hair").exists());
    assert!(hairspring_io::read_groom(&f.join("x.1.hair"), &Default::default()).is_ok());
    rest
}
