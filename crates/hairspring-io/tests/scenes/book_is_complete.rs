//! Promise: the book is complete and has no broken reference. Every parameter of a scene file has a page in
//! the folder of its group in `docs/parameters`, with its unit, its range and the default of the code. The
//! page has two pictures, of the values in the table of pictures, or states why not. The group's page and
//! the summary list the parameters in the same order, and the group's page repeats the first sentence of
//! each parameter's page. Every page is in the summary exactly once. Every link of every page and of the
//! README leads to a file. Every page is linked from a page other than the summary. Every picture is shown,
//! and the scenes of the book can be read. The glossary is sorted and names files that exist.

use crate::book::{docs, files, is_a_group, name_of, parameter_pages, read};
use hairspring::{
    air::{Turbulence, WindOcclusion, WindSource},
    forces::charge::Charged,
    groom::{Growth, Thicken},
    material::Material,
    settings::{Effects, Neighbours, Solver, Volume, Wind},
};
use hairspring_io::scene::{check_text, parameters as definitions};
use hairspring_scene::{Camera, Collider, Ground, HairLook, Hand, Picture};
use serde::{Serialize, de::DeserializeOwned};
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::PathBuf,
};
use toml::{Table, Value};

#[test]
fn every_parameter_has_a_page() {
    let said = parameters();
    let known: BTreeSet<&str> = definitions::parameters().map(|(name, _)| name).collect();
    for name in &known {
        assert!(said.contains_key(*name), "docs/parameters has no page `{name}`");
    }
    for name in said.keys() {
        let there = known.contains(name.as_str());
        assert!(there, "docs/parameters has a page `{name}`, which is not a parameter of a scene file");
    }
}

#[test]
fn every_parameter_has_unit_range_and_default() {
    let defaults = defaults();
    let pages = parameters();
    for (name, text) in &pages {
        let facts =
            text.lines().find(|l| l.starts_with("Unit: ")).unwrap_or_else(|| panic!("{name}: no unit"));
        assert!(facts.contains(" Range: "), "{name}: no range");
        let default = facts.split(" Default: ").nth(1).unwrap_or_else(|| panic!("{name}: no default"));
        let Some(right) = defaults.get(name) else { continue };
        let default = default.trim_end_matches('.').trim_matches('`');
        assert!(same(&value_of(default), right), "{name}: the default is {right}, not {default}");
    }
    assert!(
        defaults.keys().filter(|name| pages.contains_key(*name)).count() > 60,
        "defaults are not compared"
    );
}

#[test]
fn every_parameter_has_pictures_or_a_reason() {
    let table: Table = read(&docs().join("pictures.toml")).parse().unwrap();
    let mut pages = parameters();
    for entry in table["parameter"].as_array().unwrap() {
        let name = entry["name"].as_str().unwrap();
        let text = pages.remove(name).unwrap_or_else(|| panic!("pictures.toml: unknown parameter `{name}`"));
        let (low, high) = (&entry["low"], &entry["high"]);
        // Values are compared, because the order of a table's fields is unspecified.
        let heads = text.lines().find(|l| l.starts_with("| `")).unwrap_or_default();
        let heads: Vec<Value> =
            heads.split(" | ").map(|h| value_of(h.trim_matches(['|', ' ', '`']))).collect();
        let right = heads.len() == 2 && same(&heads[0], low) && same(&heads[1], high);
        assert!(right, "{name}: the page does not show the values {low} and {high}");
        for side in ["low", "high"] {
            assert!(
                text.contains(&format!("(../../pictures/parameters/{name}-{side}.jpg)")),
                "{name}: {side}"
            );
        }
        let (scene, frame) = (entry["scene"].as_str().unwrap(), &entry["frame"]);
        assert!(text.contains(&format!("(../scenes/{scene}.toml)")), "{name}: the scene {scene} is missing");
        assert!(text.contains(&format!("frame {frame}.")), "{name}: the frame {frame} is missing");
    }
    for (name, text) in pages {
        assert!(text.contains("*No picture.*"), "{name} has neither a picture nor a reason");
    }
    for picture in files(&docs().join("pictures/parameters"), "jpg") {
        let bytes = fs::metadata(&picture).unwrap().len();
        assert!(bytes < 30_000, "{}: {bytes} bytes", picture.display());
    }
}

