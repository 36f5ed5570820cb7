//! Turns errors of TOML and serde about a scene file into a sentence with the line and the most similar valid
//! name.

use super::{
    expected::{self, Place, is_bounded, needed, needed_table},
    parameters::definition,
};
use crate::Problem;
use std::ops::Range;

/// Line of a byte offset, counted from 1.
pub(super) fn line_at(text: &str, byte: usize) -> usize {
    text.as_bytes().iter().take(byte).filter(|b| **b == b'\n').count() + 1
}

/// Converts a TOML error.
pub(super) fn problem(text: &str, error: &toml::de::Error) -> Problem {
    match error.span() {
        Some(span) => {
            if is_wrong_escape(error.message()) {
                return Problem::line(line_at(text, span.start), WRONG_ESCAPE);
            }
            if let Some(sentence) = given_twice(text, span.clone(), error.message()) {
                return Problem::line(line_at(text, span.start), sentence);
            }
            if let Some(sentence) = wrong_brackets(text, span.start, error.message()) {
                return Problem::line(line_at(text, span.start), sentence);
            }
            let place = Place::of(text, span.start);
            let message = misplaced(error.message(), place.as_ref())
                .unwrap_or_else(|| reworded(error.message(), place.as_ref().map(|place| &place.path[..])));
            Problem::line(line_at(text, span.start), message)
        }
        None => Problem::whole(reworded(error.message(), None)),
    }
}

/// Converts an error in a table that begins at byte `start`, caused by the field with the full name `path` if it is known.
/// The line is that of its key, if there is one after `start`.
pub(super) fn problem_in_table(
    text: &str,
    start: usize,
    error: &toml::de::Error,
    path: Option<&str>,
) -> Problem {
    let named = error.message().strip_prefix("unknown field ").and_then(|m| m.split('`').nth(1));
    let from = line_at(text, start);
    let line = named.or(path.map(key_of)).and_then(|key| line_of_key(text, from, key)).unwrap_or(from);
    Problem::line(line, reworded(error.message(), path))
}

/// The sentence for an unknown escape sequence, which is often a path of Windows.
const WRONG_ESCAPE: &str = "a backslash in double quotes begins an escape sequence, and this one is unknown; write paths with / or in single quotes";

/// Whether TOML reports an escape sequence that it does not know.
fn is_wrong_escape(message: &str) -> bool {
    ["missing escaped value", "too few unicode value digits"].iter().any(|start| message.starts_with(start))
}

/// The sentence for a key at `span` that the table already has.
fn given_twice(text: &str, span: Range<usize>, message: &str) -> Option<String> {
    let line = text.lines().nth(line_at(text, span.start) - 1)?;
    let key = text.get(span).filter(|_| message == "duplicate key")?;
    Some(match header_of(line) {
        Some(_) if line.trim_start().starts_with("[[") => {
            format!("`{key}` was one table before; write [[{key}]], with two brackets, for each")
        }
        Some(name) => format!("[{name}] is given twice; move its keys below the first header"),
        None => format!("`{key}` is given twice in the same table; remove one of the two"),
    })
}

