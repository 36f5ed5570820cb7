//! Promise: no broken file makes a reader panic, hang or allocate without bound; the reader returns a
//! one-sentence error.
//!
//! A small valid file of every format is cut at every length. Its bytes and words are changed one at a time
//! to values that break careless readers (0, the largest, the smallest). A cut file must be refused
//! wherever something is missing. A changed file may be refused or read, as long as the reader returns. The
//! fuzz targets in `/fuzz` extend this test.

use glam::Vec3;
use hairspring_io::{
    ErrorKind, Place, Problem, ReadOptions, Strands, pc2, read_body, read_groom, read_motion, read_scene,
    write_strands,
};
use proptest::prelude::*;
use rayon::prelude::*;
use std::fs;

/// A file may be read or refused; the error is one line of text.
fn check_error(name: &str, result: Result<(), Problem>) {
    if let Err(problem) = result {
        assert!(!problem.text.is_empty() && !problem.text.contains('\n'), "{name}: {problem}");
    }
}

#[test]
fn valid_files_are_read() {
    for (name, file, read) in crate::samples::all() {
        read(&file).unwrap_or_else(|e| panic!("{name}: {e}"));
    }
}

#[test]
fn binary_files_cut_at_any_length_are_refused() {
    for (name, file, read) in crate::samples::all() {
        let binary = [
            "hair",
            "hair-even",
            "tfx-4",
            "tfx-3",
            "data",
            "tfxbone",
            "glb",
            "glb-strands",
            "glb-morph",
            "ply-little",
            "ply-big",
        ];
        if !binary.contains(&name) {
            continue;
        }
        for length in 0..file.len() {
            let problem = read(&file[..length]).expect_err(&format!("{name} cut at {length}"));
            assert!(
                !problem.text.is_empty() && !problem.text.contains('\n'),
                "{name} cut at {length}: {problem}"
            );
        }
    }
}

#[test]
fn readers_of_cut_text_files_return() {
    for (name, file, read) in crate::samples::all() {
        for length in 0..file.len() {
            check_error(name, read(&file[..length]));
        }
    }
}

#[test]
fn every_changed_byte_and_word_is_handled() {
    for (name, file, read) in crate::samples::all() {
        println!("{name}: {} bytes", file.len());
        (0..file.len()).into_par_iter().for_each_init(
            || file.clone(),
            |lying, at| {
                for value in [0, 1, 0x7f, 0x80, 0xff, b'-', b'9', b' ', b'\n'] {
                    lying[at] = value;
                    let _ = read(lying);
                    lying[at] = file[at];
                }
                if at % 4 == 0 && at + 4 <= file.len() {
                    for value in [
                        0u32,
                        1,
                        0x7fff_ffff,
                        0x8000_0000,
                        0xffff_ffff,
                        f32::NAN.to_bits(),
                        f32::MAX.to_bits(),
                    ] {
                        lying[at..at + 4].copy_from_slice(&value.to_le_bytes());
                        let _ = read(lying);
                        lying[at..at + 4].copy_from_slice(&file[at..at + 4]);
                    }
                }
            },
        );
    }
}

#[test]
fn extreme_numbers_in_text_are_handled() {
    for (name, file, read) in crate::samples::all() {
        let Ok(text) = std::str::from_utf8(&file) else {
            continue;
        };
        let numbers: Vec<(usize, usize)> = text
            .split_inclusive(|c: char| !c.is_ascii_digit())
            .scan(0, |at, piece| {
                let start = *at;
                *at += piece.len();
                Some((start, start + piece.trim_end_matches(|c: char| !c.is_ascii_digit()).len()))
            })
            .filter(|(a, b)| a < b)
            .collect();
        for (a, b) in numbers {
            for number in ["99999999999999999999", "4294967295", "1000000", "-1", "nan", "inf", "1e38", ""] {
                let lying = format!("{}{number}{}", &text[..a], &text[b..]);
                check_error(name, read(lying.as_bytes()));
            }
        }
    }
}

#[test]
fn the_error_has_file_place_and_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let options = ReadOptions::default();
    fs::write(path("a.hair"), b"HAIRbut then no more").unwrap();
    let error = read_groom(&path("a.hair"), &options).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Malformed);
    assert!(
        error.to_string().contains("a.hair, byte 0") && error.to_string().contains("cut short"),
        "{error}"
    );

    fs::write(path("b.obj"), "v 0 0 0\nv 1 0 zero\n").unwrap();
    let error = read_body(&path("b.obj"), &options).unwrap_err();
    assert!(
        error.to_string().contains("b.obj, line 2: expected a vertex of 3 numbers, found `zero`"),
        "{error}"
    );

    fs::write(path("c.bvh"), "HIERARCHY\nROOT Hips\n{\n}\nMOTION\nFrames: 5\nFrame Time: 0\n").unwrap();
    let error = read_motion(&path("c.bvh"), None, &options).unwrap_err();
    assert!(error.to_string().contains("c.bvh, line 7"), "{error}");

    let comma = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 1,5 0\n";
    fs::write(path("e.bvh"), comma).unwrap();
    let error = read_motion(&path("e.bvh"), None, &options).unwrap_err();
    assert!(
        error.to_string().contains("line 4: expected an offset, found `1,5`; use decimal points"),
        "{error}"
    );

    fs::write(path("d.tfx"), 9f32.to_le_bytes()).unwrap();
    let error = read_groom(&path("d.tfx"), &options).unwrap_err();
    assert!(error.to_string().contains(".tfx version 9 is not supported"), "{error}");

    fs::write(path("empty.data"), 0i32.to_le_bytes()).unwrap();
    let error = read_groom(&path("empty.data"), &options).unwrap_err();
    assert!(error.to_string().contains("no strands"), "{error}");

    assert_eq!(read_groom(&path("none.hair"), &options).unwrap_err().kind(), ErrorKind::NotFound);
    assert_eq!(read_groom(&path("b.obj"), &options).unwrap_err().kind(), ErrorKind::Malformed);
    assert_eq!(read_groom(&path("b.bvh"), &options).unwrap_err().kind(), ErrorKind::Unsupported);
    let wrong = ReadOptions { scale: Some(0.0), ..options };
    assert_eq!(read_groom(&path("a.hair"), &wrong).unwrap_err().kind(), ErrorKind::Unsupported);
    fs::create_dir(path("folder.hair")).unwrap();
    assert_eq!(read_groom(&path("folder.hair"), &options).unwrap_err().kind(), ErrorKind::Unreadable);
}

