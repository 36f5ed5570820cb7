//! Stills that are small enough for a page.

use super::{OutputError, beside, keep};
use crate::image::Image;
use image::{ExtendedColorType, ImageError, codecs::jpeg::JpegEncoder};
use std::{
    io::{BufWriter, Write},
    path::Path,
};

/// 0 to 100: hair keeps its single strands, in a fifth of a PNG's bytes.
const QUALITY: u8 = 85;

/// Writes a JPEG; the file appears only when it is complete.
///
/// # Errors
/// If the folder is missing or not writable, or the disk is full; or a picture of more than 65,535 pixels along a side, or of none.
pub fn write_jpeg(path: &Path, image: &Image) -> Result<(), OutputError> {
    let mut file = beside(path)?;
    let mut out = BufWriter::new(file.as_file_mut());
    JpegEncoder::new_with_quality(&mut out, QUALITY)
        .encode(&image.rgb, image.width, image.height, ExtendedColorType::Rgb8)
        .map_err(|e| match e {
            ImageError::IoError(e) => e,
            other => std::io::Error::other(other),
        })
        .and_then(|()| out.flush())
        .map_err(|source| OutputError::File { path: path.into(), source })?;
    drop(out);
    keep(file, path)
}
