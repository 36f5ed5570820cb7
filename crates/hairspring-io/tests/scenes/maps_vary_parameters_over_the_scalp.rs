//! Promise: maps vary the parameters of hair over the scalp.
//!
//! A map is a texture by texture coordinates, the colors of the body's vertices, or a list of numbers for the strands.
//! What it cannot do is an error with the line.

use crate::scenes::{folder, read};
use glam::Vec3;
use hairspring::groom::{Groom, StrandScale};
use hairspring_scene::stage::Stage;
use std::{fs, path::Path};

/// A square of 2 m with a color in each corner and texture coordinates from 0 to 1 over it.
const SQUARE: &str = "v -1 0 1 0 0 0\nv 1 0 1 1 0 0\nv 1 0 -1 1 1 0\nv -1 0 -1 0 1 0\n\
    vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

/// Three strands of 10 cm, whose roots are at the left, in the middle and at the right of the square.
fn strands() -> String {
    let strand = |x: f32| (0..5).map(move |k| format!("{x},{x},{},0\n", 0.025 * k as f32));
    "strand,x,y,z\n".to_owned() + &[-1.0, 0.0, 1.0].into_iter().flat_map(strand).collect::<String>()
}

/// A picture of 64 by 64 pixels that is black at the left and white at the right, with green at the lower edge.
fn ramp(path: &Path) {
    let pixel = |x: u32, y: u32| {
        let gray = (255.0 * (x as f32 + 0.5) / 64.0).round() as u8;
        image::Rgb([gray, if y >= 32 { 255 } else { 0 }, gray])
    };
    image::RgbImage::from_fn(64, 64, pixel).save(path).unwrap();
}

fn groom(maps: &str) -> Groom {
    let folder = made();
    read(folder.path(), &scene(maps)).unwrap().value.grooms.remove(0).groom
}

/// The error of a scene that is refused.
fn refused(folder: &tempfile::TempDir, text: &str) -> String {
    read(folder.path(), text).expect_err("the scene is accepted").to_string()
}

fn made() -> tempfile::TempDir {
    let folder = folder();
    fs::write(folder.path().join("square.obj"), SQUARE).unwrap();
    fs::write(folder.path().join("strands.csv"), strands()).unwrap();
    fs::write(folder.path().join("three.txt"), "0.25, 1\n2").unwrap();
    ramp(&folder.path().join("ramp.png"));
    folder
}

fn scene(maps: &str) -> String {
    format!(
        "[body]\nfile = \"square.obj\"\nscale = 1\n[[groom]]\nfile = \"strands.csv\"\nscale = 1\nguides = \"all\"\n[groom.maps]\n{maps}\n"
    )
}

#[test]
fn each_source_gives_its_value_at_the_root() {
    let near = |a: f32, b: f32| (a - b).abs() < 0.01;
    for (maps, want) in [
        ("bend = { texture = \"ramp.png\", channel = \"red\" }", [0.5 / 64.0, 0.5, 1.0 - 0.5 / 64.0]),
        ("bend = { texture = \"ramp.png\", channel = \"red\", low = 3, high = 1 }", [2.98, 2.0, 1.02]),
        ("bend = { vertex_colors = true, channel = \"red\" }", [0.0, 0.5, 1.0]),
        ("bend = { vertex_colors = true }", [0.5 / 3.0, 1.0 / 3.0, 0.5]),
        ("bend = { values = \"three.txt\" }", [0.25, 1.0, 2.0]),
        ("bend = { values = \"three.txt\", high = 4 }", [1.0, 4.0, 8.0]),
    ] {
        let groom = groom(maps);
        let found = [0, 1, 2].map(|s| groom.scale(s).bend);
        // The texture repeats: its left and right edges meet in the middle of both.
        let edge = maps.contains("texture");
        assert!(
            near(found[1], want[1]) && (edge || near(found[0], want[0]) && near(found[2], want[2])),
            "{maps}: {found:?}"
        );
    }
}

#[test]
fn each_parameter_follows_its_map() {
    let map = "{ values = \"three.txt\" }";
    type Of = fn(&StrandScale) -> f32;
    let factors: [(&str, Of); 8] = [
        ("bend", |s| s.bend),
        ("damping", |s| s.damping),
        ("drag", |s| s.drag),
        ("friction", |s| s.friction),
        ("charge", |s| s.charge),
        ("global_shape", |s| s.global_shape),
        ("flatness", |s| s.flatness),
        ("tether", |s| s.tether),
    ];
    for (name, of) in factors {
        let groom = groom(&format!("{name} = {map}"));
        assert_eq!([0, 1, 2].map(|s| of(&groom.scale(s))), [0.25, 1.0, 2.0], "{name}");
        let others = factors.iter().filter(|(other, _)| *other != name);
        others.for_each(|(other, of)| assert_eq!(of(&groom.scale(0)), 1.0, "{name} changes {other}"));
    }
    let (plain, short) = (groom(""), groom(&format!("length = {map}")));
    let lengths = [0, 1, 2].map(|s| short.strand_length(s) / plain.strand_length(s));
    assert!((lengths[0] - 0.25).abs() < 1e-5 && lengths[1..] == [1.0, 1.0], "{lengths:?}");
    let thin = groom(&format!("radius = {map}"));
    assert_eq!([0, 5, 10].map(|k| thin.radii[k] / plain.radii[k]), [0.25, 1.0, 2.0]);
    // Density keeps a share of the strands, and a length of 0 removes a strand.
    assert_eq!(groom("density = { values = \"three.txt\" }").strand_count(), 2);
    assert_eq!(groom("length = { values = \"three.txt\", low = -0.25, high = 0.75 }").strand_count(), 2);
}

