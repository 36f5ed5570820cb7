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

    /// Returns the lines from here to the end that have words: the line, counted from 1, and the number of its words.
    pub(crate) fn lines_left(&self) -> Vec<(usize, usize)> {
        let mut rest = self.clone();
        let mut found: Vec<(usize, usize)> = Vec::new();
        while rest.word().is_some() {
            match found.last_mut() {
                Some((line, words)) if *line == rest.line => *words += 1,
                _ => found.push((rest.line, 1)),
            }
        }
        found
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
            Some(word) => format!("found `{}`{}", shortened(word), remedy(word)),
            None => "the file ends".into(),
        };
        Problem::line(self.line, format!("expected {what}, {found}"))
    }
}

/// Parses `word` as a finite number.
pub(crate) fn finite(word: &str) -> Option<f32> {
    word.parse().ok().filter(|x: &f32| x.is_finite())
}

/// Returns what to do about a word that is no number, for the end of a message, if its cause is known.
pub(crate) fn remedy(word: &str) -> &'static str {
    let is_number = |word: &str| finite(word).is_some();
    // Programs that were built with old C libraries write numbers that are not finite as `-1.#IND` or `1.#QNAN0`.
    let after = word.split_once('#').map(|(_, after)| after.to_ascii_uppercase());
    if let Some(after) = after {
        let not_finite = ["IND", "QNAN", "SNAN", "INF"].iter().any(|name| after.starts_with(name));
        return match not_finite {
            true => ", which is not finite; correct it in the program that made the file",
            false => "; put a space before a comment",
        };
    }
    if word.contains(',') && is_number(&word.replacen(',', ".", 1)) { "; use decimal points" } else { "" }
}

/// Returns a line without its comment, which begins with a number sign at the start or after a space.
pub(crate) fn without_comment(line: &str) -> &str {
    let begins = |(at, _): &(usize, &str)| line[..*at].chars().next_back().is_none_or(char::is_whitespace);
    line.match_indices('#').find(begins).map_or(line, |(at, _)| &line[..at])
}

/// A word of the file for a message: its first 40 characters.
pub(crate) fn shortened(word: &str) -> String {
    if word.chars().count() <= 40 { word.into() } else { word.chars().take(40).chain(['…']).collect() }
}

/// A file's bytes as text: UTF-16 if the file begins with its byte order mark, otherwise UTF-8. Each byte that is no
/// UTF-8 (names in old encodings) is a character of Latin-1.
pub(crate) fn as_text(data: &[u8]) -> Cow<'_, str> {
    match data {
        [0xff, 0xfe, rest @ ..] => Cow::Owned(utf16(rest, u16::from_le_bytes)),
        [0xfe, 0xff, rest @ ..] => Cow::Owned(utf16(rest, u16::from_be_bytes)),
        _ => utf8(data.strip_prefix(b"\xef\xbb\xbf").unwrap_or(data)),
    }
}

/// Decodes UTF-8, and other bytes as Latin-1.
fn utf8(data: &[u8]) -> Cow<'_, str> {
    if let Ok(text) = std::str::from_utf8(data) {
        return Cow::Borrowed(text);
    }
    let mut text = String::with_capacity(data.len());
    for chunk in data.utf8_chunks() {
        text.push_str(chunk.valid());
        text.extend(chunk.invalid().iter().map(|byte| char::from(*byte)));
    }
    Cow::Owned(text)
}

/// Describes names that are not in UTF-8, which `data` of a text file has.
pub(crate) fn encoding_note(data: &[u8]) -> Option<String> {
    let is_utf16 = data.starts_with(b"\xff\xfe") || data.starts_with(b"\xfe\xff");
    (!is_utf16 && std::str::from_utf8(data).is_err())
        .then(|| "its text is not UTF-8 and is read as Latin-1; save it as UTF-8 if names are wrong".into())
}

/// Decodes UTF-16. `unit` puts the two bytes of a code unit in order.
fn utf16(data: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let units = data.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

/// Whether a character controls a terminal, ends its line, or reorders what it shows.
pub fn is_hidden(c: char) -> bool {
    c.is_control() || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Returns `text` with its hidden characters escaped, so that it stays on its line: see [`is_hidden`]. Names that a
/// file holds, and every line of the program, go through here before anything shows them.
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if is_hidden(c) { shown.extend(c.escape_default()) } else { shown.push(c) }
    }
    Cow::Owned(shown)
}

/// Returns a name of a file's object as the program keeps and shows it.
pub(crate) fn name(text: &str) -> String {
    printable(text).into_owned()
}
