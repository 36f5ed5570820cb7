//! Promise: the curves of a PLY file are strands, in text and in both byte orders, defined by edges, by lists of
//! vertices or by an id for each vertex. A file without curves is refused with a one-sentence error.

use crate::samples::{PLY_IDS, PLY_LISTS, ply_edges};
use glam::Vec3;
use hairspring::groom::DEFAULT_RADIUS;
use hairspring_io::{Format, ReadOptions, ply, read_groom};
use std::fs;

/// The text of a PLY file with vertices at x = 0, 1, 2, …, and the element `edge`.
fn with_edges(vertices: usize, edges: &[[u32; 2]]) -> String {
    let points: String = (0..vertices).map(|x| format!("{x} 0 0\n")).collect();
    let rows: String = edges.iter().map(|[a, b]| format!("{a} {b}\n")).collect();
    format!(
        "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         element edge {}\nproperty int vertex1\nproperty int vertex2\nend_header\n{points}{rows}",
        edges.len()
    )
}

fn error(file: &str) -> String {
    ply::parse(file.as_bytes()).unwrap_err().to_string()
}

#[test]
fn every_encoding_gives_the_same_strands() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let groom = ply::parse(&ply_edges(encoding)).unwrap();
        // The root is the end that comes first in the file, in whatever direction the edges go.
        let points = [(0.25, 0.0), (0.25, 0.1), (0.5, 0.2), (-1.0, 0.0), (-1.0, 0.5)];
        assert_eq!(groom.points, points.map(|(x, y)| Vec3::new(x, y, -3.0)), "{encoding}");
        assert_eq!(groom.offsets, [0, 3, 5], "{encoding}");
        assert_eq!(groom.radii, [0.00004; 5], "{encoding}");
        // Bytes are sRGB: 102 of the second point is 0.133 in linear RGB.
        assert_eq!((groom.colors[0], groom.colors[4].y), (Vec3::Z, 0.603_827_4), "{encoding}");
        assert!((groom.colors[1].y - 0.132_868).abs() < 1e-5, "{encoding}: {:?}", groom.colors);
    }
}

#[test]
fn lists_and_numbers_of_points_name_strands() {
    let lists = ply::parse(PLY_LISTS.as_bytes()).unwrap();
    assert_eq!(lists.points.iter().map(|p| p.x).collect::<Vec<_>>(), [2.0, 0.0, 1.0, 2.0, 3.0]);
    assert_eq!(lists.offsets, [0, 2, 5]);
    // A width is twice the radius.
    assert_eq!(lists.radii, [0.00005, 0.00005, 0.0001, 0.00005, 0.00005]);

    let ids = ply::parse(PLY_IDS.as_bytes()).unwrap();
    assert_eq!(ids.offsets, [0, 3, 5]);
    for name in ["strand", "hair_id"] {
        assert_eq!(ply::parse(PLY_IDS.replace("strand_id", name).as_bytes()).unwrap().offsets, [0, 3, 5]);
    }
    let polyline = PLY_LISTS.replace("element strand", "element polyline").replace("indices", "index");
    assert_eq!(ply::parse(polyline.as_bytes()).unwrap(), lists);
}

#[test]
fn numbers_may_end_or_begin_with_their_point() {
    let file = |points: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
             property int strand\nend_header\n{points}"
        )
    };
    let groom = ply::parse(file("1. -.5 2.e-1 0\n-3. .25 0.5 0\n").as_bytes()).unwrap();
    assert_eq!(groom.points, [Vec3::new(1.0, -0.5, 0.2), Vec3::new(-3.0, 0.25, 0.5)]);
    for wrong in [". 0 0 0\n0 1 0 0\n", "1..5 0 0 0\n0 1 0 0\n"] {
        assert!(error(&file(wrong)).contains("line 9"), "{wrong:?} is read");
    }
}

#[test]
fn a_file_is_read_with_notes_about_skipped_data() {
    let folder = tempfile::tempdir().unwrap();
    let options = ReadOptions { scale: Some(1.0), up: None };
    let read = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        read_groom(&path, &options).unwrap()
    };
    let loaded = read("a.PLY", &ply_edges("binary_little_endian"));
    assert_eq!((loaded.format, loaded.value.strand_count()), (Format::Ply, 2));
    assert!(loaded.value.radii.iter().all(|r| *r == 0.00004), "{:?}", loaded.value.radii);
    assert_eq!(
        loaded.notes,
        [
            "1 faces are left out, because a groom is read from curves",
            "repaired 1 strands of fewer than 3 points"
        ]
    );
    let notes = read("b.ply", with_edges(6, &[[0, 1], [1, 2], [4, 5]]).as_bytes()).notes;
    assert_eq!(notes[0], "1 vertices belong to no strand and are left out; export curves only");
    let notes = read("c.ply", PLY_IDS.as_bytes()).notes;
    assert_eq!(notes[0], "the properties curl of the vertices are not used");
}

