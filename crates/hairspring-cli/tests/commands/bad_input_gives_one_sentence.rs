//! Promise: bad input ends with one clear sentence and a specific exit code, and leaves no partial files.
//!
//! Scripts branch on the code, and people read the sentence, so it names the file and the problem. After
//! each refusal the folder is unchanged: no output, no temporary file.

use crate::common::{contents, fail, groom, names, program, run, succeed, write_groom};
use glam::Vec3;
use std::path::Path;

/// Runs the program. It must fail with `code` and one line that contains `words`, and leave the folder
/// unchanged.
fn refuse(folder: &Path, arguments: &[&str], code: i32, words: &[&str]) {
    let before = contents(folder);
    let output = run(folder, arguments);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    let errors: Vec<&str> = stderr.lines().filter(|l| !l.starts_with("note: ")).collect();
    assert!(errors.len() == 1 && errors[0].starts_with("error: "), "{arguments:?}: {stderr}");
    for word in words {
        assert!(errors[0].contains(word), "{arguments:?}: '{word}' is missing in: {stderr}");
    }
    assert!(output.stdout.is_empty(), "{arguments:?} printed {:?}", output.stdout);
    assert!(contents(folder) == before, "{arguments:?} left something behind");
}

#[test]
fn a_command_of_the_python_package_is_said_to_come_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let words = ["`hairspring wedge` comes with the Python package", "pip install"];
    refuse(folder.path(), &["wedge", "shot.toml", "--set", "wind.gust=0;1"], 2, &words);
}

#[test]
fn missing_and_unknown_files() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    refuse(f, &["info", "no.hair"], 3, &["no.hair", "not found"]);
    refuse(f, &["convert", "no.hair", "out.tfx"], 3, &["no.hair"]);
    refuse(f, &["bake", "no.toml", "-o", "x.#.hair"], 3, &["no.toml"]);
    refuse(f, &["render", "no.hair", "-o", "x.png"], 3, &["no.hair"]);
    std::fs::write(f.join("hair.xyz"), "?").unwrap();
    refuse(f, &["info", "hair.xyz"], 2, &["hair.xyz", ".tfx"]);
    refuse(f, &["render", "hair.xyz", "-o", "x.png"], 2, &["hair.xyz", ".toml"]);
    write_groom(f, 5);
    refuse(f, &["convert", "groom.hair", "groom.abc"], 2, &["groom.abc", ".tfx"]);
    refuse(f, &["render", "groom.hair", "-o", "x.gif"], 2, &["x.gif", ".png"]);
    refuse(f, &["bake", "groom.hair", "-o", "x.#.png"], 2, &["x.#.png", ".hair"]);
}

#[test]
fn an_output_never_replaces_a_file_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    hairspring_io::write_groom(&f.join("fan.2.data"), &groom(4)).unwrap();
    std::fs::write(f.join("s.toml"), "[[groom]]\nfile = \"fan.2.data\"\nscale = 1.0\n").unwrap();
    let words = ["fan.2.data", "is an input file and would be replaced"];
    refuse(f, &["bake", "s.toml", "-o", "fan.#.data", "--frames", "1-3"], 2, &words);
    refuse(f, &["bake", "./fan.2.data", "-o", "fan.2.data", "--frames", "1-1"], 2, &words);
    // Frame 2 is not written.
    succeed(f, &["bake", "s.toml", "-o", "fan.#.data", "--frames", "3-4"]);
    let around = format!("../{}/fan.2.data", f.file_name().unwrap().to_str().unwrap());
    for same in ["fan.2.data", "./fan.2.data", &around] {
        refuse(f, &["convert", "fan.2.data", same], 2, &words);
    }
    let map = "[builtin]\nstrands = 20\nguides = 10\nmaps = { length = { texture = \"map.png\" } }\n";
    let mut white = hairspring_view::Image::new(4, 4);
    white.rgb.fill(255);
    hairspring_view::write_png(&f.join("map.png"), &white).unwrap();
    std::fs::write(f.join("map.toml"), map).unwrap();
    let compare = ["compare", "map.toml", "--set-b", "wind.gust=0.5", "-o", "map.png"];
    refuse(f, &compare, 2, &["map.png is an input file"]);
}

