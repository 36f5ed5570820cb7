//! Lists the differences between two compared scenes, with the labels of the panel.

use crate::{
    AppError,
    effective::effective,
    key::{Key, written_name},
    parameter,
    text::shortened,
};

/// Maximum number of differences that are listed. The rest does not fit under a picture and is only counted.
const MOST: usize = 3;

/// Maximum length of a value in a caption [characters], of which lists of numbers have many.
const LONGEST: usize = 60;

/// A value that differs between two scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The key of the value, such as `solver.substeps`.
    pub key: String,
    /// The two values; `None` where a scene has none.
    pub values: [Option<toml::Value>; 2],
}

impl Difference {
    /// The panel's label of the value, or its key.
    pub fn label(&self) -> &str {
        label(&self.key)
    }

    /// The two values as text.
    pub fn written(&self) -> [String; 2] {
        self.values.each_ref().map(|value| written(value.as_ref()))
    }
}

/// The differences between the effective values of the left and the right scene, as one line for each. `texts`
/// are their parsed texts.
pub fn captions(effective: [&toml::Table; 2], texts: [&toml::Table; 2]) -> [String; 2] {
    captions_of(&set_differences(effective, texts))
}

/// The same for differences that are known.
pub fn captions_of(found: &[Difference]) -> [String; 2] {
    if found.is_empty() {
        return ["the same settings".into(), "the same settings".into()];
    }
    let more = found.len().saturating_sub(MOST);
    std::array::from_fn(|side| {
        let value = |d: &Difference| shortened(&d.written()[side], LONGEST).into_owned();
        let named = found.iter().take(MOST).map(|d| format!("{}: {}", d.label(), value(d)));
        let mut text = named.collect::<Vec<_>>().join(", ");
        if more > 0 {
            text.push_str(&format!(", and {more} more"));
        }
        text
    })
}

/// The differences between two tables of effective values.
pub fn between(left: &toml::Table, right: &toml::Table) -> Vec<Difference> {
    let mut found = Vec::new();
    let [left, right] = [left, right].map(|t| toml::Value::Table(t.clone()));
    differences("", Some(&left), Some(&right), &mut found);
    found
}

/// The differences between the effective values of two scenes. If no text has a camera, the program chose it,
/// and it does not count.
fn set_differences(effective: [&toml::Table; 2], texts: [&toml::Table; 2]) -> Vec<Difference> {
    let mut found = between(effective[0], effective[1]);
    if texts.iter().all(|text| !text.contains_key("camera")) {
        found.retain(|d| d.key.split('.').next() != Some("camera"));
    }
    found
}

/// The differences between two scenes: their settings without geometry ([`hairspring_io::read_settings`]) and
/// the texts of their files. Defaults count as values. The name of a scene does not count.
///
/// # Errors
/// Returns an error for a text that is not TOML.
pub fn scene_differences(
    scenes: [&hairspring_scene::Scene; 2],
    texts: [&str; 2],
) -> Result<Vec<Difference>, AppError> {
    let parse = |text: &str| text.parse::<toml::Table>().map_err(|why| AppError::new(why.to_string()));
    let parsed = [parse(texts[0])?, parse(texts[1])?];
    let effective = [0, 1].map(|k| effective(scenes[k], &parsed[k]));
    let mut found = set_differences(effective.each_ref(), parsed.each_ref());
    // Files, props and motions are not settings. Of the texts, only what has no effective value counts.
    let known = |key: &str| {
        let covered = ["name", "material", "builtin"];
        let first = key.split(['.', '[']).next().unwrap_or_default();
        let key: Option<Key> = key.parse().ok();
        covered.contains(&first) || key.is_some_and(|k| effective.iter().any(|t| k.look_up(t).is_some()))
    };
    found.retain(|d| d.key != "name");
    found.extend(between(&parsed[0], &parsed[1]).into_iter().filter(|d| !known(&d.key)));
    Ok(found)
}

