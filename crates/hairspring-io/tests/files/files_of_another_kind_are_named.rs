//! Promise: a file that is not what its extension says is refused with what it is, and with what to do.

use hairspring_io::{ErrorKind, ReadOptions, read_body, read_groom, read_motion, read_scene};
use std::fs;

const POINTER: &[u8] = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";

#[test]
fn every_reader_names_what_a_file_is() {
    let folder = tempfile::tempdir().unwrap();
    let options = ReadOptions::default();
    for (name, data, part) in [
        (
            "a.hair",
            POINTER,
            "a.hair: it is a Git LFS pointer, not the file itself; fetch the file with `git lfs pull`",
        ),
        ("a.glb", POINTER, "Git LFS pointer"),
        ("a.bvh", b"\x1f\x8b\x08\0\0", "a.bvh: it is compressed with gzip; decompress it"),
        ("a.toml", b"\x1f\x8b\x08\0\0", "a.toml: it is compressed with gzip"),
        ("a.obj", b"Kaydara FBX Binary  \0\x1a\0", "a.obj: by its content it is an FBX file; it is not read"),
        ("b.obj", b"v\0 \x000\0 \x000\0 \x000\0\n\0", "UTF-16 without a byte order mark; save it as UTF-8"),
        ("b.tfx", b"HAIR\x01\0\0\0\x03\0\0\0", "by its content it is a .hair file; correct its extension"),
    ] {
        let path = folder.path().join(name);
        fs::write(&path, data).unwrap();
        let error = match name.rsplit('.').next().unwrap() {
            "hair" | "tfx" => read_groom(&path, &options).map(drop),
            "bvh" => read_motion(&path, None, &options).map(drop),
            "toml" => read_scene(&path).map(drop),
            _ => read_body(&path, &options).map(drop),
        };
        let error = error.unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Malformed, "{error}");
        assert!(error.to_string().contains(part), "{error}");
    }
}

#[test]
fn a_buffer_of_a_gltf_file_is_named_too() {
    let json = r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"a.bin","byteLength":400}]}"#;
    let error = hairspring_io::gltf::parse(json.as_bytes(), &|_| Some(POINTER.into())).unwrap_err().text;
    assert!(error.contains("buffer 0 has") && error.ends_with("`git lfs pull`"), "{error}");
}
