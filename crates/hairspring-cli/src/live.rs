//! `hairspring live`: the window. It also opens without a command if there is a desktop.

use crate::{console::Console, demo, fault::Fault};
use clap::{Parser, ValueEnum};
use hairspring_app::{Document, Drawn, read_script};
use std::path::PathBuf;

/// Opens a window where hair can be viewed, touched and tuned while it moves.
#[derive(Parser, Default)]
#[command(after_help = "\
Examples:
  hairspring live shot.toml
  hairspring live --script show.txt

Press `?` in the window for the keys. A script has one command per line: wait 30, set KEY VALUE, drag X Y X Y FRAMES, shot FILE.png, pace, quit.")]
pub struct Options {
    /// A scene file [default: the built-in head]
    scene: Option<PathBuf>,

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
    if !has_desktop() {
        let text = "there is no desktop to open a window on; neither WAYLAND_DISPLAY nor DISPLAY is set";
        return Err(Fault::Lacking(text.into()));
    }
    let document = options.scene.as_ref().map(|path| Document::open(path)).transpose();
    let document = document.map_err(|why| Fault::Content(why.to_string()))?;
    let script = match &options.script {
        Some(path) => {
            let text = std::fs::read_to_string(path)
                .map_err(|why| Fault::Unreadable(format!("{} could not be read: {why}", path.display())))?;
            read_script(&text).map_err(|why| Fault::Content(why.to_string()))?
        }
        None => Default::default(),
    };
    let drawn = match options.draw {
        Draw::Auto => Drawn::Auto,
        Draw::Gpu => Drawn::Gpu,
        Draw::Cpu => Drawn::Cpu,
    };
    hairspring_app::run(hairspring_app::Options { document, script, drawn })
        .map_err(|why| Fault::Lacking(why.to_string()))
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
