//! Stills that are small enough for a web page.

use super::{OutputError, beside, keep};
use crate::image::Image;
use image::{ExtendedColorType, ImageError, codecs::jpeg::JpegEncoder};
use std::{
    io::{BufWriter, Write},
    path::Path,
};

/// JPEG quality, 0 to 100. At this value single strands stay visible, in a fifth of the bytes of a PNG.
const QUALITY: u8 = 85;

/// Writes a JPEG. The file appears only when it is complete.
///
/// # Errors
/// Returns an error if the folder is missing or not writable, if the disk is full, or if a side of the
/// picture is 0 or more than 65,535 pixels.
pub fn write_jpeg(path: &Path, image: &Image) -> Result<(), OutputError> {
    let mut file = beside(path)?;
    let mut out = BufWriter::new(&mut file);
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