#[test]
fn a_point_cache_without_samples_or_with_a_broken_one_is_refused() {
    let cache = |samples: &[f32]| {
        let mut file = b"POINTCACHE2\0".to_vec();
        file.extend([1i32, 4].map(i32::to_le_bytes).concat());
        file.extend([0f32, 1.0].map(f32::to_le_bytes).concat());
        file.extend((samples.len() as i32 / 12).to_le_bytes());
        file.extend(samples.iter().flat_map(|x| x.to_le_bytes()));
        file
    };
    let mut samples = [0.5; 36];
    assert!(pc2::parse(&cache(&samples)).is_ok());
    samples[12 + 3 * 2] = f32::NAN;
    let broken = cache(&samples);
    let text = pc2::parse(&broken).unwrap_err().text;
    assert!(text.starts_with("vertex 2 of sample 1 is not finite"), "{text}");
    let text = pc2::parse(&cache(&[])).unwrap_err().text;
    assert!(text.starts_with("the file has no samples"), "{text}");
    // A scene names the file.
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("a.pc2"), broken).unwrap();
    fs::write(path("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        .unwrap();
    fs::write(path("a.csv"), "strand,x,y,z\n0,0,1,0\n0,0,1.1,0\n").unwrap();
    let scene = "[body]\nfile = \"a.obj\"\nvertex_cache = \"a.pc2\"\n[[groom]]\nfile = \"a.csv\"\n";
    fs::write(path("a.toml"), scene).unwrap();
    let error = read_scene(&path("a.toml")).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Malformed);
    assert!(error.to_string().contains("a.pc2: vertex 2 of sample 1"), "{error}");
}

#[test]
fn a_groom_too_far_from_the_origin_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("far.data");
    let write = |x: f32| {
        let points: Vec<Vec3> = (0..16).map(|i| Vec3::new(x, 0.005 * i as f32, 0.0)).collect();
        let strands = Strands { points: &points, offsets: &[0, 16], radii: &[], colors: &[], root_uvs: &[] };
        write_strands(&path, strands).unwrap();
        points
    };
    let options = ReadOptions { scale: Some(1.0), up: None };
    for x in [5e3, 1e7, 1e30] {
        write(x);
        let error = read_groom(&path, &options).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Malformed);
        assert!(error.to_string().contains("from the origin"), "{error}");
    }
    let points = write(100.0);
    assert_eq!(read_groom(&path, &options).unwrap().value.points, points);
}

#[test]
fn a_gltf_with_a_cycle_or_a_remote_buffer_is_refused() {
    let read = |json: &str| hairspring_io::gltf::parse(json.as_bytes(), &|_| None).map(drop).unwrap_err();
    let circle =
        r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}]}"#;
    assert!(read(circle).text.contains("its own ancestor"));
    let abroad =
        r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"https://example.org/a.bin","byteLength":4}]}"#;
    assert!(read(abroad).text.contains("on a network"));
    let absent = r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"a.bin","byteLength":4}]}"#;
    assert!(read(absent).text.contains("a.bin"));
    let draco = r#"{"asset":{"version":"2.0"},"extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"]}"#;
    let problem = read(draco);
    assert!(problem.place == Place::Whole && !problem.text.contains('\n'), "{problem}");
}

#[test]
fn a_rig_with_a_cycle_is_refused() {
    let mesh = || hairspring_io::obj::parse(crate::samples::mesh().as_bytes()).unwrap();
    let end = r#""head": {"strategy": "VERTEX", "vertex_index": 0}"#;
    for (rig, why) in [
        (format!(r#"{{"": {{{end}, "parent": ""}}}}"#), "no name"),
        (format!(r#"{{"a": {{{end}, "parent": "b"}}, "b": {{{end}, "parent": "a"}}}}"#), "form a cycle"),
        (format!(r#"{{"a": {{{end}, "parent": "c"}}}}"#), "does not have"),
    ] {
        let problem =
            hairspring_io::makehuman::parse(mesh(), rig.as_bytes(), crate::samples::WEIGHTS).unwrap_err();
        assert!(problem.text.contains(why), "{problem}");
    }
}

/// Made once, because the property test runs many times.
static SAMPLES: std::sync::LazyLock<Vec<crate::samples::Sample>> =
    std::sync::LazyLock::new(crate::samples::all);

proptest! {
    #[test]
    fn readers_of_noise_return(noise in prop::collection::vec(any::<u8>(), 0..400)) {
        for (_, file, read) in SAMPLES.iter() {
            let _ = read(&noise);
            // Noise after a valid beginning.
            let mut half = file[..file.len() / 2].to_vec();
            half.extend(&noise);
            let _ = read(&half);
        }
    }
}
