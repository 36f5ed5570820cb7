//! Promise: a header of a `.tfx` file that places an array inside of itself is refused, and bytes that it does not name
//! are reported.

use crate::samples;
use hairspring_io::{ReadOptions, read_groom, tfx};
use std::fs;

#[test]
fn an_array_inside_of_the_header_is_refused() {
    let file = samples::written(&samples::groom(4), "tfx");
    for (word, name, offsets) in [
        (3, "positions", &[0, 4, 159][..]),
        (4, "strand texture coordinates", &[8, 159]),
        (5, "point texture coordinates", &[8, 159]),
        (6, "thicknesses", &[8, 159]),
        (7, "colors", &[8, 159]),
    ] {
        for offset in offsets {
            let mut broken = file.clone();
            broken[word * 4..][..4].copy_from_slice(&u32::to_le_bytes(*offset));
            let error = tfx::parse(&broken).unwrap_err().to_string();
            let part = format!("the header places the {name} at byte {offset}, inside of its own 160 bytes");
            assert!(error.contains(&part) && error.ends_with("export the file again"), "{error}");
        }
    }
    // The header of version 3 is longer.
    let mut broken = samples::tfx_3();
    broken[36 * 4..][..4].copy_from_slice(&u32::to_le_bytes(160));
    let error = tfx::parse(&broken).unwrap_err().to_string();
    assert!(error.contains("positions at byte 160, inside of its own 296 bytes"), "{error}");
    let error = tfx::parse(&[1; 400]).unwrap_err().to_string();
    assert!(error.contains("so it is no .tfx file"), "{error}");
}

#[test]
fn bytes_after_the_arrays_are_reported_unless_they_align_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.tfx");
    for (more, reported) in [(&b""[..], false), (b"\0\0\0\0", false), (b"zzz", true), (&[0; 16], true)] {
        fs::write(&path, [&samples::written(&samples::groom(4), "tfx"), more].concat()).unwrap();
        let notes = read_groom(&path, &ReadOptions::default()).unwrap().notes.join("; ");
        let part = format!("{} bytes after the last array are not used", more.len());
        assert_eq!(notes.contains(&part), reported, "{more:?}: {notes}");
    }
}
