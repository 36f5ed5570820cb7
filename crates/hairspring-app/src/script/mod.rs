//! Scripted sessions: user input line by line, for tests, pictures and demonstrations.
//!
//! [`VERBS`] lists what a line can be; docs/window.md shows the same list.

mod arguments;
mod verbs;

pub use verbs::{VERBS, Verb};

use crate::{AppError, key::Key, record::Kind, view::Tool};
use glam::Vec2;
use hairspring_scene::stage::{FrameRate, Value};
use std::{collections::VecDeque, path::PathBuf};

/// A line of a script.
#[derive(Clone, Debug)]
pub enum Line {
    /// Waits for this number of frames.
    Wait(u64),
    /// Plays or pauses.
    Play(bool),
    /// Advances by one frame.
    Step,
    /// Returns to time 0.
    Reset,
    /// Goes to the nearest cached frame.
    Seek(u64),
    /// Sets the first and the last frame of the loop.
    Range(Option<(u64, u64)>),
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
    Tool(Tool),
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
    Switch(&'static str, bool),
    /// Records for this number of seconds.
    Record(Kind, PathBuf, f32),
    /// Sets the size of recordings [pixels].
    Size([u32; 2]),
    /// Sets the frame rate of recordings and bakes.
    Rate(FrameRate),
    /// Writes the hair of the current frame.
    Export(PathBuf),
    /// Writes the hair of these frames.
    Bake(PathBuf, [u32; 2]),
    /// Writes the window as a picture.
    Shot(PathBuf),
    /// Prints the speed.
    Pace,
    /// Closes the window.
    Quit,
}

/// A script that runs, line by line.
#[derive(Debug, Default)]
pub struct Script {
    /// The name of its file, for messages.
    name: String,
    lines: VecDeque<(usize, Line)>,
    /// Number of the last line that was begun, until the script is finished.
    current: Option<usize>,
}

impl Script {
    /// Parses the text of the script `name`.
    ///
    /// # Errors
    /// Returns an error for the first line that is not a command.
    pub fn parse(name: &str, text: &str) -> Result<Self, AppError> {
        let mut lines = VecDeque::new();
        for (number, line) in text.lines().enumerate() {
            let line = line.trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let read = verbs::read(line)
                .map_err(|why| AppError::new(format!("{name}, line {}: {why}", number + 1)))?;
            lines.push_back((number + 1, read));
        }
        Ok(Self { name: name.into(), lines, current: None })
    }

    /// Whether every line was begun.
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Begins the next line.
    pub fn begin_next(&mut self) -> Option<Line> {
        let next = self.lines.pop_front();
        self.current = next.as_ref().map(|(number, _)| *number);
        next.map(|(_, line)| line)
    }

    /// Puts a line back that cannot begin yet.
    pub fn wait_for(&mut self, line: Line) {
        if let Some(number) = self.current {
            self.lines.push_front((number, line));
        }
    }

    /// The place of the line that runs, for messages: the name of the file and the number of the line.
    pub fn place(&self) -> Option<String> {
        Some(format!("{}, line {}", self.name, self.current?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_verb_accepts_its_listed_example() {
        for verb in VERBS {
            let line = format!("{} {}", verb.name, verb.example);
            assert!(Script::parse("s", &line).is_ok_and(|script| script.lines.len() == 1), "{line}");
        }
    }

    #[test]
    fn an_invalid_line_is_refused_with_its_file_and_number() {
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
            "still",
            "overlay moon on",
            "overlay slice on off",
            "compare on off",
            "wait -5",
            "wait 1.9",
            "wait 5 6",
            "wait 1e19",
            "wait 99999999999999999999",
            "wait nan",
            "seek 0",
            "seek -3",
            "seek 3 4",
            "speed 0",
            "speed 100",
            "speed nan",
            "speed 1 2",
            "range 5",
            "range 5 5",
            "range 1.5 3",
            "range 1 3 5",
            "size 10.7 99.2",
            "size 640",
            "size -1 5",
            "size 640 480 3",
            "drag 0 0 1 1 1.5",
            "drag 0 0 1 1 0",
            "drag 0 0 inf 1 5",
            "drag 2 2 3 3 1",
            "hold 0.5 0.5 1.01 0.5 1",
            "size 64 48",
            "size 20000 20000",
            "rate",
            "rate 1000",
            "rate 1/2",
            "rate 24 30",
            "bake a.##.hair 0",
            "bake a.##.hair 1.5",
            "clip a.mp4 inf",
            "clip a.mp4 nan",
            "pictures a.##.png 0",
            "turntable a.mp4 -1",
            "shot a.bmp",
            "shot a",
            "set material.\"my hair.bend 3",
            "set material.\"my hair\".bend",
        ] {
            let error = Script::parse("s.txt", &format!("play\n# no\n\n{wrong}")).unwrap_err().to_string();
            assert!(error.starts_with("s.txt, line 4: "), "{wrong}: {error}");
        }
    }

    #[test]
    fn an_argument_outside_its_range_is_refused_with_the_range() {
        for (wrong, range) in [
            ("wait 1e19", "whole number from 0 to 1000000"),
            ("seek 0", "whole number from 1 to 1000000"),
            ("speed 9", "number from 0.05 to 4"),
            ("size 64 48", "whole number from 64 to 8192"),
            ("rate 1000", "from 1 to 240"),
            ("drag 0 0 3 0 1", "number from 0 to 1"),
            ("overlay bogus on", "hair, body, colliders"),
        ] {
            let error = Script::parse("s.txt", wrong).unwrap_err().to_string();
            assert!(error.contains(range) && !(range.starts_with('n') && error.contains("whole")), "{error}");
        }
    }

    #[test]
    fn a_key_may_have_quoted_names_with_spaces() {
        let script = Script::parse("s.txt", "set material.\"my hair.2\".bend [1, 2]").unwrap();
        let Some((_, Line::Set(key, Some(value)))) = script.lines.front() else { panic!("{script:?}") };
        assert_eq!(
            (key.to_string().as_str(), value.to_string().as_str()),
            ("material.\"my hair.2\".bend", "[1, 2]")
        );
    }

    #[test]
    fn the_documented_verbs_match_the_parser() {
        let page =
            std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/window.md")).unwrap();
        let (_, section) = page.split_once("## Scripts").expect("the page has a section about scripts");
        let section = section.split("\n## ").next().unwrap_or_default();
        let rows: Vec<&str> = section.lines().filter(|line| line.starts_with("| `")).collect();
        let wanted: Vec<String> = VERBS.iter().map(Verb::row).collect();
        assert_eq!(rows, wanted, "the table in docs/window.md should be\n{}", wanted.join("\n"));
    }
}
