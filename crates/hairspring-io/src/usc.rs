//! Reader and writer for the `.data` format of the USC-HairSalon database (Hu et al. 2015, "Single-View Hair
//! Modeling Using A Hairstyle Database"): i32 number of strands; for each, i32 number of points and that many
//! float3. Meters, Y up.

use crate::{
    Place, Problem,
    bytes::Bytes,
    strands::{Read, Strands},
    units::{Axis, FileUnits},
};
use bytemuck::{bytes_of, cast_slice};
use glam::Vec3;
use hairspring::groom::Groom;
use std::io::{self, Write};

/// Reads a `.data` file, in its own units.
///
/// # Errors
/// Returns an error for a negative count, or for a file that ends too early or too late.
pub fn parse(data: &[u8]) -> Result<Groom, Problem> {
    read(data).map(Read::in_file_units)
}

pub(crate) fn read(data: &[u8]) -> Result<Read, Problem> {
    let mut bytes = Bytes::new(data);
    let strands: i32 = bytes.value("the strand count")?;
    // A strand takes at least four bytes.
    let strands = usize::try_from(strands).ok().filter(|n| *n <= bytes.remaining() / 4).ok_or_else(|| {
        Problem::new(
            Place::Byte(0),
            format!("{strands} strands do not fit into a file of {} bytes", data.len()),
        )
    })?;
    let mut groom = Groom { offsets: Vec::with_capacity(strands + 1), ..Groom::default() };
    groom.offsets.push(0);
    for s in 0..strands {
        let at = bytes.at();
        let count: i32 = bytes.value("a strand's point count")?;
        let count = usize::try_from(count).map_err(|_| {
            Problem::new(Place::Byte(at), format!("strand {s} has a negative point count ({count})"))
        })?;
        let run = bytes.take(count.saturating_mul(size_of::<Vec3>()), "a strand's points")?;
        groom.points.extend(run.chunks_exact(size_of::<Vec3>()).map(bytemuck::pod_read_unaligned::<Vec3>));
        groom.offsets.push(groom.points.len() as u32);
    }
    if bytes.remaining() > 0 {
        let text = format!(
            "{} bytes are left after the last strand; this is not a .data file of strands",
            bytes.remaining()
        );
        return Err(Problem::new(Place::Byte(bytes.at()), text));
    }
    let units = FileUnits { scale: None, up: Some(Axis::Y) };
    Ok(Read { groom, radii: None, true_radii: false, units, notes: Vec::new() })
}

/// Writes strands as a `.data` file: positions only.
pub(crate) fn write(out: &mut dyn Write, strands: &Strands<'_>) -> io::Result<()> {
    out.write_all(bytes_of(&(strands.strand_count() as i32)))?;
    for w in strands.offsets.windows(2) {
        out.write_all(bytes_of(&((w[1] - w[0]) as i32)))?;
        out.write_all(cast_slice(&strands.points[w[0] as usize..w[1] as usize]))?;
    }
    Ok(())
}
