//! `hairspring live`, and what runs without a command where there is a desktop: the window.

use crate::{console::Console, demo, fault::Fault};
use clap::{Parser, ValueEnum};
use hairspring_app::{Document, Drawn, read_script};
use std::path::PathBuf;

/// Opens the window: hair to look at, touch and tune while it moves.
#[derive(Parser, Default)]
#[command(after_help = "\
Examples:
  hairspring live shot.toml
  hairspring live --script show.txt

Keys are on `?` in the window. A script is a session line by line: wait 30, set KEY VALUE, drag X Y X Y FRAMES, shot FILE.png, pace, quit.")]
pub struct Options {
    /// A scene file; without one, the built-in head
    scene: Option<PathBuf>,

    /// Does what a script says, line by line
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,

    /// Who draws the hair
    #[arg(long, value_name = "WHO", default_value = "auto")]
    draw: Draw,
}

/// Who draws the hair.
#[derive(Clone, Copy, Default, ValueEnum)]
enum Draw {
    /// The GPU, where there is a real one
    #[default]
    Auto,
    /// The window's device, even where that is software
    Gpu,
    /// The CPU rasteriser
    Cpu,
}

/// Runs the command.
pub fn run(options: &Options) -> Result<(), Fault> {
    if !has_desktop() {
        let text = "there is no desktop to open a window on: neither WAYLAND_DISPLAY nor DISPLAY is set";
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

/// What runs without a command: the window where there can be one, else the clip, with one sentence.
pub fn run_or_demo(console: Console) -> Result<(), Fault> {
    let why = match run(&Options::default()) {
        Err(Fault::Lacking(why)) => why,
        other => return other,
    };
    console.doing(format_args!("{why}; writing a clip instead (`hairspring demo`)"));
    demo::run(&demo::Options::parse_from(["demo"]), console)
}

/// Whether a window system is named in the environment; everywhere but on Unixes with X11 or Wayland there always is one.
fn has_desktop() -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    cfg!(any(windows, target_os = "macos")) || set("WAYLAND_DISPLAY") || set("DISPLAY")
}
