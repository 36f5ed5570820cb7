//! Notes about the repairs of a groom, and about what was found in it and kept.

use hairspring::groom::{Groom, Repairs, has_stray_point};

/// Strands that are replaced because no point of them can be used. Each becomes a stub.
pub(crate) struct Lost {
    /// Those that lie far from all others.
    pub far: Vec<usize>,
    /// Number of those without points.
    pub pointless: usize,
}

/// Counts the strands without points.
pub(crate) fn strands_without_points(groom: &Groom) -> usize {
    groom.offsets.windows(2).filter(|of| of[0] == of[1]).count()
}

/// Describes what was repaired, and what was found and kept.
pub(crate) fn repair_notes(groom: &Groom, repairs: &Repairs, lost: &Lost) -> Vec<String> {
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
    let infinite = repairs.empty_strands.saturating_sub(lost.far.len() + lost.pointless);
    for (count, what) in [(lost.pointless, "have no points"), (infinite, "have no finite point")] {
        if count > 0 {
            notes.push(format!("{count} strands {what}; {STUBS}"));
        }
    }
    if let Some(first) = lost.far.first() {
        notes.push(format!(
            "{} strands, the first of them strand {first}, are far from all others, where single precision does not resolve them; {STUBS}",
            lost.far.len()
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

/// What becomes of strands without a usable point.
const STUBS: &str = "each is now a stub of a millimeter at the root of another strand; remove them";

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