/// Descends into tables and lists of tables; everything else is compared as a value.
fn differences(
    key: &str,
    left: Option<&toml::Value>,
    right: Option<&toml::Value>,
    found: &mut Vec<Difference>,
) {
    use toml::Value::{Array, Table};
    match (left, right) {
        (left, right) if left == right => {}
        (Some(Table(a)), Some(Table(b))) => {
            let names = a.keys().chain(b.keys().filter(|name| !a.contains_key(*name)));
            for name in names {
                let written = written_name(name);
                let key = if key.is_empty() { written } else { format!("{key}.{written}") };
                differences(&key, a.get(name), b.get(name), found);
            }
        }
        (Some(Array(a)), Some(Array(b)))
            if [a, b].iter().any(|list| list.iter().any(toml::Value::is_table)) =>
        {
            for k in 0..a.len().max(b.len()) {
                differences(&format!("{key}[{k}]"), a.get(k), b.get(k), found);
            }
        }
        (a, b) => found.push(Difference { key: key.to_owned(), values: [a.cloned(), b.cloned()] }),
    }
}

fn written(value: Option<&toml::Value>) -> String {
    match value {
        None => "none".into(),
        Some(toml::Value::String(text)) => text.clone(),
        Some(toml::Value::Table(_)) => "there".into(),
        Some(toml::Value::Float(x)) => x.to_string(),
        Some(toml::Value::Array(list)) => {
            format!("[{}]", list.iter().map(|x| written(Some(x))).collect::<Vec<_>>().join(", "))
        }
        Some(other) => other.to_string(),
    }
}

/// The panel's label of a value, or its key.
fn label(key: &str) -> &str {
    let known = |p: &&parameter::Parameter| {
        key == p.name || key.strip_suffix(p.name).is_some_and(|k| k.ends_with('.'))
    };
    // If several names have the same ending, the longest one is used.
    parameter::ALL.iter().filter(known).max_by_key(|p| p.name.len()).map_or(key, |p| p.label)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(left: &str, right: &str) -> [String; 2] {
        let [left, right] = [left, right].map(|text| text.parse().unwrap());
        captions([&left, &right], [&left, &right])
    }

    #[test]
    fn a_camera_that_the_program_chose_is_no_difference() {
        let [none, some]: [toml::Table; 2] = ["", "camera.fov = 30.0"].map(|text| text.parse().unwrap());
        assert_eq!(captions([&some, &none], [&none, &none]), ["the same settings"; 2]);
        assert_eq!(captions([&some, &none], [&some, &none]), ["camera: there", "camera: none"]);
    }

    #[test]
    fn captions_name_each_difference_on_its_side() {
        let [left, right] =
            named("solver.integrator = \"bdf2\"\nx = 1", "solver.integrator = \"verlet\"\nx = 1");
        assert_eq!((left.as_str(), right.as_str()), ("Integrator: bdf2", "Integrator: verlet"));
        let [left, right] =
            named("[[groom]]\nmaterial = [{ bend = 1.0 }]", "[[groom]]\nmaterial = [{ bend = 4.5 }]");
        assert_eq!((left.as_str(), right.as_str()), ("Bending: 1", "Bending: 4.5"));
        assert_eq!(named("[[hand]]\nfrom = 1.0", ""), ["hand: [there]", "hand: none"]);
        assert_eq!(named("a = 1", "a = 1"), ["the same settings"; 2]);
        let many = named("a = 1\nb = 1\nc = 1\nd = 1\ne = 1", "a = 2\nb = 2\nc = 2\nd = 2\ne = 2");
        assert_eq!(many[1], "a: 2, b: 2, c: 2, and 2 more");
        let list = format!("a = [{}]", "1.5, ".repeat(100));
        let [left, _] = named(&list, "a = []");
        assert!(
            left.starts_with("a: [1.5, 1.5") && left.ends_with('…') && left.chars().count() < 70,
            "{left}"
        );
    }

    #[test]
    fn defaults_count_as_values_and_files_as_differences() {
        let texts = [
            "name = \"one\"\n[builtin]\nstrands = 500\n[solver]\nsubsteps = 4\n",
            "[builtin]\nstrands = 500\n[wind]\ngust = 0.5\n[clip]\nfile = \"walk.bvh\"\n",
        ];
        let scenes = texts.map(|text| hairspring_io::read_settings("a.toml".as_ref(), text).unwrap());
        let found = scene_differences([&scenes[0], &scenes[1]], texts).unwrap();
        let keys: Vec<&str> = found.iter().map(|d| d.key.as_str()).collect();
        assert!(keys.contains(&"wind.gust"), "{keys:?}");
        assert!(keys.iter().any(|k| k.starts_with("clip")), "{keys:?}");
        assert!(!keys.iter().any(|k| ["name", "solver.substeps", "builtin.strands"].contains(k)), "{keys:?}");
    }
}