#[test]
fn group_pages_list_their_parameters() {
    let pages = parameters();
    let summary = read(&docs().join("SUMMARY.md"));
    let mut listed = BTreeSet::new();
    for page in files(&docs().join("parameters"), "md").iter().filter(|p| is_a_group(p)) {
        let group = page.file_stem().unwrap().to_str().unwrap();
        let text = read(page);
        assert!(!text.contains("\n## "), "{}: parameters must have pages of their own", page.display());
        let rows: Vec<&str> = text.lines().filter(|l| l.starts_with("| [`")).collect();
        let mut entries = format!("](parameters/{group}.md)\n");
        for row in rows {
            let name = row.trim_start_matches("| [`").split('`').next().unwrap();
            let text = pages.get(name).unwrap_or_else(|| panic!("{group}: the page `{name}` is missing"));
            // The links of a page are relative to its own folder.
            let [row, text] = [row, text].map(without_links);
            let mut parts = text.lines().filter(|l| !l.is_empty() && !l.starts_with("Applies only if "));
            let (unit, rest) =
                parts.next().unwrap().trim_start_matches("Unit: ").split_once(". Range: ").unwrap();
            let default = rest.split(" Default: ").nth(1).unwrap().trim_end_matches('.');
            let what = parts.next().unwrap();
            let first = what.split_inclusive(". ").next().unwrap().trim_end();
            assert_eq!(row, format!("| `{name}` | {first} | {unit} | {default} |"), "{}", page.display());
            entries += &format!("    - [{name}](parameters/{group}/{name}.md)\n");
            listed.insert(name.to_owned());
        }
        assert!(summary.contains(&entries), "docs/SUMMARY.md does not list, in this order: {entries}");
    }
    assert!(
        pages.keys().eq(&listed),
        "missing on the page of their group: {:?}",
        pages.keys().filter(|n| !listed.contains(*n))
    );
}

#[test]
fn every_page_is_in_the_summary_and_linked() {
    let summary = read(&docs().join("SUMMARY.md"));
    let led_to = links(files(&docs(), "md").into_iter().filter(|page| !page.ends_with("SUMMARY.md")));
    for page in files(&docs(), "md") {
        let name = page.strip_prefix(docs()).unwrap().to_str().unwrap().replace('\\', "/");
        if name != "SUMMARY.md" && name != "README.md" {
            assert_eq!(summary.matches(&format!("]({name})")).count(), 1, "{name} in docs/SUMMARY.md");
            assert!(led_to.contains(&page.canonicalize().unwrap()), "no page links to {name}");
        }
    }
}

#[test]
fn every_link_leads_to_a_file() {
    let linked = links(files(&docs(), "md").into_iter().chain([docs().join("../README.md")]));
    for picture in files(&docs(), "jpg") {
        assert!(linked.contains(&picture.canonicalize().unwrap()), "no page shows {}", picture.display());
    }
}

#[test]
fn the_glossary_is_in_order_and_names_files_that_exist() {
    let page = read(&docs().join("glossary.md"));
    // A path that begins with the name of a crate is relative to that crate's source.
    let crates = docs().join("../crates");
    let source = |file: &str| match file.split_once('/') {
        Some((name, rest)) if name.starts_with("hairspring-") => crates.join(name).join("src").join(rest),
        _ => crates.join("hairspring/src").join(file),
    };
    let rows: Vec<Vec<&str>> = page
        .lines()
        .filter(|line| line.starts_with("| "))
        .skip(1)
        .map(|line| line.split('|').map(str::trim).collect())
        .filter(|cells: &Vec<&str>| !cells[1].starts_with('-'))
        .collect();
    assert!(rows.len() > 50, "{} terms", rows.len());
    let terms: Vec<&str> = rows.iter().map(|cells| cells[1]).collect();
    assert!(terms.is_sorted(), "the terms are not in order: {terms:?}");
    for cells in &rows {
        assert!(cells[2].ends_with('.'), "{}: the meaning is not a sentence", cells[1]);
        for file in cells[3].split('`').skip(1).step_by(2) {
            assert!(source(file).exists(), "{} is in {file}, which does not exist", cells[1]);
        }
    }
}

#[test]
fn every_scene_of_the_book_can_be_read() {
    for scene in files(&docs().join("parameters/scenes"), "toml") {
        check_text(&read(&scene)).unwrap_or_else(|why| panic!("{}: {why}", scene.display()));
    }
    let tutorials: String = files(&docs().join("tutorial"), "md").iter().map(|page| read(page)).collect();
    for scene in files(&docs().join("tutorial"), "toml") {
        let text = read(&scene);
        check_text(&text).unwrap_or_else(|why| panic!("{}: {why}", scene.display()));
        assert!(tutorials.contains(&text), "no tutorial shows {} as it is", scene.display());
    }
}

/// The text of each parameter's page, `docs/parameters/GROUP/NAME.md`, after its heading.
fn parameters() -> BTreeMap<String, String> {
    let mut all = BTreeMap::new();
    for page in parameter_pages() {
        let name = name_of(&page);
        let text = read(&page);
        let text = text.strip_prefix(&format!("# `{name}`\n"));
        let text = text.unwrap_or_else(|| panic!("{}: wrong heading", page.display()));
        let before = all.insert(name.to_owned(), text.to_owned());
        assert!(before.is_none(), "{name} has two pages");
    }
    all
}

