//! Reads a glTF accessor and checks every bound.

use crate::Problem;
use gltf::{Accessor, accessor::DataType};

/// The bytes of each buffer of a file.
pub(super) struct Buffers(pub(super) Vec<Vec<u8>>);

/// Reads the elements of an accessor of `N` components, with normalized integers as fractions. `what` names
/// them in error messages.
pub(super) fn components<const N: usize>(
    accessor: &Accessor<'_>,
    buffers: &Buffers,
    what: &str,
) -> Result<Vec<[f64; N]>, Problem> {
    let wrong = |why: &str| Problem::whole(format!("the {what} (accessor {}) {why}", accessor.index()));
    if accessor.sparse().is_some() {
        return Err(wrong("use sparse storage, which is not supported; export without sparse accessors"));
    }
    if accessor.dimensions().multiplicity() != N {
        return Err(wrong(&format!("should have {N} components each")));
    }
    let view = accessor.view().ok_or_else(|| wrong("have no buffer view"))?;
    let (kind, count) = (accessor.data_type(), accessor.count());
    let width = kind.size();
    let size = width * N;
    let stride = view.stride().unwrap_or(size);
    let buffer = buffers.0.get(view.buffer().index()).ok_or_else(|| wrong("have no buffer"))?;
    let end = view.offset().checked_add(view.length());
    let bytes = end.and_then(|end| buffer.get(view.offset()..end)).and_then(|b| b.get(accessor.offset()..));
    let bytes = bytes.ok_or_else(|| wrong("lie outside their buffer: the file is cut short"))?;
    if count == 0 {
        return Ok(Vec::new());
    }
    let needed = stride.checked_mul(count - 1).and_then(|n| n.checked_add(size));
    if stride < size || needed.is_none_or(|n| n > bytes.len()) {
        return Err(wrong("lie outside their buffer: the file is cut short"));
    }
    let normalized = accessor.normalized();
    Ok((0..count)
        .map(|i| std::array::from_fn(|k| component(&bytes[i * stride + k * width..], kind, normalized)))
        .collect())
}

/// Reads one number. Normalized integers become fractions as specified in glTF 2.0 §3.11.
fn component(bytes: &[u8], kind: DataType, normalized: bool) -> f64 {
    let (value, most) = match kind {
        DataType::I8 => (bytes[0] as i8 as f64, 127.0),
        DataType::U8 => (bytes[0] as f64, 255.0),
        DataType::I16 => (i16::from_le_bytes([bytes[0], bytes[1]]) as f64, 32767.0),
        DataType::U16 => (u16::from_le_bytes([bytes[0], bytes[1]]) as f64, 65535.0),
        DataType::U32 => {
            (u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as f64, u32::MAX as f64)
        }
        DataType::F32 => {
            return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as f64;
        }
    };
    if normalized { (value / most).max(-1.0) } else { value }
}