/// A radius map multiplies the material's radius and its profile, both for drawing and for the simulation.
#[test]
fn a_radius_by_a_map_and_a_profile_is_drawn_as_it_is_simulated() {
    let folder = made();
    let material = "material = \"m\"\n[material.m]\nradius = 1e-5\nradius_profile = [1, 0.5]\n";
    let text = scene("radius = { values = \"three.txt\" }").replace("[groom.maps]", "@");
    let (before, after) = text.split_once('@').unwrap();
    let text = format!("{before}material = \"m\"\n[groom.maps]\n{after}{}", &material[15..]);
    let scene = read(folder.path(), &text).unwrap().value;
    let radii = &scene.grooms[0].groom.radii;
    let near = |a: f32, b: f32| (a / b - 1.0).abs() < 1e-4;
    for (s, factor) in [0.25, 1.0, 2.0].into_iter().enumerate() {
        assert!(near(radii[5 * s], 1e-5 * factor) && near(radii[5 * s + 4], 0.5e-5 * factor), "{radii:?}");
    }
    // The simulation multiplies the material's radius by the same factor.
    assert_eq!([0, 1, 2].map(|s| scene.grooms[0].groom.scale(s).radius), [0.25, 1.0, 2.0]);
    assert!(Stage::new(scene).is_ok());
}

#[test]
fn grown_hair_leaves_the_skin_as_its_map_combs_it() {
    let folder = made();
    let numbers: String = (0..40).map(|k| if k < 20 { "1 0 0\n" } else { "0 0 -0.5\n" }).collect();
    fs::write(folder.path().join("comb.txt"), numbers).unwrap();
    let grown = |maps: &str| {
        let text = format!(
            "[body]\nfile = \"square.obj\"\nscale = 1\n[[groom]]\ngrow = {{ strands = 40, fall = 0, length = 0.1 }}\nguides = \"all\"\n[groom.maps]\n{maps}\n"
        );
        let groom = read(folder.path(), &text).unwrap().value.grooms.remove(0).groom;
        let direction = |s: usize| (groom.strand(s)[15] - groom.strand(s)[0]).normalize();
        (0..groom.strand_count()).map(direction).collect::<Vec<_>>()
    };
    let near = |a: Vec3, b: Vec3| a.distance(b.normalize()) < 0.03;
    assert!(grown("").into_iter().all(|d| near(d, Vec3::Y)));
    let by_values = grown("comb = { values = \"comb.txt\" }");
    assert!(by_values[..20].iter().all(|d| near(*d, Vec3::X)), "{by_values:?}");
    assert!(by_values[20..].iter().all(|d| near(*d, Vec3::Y - Vec3::Z)), "{by_values:?}");
    // Red is along u, which is +X here, and green along v, which is −Z.
    let picture = |name: &str, color: [u8; 3]| {
        image::RgbImage::from_pixel(4, 4, image::Rgb(color)).save(folder.path().join(name)).unwrap();
    };
    picture("right.png", [255, 128, 0]);
    picture("back.png", [128, 255, 0]);
    picture("none.png", [128, 128, 0]);
    assert!(grown("comb = { texture = \"right.png\" }").into_iter().all(|d| near(d, Vec3::X)));
    assert!(grown("comb = { texture = \"back.png\" }").into_iter().all(|d| near(d, Vec3::NEG_Z)));
    assert!(
        grown("comb = { texture = \"back.png\", high = 0.5 }")
            .into_iter()
            .all(|d| near(d, Vec3::Y - Vec3::Z))
    );
    assert!(grown("comb = { texture = \"none.png\" }").into_iter().all(|d| near(d, Vec3::Y)));
    // A map of length cuts hair that grows, and one of density thins it evenly.
    let kept = grown("density = { vertex_colors = true, channel = \"blue\", low = 0.5 }").len();
    assert!((18..=22).contains(&kept), "{kept} of 40");
}

