//! All effective values of a scene, whether they are in its text or are defaults.

use hairspring::{
    groom::{Growth, Thicken},
    material::{Material, PRESETS},
};
use hairspring_scene::{
    Guides, InitialContact, Scene, SceneGroom, SceneSheet,
    builtin::{BuiltinOptions, Style},
};

fn value(of: &impl serde::Serialize) -> toml::Value {
    toml::Value::try_from(of).unwrap_or_else(|why| unreachable!("settings are plain data: {why}"))
}

/// Returns the effective values of these settings, with the keys of a scene file. There are two differences:
/// `groom` lists all grooms, including those of the built-in scene with the values of `[builtin]`; and a
/// groom's `material` is the list of its materials, each with its `preset`. `parsed` is the parsed text. A
/// motion is not a setting, so its keys are taken from the text.
pub fn effective(scene: &Scene, parsed: &toml::Table) -> toml::Table {
    let made = scene.grooms.len().saturating_sub(entries(parsed, "groom").len());
    let grooms = scene.grooms.iter().enumerate().map(|(place, groom)| {
        let text = match place.checked_sub(made) {
            Some(listed) => entries(parsed, "groom").get(listed),
            None => parsed.get("builtin").filter(|_| place == 0),
        };
        let mut table = toml::Table::new();
        table.insert("look".into(), value(&groom.look));
        table.insert("effects".into(), value(&groom.effects));
        table.insert("guides".into(), guides(groom));
        let default = [Material::default()];
        let materials = if groom.materials.is_empty() { &default[..] } else { &groom.materials };
        let materials = materials.iter().enumerate().map(|(group, material)| {
            let mut material = value(material);
            if let Some(table) = material.as_table_mut() {
                let preset = preset_of(parsed, text, place < made, group).unwrap_or("none");
                table.insert("preset".into(), preset.into());
            }
            material
        });
        table.insert("material".into(), toml::Value::Array(materials.collect()));
        if let Some(text) = text {
            if place < made { built(text, &mut table) } else { listed(text, &mut table) }
        }
        toml::Value::Table(table)
    });
    let mut all = toml::Table::new();
    all.insert("groom".into(), toml::Value::Array(grooms.collect()));
    for (name, value) in [
        ("name", value(&scene.name)),
        ("gravity", value(&scene.gravity)),
        ("collider", value(&scene.colliders)),
        ("wind", value(&scene.wind)),
        ("wind_source", value(&scene.wind_sources)),
        ("turbulence", value(&scene.turbulence)),
        ("wind_occlusion", value(&scene.wind_occlusion)),
        ("charged", value(&scene.charged)),
        ("solver", value(&scene.solver)),
        ("volume", value(&scene.volume)),
        ("neighbours", value(&scene.neighbours)),
        ("hand", value(&scene.hands)),
        ("picture", value(&scene.picture)),
        ("ground", value(&scene.ground)),
    ] {
        all.insert(name.into(), value);
    }
    if let Some(clip) = parsed.get("clip") {
        all.insert("clip".into(), motion(clip));
    }
    if let Some(body) = parsed.get("body") {
        all.insert("body".into(), picked(body, &["color", "roughness"]).into());
    }
    let sheets = entries(parsed, "sheet").iter().map(|sheet| {
        let mut table = picked(sheet, &["joint", "thickness", "initial"]);
        table.entry("thickness").or_insert(value(&SceneSheet::THICKNESS));
        table.entry("initial").or_insert(value(&InitialContact::default()));
        toml::Value::Table(table)
    });
    all.insert("sheet".into(), toml::Value::Array(sheets.collect()));
    if let Some(camera) = &scene.camera {
        all.insert("camera".into(), value(camera));
    }
    all.iter_mut().for_each(|(_, value)| shortest(value));
    all
}

/// Adds the values of `[builtin]` that other grooms do not have.
fn built(text: &toml::Value, table: &mut toml::Table) {
    let style =
        text.get("style").and_then(toml::Value::as_str).and_then(Style::from_name).unwrap_or_default();
    let strands = i64::from(BuiltinOptions::new(style).strands);
    table.insert("style".into(), style.name().into());
    table.insert("strands".into(), text.get("strands").cloned().unwrap_or(strands.into()));
    table.insert("motion".into(), text.get("motion").cloned().unwrap_or(true.into()));
}

