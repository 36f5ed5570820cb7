//! Parameters without effect in a scene, because a feature is off or another value replaces them.

use super::{
    file::SceneFile,
    material,
    parameters::{contents, definition},
    sentence::line_at,
};
use hairspring::settings::When;
use hairspring_scene::{Scene, SceneGroom};
use serde::Serialize;
use toml::{
    Spanned, Table, Value,
    de::{DeTable, DeValue},
};

/// Returns the parts of a condition that do not hold; none if the condition holds. `value` returns the effective value of a
/// parameter or table, named as in the book.
pub fn unmet<'w, 'v>(when: &'w When, value: &dyn Fn(&str) -> Option<&'v Value>) -> Vec<&'w When> {
    if let When::All(parts) = when {
        return parts.iter().flat_map(|part| unmet(part, value)).collect();
    }
    let is = |name: &str, holds: fn(&Value) -> bool| value(name).is_some_and(holds);
    let word = |name: &str| value(name).and_then(Value::as_str).unwrap_or_default();
    let holds = match *when {
        When::Always | When::All(_) => true,
        When::On(name) => is(name, |on| on.as_bool() == Some(true)),
        When::Above0(name) => is(name, |number| as_number(number) > 0.0),
        When::Not0(name) => is(name, is_not_0),
        When::Has(name) => is(name, is_not_empty),
        When::HasNot(name) => !is(name, is_not_empty),
        When::Given(name) => value(name).is_some(),
        When::NotGiven(name) => value(name).is_none(),
        When::Is(name, words) => words.contains(&word(name)),
        When::IsNot(name, words) => !words.contains(&word(name)),
        When::Any(parts) => parts.iter().any(|part| unmet(part, value).is_empty()),
    };
    if holds { Vec::new() } else { vec![when] }
}

/// A number; 0 for other values.
fn as_number(value: &Value) -> f64 {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64)).unwrap_or_default()
}

/// Whether a number or one of several is not 0.
fn is_not_0(value: &Value) -> bool {
    value.as_array().map_or_else(|| as_number(value) != 0.0, |list| list.iter().any(is_not_0))
}

/// Whether a list has entries; a table has.
fn is_not_empty(value: &Value) -> bool {
    value.as_array().is_none_or(|list| !list.is_empty())
}

/// Returns a note for each parameter that is written in `text` and has no effect. `file` is parsed from the text, and `scene`
/// has its settings.
pub(super) fn notes(text: &str, file: &SceneFile, scene: &Scene) -> Vec<String> {
    let (Ok(written), Ok(plain)) = (DeTable::parse(text), text.parse::<Table>()) else { return Vec::new() };
    let mut shared: Table = [
        ("solver", value(&scene.solver)),
        ("volume", value(&scene.volume)),
        ("neighbours", value(&scene.neighbours)),
        ("wind", value(&scene.wind)),
        ("turbulence", value(&scene.turbulence)),
        ("wind_occlusion", value(&scene.wind_occlusion)),
        ("picture", value(&scene.picture)),
        ("ground", value(&scene.ground)),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .into_iter()
    .collect();
    let present = ["wind_source", "clip", "body"].map(|name| (name.to_owned(), plain.get(name).cloned()));
    shared.extend(present.into_iter().filter_map(|(name, value)| Some((name, value?))));
    // The built-in scene has grooms of its own, such as brows.
    let made = scene.grooms.len().saturating_sub(file.groom.len());
    let mut search = Search { text, shared: &shared, notes: Vec::new() };
    for (key, value) in written.get_ref() {
        let key: &str = key.get_ref();
        match (key, value.get_ref()) {
            ("groom", DeValue::Array(grooms)) => {
                let own = scene.grooms.iter().skip(made).zip(&file.groom);
                for (table, (groom, file)) in grooms.iter().zip(own) {
                    let mut values = of_groom(groom);
                    values.insert("thicken".into(), self::value(&file.thicken));
                    search.value(table, "groom", &Own { table: "groom", shown: "groom", values: &values });
                }
            }
            ("builtin", _) => {
                let values = scene.grooms.first().map(of_groom).unwrap_or_default();
                search.value(value, "builtin", &Own { table: "groom", shown: "builtin", values: &values });
            }
            ("material", DeValue::Table(materials)) => {
                for (name, table) in materials {
                    let name: &str = name.get_ref();
                    let Some(Ok(material)) =
                        file.material.get(name).map(|table| material::overlaid(text, table))
                    else {
                        continue;
                    };
                    let values = self::value(&material).try_into().unwrap_or_default();
                    let path = format!("material.{name}");
                    search.value(table, &path, &Own { table: "material", shown: &path, values: &values });
                }
            }
            _ => search.value(value, key, &Own { table: "", shown: "", values: &Table::new() }),
        }
    }
    search.notes
}

fn value(settings: &impl Serialize) -> Value {
    Value::try_from(settings).unwrap_or_else(|why| unreachable!("settings are plain data: {why}"))
}

/// The values of a groom that conditions name.
fn of_groom(groom: &SceneGroom) -> Table {
    [("look", value(&groom.look)), ("effects", value(&groom.effects))]
        .map(|(name, value)| (name.to_owned(), value))
        .into_iter()
        .collect()
}

/// The effective values of one groom or material.
struct Own<'a> {
    /// The table that conditions name: `groom` or `material`.
    table: &'a str,
    /// Its name in the scene file, such as `material.soft`.
    shown: &'a str,
    values: &'a Table,
}

