//! Looks up materials by name, and applies tables that override a base.

use super::{
    check,
    exact_arrays::Exact,
    file::{OneOrMore, SceneFile},
    groom_file::GroomFile,
    sentence::{line_at, line_of_key, problem_in_table, unknown},
};
use crate::Problem;
use hairspring::material::{self, Material};
use serde::{Serialize, de::DeserializeOwned};
use toml::Spanned;

/// Returns the materials of a groom, one per group.
pub(super) fn of_groom(text: &str, scene: &SceneFile, groom: &GroomFile) -> Result<Vec<Material>, Problem> {
    named(text, scene, groom.material.as_ref(), groom.start())
}

/// Returns the materials of these names. `start` is the first byte of the table that refers to them.
pub(super) fn named(
    text: &str,
    scene: &SceneFile,
    named: Option<&OneOrMore>,
    start: usize,
) -> Result<Vec<Material>, Problem> {
    let names: &[String] = match named {
        None => &[],
        Some(OneOrMore::One(name)) => std::slice::from_ref(name),
        Some(OneOrMore::More(names)) if names.is_empty() => {
            let line = line_of_key(text, line_at(text, start), "material").unwrap_or(1);
            return Err(Problem::line(
                line,
                "`material` must name at least one material; omit it for the default",
            ));
        }
        Some(OneOrMore::More(names)) => names,
    };
    let known = || scene.material.keys().map(String::as_str).chain(material::PRESETS);
    names
        .iter()
        .map(|name| match (scene.material.get(name), material::preset(name)) {
            (Some(table), _) => overlaid(text, table),
            (None, Some(preset)) => Ok(preset),
            (None, None) => {
                let line = line_of_key(text, line_at(text, start), "material").unwrap_or(1);
                Err(Problem::line(line, format!("the material {}", unknown(name, known()))))
            }
        })
        .collect()
}

/// Checks every material, also those that no groom uses.
pub(super) fn check_all(text: &str, scene: &SceneFile) -> Result<(), Problem> {
    scene.material.values().try_for_each(|table| overlaid(text, table).map(|_| ()))
}

/// Notes about materials that no groom uses.
pub(super) fn unused(scene: &SceneFile) -> Option<String> {
    let named = scene.groom.iter().filter_map(|groom| groom.material.as_ref());
    let named = named.chain(scene.builtin.iter().filter_map(|builtin| builtin.material.as_ref()));
    let used: Vec<&str> = named
        .flat_map(|named| match named {
            OneOrMore::One(name) => std::slice::from_ref(name),
            OneOrMore::More(names) => names,
        })
        .map(String::as_str)
        .collect();
    let unused: Vec<String> = scene
        .material
        .keys()
        .filter(|name| !used.contains(&name.as_str()))
        .map(|name| format!("[material.{name}]"))
        .collect();
    (!unused.is_empty()).then(|| format!("no groom uses {}; name it in `material`", unused.join(", ")))
}

/// A note about a groom whose groups are more or fewer than the materials that it names.
pub(super) fn of_groups(materials: usize, groups: usize) -> Option<String> {
    let differ = materials > 1 && materials != groups;
    let which =
        if materials > groups { "the last ones are not used" } else { "the last one is used for the rest" };
    let noun = if groups == 1 { "group" } else { "groups" };
    differ
        .then(|| format!("the groom has {groups} {noun} and `material` names {materials} materials; {which}"))
}

/// Returns a `[material.NAME]`: its preset, overridden by the given fields.
pub(super) fn overlaid(text: &str, table: &Spanned<toml::Table>) -> Result<Material, Problem> {
    let start = table.span().start;
    let mut fields = table.get_ref().clone();
    let base = match fields.remove("preset") {
        None => Material::default(),
        Some(value) => value.as_str().and_then(material::preset).ok_or_else(|| {
            let line = line_of_key(text, line_at(text, start), "preset").unwrap_or(1);
            let name = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            Problem::line(line, format!("the preset {}", unknown(&name, material::PRESETS)))
        })?,
    };
    let material: Material = over(text, start, "material.NAME", &base, fields)?;
    check::in_range(text, line_at(text, start), &material)?;
    Ok(material)
}

/// Returns `base`, overridden by the given fields of a `table` of the scene file, which begins at byte `start`.
pub(super) fn over<T: Serialize + DeserializeOwned>(
    text: &str,
    start: usize,
    table: &str,
    base: &T,
    fields: toml::Table,
) -> Result<T, Problem> {
    let mut all = toml::Table::try_from(base).map_err(|e| Problem::whole(e.to_string()))?;
    all.extend(fields.clone());
    T::deserialize(Exact(all.clone())).map_err(|e: toml::de::Error| {
        let path = wrong_field::<T>(&all, &fields).map(|field| format!("{table}.{field}"));
        problem_in_table(text, start, &e, path.as_deref())
    })
}

/// Returns the field without which the table `all` would be valid, of those given. A field of a table inside
/// it, such as `global_shape.pull`, is preferred.
fn wrong_field<T: DeserializeOwned>(all: &toml::Table, fields: &toml::Table) -> Option<String> {
    let valid = |table: toml::Table| table.try_into::<T>().is_ok();
    let without = |key: &str| {
        let mut rest = all.clone();
        rest.remove(key);
        rest
    };
    fields.iter().find(|(key, _)| valid(without(key))).map(|(key, value)| {
        let inner = value.as_table().into_iter().flatten().map(|(inner, _)| inner).find(|inner| {
            let mut rest = all.clone();
            rest.get_mut(key).and_then(toml::Value::as_table_mut).map(|table| table.remove(*inner));
            valid(rest)
        });
        inner.map_or(key.clone(), |inner| format!("{key}.{inner}"))
    })
}
