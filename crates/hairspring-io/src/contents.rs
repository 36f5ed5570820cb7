//! What a file is by its first bytes, for files that are not what their name says.

use crate::{Format, Problem, text::printable};
use std::path::Path;

/// Number of bytes that decide whether a text is one.
const HEAD: usize = 1024;

/// Checks that the content of the file at `path` can be of the format that its extension names.
///
/// # Errors
/// Returns an error with what the file is, and what to do.
pub(crate) fn check(path: &Path, data: &[u8]) -> Result<(), Problem> {
    let format = Format::of(path);
    let name = path.extension().map(|name| name.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    // Some formats are archives themselves.
    let packed = packed(data).filter(|_| name != "usdz").map(str::to_owned);
    let other = || format.and_then(|format| other_format(data, format));
    let garbled = || match format? {
        format if is_text(format) => unreadable_text(data),
        // Other files of these formats are binary.
        Format::Gltf | Format::Ply | Format::Tfx if has_utf16_mark(data) => {
            Some("its text is in UTF-16; save it as UTF-8")
        }
        Format::Gltf | Format::Ply | Format::Tfx => wide_text(data),
        _ => None,
    };
    match packed.or_else(other).or_else(|| garbled().map(str::to_owned)) {
        Some(text) => Err(Problem::whole(printable(&text))),
        None => Ok(()),
    }
}

/// Describes a file that holds another file, or stands for one.
pub(crate) fn packed(data: &[u8]) -> Option<&'static str> {
    let kinds: [(&[u8], &str); 7] = [
        (
            b"version https://git-lfs",
            "it is a Git LFS pointer, not the file itself; fetch the file with `git lfs pull`",
        ),
        // A .data file of 35,615 strands begins with the first two.
        (b"\x1f\x8b\x08", "it is compressed with gzip; decompress it"),
        (b"BZh91AY&SY", "it is compressed with bzip2; decompress it"),
        (b"\xfd7zXZ\0", "it is compressed with xz; decompress it"),
        (b"\x28\xb5\x2f\xfd", "it is compressed with Zstandard; decompress it"),
        (b"PK\x03\x04", "it is a ZIP archive; unpack it"),
        (b"7z\xbc\xaf\x27\x1c", "it is a 7z archive; unpack it"),
    ];
    let known = kinds.into_iter().find(|(start, _)| data.starts_with(start)).map(|(_, text)| text);
    let page = || {
        let start = data.trim_ascii_start();
        let is = |tag: &[u8]| start.get(..tag.len()).is_some_and(|head| head.eq_ignore_ascii_case(tag));
        (is(b"<!doctype html") || is(b"<html"))
            .then_some("it is a web page, probably instead of a download; download the file again")
    };
    known.or_else(page)
}

/// Describes a file of another format than `format`.
fn other_format(data: &[u8], format: Format) -> Option<String> {
    let readable: [(&[u8], Format, &str); 5] = [
        (b"glTF", Format::Gltf, "glb"),
        (b"POINTCACHE2", Format::Pc2, "pc2"),
        (b"ply\n", Format::Ply, "ply"),
        (b"ply\r", Format::Ply, "ply"),
        (b"HIERARCHY", Format::Bvh, "bvh"),
    ];
    let unread: [(&[u8], &str); 9] = [
        (b"Kaydara FBX", "an FBX file"),
        (b"; FBX", "an FBX file"),
        (b"BLENDER", "a Blender file"),
        (b"solid ", "an STL file"),
        (b"#usda", "a USD file"),
        (b"PXR-USDC", "a USD file"),
        (b"Ogawa", "an Alembic file"),
        (b"\x89PNG", "a picture"),
        (b"\xff\xd8\xff", "a picture"),
    ];
    let is = |start: &[u8]| data.starts_with(start);
    // Only a binary file, because a table may begin with any word.
    let hair = is(b"HAIR") && data.iter().take(32).any(|byte| *byte == 0);
    let known = readable.into_iter().find(|(start, ..)| is(start)).map(|(_, kind, name)| (kind, name));
    if let Some((kind, name)) = known.or(hair.then_some((Format::Hair, "hair"))) {
        return (format != kind)
            .then(|| format!("by its content it is a .{name} file; correct its extension"));
    }
    let external = Format::EXTERNAL.contains(&format);
    let (_, what) = unread.into_iter().filter(|_| !external).find(|(start, _)| is(start))?;
    let remedy = match what {
        "a USD file" | "an Alembic file" => "give its name the extension of that format",
        "a picture" => "name the file of the geometry",
        _ => "it is not read; export glTF (.glb) or OBJ from the program that made it",
    };
    Some(format!("by its content it is {what}; {remedy}"))
}

/// Whether files of a format are text.
fn is_text(format: Format) -> bool {
    matches!(format, Format::Obj | Format::Bvh | Format::Csv | Format::TfxMesh | Format::Scene)
}

/// Whether data begins with the byte order mark of UTF-16.
fn has_utf16_mark(data: &[u8]) -> bool {
    [&b"\xff\xfe"[..], b"\xfe\xff"].iter().any(|mark| data.starts_with(mark)) && !has_utf32_mark(data)
}

/// Whether data begins with the byte order mark of UTF-32.
fn has_utf32_mark(data: &[u8]) -> bool {
    [&b"\xff\xfe\0\0"[..], b"\0\0\xfe\xff"].iter().any(|mark| data.starts_with(mark))
}

