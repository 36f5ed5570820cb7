//! The header and the rows of a PLY file, with errors that name their place.

use crate::{
    Place, Problem,
    text::{self, shortened},
};
use ply_rs_bw::{
    parser::{ParseError, Parser, Reader},
    ply::{ElementDef, Encoding, Header, PropertyAccess},
};
use std::{borrow::Cow, io::ErrorKind};

/// Largest header [bytes]. It bounds the work for long names.
const MAX_HEADER: usize = 64 << 10;

/// Names of properties in an error message.
const SHOWN_NAMES: usize = 8;

/// The header of a file, and where its rows begin.
pub(super) struct Opened {
    pub header: Header,
    /// Offset of the first row [bytes].
    rows: usize,
    /// Whether lines end in CR.
    cr: bool,
    /// Number of lines of the header.
    lines: usize,
}

/// Reads the header.
pub(super) fn open(data: &[u8]) -> Result<Opened, Problem> {
    if !data.starts_with(b"ply") {
        let text = "a .ply file begins with the letters ply; this one does not";
        return Err(Problem::new(Place::Byte(0), text));
    }
    // The first line tells how lines end: in LF or CR LF, or in CR.
    let cr = data.get(3) == Some(&b'\r') && data.get(4) != Some(&b'\n');
    let end = if cr { b'\r' } else { b'\n' };
    let head = &data[..data.len().min(MAX_HEADER)];
    let (mut rows, mut lines) = (0, 0);
    loop {
        let rest = &head[rows..];
        let Some(length) = rest.iter().position(|byte| *byte == end) else {
            let text = match head.len() {
                MAX_HEADER => format!(
                    "the header has no line `end_header` within the limit of {MAX_HEADER} bytes; remove its comments"
                ),
                _ => "the header has no line `end_header`: the file is cut short".into(),
            };
            return Err(Problem::new(Place::Line(lines + 1), text));
        };
        (rows, lines) = (rows + length + 1, lines + 1);
        if rest[..length].trim_ascii() == b"end_header" {
            break;
        }
    }
    // Comments may be in an old encoding.
    let mut text = String::from_utf8_lossy(&data[..rows]);
    if cr {
        text = Cow::Owned(text.replace('\r', "\n"));
    }
    let mut reader = Reader::new(text.as_bytes());
    let header = Parser::<super::Skipped>::new().read_header(&mut reader).map_err(|error| {
        let Some(line) = error.line() else {
            return Problem::whole("the header has no line `format ascii 1.0` or `format binary_little_endian 1.0`");
        };
        let found = text::lines(&text).nth(line.saturating_sub(1)).unwrap_or("");
        Problem::line(
            line,
            format!(
                "expected a line of a PLY header, such as `element vertex 8` or `property float x`, found `{}`",
                shortened(found)
            ),
        )
    })?;
    let empty = |element: &&ElementDef| element.properties.is_empty() && element.count > 0;
    match header.elements.values().find(empty) {
        Some(element) => Err(Problem::whole(format!(
            "the element `{}` has {} rows but no properties; remove it from the header",
            shortened(&element.name),
            element.count
        ))),
        None => Ok(Opened { header, rows, cr, lines }),
    }
}

/// The rows of a file, element after element.
pub(super) struct Payload<'a> {
    opened: &'a Opened,
    reader: Reader<&'a [u8]>,
    /// Size of the file [bytes].
    size: usize,
}

/// Returns the file with the rows of text as the parser accepts them: with lines that end in LF, and with digits on both
/// sides of the point of a number, as in `1.0` for `1.` and `0.5` for `.5`. Binary files are not changed.
pub(super) fn readable_rows<'a>(opened: &Opened, data: &'a [u8]) -> Cow<'a, [u8]> {
    let (head, rows) = data.split_at(opened.rows);
    if opened.cr && opened.header.encoding == Encoding::Ascii {
        let lines = rows.iter().map(|byte| if *byte == b'\r' { b'\n' } else { *byte });
        let data = head.iter().copied().chain(lines).collect::<Vec<u8>>();
        return Cow::Owned(with_digits(opened, &data).into_owned());
    }
    with_digits(opened, data)
}

/// Adds the digits.
fn with_digits<'a>(opened: &Opened, data: &'a [u8]) -> Cow<'a, [u8]> {
    let (head, rows) = data.split_at(opened.rows);
    let digit = |k: Option<usize>| k.and_then(|k| rows.get(k)).is_some_and(u8::is_ascii_digit);
    // Whether a digit is missing before and after the point at `k`. A point without any digit is no number.
    let missing = |k: usize| {
        let [before, after] = [digit(k.checked_sub(1)), digit(Some(k + 1))];
        (rows[k] == b'.' && before != after).then_some([!before, !after])
    };
    if opened.header.encoding != Encoding::Ascii || !(0..rows.len()).any(|k| missing(k).is_some()) {
        return data.into();
    }
    let mut all = head.to_vec();
    for (k, byte) in rows.iter().enumerate() {
        let [before, after] = missing(k).unwrap_or_default();
        all.extend(before.then_some(b'0'));
        all.push(*byte);
        all.extend(after.then_some(b'0'));
    }
    all.into()
}

impl<'a> Payload<'a> {
    pub(super) fn new(opened: &'a Opened, data: &'a [u8]) -> Self {
        Self { opened, reader: Reader::new(&data[opened.rows..]), size: data.len() }
    }

    /// Reads all rows of the next element.
    pub(super) fn rows<E: PropertyAccess>(&mut self, element: &ElementDef) -> Result<Vec<E>, Problem> {
        let rows = Parser::new().read_payload_for_element(&mut self.reader, element, &self.opened.header);
        rows.map_err(|error| self.problem(element, &error))
    }

    /// Checks that nothing is left after the last row.
    pub(super) fn finish(&self) -> Result<(), Problem> {
        let rest = *self.reader.get_ref();
        if rest.trim_ascii().is_empty() {
            return Ok(());
        }
        let text = format!(
            "{} bytes are left after the rows that the header declares: its counts or properties are wrong",
            rest.len()
        );
        Err(Problem::new(Place::Byte(self.at()), text))
    }

    /// Offset of the next byte.
    fn at(&self) -> usize {
        self.size - self.reader.get_ref().len()
    }

    fn problem(&self, element: &ElementDef, error: &ParseError) -> Problem {
        let name = shortened(&element.name);
        let is_text = self.opened.header.encoding == Encoding::Ascii;
        let place = match error.line().filter(|_| is_text) {
            Some(line) => Place::Line(self.opened.lines + line),
            None => Place::Byte(self.at()),
        };
        if error.kind() == ErrorKind::UnexpectedEof {
            let text = format!(
                "the file ends before the last of the {} rows of the element `{name}`: it is cut short",
                element.count
            );
            return Problem::new(place, text);
        }
        let names: Vec<String> = element.properties.keys().take(SHOWN_NAMES).map(|n| shortened(n)).collect();
        let more = if element.properties.len() > SHOWN_NAMES { ", …" } else { "" };
        let text = format!(
            "expected a row of the element `{name}` with numbers for {}{more}, and numbers of vertices from 0; export the file again",
            names.join(", ")
        );
        Problem::new(place, text)
    }
}
