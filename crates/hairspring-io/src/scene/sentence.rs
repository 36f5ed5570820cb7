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
    let lines: Vec<&str> = text.lines().map(str::trim_start).collect();
    let name = |line: &str| line.trim_start_matches('[').split(']').next().unwrap_or_default().to_owned();
    let table = lines
        .iter()
        .take(from)
        .rev()
        .find(|line| line.starts_with('['))
        .map_or_else(String::new, |l| name(l));
    let leaves = |line: &&str| {
        line.starts_with("[[") || (line.starts_with('[') && !name(line).starts_with(&format!("{table}.")))
    };
    let end = lines.iter().skip(from).position(leaves).map_or(lines.len(), |k| from + k);
    let own = lines[..end].join("\n");
    let (parent, key) = path.rsplit_once('.').unwrap_or(("", path));
    // The header of a nested table, and the key below it.
    let header = |line: &&str| line.starts_with('[') && name(line).ends_with(&format!(".{parent}"));
    let below = lines[..end].iter().skip(from).position(header).map(|k| from + k + 1);
    below
        .filter(|_| !parent.is_empty())
        .and_then(|below| line_of_key(&own, below, key))
        .or_else(|| prefixes(path).find_map(|path| line_of_key(&own, from, path)))
        .or_else(|| line_of_key(text, from, path))
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