/// All files that these pages link to or show; each must exist.
fn links(pages: impl Iterator<Item = PathBuf>) -> BTreeSet<PathBuf> {
    let mut linked = BTreeSet::new();
    for page in pages {
        let mut code = false;
        for line in read(&page).lines() {
            code ^= line.starts_with("```");
            for link in line.split("](").skip(1).filter(|_| !code).filter_map(|l| l.split(')').next()) {
                let file = link.split('#').next().unwrap();
                if !file.is_empty() && !link.contains("://") {
                    let to = page.parent().unwrap().join(file);
                    assert!(to.is_file(), "{}: {link} does not exist", page.display());
                    linked.insert(to.canonicalize().unwrap());
                }
            }
        }
    }
    linked
}

/// The text with `` `name` `` in place of every `` [`name`](link) ``.
fn without_links(text: &str) -> String {
    let (start, rest) = text.split_once("](").unwrap_or((text, ""));
    let leads_to = |part: &str| part.split_once(')').map(|(_, behind)| behind.to_owned());
    let rest: String = rest.split("](").filter_map(leads_to).collect();
    format!("{start}{rest}").replace("[`", "`")
}

/// Defaults in the code, by the names that the book uses.
fn defaults() -> BTreeMap<String, Value> {
    let mut all = BTreeMap::new();
    defaults_of::<HairLook>("groom.look", "", &mut all);
    defaults_of::<Effects>("groom.effects", "", &mut all);
    defaults_of::<Thicken>("groom.thicken", "", &mut all);
    defaults_of::<Material>("material", "", &mut all);
    defaults_of::<Wind>("wind", "", &mut all);
    defaults_of::<Turbulence>("turbulence", "", &mut all);
    defaults_of::<WindOcclusion>("wind_occlusion", "", &mut all);
    defaults_of::<Solver>("solver", "", &mut all);
    defaults_of::<Volume>("volume", "", &mut all);
    defaults_of::<Neighbours>("neighbours", "", &mut all);
    defaults_of::<Camera>("camera", "position = [1, 0, 0]\ntarget = [0, 0, 0]", &mut all);
    defaults_of::<Picture>("picture", "", &mut all);
    defaults_of::<Ground>("ground", "", &mut all);
    let place = "center = [0, 0, 0]\nradius = 1\n";
    let ring = format!("{place}axis = [0, 1, 0]\n");
    defaults_of::<WindSource>("wind_source", &format!("[shape.fan]\n{ring}speed = 1"), &mut all);
    defaults_of::<Charged>("charged", &format!("{place}charge = 0"), &mut all);
    defaults_of::<Collider>("collider", "shape.box = { center = [0, 0, 0], size = [1, 1, 1] }", &mut all);
    defaults_of::<Hand>("hand", &format!("[tool.grab]\n{place}"), &mut all);
    defaults_of::<Hand>("hand", "tool.comb = { a = [0, 0, 0], b = [1, 0, 0], radius = 1 }", &mut all);
    defaults_of::<Hand>("hand", &format!("[tool.tie]\n{ring}reach = 1"), &mut all);
    let grown = Growth::default();
    for (name, value) in [
        ("strands", grown.strands as f32),
        ("points", grown.points as f32),
        ("length", grown.length),
        ("spread", grown.spread),
        ("fall", grown.fall),
    ] {
        all.insert(format!("groom.grow.{name}"), Value::Float(value.into()));
    }
    all
}

/// The value of `T` for a file that has only the fields in `needed`.
fn defaults_of<T: Serialize + DeserializeOwned>(
    prefix: &str,
    needed: &str,
    all: &mut BTreeMap<String, Value>,
) {
    let (mut given, mut whole) = (BTreeMap::new(), BTreeMap::new());
    flatten(prefix, &needed.parse().unwrap(), &mut given);
    flatten(prefix, &Table::try_from(toml::from_str::<T>(needed).unwrap()).unwrap(), &mut whole);
    all.extend(whole.into_iter().filter(|(name, _)| !given.contains_key(name)));
}

fn flatten(prefix: &str, table: &Table, flat: &mut BTreeMap<String, Value>) {
    for (key, value) in table {
        let name = format!("{prefix}.{key}");
        match value {
            Value::Table(inner) => flatten(&name, inner, flat),
            _ => drop(flat.insert(name, value.clone())),
        }
    }
}

/// Parses a TOML value.
fn value_of(text: &str) -> Value {
    let table = format!("x = {text}").parse::<Table>();
    table.unwrap_or_else(|why| panic!("`{text}`: {why}")).remove("x").unwrap()
}

/// Whether two values are equal up to `f32` precision.
fn same(a: &Value, b: &Value) -> bool {
    let number = |v: &Value| v.as_float().or(v.as_integer().map(|i| i as f64));
    match (a, b) {
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        _ => match (number(a), number(b)) {
            (Some(a), Some(b)) => (a - b).abs() <= 1e-6 * b.abs(),
            _ => a == b,
        },
    }
}
