//! Keys of values in a scene file, such as `groom[0].look.roughness`, and writing at them without touching
//! the rest of the text.

use hairspring::material::preset;
use std::{fmt, str::FromStr};
use toml_edit::{Item, Table, TableLike, Value};

/// One component of a key.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Step {
    /// A field of a table.
    Field(String),
    /// An index into a list.
    Place(usize),
}

/// The path to a value of a scene file, from its root. The default is the root itself.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Key(Vec<Step>);

impl Key {
    /// A field at the root of the file.
    pub fn top(name: &str) -> Self {
        Self(vec![Step::Field(name.into())])
    }

    /// Appends the field `name`.
    pub fn field(&self, name: &str) -> Self {
        let mut steps = self.0.clone();
        steps.extend(name.split('.').map(|n| Step::Field(n.into())));
        Self(steps)
    }

    /// Appends a table entry by its name, which may contain any characters.
    pub fn entry(&self, name: &str) -> Self {
        let mut steps = self.0.clone();
        steps.push(Step::Field(name.into()));
        Self(steps)
    }

    /// Appends the index `place` into a list.
    pub fn place(&self, place: usize) -> Self {
        let mut steps = self.0.clone();
        steps.push(Step::Place(place));
        Self(steps)
    }

    /// The field `name` in the same table as this key.
    pub fn sibling(&self, name: &str) -> Self {
        self.parent().entry(name)
    }

    /// The key of the containing table or list.
    pub fn parent(&self) -> Self {
        let mut steps = self.0.clone();
        steps.pop();
        Self(steps)
    }

    /// The name of the parameter at this key, as in the book: without indices.
    pub fn full_name(&self) -> String {
        let fields = self.0.iter().filter_map(|step| match step {
            Step::Field(name) => Some(name.as_str()),
            Step::Place(_) => None,
        });
        fields.collect::<Vec<_>>().join(".")
    }

    /// The list at the root of the file and the index in it, if the key is inside such a list.
    pub fn listed(&self) -> Option<(&str, usize)> {
        match &self.0[..] {
            [Step::Field(list), Step::Place(place), ..] => Some((list, *place)),
            _ => None,
        }
    }

    /// The same key for the entry at another index of that list.
    pub fn relisted(&self, place: usize) -> Self {
        let mut key = self.clone();
        if let [Step::Field(_), Step::Place(old), ..] = &mut key.0[..] {
            *old = place;
        }
        key
    }

    /// The name of the material that the key is in.
    pub fn material(&self) -> Option<&str> {
        match &self.0[..] {
            [Step::Field(top), Step::Field(name), ..] if top == "material" => Some(name),
            _ => None,
        }
    }

    /// Looks up the value in a table of effective values.
    pub fn look_up<'a>(&self, table: &'a toml::Table) -> Option<&'a toml::Value> {
        let Some((Step::Field(first), rest)) = self.0.split_first() else { return None };
        rest.iter().try_fold(table.get(first)?, |value, step| match step {
            Step::Field(name) => value.get(name.as_str()),
            Step::Place(place) => value.get(*place),
        })
    }

    /// Writes `value` at this key, or removes the field if it is `None`, so that its default applies. Missing
    /// tables on the path are created. A material that takes the name of a preset is based on it, so that only this
    /// field differs from what the name meant before. Returns false and writes nothing if the path does not exist and
    /// cannot be created.
    pub(crate) fn write(&self, table: &mut dyn TableLike, value: Option<Value>) -> bool {
        if value.is_some()
            && let Some(name) = self.hides_preset(table)
        {
            write(table, &Self::top("material").entry(name).field("preset").0, Some(name.into()));
        }
        write(table, &self.0, value)
    }

    /// The name of the preset that a new material at this key would hide.
    fn hides_preset(&self, table: &dyn TableLike) -> Option<&str> {
        let name = self.material().filter(|name| self.0.len() > 2 && preset(name).is_some())?;
        let defined = table.get("material").and_then(|materials| materials.get(name)).is_some();
        (!defined).then_some(name)
    }
}

