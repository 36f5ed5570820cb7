//! Turns errors of TOML and serde about a scene file into a sentence with the line and the most similar valid
//! name.

use crate::Problem;

/// Line of a byte offset, counted from 1.
pub(super) fn line_at(text: &str, byte: usize) -> usize {
    text.as_bytes().iter().take(byte).filter(|b| **b == b'\n').count() + 1
}

/// Converts a TOML error.
pub(super) fn problem(text: &str, error: &toml::de::Error) -> Problem {
    match error.span() {
        Some(span) => {
            if let Some(sentence) = wrong_brackets(text, span.start, error.message()) {
                return Problem::line(line_at(text, span.start), sentence);
            }
            let message = reworded(error.message(), key_of(text, span.start));
            Problem::line(line_at(text, span.start), message)
        }
        None => Problem::whole(reworded(error.message(), None)),
    }
}

/// Converts an error in a table that begins at byte `start`, caused by the field `key` if it is known. The
/// line is that of the key, if there is one after `start`.
pub(super) fn problem_in_table(
    text: &str,
    start: usize,
    error: &toml::de::Error,
    key: Option<&str>,
) -> Problem {
    let named = error.message().strip_prefix("unknown field ").and_then(|m| m.split('`').nth(1));
    let from = line_at(text, start);
    let line = named.or(key).and_then(|key| line_of_key(text, from, key)).unwrap_or(from);
    Problem::line(line, reworded(error.message(), key))
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

/// The key whose value begins or continues at byte `at`, which may be in the header of its table.
fn key_of(text: &str, at: usize) -> Option<&str> {
    let line = text.get(..at)?.rfind('\n').map_or(0, |end| end + 1);
    if let Some(name) = text[line..].lines().next().and_then(header_of) {
        return name.rsplit('.').next();
    }
    let before = text.get(..at)?;
    let before = before[..before.rfind('=')?].trim_end();
    let key = before.rsplit(|c: char| !(c.is_alphanumeric() || "_-".contains(c))).next()?;
    Some(key).filter(|key| !key.is_empty())
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

/// Rewords an error of serde in terms of TOML. `key` is the field that has the wrong value.
///
/// ``unknown field `x`, expected one of `a`, `b` `` becomes a sentence with the most similar name first.
/// ``invalid type: string "x", expected f32`` becomes a sentence about the value that the field needs.
fn reworded(message: &str, key: Option<&str>) -> String {
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
    let field = key.map_or("the value".into(), |key| format!("`{key}`"));
    if message.starts_with("wanted exactly 1 element") {
        return "the table has more than one kind or none; give one, such as one shape in each [[collider]]"
            .into();
    }
    if message == "wanted string or table" {
        return format!("{field} needs a name in quotes");
    }
    if let Some(expected) = message.strip_prefix("expected ").filter(|_| key.is_some()) {
        return format!("{field} needs {expected}");
    }
    let wrong = ["invalid type: ", "invalid value: ", "invalid length "].iter().find_map(|start| {
        let (found, expected) = message.strip_prefix(start)?.split_once(", expected ")?;
        Some((start.contains("length"), found, expected))
    });
    match wrong {
        Some((true, count, expected)) => format!("{field} needs {}, not {count} values", needed(expected)),
        Some((false, found, expected)) => match largest(expected).filter(|_| is_above(found, expected)) {
            Some(most) => format!("{field} needs a whole number of at most {most}, not {}", value(found)),
            None => format!("{field} needs {}, not {}", needed(expected), value(found)),
        },
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

/// Describes the type that serde expected.
fn needed(expected: &str) -> String {
    let text = match expected {
        "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number, 0 or more",
        "i8" | "i16" | "i32" | "i64" | "isize" => "a whole number",
        "f32" | "f64" => "a number, such as 1.5",
        "a boolean" => "true or false",
        "a string" | "string" | "path string" | "a borrowed string" => "text in quotes",
        "a sequence" => "a list, such as [1.0, 2.0]",
        "a map" => "a table, such as { name = 1.0 }",
        "variant identifier" => "a name in quotes",
        "a sequence of 2 f32 values" => "two numbers, such as [1.5, 0.0]",
        "a sequence of 3 f32 values" => "three numbers, such as [1.5, 0.0, 0.0]",
        "a sequence of 4 f32 values" => "four numbers, such as [1.5, 0.0, 0.0, 0.0]",
        _ if expected.starts_with("struct ") => "a table, such as { name = 1.0 }",
        _ if expected.starts_with("enum ") => "a name in quotes",
        _ if expected.starts_with("a tuple of size ") || expected.starts_with("an array of length ") => {
            let count = expected.rsplit(' ').next().unwrap_or_default();
            return format!("a list of {count} values");
        }
        _ => expected,
    };
    text.to_owned()
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
