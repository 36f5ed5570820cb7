//! Scripted sessions: user input line by line, for tests, pictures and demonstrations.
//!
//! ```text
//! # coordinates: from the picture's top left corner (0, 0) to its bottom right (1, 1)
//! wait 30                          waits for steps of the simulation
//! set groom[0].look.roughness 0.5  writes a value by its key; `unset KEY` removes it
//! hand grab                        selects a tool: look, grab, ball, head, pick, comb, hand
//! drag 0.4 0.6 0.7 0.5 30          presses, moves in this number of frames of the window, releases
//! hold 0.4 0.6 0.7 0.5 30          the same, but holds until `release`, to show the effect of a tool
//! shot window.png                  writes a picture of the window; if paused, once it is drawn in full quality
//! pace                             prints the renderer, the pictures per second, and the time of a step
//! ```
//!
//! Other commands: `play`, `pause`, `step`, `reset`, `speed X`, `undo`, `redo`, `new STYLE`, `open FILE`,
//! `save FILE`, `show VALUE` (or `natural`), `find TEXT` (parameters), `overlay NAME on|off`, `compare
//! on|off`, `second on|off`, `graphs on|off`, `presets on|off`, `help on|off`, `panels on|off`, `still FILE`,
//! `clip FILE SECONDS`, `pictures FILE SECONDS`, `turntable FILE SECONDS`, `quit`.

use crate::{AppError, key::Key, record::Kind, view::Hand};
use glam::Vec2;
use hairspring_scene::stage::Value;
use std::{collections::VecDeque, path::PathBuf};

/// A line of a script.
#[derive(Clone, Debug)]
pub enum Line {
    /// Waits for this number of steps.
    Wait(u64),
    /// Plays or pauses.
    Play(bool),
    /// Advances by one step.
    Step,
    /// Returns to time 0.
    Reset,
    /// Playback speed in scene seconds per second.
    Speed(f32),
    /// Writes a value, or removes it.
    Set(Key, Option<toml_edit::Value>),
    /// Undoes one step.
    Undo,
    /// Redoes one step.
    Redo,
    /// Opens the built-in head in a style.
    New(String),
    /// Opens a file.
    Open(PathBuf),
    /// Saves the scene.
    Save(PathBuf),
    /// Selects a tool.
    Hand(Hand),
    /// Drags from one point of the picture to another in this number of frames.
    Drag(Vec2, Vec2, u32),
    /// Like `Drag`, but does not release.
    Hold(Vec2, Vec2, u32),
    /// Releases the pointer.
    Release,
    /// Selects the value that colors show.
    Show(Option<Value>),
    /// Searches for parameters, whose groups open.
    Find(String),
    /// Switches something on or off by its name.
    Switch(String, bool),
    /// Records for this number of seconds.
    Record(Kind, PathBuf, f32),
    /// Writes the window as a picture.
    Shot(PathBuf),
    /// Prints the speed.
    Pace,
    /// Closes the window.
    Quit,
}

/// Names of the switches of [`Line::Switch`].
pub const SWITCHES: [&str; 14] = [
    "compare",
    "second",
    "graphs",
    "presets",
    "help",
    "panels",
    "hair",
    "body",
    "colliders",
    "slice",
    "volume",
    "frames",
    "roots",
    "handles",
];

/// Parses a script.
pub fn parse(text: &str) -> Result<VecDeque<Line>, AppError> {
    let mut lines = VecDeque::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let read =
            read(line).map_err(|why| AppError::new(format!("the script, line {}: {why}", number + 1)))?;
        lines.push_back(read);
    }
    Ok(lines)
}

