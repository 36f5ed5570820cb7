//! `hairspring live`: the window. It also opens without a command if there is a desktop.

use crate::{console::Console, demo, fault::Fault};
use clap::{Parser, ValueEnum};
use hairspring_app::{Document, Drawn, Ended, RunError, Script, recovery_folder};
use hairspring_io::{Format, check_file, text_of};
use std::path::{Path, PathBuf};

/// Opens a window where hair can be viewed, touched and tuned while it moves.
#[derive(Parser, Default)]
#[command(after_help = "\
Examples:
  hairspring live shot.toml
  hairspring live ponytail.tfx                  a groom on its own; a body grows a short coat
  hairspring live --script show.txt

Press `?` in the window for the keys. A script has one command per line, such as `wait 30`, `set KEY VALUE`, `shot FILE.png` or `quit`; docs/window.md lists all. \
An error of a line is printed with the line's number. The script goes on, and the exit code is 2.")]
pub struct Options {
    /// A scene (.toml), a groom (.hair, .tfx, .data, .csv, .ply, .obj), a body (.glb, .gltf, .vrm, .obj, .tfxmesh) or a
    /// motion (.bvh) [default: the built-in head]
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,

    /// Run a script, line by line
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,

    /// Renderer for the hair
    #[arg(long, value_name = "WHO", default_value = "auto")]
    draw: Draw,
}

/// Renderer for the hair.
#[derive(Clone, Copy, Default, ValueEnum)]
enum Draw {
    /// The GPU if there is a hardware one, otherwise the CPU
    #[default]
    Auto,
    /// The window's device, even if it is a software renderer
    Gpu,
    /// The CPU rasterizer
    Cpu,
}

/// Runs the command.
pub fn run(options: &Options) -> Result<(), Fault> {
    let document = options.file.as_deref().map(open).transpose()?;
    // Nobody answers the offers of a scripted session.
    let recovery = if options.script.is_some() { None } else { recovery_folder() };
    let script = match &options.script {
        Some(path) => {
            let text = text_of(path).map_err(|why| Fault::reading(why, path))?;
            Script::parse(&path.display().to_string(), &text).map_err(|why| Fault::Usage(why.to_string()))?
        }
        None => Default::default(),
    };
    if !has_desktop() {
        let text = "there is no desktop to open a window on; neither WAYLAND_DISPLAY nor DISPLAY is set";
        return Err(Fault::Lacking(text.into()));
    }
    let drawn = match options.draw {
        Draw::Auto => Drawn::Auto,
        Draw::Gpu => Drawn::Gpu,
        Draw::Cpu => Drawn::Cpu,
    };
    let Ended { script_errors } = hairspring_app::run(hairspring_app::Options {
        document,
        script,
        drawn,
        recovery,
        ..Default::default()
    })
    .map_err(|why| match why {
        RunError::Scene(why) => Fault::Content(why),
        RunError::Window(why) => Fault::Lacking(why),
    })?;
    match script_errors {
        0 => Ok(()),
        1 => Err(Fault::Usage("a line of the script failed".into())),
        n => Err(Fault::Usage(format!("{n} lines of the script failed"))),
    }
}

/// Opens a file of any kind as a scene.
fn open(path: &Path) -> Result<Document, Fault> {
    check_file(path).map_err(|why| Fault::reading(why, path))?;
    let wrong = |why: hairspring_app::AppError| match Format::of(path) {
        Some(Format::TfxBone) | None => Fault::Usage(why.to_string()),
        Some(_) => Fault::Content(why.to_string()),
    };
    Document::open_any(path, None).map_err(wrong)
}

/// Runs without a command: opens the window if possible. Otherwise it prints one sentence and writes the
/// clip.
pub fn run_or_demo(console: Console) -> Result<(), Fault> {
    let why = match run(&Options::default()) {
        Err(Fault::Lacking(why)) => why,
        other => return other,
    };
    console.doing(format_args!("{why}; writing a clip instead (`hairspring demo`)"));
    demo::run(&demo::Options::parse_from(["demo"]), console)
}

/// Whether there is a desktop. On Windows and macOS there always is; elsewhere the environment must name an
/// X11 or Wayland display.
fn has_desktop() -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    cfg!(any(windows, target_os = "macos")) || set("WAYLAND_DISPLAY") || set("DISPLAY")
}
