//! Writes a groom to a file that is either complete or absent.

use crate::{Error, Format, Result, Strands, hair, tfx, usc};
use hairspring::groom::{DEFAULT_RADIUS, Groom};
use std::{
    io::{self, Write},
    path::Path,
};

/// Writes a groom in the format of the path's extension (`.hair`, `.tfx`, `.data`), in meters, Y up. An
/// existing file is replaced only when the new one is complete. Returns what the format could not hold, one
/// sentence each.
///
/// # Errors
/// Returns an error for another extension, for strands that the format cannot hold, or if the system cannot
/// write the file.
pub fn write_groom(path: &Path, groom: &Groom) -> Result<Vec<String>> {
    let format = write_strands(path, groom.into())?;
    let mut lost = Vec::new();
    let parts = [
        (groom.groups.iter().any(|g| *g != 0), "groups"),
        (!groom.scales.is_empty(), "per-strand multipliers"),
        (!groom.guides.is_empty(), "guide weights"),
        (!groom.roots.is_empty(), "root bindings"),
        (!groom.root_uvs.is_empty() && !holds_root_uvs(format), "texture coordinates"),
        (!groom.colors.is_empty() && !holds_colors(format), "colors"),
        (varies_along(groom) && format == Format::Tfx, "radii that vary along a strand"),
        // A reader gives the points of a .data file the default radius.
        (format == Format::Usc && groom.radii.iter().any(|r| *r != DEFAULT_RADIUS), "radii"),
    ];
    let names: Vec<&str> = parts.iter().filter(|(there, _)| *there).map(|(_, name)| *name).collect();
    if !names.is_empty() {
        lost.push(format!("a .{} file cannot hold {}; left out", format.name(), names.join(", ")));
    }
    Ok(lost)
}

/// Writes borrowed strands, such as one baked frame, in the format of the path's extension. Otherwise like
/// [`write_groom`].
///
/// # Errors
/// See [`write_groom`].
pub fn write_strands(path: &Path, strands: Strands<'_>) -> Result<Format> {
    strands.check().map_err(|reason| Error::Unwritable { path: path.to_owned(), reason })?;
    let format = format_for(path, &strands)?;
    atomically(path, |out| match format {
        Format::Hair => hair::write(out, &strands),
        Format::Tfx => tfx::write(out, &strands),
        _ => usc::write(out, &strands),
    })
    .map_err(|source| Error::Write { path: path.to_owned(), source })?;
    Ok(format)
}

/// Returns the format of a path, which must be able to hold strands with these numbers of points.
pub(crate) fn format_for(path: &Path, strands: &Strands<'_>) -> Result<Format> {
    let format =
        Format::of(path).filter(|f| Format::GROOMS.contains(f)).ok_or_else(|| Error::Unsupported {
            path: path.to_owned(),
            reason: "unknown extension; a groom is written as .hair, .tfx or .data".into(),
        })?;
    let misfit = match format {
        Format::Tfx => tfx::misfit(strands),
        Format::Hair => strands.counts().position(|n| n > 1 << 16).map(|s| {
            format!(
                "strand {s} has more than the 65,536 points that a .hair file can hold; write .data instead"
            )
        }),
        _ => None,
    };
    match misfit {
        Some(reason) => Err(Error::Unwritable { path: path.to_owned(), reason }),
        None => Ok(format),
    }
}

/// Whether a format for grooms holds a color at each point.
pub(crate) fn holds_colors(format: Format) -> bool {
    format != Format::Usc
}

/// Whether a format for grooms holds texture coordinates of each root.
pub(crate) fn holds_root_uvs(format: Format) -> bool {
    format == Format::Tfx
}

/// Whether any strand's radius varies along its points.
fn varies_along(groom: &Groom) -> bool {
    (0..groom.strand_count()).any(|s| {
        let radii = groom.radii.get(groom.range(s)).unwrap_or_default();
        radii.windows(2).any(|w| w[0] != w[1])
    })
}

/// Writes a file atomically. `write` fills a temporary file in the folder of `path`, which is written to the
/// disk and then renamed. The finished file has the permissions of the file that it replaces, or those of a new file.
///
/// # Errors
/// Returns the error of `write` or of the system. Nothing is left behind in that case.
pub fn atomically(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    hairspring_file::write_atomically(path, write)
}
