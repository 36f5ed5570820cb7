//! Promise: what a scene repairs, leaves out or cannot use is reported once, with the name of its file.
//!
//! A wrong result without a word costs a day. Each test has a file that looks right in another program.

use crate::scenes::{folder, read};
use glam::Vec3;
use hairspring::groom::Groom;
use hairspring_io::write_groom;
use hairspring_scene::{Scene, stage::Stage};
use std::fs;

const GROOM: &str = "[[groom]]\nfile = \"hair.data\"\nscale = 1.0\n";

/// A box of 20 cm below the hair, whose faces look outward or inward.
fn cube(inward: bool, at: Vec3) -> String {
    let mut text = String::new();
    for k in 0..8 {
        let corner = at + Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32) * 0.2;
        text += &format!("v {} {} {}\n", corner.x, corner.y, corner.z);
    }
    for mut face in [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]] {
        if inward {
            face.reverse();
        }
        text += &format!("f {} {} {} {}\n", face[0], face[1], face[2], face[3]);
    }
    text
}

/// The notes of a scene that contain `words`.
fn notes(notes: &[String], words: &str) -> usize {
    notes.iter().filter(|note| note.contains(words)).count()
}

#[test]
fn a_body_whose_triangles_face_inward_is_turned_round() {
    let folder = folder();
    let text = format!("[body]\nfile = \"box.obj\"\nscale = 1.0\n{GROOM}");
    let mut bodies = Vec::new();
    for inward in [false, true] {
        fs::write(folder.path().join("box.obj"), cube(inward, Vec3::ZERO)).unwrap();
        let loaded = read(folder.path(), &text).unwrap();
        assert_eq!(
            notes(&loaded.notes, "box.obj: its triangles face inward"),
            inward as usize,
            "{:?}",
            loaded.notes
        );
        bodies.push(loaded.value.body.unwrap().mesh);
    }
    let [right, turned] = &bodies[..] else { panic!() };
    for (a, b) in right.normals.iter().zip(&turned.normals) {
        assert!(a.dot(*b) > 0.5, "{a} {b}");
    }
    // An open mesh has no inside: a square, and half of a box.
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n".to_owned();
    let half = cube(true, Vec3::ZERO).lines().take(11).collect::<Vec<_>>().join("\n");
    for open in [square, half] {
        fs::write(folder.path().join("box.obj"), open).unwrap();
        let loaded = read(folder.path(), &text).unwrap();
        assert_eq!(notes(&loaded.notes, "inward"), 0, "{:?}", loaded.notes);
    }
}

#[test]
fn a_mesh_far_from_the_origin_is_not_thin() {
    let folder = folder();
    let at = Vec3::new(200.0, 0.0, 0.0);
    fs::write(folder.path().join("box.obj"), cube(false, at)).unwrap();
    let strand = [0.0, 0.1, 0.2].map(|y| at + Vec3::new(0.1, 0.2 + y, 0.1));
    write_groom(&folder.path().join("hair.data"), &Groom::from_strands([strand], 4e-5)).unwrap();
    let text = format!("[body]\nfile = \"box.obj\"\nscale = 1.0\n{GROOM}");
    let stage = Stage::new(read(folder.path(), &text).unwrap().value).unwrap();
    assert_eq!(stage.thin_mesh(), None);
}

#[test]
fn the_transform_of_a_body_moves_its_vertex_cache_too() {
    let folder = folder();
    for k in 0..3 {
        fs::write(folder.path().join(format!("box.{k}.obj")), cube(false, Vec3::Y * 0.1 * k as f32)).unwrap();
    }
    let text = format!(
        "[body]\nfile = \"box.0.obj\"\nscale = 1.0\nvertex_cache = \"box.#.obj\"\ntransform = {{ position = [0.5, 0, 0], scale = [3, 3, 3] }}\n{GROOM}"
    );
    let Scene { body, vertex_cache, .. } = read(folder.path(), &text).unwrap().value;
    let (mesh, frames) = (body.unwrap().mesh, vertex_cache.unwrap().frames);
    for (k, frame) in frames.iter().enumerate() {
        for (moved, rest) in frame.iter().zip(&mesh.positions) {
            assert!(moved.distance(*rest + Vec3::Y * 0.3 * k as f32) < 1e-5, "frame {k}: {moved}, {rest}");
        }
    }
}

