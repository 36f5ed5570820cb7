//! Every parameter of a scene file under its full name, from the definitions of the settings.

use super::{
    file::{BodyFile, BuiltinFile, ClipFile, KeyFile, PropFile, SceneFile},
    groom_file::{GroomFile, GrowFile, Placement},
};
use hairspring::{
    air::{Turbulence, WindOcclusion, WindSource},
    forces::charge::Charged,
    groom::{Growth, Thicken},
    material::{Material, PRESETS},
    settings::{Effects, Fields, Neighbours, Parameter, Range, Setting, Solver, Volume, When, Wind},
};
use hairspring_scene::{Camera, Collider, Ground, HairLook, Hand, Picture};
use std::{collections::BTreeMap, sync::LazyLock};

/// The preset of a material. It selects the values that a material does not set, so no material stores it.
const PRESET: Parameter = Parameter {
    name: "preset",
    unit: "none",
    range: Range::Words,
    expected: "one of its values",
    default: None,
    default_text: "none: a single human hair",
    doc: "Preset that gives the values which the material does not set. Without a preset, they are those of a\n single human hair.",
    words: &PRESETS,
    fields: &[],
    when: When::Always,
};

/// The tables of a scene file, and the parameters in each.
const TABLES: [(&str, &[Parameter]); 26] = [
    ("", SceneFile::PARAMETERS),
    ("builtin", BuiltinFile::PARAMETERS),
    ("body", BodyFile::PARAMETERS),
    ("collision", BodyFile::PARAMETERS),
    ("sheet", BodyFile::PARAMETERS),
    ("clip", ClipFile::PARAMETERS),
    ("clip.keys", KeyFile::PARAMETERS),
    ("prop", PropFile::PARAMETERS),
    ("groom", GroomFile::PARAMETERS),
    ("groom.grow", GrowFile::PARAMETERS),
    ("groom.grow", Growth::PARAMETERS),
    ("groom.transform", Placement::PARAMETERS),
    ("groom.thicken", Thicken::PARAMETERS),
    ("groom.look", HairLook::PARAMETERS),
    ("groom.effects", Effects::PARAMETERS),
    ("material", &[PRESET]),
    ("material", Material::PARAMETERS),
    ("wind", Wind::PARAMETERS),
    ("turbulence", Turbulence::PARAMETERS),
    ("wind_occlusion", WindOcclusion::PARAMETERS),
    ("solver", Solver::PARAMETERS),
    ("volume", Volume::PARAMETERS),
    ("neighbours", Neighbours::PARAMETERS),
    ("camera", Camera::PARAMETERS),
    ("picture", Picture::PARAMETERS),
    ("ground", Ground::PARAMETERS),
];

/// Lists of the scene file, whose entries have these parameters.
const LISTS: [(&str, Fields); 4] = [
    ("wind_source", WindSource::FIELDS),
    ("charged", Charged::FIELDS),
    ("collider", Collider::FIELDS),
    ("hand", Hand::FIELDS),
];

/// All parameters by full name.
static ALL: LazyLock<BTreeMap<String, &'static Parameter>> = LazyLock::new(|| {
    let mut all = BTreeMap::new();
    for (table, parameters) in TABLES {
        add(table, parameters, &mut all);
    }
    for (list, parameters) in LISTS.iter().flat_map(|(list, fields)| fields.iter().map(move |f| (list, f.1)))
    {
        add(list, parameters, &mut all);
    }
    all
});

/// Returns every parameter of a scene file with its full name, such as `groom.effects.curl_radius`, in
/// alphabetical order.
pub fn parameters() -> impl Iterator<Item = (&'static str, &'static Parameter)> {
    ALL.iter().map(|(name, parameter)| (name.as_str(), *parameter))
}

/// Returns the definition of the parameter with this full name.
pub fn parameter(name: &str) -> Option<&'static Parameter> {
    ALL.get(name).copied()
}

