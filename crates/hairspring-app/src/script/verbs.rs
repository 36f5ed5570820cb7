//! The commands of a script: their forms, their descriptions, and how they are read.

use super::Line;
use crate::{record::Kind, view::Tool};
use glam::Vec2;
use hairspring_scene::stage::Value;
use std::path::PathBuf;

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
    read: fn(Rest<'_>) -> Result<Line, String>,
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
    read: fn(Rest<'_>) -> Result<Line, String>,
) -> Verb {
    Verb { name, arguments, example, does, read }
}

/// All commands.
pub const VERBS: &[Verb] = &[
    verb(
        "wait",
        "STEPS",
        "30",
        "waits for this number of steps of 1/60 s; while paused, it takes them",
        |r| Ok(Line::Wait(r.number()?.max(0.0) as u64)),
    ),
    verb("play", "", "", "plays", |_| Ok(Line::Play(true))),
    verb("pause", "", "", "pauses", |_| Ok(Line::Play(false))),
    verb("step", "", "", "takes one step", |_| Ok(Line::Step)),
    verb("reset", "", "", "returns to time 0", |_| Ok(Line::Reset)),
    verb(
        "seek",
        "FRAME",
        "30",
        "pauses, and goes to the cached frame nearest to this one; frame 1 is at time 0",
        |r| Ok(Line::Seek((r.number()?.max(1.0) as u64) - 1)),
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
            match r.numbers()?[..] {
                [first, last] if first >= 1.0 && last > first => {
                    Ok(Line::Range(Some((first as u64 - 1, last as u64 - 1))))
                }
                _ => {
                    Err("`range` needs the first and a later last frame, such as `range 10 60`, or `all`"
                        .into())
                }
            }
        },
    ),
    verb("speed", "X", "0.5", "sets the seconds of the scene that play in a second", |r| {
        Ok(Line::Speed(r.number()?))
    }),
    verb(
        "set",
        "KEY VALUE",
        "groom[0].look.roughness 0.5",
        "writes a value of the scene file by its key",
        |r| {
            let (key, value) = r.two("a key and a value")?;
            let value =
                value.parse().map_err(|_| format!("'{value}' is not a valid value of a scene file"))?;
            Ok(Line::Set(key.parse()?, Some(value)))
        },
    ),
    verb(
        "unset",
        "KEY",
        "wind.gust",
        "removes a value of the scene file, so that its default applies",
        |r| Ok(Line::Set(r.text.parse()?, None)),
    ),
    verb("undo", "", "", "undoes one step", |_| Ok(Line::Undo)),
    verb("redo", "", "", "redoes one step", |_| Ok(Line::Redo)),
    verb("new", "STYLE", "curly", "opens the built-in head in a style", |r| Ok(Line::New(r.text.to_owned()))),
    verb("open", "FILE", "shot.toml", "opens a file as *File > Open* does, without asking to save", |r| {
        Ok(Line::Open(r.path()?))
    }),
    verb("save", "FILE", "shot.toml", "saves the scene", |r| Ok(Line::Save(r.path()?))),
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
            let (name, state) = r.two("a name and on or off")?;
            let known = SWITCHES.iter().find(|known| **known == name);
            Ok(Line::Switch(known.ok_or_else(|| format!("'{name}' is no overlay"))?, on(state)?))
        },
    ),
    verb("compare", "on|off", "on", "opens or closes the second scene", |r| r.switch("compare")),
    verb("second", "on|off", "on", "selects the second scene for changes, or the first", |r| {
        r.switch("second")
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
    verb("size", "WIDTH HEIGHT", "1920 1080", "sets the size of recordings in pixels", |r| {
        match r.numbers()?[..] {
            [width, height] => Ok(Line::Size([width as u32, height as u32])),
            _ => Err("`size` needs a width and a height, such as `size 1920 1080`".into()),
        }
    }),
    verb("rate", "RATE", "24", "sets the frames per second of recordings and bakes", |r| {
        Ok(Line::Rate(r.text.parse()?))
    }),
    verb("export", "FILE", "groom.hair", "writes the hair of the current frame", |r| {
        Ok(Line::Export(r.path()?))
    }),
    verb("bake", "FILE LAST", "hair.####.hair 60", "bakes the frames from 1 to this one, from time 0", |r| {
        let (file, last) = r.last("a file and the last frame")?;
        let number = last.parse().ok().filter(|last| *last > 0);
        Ok(Line::Bake(file, [1, number.ok_or_else(|| format!("'{last}' is no number of a frame"))?]))
    }),
    verb(
        "shot",
        "FILE",
        "window.png",
        "writes a picture of the window; if paused, once the hair is drawn in full quality",
        |r| Ok(Line::Shot(r.path()?)),
    ),
    verb("pace", "", "", "prints the renderer, the pictures per second, and the time of a step", |_| {
        Ok(Line::Pace)
    }),
    verb("quit", "", "", "closes the window without asking to save", |_| Ok(Line::Quit)),
];

/// Names of the overlays.
const SWITCHES: [&str; 8] = ["hair", "body", "colliders", "slice", "volume", "frames", "roots", "handles"];

/// Parses a line.
pub(super) fn read(line: &str) -> Result<Line, String> {
    let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let text = rest.trim();
    let known = VERBS.iter().find(|verb| verb.name == word);
    let verb =
        known.ok_or_else(|| format!("'{word}' is no command of a script; docs/window.md lists them"))?;
    if verb.arguments.is_empty() && !text.is_empty() {
        return Err(format!("`{word}` takes no argument, but found '{text}'"));
    }
    (verb.read)(Rest { word, text })
}

/// What follows the first word of a line.
#[derive(Clone, Copy)]
struct Rest<'a> {
    word: &'a str,
    text: &'a str,
}

