//! URIs of the buffers of a glTF file: data URIs (RFC 2397) and relative references (RFC 3986).

use crate::Problem;
use base64::{
    Engine,
    alphabet::STANDARD,
    engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig},
};
use std::borrow::Cow;

/// Some programs leave out the padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Returns the bytes of a data URI; `None` for another URI. `buffer` is the index of the buffer that has it.
pub(super) fn data(uri: &str, buffer: usize) -> Option<Result<Vec<u8>, Problem>> {
    let rest = uri.get(5..).filter(|_| uri.as_bytes()[..5].eq_ignore_ascii_case(b"data:"))?;
    let wrong = |why: &str| {
        Problem::whole(format!(
            "the data URI of buffer {buffer} {why}; export the buffer as a separate file, or the whole as .glb"
        ))
    };
    let Some((kind, content)) = rest.split_once(',') else {
        return Some(Err(wrong("has no comma before its data")));
    };
    let bytes = percent_decoded(content);
    let last = kind.rsplit_once(';').map(|(_, last)| last.trim());
    if !last.is_some_and(|last| last.eq_ignore_ascii_case("base64")) {
        return Some(Ok(bytes.into_owned()));
    }
    // Some programs break the lines.
    let packed = if bytes.iter().any(u8::is_ascii_whitespace) {
        Cow::Owned(bytes.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).collect())
    } else {
        bytes
    };
    Some(BASE64.decode(&packed).map_err(|_| wrong("is not valid base64")))
}

/// Returns the name of the file that a relative URI refers to, in the folder of the glTF file or below: `%20` is a space, `./` is
/// the same folder, and `../` the one above. Some programs write `\\` for `/`.
pub(super) fn file_name(uri: &str) -> Result<String, Problem> {
    let wrong = |why: &str| {
        Err(Problem::whole(format!(
            "the buffer {uri:?} {why}; put it next to the file and export with relative paths"
        )))
    };
    let is_file = uri.get(..5).is_some_and(|start| start.eq_ignore_ascii_case("file:"));
    if uri.contains("://") && !is_file {
        return wrong("is on a network");
    }
    let name = String::from_utf8(percent_decoded(uri).into_owned()).unwrap_or_else(|_| uri.to_owned());
    let name = name.replace('\\', "/");
    let has_drive = name.as_bytes().get(1) == Some(&b':');
    if is_file || has_drive || name.starts_with('/') {
        return wrong("is an absolute path");
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in name.split('/').filter(|part| *part != "." && !part.is_empty()) {
        if part != ".." {
            parts.push(part);
        } else if parts.pop().is_none() {
            return wrong("is outside of the folder of the file");
        }
    }
    Ok(parts.join("/"))
}

/// Returns the bytes of a text in which `%` and two digits are a byte.
fn percent_decoded(text: &str) -> Cow<'_, [u8]> {
    if !text.contains('%') {
        return Cow::Borrowed(text.as_bytes());
    }
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let code = match rest {
            [b'%', a, b, ..] => hex(*a).zip(hex(*b)).map(|(a, b)| 16 * a + b),
            _ => None,
        };
        bytes.push(code.unwrap_or(*first));
        rest = if code.is_some() { &rest[3..] } else { after };
    }
    Cow::Owned(bytes)
}

fn hex(digit: u8) -> Option<u8> {
    (digit as char).to_digit(16).map(|d| d as u8)
}
