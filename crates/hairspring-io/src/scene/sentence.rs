//! Turns errors of TOML and serde about a scene file into a sentence with the line and the most similar valid
//! name.

use crate::Problem;

/// Line of a byte offset, counted from 1.
pub(super) fn line_at(text: &str, byte: usize) -> usize {
    text.as_bytes().iter().take(byte).filter(|b| **b == b'\n').count() + 1
}

/// Converts a TOML error.
pub(super) fn problem(text: &str, error: &toml::de::Error) -> Problem {
    let message = reworded(error.message());
    match error.span() {
        Some(span) => Problem::line(line_at(text, span.start), message),
        None => Problem::whole(message),
    }
}

/// Converts an error in a table that begins at byte `start`. The line is that of the key that the error
/// names, if there is one after `start`.
pub(super) fn problem_in_table(text: &str, start: usize, error: &toml::de::Error) -> Problem {
    let key = error.message().strip_prefix("unknown field ").and_then(|m| m.split('`').nth(1));
    let from = line_at(text, start);
    let line = key.and_then(|key| line_of_key(text, from, key)).unwrap_or(from);
    Problem::line(line, reworded(error.message()))
}

/// The line that sets the setting `path`, such as `shape.fan.radius`, in the table that line `from` belongs to;
/// if it is in an inline table, the line of that table. Without such a line, the first one after the table.
pub(super) fn line_of_setting(text: &str, from: usize, path: &str) -> Option<usize> {
    let lines: Vec<&str> = text.lines().collect();
    let table = lines.iter().take(from).rev().find_map(|line| header_of(line)).unwrap_or_default();
    let inside = format!("{table}.");
    let leaves = |line: &&str| {
        header_of(line).is_some_and(|name| line.trim_start().starts_with("[[") || !name.starts_with(&inside))
    };
    let end = lines.iter().skip(from).position(leaves).map_or(lines.len(), |k| from + k);
    let own = lines[..end].join("\n");
    // The key below the header of its own table.
    let below_header = || {
        let (parent, key) = path.rsplit_once('.')?;
        let parent = format!(".{parent}");
        let opens = |line: &&str| header_of(line).is_some_and(|name| name.ends_with(&parent));
        let k = lines[..end].iter().skip(from).position(opens)?;
        line_of_key(&own, from + k + 1, key)
    };
    below_header()
        .or_else(|| prefixes(path).find_map(|path| line_of_key(&own, from, path)))
        .or_else(|| line_of_key(text, from, path))
}

/// The name of the table that begins at this line. A line of a list of lists also begins with a bracket, but
/// then with a number or another bracket.
fn header_of(line: &str) -> Option<&str> {
    let name = line.trim_start().strip_prefix('[')?;
    let name = name.strip_prefix('[').unwrap_or(name).split(']').next()?.trim();
    name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_').then_some(name)
}

/// A path, then the paths of the tables around it.
fn prefixes(path: &str) -> impl Iterator<Item = &str> {
    std::iter::successors(Some(path), |path| path.rsplit_once('.').map(|(table, _)| table))
}

/// The first line from `from` on that sets `key`.
pub(super) fn line_of_key(text: &str, from: usize, key: &str) -> Option<usize> {
    let sets = |line: &str| {
        line.trim_start().strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with(['=', '.']))
    };
    text.lines().enumerate().skip(from - 1).find(|(_, line)| sets(line)).map(|(i, _)| i + 1)
}

/// Returns the name in `names` that `wrong` was probably meant to be.
pub(super) fn nearest<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let far = |name: &str| strsim::damerau_levenshtein(&wrong.to_lowercase(), &name.to_lowercase());
    // A name with more than half of its letters wrong is a different word.
    let near =
        |(distance, name): &(usize, &str)| *distance * 2 <= name.chars().count().max(wrong.chars().count());
    names.into_iter().map(|n| (far(n), n)).filter(near).min().map(|(_, n)| n)
}

/// Rewords ``unknown field `x`, expected one of `a`, `b` `` so that the most similar name comes first.
fn reworded(message: &str) -> String {
    let Some(rest) = message.strip_prefix("unknown field ").or(message.strip_prefix("unknown variant "))
    else {
        return message.to_owned();
    };
    let quoted: Vec<&str> = rest.split('`').skip(1).step_by(2).collect();
    let Some((wrong, known)) = quoted.split_first() else {
        return message.to_owned();
    };
    unknown(wrong, known.iter().copied())
}

/// Says that `wrong` is not one of `names`.
pub(super) fn unknown<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    let hint =
        nearest(wrong, names.iter().copied()).map_or(String::new(), |n| format!("did you mean `{n}`? "));
    match names.is_empty() {
        true => format!("`{wrong}` is unknown; there are none"),
        false => format!("`{wrong}` is unknown; {hint}expected one of: {}", names.join(", ")),
    }
}
