//! Lists the differences between two compared scenes, with the labels of the panel.

use crate::parameter;

/// Maximum number of differences that are listed. The rest does not fit under a picture and is only counted.
const MOST: usize = 3;

/// The differences between the effective values of the left and the right scene, as one line for each.
pub fn captions(left: &toml::Table, right: &toml::Table) -> [String; 2] {
    let mut found = Vec::new();
    let [left, right] = [left, right].map(|t| toml::Value::Table(t.clone()));
    differences("", Some(&left), Some(&right), &mut found);
    if found.is_empty() {
        return ["the same settings".into(), "the same settings".into()];
    }
    let more = found.len().saturating_sub(MOST);
    std::array::from_fn(|side| {
        let named = found.iter().take(MOST).map(|(key, values)| format!("{}: {}", label(key), values[side]));
        let mut text = named.collect::<Vec<_>>().join(", ");
        if more > 0 {
            text.push_str(&format!(", and {more} more"));
        }
        text
    })
}

/// Descends into tables and lists of tables; everything else is compared as a value.
fn differences(
    key: &str,
    left: Option<&toml::Value>,
    right: Option<&toml::Value>,
    found: &mut Vec<(String, [String; 2])>,
) {
    use toml::Value::{Array, Table};
    match (left, right) {
        (left, right) if left == right => {}
        (Some(Table(a)), Some(Table(b))) => {
            let names = a.keys().chain(b.keys().filter(|name| !a.contains_key(*name)));
            for name in names {
                let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
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
        (a, b) => found.push((key.to_owned(), [a, b].map(written))),
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
        captions(&left.parse().unwrap(), &right.parse().unwrap())
    }

    #[test]
    fn what_differs_is_named_on_its_side() {
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
    }
}