#[cfg(unix)]
#[test]
fn an_output_never_replaces_a_pipe_or_a_socket() {
    use std::os::unix::{fs::FileTypeExt, net::UnixListener};
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 5);
    for name in ["pipe.hair", "pipe.png", "pipe.mp4"] {
        assert!(std::process::Command::new("mkfifo").arg(f.join(name)).status().unwrap().success());
    }
    let _socket = UnixListener::bind(f.join("socket.data")).unwrap();
    for (arguments, to) in [
        (&["convert", "groom.hair", "pipe.hair"][..], "pipe.hair"),
        (&["convert", "groom.hair", "socket.data"], "socket.data"),
        (&["bake", "groom.hair", "--frames", "1-1", "-o", "pipe.hair"], "pipe.hair"),
        (&["render", "groom.hair", "-o", "pipe.png"], "pipe.png"),
        (&["render", "groom.hair", "-o", "pipe.mp4"], "pipe.mp4"),
    ] {
        let stderr = fail(f, arguments, 5);
        assert!(stderr.contains(&format!("{to} is a pipe, a socket or a device; name a file")), "{stderr}");
        let kind = f.join(to).metadata().unwrap().file_type();
        assert!(kind.is_fifo() || kind.is_socket(), "{arguments:?}");
    }
}

#[cfg(unix)]
#[test]
fn an_output_never_replaces_an_input_through_a_link() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 5);
    for (link, to) in [("link.hair", "groom.hair"), ("far.hair", "link.hair")] {
        std::os::unix::fs::symlink(to, f.join(link)).unwrap();
    }
    for (from, to) in [("groom.hair", "link.hair"), ("far.hair", "groom.hair"), ("link.hair", "far.hair")] {
        refuse(f, &["convert", from, to], 2, &["is an input file and would be replaced"]);
    }
}

/// A pipe would wait for a writer. One is there, so that a program that opens the pipe ends this test, too.
#[cfg(unix)]
#[test]
fn pipes_are_no_input() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    std::fs::write(f.join("head.toml"), "[builtin]\nstrands = 10\nguides = 5\n").unwrap();
    for pipe in ["pipe.toml", "pipe.hair", "pipe.glb", "pipe.bvh", "pipe.txt", "pipe.pc2"] {
        assert!(std::process::Command::new("mkfifo").arg(f.join(pipe)).status().unwrap().success());
        let path = f.join(pipe);
        std::thread::spawn(move || std::fs::OpenOptions::new().write(true).open(path));
        std::os::unix::fs::symlink(pipe, f.join(format!("link-{pipe}"))).unwrap();
    }
    let before = names(f);
    let wanted = "could not be read: it is a pipe, a socket or a device";
    for arguments in [
        &["live", "pipe.toml"][..],
        &["live", "pipe.hair"],
        &["live", "link-pipe.glb"],
        &["live", "pipe.bvh"],
        &["live", "--script", "pipe.txt"],
        &["live", "--script", "link-pipe.txt", "head.toml"],
        &["info", "pipe.pc2"],
        &["info", "link-pipe.toml"],
        &["convert", "pipe.hair", "a.data"],
    ] {
        let error = fail(f, arguments, 3);
        assert!(error.contains(wanted), "{arguments:?}: {error}");
    }
    assert_eq!(names(f), before);
}

#[test]
fn a_script_has_a_largest_size() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    std::fs::File::create(f.join("long.txt")).unwrap().set_len(65 << 20).unwrap();
    let error = fail(f, &["live", "--script", "long.txt"], 4);
    assert!(error.contains("long.txt") && error.contains("limit of 67108864 bytes"), "{error}");
}

