//! Stray points of a groom: points that lie far from all others and say nothing about its size.

use crate::units::{bounds, extent};
use glam::Vec3;
use hairspring::groom::{DEFAULT_RADIUS, Groom, first_imprecise};

/// Distance from the middle of a groom above which a point is a stray, over the median distance [1]. Points of a head of
/// hair with a long tail reach a quarter of it.
const FAR: f32 = 12.0;
/// A larger share of points than one in this number is a part of the groom.
const FEWEST: usize = 5;
/// Largest number of points that medians are taken over.
const SAMPLES: usize = 20_000;

/// Stray points of a groom, and its size without them.
pub(crate) struct Strays {
    /// Number of them that are exactly at the origin.
    at_origin: usize,
    /// Number of the others.
    elsewhere: usize,
    /// Longest side of the box around the groom [file units].
    pub extent: f32,
}

impl Strays {
    pub(crate) fn of(groom: &Groom) -> Self {
        let strands = measured_strands(groom);
        let points = || strands.iter().flat_map(|s| groom.strand(*s)).copied().filter(|p| p.is_finite());
        let count = points().count();
        let without_origin = origin_is_apart(&points);
        let counts = |p: &Vec3| !without_origin || *p != Vec3::ZERO;
        let is_near = nearness(points().filter(counts));
        let all = points().filter(|p| counts(p) && !is_near(*p)).count() * FEWEST > count;
        let kept = || points().filter(|p| counts(p) && (all || is_near(*p)));
        let (lo, hi) = bounds(kept());
        let is_far = |p: &&Vec3| p.is_finite() && lo.is_finite() && is_apart(**p, lo, hi);
        let at_origin = groom.points.iter().filter(|p| is_far(p) && **p == Vec3::ZERO).count();
        Self {
            at_origin,
            elsewhere: groom.points.iter().filter(is_far).count() - at_origin,
            extent: inner_extent(&kept, count),
        }
    }

    /// The end of a note about a guess that these points had no part in.
    pub(crate) fn note(&self) -> Option<String> {
        match (self.at_origin, self.elsewhere) {
            (0, 0) => None,
            (n, 0) => Some(format!(" ({n} points at the origin, far from the others, do not count)")),
            (at_origin, n) => Some(format!(" ({} points far from the others do not count)", at_origin + n)),
        }
    }
}

/// Makes the points of strands far from all others NaN, so that they are repaired like strands without a finite point.
/// Returns these strands.
pub(crate) fn give_up_far_strands(groom: &mut Groom) -> Vec<usize> {
    let far = far_strands(groom);
    for s in &far {
        let points = groom.range(*s);
        groom.points[points].fill(Vec3::NAN);
    }
    far
}

/// Returns the strands far from all others, beyond the precision at their place, if they are few.
fn far_strands(groom: &Groom) -> Vec<usize> {
    let is_near = nearness(groom.points.iter().copied().filter(|p| p.is_finite()));
    let is_far = |s: &usize| {
        let strand = groom.strand(*s);
        strand.iter().any(|p| p.is_finite())
            && !strand.iter().any(|p| p.is_finite() && is_near(*p))
            && first_imprecise(&Groom::from_strands([strand], DEFAULT_RADIUS)).is_some()
    };
    let far: Vec<usize> = (0..groom.strand_count()).filter(is_far).collect();
    if far.len() * FEWEST > groom.strand_count() { Vec::new() } else { far }
}

/// Returns whether a point is near enough to the middle of `points` to belong to them. Distances are those of the
/// farthest coordinate, which do not overflow for any finite point.
fn nearness(points: impl Iterator<Item = Vec3> + Clone) -> impl Fn(Vec3) -> bool {
    let step = points.clone().count().div_ceil(SAMPLES).max(1);
    let sample: Vec<Vec3> = points.step_by(step).collect();
    let median = |mut values: Vec<f32>| {
        let middle = values.len() / 2;
        if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f32::total_cmp).1 }
    };
    let middle = Vec3::from([0, 1, 2].map(|axis| median(sample.iter().map(|p| p[axis]).collect())));
    let distance = move |p: Vec3| (p - middle).abs().max_element();
    let limit = FAR * median(sample.iter().map(|p| distance(*p)).collect());
    move |p| limit == 0.0 || distance(p) <= limit
}

/// Returns the strands that tell the size of a groom: those with a length, except few whose root is far from the roots of the
/// others; all strands if none has a length.
fn measured_strands(groom: &Groom) -> Vec<usize> {
    let root = |s: usize| groom.strand(s).iter().copied().find(|p| p.is_finite());
    let has_length = |s: &usize| {
        let first = root(*s);
        groom.strand(*s).iter().any(|p| p.is_finite() && Some(*p) != first)
    };
    let all = 0..groom.strand_count();
    let strands: Vec<usize> = all.clone().filter(has_length).collect();
    let roots: Vec<Vec3> = strands.iter().filter_map(|s| root(*s)).collect();
    let is_near = nearness(roots.iter().copied());
    let near: Vec<usize> = strands.iter().copied().filter(|s| root(*s).is_some_and(&is_near)).collect();
    let far = strands.len() - near.len();
    match (strands.is_empty(), far * FEWEST > strands.len()) {
        (true, _) => all.collect(),
        (_, true) => strands,
        (_, false) => near,
    }
}

/// Whether points exactly at the origin are no part of the hair: at most a tenth of all, and apart from the others.
fn origin_is_apart<P: Iterator<Item = Vec3> + Clone>(points: &dyn Fn() -> P) -> bool {
    let at_origin = points().filter(|p| *p == Vec3::ZERO).count();
    if at_origin == 0 || at_origin * 10 > points().count() {
        return false;
    }
    let others = || points().filter(|p| *p != Vec3::ZERO);
    let is_near = nearness(others());
    let (lo, hi) = bounds(others().filter(|p| is_near(*p)));
    is_apart(Vec3::ZERO, lo, hi)
}

/// Whether a point is farther from a box than half of its longest side.
fn is_apart(point: Vec3, lo: Vec3, hi: Vec3) -> bool {
    (point - point.clamp(lo, hi)).length() > 0.5 * (hi - lo).max_element()
}

/// The longest side of the box around `points`, of which there are at most `count`. The hundredth of them that is
/// farthest out does not count if the box without it is less than half as long.
fn inner_extent<P: Iterator<Item = Vec3>>(points: &dyn Fn() -> P, count: usize) -> f32 {
    let whole = extent(points());
    let step = count.div_ceil(SAMPLES).max(1);
    let inner = |axis: usize| {
        let mut along: Vec<f32> = points().step_by(step).map(|p| p[axis]).collect();
        along.sort_by(f32::total_cmp);
        let cut = along.len() / 100;
        let at = |i: usize| along.get(i).copied().unwrap_or(0.0);
        at(along.len().saturating_sub(1 + cut)) - at(cut)
    };
    let inner = inner(0).max(inner(1)).max(inner(2));
    if inner > 0.0 && inner < 0.5 * whole { inner } else { whole }
}