/// A search through a scene file for parameters without effect.
struct Search<'a> {
    text: &'a str,
    /// The effective values of the scene.
    shared: &'a Table,
    notes: Vec<String>,
}

impl Search<'_> {
    /// Searches a value of the file at `path`.
    fn value(&mut self, value: &Spanned<DeValue>, path: &str, own: &Own) {
        match value.get_ref() {
            DeValue::Array(list) => list.iter().for_each(|value| self.value(value, path, own)),
            DeValue::Table(table) => {
                for (key, value) in table {
                    let path = format!("{path}.{}", key.get_ref());
                    match self.without_effect(&path, key.span().start, own) {
                        Some(note) => self.notes.push(note),
                        None => self.value(value, &path, own),
                    }
                }
            }
            _ => {}
        }
    }

    /// A note that the parameter at `path`, written at byte `at`, has no effect; `None` if it has.
    fn without_effect(&self, path: &str, at: usize, own: &Own) -> Option<String> {
        let look_up = |name: &str| {
            let mut keys = name.split('.');
            let first = keys.next()?;
            let (values, name) = match first == own.table {
                true => (own.values, keys.next()?),
                false => (self.shared, first),
            };
            keys.try_fold(values.get(name)?, |value, key| value.get(key))
        };
        let when = &definition(path)?.when;
        let first = *unmet(when, &look_up).first()?;
        let shown = |name: &str| match name.strip_prefix(own.table).filter(|_| !own.table.is_empty()) {
            Some(rest) => format!("`{}{rest}`", own.shown),
            None => format!("`{name}`"),
        };
        let parts = if let When::Any(parts) = first { parts } else { std::slice::from_ref(first) };
        let (states, remedies): (Vec<_>, Vec<_>) =
            parts.iter().map(|part| state_and_remedy(part, &look_up, &shown)).unzip();
        Some(format!(
            "`{path}` has no effect: {}; {}, or remove line {}",
            states.join(" and "),
            remedies.join(", "),
            line_at(self.text, at)
        ))
    }
}

