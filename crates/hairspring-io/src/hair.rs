//! Reader and writer for the `.hair` format of Cem Yuksel (cemyuksel.com, "HAIR Model Files"): a 128-byte
//! header, then the arrays that its flags name, each for all strands.

use crate::{
    Place, Problem,
    bytes::Bytes,
    strands::{Read, Strands, gather_offsets},
    units::{Axis, FileUnits},
};
use bytemuck::{Pod, Zeroable, bytes_of, cast_slice};
use glam::Vec3;
use hairspring::groom::{DEFAULT_RADIUS, Groom};
use std::io::{self, Write};

const HAS_SEGMENTS: u32 = 1;
const HAS_POINTS: u32 = 2;
const HAS_THICKNESS: u32 = 4;
const HAS_TRANSPARENCY: u32 = 8;
const HAS_COLORS: u32 = 16;

/// What our writer puts into the header's free text. A file that begins with it is in meters, Y up, with true
/// radii.
const MARK: &[u8] = b"Hairspring: metres, Y up";

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Header {
    magic: [u8; 4],
    strands: u32,
    points: u32,
    flags: u32,
    /// Number of segments of every strand if there is no array of them.
    segments: u32,
    /// Diameter of all points if there is no array of them.
    thickness: f32,
    /// Transparency of all points if there is no array of them.
    transparency: f32,
    /// Linear RGB of all points if there is no array of them.
    color: [f32; 3],
    info: [u8; 88],
}

impl Header {
    /// Says which defaults of a file of another program are not used. Those that are 0 are not set.
    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let mut note = |array: u32, name: &str, values: &[f32], why_not: Option<&str>| {
            if self.flags & array != 0 || values.iter().all(|x| *x == 0.0) {
                return;
            }
            let listed: Vec<String> = values.iter().map(f32::to_string).collect();
            let why_not = if values.iter().all(|x| x.is_finite() && *x >= 0.0) {
                why_not
            } else {
                Some("it must be finite and not below 0")
            };
            let not_used =
                |why| format!("the header's default {name} of {} is not used; {why}", listed.join(", "));
            notes.extend(why_not.map(not_used));
        };
        note(HAS_THICKNESS, "thickness", &[self.thickness], None);
        note(
            HAS_TRANSPARENCY,
            "transparency",
            &[self.transparency],
            Some("it follows from the fiber's width"),
        );
        note(HAS_COLORS, "color", &self.color, Some("set the color in [groom.look]"));
        notes
    }
}

/// Reads a `.hair` file, in its own units.
///
/// # Errors
/// Returns an error for a wrong magic, counts that disagree, or a truncated file.
pub fn parse(data: &[u8]) -> Result<Groom, Problem> {
    read(data, None).map(Read::in_file_units)
}

/// Like [`parse`], with what the file says about its units. `up` is the axis that the caller knows to point up.
pub(crate) fn read(data: &[u8], up: Option<Axis>) -> Result<Read, Problem> {
    let mut bytes = Bytes::new(data);
    let header: Header = bytes.value("the header")?;
    if &header.magic != b"HAIR" {
        return Err(Problem::new(
            Place::Byte(0),
            "a .hair file begins with the letters HAIR; this one does not",
        ));
    }
    if header.flags & HAS_POINTS == 0 {
        return Err(Problem::new(
            Place::Byte(12),
            "the header says that there are no points; there is nothing to read",
        ));
    }
    let (strands, points) = (header.strands as usize, header.points as usize);
    let offsets = if header.flags & HAS_SEGMENTS != 0 {
        let at = bytes.at();
        let segments: Vec<u16> = bytes.array(strands, "the segment counts")?;
        gather_offsets(segments.iter().map(|s| *s as usize + 1), points, at)?
    } else {
        let per_strand = header.segments as usize + 1;
        // Every strand has at least one point, so `points` bounds `strands`, and the file's size bounds
        // `points`.
        if strands.checked_mul(per_strand) != Some(points) || points > bytes.remaining() / size_of::<Vec3>() {
            let text = format!(
                "{strands} strands of {per_strand} points (the header's default) do not give the {points} points of the header, or the file is cut short"
            );
            return Err(Problem::new(Place::Byte(4), text));
        }
        gather_offsets(std::iter::repeat_n(per_strand, strands), points, 4)?
    };
    let mut groom = Groom { offsets, ..Groom::default() };
    groom.points = bytes.array(points, "the points")?;
    let ours = header.info.starts_with(MARK);
    let mut notes = Vec::new();
    let thickness: Option<Vec<f32>> = match header.flags & HAS_THICKNESS {
        0 => None,
        _ => Some(bytes.array(points, "the thicknesses")?),
    };
    if header.flags & HAS_TRANSPARENCY != 0 {
        let _: Vec<f32> = bytes.array(points, "the transparencies")?;
        notes.push("the transparency of each point is not used; it follows from the fiber's width".into());
    }
    if header.flags & HAS_COLORS != 0 {
        groom.colors = bytes.array(points, "the colors")?;
    }
    if bytes.remaining() > 0 {
        notes.push(format!(
            "{} bytes after the last array are not used; the header names fewer points or arrays than the file holds",
            bytes.remaining()
        ));
    }
    // Thickness is a diameter. In most files it is a line width for display, which `Read::finish` finds by its size.
    let radii = match thickness {
        Some(diameters) => Some(diameters.iter().map(|d| d * 0.5).collect()),
        None if ours || header.thickness.is_finite() && header.thickness > 0.0 => {
            Some(vec![header.thickness * 0.5; points])
        }
        None => None,
    };
    if !ours {
        notes.extend(header.notes());
    }
    let units = if ours {
        FileUnits { scale: Some(1.0), up: Some(Axis::Y) }
    } else {
        if up.is_none() {
            notes.push("read as Z up, the convention of .hair models; set `up` to change it".into());
        }
        FileUnits { scale: None, up: Some(Axis::Z) }
    };
    Ok(Read { groom, radii, true_radii: ours, units, notes })
}

