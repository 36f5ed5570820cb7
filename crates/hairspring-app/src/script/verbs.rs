//! The commands of a script: their forms, their descriptions, and how they are read.

use super::{Line, arguments::Arguments};
use crate::{key::split_key, record::Kind, view::Tool};
use hairspring_scene::stage::Value;

/// A command of a script.
pub struct Verb {
    /// The first word of the line.
    pub name: &'static str,
    /// The rest of the line, in capitals; empty if there is none.
    pub arguments: &'static str,
    /// The rest of a line as an example.
    pub example: &'static str,
    /// What it does.
    pub does: &'static str,
    read: fn(Arguments<'_>) -> Result<Line, String>,
}

impl Verb {
    /// The row of the verb in the table of docs/window.md.
    pub fn row(&self) -> String {
        // A bare bar would end the cell.
        let form = format!("{} {}", self.name, self.arguments).replace('|', "\\|");
        format!("| `{}` | {} |", form.trim(), self.does)
    }
}

const fn verb(
    name: &'static str,
    arguments: &'static str,
    example: &'static str,
    does: &'static str,
    read: fn(Arguments<'_>) -> Result<Line, String>,
) -> Verb {
    Verb { name, arguments, example, does, read }
}

/// All commands.
pub const VERBS: &[Verb] = &[
    verb(
        "wait",
        "FRAMES",
        "30",
        "waits for this number of frames of 1/60 s; while paused, it advances by them",
        |r| Ok(Line::Wait(r.count("a number of frames", 0)?.into())),
    ),
    verb("play", "", "", "plays", |_| Ok(Line::Play(true))),
    verb("pause", "", "", "pauses", |_| Ok(Line::Play(false))),
    verb("step", "", "", "advances by one frame", |_| Ok(Line::Step)),
    verb("reset", "", "", "returns to time 0", |_| Ok(Line::Reset)),
    verb(
        "seek",
        "FRAME",
        "30",
        "pauses, and goes to the cached frame nearest to this one; frame 1 is at time 0",
        |r| Ok(Line::Seek(u64::from(r.count("a frame", 1)?) - 1)),
    ),
    verb(
        "range",
        "FIRST LAST",
        "10 60",
        "plays these frames in a loop; `range all` plays the whole motion",
        |r| {
            if r.text == "all" {
                return Ok(Line::Range(None));
            }
            let [first, last] = r.range()?.map(|frame| u64::from(frame) - 1);
            Ok(Line::Range(Some((first, last))))
        },
    ),
    verb("speed", "X", "0.5", "sets the seconds of the scene that play in a second", |r| {
        Ok(Line::Speed(r.speed()?))
    }),
    verb(
        "set",
        "KEY VALUE",
        "groom[0].look.roughness 0.5",
        "writes a value of the scene file by its key",
        |r| {
            let (key, value) = split_key(r.text);
            if value.is_empty() {
                return Err("`set` needs a key and a value".into());
            }
            let value =
                value.parse().map_err(|_| format!("'{value}' is not a valid value of a scene file"))?;
            Ok(Line::Set(key.parse()?, Some(value)))
        },
    ),
    verb(
        "unset",
        "KEY",
        "wind.gust",
        "removes a value that the scene file has, so that its default applies",
        |r| Ok(Line::Set(r.text.parse()?, None)),
    ),
    verb("undo", "", "", "undoes one change", |_| Ok(Line::Undo)),
    verb("redo", "", "", "redoes one change", |_| Ok(Line::Redo)),
    verb("new", "STYLE", "curly", "opens the built-in head in a style", |r| Ok(Line::New(r.text.to_owned()))),
    verb("open", "FILE", "shot.toml", "opens a file as *File > Open* does, without asking to save", |r| {
        Ok(Line::Open(r.path()?))
    }),
    verb(
        "save",
        "FILE",
        "shot.toml",
        "saves the scene that is selected for changes, as `.toml`; fails if another program changed its file",
        |r| Ok(Line::Save(r.path()?)),
    ),
    verb(
        "hand",
        "TOOL",
        "grab",
        "selects a tool: `look`, `grab`, `ball`, `head`, `pick`, `comb` or `hand`",
        |r| {
            let known = Tool::ALL.iter().find(|tool| tool.1.eq_ignore_ascii_case(r.text));
            let names = || Tool::ALL.map(|tool| tool.1.to_lowercase()).join(", ");
            let unknown = || format!("unknown tool '{}'; expected one of: {}", r.text, names());
            Ok(Line::Tool(known.ok_or_else(unknown)?.0))
        },
    ),
    verb(
        "drag",
        "X Y X Y FRAMES",
        "0.4 0.6 0.7 0.5 30",
        "presses at the first place, moves to the second in this number of frames of the window, and releases",
        |r| r.path_of_pointer().map(|(from, to, frames)| Line::Drag(from, to, frames)),
    ),
    verb(
        "hold",
        "X Y X Y FRAMES",
        "0.4 0.6 0.7 0.5 30",
        "drags, but does not release, so that `shot` shows the tool at work",
        |r| r.path_of_pointer().map(|(from, to, frames)| Line::Hold(from, to, frames)),
    ),
    verb("release", "", "", "releases what `hold` holds", |_| Ok(Line::Release)),
    verb(
        "show",
        "VALUE",
        "tension",
        "colors the hair by a value of the *Color* menu; `natural` is its own color",
        |r| {
            if r.text == "natural" {
                return Ok(Line::Show(None));
            }
            let known = Value::ALL.into_iter().find(|v| v.name().eq_ignore_ascii_case(r.text));
            let unknown = || {
                let names = Value::ALL.map(|v| v.name().to_lowercase()).join(", ");
                format!("unknown color '{}'; expected one of: natural, {names}", r.text)
            };
            Ok(Line::Show(Some(known.ok_or_else(unknown)?)))
        },
    ),
    verb("find", "TEXT", "wind", "searches for parameters, whose groups open", |r| {
        Ok(Line::Find(r.text.to_owned()))
    }),
    verb(
        "overlay",
        "NAME on|off",
        "slice on",
        "shows or hides an overlay: `hair`, `body`, `colliders`, `slice`, `volume`, `frames`, `roots`, `handles`",
        |r| {
            let (name, on) = r.named_switch()?;
            let known = SWITCHES.iter().find(|known| **known == name);
            let unknown = || format!("unknown overlay '{name}'; expected one of: {}", SWITCHES.join(", "));
            Ok(Line::Switch(known.ok_or_else(unknown)?, on))
        },
    ),
    verb("compare", "on|off", "on", "opens or closes the second scene", |r| r.switch("compare")),
    verb("second", "on|off", "on", "selects the second scene for changes, or the first", |r| {
        r.switch("second")
    }),
    verb("follow", "on|off", "on", "lets the camera move along with the hair, or not", |r| {
        r.switch("follow")
    }),
    verb("graphs", "on|off", "on", "shows or hides the graphs", |r| r.switch("graphs")),
    verb("presets", "on|off", "on", "shows or hides the presets", |r| r.switch("presets")),
    verb("help", "on|off", "on", "shows or hides the list of keys", |r| r.switch("help")),
    verb("panels", "on|off", "on", "shows or hides the panels", |r| r.switch("panels")),
    verb("still", "FILE", "a.png", "records a picture", |r| Ok(Line::Record(Kind::Still, r.path()?, 0.0))),
    verb("clip", "FILE SECONDS", "a.mp4 2", "records a clip of the play", |r| r.record(Kind::Clip)),
    verb("pictures", "FILE SECONDS", "a.##.png 2", "records numbered pictures", |r| r.record(Kind::Pictures)),
    verb("turntable", "FILE SECONDS", "a.mp4 2", "records a turn around the current moment", |r| {
        r.record(Kind::Turntable)
    }),
    verb(
        "size",
        "WIDTH HEIGHT",
        "1920 1080",
        "sets the size of recordings in pixels, 64 to 8192 each",
        |r| Ok(Line::Size(r.size()?)),
    ),
    verb("rate", "RATE", "24", "sets the frames per second of recordings and bakes, 1 to 240", |r| {
        Ok(Line::Rate(r.rate()?))
    }),
    verb("export", "FILE", "groom.hair", "writes the hair of the current frame", |r| {
        Ok(Line::Export(r.path()?))
    }),
    verb("bake", "FILE LAST", "hair.####.hair 60", "bakes the frames from 1 to this one, from time 0", |r| {
        r.bake()
    }),
    verb(
        "shot",
        "FILE",
        "window.png",
        "writes a picture of the window; if paused, once the hair is drawn in full quality",
        |r| Ok(Line::Shot(r.picture()?)),
    ),
    verb(
        "pace",
        "",
        "",
        "prints the renderer, the pictures per second, and the compute time of a frame",
        |_| Ok(Line::Pace),
    ),
    verb("quit", "", "", "closes the window without asking to save", |_| Ok(Line::Quit)),
];

/// Names of the overlays.
const SWITCHES: [&str; 8] = ["hair", "body", "colliders", "slice", "volume", "frames", "roots", "handles"];

/// Parses a line.
pub(super) fn read(line: &str) -> Result<Line, String> {
    let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let text = rest.trim();
    let known = VERBS.iter().find(|verb| verb.name == word);
    let verb = known
        .ok_or_else(|| format!("unknown command '{word}'; docs/window.md lists the commands of a script"))?;
    if verb.arguments.is_empty() && !text.is_empty() {
        return Err(format!("`{word}` takes no argument, but found '{text}'"));
    }
    (verb.read)(Arguments { word, text })
}