/// A scheduler reads lines such as `openjd_fail: REASON` on standard output and standard error.
#[cfg(unix)]
#[test]
fn a_name_never_begins_a_line() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 5);
    let evil = "a\nopenjd_fail: b\u{202e}";
    std::fs::write(f.join(format!("{evil}.hair")), std::fs::read(f.join("groom.hair")).unwrap()).unwrap();
    let scene =
        "name = \"a\\nopenjd_fail: b\\u202e\"\n[[groom]]\nfile = \"groom.hair\"\nname = \"\\u001b[31m\"\n";
    std::fs::write(f.join("scene.toml"), scene).unwrap();
    let groom = format!("{evil}.hair");
    let [numbered, copy] = [format!("{evil}.#.hair"), format!("{evil}.data")];
    for arguments in [
        &["bake", "scene.toml", "-o", &numbered, "--frames", "1-2", "--progress", "openjd"][..],
        &["bake", "scene.toml", "-o", &numbered, "--frames", "1-3", "--resume"],
        &["bake", "scene.toml", "-o", &numbered, "--frames", "1-2", "--fps", "24"],
        &["bake", "scene.toml", "-o", &numbered, "--frames", "1-2", "--fps", "25", "--progress", "json"],
        &["bake", "scene.toml", "-o", &numbered, "--frames", "1-2", "--fps", "25", "--json"],
        &["info", "scene.toml"],
        &["info", "scene.toml", "--json"],
        &["info", &groom],
        &["convert", &groom, &copy],
        &["compare", &groom, "groom.hair", "--no-picture", "--seconds", "0.1"],
        &["compare", "scene.toml", "--set-b", "wind.gust=0.5", "--no-picture", "--seconds", "0.1", "--json"],
        &["render", &groom, "-o", "a.png", "--size", "64x64", "--frames", evil],
        &["bake", "scene.toml", "-o", &format!("{evil}.png")],
        &["info", &format!("{evil}.none")],
        &[evil],
    ] {
        let output = run(f, arguments);
        for text in [output.stdout, output.stderr] {
            let text = String::from_utf8(text).unwrap();
            assert!(!text.lines().any(|line| line.starts_with("openjd_fail")), "{arguments:?}: {text}");
            let shown = |c: char| c != '\n' && hairspring_io::is_hidden(c);
            assert!(!text.contains(shown), "{arguments:?}: {text:?}");
        }
    }
    let found = crate::common::json(&succeed(
        f,
        &["bake", "scene.toml", "-o", &numbered, "--frames", "1-2", "--json"],
    ));
    assert_eq!(found["output"], numbered.as_str(), "the path as JSON is the path");
}

#[test]
fn a_file_in_the_place_of_a_folder_is_said_to_be_one() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 5);
    let words = ["groom.hair is a file and not a folder"];
    refuse(f, &["bake", "groom.hair", "-o", "groom.hair/c.#.hair"], 5, &words);
    let error = fail(f, &["bake", "groom.hair", "-o", "x.#.hair", "--guides", "99999999999"], 2);
    assert!(error.contains("expected a number from 1 to 4294967295"), "{error}");
}

#[test]
fn one_file_has_no_frame_number() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 5);
    let words = ["writes one file", "leave out the # signs"];
    refuse(f, &["convert", "groom.hair", "x.##.data"], 2, &words);
    let settings = ["--set-a", "wind.gust=0.1", "--set-b", "wind.gust=0.5"];
    for output in ["x.####.png", "x.#.mp4", "x.##.jpg"] {
        refuse(f, &[&["compare", "groom.hair", "-o", output][..], &settings].concat(), 2, &words);
    }
}

#[test]
fn a_refused_cache_leaves_no_folder() {
    let folder = tempfile::tempdir().unwrap();
    write_groom(folder.path(), 5);
    let bake = ["bake", "groom.hair", "-o", "x.pc2", "--start", "1001", "--frames", "1-3"];
    refuse(folder.path(), &bake, 2, &["frame 1 is before frame 1001"]);
}

