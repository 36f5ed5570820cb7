//! Promise: a reader takes memory in proportion to its file, and a sentence says where memory runs out.
//!
//! An allocator counts what a test holds, and can refuse large blocks.

#[path = "../common/gltf_file.rs"]
mod gltf_file;

use gltf_file::GltfFile;
use hairspring_io::{Problem, ReadOptions, gltf, obj, ply, read_body, read_groom};
use serde_json::json;
use std::{
    alloc::{GlobalAlloc, Layout, System},
    fs,
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
};

struct Counting;

/// Bytes that are held, their maximum since the last reset, and the largest block that is given out.
static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
static LARGEST: AtomicUsize = AtomicUsize::new(usize::MAX);

// SAFETY: every call is forwarded unchanged to the system allocator, or refused with a null pointer.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if layout.size() > LARGEST.load(Relaxed) {
            return std::ptr::null_mut();
        }
        let held = HELD.fetch_add(layout.size(), Relaxed) + layout.size();
        PEAK.fetch_max(held, Relaxed);
        // SAFETY: the caller upholds the system allocator's requirements.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Bytes that a reader may take for a file of any size: the floors of the limits of glTF files.
const FLOOR: usize = 200 << 20;
/// Bytes that a reader may take for each byte of its file.
const FACTOR: usize = 128;

/// Reads `file`, and checks the most memory that was held at a time.
fn check(name: &str, file: &[u8], read: impl Fn(&[u8]) -> Result<(), Problem>) {
    let before = HELD.load(Relaxed);
    PEAK.store(before, Relaxed);
    let result = read(file);
    let taken = PEAK.load(Relaxed) - before;
    println!("{name}: {} bytes take {taken}: {result:?}", file.len());
    assert!(taken < FLOOR + FACTOR * file.len(), "{name}: {} bytes take {taken}", file.len());
}

