//! Distances of strands from the skin: whether a groom fits its body.

use glam::{Affine3A, Vec3};
use hairspring::{
    body::{Mesh, NearestTree},
    groom::Groom,
};

/// Strands that are measured at most; more are sampled evenly.
const SAMPLES: usize = 5_000;
/// Distance of a root from the skin above which it is reported [m].
const FAR: f32 = 0.01;

/// Share of reversed strands above which a part of a groom is reported, and above which all of it counts as reversed.
const SOME_REVERSED: f32 = 0.1;
const ALL_REVERSED: f32 = 0.8;

/// Distances of a groom's strands from the skin of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkinDistance {
    /// Median distance of the roots [m].
    pub median: f32,
    /// Largest distance of a root [m].
    pub max: f32,
    /// Median distance of the tips [m].
    pub tip_median: f32,
    /// Share of the strands that begin away from the skin and end on it, 0 to 1.
    pub reversed: f32,
}

impl SkinDistance {
    /// Measures the distances between a groom and a mesh in its rest pose. `None` if either is empty.
    pub fn of(groom: &Groom, mesh: &Mesh) -> Option<Self> {
        Self::new(groom, &NearestTree::new(mesh))
    }

    pub(crate) fn new(groom: &Groom, skin: &NearestTree<'_>) -> Option<Self> {
        let step = groom.strand_count().div_ceil(SAMPLES).max(1);
        let ends = (0..groom.strand_count()).step_by(step).filter_map(|s| {
            let strand = groom.strand(s);
            Some([distance(skin, *strand.first()?)?, distance(skin, *strand.last()?)?])
        });
        let ends: Vec<[f32; 2]> = ends.collect();
        let turned = ends.iter().filter(|ends| is_reversed(**ends)).count();
        let reversed = turned as f32 / ends.len().max(1) as f32;
        let sorted = |end: usize| {
            let mut all: Vec<f32> = ends.iter().map(|e| e[end]).collect();
            all.sort_by(f32::total_cmp);
            all
        };
        let (roots, tips) = (sorted(0), sorted(1));
        let middle = ends.len() / 2;
        Some(Self {
            median: *roots.get(middle)?,
            max: *roots.last()?,
            tip_median: *tips.get(middle)?,
            reversed,
        })
    }

    /// Describes what does not fit, and what to do. `turned` is whether all strands were reversed.
    pub(crate) fn note(&self, turned: bool) -> Option<String> {
        let Self { median, max, tip_median, reversed } = *self;
        if reversed > ALL_REVERSED {
            let remedy = if turned { "remove `reverse`" } else { "set `reverse = true`" };
            return Some(format!(
                "the roots are {median:.3} m from the skin and the tips {tip_median:.3} m, so the strands are probably reversed; {remedy} in the [[groom]]"
            ));
        }
        if reversed > SOME_REVERSED {
            return Some(format!(
                "{:.0} % of the strands begin away from the skin and end on it, so they are probably reversed; set `reverse = \"nearest\"` in the [[groom]] to turn only these",
                100.0 * reversed
            ));
        }
        let remedy = "are held there; set `scale`, `up` or `transform` of the [[groom]], or `scale` of the [body], if that is wrong";
        if median > FAR {
            return Some(format!(
                "the roots are {median:.3} m from the skin (at most {max:.3} m); they {remedy}"
            ));
        }
        if max > FAR && reversed > 0.0 {
            return Some(format!(
                "some roots are up to {max:.3} m from the skin (median {median:.3} m), and some strands begin away from the skin and end on it; set `reverse = \"nearest\"` in the [[groom]] to turn only these; other roots {remedy}"
            ));
        }
        (max > FAR).then(|| {
            format!("some roots are up to {max:.3} m from the skin (median {median:.3} m); they {remedy}")
        })
    }
}

/// Whether a strand with its first and last point at these distances from the skin [m] is probably reversed.
fn is_reversed([first, last]: [f32; 2]) -> bool {
    // A root a little below the skin may be farther from it than a tip that lies on it.
    first > 0.002 && last < 0.5 * first
}

/// Reverses the strands of a groom that begin away from the skin and end on it. Returns their number.
pub(crate) fn reverse_to_skin(groom: &mut Groom, skin: &NearestTree<'_>) -> usize {
    groom.reverse_strands(|_, points| {
        let ends = [points.first(), points.last()].map(|p| p.and_then(|p| distance(skin, *p)));
        matches!(ends, [Some(first), Some(last)] if is_reversed([first, last]))
    })
}

/// Distance of a point from the skin [m].
fn distance(skin: &NearestTree<'_>, p: Vec3) -> Option<f32> {
    skin.nearest(p, |_| true).map(|place| place.distance_squared.sqrt())
}

/// Returns the unit [m] that puts most strands, given by their two ends, on the skin when they are placed by
/// `place`. Units are in order of preference: a later one must be twice as near. `None` if no unit puts them
/// within a tenth of the body's `size` [m].
pub(crate) fn unit_on_skin(
    ends: &[[Vec3; 2]],
    units: &[f32],
    place: Affine3A,
    skin: &NearestTree<'_>,
    size: f32,
) -> Option<f32> {
    let (near, equal) = (0.1 * size, 2e-4 * size);
    let median = |unit: f32| {
        let nearer = |ends: &[Vec3; 2]| {
            let [a, b] = ends.map(|p| distance(skin, place.transform_point3(p * unit)));
            Some(a?.min(b?))
        };
        let mut all: Vec<f32> = ends.iter().filter_map(nearer).collect();
        all.sort_by(f32::total_cmp);
        all.get(all.len() / 2).copied()
    };
    let mut best: Option<(f32, f32)> = None;
    for unit in units {
        let Some(distance) = median(*unit).filter(|d| *d <= near) else { continue };
        // Smaller distances are equal.
        if best.is_none_or(|(_, b)| distance.max(equal) * 2.0 < b) {
            best = Some((*unit, distance.max(equal)));
        }
    }
    best.map(|(unit, _)| unit)
}
