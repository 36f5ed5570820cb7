//! Repairs defects found in real files: duplicate points, non-finite values, strands of a single point.

use super::{DEFAULT_RADIUS, Groom, MAX_COORDINATE, stray::stray_length};
use glam::Vec3;

/// Counts of what [`sanitize`] found and repaired. Nothing is changed without being counted here.
///
/// For an example, see [`groom`](crate::groom).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Repairs {
    /// Points with a NaN or infinite coordinate, moved onto the line between their finite neighbors.
    pub non_finite_points: usize,
    /// Segments below the minimum length, whose points were spread out along the strand.
    pub zero_segments: usize,
    /// Strands with one or two points, which were given intermediate points. A single point becomes a stub of 1 mm
    /// along +Y.
    pub short_strands: usize,
    /// Strands without any finite point. Each becomes a stub at the root of the strand before it, or of the first one
    /// that has a finite point.
    pub empty_strands: usize,
    /// Radii that were not positive and finite, replaced by the strand's mean or by the default.
    pub bad_radii: usize,
    /// Joints at which a strand turns by more than 150°. They are counted, not changed.
    pub folds: usize,
}

impl Repairs {
    /// Returns the total number of repairs.
    pub fn total(&self) -> usize {
        self.non_finite_points + self.zero_segments + self.short_strands + self.empty_strands + self.bad_radii
    }
}

/// Minimum segment length as a fraction of the strand's mean segment: 1 %. Segments to stray points do not count.
///
/// The stiffness of a stretch spring is EA/L, so a segment of a hundredth of the mean is a hundred times
/// stiffer than its neighbors. The band solver in f32 still has five digits left for them. Uneven spacing by
/// artists is not changed; root segments of a tenth of the mean are common.
const SHORTEST_SEGMENT: f32 = 0.01;

/// Minimum length of a strand that has a shape [m]. A shorter strand counts as a point and becomes a stub.
const SHORTEST_STRAND: f32 = 1e-6;

/// Length of the stub that replaces a strand without a shape [m].
const STUB: f32 = 1e-3;

/// Repairs `groom` in place and returns what was repaired. Afterward every strand has at least three points,
/// all coordinates and radii are finite, and no segment is near zero length. No strand is removed, and a
/// second call finds nothing to repair.
///
/// A strand shorter than the resolution of single precision at its position has no shape to keep. Such grooms
/// should be rejected first; [`first_imprecise`](super::first_imprecise) finds them.
///
/// For an example, see [`groom`](crate::groom).
///
/// # Panics
/// If the arrays of the groom do not fit together.
pub fn sanitize(groom: &mut Groom) -> Repairs {
    let mut repairs = Repairs::default();
    if groom.offsets.is_empty() {
        groom.offsets.push(0);
    }
    lengthen_short_strands(groom, &mut repairs);
    groom.radii.resize(groom.points.len(), f32::NAN);
    let mut empty = Vec::new();
    for s in 0..groom.strand_count() {
        let range = groom.range(s);
        repairs.bad_radii += mend_radii(&mut groom.radii[range.clone()]);
        if !groom.strand(s).iter().any(is_usable) {
            empty.push(s);
            continue;
        }
        repairs.non_finite_points += fill_non_finite(&mut groom.points[range.clone()]);
        repairs.zero_segments += spread_zero_segments(&mut groom.points[range.clone()]);
        repairs.folds += folds(&groom.points[range]);
    }
    repairs.empty_strands = empty.len();
    place_empty_strands(groom, &empty);
    repairs
}

/// Places the strands `empty`, in order, as stubs where another strand has its root. Elsewhere they would widen the
/// bounds of the groom.
fn place_empty_strands(groom: &mut Groom, empty: &[usize]) {
    let first = (0..groom.strand_count()).find(|s| empty.binary_search(s).is_err());
    let first = first.map_or(Vec3::ZERO, |s| groom.strand(s)[0]);
    for &s in empty {
        let root = s.checked_sub(1).map_or(first, |before| groom.strand(before)[0]);
        let points = groom.range(s);
        groom.points[points.clone()].fill(root);
        stub(&mut groom.points[points]);
    }
}

/// Returns whether a point is finite and within [`MAX_COORDINATE`].
fn is_usable(p: &Vec3) -> bool {
    p.is_finite() && p.abs().max_element() <= MAX_COORDINATE
}