#[test]
fn strands_without_points_stay_beside_the_others() {
    let folder = folder();
    let at = Vec3::splat(3.0);
    let good = [0.0, 0.1, 0.2].map(|y| at + Vec3::Y * y);
    let lost = [Vec3::NAN; 3];
    write_groom(&folder.path().join("hair.data"), &Groom::from_strands([good, lost], 4e-5)).unwrap();
    let loaded = read(folder.path(), GROOM).unwrap();
    assert_eq!(notes(&loaded.notes, "hair.data: 1 strands have no finite point"), 1, "{:?}", loaded.notes);
    assert_eq!(loaded.value.grooms[0].groom.strand(1)[0], at);
}

#[test]
fn repairs_name_the_groom() {
    let folder = folder();
    let strand = |x: f32| [Vec3::X * x, Vec3::X * x, Vec3::new(x, 0.1, 0.0)];
    write_groom(&folder.path().join("other.data"), &Groom::from_strands([strand(0.0), strand(1.0)], 4e-5))
        .unwrap();
    let text = format!("{GROOM}[[groom]]\nfile = \"other.data\"\nscale = 1.0\n");
    let loaded = read(folder.path(), &text).unwrap();
    assert_eq!(notes(&loaded.notes, "other.data: repaired 2 segments"), 1, "{:?}", loaded.notes);
    assert_eq!(notes(&loaded.notes, "repaired"), 1, "{:?}", loaded.notes);
}

#[test]
fn materials_that_nothing_uses_are_named() {
    let folder = folder();
    let text = format!(
        "{GROOM}material = [\"a\", \"wavy\"]\n[material.a]\nfriction = 0.1\n[material.b]\nfriction = 0.2\n"
    );
    let loaded = read(folder.path(), &text).unwrap();
    assert_eq!(notes(&loaded.notes, "no groom uses [material.b]"), 1, "{:?}", loaded.notes);
    assert_eq!(notes(&loaded.notes, "1 group and `material` names 2"), 1, "{:?}", loaded.notes);
    let loaded = read(folder.path(), &format!("{GROOM}material = \"wavy\"\n")).unwrap();
    assert_eq!(notes(&loaded.notes, "material"), 0, "{:?}", loaded.notes);
}

#[test]
fn vertex_colors_out_of_range_are_reported_and_used() {
    let folder = folder();
    let mesh = "v 0 0 0 255 0 0\nv 1 0 0 255 255 255\nv 1 0 -1 0 0 0\nv 0 0 -1 0 0 0\nf 1 2 3 4\n";
    fs::write(folder.path().join("head.obj"), mesh).unwrap();
    let text = format!("[body]\nfile = \"head.obj\"\nscale = 1.0\n{GROOM}");
    let loaded = read(folder.path(), &text).unwrap();
    assert_eq!(notes(&loaded.notes, "head.obj: colors of up to 255"), 1, "{:?}", loaded.notes);
    assert_eq!(loaded.value.body.unwrap().mesh.colors[0], Vec3::X);
}

#[test]
fn meshes_without_a_unit_have_that_of_the_body_if_they_are_within_its_reach() {
    let folder = folder();
    // A body of 1.8 m in centimeters, an eye of 6 cm, and a collision mesh of another program in meters.
    let scaled = |low: [f32; 3], size: f32| {
        cube(false, Vec3::ZERO)
            .lines()
            .map(|line| match line.strip_prefix("v ") {
                Some(numbers) => {
                    let p: Vec<f32> = numbers.split(' ').map(|x| x.parse().unwrap()).collect();
                    let [x, y, z] = [0, 1, 2].map(|k| low[k] + p[k] / 0.2 * size);
                    format!("v {x} {y} {z}\n")
                }
                None => format!("{line}\n"),
            })
            .collect::<String>()
    };
    let write = |name: &str, text: String| fs::write(folder.path().join(name), text).unwrap();
    write("body.obj", scaled([-90.0, 0.0, -90.0], 180.0));
    write("eye.obj", scaled([0.0, 160.0, 8.0], 6.0));
    write("meters.obj", scaled([-0.9, 0.0, -0.9], 1.8));
    let hull = "[[collider]]\nshape = { hull = { file = \"eye.obj\" } }\n";
    let text = format!(
        "[body]\nfile = \"body.obj\"\n[[body.more]]\nfile = \"eye.obj\"\n[collision]\nfile = \"eye.obj\"\n[[sheet]]\nfile = \"eye.obj\"\n{hull}{GROOM}"
    );
    let read = |text: &str| {
        let loaded = read(folder.path(), text).unwrap();
        (loaded.value, loaded.notes)
    };
    let (scene, reported) = read(&text);
    let size = |points: &[Vec3]| {
        let heights = || points.iter().map(|p| p.y);
        (heights().fold(f32::INFINITY, f32::min), heights().fold(f32::NEG_INFINITY, f32::max))
    };
    let eye = |points: &[Vec3]| {
        let (low, high) = size(points);
        assert!((low - 1.6).abs() < 1e-4 && (high - 1.66).abs() < 1e-4, "{low} to {high}: {reported:?}");
    };
    eye(&scene.body.as_ref().unwrap().mesh.positions[8..]);
    eye(&scene.collision.as_ref().unwrap().mesh.positions);
    eye(&scene.sheets[0].body.mesh.positions);
    let hairspring_scene::Shape::Hull { points, .. } = &scene.colliders[0].shape else { panic!() };
    eye(points);
    assert_eq!(notes(&reported, "eye.obj: the file has no unit; read in that of the body, centimeters"), 1);
    assert_eq!(notes(&reported, "body.obj: the file has no unit; guessed centimeters"), 1);
    // A mesh that fits the body in its own unit keeps it.
    let (scene, reported) =
        read(&format!("[body]\nfile = \"body.obj\"\n[collision]\nfile = \"meters.obj\"\n{GROOM}"));
    let (low, high) = size(&scene.collision.unwrap().mesh.positions);
    assert!(low.abs() < 1e-4 && (high - 1.8).abs() < 1e-4, "{low} to {high}: {reported:?}");
}