/// The key of a field in its table.
fn key_of(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// The sentence for a value in the place of a table. serde also reads a list as a table, whose fields are the values of the
/// list, and then speaks of the first that is wrong.
fn misplaced(message: &str, place: Option<&Place>) -> Option<String> {
    let of_type = ["invalid ", "wanted string or table", "expected table"];
    let Place { path, word, found } =
        place.filter(|_| of_type.iter().any(|start| message.starts_with(start)))?;
    let needed = needed_table(path, word.as_deref()).filter(|_| found != "a table")?;
    let not = match found == "a list" && needed.starts_with("a list") {
        true => String::new(),
        false => format!(", not {found}"),
    };
    Some(format!("`{}` needs {needed}{not}", key_of(path)))
}

/// The sentence for a header at byte `at` with one bracket too few or too many.
fn wrong_brackets(text: &str, at: usize, message: &str) -> Option<String> {
    let found = message.strip_prefix("invalid type: map, expected ")?;
    let line = text.lines().nth(line_at(text, at) - 1)?.trim_start();
    let name = header_of(line)?;
    match (line.starts_with("[["), found) {
        (false, "a sequence") => {
            Some(format!("`{name}` is a list of tables; write [[{name}]], with two brackets"))
        }
        // serde reads a list of tables as a table whose first field is the first of them.
        (true, _) => Some(format!("`{name}` is one table; write [{name}], with one bracket")),
        (false, _) => None,
    }
}

/// The line that sets the setting `path`, such as `shape.fan.radius`, in the table that line `from` belongs to;
/// if it is in an inline table, the line of that table. Without such a line, the first one after the table.
pub(super) fn line_of_setting(text: &str, from: usize, path: &str) -> Option<usize> {
    let lines: Vec<&str> = text.lines().collect();
    let header = lines.iter().take(from).rposition(|line| header_of(line).is_some());
    let table = header.and_then(|k| header_of(lines[k])).unwrap_or_default();
    // The keys of a table are in any order.
    let first = header.map_or(from, |k| k + 1);
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
        let k = lines[..end].iter().skip(first).position(opens)?;
        line_of_key(&own, first + k + 1, key)
    };
    below_header()
        .or_else(|| prefixes(path).find_map(|path| line_of_key(&own, first, path)))
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

/// Rewords an error of serde in terms of TOML. `path` is the full name of the field that has the wrong value.
///
/// ``unknown field `x`, expected one of `a`, `b` `` becomes a sentence with the most similar name first.
/// ``invalid type: string "x", expected f32`` becomes a sentence about the value that the field needs.
fn reworded(message: &str, path: Option<&str>) -> String {
    if let Some(rest) = message.strip_prefix("unknown field ").or(message.strip_prefix("unknown variant ")) {
        let quoted: Vec<&str> = rest.split('`').skip(1).step_by(2).collect();
        return match quoted.split_first() {
            Some((wrong, known)) => unknown(wrong, known.iter().copied()),
            None => message.to_owned(),
        };
    }
    if let Some(name) = message.strip_prefix("missing field ") {
        return format!("{name} is missing");
    }
    let field = path.map_or("the value".into(), |path| format!("`{}`", key_of(path)));
    if message.starts_with("wanted exactly 1 element") {
        return "the table has more than one kind or none; give one, such as one shape in each [[collider]]"
            .into();
    }
    if message == "wanted string or table" {
        return format!("{field} needs {}", expected::name(path.and_then(definition)));
    }
    if let Some(expected) = message.strip_prefix("expected ").filter(|_| path.is_some()) {
        return format!("{field} needs {expected}");
    }
    let wrong = ["invalid type: ", "invalid value: ", "invalid length "].iter().find_map(|start| {
        let (found, expected) = message.strip_prefix(start)?.split_once(", expected ")?;
        Some((start.contains("length"), found, expected))
    });
    match wrong {
        Some((true, count, expected)) => {
            format!("{field} needs {}, not {count} values", needed(expected, path))
        }
        Some((false, found, expected)) => {
            let is_above = is_above(found, expected) && !is_bounded(path);
            match largest(expected).filter(|_| is_above) {
                Some(most) => format!("{field} needs a whole number of at most {most}, not {}", value(found)),
                None => {
                    let table = path.filter(|_| found != "map").and_then(|path| needed_table(path, None));
                    let needed = table.unwrap_or_else(|| needed(expected, path));
                    format!("{field} needs {needed}, not {}", value(found))
                }
            }
        }
        None => message.to_owned(),
    }
}

/// The largest value of a type of whole numbers. Those of TOML have 64 bits.
fn largest(expected: &str) -> Option<i128> {
    Some(match expected {
        "u8" => u8::MAX.into(),
        "u16" => u16::MAX.into(),
        "u32" => u32::MAX.into(),
        "i8" => i8::MAX.into(),
        "i16" => i16::MAX.into(),
        "i32" => i32::MAX.into(),
        "u64" | "usize" | "i64" | "isize" => i64::MAX.into(),
        _ => return None,
    })
}

/// Whether serde found a whole number above the largest value of the type that it expected.
fn is_above(found: &str, expected: &str) -> bool {
    let number = found.strip_prefix("integer ").and_then(|_| value(found).parse::<i128>().ok());
    number.zip(largest(expected)).is_some_and(|(number, most)| number > most)
}

/// Describes the value that serde found.
fn value(found: &str) -> String {
    let quoted = |start: &str| Some(found.strip_prefix(start)?.split('`').nth(1)?.to_owned());
    match found {
        "map" => "a table".into(),
        "sequence" => "a list".into(),
        _ => quoted("integer ")
            .or_else(|| quoted("floating point "))
            .or_else(|| quoted("boolean "))
            .or_else(|| Some(format!("the text {}", found.strip_prefix("string ")?)))
            .unwrap_or_else(|| found.to_owned()),
    }
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