/// Adds the values of a `[[groom]]` that the settings do not have: the number of hairs, and the placement.
fn listed(text: &toml::Value, table: &mut toml::Table) {
    let over = |base: toml::Value, name: &str| {
        let (mut base, own) = (base.try_into::<toml::Table>().unwrap_or_default(), text.get(name));
        base.extend(
            own.and_then(toml::Value::as_table).into_iter().flatten().map(|(k, v)| (k.clone(), v.clone())),
        );
        base
    };
    table.insert("thicken".into(), over(value(&Thicken::default()), "thicken").into());
    if text.get("grow").is_some() {
        let base = Growth::default();
        let mut grow = toml::Table::new();
        grow.insert("strands".into(), value(&base.strands));
        grow.insert("points".into(), value(&base.points));
        for (name, x) in [("length", base.length), ("spread", base.spread), ("fall", base.fall)] {
            grow.insert(name.into(), value(&x));
        }
        table.insert("grow".into(), over(grow.into(), "grow").into());
    }
    let mut place = toml::Table::new();
    for (name, x) in [("position", 0.0), ("rotation", 0.0), ("scale", 1.0)] {
        place.insert(name.into(), value(&[x; 3]));
    }
    let mut place = over(place.into(), "transform");
    // A single factor is equivalent to three equal ones.
    if let Some(factor) = place.get("scale").filter(|scale| !scale.is_array()).cloned() {
        place.insert("scale".into(), vec![factor; 3].into());
    }
    table.insert("transform".into(), place.into());
}

/// A motion as it is written, with defaults for the fields of a motion file that are left out.
fn motion(clip: &toml::Value) -> toml::Value {
    let mut table = clip.as_table().cloned().unwrap_or_default();
    if clip.get("keys").is_none() {
        let start = table.entry("start").or_insert(0.into()).clone();
        if clip.get("joint").is_some() {
            table.entry("rest_frame").or_insert(start);
            table.entry("travel").or_insert("in-place".into());
            table.entry("facing").or_insert(0.0.into());
        }
    }
    table.into()
}

/// These fields of a table, if they are present.
fn picked(text: &toml::Value, names: &[&str]) -> toml::Table {
    names.iter().filter_map(|name| Some(((*name).to_owned(), text.get(name)?.clone()))).collect()
}

fn guides(groom: &SceneGroom) -> toml::Value {
    match groom.guides {
        Guides::FromGroom => "file".into(),
        Guides::All => "all".into(),
        Guides::Count(n) => i64::from(n).into(),
    }
}

/// Name of the preset that a groom's material is based on. `text` is the groom's table; `built` marks that of
/// the built-in scene, whose style has a material.
fn preset_of(
    parsed: &toml::Table,
    text: Option<&toml::Value>,
    built: bool,
    group: usize,
) -> Option<&'static str> {
    let text = text?;
    let named = match text.get("material") {
        Some(toml::Value::Array(names)) => names.get(group).or(names.last()).and_then(toml::Value::as_str),
        Some(name) => name.as_str(),
        None if built => text.get("style").map_or(Some(Style::default().name()), toml::Value::as_str),
        None => None,
    }?;
    let own = parsed.get("material").and_then(|materials| materials.get(named));
    let name = own.map_or(Some(named), |own| own.get("preset").and_then(toml::Value::as_str))?;
    PRESETS.into_iter().find(|preset| *preset == name)
}

/// The entries of a list of tables.
pub fn entries<'a>(parsed: &'a toml::Table, list: &str) -> &'a [toml::Value] {
    parsed.get(list).and_then(toml::Value::as_array).map_or(&[], Vec::as_slice)
}

/// Settings have single precision. Each number is replaced by its shortest decimal representation, as a
/// person would write it.
fn shortest(value: &mut toml::Value) {
    match value {
        toml::Value::Float(x) => *x = (*x as f32).to_string().parse().unwrap_or(*x),
        toml::Value::Array(list) => list.iter_mut().for_each(shortest),
        toml::Value::Table(table) => table.iter_mut().for_each(|(_, value)| shortest(value)),
        _ => {}
    }
}