/// Returns what a list or table of the scene file contains, for the conditions of parameters.
pub fn contents(table: &str) -> Option<&'static str> {
    Some(match table {
        "clip" => "a motion of its own",
        "wind_source" => "a wind source",
        _ => return None,
    })
}

/// The fields of a table, and the name of the kind of table that has them, which is empty for a plain table.
pub(super) type Variant = (&'static str, Vec<&'static Parameter>);

/// Returns the fields of the table, or of the tables of the list, at this place of a scene file, such as `clip.keys`; none if
/// another value belongs there.
pub(super) fn fields(path: &str) -> Vec<Variant> {
    documented_fields(&documented(path))
}

/// Returns the definition of the field at this place of a scene file.
pub(super) fn definition(path: &str) -> Option<&'static Parameter> {
    documented_definition(&documented(path))
}

/// [`fields`] for the name under which the tables list a place.
fn documented_fields(path: &str) -> Vec<Variant> {
    let plain: Vec<&Parameter> =
        TABLES.iter().filter(|(table, _)| *table == path).flat_map(|(_, fields)| *fields).collect();
    if !plain.is_empty() {
        return vec![("", plain)];
    }
    let variants =
        |fields: Fields| fields.iter().map(|(variant, fields)| (*variant, fields.iter().collect::<Vec<_>>()));
    if let Some((_, fields)) = LISTS.iter().find(|(list, _)| *list == path) {
        return variants(*fields).collect();
    }
    if let Some(field) = documented_definition(path) {
        return variants(field.fields).collect();
    }
    let Some((parent, name)) = path.rsplit_once('.') else { return Vec::new() };
    let of_kind = documented_fields(parent).into_iter().find(|(variant, _)| *variant == name);
    of_kind.map(|(_, fields)| ("", fields)).into_iter().collect()
}

/// [`definition`] for the name under which the tables list a place.
fn documented_definition(path: &str) -> Option<&'static Parameter> {
    let (parent, name) = path.rsplit_once('.').unwrap_or(("", path));
    let plain = documented_fields(parent).into_iter().filter(|(variant, _)| variant.is_empty());
    let named = plain.flat_map(|(_, fields)| fields).filter(|field| field.name == name);
    // The table around the hair that is grown repeats the names of its fields without a definition.
    named.max_by_key(|field| field.range != Range::Table)
}

/// Whether this place of a scene file holds a list of tables.
pub(super) fn is_list(path: &str) -> bool {
    let mut of_file = ["groom", "prop", "sheet"].into_iter().chain(LISTS.map(|(list, _)| list));
    let is_empty_list = |default: fn() -> String| default() == "[]";
    of_file.any(|list| list == path)
        || path.ends_with(".more")
        || definition(path).and_then(|field| field.default).is_some_and(is_empty_list)
}

/// The name under which the tables list this place: without the name of a material, and with the fields that several tables
/// share under the one that documents them.
fn documented(path: &str) -> String {
    let mut parts: Vec<&str> = path.split('.').collect();
    match parts[..] {
        ["material", _, ..] => _ = parts.remove(1),
        ["prop", "keys", ..] => parts[0] = "clip",
        ["prop", "mesh", ..] | ["body" | "collision" | "sheet", "more", ..] => {
            _ = parts.splice(..2, ["body"])
        }
        ["builtin", "look" | "effects", ..] | ["body" | "collision" | "sheet", "transform", ..] => {
            parts[0] = "groom"
        }
        ["groom", "grow", "inside", ..] => _ = parts.splice(..3, ["collider", "shape"]),
        _ => {}
    }
    parts.join(".")
}

