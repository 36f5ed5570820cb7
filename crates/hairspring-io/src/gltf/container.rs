//! The container of a glTF file: GLB chunks or plain JSON, and the bytes of its buffers.

use super::accessor::Buffers;
use crate::{Place, Problem, bytes::Bytes};
use base64::{Engine, engine::general_purpose::STANDARD};
use gltf::{
    Document,
    buffer::Source,
    json::{Path, validation::Validate},
};

/// Opens a `.glb` or `.gltf` file and loads its buffers. `sibling` returns the bytes of a file next to it.
pub(super) fn open(
    data: &[u8],
    sibling: &dyn Fn(&str) -> Option<Vec<u8>>,
) -> Result<(Document, Buffers), Problem> {
    let (json, mut blob) = if data.starts_with(b"glTF") { chunks(data)? } else { (data, None) };
    let invalid = |e: &dyn std::fmt::Display| {
        Problem::whole(format!("not a valid glTF file: {}", first_line(&e.to_string())))
    };
    let root = gltf::json::Root::from_slice(json).map_err(|e| invalid(&e))?;
    trusted_indices(&root)?;
    let document = Document::from_json(root).map_err(|e| invalid(&e))?;
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        let bytes = match buffer.source() {
            Source::Bin => {
                blob.take().ok_or_else(|| Problem::whole("the file's binary chunk is missing"))?.to_vec()
            }
            Source::Uri(uri) => resolve(uri, sibling)?,
        };
        if bytes.len() < buffer.length() {
            let (have, want) = (bytes.len(), buffer.length());
            return Err(Problem::whole(format!(
                "buffer {} has {have} bytes, but {want} are declared",
                buffer.index()
            )));
        }
        buffers.push(bytes);
    }
    Ok((document, Buffers(buffers)))
}

/// Checks the indices that the `gltf` crate's own validation and iterators use without checking.
fn trusted_indices(root: &gltf::json::Root) -> Result<(), Problem> {
    for animation in &root.animations {
        // The crate validates samplers, but not channels.
        let mut lost = animation.channels.iter().any(|c| c.sampler.value() >= animation.samplers.len());
        for channel in &animation.channels {
            channel.target.validate(root, Path::new, &mut |_, _| lost = true);
        }
        if lost {
            return Err(Problem::whole(
                "an animation channel refers to a missing object or to an unknown property",
            ));
        }
    }
    for primitive in root.meshes.iter().flat_map(|m| &m.primitives) {
        if primitive.attributes.values().any(|a| a.value() >= root.accessors.len()) {
            return Err(Problem::whole("a mesh names an accessor that the file does not have"));
        }
    }
    Ok(())
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

/// Returns the bytes of a buffer that is named by a URI: embedded in the URI, or in a file next to this one.
fn resolve(uri: &str, sibling: &dyn Fn(&str) -> Option<Vec<u8>>) -> Result<Vec<u8>, Problem> {
    if let Some(data) = uri.strip_prefix("data:") {
        let encoded = data.split_once(";base64,").map(|(_, e)| e);
        let decoded = encoded.and_then(|e| STANDARD.decode(e).ok());
        return decoded.ok_or_else(|| Problem::whole("a buffer's data URI is not base64"));
    }
    if uri.contains("://") {
        return Err(Problem::whole(format!(
            "the buffer {uri:?} is on a network; put the file next to this one"
        )));
    }
    sibling(uri).ok_or_else(|| Problem::whole(format!("its buffer {uri:?} was not found next to it")))
}

/// The first line of a message, cut at 300 characters.
fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().chars().take(300).collect()
}
