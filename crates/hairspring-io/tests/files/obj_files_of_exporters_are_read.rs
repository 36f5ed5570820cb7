//! Promise: an OBJ file is read as exporters write it, in any encoding with a byte order mark and with any line end.
//! Polygons that are not convex get triangles inside them, and polylines are strands. A file without faces is no body.

use glam::Vec3;
use hairspring::{body::Mesh, groom::Groom};
use hairspring_io::{ErrorKind, ReadOptions, obj, read_body, read_groom};
use std::fs;

const SQUARE: &str =
    "# a square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.25\nvt 0.5 0.75\ng side # 1\nf 1/1 2/2 3/2 4/1\n";

fn parse(text: &str) -> Mesh {
    obj::parse(text.as_bytes()).unwrap_or_else(|e| panic!("{e}"))
}

fn assert_square(mesh: &Mesh) {
    let square = parse(SQUARE);
    assert_eq!((mesh.positions.len(), &mesh.triangles), (4, &vec![[0, 1, 2], [0, 2, 3]]));
    assert_eq!((&mesh.positions, &mesh.uvs), (&square.positions, &square.uvs));
}

#[test]
fn every_encoding_with_a_mark_and_every_line_end_is_read() {
    assert_eq!(parse(SQUARE).uvs[0], glam::Vec2::new(0.25, 0.0));
    for end in ["\n", "\r\n", "\r"] {
        let text = SQUARE.replace('\n', end);
        assert_square(&parse(&text));
        assert_square(&parse(&format!("\u{feff}{text}")));
        let utf16 = |order: fn(u16) -> [u8; 2]| {
            format!("\u{feff}{text}").encode_utf16().flat_map(order).collect::<Vec<u8>>()
        };
        assert_square(&obj::parse(&utf16(u16::to_le_bytes)).unwrap());
        assert_square(&obj::parse(&utf16(u16::to_be_bytes)).unwrap());
        // Errors name the line.
        let error = obj::parse(text.replace("0.5", "half").as_bytes()).unwrap_err().to_string();
        assert!(
            error.starts_with("line 7: expected a texture coordinate of 1 number, found `half`"),
            "{error}"
        );
    }
}

#[test]
fn continued_lines_and_comments_are_read() {
    let text = "# C:\\models\\\nmtllib C:\\models\\\nv 0 0 0\nv 1 \\\n 0 0 # one\nv 1 1 \\ \n\\\n0\nv 0 1 0\nvt 0.25\nvt 0.5 0.75 0\n\
                f 1/1 2/2 \\\n 3/2 4/1 # a face\n";
    assert_square(&parse(text));
    assert_square(&parse(&text.replace('\n', "\r\n")));
    // A backslash at the end of the file.
    let mut mesh = parse(&format!("{SQUARE}v 1 2 3 \\"));
    assert_eq!(
        (mesh.positions.pop(), mesh.uvs.pop()),
        (Some(Vec3::new(1.0, 2.0, 3.0)), Some(glam::Vec2::ZERO))
    );
    assert_square(&mesh);
}

/// The triangles of a polygon in the plane z = 0, which must have its area and keep its direction.
fn assert_triangulated(corners: &[(f32, f32)]) {
    let mut text: String = corners.iter().map(|(x, y)| format!("v {x} {y} 0\n")).collect();
    text += "f";
    (1..=corners.len()).for_each(|i| text += &format!(" {i}"));
    let mesh = parse(&text);
    assert_eq!(mesh.triangles.len(), corners.len() - 2);
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        0.5 * (b - a).cross(c - a).z
    };
    let around = corners.iter().zip(corners.iter().cycle().skip(1));
    let want: f32 = 0.5 * around.map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum::<f32>();
    let (sum, size) = mesh
        .triangles
        .iter()
        .map(area)
        .fold((0.0, 0.0), |(sum, size): (f32, f32), a| (sum + a, size + a.abs()));
    // Triangles outside the polygon would overlap others or have the opposite direction.
    assert!((sum - want).abs() < 1e-4 * want.abs(), "{sum} is not {want}");
    assert!((size - want.abs()).abs() < 1e-4 * want.abs(), "{corners:?}: triangles overlap");
}

