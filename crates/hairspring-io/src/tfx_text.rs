//! Reader for the text form of TressFX grooms, versions 1 and 2 (AMD TressFX 2.2, `.tfx`): a header of one
//! keyword a line, then for each strand a line `strand 0 numVerts 4 texcoord 0.1 0.2` and one line of
//! coordinates, separated by commas, for each point.

use crate::{
    Problem,
    strands::Read,
    text::{Words, as_text, finite, shortened},
    units::{Axis, FileUnits},
};
use glam::{Affine3A, EulerRot, Quat, Vec2, Vec3};
use hairspring::groom::Groom;

/// Whether these are the bytes of a text file of TressFX.
pub(crate) fn is_text(data: &[u8]) -> bool {
    let head = &data[..data.len().min(1024)];
    let head = String::from_utf8_lossy(head).to_ascii_lowercase();
    let head = head.trim_start_matches('\u{feff}').trim_start();
    head.starts_with("version ") || head.lines().any(|line| line.trim_start().starts_with("numstrands "))
}

/// Reads a text file.
pub(crate) fn read(data: &[u8]) -> Result<Read, Problem> {
    // Coordinates are separated by commas, spaces or both.
    let text = as_text(data).replace(',', " ");
    let mut words = Words::new(&text);
    let mut groom = Groom { offsets: vec![0], ..Groom::default() };
    let mut notes = Vec::new();
    let mut named: Option<usize> = None;
    let (mut scale, mut rotation, mut translation) = (1.0, Vec3::ZERO, Vec3::ZERO);
    while let Some(word) = words.word() {
        match word.to_ascii_lowercase().as_str() {
            "version" => {
                let version = words.finite("the version")?;
                if !(1.0..3.0).contains(&version) {
                    let text = format!(
                        "version {version} is not supported as text; export the file as version 2 (text), or 3 or 4 (binary)"
                    );
                    return Err(Problem::line(words.line(), text));
                }
            }
            "scale" => scale = words.finite("the scale")?,
            "rotation" => rotation = words.vector("the rotation")?,
            "translation" => translation = words.vector("the translation")?,
            "bothendsimmovable" => {
                if words.finite("0 or 1")? != 0.0 {
                    notes.push("its tips are marked as fixed; they are simulated as free".into());
                }
            }
            "numfollowhairsperguidehair" => {
                let follow: u32 = words.number("the number of follow hairs")?;
                if follow > 0 {
                    notes.push(format!(
                        "it asks for {follow} follow hairs around each strand; the file holds only the guides; set `thicken` for more"
                    ));
                }
            }
            "maxnumverticesinstrand" | "maxradiusaroundguidehair" | "is" => {
                words.rest_of_line();
            }
            "numstrands" => named = Some(words.number("the number of strands")?),
            "strand" => strand(&mut words, &mut groom)?,
            other if finite(other).is_some() && groom.strand_count() > 0 => {
                let s = groom.strand_count() - 1;
                return Err(Problem::line(
                    words.line(),
                    format!(
                        "strand {s} has more points than its `numVerts` names ({}); correct `numVerts`",
                        groom.strand(s).len()
                    ),
                ));
            }
            other => {
                return Err(Problem::line(
                    words.line(),
                    format!("`{}` is no keyword of a TressFX text file", shortened(other)),
                ));
            }
        }
    }
    let strands = groom.strand_count();
    if named.is_some_and(|named| named > strands) {
        let text = format!(
            "the header names {} strands, but the file holds {strands}: it is cut short",
            named.unwrap_or_default()
        );
        return Err(Problem::line(words.line(), text));
    }
    if let Some(named) = named.filter(|named| *named < strands) {
        notes.push(format!("the header names {named} strands, but the file holds {strands}; all are used"));
    }
    u32::try_from(groom.points.len())
        .map_err(|_| Problem::limit(crate::Place::Whole, "more than 4 billion points"))?;
    let [x, y, z] = rotation.to_array().map(f32::to_radians);
    let turn = Quat::from_euler(EulerRot::ZYX, z, y, x);
    let place = Affine3A::from_scale_rotation_translation(Vec3::splat(scale), turn, translation);
    if place != Affine3A::IDENTITY {
        groom.points.iter_mut().for_each(|p| *p = place.transform_point3(*p));
        notes.push("the scale, rotation and translation of its header are applied".into());
    }
    let units = FileUnits { scale: None, up: Some(Axis::Y) };
    Ok(Read { groom, radii: None, true_radii: false, units, notes })
}

/// Reads the rest of a strand's line, and its points.
fn strand(words: &mut Words<'_>, groom: &mut Groom) -> Result<(), Problem> {
    let s = groom.strand_count();
    let line = words.rest_of_line();
    let after = |key: &str| {
        let at = line.iter().position(|word| word.eq_ignore_ascii_case(key))?;
        Some(&line[at + 1..])
    };
    let count = after("numVerts").and_then(|rest| rest.first()).and_then(|n| n.parse::<u32>().ok());
    let count = count.ok_or_else(|| {
        Problem::line(words.line(), format!("expected `numVerts` and the number of points of strand {s}"))
    })?;
    for _ in 0..count {
        groom.points.push(words.vector(&format!("a coordinate of strand {s}"))?);
    }
    groom.offsets.push(groom.points.len() as u32);
    let uv = |rest: &[&str]| Some(Vec2::new(finite(rest.first()?)?, finite(rest.get(1)?)?));
    groom.root_uvs.push(after("texcoord").and_then(uv).unwrap_or(Vec2::ZERO));
    Ok(())
}
