//! Reader and writer for TressFX `.tfx` grooms, versions 3.0 and 4.0 (AMD TressFX, `TressFXFileFormat.h` of
//! branches 3.1.1 and 4.1): a header of offsets, then strands that all have the same number of points. Files of
//! versions 1 and 2 are text (`tfx_text.rs`).

use crate::{
    Place, Problem,
    bytes::Bytes,
    strands::{Read, Strands},
    tfx_text,
    units::{Axis, FileUnits},
};
use bytemuck::{Pod, Zeroable, bytes_of, cast_slice};
use glam::{Vec2, Vec4};
use hairspring::groom::{DEFAULT_RADIUS, Groom};
use std::io::{self, Write};

/// First reserved word of our own files ("HSPR"): meters, Y up, true radii.
const MARK: u32 = u32::from_le_bytes(*b"HSPR");

/// Zeros after the last array that align the end of a file, and are fewer than this.
const PADDING: usize = 16;

/// Header of version 4.0, 160 bytes. An offset of 0 means that the array is absent.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Header4 {
    version: f32,
    strands: u32,
    points_per_strand: u32,
    /// float4 per point: position, inverse mass.
    positions: u32,
    /// float2 per strand.
    strand_uvs: u32,
    /// float2 per point.
    point_uvs: u32,
    /// float per strand: diameter.
    thickness: u32,
    /// float4 per point.
    colors: u32,
    reserved: [u32; 32],
}

/// Header of version 3.0, 296 bytes.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Header3 {
    version: f32,
    strands: u32,
    points_per_strand: u32,
    follow_per_guide: u32,
    both_ends_fixed: u32,
    reserved_1: [u32; 31],
    /// float3 per point.
    positions: u32,
    thickness: u32,
    strand_uvs: u32,
    colors: u32,
    guides: u32,
    point_uvs: u32,
    reserved_2: [u32; 32],
}

/// Positions of the arrays, for either version.
struct Layout {
    /// Size of the header [bytes].
    header: usize,
    strands: usize,
    points_per_strand: usize,
    positions: usize,
    /// Floats per position: 3 or 4.
    width: usize,
    strand_uvs: u32,
    point_uvs: u32,
    thickness: u32,
    colors: u32,
    /// Whether the file has a table of guides, whose length the header does not name.
    has_guide_table: bool,
    ours: bool,
    notes: Vec<String>,
}

impl Layout {
    /// Checks that no array begins inside of the header. Only the positions are required.
    fn check_offsets(&self) -> Result<(), Problem> {
        let arrays = [
            ("positions", self.positions, self.strands > 0),
            ("strand texture coordinates", self.strand_uvs as usize, false),
            ("point texture coordinates", self.point_uvs as usize, false),
            ("thicknesses", self.thickness as usize, false),
            ("colors", self.colors as usize, false),
        ];
        let inside = |(_, offset, required): &&(&str, usize, bool)| {
            *offset < self.header && (*offset > 0 || *required)
        };
        match arrays.iter().find(inside) {
            Some((name, offset, _)) => Err(Problem::new(
                Place::Byte(0),
                format!(
                    "the header places the {name} at byte {offset}, inside of its own {} bytes; export the file again",
                    self.header
                ),
            )),
            None => Ok(()),
        }
    }
}

/// Reads a `.tfx` file of version 1 to 4, in its own units.
///
/// # Errors
/// Returns an error for another version, offsets outside the file, or a truncated file.
pub fn parse(data: &[u8]) -> Result<Groom, Problem> {
    read(data).map(Read::in_file_units)
}