/// Describes text of two or four bytes a letter, except UTF-16 with a byte order mark.
fn wide_text(data: &[u8]) -> Option<&'static str> {
    let head = &data[..data.len().min(HEAD)];
    // Western letters have one byte that is not 0 in each unit of two or four.
    let letters = |unit: usize| {
        let units = head.chunks_exact(unit);
        let western = |bytes: &&[u8]| bytes.iter().filter(|byte| **byte != 0).count() == 1;
        units.len() > 3 && units.clone().filter(western).count() * 10 >= units.len() * 9
    };
    if has_utf32_mark(data) || letters(4) {
        return Some("its text is in UTF-32; save it as UTF-8");
    }
    letters(2).then_some("its text is in UTF-16 without a byte order mark; save it as UTF-8")
}

/// Describes the content of a text file that is no text, or in an encoding that is not read.
fn unreadable_text(data: &[u8]) -> Option<&'static str> {
    if has_utf16_mark(data) {
        return None;
    }
    let head = &data[..data.len().min(HEAD)];
    let binary = || {
        let control = head.iter().filter(|byte| **byte < 9 || (14..32).contains(*byte)).count();
        (control >= 8 && control * 20 > head.len()).then_some(
            "it is a binary file, but this format is text; export it again, or correct its extension",
        )
    };
    wide_text(data).or_else(binary)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(name: &str, data: &[u8]) -> String {
        check(Path::new(name), data).err().map_or(String::new(), |problem| problem.text)
    }

    #[test]
    fn files_of_another_kind_are_named_with_a_remedy() {
        let lfs = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
        let hair = [&b"HAIR\x06\0\0\0"[..], &[0; 120]].concat();
        let utf16: Vec<u8> = "v 0 0 0\nv 1 0 0\n".bytes().flat_map(|byte| [byte, 0]).collect();
        let utf32: Vec<u8> = "v 0 0 0\nv 1 0 0\n".bytes().flat_map(|byte| [0, 0, 0, byte]).collect();
        let noise: Vec<u8> = (0..2000u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
        let page = b"\n<!DOCTYPE HTML><title>404</title>";
        let marked = |name: &[u8]| [b"\xff\xfe", name].concat();
        let cases: [(&[&str], &[u8], &str); 15] = [
            (&["a.hair", "a.obj", "a.glb", "a.tfx", "a.toml", "a.csv", "a.png"], lfs, "`git lfs pull`"),
            (
                &["a.hair", "a.obj", "a.glb", "a.bvh", "a.toml", "a.jpg"],
                b"\x1f\x8b\x08\0",
                "gzip; decompress",
            ),
            (&["a.hair", "a.obj"], b"PK\x03\x04\0\0", "ZIP archive; unpack"),
            (&["a.hair", "a.csv"], page, "web page"),
            (&["a.glb", "a.obj"], b"Kaydara FBX Binary  \0", "an FBX file; it is not read; export glTF"),
            (&["a.tfx", "a.data", "a.obj"], &hair, "a .hair file; correct its extension"),
            (&["a.obj", "a.bvh"], b"glTF\x02\0\0\0", "a .glb file; correct its extension"),
            (&["a.obj", "a.glb"], b"solid ball\nfacet normal 0 0 1\n", "STL"),
            (&["a.obj", "a.bvh", "a.csv", "a.toml", "a.tfxmesh"], &utf16, "UTF-16 without a byte order mark"),
            (&["a.gltf", "a.ply", "a.tfx"], &utf16, "UTF-16 without a byte order mark"),
            (&["a.gltf", "a.ply", "a.tfx"], &marked(&utf16), "its text is in UTF-16; save it as UTF-8"),
            (&["a.gltf", "a.ply", "a.tfx"], &utf32, "UTF-32; save it as UTF-8"),
            (&["a.obj", "a.toml"], &utf32, "UTF-32; save it as UTF-8"),
            (&["a.obj"], &[&b"\xff\xfe\0\0"[..], &[65, 0, 0, 0]].concat(), "UTF-32"),
            (&["a.obj", "a.bvh", "a.toml"], &noise, "binary file"),
        ];
        for (names, data, part) in cases {
            for name in names {
                let text = found(name, data);
                assert!(text.contains(part), "{name}: {text}");
            }
        }
    }

    #[test]
    fn files_that_are_what_their_name_says_are_not_reported() {
        let hair = [&b"HAIR\x06\0\0\0"[..], &[0; 120]].concat();
        let cases: [(&str, &[u8]); 13] = [
            ("a.hair", &hair),
            ("a.HAIR", &hair),
            ("a.glb", b"glTF\x02\0\0\0"),
            ("a.vrm", b"glTF\x02\0\0\0"),
            ("a.usdz", b"PK\x03\x04\0\0"),
            ("a.png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"),
            ("a.jpg", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"),
            ("a.csv", b"HAIR,x,y,z\n"),
            ("a.obj", b"\xff\xfev\0 \x000\0 \x000\0"),
            ("a.obj", b"g T\xeate\x01\nv 0 0 0\n\x1a"),
            ("a.data", &[0x1f, 0x8b, 0, 0, 64, 0, 0, 0, 0, 0, 128, 63]),
            ("a.data", &[40, 0, 0, 0, 64, 0, 0, 0, 0, 0, 128, 63]),
            ("a.obj", b""),
        ];
        for (name, data) in cases {
            assert_eq!(found(name, data), "", "{name}");
        }
    }
}