/// Why a simple condition does not hold, and how to change that.
fn state_and_remedy<'v>(
    when: &When,
    value: &dyn Fn(&str) -> Option<&'v Value>,
    shown: &dyn Fn(&str) -> String,
) -> (String, String) {
    let word = |name: &str| value(name).and_then(Value::as_str).unwrap_or("another");
    let has = |name: &'static str| contents(name).unwrap_or(name);
    match *when {
        When::On(name) => (format!("{} is false", shown(name)), "set it to true".into()),
        When::Above0(name) => {
            (format!("{} is not above 0", shown(name)), format!("set {} above 0", shown(name)))
        }
        When::Not0(name) => (format!("{} is 0", shown(name)), format!("set {}", shown(name))),
        When::Given(name) => (format!("{} is not set", shown(name)), format!("set {}", shown(name))),
        When::NotGiven(name) => (format!("{} is set", shown(name)), format!("remove {}", shown(name))),
        When::Is(name, words) => (
            format!("{} is {}", shown(name), word(name)),
            format!("set {} to {}", shown(name), words.join(" or ")),
        ),
        When::IsNot(name, _) => {
            (format!("{} is {}", shown(name), word(name)), format!("choose another {}", shown(name)))
        }
        When::Has(name) => (format!("the scene does not have {}", has(name)), format!("add {}", has(name))),
        When::HasNot(name) => (format!("the scene has {}", has(name)), format!("remove {}", shown(name))),
        When::Always | When::All(_) | When::Any(_) => {
            let names: Vec<String> = when.names().into_iter().map(shown).collect();
            (format!("it needs {}", when.phrase(shown)), format!("change {}", names.join(" or ")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{super::Reader, *};
    use std::path::{Path, PathBuf};

    /// A scene with these lines. Its hair has the material `m`.
    fn with_hair(lines: &str) -> String {
        let material = if lines.contains("[material.m]") { "" } else { "[material.m]\n" };
        format!("[builtin]\nstrands = 10\nguides = 5\nmaterial = \"m\"\n{lines}{material}")
    }

    fn notes_of(path: &Path, text: &str) -> Vec<String> {
        let file = super::super::parse(text).unwrap_or_else(|why| panic!("{}: {}", path.display(), why.text));
        let scene = Reader::new(path, text, &file.groom).settings(&file).unwrap();
        notes(text, &file, &scene)
    }

    #[test]
    fn written_parameters_without_effect_are_reported_with_a_remedy() {
        for (text, expected) in [
            (
                "[neighbours]\nradius = 0.002\n",
                "`neighbours.radius` has no effect: `neighbours.on` is false; set it to true, or remove line 6",
            ),
            (
                "[material.m]\nmodel = \"curvature\"\nshear = 1e9\n",
                "`material.m.shear` has no effect: `material.m.model` is curvature; choose another `material.m.model`, or remove line 7",
            ),
            (
                "[material.m]\nfriction = 0\nfriction_kinetic = 0.5\n",
                "`material.m.friction_kinetic` has no effect: `material.m.friction` is not above 0; set `material.m.friction` above 0, or remove line 7",
            ),
            (
                "[wind_occlusion]\nbody = 0.5\n",
                "`wind_occlusion.body` has no effect: `wind.velocity` is 0 and the scene does not have a wind source; set `wind.velocity`, add a wind source, or remove line 6",
            ),
            (
                "[builtin.effects]\ncurl_length = 0.02\n",
                "`builtin.effects.curl_length` has no effect: `builtin.effects.curl_radius` is not above 0; set `builtin.effects.curl_radius` above 0, or remove line 6",
            ),
            (
                "[volume]\nmethod = \"incompressible\"\npressure = 1.0\n",
                "`volume.pressure` has no effect: `volume.method` is incompressible; set `volume.method` to density, or remove line 7",
            ),
            (
                "[solver]\nglobal_shape = false\n[material.m]\nglobal_shape = { pull = 2.0 }\n",
                "`material.m.global_shape.pull` has no effect: `solver.global_shape` is false; set it to true, or remove line 8",
            ),
            (
                "[[groom]]\nfile = \"a.hair\"\nlook = { melanin = 0.5 }\n[[groom]]\nfile = \"a.hair\"\nlook = { melanin_redness = 0.5 }\n",
                "`groom.look.melanin_redness` has no effect: `groom.look.melanin` is not set; set `groom.look.melanin`, or remove line 10",
            ),
        ] {
            let text = with_hair(text);
            assert_eq!(notes_of("scene.toml".as_ref(), &text), [expected], "{text}");
        }
    }

    #[test]
    fn parameters_with_an_effect_are_not_reported() {
        for text in [
            "",
            "[neighbours]\non = true\nradius = 0.002\n",
            "[material.m]\nshear = 1e9\n",
            "[material.m]\ncharge = -1e-9\ncharge_profile = [0.0, 1.0]\n",
            "[wind]\nvelocity = [1, 0, 0]\ngust = 0.5\ngust_rate = 2\n",
            "[wind_occlusion]\nbody = 0.5\n[[wind_source]]\nshape.point = { center = [0, 1, 0], radius = 0.1, speed = 2 }\n",
        ] {
            let text = with_hair(text);
            assert_eq!(notes_of("scene.toml".as_ref(), &text), Vec::<String>::new(), "{text}");
        }
    }

    #[test]
    fn scenes_of_the_examples_and_the_book_have_no_parameters_without_effect() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let files =
            ["examples/scenes", "docs/parameters/scenes", "docs/tutorial"].into_iter().flat_map(|folder| {
                let folder = root.join(folder).read_dir().unwrap();
                folder.map(|entry| entry.unwrap().path()).collect::<Vec<PathBuf>>()
            });
        let scenes: Vec<PathBuf> =
            files.filter(|file| file.extension().is_some_and(|e| e == "toml")).collect();
        assert!(scenes.len() > 50, "{} scenes", scenes.len());
        for scene in scenes {
            let found = notes_of(&scene, &std::fs::read_to_string(&scene).unwrap());
            assert_eq!(found, Vec::<String>::new(), "{}", scene.display());
        }
    }
}
