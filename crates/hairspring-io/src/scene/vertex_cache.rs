//! `vertex_cache` of `[body]`: positions of its vertices over time.

use super::{
    Reader,
    file::{BodyFile, FileName},
    groom_file::Placement,
};
use crate::{Format, ReadOptions, Result, load, motion::MAX_POSITIONS, pc2, read_body, units};
use glam::{Affine3A, Vec3};
use hairspring::body::Body;
use hairspring_scene::VertexCache;
use std::path::{Path, PathBuf};

/// Frame rate if none is given [Hz].
const RATE: f64 = 24.0;

impl Reader<'_> {
    /// Reads the vertex cache `cache` of `body`, which the table `named` describes.
    pub(super) fn vertex_cache(
        &mut self,
        named: &BodyFile,
        cache: &FileName,
        body: &Body,
    ) -> Result<VertexCache> {
        let path = self.resolve(cache);
        let near = cache.span().start;
        let wrong = |text: String| self.wrong(near, "vertex_cache", text);
        let vertices = body.mesh.positions.len();
        // The frames of the file are in the place of its mesh before `transform`.
        let transform = named.transform.map_or(Affine3A::IDENTITY, Placement::to_affine);
        let before = transform.inverse();
        let unplaced: Vec<Vec3> = body.mesh.positions.iter().map(|p| before.transform_point3(*p)).collect();
        let (frames, rate) = if Format::of(&path) == Some(Format::Pc2) {
            let data = self.named(load::bytes_of(&path), cache, "vertex cache")?;
            let read = pc2::parse(&data).map_err(|p| p.in_file(&path))?;
            // A file without a unit has that of the mesh, which may have been guessed.
            let scale = named.scale.or_else(|| scale_of(read.samples.first()?, &unplaced));
            let turn = units::turn_of(named.up.unwrap_or(crate::Axis::Y));
            let place = |p: Vec3| turn * (p * scale.unwrap_or(1.0));
            let frames = read.samples.into_iter().map(|s| s.into_iter().map(place).collect()).collect();
            (frames, 1.0 / f64::from(read.frames_per_sample))
        } else {
            let files = numbered(&path).ok_or_else(|| {
                wrong("expected a .pc2 file or numbered meshes, such as body.####.obj".into())
            })?;
            if files.is_empty() {
                return Err(wrong(format!("there are no files {}", path.display())));
            }
            if let Some((before, missing)) = gap(&files) {
                return Err(wrong(format!(
                    "number {missing} is missing after {}; export it, or number the files without gaps",
                    before.display()
                )));
            }
            // The unit is that of the body, not one guessed for each file.
            let options = ReadOptions { scale: Some(1.0), up: named.up };
            let mut scale = named.scale;
            let mut frames: Vec<Vec<Vec3>> = Vec::with_capacity(files.len());
            for (_, file) in &files {
                let mut read = self.named(read_body(file, &options), cache, "vertex cache")?.value.body.mesh;
                if read.positions.len() != vertices {
                    let text = format!(
                        "{} has {} vertices, and the body has {vertices}: export the meshes without changes of topology",
                        file.display(),
                        read.positions.len()
                    );
                    return Err(wrong(text));
                }
                if frames.len().saturating_mul(vertices) > MAX_POSITIONS {
                    return Err(wrong(format!(
                        "the files hold more than {MAX_POSITIONS} positions; shorten the motion"
                    )));
                }
                let scale = *scale.get_or_insert_with(|| scale_of(&read.positions, &unplaced).unwrap_or(1.0));
                read.positions.iter_mut().for_each(|p| *p *= scale);
                frames.push(read.positions);
            }
            (frames, 1.0)
        };
        if let Some(frame) = frames.iter().position(|frame| frame.len() != vertices) {
            let text = format!(
                "sample {frame} has {} points, and the body has {vertices} vertices: export both from the same mesh",
                frames[frame].len()
            );
            return Err(wrong(text));
        }
        let frames = frames
            .into_iter()
            .map(|frame| frame.into_iter().map(|p| transform.transform_point3(p)).collect())
            .collect::<Vec<Vec<Vec3>>>();
        let rate = rate * named.vertex_rate.unwrap_or(RATE);
        let note = format!("{} frames at {rate} Hz move the body's vertices", frames.len());
        self.note(&path, vec![note]);
        Ok(VertexCache { rate, frames })
    }
}

/// The ratio of sizes of the same points in the unit of the body and in that of a file.
fn scale_of(file: &[Vec3], body: &[Vec3]) -> Option<f32> {
    let size = |points: &[Vec3]| {
        let lo = points.iter().fold(Vec3::INFINITY, |lo, p| lo.min(*p));
        let hi = points.iter().fold(Vec3::NEG_INFINITY, |hi, p| hi.max(*p));
        (hi - lo).length()
    };
    // Poses differ in size; units differ by at least a factor of two.
    let ratio = size(body) / size(file);
    [1.0, 0.1, 0.01, 0.001, 0.0254].into_iter().find(|unit| (ratio / unit).ln().abs() < 0.5)
}

/// The existing files that a name with `#` signs stands for, in the order of their numbers, with these; `None`
/// without `#` signs.
fn numbered(path: &Path) -> Option<Vec<(u64, PathBuf)>> {
    let name = path.file_name()?.to_str()?;
    let (first, last) = (name.find('#')?, name.rfind('#')?);
    let (prefix, suffix) = (&name[..first], &name[last + 1..]);
    let folder = path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut found: Vec<(u64, PathBuf)> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let digits = name.strip_prefix(prefix)?.strip_suffix(suffix)?;
            let all = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
            Some((digits.parse().ok().filter(|_| all)?, entry.path()))
        })
        .collect();
    found.sort();
    Some(found)
}

/// The first number that is missing between those of `files`, whose distance is the smallest between two of them, and
/// the file before it.
fn gap(files: &[(u64, PathBuf)]) -> Option<(&Path, u64)> {
    let distances = files.windows(2).map(|pair| pair[1].0 - pair[0].0);
    let step = distances.filter(|distance| *distance > 0).min()?;
    let pair = files.windows(2).find(|pair| pair[1].0 - pair[0].0 > step)?;
    Some((&pair[0].1, pair[0].0 + step))
}
