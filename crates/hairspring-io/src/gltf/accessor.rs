//! Reads a glTF accessor and checks every bound.

use super::json::{Accessor, Document, View, compressed};
use crate::{Place, Problem, bytes::with_room};
use glam::Vec3;
use std::{borrow::Cow, cell::Cell};

/// Numbers that may be read from a file of any size. An array that several objects share is read for each of
/// them.
const NUMBERS: usize = 24_000_000;

/// Numbers that may be read for each byte of a file, in addition.
const NUMBERS_PER_BYTE: usize = 16;

/// Elements of an accessor without bytes (all zero) in a file of any size.
const ZEROS: usize = 1_000_000;

/// The bytes of a file's buffers.
pub(super) struct Buffers<'a> {
    /// Each file or data URI once.
    stored: Vec<Cow<'a, [u8]>>,
    /// Index in `stored` of each buffer; `None` if the file does not contain its bytes. Shape `[buffers]`.
    of: Vec<Option<usize>>,
    /// Size of the file and of its buffers [bytes].
    size: usize,
    /// Numbers that may still be read.
    left: Cell<usize>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(file: usize, stored: Vec<Cow<'a, [u8]>>, of: Vec<Option<usize>>) -> Self {
        // A data URI and a binary chunk are part of the file; counting them twice changes a factor below two.
        let size = stored.iter().fold(file, |sum, bytes| sum.saturating_add(bytes.len()));
        let left = Cell::new(size.saturating_mul(NUMBERS_PER_BYTE).saturating_add(NUMBERS));
        Self { stored, of, size, left }
    }

    /// Size of the file and of its buffers [bytes].
    pub(super) fn size(&self) -> usize {
        self.size
    }

    /// Takes `count` numbers from those that may still be read, so that a small file cannot make the reader
    /// decode one array forever.
    pub(super) fn spend(&self, count: usize) -> Result<(), Problem> {
        let left = self.left.get().checked_sub(count).ok_or_else(|| {
            let text = "its objects use the same arrays too many times; export fewer copies of its meshes and animations";
            Problem::limit(Place::Whole, text)
        })?;
        self.left.set(left);
        Ok(())
    }

    /// Returns the bytes of a view; `None` if they lie outside the buffer.
    fn view(&self, view: &View) -> Result<Option<&[u8]>, Problem> {
        let Some(stored) = self.of.get(view.buffer).copied().flatten() else {
            return match view.buffer < self.of.len() {
                true if view.is_meshopt() => Err(compressed("EXT_meshopt_compression")),
                true => Err(without_uri(view.buffer)),
                false => Ok(None),
            };
        };
        let end = view.byte_offset.checked_add(view.byte_length);
        Ok(end.and_then(|end| self.stored[stored].get(view.byte_offset..end)))
    }
}

/// The error for a buffer whose bytes the file does not hold.
fn without_uri(buffer: usize) -> Problem {
    Problem::whole(format!(
        "buffer {buffer} has no `uri`, so its bytes are missing: the file is the JSON of a .glb without its binary chunk, or an extension that is not read holds them; export it as .glb, without compression"
    ))
}

/// Reads the colors of accessor `index`, with or without opacity, which is left out.
pub(super) fn colors(document: &Document, index: usize, buffers: &Buffers<'_>) -> Result<Vec<Vec3>, Problem> {
    let rgb = |r: f64, g: f64, b: f64| Vec3::new(r as f32, g as f32, b as f32);
    Ok(if accessor(document, index, "colors")?.shape.components() == 4 {
        let colors = components::<4>(document, index, buffers, "colors")?;
        colors.into_iter().map(|[r, g, b, _]| rgb(r, g, b)).collect()
    } else {
        let colors = components::<3>(document, index, buffers, "colors")?;
        colors.into_iter().map(|[r, g, b]| rgb(r, g, b)).collect()
    })
}

