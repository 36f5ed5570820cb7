//! Writes the hair of a scene, frame by frame, as groom files.

use crate::{
    Error, Format, Strands,
    save::{format_for, holds_colors, holds_root_uvs},
    write_strands,
};
use glam::{Vec2, Vec3};
use std::path::Path;

/// All grooms of a scene as the strands of one file, one groom after the other. The static arrays are kept from
/// frame to frame.
#[derive(Clone, Debug, Default)]
pub struct FrameWriter {
    points: Vec<Vec3>,
    offsets: Vec<u32>,
    radii: Vec<f32>,
    colors: Vec<Vec3>,
    root_uvs: Vec<Vec2>,
}

/// Why a frame was not written.
#[derive(Debug, thiserror::Error)]
pub enum FrameError {
    /// The simulation has diverged.
    #[error(
        "strand {strand} is not finite at {time} s, so {path} was not written; a setting of the scene is too large"
    )]
    NotFinite {
        /// Index of the strand in the file.
        strand: usize,
        /// Time of the frame [s].
        time: f64,
        /// Path of the file.
        path: String,
    },
    /// The file cannot be written.
    #[error(transparent)]
    File(#[from] Error),
}

impl FrameWriter {
    /// Creates a writer for frames in the format of `path`. It copies radii, colors and texture coordinates from `grooms`;
    /// each frame supplies the points. Also returns one note for each of these attributes that the format supports and
    /// the writer omits.
    ///
    /// # Errors
    /// Returns an error for an extension that is not that of a groom, or for strands that the format cannot hold.
    pub fn new<'a>(
        path: &Path,
        grooms: impl Iterator<Item = Strands<'a>>,
    ) -> Result<(Self, Vec<String>), FrameError> {
        let format = Format::of(path);
        let [has_colors, has_uvs] = [holds_colors, holds_root_uvs].map(|holds| format.is_some_and(holds));
        let grooms: Vec<Strands<'a>> = grooms.collect();
        let mut offsets = vec![0];
        for groom in &grooms {
            let before = offsets.last().copied().unwrap_or(0);
            offsets.extend(groom.offsets.iter().skip(1).map(|o| o + before));
        }
        // A file has a color at every point or none at all; the same holds for texture coordinates.
        let colored = grooms.iter().filter(|g| !g.colors.is_empty()).count();
        let mapped = grooms.iter().filter(|g| !g.root_uvs.is_empty()).count();
        let parts = [(has_colors, colored, "colors"), (has_uvs, mapped, "texture coordinates")];
        let some = parts.into_iter().filter(|(has, some, _)| *has && *some > 0 && *some < grooms.len());
        let notes = some
            .map(|(_, some, what)| format!("only {some} of {} grooms have {what}; left out", grooms.len()));
        let writer = Self {
            points: Vec::new(),
            offsets,
            radii: grooms.iter().flat_map(|g| g.radii.iter().copied()).collect(),
            colors: match colored == grooms.len() {
                true => grooms.iter().flat_map(|g| g.colors.iter().copied()).collect(),
                false => Vec::new(),
            },
            root_uvs: match mapped == grooms.len() {
                true => grooms.iter().flat_map(|g| g.root_uvs.iter().copied()).collect(),
                false => Vec::new(),
            },
        };
        let notes = notes.collect();
        format_for(path, &writer.strands())?;
        Ok((writer, notes))
    }

    /// The strands with the points of the current frame.
    fn strands(&self) -> Strands<'_> {
        Strands {
            points: &self.points,
            offsets: &self.offsets,
            radii: &self.radii,
            colors: &self.colors,
            root_uvs: &self.root_uvs,
        }
    }

    /// Writes a frame: the points of all grooms [m] at `time` [s].
    ///
    /// # Errors
    /// Returns an error if a point is not finite, or an error of [`write_strands`].
    pub fn write<'a>(
        &mut self,
        path: &Path,
        time: f64,
        points: impl Iterator<Item = &'a [Vec3]>,
    ) -> Result<(), FrameError> {
        self.points.clear();
        points.for_each(|points| self.points.extend_from_slice(points));
        if let Some(point) = self.points.iter().position(|p| !p.is_finite()) {
            let strand = self.offsets.partition_point(|first| *first as usize <= point) - 1;
            return Err(FrameError::NotFinite { strand, time, path: path.display().to_string() });
        }
        write_strands(path, self.strands())?;
        Ok(())
    }
}