#[test]
fn polygons_that_are_not_convex_are_triangulated_inside() {
    let arrow = [(0.0, 0.0), (1.0, -1.0), (0.2, 0.0), (1.0, 1.0)];
    let l = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    let comb: Vec<(f32, f32)> = (0..40)
        .map(|i| (i as f32, if i % 2 == 0 { 1.0 } else { 9.0 }))
        .chain([(39.0, 0.0), (0.0, 0.0)])
        .collect();
    let star: Vec<(f32, f32)> = (0..30)
        .map(|i| (i as f32 * std::f32::consts::TAU / 30.0).sin_cos())
        .enumerate()
        .map(|(i, (sin, cos))| if i % 2 == 0 { (cos, sin) } else { (0.3 * cos, 0.3 * sin) })
        .collect();
    for polygon in [&arrow[..], &l, &comb, &star] {
        for first in 0..polygon.len() {
            let mut turned = polygon.to_vec();
            turned.rotate_left(first);
            assert_triangulated(&turned);
            turned.reverse();
            assert_triangulated(&turned);
        }
    }
    // The normal of a quad that is not convex is that of its surface.
    let mesh = parse("v 0 0 0\nv 1 -1 0\nv 0.2 0 0\nv 1 1 0\nf 2 3 4 1\n");
    assert!(mesh.normals.iter().all(|n| *n == Vec3::NEG_Z || *n == Vec3::Z));
}

#[test]
fn a_polygon_of_many_corners_takes_linear_time_and_is_noted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("comb.obj");
    let corners = 200_000;
    let mut text: String = (0..corners)
        .map(|i| format!("v {} {} 0\n", 1e-5 * i as f32, if i % 2 == 0 { 0.1 } else { 0.9 }))
        .collect();
    text += &format!(
        "v 2 0 0\nv 0 0 0\nf {}\n",
        (1..=corners + 2).map(|i| i.to_string()).collect::<Vec<_>>().join(" ")
    );
    fs::write(&path, text).unwrap();
    let loaded = read_body(&path, &ReadOptions::default()).unwrap();
    assert!(
        loaded.notes.iter().any(|n| n.contains("1 polygons of many corners are not convex")),
        "{:?}",
        loaded.notes
    );
}

#[test]
fn polylines_are_strands() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curves.obj");
    let strands = "v 0 0 0\nv 0 0.1 0\nv 0 0.2 0\nv 0.1 0 0\nv 0.1 0.1 0\nvt 0.5 0.25\n";
    let options = ReadOptions { scale: Some(1.0), up: None };
    // Whole strands, and each segment as a line of its own.
    for lines in
        ["g hair\nl 1/1 2/1 3/1\nl 4 5\nl 1\n", "l 1/1 2\nl 2 3 # tip\nl 4 5\n", "l -5/1 \\\n-4 -3\rl 4 5"]
    {
        fs::write(&path, format!("{strands}{lines}")).unwrap();
        let groom = obj::parse_groom(&fs::read(&path).unwrap()).unwrap();
        assert_eq!(groom.offsets, [0, 3, 5], "{lines}");
        assert_eq!(read_groom(&path, &options).unwrap().value.strand_count(), 2);
        assert_eq!(groom.points[..3], [Vec3::ZERO, Vec3::Y * 0.1, Vec3::Y * 0.2]);
        assert_eq!(groom.root_uvs[0], glam::Vec2::new(0.5, 0.25));
        let error = read_body(&path, &options).unwrap_err().to_string();
        assert!(error.contains("polylines but no faces"), "{error}");
    }
    fs::write(&path, format!("{strands}l 1 2 3\nf 1 2 4\n")).unwrap();
    assert!(read_groom(&path, &options).unwrap().notes.iter().any(|n| n.contains("1 faces are left out")));
    assert!(
        read_body(&path, &options).unwrap().notes.iter().any(|n| n.contains("1 polylines are no surface"))
    );
    fs::write(&path, SQUARE).unwrap();
    assert!(read_groom(&path, &options).unwrap_err().to_string().contains("no polylines"));
    fs::write(&path, format!("{strands}l 1 9\n")).unwrap();
    assert!(
        read_groom(&path, &options)
            .unwrap_err()
            .to_string()
            .contains("line 7: the face or line names vertex 9")
    );
}

#[test]
fn segments_in_any_order_and_direction_are_joined() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curves.obj");
    let strands = "v 0 0 0\nv 0 0.1 0\nv 0 0.2 0\nv 0.1 0 0\nv 0.1 0.1 0\nv 0.1 0.2 0\nvt 0.5 0.25\n";
    for lines in ["l 2 3\nl 5 6\nl 1/1 2\nl 4 5\n", "l 2 1/1\nl 5 4\nl 3 2\nl 5 6\n"] {
        fs::write(&path, format!("{strands}{lines}")).unwrap();
        let read = read_groom(&path, &ReadOptions { scale: Some(1.0), up: None }).unwrap();
        assert_eq!(read.value.offsets, [0, 3, 6], "{lines}");
        assert_eq!(read.value.points[..3], [Vec3::ZERO, Vec3::Y * 0.1, Vec3::Y * 0.2]);
        assert_eq!(read.value.root_uvs, [glam::Vec2::new(0.5, 0.25), glam::Vec2::ZERO]);
        assert!(read.notes.iter().any(|n| n.contains("joined to 2 strands")), "{:?}", read.notes);
    }
    // Strands may share a root.
    fs::write(&path, format!("{strands}l 1 2 3\nl 1 4 5\n")).unwrap();
    assert_eq!(obj::parse_groom(&fs::read(&path).unwrap()).unwrap().offsets, [0, 3, 6]);
    // A branch is not joined.
    fs::write(&path, format!("{strands}l 1 2\nl 2 3\nl 2 5\n")).unwrap();
    assert_eq!(obj::parse_groom(&fs::read(&path).unwrap()).unwrap().strand_count(), 2);
}