#[test]
fn maps_that_cannot_work_are_refused() {
    let folder = made();
    fs::write(folder.path().join("bad.txt"), "1 2 x").unwrap();
    fs::write(folder.path().join("four.txt"), "1 2 3 4").unwrap();
    fs::write(folder.path().join("square.obj"), SQUARE.replace(" 0 0 0\n", "\n")).unwrap();
    for (maps, words) in [
        ("bend = { }", &["line 9", "one of `texture`, `vertex_colors = true` and `values`"][..]),
        ("bend = { values = \"a\", vertex_colors = true }", &["line 9", "one of"]),
        ("bend = { values = \"bad.txt\" }", &["bad.txt, line 1", "expected a number, but found \"x\""]),
        (
            "bend = { values = \"four.txt\" }",
            &["four.txt", "expected 3 numbers, one for each strand, but found 4"],
        ),
        ("bend = { values = \"no.txt\" }", &["no.txt", "names it as the map"]),
        ("bend = { texture = \"four.txt\" }", &["four.txt", "export it as PNG or JPEG"]),
        (
            "bend = { values = \"three.txt\", high = -1 }",
            &["line 9", "is -0.25 at strand 0; it must be 0 or more"],
        ),
        ("bend = { values = \"three.txt\", high = inf }", &["line 9", "finite"]),
        ("bend = { values = \"three.txt\", chanel = \"red\" }", &["chanel"]),
        ("bends = { values = \"three.txt\" }", &["bends"]),
        ("density = { values = \"three.txt\", high = 0 }", &["leave no strand"]),
        ("radius = { values = \"three.txt\", low = -0.25, high = 0.75 }", &["line 9", "must be above 0"]),
        ("comb = { values = \"three.txt\" }", &["line 9", "direction of hair that grows"]),
    ] {
        let error = refused(&folder, &scene(maps));
        assert!(words.iter().all(|word| error.contains(word)), "{maps}: {error}");
    }
    let grown = "[body]\nfile = \"square.obj\"\n[[groom]]\ngrow = { strands = 10 }\n[groom.maps]\n";
    for setting in ["low = 0.5", "high = -1", "channel = \"red\""] {
        let text = format!("{grown}comb = {{ texture = \"ramp.png\", {setting} }}\n");
        let error = refused(&folder, &text);
        assert!(error.contains("line 6") && error.contains("omit `channel` and `low`"), "{setting}: {error}");
    }
    // Bodies without what the map needs.
    fs::write(folder.path().join("square.obj"), "v -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3\n").unwrap();
    let error = refused(&folder, &scene("bend = { vertex_colors = true }"));
    assert!(error.contains("needs a [body] whose vertices have colors"), "{error}");
    let error = refused(&folder, &scene("bend = { texture = \"ramp.png\" }"));
    assert!(error.contains("needs texture coordinates"), "{error}");
}

#[test]
fn maps_vary_the_hair_of_the_built_in_head() {
    let folder = folder();
    // White at the right half of the picture, which is her left (+X).
    let pixel = |x: u32, _| image::Luma([if x >= 32 { 255u8 } else { 0 }]);
    image::GrayImage::from_fn(64, 64, pixel).save(folder.path().join("left.png")).unwrap();
    // White at the lower half, which is the front (+Z).
    let pixel = |_, y: u32| image::Luma([if y >= 32 { 255u8 } else { 0 }]);
    image::GrayImage::from_fn(64, 64, pixel).save(folder.path().join("front.png")).unwrap();
    let hair = |maps: &str| {
        let text = format!("[builtin]\nstrands = 300\nguides = 30\nmaps = {{ {maps} }}\n");
        read(folder.path(), &text).unwrap().value.grooms.remove(0).groom
    };
    let whole = hair("");
    let cut = hair(
        "length = { texture = \"left.png\", low = 0.5 }, bend = { texture = \"front.png\", low = 2, high = 4 }",
    );
    assert_eq!(cut.strand_count(), 300);
    let mut compared = [0; 2];
    for s in 0..300 {
        let root = whole.strand(s)[0];
        // The texture changes within a pixel of the middle.
        if root.x.abs() > 0.01 {
            let share = cut.strand_length(s) / whole.strand_length(s);
            let want = if root.x > 0.0 { 1.0 } else { 0.5 };
            assert!((share - want).abs() < 0.02, "strand {s} at {root}: {share}");
            compared[usize::from(root.x > 0.0)] += 1;
        }
        if (root.z + 0.015).abs() > 0.01 {
            let want = if root.z > -0.015 { 4.0 } else { 2.0 };
            assert!((cut.scale(s).bend - want).abs() < 0.02, "strand {s} at {root}");
        }
    }
    assert!(compared.iter().all(|n| *n > 100), "{compared:?}");
    let thinned = hair("density = { texture = \"left.png\" }");
    assert!((0..thinned.strand_count()).all(|s| thinned.strand(s)[0].x > -0.01));
    assert!(thinned.strand_count() > 100);
    for (maps, words) in [
        ("comb = { texture = \"left.png\" }", ["line 4", "`comb`"]),
        ("length = { vertex_colors = true }", ["line 4", "needs a `texture` or `values`"]),
    ] {
        let text = format!("[builtin]\nstrands = 300\nguides = 30\nmaps = {{ {maps} }}\n");
        let error = refused(&folder, &text);
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
}
