//! What a field of a scene file needs, for messages about a value of another type: the kind of value, with an example that
//! the field accepts.

use super::parameters::{Variant, definition, fields, is_list};
use glam::Vec3;
use hairspring::settings::{Parameter, Range, Setting};
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

/// A value in the text of a scene file.
pub(super) struct Place {
    /// Full name of its field, such as `clip.keys`.
    pub path: String,
    /// The value if it is text.
    pub word: Option<String>,
    /// What the field holds, as messages name it: `a list`, `3`.
    pub found: String,
}

impl Place {
    /// Finds the value at byte `at`. In a header, it is the table that begins there.
    pub fn of(text: &str, at: usize) -> Option<Self> {
        let root = DeTable::parse(text).ok()?;
        let mut best = None;
        in_table(root.get_ref(), "", at, &mut best);
        best.map(|(_, place)| place)
    }
}

/// Looks for the shortest value at `at` in a table.
fn in_table(table: &DeTable, path: &str, at: usize, best: &mut Option<(usize, Place)>) {
    for (key, value) in table {
        let path =
            if path.is_empty() { key.get_ref().to_string() } else { format!("{path}.{}", key.get_ref()) };
        in_value(value, &path, false, at, best);
    }
}

fn in_value(
    value: &Spanned<DeValue>,
    path: &str,
    listed: bool,
    at: usize,
    best: &mut Option<(usize, Place)>,
) {
    let (span, value) = (value.span(), value.get_ref());
    if span.contains(&at) && best.as_ref().is_none_or(|(length, _)| span.len() <= *length) {
        let found = match value {
            _ if listed => "a list".into(),
            DeValue::Array(_) => "a list".into(),
            DeValue::Table(_) => "a table".into(),
            DeValue::String(word) => format!("the text {word:?}"),
            DeValue::Integer(number) => number.to_string(),
            DeValue::Float(number) => number.to_string(),
            DeValue::Boolean(on) => on.to_string(),
            DeValue::Datetime(time) => time.to_string(),
        };
        let word = value.as_str().filter(|_| !listed).map(str::to_owned);
        *best = Some((span.len(), Place { path: path.to_owned(), word, found }));
    }
    match value {
        DeValue::Array(list) => list.iter().for_each(|value| in_value(value, path, true, at, best)),
        DeValue::Table(table) => in_table(table, path, at, best),
        _ => {}
    }
}

/// Describes the table, or the list of tables, that the field `path` needs; `None` for another field. `word` is text in its
/// place, which may be the name of a kind of table, such as `sphere`.
pub(super) fn needed_table(path: &str, word: Option<&str>) -> Option<String> {
    let fields = fields(path);
    let table = table(&fields, word)?;
    Some(match is_list(path) {
        true => format!("a list of tables, such as [{table}]"),
        false => format!("a table, such as {table}"),
    })
}

/// Describes the type that serde expected of the field `path`.
pub(super) fn needed(expected: &str, path: Option<&str>) -> String {
    let field = path.and_then(definition);
    let such_as = |kind: &str, example: String| format!("{kind}, such as {example}");
    match expected {
        "u8" | "u16" | "u32" | "u64" | "usize" | "i8" | "i16" | "i32" | "i64" | "isize" => {
            let bounded = field.filter(|field| !matches!(field.range, Range::Described | Range::Table));
            match (bounded, expected.starts_with('u')) {
                (Some(field), _) => format!("a whole number, {}", field.range_text()),
                (None, true) => "a whole number, 0 or more".into(),
                (None, false) => "a whole number".into(),
            }
        }
        "f32" | "f64" => such_as("a number", field.and_then(number).unwrap_or_else(|| "1.5".into())),
        "a boolean" => "true or false".into(),
        "a string" | "string" | "path string" | "a borrowed string" => {
            field.and_then(words).unwrap_or_else(|| "text in quotes".into())
        }
        "a sequence" => match field {
            Some(field) => list(field).map_or("a list".into(), |example| such_as("a list", example)),
            None => "a list, such as [1.0, 2.0]".into(),
        },
        "a sequence of 2 f32 values" => "two numbers, such as [1.5, 0.0]".into(),
        "a sequence of 3 f32 values" => such_as("three numbers", field.map_or(VECTOR.toml(), vector)),
        "a sequence of 4 f32 values" => "four numbers, such as [1.5, 0.0, 0.0, 0.0]".into(),
        "a map" => "a table".into(),
        _ if expected.starts_with("struct ") => "a table".into(),
        _ if expected == "variant identifier" || expected.starts_with("enum ") => name(field),
        _ if expected.starts_with("a tuple of size ") || expected.starts_with("an array of length ") => {
            format!("a list of {} values", expected.rsplit(' ').next().unwrap_or_default())
        }
        _ => expected.to_owned(),
    }
}