pub(crate) fn read(data: &[u8]) -> Result<Read, Problem> {
    if tfx_text::is_text(data) {
        return tfx_text::read(data);
    }
    let mut bytes = Bytes::new(data);
    let layout = layout(&mut bytes)?;
    let Layout { strands, points_per_strand, .. } = layout;
    let points =
        strands.checked_mul(points_per_strand).filter(|n| u32::try_from(*n).is_ok()).ok_or_else(|| {
            let text =
                format!("{strands} strands of {points_per_strand} points are more than 4 billion points");
            Problem::limit(Place::Byte(4), text)
        })?;
    if points_per_strand == 0 && strands > 0 {
        return Err(Problem::new(
            Place::Byte(8),
            format!("the header names {strands} strands without points"),
        ));
    }
    let mut groom = Groom::default();
    layout.check_offsets()?;
    bytes.seek(layout.positions, "the array of positions")?;
    let mut notes = layout.notes;
    groom.points = match layout.width {
        3 => bytes.array(points, "the positions")?,
        _ => {
            let positions: Vec<Vec4> = bytes.array(points, "the positions")?;
            notes.extend(fixed_points(&positions, points_per_strand));
            positions.iter().map(|p| p.truncate()).collect()
        }
    };
    let mut end = bytes.at();
    groom.offsets = (0..=strands).map(|s| (s * points_per_strand) as u32).collect();
    if layout.strand_uvs != 0 {
        bytes.seek(layout.strand_uvs as usize, "the array of strand texture coordinates")?;
        groom.root_uvs = bytes.array(strands, "the strand texture coordinates")?;
        end = end.max(bytes.at());
    }
    if layout.colors != 0 {
        bytes.seek(layout.colors as usize, "the array of colors")?;
        let colors: Vec<Vec4> = bytes.array(points, "the colors")?;
        groom.colors = colors.iter().map(|c| c.truncate()).collect();
        end = end.max(bytes.at());
    }
    let radii = if layout.thickness != 0 {
        bytes.seek(layout.thickness as usize, "the array of thicknesses")?;
        let diameters: Vec<f32> = bytes.array(strands, "the thicknesses")?;
        end = end.max(bytes.at());
        Some(diameters.iter().flat_map(|d| std::iter::repeat_n(d * 0.5, points_per_strand)).collect())
    } else {
        None
    };
    if layout.point_uvs != 0 {
        end = end.max((layout.point_uvs as usize).saturating_add(points * size_of::<Vec2>()));
    }
    let rest = data.get(end..).unwrap_or_default();
    let extra = rest.len();
    // A few zeros align the end of the file.
    let is_padding = extra < PADDING && rest.iter().all(|byte| *byte == 0);
    if !is_padding && !layout.has_guide_table {
        notes.push(format!(
            "{extra} bytes after the last array are not used; the header names fewer strands or arrays than the file holds"
        ));
    }
    let units = FileUnits { scale: layout.ours.then_some(1.0), up: Some(Axis::Y) };
    Ok(Read { groom, radii, true_radii: layout.ours, units, notes })
}

/// Describes points with an inverse mass of 0, which fixes them. It is 0 at the first two points of each strand, which
/// the scalp moves.
fn fixed_points(positions: &[Vec4], points_per_strand: usize) -> Option<String> {
    let strands = positions.chunks_exact(points_per_strand.max(1));
    let is_fixed = |i: usize, p: &Vec4| i >= 2 && p.w == 0.0;
    let of_strand = |strand: &[Vec4]| strand.iter().enumerate().filter(|(i, p)| is_fixed(*i, p)).count();
    let fixed: usize = strands.clone().map(of_strand).sum();
    let tips = strands.filter_map(<[Vec4]>::last).filter(|p| is_fixed(points_per_strand - 1, p)).count();
    match fixed {
        0 => None,
        n if n == tips => Some(format!("{n} of its tips are marked as fixed; they are simulated as free")),
        n => Some(format!(
            "{n} points after the first two of their strands have an inverse mass of 0, which marks them as fixed; they are simulated as free"
        )),
    }
}