#[test]
fn headers_of_other_programs_are_read() {
    let plain = with_edges(3, &[[0, 1], [1, 2]]);
    let expected = ply::parse(plain.as_bytes()).unwrap();
    let (header, rows) = plain.split_once("end_header\n").unwrap();
    let other = [
        plain.replace('\n', "\r\n").into_bytes(),
        // A comment in an old encoding, and lines of the classic Mac OS before binary data.
        [&b"ply\ncomment Fran\xe7ois\n"[..], &plain.as_bytes()[4..]].concat(),
        [format!("{header}end_header\n").replace("int ", "float ").as_bytes(), rows.as_bytes()].concat(),
        plain.replace("float ", "float64 ").replace("int ", "uint8 ").into_bytes(),
    ];
    for (k, file) in other.iter().enumerate() {
        assert_eq!(ply::parse(file).unwrap(), expected, "{k}");
    }
    let mut mac = header.replace("ascii", "binary_big_endian").replace("int", "uchar");
    mac = mac.replace("float", "char").replace('\n', "\r") + "end_header\r";
    let file = [mac.as_bytes(), &[0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 1, 2]].concat();
    assert_eq!(ply::parse(&file).unwrap(), expected);
}

#[test]
fn files_without_valid_curves_are_refused_in_one_sentence() {
    assert!(error(&with_edges(4, &[[0, 1], [1, 2], [1, 3]])).contains("vertex 1 has more than two edges"));
    assert!(error(&with_edges(3, &[[0, 1], [1, 2], [2, 0]])).contains("form a loop"));
    assert!(error(&with_edges(2, &[[0, 2]])).contains("names vertex 2, but the file has 2 vertices"));
    assert!(error(&PLY_LISTS.replace("3 1 2 3", "3 1 2 4")).contains("strand 2 names vertex 4"));
    assert!(
        error(&PLY_LISTS.replace("3 1 2 3", "3 1 2 -3"))
            .starts_with("line 17: expected a row of the element `strand`")
    );
    assert!(error(&with_edges(2, &[[0, 1]]).replace("0 1\n", "0 0.5\n")).contains("line 13: expected a row"));
    let mesh = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let text = error(mesh);
    assert!(text.starts_with("the file has 1 faces but no strands: expected an element `edge`"), "{text}");
    assert!(
        error(&mesh.replace("face 1", "face 0").replace("\n3 0 1 2", "")).contains("the file has points but")
    );
    assert!(
        error(&mesh.replace("float z", "float depth"))
            .contains("no element `vertex` with the properties x, y")
    );
}

#[test]
fn errors_name_the_line_or_the_byte() {
    let file = with_edges(3, &[[0, 1], [1, 2]]);
    assert!(error("solid\n").starts_with("byte 0: a .ply file begins with"));
    assert!(error("ply\nformat ascii 1.0\n").starts_with("line 3: the header has no line `end_header`"));
    assert!(
        error(&file.replace("property float y", "property vec3 y"))
            .starts_with("line 5: expected a line of a PLY header")
    );
    assert!(error(&file.replace("format ascii 1.0\n", "")).contains("no line `format ascii 1.0`"));
    assert!(
        error(&file.replace("1 0 0\n", "1 b 0\n"))
            .starts_with("line 12: expected a row of the element `vertex` with numbers for x, y, z")
    );
    assert!(
        error(&file.replace("edge 2", "edge 3"))
            .contains("ends before the last of the 3 rows of the element `edge`")
    );
    assert!(error(&file.replace("edge 2", "edge 1")).contains("4 bytes are left after the rows"));
    let binary = ply_edges("binary_little_endian");
    let text = ply::parse(&binary[..binary.len() - 1]).unwrap_err().to_string();
    assert!(text.starts_with(&format!("byte {}", binary.len() - 1)) && text.contains("cut short"), "{text}");
}

#[test]
fn large_counts_and_lines_of_a_header_use_no_memory() {
    let header = |element: &str| {
        format!(
            "ply\nformat binary_little_endian 1.0\n{element}\nelement vertex 18446744073709551615\nproperty char x\n\
             property char y\nproperty char z\nproperty char strand\nend_header\n"
        )
    };
    assert!(error(&header("comment")).contains("cut short"));
    assert!(error(&header("element none 18446744073709551615")).contains("but no properties"));
    let long = "element a".to_owned() + &"b".repeat(60_000) + " 0";
    assert!(error(&header(&long)).contains("cut short"));
    let comments = "comment\n".repeat(1 << 20);
    assert!(error(&header(&comments)).contains("within the limit of 65536 bytes"));
}

#[test]
fn radii_that_are_not_above_0_are_repaired_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ply");
    let read = |radii: [&str; 3]| {
        let points: String = radii.iter().enumerate().map(|(x, r)| format!("0.{x} 0 0 {r}\n")).collect();
        let file = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property float radius\nelement edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n\
             {points}0 1\n1 2\n"
        );
        fs::write(&path, file).unwrap();
        let loaded = read_groom(&path, &ReadOptions { scale: Some(1.0), up: None }).unwrap();
        (loaded.value.radii, loaded.repairs.bad_radii, loaded.notes)
    };
    assert_eq!(read(["-0.1", "-0.1", "-0.1"]).1, 3);
    assert_eq!(
        read(["0", "0", "0"]),
        (vec![DEFAULT_RADIUS; 3], 3, vec!["repaired 3 radii that were not above 0".into()])
    );
    let (radii, repaired, notes) = read(["-0.1", "-0.1", "0.00005"]);
    assert_eq!((radii, repaired), (vec![0.00005; 3], 2));
    assert_eq!(notes, ["repaired 2 radii that were not above 0"]);
}
