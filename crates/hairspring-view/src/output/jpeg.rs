//! Stills that are small enough for a page.

use super::{OutputError, beside, keep};
use crate::image::Image;
use jpeg_encoder::{ColorType, Encoder, EncodingError};
use std::{io::BufWriter, path::Path};

/// 0 to 100: hair keeps its single strands, in a fifth of a PNG's bytes.
const QUALITY: u8 = 85;

/// Writes a JPEG; the file appears only when it is complete.
///
/// # Errors
/// If the folder is missing or not writable, or the disk is full; or a picture of more than 65,535 pixels along a side, or of none.
pub fn write_jpeg(path: &Path, image: &Image) -> Result<(), OutputError> {
    let mut file = beside(path)?;
    let failed = |e: EncodingError| OutputError::File {
        path: path.into(),
        source: match e {
            EncodingError::IoError(e) => e,
            other => std::io::Error::other(other),
        },
    };
    let side = |n: u32| u16::try_from(n).unwrap_or(0);
    Encoder::new(BufWriter::new(file.as_file_mut()), QUALITY)
        .encode(&image.rgb, side(image.width), side(image.height), ColorType::Rgb)
        .map_err(failed)?;
    keep(file, path)
}