fn layout(bytes: &mut Bytes<'_>) -> Result<Layout, Problem> {
    let version: f32 = bytes.value("the version")?;
    bytes.seek(0, "the header")?;
    let mut notes = Vec::new();
    match version as u32 {
        3 => {
            let h: Header3 = bytes.value("the header of version 3")?;
            if h.follow_per_guide > 0 {
                notes.push(format!(
                    "it asks for {} follow hairs around each strand; the file holds only the guides",
                    h.follow_per_guide
                ));
            }
            if h.guides != 0 {
                notes.push("its table of guides is not used; guides are selected again".into());
            }
            if h.both_ends_fixed != 0 {
                notes.push("its tips are marked as fixed; they are simulated as free".into());
            }
            Ok(Layout {
                header: size_of::<Header3>(),
                strands: h.strands as usize,
                points_per_strand: h.points_per_strand as usize,
                positions: h.positions as usize,
                width: 3,
                strand_uvs: h.strand_uvs,
                point_uvs: h.point_uvs,
                has_guide_table: h.guides != 0,
                thickness: h.thickness,
                colors: h.colors,
                ours: false,
                notes,
            })
        }
        4 => {
            let h: Header4 = bytes.value("the header of version 4")?;
            Ok(Layout {
                header: size_of::<Header4>(),
                strands: h.strands as usize,
                points_per_strand: h.points_per_strand as usize,
                positions: h.positions as usize,
                width: 4,
                strand_uvs: h.strand_uvs,
                point_uvs: h.point_uvs,
                has_guide_table: false,
                thickness: h.thickness,
                colors: h.colors,
                ours: h.reserved[0] == MARK,
                notes,
            })
        }
        _ => {
            let text = match (1.0..100.0).contains(&version) {
                true => format!(".tfx version {version} is not supported; export the file as version 3 or 4"),
                false => {
                    "a .tfx file begins with its version; this one does not, so it is no .tfx file".into()
                }
            };
            Err(Problem::new(Place::Byte(0), text))
        }
    }
}

/// Writes strands as a `.tfx` file of version 4 in meters, Y up. All strands must have the same number of
/// points.
pub(crate) fn write(out: &mut dyn Write, strands: &Strands<'_>) -> io::Result<()> {
    let count = strands.strand_count();
    let per_strand = strands.counts().next().unwrap_or(0);
    let points = strands.points.len();
    let radius = |s: usize| strands.radii.get(s * per_strand).copied().unwrap_or(DEFAULT_RADIUS);
    let mut at = size_of::<Header4>();
    let mut place = |present: bool, bytes: usize| {
        let here = if present { at as u32 } else { 0 };
        at += if present { bytes } else { 0 };
        here
    };
    let mut header = Header4 {
        version: 4.0,
        strands: count as u32,
        points_per_strand: per_strand as u32,
        positions: place(true, points * size_of::<Vec4>()),
        strand_uvs: place(!strands.root_uvs.is_empty(), count * 8),
        point_uvs: 0,
        thickness: place(count > 0, count.next_multiple_of(2) * 4),
        colors: place(!strands.colors.is_empty(), points * size_of::<Vec4>()),
        reserved: [0; 32],
    };
    header.reserved[0] = MARK;
    out.write_all(bytes_of(&header))?;
    for w in strands.offsets.windows(2) {
        // Inverse mass. It is 0 for the first two points, which the scalp moves.
        let run = strands.points[w[0] as usize..w[1] as usize].iter().enumerate();
        let run: Vec<Vec4> = run.map(|(i, p)| p.extend(if i < 2 { 0.0 } else { 1.0 })).collect();
        out.write_all(cast_slice(&run))?;
    }
    out.write_all(cast_slice(strands.root_uvs))?;
    let mut diameters: Vec<f32> = (0..count).map(|s| radius(s) * 2.0).collect();
    diameters.resize(count.next_multiple_of(2), 0.0);
    out.write_all(cast_slice(&diameters))?;
    let colors: Vec<Vec4> = strands.colors.iter().map(|c| c.extend(1.0)).collect();
    out.write_all(cast_slice(&colors))
}

/// Returns why these strands do not fit into a `.tfx` file, or `None` if they do.
pub(crate) fn misfit(strands: &Strands<'_>) -> Option<String> {
    let first = strands.counts().next()?;
    let other = strands.counts().position(|n| n != first)?;
    let n = strands.counts().nth(other).unwrap_or_default();
    Some(format!(
        "a .tfx file needs the same number of points in every strand, but strand 0 has {first} and strand {other} has {n}; write .hair or .data instead"
    ))
}