#[cfg(unix)]
#[test]
fn numbered_names_must_be_valid_text() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    write_groom(folder.path(), 5);
    let output = std::ffi::OsStr::from_bytes(b"\xff.#.data");
    let done = program(folder.path(), &["bake", "groom.hair", "-o"]).arg(output).output().unwrap();
    let error = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.code() == Some(2) && error.contains("not valid UTF-8"), "{error}");
}

#[test]
fn live_refuses_files_that_cannot_be_opened() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    refuse(f, &["live", "no.toml"], 3, &["no.toml"]);
    refuse(f, &["live", "--script", "no.txt"], 3, &["no.txt"]);
    std::fs::write(f.join("hair.xyz"), "?").unwrap();
    refuse(f, &["live", "hair.xyz"], 2, &["hair.xyz", ".toml", ".vrm"]);
    std::fs::write(f.join("wrong.toml"), "[builtin]\nstrand = 3\n").unwrap();
    refuse(f, &["live", "wrong.toml"], 4, &["wrong.toml", "strand"]);
    std::fs::write(f.join("wrong.txt"), "play\n\nfly away\n").unwrap();
    refuse(f, &["live", "--script", "wrong.txt"], 2, &["wrong.txt, line 3", "fly"]);
}

#[test]
fn no_graphics_card() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 5);
    let before = contents(f);
    // A graphics API that this machine cannot have: DirectX 12 outside Windows, Metal on Windows.
    let none = if cfg!(windows) { "metal" } else { "dx12" };
    let arguments = ["render", "groom.hair", "-o", "x.png", "--gpu", "--size", "64x36"];
    let output = program(f, &arguments).env("WGPU_BACKEND", none).output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(7), "{stderr}");
    let errors: Vec<&str> = stderr.lines().filter(|l| !l.starts_with("note: ")).collect();
    assert!(
        errors.len() == 1 && errors[0].contains("no GPU is available") && errors[0].contains("install"),
        "{stderr}"
    );
    assert!(contents(f) == before);
}

#[test]
fn truncated_and_empty_files() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let path = write_groom(f, 20);
    let bytes = std::fs::read(&path).unwrap();
    for cut in [0, 3, 100, bytes.len() / 2, bytes.len() - 1] {
        std::fs::write(&path, &bytes[..cut]).unwrap();
        refuse(f, &["info", "groom.hair"], 4, &["groom.hair"]);
        refuse(f, &["convert", "groom.hair", "out.tfx"], 4, &["groom.hair"]);
        refuse(f, &["render", "groom.hair", "-o", "x.mp4"], 4, &["groom.hair"]);
    }
    // No strands at all.
    std::fs::write(f.join("none.data"), 0i32.to_le_bytes()).unwrap();
    refuse(f, &["info", "none.data"], 4, &["none.data", "no strands"]);
    refuse(f, &["render", "none.data", "-o", "x.png"], 4, &["none.data", "no strands"]);
}

#[test]
fn non_finite_points_are_repaired_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let mut broken = groom(10);
    broken.points[4] = Vec3::NAN;
    hairspring_io::write_groom(&folder.path().join("nan.hair"), &broken).unwrap();
    let output = run(folder.path(), &["convert", "nan.hair", "mended.hair"]);
    assert!(output.status.success());
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(stderr.contains("repaired 1 points that were not finite"), "{stderr}");
    let found = crate::common::json(&succeed(folder.path(), &["info", "mended.hair", "--json"]));
    assert_eq!(found["repaired"], 0);
}

