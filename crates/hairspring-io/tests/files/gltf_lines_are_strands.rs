//! Promise: the lines of a glTF file are strands where a groom is read: segments, strips and loops, placed by their
//! nodes, with colors, radii and groups. A file without lines is refused, and the error states that lines are expected.

use crate::{
    gltf_file::GltfFile,
    samples::{glb, glb_strands},
};
use glam::{Vec2, Vec3};
use hairspring_io::{Format, ReadOptions, gltf, holds_only_curves, read_body, read_groom, read_scene};
use serde_json::{Value, json};
use std::fs;

/// A file of one node with the primitives that `primitives` makes of an accessor of points at x = 0, 0.1, 0.2, ….
fn lines(points: u8, primitives: impl FnOnce(&mut GltfFile, usize) -> Value) -> GltfFile {
    let mut file = GltfFile::default();
    let positions: Vec<f32> = (0..points).flat_map(|k| [0.1 * f32::from(k), 0.0, 0.0]).collect();
    let positions = file.floats("VEC3", &positions);
    let primitives = primitives(&mut file, positions);
    file.push("meshes", json!({"primitives": primitives}));
    file.json["nodes"] = json!([{"mesh": 0}]);
    file.json["scenes"][0]["nodes"] = json!([0]);
    file
}

fn error(file: &GltfFile) -> String {
    gltf::parse_groom(&file.glb(), &|_| None).unwrap_err().to_string()
}

/// Reads a groom from a file with these bytes, and the notes that are not about repairs of its strands.
fn read(name: &str, bytes: &[u8]) -> (hairspring::groom::Groom, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    let loaded = read_groom(&path, &ReadOptions::default()).unwrap();
    assert_eq!((loaded.format, loaded.scale), (Format::Gltf, 1.0));
    let of_strands =
        |note: &str| note.starts_with("repaired ") || note.contains(" joints bend by more than 150°");
    (loaded.value, loaded.notes.into_iter().filter(|note| !of_strands(note)).collect())
}

#[test]
fn segments_strips_and_loops_are_strands_in_the_place_of_their_nodes() {
    let groom = gltf::parse_groom(&glb_strands(), &|_| None).unwrap();
    // Segments 1-0, 2-1 and 3-4 are joined; then a strip and a loop of all five points.
    assert_eq!(groom.offsets, [0, 3, 5, 10, 15]);
    let point = |x: f32, y: f32| Vec3::new(x, y, 0.0);
    assert_eq!(groom.strand(0), [point(0.0, 0.0), point(0.0, 0.2), point(0.0, 0.4)]);
    assert_eq!(groom.strand(1), [point(0.2, 0.0), point(0.2, 0.2)]);
    // The child node is moved by 1 in its parent, which doubles everything.
    assert_eq!(groom.strand(2)[..2], [point(0.0, 2.0), point(0.0, 2.2)]);
    assert_eq!(groom.strand(3), groom.strand(2));
    assert_eq!(groom.colors, [Vec3::X; 15]);
    assert_eq!(groom.radii, [0.00008; 15]);
    assert_eq!(
        (&groom.groups[..], &groom.group_names[..]),
        (&[0, 0, 1, 1][..], &["fringe".into(), "braid".into()][..])
    );
    let (_, notes) = read("a.glb", &glb_strands());
    assert_eq!(notes, ["1 closed lines (LINE_LOOP) are opened at their first point, which is the root"]);
}

#[test]
fn segments_with_points_of_their_own_are_joined() {
    let mut file = GltfFile::default();
    let ends = [0.0, 0.1, 0.1, 0.2, 0.2, 0.3, 0.7, 0.8].map(|x| [x, 0.0, 0.0]).concat();
    let positions = file.floats("VEC3", &ends);
    file.push("meshes", json!({"primitives": [{"mode": 1, "attributes": {"POSITION": positions}}]}));
    file.json["nodes"] = json!([{"mesh": 0}]);
    let groom = gltf::parse_groom(&file.glb(), &|_| None).unwrap();
    assert_eq!(groom.offsets, [0, 4, 6]);
    assert_eq!(groom.points.iter().map(|p| p.x).collect::<Vec<_>>(), [0.0, 0.1, 0.2, 0.3, 0.7, 0.8]);
    assert_eq!(groom.group_names, ["node0"]);
}