#[test]
fn a_collision_mesh_that_hair_does_not_meet_is_reported() {
    let folder = folder();
    let scene = |mesh: String, rest: &str| {
        fs::write(folder.path().join("box.obj"), mesh).unwrap();
        let text = format!(
            "[body]\nfile = \"head.obj\"\nscale = 1.0\n[collision]\nfile = \"box.obj\"\n{rest}\n{GROOM}"
        );
        read(folder.path(), &text).unwrap().notes
    };
    let of_collision = "box.obj: the [collision] mesh";
    let near = cube(false, Vec3::new(0.1, -0.2, -0.1));
    let found = scene(near.clone(), "scale = 1.0");
    assert_eq!(notes(&found, of_collision), 0, "{found:?}");
    // 9.8 m to the left of the first root.
    let found = scene(cube(false, Vec3::X * -10.0), "scale = 1.0");
    assert_eq!(notes(&found, &format!("{of_collision} is 9.80 m from the nearest root")), 1, "{found:?}");
    let found = scene(near.clone(), "scale = 0.1");
    assert_eq!(
        notes(&found, &format!("{of_collision} is 0.020 m large, and the [body] 1.000 m")),
        1,
        "{found:?}"
    );
    let lid = near.lines().filter(|line| *line != "f 5 6 8 7").collect::<Vec<_>>().join("\n");
    let found = scene(lid, "scale = 1.0");
    assert_eq!(notes(&found, &format!("{of_collision} is not closed (4 edges")), 1, "{found:?}");
}

#[test]
fn a_mesh_whose_vertices_are_all_at_one_place_is_refused() {
    let folder = folder();
    fs::write(folder.path().join("point.obj"), "v 1 2 3\n".repeat(4) + "f 1 2 3\nf 1 3 4\n").unwrap();
    for rest in [
        "[body]\nfile = \"point.obj\"\nscale = 1.0",
        "[body]\nfile = \"head.obj\"\nscale = 1.0\n[collision]\nfile = \"point.obj\"\nscale = 1.0",
    ] {
        let error = read(folder.path(), &format!("{rest}\n{GROOM}")).unwrap_err().to_string();
        let expected =
            "point.obj: all vertices of its triangles are at one place, so it has no size; export it again";
        assert!(error.ends_with(expected), "{error}");
    }
}

#[test]
fn a_camera_that_is_only_partly_placed_is_reported() {
    let folder = folder();
    fs::write(folder.path().join("box.obj"), cube(false, Vec3::ZERO)).unwrap();
    let body = format!("[body]\nfile = \"box.obj\"\nscale = 1.0\n{GROOM}");
    let both = "position = [0.0, 0.0, 2.0]\ntarget = [0.0, 0.0, 0.0]\n";
    for (scene, camera, missing) in [
        (body.as_str(), "fov = 20.0\n", Some("position")),
        (&body, "position = [0.0, 0.0, 2.0]\n", Some("target")),
        (&body, both, None),
        ("[builtin]\nstrands = 5\n", "fov = 20.0\n", None),
    ] {
        let loaded = read(folder.path(), &format!("{scene}[camera]\n{camera}")).unwrap();
        let said = missing.map_or(0, |key| notes(&loaded.notes, &format!("[camera] has no `{key}`")));
        assert_eq!(said, usize::from(missing.is_some()), "{camera}: {:?}", loaded.notes);
        assert_eq!(notes(&loaded.notes, "[camera] has no"), said);
    }
}
