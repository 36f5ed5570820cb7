//! Promise: the settings of a scene file are read quickly, without its geometry. Settings and geometry
//! together equal the scene.
//!
//! `read_settings` returns the same settings as reading the whole scene, for `Stage::update_settings`,
//! without opening a file or growing hair. `same_geometry` tells whether two texts differ only in settings.

use crate::scenes::{folder, message, read};
use glam::Vec3;
use hairspring::{groom::Groom, settings::Effects};
use hairspring_io::{Error, read_scene_text, read_settings, same_geometry};
use hairspring_scene::{HairLook, Scene, SceneGroom, Shape, builtin};
use std::path::Path;

/// A scene without geometry.
fn bare(scene: Scene) -> Scene {
    let grooms = scene.grooms.into_iter().map(|g| SceneGroom { groom: Groom::default(), ..g }).collect();
    Scene { grooms, body: None, collision: None, sheets: Vec::new(), clip: None, ..scene }
}

const FILES: &str = r#"
    [body]
    file = "head.obj"
    scale = 1
    [clip]
    keys = [{ time = 0 }, { time = 1, rotation = [0, 90, 0] }]
    [[groom]]
    file = "hair.data"
    scale = 2
    material = ["mine", "coily"]
    guides = 3
    [groom.look]
    variation = 0.7
    [groom.effects]
    clump = 0.3
    [[groom]]
    grow = { parts = ["scalp"], strands = 40, points = 5 }
    [material.mine]
    preset = "curly"
    friction = 0.5
    [[sheet]]
    file = "head.obj"
    scale = 1
    [[collider]]
    shape.hull = { file = "stone.obj", scale = 1 }
    [wind]
    velocity = [1, 0, 0]
    [[charged]]
    center = [0, 1, 0]
    radius = 0.1
    charge = -1e-7
    [solver]
    collide_body = false
    [[hand]]
    tool.grab = { center = [0, 1, 0], radius = 0.02 }
    [camera]
    fov = 20
"#;

const STONE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";

const BUILTIN: &str = "[builtin]\nstyle = \"curly\"\nstrands = 40\nguides = 10\nmaterial = \"mine\"\n\
    look = { variation = 0.9 }\neffects = { noise = 0.002 }\n\
    [material.mine]\npreset = \"curly\"\nbend = 3\n[volume]\nmethod = \"density\"\n";

#[test]
fn settings_and_geometry_are_the_scene() {
    let folder = folder();
    std::fs::write(folder.path().join("stone.obj"), STONE).unwrap();
    for text in [FILES, BUILTIN] {
        let whole = read(folder.path(), text).unwrap().value;
        let path = folder.path().join("scene.toml");
        let again = read_scene_text(&path, text).unwrap().value;
        assert!(again == whole, "reading the text gives another scene than reading the file");
        assert!(whole.grooms.iter().all(|g| g.groom.strand_count() > 0) && whole.body.is_some());
        assert_eq!(read_settings(&path, text).unwrap(), bare(whole));
    }
}

#[test]
fn only_hull_files_are_opened() {
    // This folder does not exist.
    let path = Path::new("nowhere/scene.toml");
    let without =
        FILES.replace("    [[collider]]\n    shape.hull = { file = \"stone.obj\", scale = 1 }\n", "");
    let settings = read_settings(path, &without).unwrap();
    assert_eq!((settings.name.as_str(), settings.grooms.len()), ("scene", 2));
    assert_eq!(settings.grooms[0].materials[0].friction, 0.5);
    let error = read_settings(path, FILES).unwrap_err();
    assert!(matches!(error, Error::NotFound { .. }) && error.to_string().contains("stone.obj"), "{error}");
    let folder = folder();
    std::fs::write(folder.path().join("stone.obj"), STONE).unwrap();
    let settings = read_settings(&folder.path().join("scene.toml"), FILES).unwrap();
    assert!(matches!(&settings.colliders[0].shape, Shape::Hull { points, .. } if points.len() == 4));
}

#[test]
fn built_in_hair_accepts_look_and_effects() {
    let settings = |text: &str| read_settings(Path::new("x.toml"), text).unwrap();
    let style = builtin::settings(&Default::default()).grooms[0].clone();
    assert_eq!(settings("[builtin]").grooms[0].look, style.look);
    let hair = settings("[builtin]\nlook.variation = 0.9\n[builtin.effects]\nclump = 0.4").grooms[0].clone();
    // The given fields override those of the style, not the general defaults.
    assert_eq!(hair.look, HairLook { variation: 0.9, ..style.look });
    assert_eq!(hair.effects, Effects { clump: 0.4, ..Effects::default() });
    assert_eq!(settings("[builtin]\nlook = {}").grooms[1], builtin::settings(&Default::default()).grooms[1]);
    for (text, part) in [
        ("[builtin]\n[builtin.look]\nvariation = 2", "scene.toml, line 3: `variation` must be 0 to 1"),
        (
            "[builtin]\n[builtin.look]\nvarition = 0",
            "line 3: `varition` is unknown; did you mean `variation`?",
        ),
        ("[builtin]\n[builtin.effects]\nclump = -1", "line 3: `clump` must be 0 to 1"),
        ("[builtin]\nstyle = \"wvy\"", "line 2: the style `wvy` is unknown; did you mean `wavy`?"),
    ] {
        let of_settings = read_settings(Path::new("scene.toml"), text).unwrap_err().to_string();
        for error in [message(text), of_settings] {
            assert!(error.contains(part), "{error}");
        }
    }
}