#[test]
fn a_width_is_twice_the_radius_and_a_color_has_three_channels_or_four() {
    let file = lines(3, |file, positions| {
        let widths = file.floats("SCALAR", &[0.0001, 0.0001, 0.00008]);
        let colors = file.floats("VEC3", &[0.5, 0.25, 2.0, 0.5, 0.25, 0.0, 0.5, 0.25, 0.0]);
        json!([{"mode": 3, "attributes": {"POSITION": positions, "COLOR_0": colors, "_WIDTH": widths}}])
    });
    let (groom, notes) = read("a.glb", &file.glb());
    assert_eq!(groom.radii, [0.00005, 0.00005, 0.00004]);
    assert_eq!(
        groom.colors,
        [Vec3::new(0.5, 0.25, 1.0), Vec3::new(0.5, 0.25, 0.0), Vec3::new(0.5, 0.25, 0.0)]
    );
    assert_eq!(notes, ["1 colors outside of 0 to 1 are clipped"]);
}

#[test]
fn many_strands_may_share_the_arrays_of_points() {
    // Each strand is a primitive with two indices of its own in the same 60,000 points.
    let mut file = GltfFile::default();
    let positions: Vec<f32> = (0..60_000u32).flat_map(|k| [0.001 * k as f32, 0.0, 0.0]).collect();
    let positions = file.floats("VEC3", &positions);
    let primitives: Vec<Value> = (0..2_000u16)
        .map(|k| {
            let indices =
                file.bytes(5123, "SCALAR", 2, &[(2 * k).to_le_bytes(), (2 * k + 1).to_le_bytes()].concat());
            json!({"mode": 1, "attributes": {"POSITION": positions}, "indices": indices})
        })
        .collect();
    file.push("meshes", json!({"primitives": primitives}));
    file.json["nodes"] = json!([{"mesh": 0}]);
    let groom = gltf::parse_groom(&file.glb(), &|_| None).unwrap();
    assert_eq!((groom.strand_count(), groom.point_count()), (2_000, 4_000));
}

#[test]
fn skipped_data_is_noted() {
    let file = lines(3, |file, positions| {
        let radii = file.floats("SCALAR", &[0.00005; 3]);
        json!([
            {"mode": 3, "attributes": {"POSITION": positions, "COLOR_0": positions, "_RADIUS": radii}},
            {"mode": 3, "attributes": {"POSITION": positions}, "targets": [{"POSITION": positions}]},
            {"mode": 4, "attributes": {"POSITION": positions}},
        ])
    });
    let mut file = file;
    file.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {}});
    file.json["nodes"][0]["skin"] = json!(0);
    let (groom, notes) = read("a.glb", &file.glb());
    assert_eq!(groom.strand_count(), 2);
    assert!(groom.colors.is_empty());
    for text in [
        "1 primitives of triangles or points",
        "2 primitives of lines have a skin",
        "no COLOR_0",
        "no _RADIUS",
        "1 nodes draw copies of a mesh with a skin",
    ] {
        assert_eq!(notes.iter().filter(|note| note.contains(text)).count(), 1, "{text}: {notes:?}");
    }
}

#[test]
fn half_a_segment_is_noted() {
    let file = lines(3, |file, positions| {
        let indices = file.bytes(5121, "SCALAR", 5, &[0, 1, 1, 2, 2]);
        json!([{"mode": 1, "attributes": {"POSITION": positions}, "indices": indices}])
    });
    let (groom, notes) = read("a.glb", &file.glb());
    assert_eq!((groom.strand_count(), groom.point_count()), (1, 3));
    assert!(
        notes.len() == 1 && notes[0].starts_with("1 primitives of lines end with half a segment"),
        "{notes:?}"
    );
}

#[test]
fn more_objects_than_groups_are_one_group() {
    let mut file = lines(2, |_, positions| json!([{"mode": 3, "attributes": {"POSITION": positions}}]));
    file.json["scenes"] = json!([]);
    file.json.as_object_mut().unwrap().remove("scene");
    let nodes = |count: usize| json!((0..count).map(|_| json!({"mesh": 0})).collect::<Vec<_>>());
    file.json["nodes"] = nodes(65_536);
    let (groom, notes) = read("a.glb", &file.glb());
    assert!(groom.groups.last() == Some(&u16::MAX) && notes.is_empty(), "{notes:?}");
    file.json["nodes"] = nodes(65_537);
    let (groom, notes) = read("b.glb", &file.glb());
    assert!(groom.groups.is_empty() && groom.group_names.is_empty() && groom.strand_count() == 65_537);
    assert!(notes[0].contains("65537 objects are more than the limit of 65,536 groups"), "{notes:?}");
}

