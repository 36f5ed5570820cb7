//! The common output of all groom readers and the common input of all groom writers.

use crate::{
    Place, Problem, ReadOptions, color,
    units::{FileUnits, FitUnit, apply_to_groom, settle_groom},
};
use glam::{Vec2, Vec3};
use hairspring::groom::{DEFAULT_RADIUS, Groom};

/// Borrowed strands to be written: a groom, or the points of one baked frame.
#[derive(Clone, Copy, Debug)]
pub struct Strands<'a> {
    /// Positions, strand after strand, root first [m]; shape `[points]`.
    pub points: &'a [Vec3],
    /// Index of each strand's first point, and the number of points at the end; shape `[strands + 1]`.
    pub offsets: &'a [u32],
    /// Radius at each point [m]; shape `[points]`, or empty for the default radius.
    pub radii: &'a [f32],
    /// Linear RGB at each point; shape `[points]`, or empty.
    pub colors: &'a [Vec3],
    /// Texture coordinates of each root; shape `[strands]`, or empty.
    pub root_uvs: &'a [Vec2],
}

impl<'a> From<&'a Groom> for Strands<'a> {
    fn from(groom: &'a Groom) -> Self {
        Self {
            points: &groom.points,
            offsets: &groom.offsets,
            radii: &groom.radii,
            colors: &groom.colors,
            root_uvs: &groom.root_uvs,
        }
    }
}

impl Strands<'_> {
    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Points of each strand, in order.
    pub(crate) fn counts(&self) -> impl Iterator<Item = usize> + '_ {
        self.offsets.windows(2).map(|w| (w[1] - w[0]) as usize)
    }

    /// Checks that the arrays agree with each other. The error says which one does not.
    pub(crate) fn check(&self) -> Result<(), String> {
        let (points, strands) = (self.points.len(), self.strand_count());
        let ordered = self.offsets.first().is_none_or(|o| *o == 0) && self.offsets.is_sorted();
        if !ordered || self.offsets.last().map_or(0, |o| *o as usize) != points {
            return Err(format!("its offsets do not increase from 0 to its {points} points"));
        }
        for (name, len, want) in [
            ("radii", self.radii.len(), points),
            ("colors", self.colors.len(), points),
            ("root texture coordinates", self.root_uvs.len(), strands),
        ] {
            if len != 0 && len != want {
                return Err(format!("it has {len} {name} where {want} are needed"));
            }
        }
        match self.counts().position(|n| n == 0) {
            Some(s) => Err(format!("strand {s} has no points; run the groom through `sanitize` first")),
            None => Ok(()),
        }
    }
}

/// A groom as a reader returns it, before its units are converted.
pub(crate) struct Read {
    /// Everything except the radii, in the file's units and axes.
    pub groom: Groom,
    /// Radius of each point [file units], if the file has them.
    pub radii: Option<Vec<f32>>,
    /// Whether the radii are known to be measurements (our own files), not widths for a display.
    pub true_radii: bool,
    /// What the file specifies about its units.
    pub units: FileUnits,
    /// Notes so far.
    pub notes: Vec<String>,
}

/// Plausible radii of hair and fur fibers, with some margin [m]: vellus hair has 5 µm, a whisker up to 250
/// µm.
const BELIEVABLE_RADIUS: std::ops::RangeInclusive<f32> = 2e-6..=300e-6;

impl Read {
    /// Returns the groom in the file's own units.
    pub fn in_file_units(mut self) -> Groom {
        self.groom.radii = self.radii.unwrap_or_else(|| vec![DEFAULT_RADIUS; self.groom.points.len()]);
        self.groom
    }

    /// Returns the groom in meters and Y up, the meters per file unit, and the notes. A unit that is neither
    /// given nor in the file is chosen by `fit`, or guessed from the sizes.
    pub fn finish(mut self, options: &ReadOptions, fit: Option<FitUnit<'_>>) -> (Groom, f32, Vec<String>) {
        self.notes.extend(color::into_range(&mut self.groom.colors));
        let (scale, turn) = settle_groom(options, self.units, &self.groom, fit, &mut self.notes);
        apply_to_groom(&mut self.groom, scale, turn);
        self.groom.radii = match self.radii {
            None => vec![DEFAULT_RADIUS; self.groom.points.len()],
            Some(mut radii) => {
                radii.iter_mut().for_each(|r| *r *= scale);
                // Others are repaired later, and counted.
                let mut valid: Vec<f32> =
                    radii.iter().copied().filter(|r| r.is_finite() && *r > 0.0).collect();
                let middle = valid.len() / 2;
                let median =
                    (!valid.is_empty()).then(|| *valid.select_nth_unstable_by(middle, f32::total_cmp).1);
                match median.filter(|m| !self.true_radii && !BELIEVABLE_RADIUS.contains(m)) {
                    None => radii,
                    Some(median) => {
                        self.notes.push(format!(
                            "the file's thickness gives fibers a radius of {:.3} mm, which is taken for a display width; {:.3} mm is used instead",
                            median * 1e3,
                            DEFAULT_RADIUS * 1e3
                        ));
                        vec![DEFAULT_RADIUS; radii.len()]
                    }
                }
            }
        };
        (self.groom, scale, self.notes)
    }
}

/// Returns the offsets of strands with `counts` points, which must sum to `points`. `at` is the position of
/// the counts [bytes].
pub(crate) fn gather_offsets(
    counts: impl Iterator<Item = usize>,
    points: usize,
    at: usize,
) -> Result<Vec<u32>, Problem> {
    let mut offsets = Vec::with_capacity(counts.size_hint().0 + 1);
    let mut sum = 0usize;
    offsets.push(0);
    for count in counts {
        sum += count;
        if sum > points {
            break;
        }
        offsets.push(sum as u32);
    }
    if sum != points {
        let text = format!(
            "the strands' points come to {sum} or more, but the file names {points}: one of the two counts is wrong"
        );
        return Err(Problem::new(Place::Byte(at), text));
    }
    u32::try_from(points).map_err(|_| Problem::limit(Place::Byte(at), "more than 4 billion points"))?;
    Ok(offsets)
}