#[test]
fn strands_that_share_a_root_or_branch_stay_separate() {
    let at = |points: &[usize]| -> Vec<Vec3> {
        points.iter().map(|p| Vec3::new((p - 1) as f32 / 3.0, ((p - 1) % 3) as f32, 0.0)).collect()
    };
    let vertices: String =
        (1..=6).map(|p| at(&[p])[0]).map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)).collect();
    for (lines, want) in [
        ("l 1 2\nl 1 3\n", vec![at(&[1, 2]), at(&[1, 3])]),
        ("l 2 3\nl 1 4\nl 1 2\nl 4 5\n", vec![at(&[1, 4, 5]), at(&[1, 2, 3])]),
        ("l 2 3\nl 6 2\nl 6 4\nl 4 5\n", vec![at(&[6, 2, 3]), at(&[6, 4, 5])]),
        ("l 1 3\nl 2 3\n", vec![at(&[1, 3]), at(&[2, 3])]),
    ] {
        let groom = obj::parse_groom(format!("{vertices}{lines}").as_bytes()).unwrap();
        let got: Vec<Vec<Vec3>> = (0..groom.strand_count()).map(|s| groom.strand(s).to_vec()).collect();
        assert_eq!(got, want, "{lines}");
    }
    let (branched, notes) = groom(&format!("{POINTS}l 1 2\nl 2 3\nl 2 4\n"));
    assert_eq!(branched.strand_count(), 2);
    assert!(notes[0].starts_with("strands branch at 1 vertices") && notes.len() == 1, "{notes:?}");
}

#[test]
fn numbers_of_texture_coordinates_that_are_not_defined_are_noted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.obj");
    let vertices = "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\n";
    fs::write(&path, format!("{vertices}f 1/1/1 3/2/2 2/3/3\n")).unwrap();
    let read = read_body(&path, &ReadOptions { scale: Some(1.0), up: None }).unwrap();
    assert!(read.value.body.mesh.uvs.is_empty());
    assert_eq!(read.value.body.mesh.triangles, [[0, 2, 1]]);
    let notes = read.notes.join("\n");
    assert!(notes.contains("3 corners name texture coordinates, but the file defines none"), "{notes}");
    assert!(notes.contains("2 vertices have no color, but others do"), "{notes}");
    // Where some are defined, others are wrong.
    let error = obj::parse(format!("{vertices}vt 0 0\nf 1/1 3/2 2/1\n").as_bytes()).unwrap_err().to_string();
    assert!(error.contains("texture coordinate 2, but only 1 are defined"), "{error}");
}

#[test]
fn numbered_meshes_have_the_unit_of_the_body_and_no_gaps() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    // Heights next to each other, for which different units would be guessed.
    let heights = [29.0, 29.2, 29.4, 29.6];
    let tetrahedron = |height: f32| {
        format!("v 0 0 0\nv 10 0 0\nv 0 0 10\nv 0 {height} 0\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 3 2\n")
    };
    write("body.obj", &tetrahedron(heights[0]));
    for (k, height) in heights.into_iter().enumerate() {
        write(&format!("body.{}.obj", k + 7), &tetrahedron(height));
    }
    write("hair.csv", "strand,x,y,z\n0,0,0.3,0\n0,0,0.4,0\n0,0,0.5,0\n");
    write(
        "scene.toml",
        "[body]\nfile = \"body.obj\"\nscale = 0.01\nvertex_cache = \"body.#.obj\"\n[[groom]]\nfile = \"hair.csv\"\nscale = 1\n",
    );
    let scene = folder.path().join("scene.toml");
    let guessed = fs::read_to_string(&scene).unwrap().replace("scale = 0.01\n", "");
    for text in [fs::read_to_string(&scene).unwrap(), guessed] {
        let scene = hairspring_io::read_scene_text(&scene, &text).unwrap().value;
        let unit = scene.body.unwrap().mesh.positions[3].y / heights[0];
        let frames = scene.vertex_cache.unwrap().frames;
        assert_eq!(frames.len(), heights.len());
        for (frame, height) in frames.iter().zip(heights) {
            assert!((frame[3].y - height * unit).abs() < 1e-5, "{} for {height}", frame[3].y);
        }
    }
    fs::remove_file(folder.path().join("body.9.obj")).unwrap();
    let error = hairspring_io::read_scene(&scene).unwrap_err().to_string();
    assert!(error.contains("number 9 is missing after") && error.contains("body.8.obj"), "{error}");
}