#[test]
fn a_file_without_strands_is_refused_with_the_expected_content() {
    let text = gltf::parse_groom(&glb(), &|_| None).unwrap_err().to_string();
    assert!(
        text.starts_with(
            "the file has 2 primitives of triangles or points but no lines: a groom is read from"
        ),
        "{text}"
    );
    assert!(
        error(&GltfFile::default()).starts_with("the file has no lines: a groom is read from primitives")
    );
    let segments = |pairs: &'static [u8]| {
        lines(4, |file, positions| {
            let indices = file.bytes(5121, "SCALAR", pairs.len(), pairs);
            json!([{"mode": 1, "attributes": {"POSITION": positions}, "indices": indices}])
        })
    };
    assert!(error(&segments(&[0, 1, 1, 2, 1, 3])).contains("vertex 1 has more than two edges"));
    assert!(error(&segments(&[0, 1, 1, 2, 2, 0])).contains("form a loop"));
    assert!(error(&segments(&[0, 4])).contains("a line names vertex 4 of an object of 4"));
    let uneven = lines(3, |file, positions| {
        let radii = file.floats("SCALAR", &[0.1; 2]);
        json!([{"mode": 3, "attributes": {"POSITION": positions, "_RADIUS": radii}}])
    });
    assert!(error(&uneven).contains("lines have 3 positions but 2 radii"));
}

#[test]
fn a_scene_reads_the_lines_of_a_gltf_file() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("hair.glb"), glb_strands()).unwrap();
    let scene = folder.path().join("a.toml");
    fs::write(&scene, "[[groom]]\nfile = \"hair.glb\"\n").unwrap();
    let groom = &read_scene(&scene).unwrap().value.grooms[0].groom;
    assert_eq!(
        (groom.strand_count(), &groom.group_names[..]),
        (4, &["fringe".to_owned(), "braid".into()][..])
    );
}

#[test]
fn a_file_with_curves_only_is_recognized() {
    let folder = tempfile::tempdir().unwrap();
    let holds = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        holds_only_curves(&path)
    };
    let of = |primitives: Value| {
        lines(3, |_, positions| {
            let mut primitives = primitives;
            for primitive in primitives.as_array_mut().unwrap() {
                primitive["attributes"] = json!({"POSITION": positions});
            }
            primitives
        })
    };
    assert!(holds("lines.glb", &of(json!([{"mode": 1}, {"mode": 3}])).glb()));
    assert!(!holds("mixed.glb", &of(json!([{"mode": 3}, {"mode": 4}])).glb()));
    assert!(!holds("mesh.glb", &of(json!([{}])).glb()), "triangles are the default");
    assert!(!holds("empty.glb", &GltfFile::default().glb()));
    assert!(!holds("broken.glb", b"glTF"));
    assert!(holds("lines.obj", b"v 0 0 0\nv 0 1 0\nl 1 2\n"));
    assert!(!holds("mesh.obj", b"v 0 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 3\nl 1 2\n"));
    assert!(!holds("hair.csv", b"0,0,0,0\n0,0,1,0\n"), "the format has no meshes");
    assert!(!holds_only_curves(&folder.path().join("missing.glb")));
}

#[test]
fn texture_coordinates_of_the_first_point_are_those_of_the_root() {
    let file = |all: bool| {
        lines(2, |file, positions| {
            let uvs = file.floats("VEC2", &[0.25, 0.125, 0.5, 0.5]);
            let mapped = json!({"mode": 3, "attributes": {"POSITION": positions, "TEXCOORD_0": uvs}});
            let other = json!({"mode": 3, "attributes": {"POSITION": positions}});
            json!([mapped, if all { &mapped } else { &other }])
        })
    };
    let (groom, notes) = read("a.glb", &file(true).glb());
    assert_eq!((groom.root_uvs, notes), (vec![Vec2::new(0.25, 0.875); 2], vec![]));
    let (groom, notes) = read("a.glb", &file(false).glb());
    assert_eq!(groom.root_uvs, [Vec2::new(0.25, 0.875), Vec2::ZERO]);
    assert!(notes.len() == 1 && notes[0].starts_with("1 strands have no TEXCOORD_0"), "{notes:?}");
}

#[test]
fn what_is_wrong_with_lines_is_said_where_a_body_is_read_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.glb");
    let body_error = |file: &GltfFile| {
        fs::write(&path, file.glb()).unwrap();
        read_body(&path, &ReadOptions::default()).unwrap_err().to_string()
    };
    let strip = |index: u8| {
        lines(2, |file, positions| {
            let indices = file.bytes(5121, "SCALAR", 2, &[0, index]);
            json!([{"mode": 3, "attributes": {"POSITION": positions}, "indices": indices}])
        })
    };
    assert!(body_error(&strip(1)).contains("lines but no triangles, so it is no body; name it as a groom"));
    assert!(body_error(&strip(7)).contains("a line names vertex 7 of an object of 2"));
    let wrong = lines(
        2,
        |_, positions| json!([{"mode": 3, "attributes": {"POSITION": positions, "_RADIUS": positions}}]),
    );
    assert!(body_error(&wrong).contains("the radii (accessor 0) should have 1 components each"));
}