/// Counts the joints that turn by more than 150°.
fn folds(points: &[Vec3]) -> usize {
    const COSINE: f32 = -0.866;
    let turn = |w: &[Vec3]| (w[1] - w[0]).normalize_or_zero().dot((w[2] - w[1]).normalize_or_zero());
    points.windows(3).filter(|w| turn(w) < COSINE).count()
}

/// Adds the missing points to strands with fewer than three, by resampling every per-point array.
fn lengthen_short_strands(groom: &mut Groom, repairs: &mut Repairs) {
    repairs.short_strands = groom.offsets.windows(2).filter(|w| matches!(w[1] - w[0], 1 | 2)).count();
    if !groom.offsets.windows(2).any(|w| w[1] - w[0] < 3) {
        return;
    }
    let old = std::mem::take(groom);
    let (has_radii, has_colors) = (old.radii.len() == old.points.len(), !old.colors.is_empty());
    let mut offsets = vec![0];
    for s in 0..old.strand_count() {
        let range = old.range(s);
        // Old point indices and interpolation parameter (a, b, t) of each new point.
        let places: Vec<(usize, usize, f32)> = match range.len() {
            0 => Vec::new(),
            1 => vec![(range.start, range.start, 0.0); 3],
            2 => vec![
                (range.start, range.start, 0.0),
                (range.start, range.start + 1, 0.5),
                (range.start + 1, range.start + 1, 0.0),
            ],
            _ => range.clone().map(|i| (i, i, 0.0)).collect(),
        };
        if places.is_empty() {
            groom.points.extend([Vec3::NAN; 3]);
            groom.radii.extend([DEFAULT_RADIUS; 3].iter().filter(|_| has_radii));
            groom.colors.extend([Vec3::ZERO; 3].iter().filter(|_| has_colors));
        }
        for (a, b, t) in places {
            groom.points.push(if a == b { old.points[a] } else { old.points[a].lerp(old.points[b], t) });
            if has_radii {
                groom.radii.push(old.radii[a] + (old.radii[b] - old.radii[a]) * t);
            }
            if has_colors {
                groom.colors.push(old.colors[a].lerp(old.colors[b], t));
            }
        }
        offsets.push(groom.points.len() as u32);
    }
    *groom = Groom {
        points: std::mem::take(&mut groom.points),
        radii: std::mem::take(&mut groom.radii),
        colors: std::mem::take(&mut groom.colors),
        offsets,
        ..old
    };
}

/// Repairs points that are not finite or beyond [`MAX_COORDINATE`]. They move onto the line between their
/// finite neighbors; at the ends, they continue the strand. At least one must be finite. Returns the number of repaired
/// points.
fn fill_non_finite(points: &mut [Vec3]) -> usize {
    let finite: Vec<usize> = (0..points.len()).filter(|i| is_usable(&points[*i])).collect();
    let bad = points.len() - finite.len();
    if bad == 0 {
        return 0;
    }
    let (first, last) = (finite[0], finite[finite.len() - 1]);
    for w in finite.windows(2) {
        let (a, b) = (points[w[0]], points[w[1]]);
        let steps = (w[1] - w[0]) as f32;
        for (i, p) in points[w[0]..w[1]].iter_mut().enumerate().skip(1) {
            *p = a.lerp(b, i as f32 / steps);
        }
    }
    // The ends continue with the mean step of the finite points.
    let steps = (last - first).max(1) as f32;
    let step = (points[last] - points[first]) / steps;
    for i in (0..first).rev() {
        points[i] = within_reach(points[i + 1] - step);
    }
    for i in last + 1..points.len() {
        points[i] = within_reach(points[i - 1] + step);
    }
    bad
}

/// Repairs segments below the minimum length; returns their number. The methods are tried in order: spread
/// the points along the strand, space them evenly along it (for a strand folded onto itself), space them on a
/// straight line, and replace the strand by a stub. Each result is checked like the input, so that a second
/// call finds nothing. This matters because a resampled strand cuts corners, is therefore shorter, and may
/// fall below the length of a shape.
fn spread_zero_segments(points: &mut [Vec3]) -> usize {
    let short = short_segments(points);
    if short == 0 {
        return 0;
    }
    let old = points.to_vec();
    let mut at = vec![0.0f32];
    for w in old.windows(2) {
        at.push(at[at.len() - 1] + w[0].distance(w[1]));
    }
    for spread in [spread_apart, spread_evenly, spread_straight] {
        spread(points, &old, &at);
        if short_segments(points) == 0 && points.iter().all(|p| p.abs().max_element() <= MAX_COORDINATE) {
            return short;
        }
    }
    points.copy_from_slice(&old);
    stub(points);
    short
}