fn write(table: &mut dyn TableLike, steps: &[Step], value: Option<Value>) -> bool {
    match steps {
        [Step::Field(name)] => {
            match (value, table.get_mut(name)) {
                (Some(mut value), Some(Item::Value(old))) => {
                    // A comment after the value is kept.
                    *value.decor_mut() = old.decor().clone();
                    *old = value;
                }
                (Some(value), _) => drop(table.insert(name, Item::Value(value))),
                (None, _) => drop(table.remove(name)),
            }
            true
        }
        [Step::Field(name), Step::Place(place), rest @ ..] => match table.get_mut(name) {
            Some(Item::ArrayOfTables(list)) => {
                list.get_mut(*place).is_some_and(|table| write(table, rest, value))
            }
            Some(Item::Value(Value::Array(list))) => match (list.get_mut(*place), rest, value) {
                (Some(Value::InlineTable(table)), [_, ..], value) => write(table, rest, value),
                (Some(old), [], Some(mut value)) => {
                    *value.decor_mut() = old.decor().clone();
                    *old = value;
                    true
                }
                _ => false,
            },
            _ => false,
        },
        [Step::Field(name), rest @ ..] => {
            if table.get(name).is_none() {
                if value.is_none() {
                    return true;
                }
                // Its header is written only if it holds values.
                let mut missing = Table::new();
                missing.set_implicit(true);
                table.insert(name, Item::Table(missing));
            }
            table.get_mut(name).and_then(Item::as_table_like_mut).is_some_and(|t| write(t, rest, value))
        }
        _ => false,
    }
}

/// A name as it is written in a key: in quotes, unless it consists of letters, digits, `_` and `-`.
pub fn written_name(name: &str) -> String {
    toml_edit::Key::new(name).to_string()
}

/// Splits text after the key at its start, which ends at white space outside quotes.
pub fn split_key(text: &str) -> (&str, &str) {
    let mut quote = None;
    let mut escaped = false;
    let end = text.find(|c: char| {
        match quote {
            Some('"') if escaped => escaped = false,
            Some('"') if c == '\\' => escaped = true,
            Some(open) if c == open => quote = None,
            None if matches!(c, '"' | '\'') => quote = Some(c),
            _ => {}
        }
        quote.is_none() && c.is_whitespace()
    });
    let (key, rest) = text.split_at(end.unwrap_or(text.len()));
    (key, rest.trim_start())
}

/// Splits text after the name at its start, which may be in quotes as in a TOML file. `None`: there is no name.
fn split_name(text: &str) -> Option<(String, &str)> {
    let end = match text.chars().next()? {
        '\'' => 2 + text[1..].find('\'')?,
        '"' => {
            let mut escaped = false;
            let closes = |c: char| {
                let closes = c == '"' && !escaped;
                escaped = c == '\\' && !escaped;
                closes
            };
            2 + text[1..].find(closes)?
        }
        _ => {
            let end = text.find(['.', '[']).unwrap_or(text.len());
            return (end > 0).then(|| (text[..end].to_owned(), &text[end..]));
        }
    };
    let (name, rest) = text.split_at(end);
    Some((name.parse::<toml_edit::Key>().ok()?.get().to_owned(), rest))
}

