//! Frames for compositing, as OpenEXR files.

use super::{OutputError, beside, keep};
use crate::linear::{GeometryImage, LinearImage};
use exr::{
    image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, write::WritableImage},
    meta::{attribute::Chromaticities, header::LayerAttributes},
    prelude::f16,
};
use std::{
    io::{Cursor, Write},
    path::Path,
};

/// The channels of an EXR file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// Color and alpha.
    pub color: LinearImage,
    /// Depth and motion.
    pub geometry: GeometryImage,
}

/// Writes an OpenEXR file. The file appears only when it is complete.
///
/// | channel | type | meaning |
/// | --- | --- | --- |
/// | `R`, `G`, `B` | half | linear light with Rec. 709 primaries, multiplied with alpha; no tone curve |
/// | `A` | half | coverage, 0 to 1 |
/// | `Z` | float | distance along the camera's axis [m]; 1e10 where nothing is visible |
/// | `backward.u`, `backward.v` | float | displacement to the place in the previous frame [pixels]: to the right, and upward |
///
/// # Errors
/// Returns an error if the folder is missing or not writable, or if the disk is full.
pub fn write_exr(path: &Path, layers: &Layers) -> Result<(), OutputError> {
    let mut bytes = Cursor::new(Vec::new());
    let mut file = beside(path)?;
    image(layers)
        .write()
        .to_buffered(&mut bytes)
        .map_err(|e| match e {
            exr::error::Error::Io(e) => e,
            other => std::io::Error::other(other),
        })
        .and_then(|()| file.write_all(bytes.get_ref()))
        .map_err(|source| OutputError::File { path: path.into(), source })?;
    keep(file, path)
}

fn image(layers: &Layers) -> Image<Layer<AnyChannels<FlatSamples>>> {
    let Layers { color, geometry } = layers;
    let half = |name: &str, k: usize| {
        let samples = color.rgba.iter().map(|p| f16::from_f32(p[k])).collect();
        AnyChannel::new(name, FlatSamples::F16(samples))
    };
    let motion = |name: &str, k: usize| {
        // Zero has no sign.
        let samples = geometry.motion.iter().map(|m| 0.0 - m[k]).collect();
        AnyChannel::new(name, FlatSamples::F32(samples))
    };
    let depth = AnyChannel::new("Z", FlatSamples::F32(geometry.depth.clone()));
    let channels = [
        half("R", 0),
        half("G", 1),
        half("B", 2),
        half("A", 3),
        depth,
        motion("backward.u", 0),
        motion("backward.v", 1),
    ];
    let size = (color.width as usize, color.height as usize);
    let attributes =
        LayerAttributes { software_name: Some("Hairspring".into()), ..LayerAttributes::default() };
    let layer = Layer::new(
        size,
        attributes,
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels.into_iter().collect()),
    );
    let mut image = Image::from_layer(layer);
    // ITU-R BT.709.
    image.attributes.chromaticities = Some(Chromaticities {
        red: (0.64, 0.33).into(),
        green: (0.30, 0.60).into(),
        blue: (0.15, 0.06).into(),
        white: (0.3127, 0.3290).into(),
    });
    image
}