#[test]
fn a_file_without_faces_is_no_body() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("nothing.obj");
    let gzip = [&[0x1f, 0x8b, 8, 0][..], &[0x55; 5000]].concat();
    for content in
        [&b""[..], &gzip, "A".repeat(5_000_000).as_bytes(), b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", b"f\nf 1\n"]
    {
        fs::write(&path, content).unwrap();
        let error = read_body(&path, &ReadOptions::default()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Malformed);
        let parts = ["no face", "line 2", "compressed with gzip"];
        assert!(parts.iter().any(|part| error.to_string().contains(part)), "{error}");
    }
}

/// Reads a groom from this text, in meters, and the notes that are not about repairs.
fn groom(text: &str) -> (Groom, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curves.obj");
    fs::write(&path, text).unwrap();
    let loaded = read_groom(&path, &ReadOptions { scale: Some(1.0), up: None }).unwrap();
    let of_strands =
        |note: &String| note.starts_with("repaired ") || note.contains(" joints bend by more than");
    (loaded.value, loaded.notes.into_iter().filter(|note| !of_strands(note)).collect())
}

const POINTS: &str = "v 0 0 0\nv 0 0.1 0\nv 0 0.2 0\nv 0.1 0 0\nv 0.1 0.1 0\nv 0.1 0.2 0\n";

#[test]
fn names_are_groups_of_strands() {
    let names = |groom: &Groom| groom.group_names.join(", ");
    let (named, notes) =
        groom(&format!("{POINTS}o fringe\nl 1 2 3\no back\ng back of head\nl 4 5 6\no fringe\nl 3 2 1\n"));
    assert_eq!((&named.groups[..], &*names(&named), notes), (&[0, 1, 0][..], "fringe, back of head", vec![]));
    // Polylines before the first name have a group without one.
    let (some, _) = groom(&format!("{POINTS}l 1 2 3\ng back\nl 4 5 6\n"));
    assert_eq!((&some.groups[..], &*names(&some)), (&[0, 1][..], ", back"));
    let (none, _) = groom(&format!("{POINTS}l 1 2 3\nl 4 5 6\n"));
    assert!(none.groups.is_empty() && none.group_names.is_empty());
    // A name for each of many polylines is that of a strand.
    let line = |k: usize| format!("o Curve.{k:03}\nl 1 2 3\n");
    let (curves, notes) = groom(&format!("{POINTS}{}", (0..64).map(line).collect::<String>()));
    assert!(curves.strand_count() == 64 && curves.groups.is_empty());
    assert_eq!(notes, ["each polyline has its own name, so names are not used as groups"]);
    // Segments are joined within their group.
    for lines in ["g a\nl 2 3\nl 1 2\ng b\nl 5 6\nl 4 5\n", "g a\nl 1 2\nl 2 3\ng b\nl 3 4\nl 4 5\n"] {
        let (joined, _) = groom(&format!("{POINTS}{lines}"));
        assert_eq!((&joined.groups[..], &joined.offsets[..]), (&[0, 1][..], &[0, 3, 6][..]), "{lines}");
    }
}

#[test]
fn closed_polylines_and_roots_without_texture_coordinates_are_noted() {
    for lines in ["l 1 2 4 1\n", "l 1 2\nl 2 4\nl 4 1\n"] {
        let (closed, notes) = groom(&format!("{POINTS}{lines}"));
        assert_eq!((closed.strand_count(), closed.point_count()), (1, 4));
        assert_eq!(notes, ["1 closed polylines are opened at their first point, which is the root"]);
    }
    let (_, notes) = groom(&format!("{POINTS}vt 0.5 0.5\nl 1/1 2 3\nl 4 5 6\n"));
    assert_eq!(notes, ["1 strands have no texture coordinates and get 0, 0; give each root one"]);
}

#[test]
fn what_is_wrong_with_polylines_is_said_where_a_body_is_read_too() {
    let text = obj::parse(format!("{POINTS}l 1 9\n").as_bytes()).unwrap_err().to_string();
    assert!(text.starts_with("line 7: the face or line names vertex 9"), "{text}");
}

#[test]
fn decimal_commas_are_refused_with_their_remedy() {
    let text = obj::parse(b"v 0,000 1,5 0\n").unwrap_err().to_string();
    assert_eq!(text, "line 1: expected a vertex of 3 numbers, found `0,000`; use decimal points");
}