/// Reads the elements of accessor `index`, which has `N` components, with normalized integers as fractions.
/// `what` names them in error messages.
pub(super) fn components<const N: usize>(
    document: &Document,
    index: usize,
    buffers: &Buffers<'_>,
    what: &str,
) -> Result<Vec<[f64; N]>, Problem> {
    let wrong = |why: &str| Problem::whole(format!("the {what} (accessor {index}) {why}"));
    let outside = || wrong("lie outside their buffer: the file is cut short");
    let accessor = accessor(document, index, what)?;
    if accessor.shape.components() != N {
        return Err(wrong(&format!("should have {N} components each")));
    }
    let kind = Kind::of(accessor.component_type).ok_or_else(|| wrong("have an unknown component type"))?;
    let layout = Layout { kind, normalized: accessor.normalized };
    let bytes_of = |view: usize, offset: usize| {
        let view =
            document.buffer_views.get(view).ok_or_else(|| wrong("name a buffer view that is missing"))?;
        let bytes = buffers.view(view)?.and_then(|bytes| bytes.get(offset..)).ok_or_else(outside)?;
        Ok::<_, Problem>((bytes, view.byte_stride))
    };
    let count = accessor.count;
    let mut elements = match accessor.buffer_view {
        Some(view) => {
            let (bytes, stride) = bytes_of(view, accessor.byte_offset)?;
            // Some programs give elements without space between them a stride, whatever their size is (§3.6.2.4).
            let size = kind.width() * N;
            if let Some(stride) = stride.filter(|s| *s != size && (*s < size || s % 4 != 0)) {
                return Err(wrong(&format!(
                    "have a byteStride of {stride}, which must be a multiple of 4 and at least the {size} bytes of an element; export the file again"
                )));
            }
            layout.elements(bytes, stride, count, buffers)?.ok_or_else(outside)?
        }
        // Zeros, most of which a sparse accessor replaces.
        None if count <= ZEROS.saturating_add(buffers.size) => {
            buffers.spend(count.saturating_mul(N))?;
            let mut zeros = with_room(count)?;
            zeros.resize(count, [0.0; N]);
            zeros
        }
        None => return Err(outside()),
    };
    if let Some(sparse) = &accessor.sparse {
        let kind = sparse.indices.component_type.and_then(Kind::of);
        let kind = kind.ok_or_else(|| wrong("have sparse indices of an unknown component type"))?;
        let (bytes, _) = bytes_of(sparse.indices.buffer_view, sparse.indices.byte_offset)?;
        let places = Layout { kind, normalized: false }.elements::<1>(bytes, None, sparse.count, buffers)?;
        let (bytes, _) = bytes_of(sparse.values.buffer_view, sparse.values.byte_offset)?;
        let values = layout.elements::<N>(bytes, None, sparse.count, buffers)?;
        for ([place], value) in places.ok_or_else(outside)?.into_iter().zip(values.ok_or_else(outside)?) {
            let slot = elements.get_mut(place as usize);
            *slot.ok_or_else(|| wrong("have a sparse index that is too large"))? = value;
        }
    }
    Ok(elements)
}

/// Returns accessor `index`. `what` names its elements in error messages.
pub(super) fn accessor<'a>(
    document: &'a Document,
    index: usize,
    what: &str,
) -> Result<&'a Accessor, Problem> {
    let missing = || Problem::whole(format!("the {what} are accessor {index}, which the file does not have"));
    document.accessors.get(index).ok_or_else(missing)
}

/// How the numbers of an accessor are stored.
struct Layout {
    kind: Kind,
    normalized: bool,
}

impl Layout {
    /// Reads `count` elements, `stride` bytes apart (without space between them if `None`); `None` if `bytes`
    /// does not hold them.
    fn elements<const N: usize>(
        &self,
        bytes: &[u8],
        stride: Option<usize>,
        count: usize,
        buffers: &Buffers<'_>,
    ) -> Result<Option<Vec<[f64; N]>>, Problem> {
        let width = self.kind.width();
        let size = width * N;
        let stride = stride.unwrap_or(size);
        if count == 0 {
            return Ok(Some(Vec::new()));
        }
        let needed = stride.checked_mul(count - 1).and_then(|n| n.checked_add(size));
        if needed.is_none_or(|n| n > bytes.len()) {
            return Ok(None);
        }
        buffers.spend(count.saturating_mul(N))?;
        let mut elements = with_room(count)?;
        let number = |at: usize| self.kind.number(&bytes[at..], self.normalized);
        elements.extend((0..count).map(|i| std::array::from_fn(|k| number(i * stride + k * width))));
        Ok(Some(elements))
    }
}

/// A type of number (glTF 2.0 §3.6.2.2).
#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Kind {
    fn of(component_type: u32) -> Option<Self> {
        Some(match component_type {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn width(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// Reads one number. Normalized integers become fractions as specified in glTF 2.0 §3.11.
    fn number(self, bytes: &[u8], normalized: bool) -> f64 {
        let (value, most) = match self {
            Self::I8 => (bytes[0] as i8 as f64, 127.0),
            Self::U8 => (bytes[0] as f64, 255.0),
            Self::I16 => (i16::from_le_bytes([bytes[0], bytes[1]]) as f64, 32767.0),
            Self::U16 => (u16::from_le_bytes([bytes[0], bytes[1]]) as f64, 65535.0),
            Self::U32 => {
                (u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as f64, u32::MAX as f64)
            }
            Self::F32 => return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as f64,
        };
        if normalized { (value / most).max(-1.0) } else { value }
    }
}