/// Counts the segments below the minimum length. If the strand is too short to have a shape, all segments
/// count.
fn short_segments(points: &[Vec3]) -> usize {
    let length: f32 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    if length < SHORTEST_STRAND.max(noise_of(points)) {
        return points.len() - 1;
    }
    let shortest = shortest_segment(points, length);
    points.windows(2).filter(|w| w[0].distance(w[1]) < shortest).count()
}

/// Returns the minimum segment length for a strand of this `length` [m].
fn shortest_segment(points: &[Vec3], length: f32) -> f32 {
    let mean = match stray_length(points) {
        None => length / (points.len() - 1) as f32,
        Some(limit) => {
            let lengths = points.windows(2).map(|w| w[0].distance(w[1])).filter(|length| *length <= limit);
            let (count, sum) = lengths.fold((0, 0.0), |(count, sum), length| (count + 1, sum + length));
            sum / count as f32
        }
    };
    SHORTEST_SEGMENT * mean
}

/// Moves points that are too near to a neighbor along the old strand; `at` [m] is the arc length of each
/// point. The spacing is at least twice the minimum, first from root to tip, then back from the tip, so that
/// the tip stays in place. The factor of two allows for chords at bends, which are shorter than the arc.
fn spread_apart(points: &mut [Vec3], old: &[Vec3], at: &[f32]) {
    let (last, length) = (at.len() - 1, at[at.len() - 1]);
    let gap = 2.0 * shortest_segment(old, length);
    let mut to = at.to_vec();
    for i in 1..to.len() {
        to[i] = to[i].max(to[i - 1] + gap);
    }
    to[last] = length;
    for i in (0..last).rev() {
        to[i] = to[i].min(to[i + 1] - gap);
    }
    for i in 1..last {
        if to[i] != at[i] {
            points[i] = along(old, at, to[i]);
        }
    }
}

/// Spaces the points evenly along the old strand.
fn spread_evenly(points: &mut [Vec3], old: &[Vec3], at: &[f32]) {
    let (last, length) = (at.len() - 1, at[at.len() - 1]);
    for (i, p) in points.iter_mut().enumerate().take(last).skip(1) {
        *p = along(old, at, length * i as f32 / last as f32);
    }
}

/// Spaces the points evenly on a straight line of the old strand's length, from its root toward its tip.
fn spread_straight(points: &mut [Vec3], old: &[Vec3], at: &[f32]) {
    let (last, length) = (at.len() - 1, at[at.len() - 1]);
    let direction = (old[last] - old[0]).try_normalize().unwrap_or(Vec3::Y);
    for (i, p) in points.iter_mut().enumerate() {
        *p = old[0] + direction * (length * i as f32 / last as f32);
    }
}

/// Replaces a strand without a shape by a straight one along +Y from its root, long enough to exceed rounding
/// noise at its position. If the root is near the upper limit of the coordinates, the direction is −Y.
fn stub(points: &mut [Vec3]) {
    let root = points[0];
    let up = if root.y > MAX_COORDINATE * 0.5 { -1.0 } else { 1.0 };
    let step = up * STUB.max(noise_of(points) * 4.0) / (points.len() - 1) as f32;
    for (i, p) in points.iter_mut().enumerate() {
        *p = root + Vec3::Y * (step * i as f32);
    }
}

/// Returns the length below which f32 cannot distinguish a strand at these coordinates from a point [m].
fn noise_of(points: &[Vec3]) -> f32 {
    let reach = points.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
    reach * f32::EPSILON * 16.0 * (points.len() - 1) as f32
}

/// Clamps each coordinate of a point to ±[`MAX_COORDINATE`].
fn within_reach(p: Vec3) -> Vec3 {
    p.clamp(Vec3::splat(-MAX_COORDINATE), Vec3::splat(MAX_COORDINATE))
}

/// Returns the point at arc length `d` along a strand whose points are at arc lengths `at`.
fn along(points: &[Vec3], at: &[f32], d: f32) -> Vec3 {
    let j = at.partition_point(|a| *a < d).clamp(1, points.len() - 1);
    let span = at[j] - at[j - 1];
    let t = if span > 0.0 { ((d - at[j - 1]) / span).clamp(0.0, 1.0) } else { 0.0 };
    points[j - 1].lerp(points[j], t)
}

