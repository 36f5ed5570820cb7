//! Stills and numbered sequences of stills.

use super::{OutputError, beside, keep};
use crate::image::Image;
use std::{
    io::{BufWriter, Write},
    path::{Path, PathBuf},
};

/// Writes an 8-bit sRGB PNG, with alpha if the picture has it. The file appears only when it is complete.
///
/// # Errors
/// Returns an error if the folder is missing or not writable, or if the disk is full.
pub fn write_png(path: &Path, image: &Image) -> Result<(), OutputError> {
    let mut file = beside(path)?;
    let mut out = BufWriter::new(&mut file);
    encode_png(&mut out, image)
        .and_then(|()| out.flush())
        .map_err(|source| OutputError::File { path: path.into(), source })?;
    drop(out);
    keep(file, path)
}

/// Writes an 8-bit sRGB PNG to any writer, such as a `Vec`.
///
/// # Errors
/// Returns the error of `out`, or an error if the width or height is 0.
pub fn encode_png(out: impl Write, image: &Image) -> std::io::Result<()> {
    let mut encoder = png::Encoder::new(out, image.width, image.height);
    let opaque = image.alpha.is_empty();
    encoder.set_color(if opaque { png::ColorType::Rgb } else { png::ColorType::Rgba });
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::Fast);
    let encoded = encoder.write_header().and_then(|mut writer| {
        if opaque {
            writer.write_image_data(&image.rgb)?;
        } else {
            let pixels = image.rgb.chunks_exact(3).zip(&image.alpha);
            let rgba: Vec<u8> = pixels.flat_map(|(rgb, a)| [rgb[0], rgb[1], rgb[2], *a]).collect();
            writer.write_image_data(&rgba)?;
        }
        writer.finish()
    });
    encoded.map_err(|e| match e {
        png::EncodingError::IoError(e) => e,
        other => std::io::Error::other(other),
    })
}

/// Reads an 8-bit PNG with RGB or RGBA.
///
/// # Errors
/// Returns an error if the file cannot be read, or is another kind of picture.
pub fn read_png(path: &Path) -> Result<Image, OutputError> {
    let file = std::fs::File::open(path).map_err(|source| OutputError::File { path: path.into(), source })?;
    let wrong = |why: String| OutputError::Picture { path: path.into(), why };
    // The decoder's own limit of 64 MiB is enough for any picture of ours.
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(file)).read_info().map_err(|e| wrong(e.to_string()))?;
    let size = reader.output_buffer_size().ok_or_else(|| wrong("too large".into()))?;
    let mut pixels = vec![0; size];
    let info = reader.next_frame(&mut pixels).map_err(|e| wrong(e.to_string()))?;
    let known = matches!(info.color_type, png::ColorType::Rgb | png::ColorType::Rgba);
    if !known || info.bit_depth != png::BitDepth::Eight {
        return Err(wrong(format!("it is {:?} with {:?} bits", info.color_type, info.bit_depth)));
    }
    let mut rgb = pixels;
    rgb.truncate(info.buffer_size());
    let mut alpha = Vec::new();
    if info.color_type == png::ColorType::Rgba {
        alpha = rgb.chunks_exact(4).map(|p| p[3]).collect();
        rgb = rgb.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    }
    Ok(Image { width: info.width, height: info.height, rgb, alpha })
}

/// Returns the path of frame `number` of a sequence. The last run of `#` in the file name is replaced by the
/// number, with at least as many digits (`frame.####.png` → `frame.0001.png`). Returns `None` if the name has
/// no `#` and so names a single file.
pub fn sequence_path(pattern: &Path, number: u32) -> Option<PathBuf> {
    let name = pattern.file_name()?.to_str()?;
    let end = name.rfind('#')? + 1;
    let start = name[..end].trim_end_matches('#').len();
    let digits = format!("{number:0width$}", width = end - start);
    Some(pattern.with_file_name(format!("{}{digits}{}", &name[..start], &name[end..])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frame_number_fills_the_last_run_of_number_signs() {
        let path = |p: &str, n| sequence_path(Path::new(p), n).map(|p| p.to_string_lossy().into_owned());
        assert_eq!(path("out/frame.####.png", 7).as_deref(), Some("out/frame.0007.png"));
        assert_eq!(path("a##b#.png", 123).as_deref(), Some("a##b123.png"));
        assert_eq!(path("##/still.png", 1), None);
    }
}