/// Writes strands as a `.hair` file in meters, Y up.
pub(crate) fn write(out: &mut dyn Write, strands: &Strands<'_>) -> io::Result<()> {
    let counts: Vec<u16> = strands.counts().map(|n| (n - 1) as u16).collect();
    let uniform = counts.windows(2).all(|w| w[0] == w[1]);
    let radius = strands.radii.first().copied().unwrap_or(DEFAULT_RADIUS);
    let one_radius = strands.radii.iter().all(|r| *r == radius);
    let mut flags = HAS_POINTS;
    for (flag, on) in
        [(HAS_SEGMENTS, !uniform), (HAS_THICKNESS, !one_radius), (HAS_COLORS, !strands.colors.is_empty())]
    {
        if on {
            flags |= flag;
        }
    }
    let mut header = Header {
        magic: *b"HAIR",
        strands: counts.len() as u32,
        points: strands.points.len() as u32,
        flags,
        segments: if uniform { counts.first().copied().unwrap_or(0) as u32 } else { 0 },
        thickness: radius * 2.0,
        transparency: 0.0,
        color: [0.0; 3],
        info: [0; 88],
    };
    header.info[..MARK.len()].copy_from_slice(MARK);
    out.write_all(bytes_of(&header))?;
    if !uniform {
        out.write_all(cast_slice(&counts))?;
    }
    out.write_all(cast_slice(strands.points))?;
    if !one_radius {
        let diameters: Vec<f32> = strands.radii.iter().map(|r| r * 2.0).collect();
        out.write_all(cast_slice(&diameters))?;
    }
    out.write_all(cast_slice(strands.colors))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ReadOptions;

    /// A file of one strand of three points, without arrays of other values.
    fn file(thickness: f32, transparency: f32, color: [f32; 3]) -> Vec<u8> {
        let header = Header {
            magic: *b"HAIR",
            strands: 1,
            points: 3,
            flags: HAS_POINTS,
            segments: 2,
            thickness,
            transparency,
            color,
            info: [0; 88],
        };
        let points = [Vec3::ZERO, Vec3::Z * 0.1, Vec3::Z * 0.2];
        [bytes_of(&header), cast_slice(&points)].concat()
    }

    /// Radii [m] and notes, for a unit of a meter.
    fn finished(file: &[u8]) -> (Vec<f32>, Vec<String>) {
        let options = ReadOptions { scale: Some(1.0), up: Some(Axis::Y) };
        let (groom, _, notes) = read(file, options.up).unwrap().finish(&options, None);
        (groom.radii, notes)
    }

    #[test]
    fn the_axis_is_noted_unless_it_is_given() {
        let file = file(0.0, 0.0, [0.0; 3]);
        let notes = |up| read(&file, up).unwrap().notes;
        assert_eq!(notes(None), ["read as Z up, the convention of .hair models; set `up` to change it"]);
        assert_eq!(notes(Some(Axis::Y)), Vec::<String>::new());
    }

    #[test]
    fn defaults_of_the_header_are_used_or_reported() {
        assert_eq!(finished(&file(0.0, 0.0, [0.0; 3])), (vec![DEFAULT_RADIUS; 3], vec![]));
        let (radii, notes) = finished(&file(0.0001, 0.25, [1.0, 0.5, 0.25]));
        assert_eq!(radii, [0.00005; 3]);
        assert_eq!(
            notes,
            [
                "the header's default transparency of 0.25 is not used; it follows from the fiber's width",
                "the header's default color of 1, 0.5, 0.25 is not used; set the color in [groom.look]",
            ]
        );
        // A line width for display, as most files have it.
        let (radii, notes) = finished(&file(0.1, 0.0, [0.0; 3]));
        assert_eq!((radii, notes.len()), (vec![DEFAULT_RADIUS; 3], 1));
        assert!(notes[0].contains("radius of 50.000 mm, which is taken for a display width"), "{notes:?}");
    }

    #[test]
    fn defaults_that_are_no_values_are_reported() {
        let (radii, notes) = finished(&file(f32::NAN, -1.0, [f32::INFINITY, 0.0, 0.0]));
        assert_eq!((radii, notes.len()), (vec![DEFAULT_RADIUS; 3], 3));
        for (note, name) in notes.iter().zip(["thickness of NaN", "transparency of -1", "color of inf, 0, 0"])
        {
            assert!(note.contains(name) && note.contains("is not used; it must be finite"), "{note}");
        }
    }
}
