//! Promise: the page that documents scene files shows every field, and its example is a valid scene file.

use hairspring_io::scene::check_text;

#[test]
fn the_example_of_the_page_is_valid() {
    let page = include_str!("../../../../docs/scene.md");
    let example = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    check_text(example).unwrap();
    // Fields that are commented out in the example because they exclude others.
    check_text(
        &example
            .replace("# rig =", "rig =")
            .replace("# weights =", "weights =")
            .replace("# bones =", "bones ="),
    )
    .unwrap();
    let commented_lines = |keys: &[&str]| -> String {
        let line = |k: &&str| {
            example.lines().filter_map(|l| l.strip_prefix("# ")).find(|l| l.starts_with(*k)).unwrap()
        };
        keys.iter().map(|k| format!("{}\n", line(k))).collect()
    };
    let builtin = commented_lines(&[
        "[builtin]",
        "style =",
        "strands =",
        "guides =",
        "material =",
        "motion =",
        "look =",
        "effects =",
    ]);
    check_text(&format!("{builtin}[clip]\n{}", commented_lines(&["keys ="]))).unwrap();
}

#[test]
fn the_page_shows_every_setting() {
    let page = include_str!("../../../../docs/scene.md");
    let material = hairspring::material::Material { radius: Some(1.0), ..Default::default() };
    let volume = hairspring::settings::Volume { cell: Some(1.0), ..Default::default() };
    let neighbours = hairspring::settings::Neighbours { radius: Some(1.0), ..Default::default() };
    let ground =
        hairspring_scene::Ground { height: Some(1.0), color: Some(Default::default()), ..Default::default() };
    for (name, fields) in [
        ("look", toml::Table::try_from(hairspring_scene::HairLook::default())),
        ("effects", toml::Table::try_from(hairspring::settings::Effects::default())),
        ("wind", toml::Table::try_from(hairspring::settings::Wind::default())),
        ("turbulence", toml::Table::try_from(hairspring::air::Turbulence::default())),
        ("wind_occlusion", toml::Table::try_from(hairspring::air::WindOcclusion::default())),
        ("solver", toml::Table::try_from(hairspring::settings::Solver::default())),
        ("volume", toml::Table::try_from(volume)),
        ("neighbours", toml::Table::try_from(neighbours)),
        ("camera", toml::Table::try_from(hairspring_scene::Camera::default())),
        ("ground", toml::Table::try_from(ground)),
        ("material", toml::Table::try_from(material)),
    ] {
        for key in fields.unwrap().keys() {
            assert!(page.contains(&format!("\n{key} = ")), "docs/scene.md does not show `{key}` of {name}");
        }
    }
}