#[test]
fn same_geometry_ignores_settings_only() {
    let builtin = "[builtin]\nstyle = \"wavy\"\nmaterial = \"mine\"\n[material.mine]\nbend = 2\n[solver]\n";
    assert!(same_geometry(builtin, builtin) && same_geometry(FILES, FILES));
    assert!(!same_geometry(builtin, FILES));
    for (before, after) in [
        ("style = \"wavy\"\n", ""),
        ("style = \"wavy\"\n", "style = \"wavy\"\nstrands = 100000\nguides = 2000\nmotion = true\n"),
        ("bend = 2", "bend = 200\ndamping = 0.1"),
        ("bend = 2", "model = \"springs\""),
        ("material = \"mine\"", "material = \"coily\"\nlook.specular = 2\neffects.clump = 1"),
        ("[solver]\n", "[solver]\nsubsteps = 8\nintegrator = \"bdf2\"\ncollide_body = true\n"),
        (
            "[solver]\n",
            "[wind]\nvelocity = [1, 0, 0]\n[turbulence]\nstrength = 1\n[wind_occlusion]\nbody = 3\n",
        ),
        (
            "[solver]\n",
            "[[collider]]\nshape.hull = { file = \"no.obj\" }\n[camera]\nfov = 3\n[volume]\ncell = 0.1\n",
        ),
        ("[solver]\n", "[ground]\non = true\nheight = 1\n"),
        ("[builtin]\n", "name = \"other\"\ngravity = [0, 0, 0]\n[builtin]\n"),
    ] {
        assert!(
            builtin.contains(before) && same_geometry(builtin, &builtin.replace(before, after)),
            "{after}"
        );
    }
    for (before, after) in [
        ("\"wavy\"", "\"curly\""),
        ("style", "strands = 7\nstyle"),
        ("style", "guides = 7\nstyle"),
        ("style", "motion = false\nstyle"),
        ("bend = 2", "radius = 3e-5"),
        ("[solver]\n", "[solver]\ncollide_body = false\n"),
        ("[solver]\n", "[[groom]]\nfile = \"hair.data\"\n"),
        ("[solver]\n", "[clip]\nkeys = [{ time = 0 }]\n"),
        ("[solver]\n", "[[sheet]]\nfile = \"cape.obj\"\n"),
        (
            "[solver]\n",
            "[[collider]]\ninitial = \"push\"\nshape.sphere = { center = [0, 0, 0], radius = 1 }\n",
        ),
        ("[solver]\n", "[solver]\nsubstep = 3\n"),
    ] {
        assert!(
            builtin.contains(before) && !same_geometry(builtin, &builtin.replace(before, after)),
            "{after}"
        );
    }
    for (before, after) in [
        ("scale = 2", "scale = 2\ntransform.position = [0, 0, 0]"),
        ("    guides = 3\n", "    guides = 3\n    thicken.copies = 0\n"),
        ("variation = 0.7", "variation = 0.1"),
        ("\"coily\"", "\"curly\""),
        ("strands = 40", "strands = 40, length = 0.1"),
    ] {
        assert!(FILES.contains(before) && same_geometry(FILES, &FILES.replacen(before, after, 1)), "{after}");
    }
    for (before, after) in [
        ("scale = 2", "scale = 2.5"),
        ("scale = 2", "scale = 2\ntransform.position = [0, 1, 0]"),
        ("guides = 3", "guides = \"all\""),
        ("guides = 3", "thicken.copies = 2"),
        ("\"coily\"", "\"short-fur\""),
        ("strands = 40", "strands = 41"),
        ("rotation = [0, 90, 0]", "rotation = [0, 91, 0]"),
        ("hair.data", "other.data"),
        ("[body]", "[collision]\nfile = \"x.obj\"\n[body]"),
    ] {
        assert!(
            FILES.contains(before) && !same_geometry(FILES, &FILES.replacen(before, after, 1)),
            "{after}"
        );
    }
    // A radius from a preset counts like a radius in the text.
    let radius = "[builtin]\n[material.mine]\nradius = 25e-6\n";
    let with_material =
        |material: &str| radius.replace("[builtin]", &format!("[builtin]\nmaterial = {material}"));
    assert!(same_geometry(&with_material("\"mine\""), &with_material("[\"short-fur\", \"mine\"]")));
}

#[test]
fn a_stage_accepts_the_settings_that_are_read() {
    let folder = folder();
    let path = folder.path().join("scene.toml");
    let mut stage =
        hairspring_scene::stage::Stage::new(read_scene_text(&path, BUILTIN).unwrap().value).unwrap();
    stage.step(hairspring_test::FRAME);
    let text =
        format!("gravity = [0, -1.6, 0]\n{BUILTIN}[wind]\nvelocity = [0, 0, 3]\n[ground]\non = true\n");
    assert!(same_geometry(BUILTIN, &text));
    stage.update_settings(read_settings(&path, &text).unwrap()).unwrap();
    assert_eq!((stage.scene().gravity, stage.scene().wind.velocity), (Vec3::Y * -1.6, Vec3::Z * 3.0));
    assert!(stage.body().is_some() && stage.scene().ground.on);
    stage.step(hairspring_test::FRAME);
}
