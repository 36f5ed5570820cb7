//! The container of a glTF file: GLB chunks or plain JSON, and the bytes of its buffers.

use super::{
    accessor::Buffers,
    json::{self, Document},
    uri,
};
use crate::{Place, Problem, bytes::Bytes, contents::packed};
use std::{borrow::Cow, collections::HashMap};

/// Largest size of all buffers together [bytes].
const MAX_BUFFERS: u64 = 4 << 30;

/// Opens a `.glb` or `.gltf` file and loads its buffers, each file once. `sibling` returns the bytes of a file
/// next to it.
pub(super) fn open<'a>(
    data: &'a [u8],
    sibling: &dyn Fn(&str) -> Option<Vec<u8>>,
) -> Result<(Document, Buffers<'a>), Problem> {
    let (json, mut blob) = parts(data)?;
    let document = json::parse(json)?;
    let mut stored: Vec<Cow<'a, [u8]>> = Vec::new();
    let mut files: HashMap<String, usize> = HashMap::new();
    let (mut of, mut total) = (Vec::new(), 0u64);
    for (index, buffer) in document.buffers.iter().enumerate() {
        let slot = match &buffer.uri {
            // A buffer without bytes is a placeholder for compressed ones. It may exist, but not be used.
            None => blob.take().map(|bytes| {
                stored.push(Cow::Borrowed(bytes));
                stored.len() - 1
            }),
            Some(text) => match uri::data(text, index) {
                Some(bytes) => {
                    stored.push(Cow::Owned(bytes?));
                    Some(stored.len() - 1)
                }
                None => {
                    let name = uri::file_name(text)?;
                    Some(match files.get(&name) {
                        Some(slot) => *slot,
                        None => {
                            stored.push(Cow::Owned(beside(&name, text, sibling)?));
                            total = total.saturating_add(stored[stored.len() - 1].len() as u64);
                            files.insert(name, stored.len() - 1);
                            stored.len() - 1
                        }
                    })
                }
            },
        };
        if total > MAX_BUFFERS {
            let text = format!("its buffers have more than {MAX_BUFFERS} bytes; export fewer objects");
            return Err(Problem::limit(Place::Whole, text));
        }
        let (have, want) = (slot.map_or(usize::MAX, |slot| stored[slot].len()), buffer.byte_length);
        if have < want {
            let what = slot.and_then(|slot| packed(&stored[slot])).map(|what| format!("; {what}"));
            return Err(Problem::whole(format!(
                "buffer {index} has {have} bytes, but {want} are declared{}",
                what.unwrap_or_default()
            )));
        }
        of.push(slot);
    }
    Ok((document, Buffers::new(data.len(), stored, of)))
}

/// Reads the document of a `.glb` or `.gltf` file without its buffers.
pub(super) fn document(data: &[u8]) -> Result<Document, Problem> {
    json::parse(parts(data)?.0)
}

/// Returns the JSON of a `.glb` or `.gltf` file, and the binary chunk of a GLB.
fn parts(data: &[u8]) -> Result<(&[u8], Option<&[u8]>), Problem> {
    if data.starts_with(b"glTF") { chunks(data) } else { Ok((data, None)) }
}

/// Returns the JSON and the binary chunk of a GLB.
fn chunks(data: &[u8]) -> Result<(&[u8], Option<&[u8]>), Problem> {
    let mut bytes = Bytes::new(data);
    bytes.take(4, "the magic")?;
    let version: u32 = bytes.value("the version")?;
    if version != 2 {
        let text = format!("GLB version {version} is not supported; export the file as glTF 2.0");
        return Err(Problem::new(Place::Byte(4), text));
    }
    let _length: u32 = bytes.value("the file's length")?;
    let mut chunk = |kind: &[u8; 4]| -> Result<&[u8], Problem> {
        let length: u32 = bytes.value("a chunk's length")?;
        let at = bytes.at();
        if bytes.take(4, "a chunk's kind")? != kind {
            return Err(Problem::new(
                Place::Byte(at),
                "expected the JSON chunk, followed by the binary chunk",
            ));
        }
        bytes.take(length as usize, "a chunk")
    };
    let json = chunk(b"JSON")?;
    let after = 20 + json.len();
    let blob = if data.len() > after { Some(chunk(b"BIN\0")?) } else { None };
    Ok((json, blob))
}

/// Reads the file `name`, or the file with the literal name `uri`: some programs do not encode it.
fn beside(name: &str, uri: &str, sibling: &dyn Fn(&str) -> Option<Vec<u8>>) -> Result<Vec<u8>, Problem> {
    let literal = || (name != uri).then(|| sibling(uri)).flatten();
    sibling(name).or_else(literal).ok_or_else(|| Problem::missing(name))
}