/// Describes the name that a field needs.
pub(super) fn name(field: Option<&Parameter>) -> String {
    field.and_then(words).unwrap_or_else(|| "a name in quotes".into())
}

/// Whether the range of the field `path` says how large a whole number may be.
pub(super) fn is_bounded(path: Option<&str>) -> bool {
    path.and_then(definition).is_some_and(|field| field.range.bounds().is_some())
}

/// The names that a field accepts.
fn words(field: &Parameter) -> Option<String> {
    let names: Vec<String> = field.words.iter().map(|word| format!("{word:?}")).collect();
    (!names.is_empty()).then(|| format!("a name in quotes, one of: {}", names.join(", ")))
}

/// A vector that most fields accept.
const VECTOR: Vec3 = Vec3::new(1.5, 0.0, 0.0);

/// An example of a field of three numbers.
fn vector(field: &Parameter) -> String {
    let known = [VECTOR, Vec3::splat(1.5), Vec3::splat(0.5)];
    known.iter().find(|v| field.range.accepts(*v)).map(Setting::toml).unwrap_or_else(|| VECTOR.toml())
}

/// An example of a field of one number.
fn number(field: &Parameter) -> Option<String> {
    let own = field.default.map(|default| default()).filter(|text| text.parse::<f32>().is_ok());
    if let Some(whole) = own.clone().filter(|text| text.parse::<i64>().is_ok()) {
        return Some(whole);
    }
    let (low, high) = field.range.bounds().unwrap_or_default();
    let known = [1.5, 0.5 * (low + high)].into_iter().find(|x| field.range.accepts(x));
    known.map(|x| x.toml()).or(own)
}

/// An example of a field of a list.
fn list(field: &Parameter) -> Option<String> {
    let own = field.default.map(|default| default()).filter(|text| text.starts_with('[') && text != "[]");
    own.or_else(|| field.expected.starts_with("names").then(|| "[\"name\"]".into()))
}

/// An example of any field; `None` if its definition does not tell one.
fn example(field: &Parameter) -> Option<String> {
    if let Some(word) = field.words.first() {
        return Some(format!("{word:?}"));
    }
    if !field.fields.is_empty() {
        let fields: Vec<Variant> =
            field.fields.iter().map(|(variant, fields)| (*variant, fields.iter().collect())).collect();
        return table(&fields, None);
    }
    let of_text = || match field.expected {
        text if text.starts_with("any text") => Some("\"name\"".into()),
        text => text.strip_prefix("`.")?.split('`').next().map(|ending| format!("\"file.{ending}\"")),
    };
    match field.range {
        Range::Table => None,
        Range::Switch => Some("true".into()),
        Range::Described => list(field).or_else(of_text),
        Range::Color | Range::Direction => Some(vector(field)),
        _ if field.expected.starts_with("three") => Some(vector(field)),
        _ => number(field),
    }
}

/// An example of a table with these fields: those that are required, or else one of the others.
fn table(fields: &[Variant], word: Option<&str>) -> Option<String> {
    let (variant, fields) = fields.iter().find(|(variant, _)| Some(*variant) == word).or(fields.first())?;
    let shown = |field: &&Parameter| Some(format!("{} = {}", field.name, example(field)?));
    let is_required = |field: &&&Parameter| {
        field.default.is_none() && field.default_text.is_empty() && !field.doc.contains("only:")
    };
    let required: Vec<String> = fields.iter().filter(is_required).filter_map(shown).collect();
    let shown = match required.is_empty() {
        true => fields.iter().find_map(shown)?,
        false => required.join(", "),
    };
    Some(if variant.is_empty() {
        format!("{{ {shown} }}")
    } else {
        format!("{{ {variant} = {{ {shown} }} }}")
    })
}