impl FromStr for Key {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "'{text}' names no value; expected names such as groom[0].look.roughness or material.\"my hair\".bend"
            )
        };
        let mut steps = Vec::new();
        let mut rest = text;
        loop {
            let (name, after) = split_name(rest).ok_or_else(wrong)?;
            steps.push(Step::Field(name));
            rest = after;
            if let Some(inside) = rest.strip_prefix('[') {
                let place =
                    inside.split_once(']').and_then(|(place, after)| Some((place.parse().ok()?, after)));
                let (place, after) =
                    place.ok_or_else(|| format!("'{rest}' is not an entry of a list, such as [0]"))?;
                steps.push(Step::Place(place));
                rest = after;
            }
            if rest.is_empty() {
                return Ok(Self(steps));
            }
            rest = rest.strip_prefix('.').ok_or_else(wrong)?;
        }
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, step) in self.0.iter().enumerate() {
            match step {
                Step::Field(name) if k == 0 => write!(f, "{}", written_name(name))?,
                Step::Field(name) => write!(f, ".{}", written_name(name))?,
                Step::Place(place) => write!(f, "[{place}]")?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toml_edit::DocumentMut;

    fn written(text: &str, key: &str, value: Option<Value>) -> Option<String> {
        let mut document: DocumentMut = text.parse().unwrap();
        let done = key.parse::<Key>().unwrap().write(document.as_table_mut(), value);
        done.then(|| document.to_string())
    }

    #[test]
    fn a_value_is_written_and_the_rest_of_the_text_stays() {
        let text = "# mine\n[solver]\nsubsteps = 4 # enough\nteleport_distance = 1.0\n";
        let after = written(text, "solver.substeps", Some(8.into())).unwrap();
        assert_eq!(after, text.replace('4', "8"));
        assert_eq!(
            written(text, "solver.teleport_distance", None).unwrap(),
            "# mine\n[solver]\nsubsteps = 4 # enough\n"
        );
        assert_eq!(written(text, "wind.gust", None).unwrap(), text);
    }

    #[test]
    fn missing_parent_tables_are_created() {
        let after =
            written("[[groom]]\nfile = \"a.hair\"\n", "groom[0].look.roughness", Some(0.5.into())).unwrap();
        assert_eq!(after, "[[groom]]\nfile = \"a.hair\"\n\n[groom.look]\nroughness = 0.5\n");
        let after = written("", "wind.velocity", Some(Value::from_iter([1.0, 0.0, 0.0]))).unwrap();
        assert_eq!(after, "[wind]\nvelocity = [1.0, 0.0, 0.0]\n");
    }

    #[test]
    fn a_new_material_with_the_name_of_a_preset_is_based_on_it() {
        let scene = "[[groom]]\nmaterial = \"wavy\"\n";
        let after = written(scene, "material.wavy.bend", Some(7.into())).unwrap();
        assert_eq!(after, format!("{scene}\n[material.wavy]\npreset = \"wavy\"\nbend = 7\n"));
        assert_eq!(written(&after, "material.wavy.bend", Some(7.into())).unwrap(), after);
        let chosen = written(scene, "material.wavy.preset", Some("curly".into())).unwrap();
        assert_eq!(chosen, format!("{scene}\n[material.wavy]\npreset = \"curly\"\n"));
        let own = written(scene, "material.mine.bend", Some(7.into())).unwrap();
        assert_eq!(own, format!("{scene}\n[material.mine]\nbend = 7\n"));
        assert_eq!(written(scene, "material.wavy.bend", None).unwrap(), scene);
    }

    #[test]
    fn keys_reach_into_lists_and_inline_tables() {
        let text = "[[hand]]\ntool.grab = { center = [0.0, 0.0, 0.0], radius = 0.02 }\n";
        let after = written(text, "hand[0].tool.grab.radius", Some(0.05.into())).unwrap();
        assert_eq!(after, text.replace("0.02", "0.05"));
        let after = written(text, "hand[0].tool.grab.center[1]", Some(1.5.into())).unwrap();
        assert!(after.contains("[0.0,1.5, 0.0]") || after.contains("[0.0, 1.5, 0.0]"), "{after}");
        assert_eq!(written(text, "hand[3].from", Some(1.0.into())), None);
    }

    #[test]
    fn keys_read_as_they_are_written() {
        for text in ["solver.substeps", "groom[2].look.root_color", "charged[0].path[1].time"] {
            assert_eq!(text.parse::<Key>().unwrap().to_string(), text);
        }
        let wrong = ["", "a..b", "a.", "a[", "a[x]", "a[0]b", "a.\"b", "a.'b", "\"a\"b", "a.\"\\q\""];
        assert!(wrong.iter().all(|t| t.parse::<Key>().is_err()));
    }

    #[test]
    fn names_may_be_quoted_as_in_a_scene_file() {
        let text = "[material.\"äö.ü\"]\nbend = 1 # soft\n";
        for key in ["material.\"äö.ü\".bend", "material.'äö.ü'.bend", "material.\"\\u00e4ö.ü\".bend"]
        {
            assert_eq!(written(text, key, Some(3.into())).unwrap(), text.replace('1', "3"), "{key}");
            assert_eq!(key.parse::<Key>().unwrap().to_string(), "material.\"äö.ü\".bend");
        }
        for name in ["my hair", "a\"b", "", "a\\", "[0]", "äö"] {
            let key = Key::top("material").entry(name).field("bend");
            assert_eq!(key.to_string().parse(), Ok(key));
        }
        assert_eq!(split_key("a.\"b \\\" c\".d  [1, 2]"), ("a.\"b \\\" c\".d", "[1, 2]"));
        assert_eq!(split_key("a.'b \\'.d \"x y\""), ("a.'b \\'.d", "\"x y\""));
        assert_eq!(split_key("gravity"), ("gravity", ""));
    }
}