/// Replaces radii that are not positive and finite by the mean of the strand's valid ones, or by the default.
/// Returns the number of replaced radii.
fn mend_radii(radii: &mut [f32]) -> usize {
    let good = |r: f32| r.is_finite() && r > 0.0;
    let (count, sum) =
        radii.iter().filter(|r| good(**r)).fold((0, 0.0f64), |(n, sum), r| (n + 1, sum + *r as f64));
    if count == radii.len() {
        return 0;
    }
    let mean = if count > 0 { (sum / count as f64) as f32 } else { DEFAULT_RADIUS };
    radii.iter_mut().filter(|r| !good(**r)).for_each(|r| *r = mean);
    radii.len() - count
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_good_groom_is_left_alone() {
        let mut groom = Groom::from_strands([[Vec3::ZERO, Vec3::Y * 0.01, Vec3::Y * 0.03]], 4e-5);
        let before = groom.clone();
        assert_eq!(sanitize(&mut groom), Repairs::default());
        assert_eq!(groom, before);
    }

    #[test]
    fn a_lost_point_goes_between_its_neighbours() {
        let mut groom = Groom::from_strands([[Vec3::ZERO, Vec3::NAN, Vec3::Y * 0.2, Vec3::INFINITY]], 4e-5);
        assert_eq!(sanitize(&mut groom).non_finite_points, 2);
        assert_eq!(groom.points, [Vec3::ZERO, Vec3::Y * 0.1, Vec3::Y * 0.2, Vec3::Y * 0.3]);
    }

    #[test]
    fn doubled_points_are_spread_and_root_and_tip_stay() {
        let strand =
            [Vec3::ZERO, Vec3::ZERO, Vec3::Y * 0.1, Vec3::Y * 0.1 + Vec3::X * 1e-7, Vec3::new(0.1, 0.1, 0.0)];
        let mut groom = Groom::from_strands([strand], 4e-5);
        assert_eq!(sanitize(&mut groom).zero_segments, 2);
        assert_eq!((groom.points[0], groom.points[4]), (strand[0], strand[4]));
        assert!(groom.points.windows(2).all(|w| w[0].distance(w[1]) > 4e-4), "{:?}", groom.points);
    }

    /// A point 50 m away makes the mean segment longer than the others by far.
    #[test]
    fn a_stray_point_does_not_move_the_others() {
        let mut strand: Vec<Vec3> = (0..8).map(|k| Vec3::new(0.05, 1.6 + 0.03 * k as f32, 0.0)).collect();
        strand[1].x = 50.0;
        let mut groom = Groom::from_strands([strand.clone()], 4e-5);
        assert_eq!(sanitize(&mut groom).total(), 0);
        assert_eq!(groom.points, strand);
        // A doubled point moves by as much as it does without the stray one.
        strand[5] = strand[4];
        let mut groom = Groom::from_strands([strand.clone()], 4e-5);
        assert_eq!(sanitize(&mut groom).zero_segments, 1);
        let moved = groom.points.iter().zip(&strand).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(moved > 0.0 && moved < 0.002, "moved by {moved} m");
    }

    #[test]
    fn short_strands_get_points_and_their_neighbours_keep_theirs() {
        let strands: [&[Vec3]; 4] =
            [&[Vec3::X], &[], &[Vec3::ZERO, Vec3::Y], &[Vec3::ZERO, Vec3::Y, Vec3::Y * 2.0]];
        let mut groom = Groom::from_strands(strands, 4e-5);
        groom.colors = groom.points.clone();
        let repairs = sanitize(&mut groom);
        assert_eq!((repairs.short_strands, repairs.empty_strands, repairs.bad_radii), (2, 1, 0));
        assert_eq!(groom.strand(1)[0], Vec3::X, "an empty strand is not at the root before it");
        assert_eq!(groom.offsets, [0, 3, 6, 9, 12]);
        assert_eq!(groom.strand(0)[0], Vec3::X);
        assert!((groom.strand_length(0) - STUB).abs() < 1e-6);
        assert_eq!(groom.strand(2), [Vec3::ZERO, Vec3::Y * 0.5, Vec3::Y]);
        assert_eq!((groom.radii.len(), groom.colors.len()), (12, 12));
    }

    #[test]
    fn strands_without_a_finite_point_do_not_change_the_bounds() {
        let good = [Vec3::ONE, Vec3::ONE * 1.1, Vec3::ONE * 1.2];
        let mut groom = Groom::from_strands([&[Vec3::NAN; 4][..], &[], &good, &[Vec3::NAN]], 4e-5);
        let repairs = sanitize(&mut groom);
        assert_eq!((repairs.empty_strands, repairs.total()), (3, 4), "{repairs:?}");
        for s in [0, 1, 3] {
            assert_eq!(groom.strand(s)[0], Vec3::ONE, "strand {s}");
        }
    }

    #[test]
    fn folds_are_counted_and_kept() {
        let strand = [Vec3::ZERO, Vec3::Y, Vec3::Y * 0.5 + Vec3::X * 0.05, Vec3::X + Vec3::Y];
        let mut groom = Groom::from_strands([strand], 4e-5);
        let repairs = sanitize(&mut groom);
        assert_eq!((repairs.folds, repairs.total()), (1, 0));
        assert_eq!(groom.strand(0), strand);
    }

    #[test]
    fn bad_radii_take_the_strands_mean() {
        let mut groom = Groom::from_strands([[Vec3::ZERO, Vec3::Y, Vec3::Y * 2.0]], 4e-5);
        groom.radii = vec![2e-5, 0.0, f32::NAN];
        assert_eq!(sanitize(&mut groom).bad_radii, 2);
        assert_eq!(groom.radii, [2e-5; 3]);
    }

    /// A zigzag slightly longer than a micrometer, with a short segment at its first fold. Spreading along
    /// the strand brings two points together there; spaced evenly, the strand cuts its corners and is shorter
    /// than a micrometer.
    #[test]
    fn a_repair_that_leaves_no_shape_is_a_stub() {
        let width = 1.02e-6 / 13.0;
        let mut places = vec![0.0, 1.0 - 0.0092];
        places.extend((1..14).map(|i| (i % 2) as f32));
        let mut groom =
            Groom::from_strands([places.iter().map(|x| Vec3::X * (x * width)).collect::<Vec<_>>()], 4e-5);
        assert!(groom.strand_length(0) > SHORTEST_STRAND);
        assert_eq!(sanitize(&mut groom).zero_segments, 1);
        assert_eq!(sanitize(&mut groom).total(), 0);
    }

    /// Coordinates as they occur in defective files.
    fn coordinate() -> impl Strategy<Value = f32> {
        prop_oneof![
            6 => -1.0f32..1.0,
            1 => Just(0.0),
            1 => -1e-7f32..1e-7,
            1 => prop_oneof![Just(f32::NAN), Just(f32::INFINITY), Just(f32::MAX), Just(-1e5f32), -1.1e6f32..1.1e6],
        ]
    }

    proptest! {
        #[test]
        fn a_second_call_repairs_nothing(
            strands in prop::collection::vec(
                prop::collection::vec((coordinate(), coordinate(), coordinate(), 0u8..4), 0..12), 0..6),
            radius in prop_oneof![Just(4e-5f32), Just(0.0), Just(f32::NAN)],
            // Some grooms have the size at which a strand ceases to have a shape.
            scale in prop_oneof![2 => Just(1.0f32), 1 => 1e-7f32..1e-5],
        ) {
            let strands: Vec<Vec<Vec3>> = strands
                .into_iter()
                .map(|s| {
                    let mut points: Vec<Vec3> = Vec::new();
                    for (x, y, z, kind) in s {
                        // Some repeat the previous point or fold back to the one before it.
                        let back = points.len().checked_sub(kind as usize);
                        let folded = back.filter(|_| kind > 0).and_then(|i| points.get(i)).copied();
                        points.push(folded.filter(|_| kind < 3).unwrap_or(Vec3::new(x, y, z) * scale));
                    }
                    points
                })
                .collect();
            let mut groom = Groom::from_strands(&strands, radius);
            let _ = sanitize(&mut groom);
            prop_assert_eq!(groom.strand_count(), strands.len());
            prop_assert!(groom.points.iter().all(|p| p.is_finite()));
            prop_assert!(groom.radii.iter().all(|r| r.is_finite() && *r > 0.0));
            prop_assert_eq!(groom.radii.len(), groom.points.len());
            for s in 0..groom.strand_count() {
                prop_assert!(groom.strand(s).len() >= 3);
                prop_assert!(groom.strand(s).windows(2).all(|w| w[0] != w[1]));
            }
            let once = groom.clone();
            prop_assert_eq!(sanitize(&mut groom).total(), 0);
            prop_assert_eq!(groom, once);
        }
    }
}
