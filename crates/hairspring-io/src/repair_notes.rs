//! Notes about the repairs of a groom, and about what was found in it and kept.

use hairspring::groom::{Groom, Repairs, has_stray_point};

/// Describes what was repaired, and what was found and kept.
pub(crate) fn repair_notes(groom: &Groom, repairs: &Repairs) -> Vec<String> {
    let parts = [
        (repairs.non_finite_points, "points that were not finite"),
        (repairs.zero_segments, "segments of zero length"),
        (repairs.short_strands, "strands of fewer than 3 points"),
        (repairs.bad_radii, "radii that were not above 0"),
    ];
    let words: Vec<String> =
        parts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
    let mut notes = Vec::new();
    if !words.is_empty() {
        notes.push(format!("repaired {}", words.join(", ")));
    }
    if repairs.empty_strands > 0 {
        notes.push(format!(
            "{} strands have no finite point; each is now a stub of a millimeter at the root of another strand; remove them",
            repairs.empty_strands
        ));
    }
    if repairs.folds > 0 {
        notes.push(format!(
            "{} joints bend by more than 150°, so that strands are folded there; they are kept as they are",
            repairs.folds
        ));
    }
    notes.extend(strays(groom));
    notes
}

/// Describes strands that have a stray point.
fn strays(groom: &Groom) -> Option<String> {
    let mut strands = (0..groom.strand_count()).filter(|s| has_stray_point(groom.strand(*s)));
    let first = strands.next()?;
    let count = 1 + strands.count();
    let segments = groom.strand(first).windows(2).map(|w| w[0].distance(w[1]));
    Some(format!(
        "{count} strands, the first of them strand {first}, have a segment of more than 20 times their median segment ({:.3} m in strand {first}), so a point of them is probably misplaced; correct it in the program that made the file",
        segments.fold(0.0, f32::max)
    ))
}
