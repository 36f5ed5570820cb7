//! The arguments of a script's line: whatever a command does not expect is an error.

use super::Line;
use crate::{
    record::{Kind, RecordFormat},
    session::SPEEDS,
};
use glam::Vec2;
use hairspring_scene::stage::FrameRate;
use std::{fmt::Display, ops::RangeInclusive, path::PathBuf, str::FromStr};

/// Most steps, frames or window frames that a line can name.
const MOST: u32 = 1_000_000;

/// What follows the first word of a line.
#[derive(Clone, Copy)]
pub(super) struct Arguments<'a> {
    pub(super) word: &'a str,
    pub(super) text: &'a str,
}

impl<'a> Arguments<'a> {
    /// Exactly this number of words; `what` describes them, for messages.
    fn words<const N: usize>(self, what: &str) -> Result<[&'a str; N], String> {
        let words: Vec<&str> = self.text.split_whitespace().collect();
        words.try_into().map_err(|_| match self.text {
            "" => format!("`{}` needs {what}", self.word),
            text => format!("`{}` needs {what}, but found '{text}'", self.word),
        })
    }

    /// The only word: a whole number of at least `least`.
    pub(super) fn count(self, what: &str, least: u32) -> Result<u32, String> {
        let [word] = self.words(what)?;
        self.number(word, what, least..=MOST)
    }

    /// The playback speed.
    pub(super) fn speed(self) -> Result<f32, String> {
        let what = "the seconds of the scene in a second";
        let [word] = self.words(what)?;
        self.number(word, what, SPEEDS)
    }

    /// The first and the last frame of a range, counted from 1.
    pub(super) fn range(self) -> Result<[u32; 2], String> {
        let what = "the first and a later last frame, such as `range 10 60`, or `all`";
        let words: [&str; 2] = self.words(what)?;
        let [first, last] = words.map(|word| self.number(word, what, 1..=MOST));
        match [first?, last?] {
            [first, last] if first < last => Ok([first, last]),
            _ => Err(format!("`{}` needs {what}, but found '{}'", self.word, self.text)),
        }
    }

    /// The width and the height of a recording [pixels].
    pub(super) fn size(self) -> Result<[u32; 2], String> {
        let what = "a width and a height, such as `size 1920 1080`";
        let words: [&str; 2] = self.words(what)?;
        let [width, height] = words.map(|word| self.number(word, what, RecordFormat::SIDES));
        Ok([width?, height?])
    }

    /// The frame rate of a recording or a bake.
    pub(super) fn rate(self) -> Result<FrameRate, String> {
        let what = "the frames per second";
        let [word] = self.words(what)?;
        FrameRate::of_output(word).map_err(|why| format!("`{}` needs {what}: '{word}': {why}", self.word))
    }

    /// Two places in the picture, and a number of frames.
    pub(super) fn path_of_pointer(self) -> Result<(Vec2, Vec2, u32), String> {
        let what = "five numbers: from x y, to x y, frames";
        let [from_x, from_y, to_x, to_y, frames] = self.words(what)?;
        let place = |word| self.number(word, what, 0.0..=1.0);
        let from = Vec2::new(place(from_x)?, place(from_y)?);
        let to = Vec2::new(place(to_x)?, place(to_y)?);
        Ok((from, to, self.number(frames, what, 1..=MOST)?))
    }

    /// A number in a range. A fraction is not a whole number.
    fn number<T>(self, word: &str, what: &str, range: RangeInclusive<T>) -> Result<T, String>
    where
        T: FromStr + PartialOrd + Display,
    {
        let number = word.parse().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| {
            let kind = if "0.5".parse::<T>().is_ok() { "number" } else { "whole number" };
            let (least, most) = (range.start(), range.end());
            let word_of_line = self.word;
            format!("`{word_of_line}` needs {what}: '{word}' is not a {kind} from {least} to {most}")
        })
    }

    /// The path of a file, which may have spaces.
    pub(super) fn path(self) -> Result<PathBuf, String> {
        match self.text {
            "" => Err(format!("`{}` needs a file", self.word)),
            name => Ok(PathBuf::from(name)),
        }
    }

    /// The path of a picture.
    pub(super) fn picture(self) -> Result<PathBuf, String> {
        let path = self.path()?;
        let known = path
            .extension()
            .is_some_and(|e| ["png", "jpg"].iter().any(|known| e.eq_ignore_ascii_case(known)));
        if known {
            Ok(path)
        } else {
            Err(format!("`{}` needs a .png or .jpg, but found '{}'", self.word, self.text))
        }
    }

    /// The path of a recording, and its length [s].
    pub(super) fn record(self, kind: Kind) -> Result<Line, String> {
        let (file, word) = self.last("a file and its seconds")?;
        let seconds = word.parse().ok().filter(|seconds: &f32| seconds.is_finite() && *seconds > 0.0);
        let wrong =
            || format!("'{word}' is not the length of a recording; expected seconds above 0, such as 2.5");
        Ok(Line::Record(kind, file, seconds.ok_or_else(wrong)?))
    }

    /// The path of a bake, and its last frame.
    pub(super) fn bake(self) -> Result<Line, String> {
        let what = "a file and the last frame";
        let (file, word) = self.last(what)?;
        Ok(Line::Bake(file, [1, self.number(word, what, 1..=MOST)?]))
    }

    /// A file, whose name may have spaces, and the last word.
    fn last(self, what: &str) -> Result<(PathBuf, &'a str), String> {
        let (file, last) = self
            .text
            .rsplit_once(char::is_whitespace)
            .ok_or_else(|| format!("`{}` needs {what}", self.word))?;
        Ok((file.trim().into(), last))
    }

    /// A name, and `on` or `off`.
    pub(super) fn named_switch(self) -> Result<(&'a str, bool), String> {
        let [name, state] = self.words("a name and on or off")?;
        Ok((name, on(state)?))
    }

    /// `on` or `off`.
    pub(super) fn switch(self, name: &'static str) -> Result<Line, String> {
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