#[test]
fn invalid_scenes() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 5);
    let scene = |text: &str| std::fs::write(f.join("scene.toml"), text).unwrap();
    let bake = ["bake", "scene.toml", "-o", "x.#.hair"];
    scene("[[groom]]\nfile = \"groom.hair\"\ngiudes = 5\n");
    refuse(f, &bake, 4, &["scene.toml", "line 3", "did you mean `guides`?"]);
    scene("[[groom]]\nfile = \"groom.hair\"\n[body]\nfile = \"head.obj\"\n");
    refuse(f, &bake, 3, &["head.obj", "scene.toml", "line 4"]);
    scene("[[groom]]\nfile = \"groom.doc\"\n");
    refuse(f, &bake, 4, &["groom.doc"]);
    scene("gravity = [0.0, -9.81, 0.0]\n");
    refuse(f, &bake, 4, &["scene.toml", "[[groom]]"]);
    scene("[[groom]]\nfile = \"groom.hair\"\n");
    refuse(f, &["bake", "scene.toml", "-o", "x.#.hair", "--scale", "2"], 2, &["--scale"]);
}

#[test]
fn impossible_outputs() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 5);
    refuse(f, &["render", "groom.hair", "-o", "no/x.png"], 5, &["no", "does not exist"]);
    refuse(f, &["bake", "groom.hair", "-o", "no/x.#.hair"], 5, &["no", "does not exist"]);
    refuse(f, &["convert", "groom.hair", "no/x.tfx"], 5, &["no", "does not exist"]);
    refuse(f, &["bake", "groom.hair", "-o", "x.hair"], 2, &["x.hair", "#"]);
    refuse(f, &["render", "groom.hair", "-o", "x.png", "--frames", "1-5"], 2, &["x.png", "#"]);
    refuse(f, &["render", "groom.hair", "-o", "x.mp4", "--resume"], 2, &["--resume"]);
    refuse(f, &["render", "groom.hair", "-o", "x.mp4", "--size", "8x8"], 2, &["8×8"]);
}

/// A .tfx file cannot hold strands of different point counts. A bake says so before it simulates and writes.
#[test]
fn strands_that_the_format_cannot_hold() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 5);
    let words = ["tfx", "needs the same number of points in every strand"];
    refuse(f, &["convert", "groom.hair", "x.tfx"], 4, &words);
    let bake = ["bake", "groom.hair", "-o", "x.#.tfx"];
    refuse(f, &bake, 4, &words);
    refuse(f, &[&bake[..], &["--only-guides"]].concat(), 4, &words);
}

#[test]
fn a_preroll_out_of_range_names_the_option() {
    let folder = tempfile::tempdir().unwrap();
    write_groom(folder.path(), 5);
    for seconds in ["61", "-1", "long"] {
        let preroll = format!("--preroll={seconds}");
        let error = fail(folder.path(), &["bake", "groom.hair", "-o", "x.#.hair", &preroll], 2);
        assert!(error.contains("--preroll") && error.contains("from 0 to 60"), "{error}");
    }
}

#[cfg(unix)]
#[test]
fn read_only_folders() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 5);
    let closed = tempfile::tempdir().unwrap();
    std::fs::set_permissions(closed.path(), std::fs::Permissions::from_mode(0o555)).unwrap();
    // Permissions do not restrict the superuser; the process file system accepts files from nobody.
    let closed = match tempfile::tempfile_in(closed.path()) {
        Err(_) => closed.path(),
        Ok(_) if Path::new("/proc/self").exists() => Path::new("/proc"),
        Ok(_) => return println!("skipped: every folder is writable here"),
    };
    let at = |name: &str| closed.join(name).to_str().unwrap().to_owned();
    refuse(f, &["render", "groom.hair", "-o", &at("x.png")], 5, &["cannot write to the folder"]);
    refuse(f, &["render", "groom.hair", "-o", &at("x.mp4")], 5, &["cannot write to the folder"]);
    refuse(f, &["bake", "groom.hair", "-o", &at("x.#.hair")], 5, &["cannot write to the folder"]);
    refuse(f, &["convert", "groom.hair", &at("x.tfx")], 5, &["cannot write to the folder"]);
    let demo = ["demo", "--strands", "10", "--seconds", "0.1", "-o", closed.to_str().unwrap()];
    refuse(f, &demo, 5, &["cannot write to the folder"]);
}