/// Adds the parameters of a table, and those of the tables in it.
fn add(table: &str, parameters: &'static [Parameter], all: &mut BTreeMap<String, &'static Parameter>) {
    let within = |table: &str, name: &str| match (table, name) {
        ("", name) => name.to_owned(),
        (table, "") => table.to_owned(),
        (table, name) => format!("{table}.{name}"),
    };
    for parameter in parameters {
        let name = within(table, parameter.name);
        for (variant, fields) in parameter.fields {
            add(&within(&name, variant), fields, all);
        }
        if parameter.range != Range::Table && belongs(table, parameter.name) {
            all.insert(name, parameter);
        }
    }
}

/// Whether this parameter of a mesh is documented under this table: those that all meshes share are
/// documented under `body`, and the others where they are first used.
fn belongs(table: &str, name: &str) -> bool {
    match name {
        "thickness" | "initial" if table != "collider" => table == "sheet",
        "joint" if table != "collision" => !["body", "sheet"].contains(&table),
        _ => name == "joint" || !["collision", "sheet"].contains(&table),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_of_the_scene_file_has_parameters() {
        assert!(ALL.len() > 150, "{} parameters", ALL.len());
        for table in SceneFile::PARAMETERS.iter().filter(|p| p.range == Range::Table) {
            let prefix = format!("{}.", table.name);
            assert!(ALL.keys().any(|name| name.starts_with(&prefix)), "{}", table.name);
        }
    }

    #[test]
    fn every_parameter_is_documented_and_its_condition_names_parameters() {
        for (name, parameter) in parameters() {
            let (summary, unit) = (parameter.summary(), parameter.unit);
            assert!(summary.ends_with('.') && !unit.is_empty(), "{name}: {summary}");
            assert!(!summary.contains("[`"), "{name}: tooltips have no links");
            assert!(parameter.range != Range::Words || !parameter.words.is_empty(), "{name} has no words");
            for other in parameter.when.names() {
                let known = ALL.contains_key(other) || contents(other).is_some();
                assert!(known && other != name, "{name} depends on `{other}`");
            }
        }
    }

    #[test]
    fn every_default_is_in_its_range() {
        let settings: [&dyn hairspring::settings::Validate; 15] = [
            &Solver::default(),
            &Volume::default(),
            &Neighbours::default(),
            &Effects::default(),
            &Wind::default(),
            &Turbulence::default(),
            &WindOcclusion::default(),
            &Material::default(),
            &Thicken::default(),
            &Growth::default(),
            &HairLook::default(),
            &Picture::default(),
            &Ground::default(),
            &Camera::default(),
            &hairspring::material::GlobalShape::default(),
        ];
        for settings in settings {
            settings.validate().unwrap();
        }
        // Those of list entries and of files, by the text of the definition.
        for (name, parameter) in parameters() {
            let Some(default) = parameter.default.filter(|_| parameter.range != Range::Described) else {
                continue;
            };
            let text = default();
            let value: toml::Table = format!("x = {text}").parse().unwrap_or_default();
            let numbers = match value.get("x") {
                Some(toml::Value::Array(list)) => list.iter().filter_map(number).collect(),
                Some(value) => number(value).into_iter().collect(),
                None => Vec::new(),
            };
            assert!(parameter.range.accepts(&numbers), "{name}: {text} is not {}", parameter.expected);
            let word = value.get("x").and_then(toml::Value::as_str);
            assert!(word.is_none_or(|word| parameter.words.contains(&word)), "{name}: {text}");
        }
    }

    #[test]
    fn defaults_of_the_built_in_scene_match_its_code() {
        use hairspring_scene::{Guides, builtin::BuiltinOptions};
        let default = |name: &str| parameter(name).unwrap().default.unwrap()();
        let options = BuiltinOptions::default();
        assert_eq!(default("builtin.style"), format!("{:?}", options.style.name()));
        assert_eq!(default("builtin.strands"), options.strands.to_string());
        assert_eq!(options.guides, Guides::Count(default("builtin.guides").parse().unwrap()));
    }

    fn number(value: &toml::Value) -> Option<f32> {
        value.as_float().map(|x| x as f32).or_else(|| value.as_integer().map(|x| x as f32))
    }
}