fn read(line: &str) -> Result<Line, String> {
    let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let rest = rest.trim();
    let numbers = || -> Result<Vec<f32>, String> {
        let read = rest.split_whitespace().map(|n| n.parse::<f32>().ok().filter(|n| n.is_finite()));
        read.collect::<Option<_>>().ok_or_else(|| format!("'{rest}' are not numbers"))
    };
    let one = || numbers()?.first().copied().ok_or_else(|| format!("`{word}` needs a number"));
    let path = || match rest {
        "" => Err(format!("`{word}` needs a file")),
        name => Ok(PathBuf::from(name)),
    };
    let on = |state: &str| match state {
        "on" => Ok(true),
        "off" => Ok(false),
        other => Err(format!("'{other}' is neither on nor off")),
    };
    let record = |kind: Kind| -> Result<Line, String> {
        let (file, seconds) = rest
            .rsplit_once(char::is_whitespace)
            .ok_or_else(|| format!("`{word}` needs a file and seconds"))?;
        let seconds = seconds.parse().map_err(|_| format!("'{seconds}' is no number of seconds"))?;
        Ok(Line::Record(kind, file.trim().into(), seconds))
    };
    Ok(match word {
        "wait" => Line::Wait(one()?.max(0.0) as u64),
        "play" => Line::Play(true),
        "pause" => Line::Play(false),
        "step" => Line::Step,
        "reset" => Line::Reset,
        "speed" => Line::Speed(one()?),
        "set" => {
            let (key, value) = rest.split_once(char::is_whitespace).ok_or("`set` needs a key and a value")?;
            let value = value
                .trim()
                .parse()
                .map_err(|_| format!("'{value}' is no value as a scene file has them"))?;
            Line::Set(key.parse()?, Some(value))
        }
        "unset" => Line::Set(rest.parse()?, None),
        "undo" => Line::Undo,
        "redo" => Line::Redo,
        "new" => Line::New(rest.to_owned()),
        "open" => Line::Open(path()?),
        "save" => Line::Save(path()?),
        "hand" => {
            let known = Hand::ALL.iter().find(|h| h.1.eq_ignore_ascii_case(rest));
            let names = || Hand::ALL.map(|h| h.1.to_lowercase()).join(", ");
            Line::Hand(known.ok_or_else(|| format!("'{rest}' is no tool: {}", names()))?.0)
        }
        "drag" | "hold" => match numbers()?[..] {
            [a, b, c, d, frames] => {
                let (from, to, frames) = (Vec2::new(a, b), Vec2::new(c, d), frames.max(1.0) as u32);
                if word == "drag" { Line::Drag(from, to, frames) } else { Line::Hold(from, to, frames) }
            }
            _ => return Err(format!("`{word}` needs five numbers: from x y, to x y, frames")),
        },
        "release" => Line::Release,
        "show" if rest == "natural" => Line::Show(None),
        "show" => {
            let known = Value::ALL.into_iter().find(|v| v.name().eq_ignore_ascii_case(rest));
            Line::Show(Some(known.ok_or_else(|| format!("'{rest}' is nothing that colors show"))?))
        }
        "find" => Line::Find(rest.to_owned()),
        "overlay" => {
            let (name, state) =
                rest.split_once(char::is_whitespace).ok_or("`overlay` needs a name and on or off")?;
            switch(name, on(state.trim())?)?
        }
        "still" => Line::Record(Kind::Still, path()?, 0.0),
        "clip" => record(Kind::Clip)?,
        "pictures" => record(Kind::Pictures)?,
        "turntable" => record(Kind::Turntable)?,
        "shot" => Line::Shot(path()?),
        "pace" => Line::Pace,
        "quit" => Line::Quit,
        name if SWITCHES.contains(&name) => switch(name, on(rest)?)?,
        name => return Err(format!("'{name}' is nothing that a script can do")),
    })
}

fn switch(name: &str, on: bool) -> Result<Line, String> {
    if SWITCHES.contains(&name) {
        Ok(Line::Switch(name.to_owned(), on))
    } else {
        Err(format!("'{name}' is nothing that a script can do"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_of_the_help_is_read_and_others_are_refused_by_their_number() {
        let text = "wait 30\nset groom[0].look.roughness 0.5\nunset wind.gust\nhand grab\ndrag 0.4 0.6 0.7 0.5 30\nhold 0.4 0.6 0.7 0.5 30\nrelease\n# no\n\nshot a b.png\n\
                    overlay slice on\ncompare off\nshow natural\nshow speed\nclip x.mp4 2\nfind wind\nquit";
        assert_eq!(parse(text).unwrap().len(), 15);
        for wrong in [
            "fly",
            "set a",
            "set a [",
            "drag 1 2 3",
            "hand foot",
            "show nothing",
            "compare maybe",
            "wait x",
            "clip a.mp4",
        ] {
            let error = parse(&format!("play\n{wrong}")).unwrap_err().to_string();
            assert!(error.contains("line 2"), "{wrong}: {error}");
        }
    }
}