impl<'a> Rest<'a> {
    fn numbers(self) -> Result<Vec<f32>, String> {
        let read = self.text.split_whitespace().map(|n| n.parse::<f32>().ok().filter(|n| n.is_finite()));
        read.collect::<Option<_>>().ok_or_else(|| format!("'{}' are not numbers", self.text))
    }

    fn number(self) -> Result<f32, String> {
        self.numbers()?.first().copied().ok_or_else(|| format!("`{}` needs a number", self.word))
    }

    /// The first word, and what follows it.
    fn two(self, what: &str) -> Result<(&'a str, &'a str), String> {
        let (first, second) = self
            .text
            .split_once(char::is_whitespace)
            .ok_or_else(|| format!("`{}` needs {what}", self.word))?;
        Ok((first, second.trim()))
    }

    fn path(self) -> Result<PathBuf, String> {
        match self.text {
            "" => Err(format!("`{}` needs a file", self.word)),
            name => Ok(PathBuf::from(name)),
        }
    }

    /// Two places in the picture, and a number of frames.
    fn path_of_pointer(self) -> Result<(Vec2, Vec2, u32), String> {
        match self.numbers()?[..] {
            [a, b, c, d, frames] => Ok((Vec2::new(a, b), Vec2::new(c, d), frames.max(1.0) as u32)),
            _ => Err(format!("`{}` needs five numbers: from x y, to x y, frames", self.word)),
        }
    }

    fn record(self, kind: Kind) -> Result<Line, String> {
        let (file, seconds) = self.last("a file and seconds")?;
        let seconds = seconds.parse().map_err(|_| format!("'{seconds}' is no number of seconds"))?;
        Ok(Line::Record(kind, file, seconds))
    }

    /// A file, whose name may have spaces, and the last word.
    fn last(self, what: &str) -> Result<(PathBuf, &'a str), String> {
        let (file, last) = self
            .text
            .rsplit_once(char::is_whitespace)
            .ok_or_else(|| format!("`{}` needs {what}", self.word))?;
        Ok((file.trim().into(), last))
    }

    fn switch(self, name: &'static str) -> Result<Line, String> {
        Ok(Line::Switch(name, on(self.text)?))
    }
}

fn on(state: &str) -> Result<bool, String> {
    match state {
        "on" => Ok(true),
        "off" => Ok(false),
        other => Err(format!("'{other}' is neither on nor off")),
    }
}
