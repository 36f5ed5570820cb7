//! Reads a text file word by word and keeps the line number for messages.

use crate::Problem;
use glam::Vec3;
use std::{borrow::Cow, str::FromStr};

/// The lines of a text. A line ends in LF, in CR LF, or in CR (the classic Mac OS).
#[derive(Clone)]
pub(crate) struct Lines<'a> {
    rest: &'a str,
}

/// Returns the lines of `text`.
pub(crate) fn lines(text: &str) -> Lines<'_> {
    Lines { rest: text }
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.find(['\n', '\r']).unwrap_or(self.rest.len());
        let (line, rest) = self.rest.split_at(end);
        self.rest = rest.strip_prefix("\r\n").or_else(|| rest.get(1..)).unwrap_or("");
        Some(line)
    }
}

/// The words of a text, with their lines.
#[derive(Clone)]
pub(crate) struct Words<'a> {
    lines: std::iter::Enumerate<Lines<'a>>,
    words: std::str::SplitWhitespace<'a>,
    line: usize,
}

impl<'a> Words<'a> {
    pub(crate) fn new(text: &'a str) -> Self {
        Self { lines: lines(text).enumerate(), words: "".split_whitespace(), line: 1 }
    }

    /// Line of the last word, counted from 1.
    pub(crate) fn line(&self) -> usize {
        self.line
    }

    /// Returns the next word; `None` at the end.
    pub(crate) fn word(&mut self) -> Option<&'a str> {
        loop {
            if let Some(word) = self.words.next() {
                return Some(word);
            }
            let (i, line) = self.lines.next()?;
            self.line = i + 1;
            self.words = line.split_whitespace();
        }
    }

    /// Returns the rest of the last word's line.
    pub(crate) fn rest_of_line(&mut self) -> Vec<&'a str> {
        self.words.by_ref().collect()
    }

    /// Counts the finite numbers from here to the end, or to the first word that is none.
    pub(crate) fn numbers_left(&self) -> usize {
        let mut rest = self.clone();
        std::iter::from_fn(|| rest.word().and_then(finite)).count()
    }

    /// Reads the next word, which must be `wanted`, ignoring case.
    pub(crate) fn expect(&mut self, wanted: &str) -> Result<(), Problem> {
        match self.word() {
            Some(word) if word.eq_ignore_ascii_case(wanted) => Ok(()),
            found => Err(self.missing(&format!("`{wanted}`"), found)),
        }
    }

    /// Reads the next word as a number. `what` names it in error messages.
    pub(crate) fn number<T: FromStr>(&mut self, what: &str) -> Result<T, Problem> {
        match self.word() {
            Some(word) => word.parse().map_err(|_| self.missing(what, Some(word))),
            None => Err(self.missing(what, None)),
        }
    }

    /// Reads the next word as a finite number. `what` names it in error messages.
    pub(crate) fn finite(&mut self, what: &str) -> Result<f32, Problem> {
        let word = self.word();
        word.and_then(finite).ok_or_else(|| self.missing(what, word))
    }

    /// Reads the next three words as finite numbers. `what` names each of them in error messages.
    pub(crate) fn vector(&mut self, what: &str) -> Result<Vec3, Problem> {
        Ok(Vec3::new(self.finite(what)?, self.finite(what)?, self.finite(what)?))
    }

    /// Says that `what` was expected, but `found` was read.
    pub(crate) fn missing(&self, what: &str, found: Option<&str>) -> Problem {
        let found = match found {
            Some(word) => format!("found `{}`{}", shortened(word), decimal_comma(word)),
            None => "the file ends".into(),
        };
        Problem::line(self.line, format!("expected {what}, {found}"))
    }
}

/// Parses `word` as a finite number.
pub(crate) fn finite(word: &str) -> Option<f32> {
    word.parse().ok().filter(|x: &f32| x.is_finite())
}

/// Returns what to do about a word that is no number, for the end of a message: if it has a decimal comma, to use points.
pub(crate) fn decimal_comma(word: &str) -> &'static str {
    let is_number = word.contains(',') && finite(&word.replacen(',', ".", 1)).is_some();
    if is_number { "; use decimal points" } else { "" }
}

/// A word of the file for a message: its first 40 characters.
pub(crate) fn shortened(word: &str) -> String {
    if word.chars().count() <= 40 { word.into() } else { word.chars().take(40).chain(['…']).collect() }
}

/// A file's bytes as text: UTF-16 if the file begins with its byte order mark, otherwise UTF-8. Anything else
/// (names in old encodings) becomes replacement characters.
pub(crate) fn as_text(data: &[u8]) -> Cow<'_, str> {
    match data {
        [0xff, 0xfe, rest @ ..] => Cow::Owned(utf16(rest, u16::from_le_bytes)),
        [0xfe, 0xff, rest @ ..] => Cow::Owned(utf16(rest, u16::from_be_bytes)),
        _ => String::from_utf8_lossy(data.strip_prefix(b"\xef\xbb\xbf").unwrap_or(data)),
    }
}

/// Decodes UTF-16. `unit` puts the two bytes of a code unit in order.
fn utf16(data: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let units = data.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

/// Returns `text` with the characters escaped that control a terminal or reorder what it shows. Names and paths
/// that a file holds go through here before anything shows them.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    let hidden = |c: char| {
        c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    if !text.contains(hidden) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if hidden(c) { shown.extend(c.escape_default()) } else { shown.push(c) }
    }
    Cow::Owned(shown)
}

/// Returns a name of a file's object as the program keeps and shows it.
pub(crate) fn name(text: &str) -> String {
    printable(text).into_owned()
}