/// A single test, because other tests would be counted, too.
#[test]
fn memory_is_proportional_to_the_file_and_its_end_is_a_sentence() {
    let read_gltf = |data: &[u8]| gltf::parse(data, &|_| None).map(drop);
    let document = |rest: &str| format!(r#"{{"asset":{{"version":"2.0"}},{rest}}}"#).into_bytes();
    let list = |name: &str, item: &str| {
        document(&format!(r#""{name}":[{}{item}]"#, format!("{item},").repeat(500_000)))
    };
    check("nodes", &list("nodes", "{}"), read_gltf);
    check("accessors", &list("accessors", r#"{"componentType":5126,"count":1,"type":"MAT4"}"#), read_gltf);
    check("views", &list("bufferViews", r#"{"buffer":0,"byteLength":0}"#), read_gltf);
    check("skins", &list("skins", r#"{"joints":[]}"#), read_gltf);
    check("animations", &list("animations", "{}"), read_gltf);
    check("materials", &list("materials", "{}"), read_gltf);
    check("extras", &list("extras", "{}"), read_gltf);
    for count in [900_000, 1_000_000_000, usize::MAX / 2] {
        let zeros = format!(
            r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":0}}}}]}}],"accessors":[{{"componentType":5126,"count":{count},"type":"VEC3"}}]"#
        );
        check("zeros", &document(&zeros), read_gltf);
    }
    let mut long = GltfFile::tetrahedron();
    let times = long.floats("SCALAR", &[0.0, 19_000.0]);
    let values = long.floats("VEC3", &[0.0; 6]);
    long.json["animations"] = json!([{"samplers": [{"input": times, "output": values}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}}]}]);
    check("a long animation", &long.glb(), read_gltf);

    let mut face = GltfFile::tetrahedron();
    let positions = face.floats("VEC3", &vec![0.5; 30_000]);
    face.primitive()["attributes"]["POSITION"] = json!(positions);
    face.primitive()["targets"] = json!(vec![json!({"POSITION": positions}); 700]);
    let (times, weights) = (face.floats("SCALAR", &[0.0]), face.floats("SCALAR", &[1.0; 700]));
    face.json["animations"] = json!([{"samplers": [{"input": times, "output": weights}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}]);
    check("morph targets that share an array", &face.glb(), |data| {
        let (character, _) = gltf::parse(data, &|_| None)?;
        character.morphed(0).map_err(|text| panic!("{text}")).map(drop)
    });

    let read_obj = |data: &[u8]| obj::parse(data).map(drop);
    let ones = "1 ".repeat(500_000);
    check("a polygon", format!("v 0 0 0\nf {ones}").as_bytes(), read_obj);
    check("faces", format!("v 0 0 0\n{}", "f 1 1 1\n".repeat(200_000)).as_bytes(), read_obj);
    check("groups", "g a\n".repeat(500_000).as_bytes(), read_obj);
    check("continued", "\\\n".repeat(500_000).as_bytes(), read_obj);
    check("a polyline", format!("v 0 0 0\nl {ones}").as_bytes(), |data| obj::parse_groom(data).map(drop));
    check("polylines", format!("v 0 0 0\n{}", "l 1 1\n".repeat(200_000)).as_bytes(), |data| {
        obj::parse_groom(data).map(drop)
    });
    let utf16 = [&[0xff, 0xfe][..], &[0x0a, 0x0d].repeat(500_000)].concat();
    check("UTF-16", &utf16, read_obj);

    let read_ply = |data: &[u8]| ply::parse(data).map(drop);
    let rows = |rest: &str, rows: &[u8]| {
        let header = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex 500000\nproperty char x\nproperty char y\nproperty char z\n{rest}\nend_header\n"
        );
        [header.as_bytes(), rows].concat()
    };
    let path: Vec<u8> =
        (0..500_000u32).flat_map(|k| [k.to_le_bytes(), (k + 1).to_le_bytes()].concat()).collect();
    let path = [vec![0; 1_500_000], path].concat();
    let edges = "element edge 499999\nproperty int vertex1\nproperty int vertex2";
    check("points with the number of a strand", &rows("property char strand", &[1; 2_000_000]), read_ply);
    check("edges", &rows(edges, &path[..path.len() - 8]), read_ply);
    let lists = "element strand 500000\nproperty list uchar uchar vertex_indices";
    check("lists of points", &rows(lists, &[1; 2_500_000]), read_ply);
    check(
        "a count without rows",
        &rows(
            "element strand 18446744073709551615\nproperty list uint int vertex_indices",
            &[255; 1_500_008],
        ),
        read_ply,
    );
    let words = format!(
        "ply\nformat ascii 1.0\nelement a 1\nproperty char b\nelement vertex 1\nproperty char x\nproperty char y\nproperty char z\nproperty char strand\nend_header\n{}",
        "1 ".repeat(500_000)
    );
    check("a row of many words", words.as_bytes(), read_ply);

    let read_lines = |data: &[u8]| gltf::parse_groom(data, &|_| None).map(drop);
    for mode in [1, 2, 3] {
        let zeros = format!(
            r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"mode":{mode},"attributes":{{"POSITION":0,"COLOR_0":0,"_RADIUS":1}}}}]}}],"accessors":[{{"componentType":5126,"count":900000,"type":"VEC3"}},{{"componentType":5126,"count":900000,"type":"SCALAR"}}]"#
        );
        check("lines of zeros", &document(&zeros), read_lines);
    }
    let primitive = r#"{"mode":3,"attributes":{"POSITION":0}}"#;
    let copies = format!(
        r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{}{primitive}]}}],"accessors":[{{"componentType":5126,"count":900000,"type":"VEC3"}}]"#,
        format!("{primitive},").repeat(1000)
    );
    check("lines that share points", &document(&copies), read_lines);

    // No block above a megabyte: files of more, and arrays of files of less.
    let folder = tempfile::tempdir().unwrap();
    let large = folder.path().join("large.hair");
    fs::write(&large, vec![b'1'; 2 << 20]).unwrap();
    let mut file = GltfFile::tetrahedron();
    let positions = file.floats("VEC3", &vec![0.0; 150_000]);
    file.primitive()["attributes"]["POSITION"] = json!(positions);
    let body = folder.path().join("body.glb");
    fs::write(&body, file.glb()).unwrap();
    LARGEST.store(1 << 20, Relaxed);
    let errors = [
        read_groom(&large, &ReadOptions::default()).map(drop).unwrap_err(),
        read_body(&body, &ReadOptions::default()).map(drop).unwrap_err(),
    ];
    LARGEST.store(usize::MAX, Relaxed);
    for error in errors {
        let text = error.to_string();
        assert!(text.contains("out of memory: ") && !text.contains('\n'), "{text}");
    }
}
