//! Every value of a scene that counts, whether its text says it or its default does.

use hairspring::scene::{Scene, SceneGroom};

/// What counts in a scene with one groom that says nothing.
pub fn defaults() -> toml::Table {
    let gravity = glam::Vec3::new(0.0, -9.81, 0.0);
    effective(
        &Scene { grooms: vec![SceneGroom::default()], gravity, ..Scene::default() },
        &toml::Table::new(),
    )
}

/// Of these settings, by the names of a scene file; but that `groom` lists all grooms, the built-in scene's among them, and that a groom's `material` is the list of
/// its materials. `said` is the text's own table: a motion is no setting, and its keys count as they are written.
pub fn effective(scene: &Scene, said: &toml::Table) -> toml::Table {
    fn value(of: &impl serde::Serialize) -> toml::Value {
        toml::Value::try_from(of).unwrap_or_else(|why| unreachable!("settings are plain data: {why}"))
    }
    let grooms = scene.grooms.iter().map(|groom| {
        let mut table = toml::Table::new();
        table.insert("look".into(), value(&groom.look));
        table.insert("effects".into(), value(&groom.effects));
        let default = [hairspring::material::Material::default()];
        let materials = if groom.materials.is_empty() { &default[..] } else { &groom.materials };
        table.insert("material".into(), value(&materials));
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
        ("shelter", value(&scene.shelter)),
        ("charged", value(&scene.charged)),
        ("solver", value(&scene.solver)),
        ("volume", value(&scene.volume)),
        ("neighbours", value(&scene.neighbours)),
        ("hand", value(&scene.hands)),
    ] {
        all.insert(name.into(), value);
    }
    if let Some(clip) = said.get("clip") {
        all.insert("clip".into(), clip.clone());
    }
    if let Some(camera) = &scene.camera {
        all.insert("camera".into(), value(camera));
    }
    all.iter_mut().for_each(|(_, value)| shortest(value));
    all
}

/// Settings are single precision: each number is the shortest that reads as it, as a person would write it.
fn shortest(value: &mut toml::Value) {
    match value {
        toml::Value::Float(x) => *x = (*x as f32).to_string().parse().unwrap_or(*x),
        toml::Value::Array(list) => list.iter_mut().for_each(shortest),
        toml::Value::Table(table) => table.iter_mut().for_each(|(_, value)| shortest(value)),
        _ => {}
    }
}
