//! Point caches `.pc2`: positions of a fixed number of points in each sample, as Blender, 3ds Max and Maya read and write
//! them.
//!
//! ```text
//! "POINTCACHE2\0"  i32 version = 1  i32 points  f32 first frame  f32 frames per sample  i32 samples
//! f32 x y z for each point of each sample, little endian
//! ```

use crate::{
    Place, Problem,
    bytes::Bytes,
    external::{CacheDescription, CacheWriter},
    motion::check_positions,
};
use bytemuck::{bytes_of, cast_slice};
use glam::Vec3;
use hairspring_file::PendingFile;
use std::{
    io::{BufWriter, Write},
    path::Path,
};

const MAGIC: &[u8; 12] = b"POINTCACHE2\0";

/// The samples of a point cache.
///
/// ```
/// use hairspring_io::pc2;
///
/// // One sample of one point.
/// let mut file = b"POINTCACHE2\0".to_vec();
/// file.extend([1i32, 1].map(i32::to_le_bytes).concat());
/// file.extend([0f32, 1.0].map(f32::to_le_bytes).concat());
/// file.extend(1i32.to_le_bytes());
/// file.extend([0.5f32, 0.0, 0.0].map(f32::to_le_bytes).concat());
/// assert_eq!(pc2::parse(&file)?.samples[0][0].x, 0.5);
/// # Ok::<(), hairspring_io::Problem>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCache {
    /// Frame number of the first sample.
    pub first_frame: f32,
    /// Frames from one sample to the next, above 0.
    pub frames_per_sample: f32,
    /// Positions [file units]; shape `[samples][points]`.
    pub samples: Vec<Vec<Vec3>>,
}

/// Reads a point cache, in its own units.
///
/// # Errors
/// Returns an error for another version, counts below zero, samples that the file is too short for, no samples, or a
/// position that is not finite.
pub fn parse(data: &[u8]) -> Result<PointCache, Problem> {
    let mut bytes = Bytes::new(data);
    if bytes.take(MAGIC.len(), "the header")? != MAGIC {
        return Err(Problem::new(
            Place::Byte(0),
            "the file does not begin with POINTCACHE2, so it is no .pc2 file",
        ));
    }
    let wrong = |at: usize, text: String| Problem::new(Place::Byte(at), text);
    let version: i32 = bytes.value("the version")?;
    if version != 1 {
        return Err(wrong(12, format!("version {version} is not supported; version 1 is")));
    }
    let points: i32 = bytes.value("the number of points")?;
    let first_frame: f32 = bytes.value("the first frame")?;
    let frames_per_sample: f32 = bytes.value("the frames per sample")?;
    let samples: i32 = bytes.value("the number of samples")?;
    let count =
        |n: i32, at: usize| usize::try_from(n).map_err(|_| wrong(at, format!("the count {n} is below zero")));
    let (points, samples) = (count(points, 16)?, count(samples, 28)?);
    if !(frames_per_sample.is_finite() && frames_per_sample > 0.0 && first_frame.is_finite()) {
        return Err(wrong(20, "the first frame or the frames per sample are not numbers above 0".into()));
    }
    if points == 0 && samples > 0 {
        return Err(wrong(16, "the file has samples of no points".into()));
    }
    // The samples grow only as far as the file goes.
    let mut read = Vec::new();
    for _ in 0..samples {
        read.push(bytes.array::<Vec3>(points, "a sample")?);
    }
    if bytes.remaining() > 0 {
        let text = format!("{} bytes are left after the last of {samples} samples", bytes.remaining());
        return Err(wrong(bytes.at(), text));
    }
    check_positions(&read)?;
    Ok(PointCache { first_frame, frames_per_sample, samples: read })
}

/// A point cache that is being written.
pub(crate) struct Writer {
    out: BufWriter<PendingFile>,
    points: usize,
}

impl Writer {
    /// Begins a file with the points of all grooms.
    pub(crate) fn create(path: &Path, description: &CacheDescription) -> Result<Self, String> {
        let points: usize = description.grooms.iter().map(|(_, groom)| groom.point_count()).sum();
        let narrow =
            |n: usize| i32::try_from(n).map_err(|_| format!("{n} points are too many for a .pc2 file"));
        let (count, samples) = (narrow(points)?, narrow(description.frames as usize)?);
        let create = || {
            let mut out = BufWriter::new(PendingFile::create(path)?);
            out.write_all(MAGIC)?;
            out.write_all(cast_slice(&[1, count]))?;
            out.write_all(cast_slice(&[
                description.first_frame as f32,
                1.0 / description.per_frame.max(1) as f32,
            ]))?;
            out.write_all(bytes_of(&samples))?;
            Ok(out)
        };
        create().map(|out| Self { out, points }).map_err(|e: std::io::Error| e.to_string())
    }
}

impl CacheWriter for Writer {
    fn frame(&mut self, frame: f64, points: &[Vec3], _velocities: &[Vec3]) -> Result<(), String> {
        if points.len() != self.points {
            return Err(format!("frame {frame} has {} points instead of {}", points.len(), self.points));
        }
        self.out.write_all(cast_slice(points)).map_err(|e| e.to_string())
    }

    fn finish(self: Box<Self>) -> Result<(), String> {
        let pending = self.out.into_inner().map_err(|e| e.to_string())?;
        pending.commit().map_err(|e| e.to_string())
    }
}
