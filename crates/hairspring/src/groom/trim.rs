//! Shorter and fewer strands: cutting, and the removal of strands.

use super::{Groom, GuideWeights};

/// Cuts each strand `s` to the share `shares[s]` of its length, 0 to 1. Its points are placed anew at equal
/// shares of the former distances, so that their number does not change; radii and colors are interpolated.
/// Shares outside of the range are clamped to it. A strand that is cut to 0 becomes a point: see [`keep_strands`]. A strand
/// of fewer than two points has no length and does not change.
///
/// ```
/// use glam::Vec3;
/// use hairspring::groom::{Groom, cut};
///
/// let mut groom = Groom::from_strands([[Vec3::ZERO, Vec3::NEG_Y, Vec3::NEG_Y * 2.0]], 35e-6);
/// cut(&mut groom, &[0.25]);
/// assert_eq!(groom.strand(0)[2], Vec3::NEG_Y * 0.5);
/// ```
///
/// # Panics
/// If `shares` does not have an entry for each strand.
pub fn cut(groom: &mut Groom, shares: &[f32]) {
    assert_eq!(shares.len(), groom.strand_count(), "a share for each strand");
    for (s, share) in shares.iter().enumerate().filter(|(_, share)| **share < 1.0) {
        let range = groom.range(s);
        if range.len() < 2 {
            continue;
        }
        let points = groom.points[range.clone()].to_vec();
        let mut ends = vec![0.0];
        for w in points.windows(2) {
            ends.push(ends[ends.len() - 1] + w[0].distance(w[1]));
        }
        let share = share.max(0.0);
        // The segment in which each new point lies, and where in it.
        let places: Vec<(usize, f32)> = ends
            .iter()
            .map(|end| {
                let at = end * share;
                let k = ends.partition_point(|end| *end <= at).clamp(1, ends.len() - 1) - 1;
                let length = ends[k + 1] - ends[k];
                (k, if length > 0.0 { ((at - ends[k]) / length).min(1.0) } else { 0.0 })
            })
            .collect();
        for (to, (k, part)) in range.clone().zip(&places) {
            groom.points[to] = points[*k].lerp(points[k + 1], *part);
        }
        if !groom.radii.is_empty() {
            let radii = groom.radii[range.clone()].to_vec();
            for (to, (k, part)) in range.clone().zip(&places) {
                groom.radii[to] = radii[*k] + (radii[k + 1] - radii[*k]) * part;
            }
        }
        if !groom.colors.is_empty() {
            let colors = groom.colors[range.clone()].to_vec();
            for (to, (k, part)) in range.zip(&places) {
                groom.colors[to] = colors[*k].lerp(colors[k + 1], *part);
            }
        }
    }
}

/// Keeps the strands `s` with `keep(s)` and removes the others. Guides that are removed are replaced by another
/// guide of the same strand; a strand that loses all of its guides follows the nearest kept strand that is a guide
/// of the file, or itself.
///
/// ```
/// use glam::Vec3;
/// use hairspring::groom::{Groom, keep_strands};
///
/// let strand = |x: f32| [0.0, 1.0, 2.0].map(|y| Vec3::new(x, y, 0.0));
/// let mut groom = Groom::from_strands([strand(0.0), strand(1.0), strand(2.0)], 35e-6);
/// keep_strands(&mut groom, |s| s != 1);
/// assert_eq!((groom.strand_count(), groom.strand(1)[0].x), (2, 2.0));
/// ```
pub fn keep_strands(groom: &mut Groom, keep: impl Fn(usize) -> bool) {
    let kept: Vec<usize> = (0..groom.strand_count()).filter(|s| keep(*s)).collect();
    if kept.len() == groom.strand_count() {
        return;
    }
    let mut moved = vec![u32::MAX; groom.strand_count()];
    kept.iter().enumerate().for_each(|(to, from)| moved[*from] = to as u32);
    let mut offsets = vec![0];
    let (mut points, mut radii, mut colors) = (Vec::new(), Vec::new(), Vec::new());
    for s in &kept {
        let range = groom.range(*s);
        points.extend_from_slice(&groom.points[range.clone()]);
        radii.extend_from_slice(groom.radii.get(range.clone()).unwrap_or_default());
        colors.extend_from_slice(groom.colors.get(range).unwrap_or_default());
        offsets.push(points.len() as u32);
    }
    let guides = guides_of(groom, &kept, &moved);
    pick(&mut groom.roots, &kept);
    pick(&mut groom.groups, &kept);
    pick(&mut groom.root_uvs, &kept);
    pick(&mut groom.scales, &kept);
    (groom.points, groom.radii, groom.colors, groom.offsets, groom.guides) =
        (points, radii, colors, offsets, guides);
}

/// Keeps the share `shares[s]` of the strands around strand `s`, 0 to 1: strand `s` is kept if its share is above
/// element `s` of a sequence that fills 0 to 1 evenly in every run of strands (multiples of √2 modulo 1).
///
/// ```
/// use glam::Vec3;
/// use hairspring::groom::{Groom, thin};
///
/// let mut groom = Groom::from_strands((0..1000).map(|k| [0.0, 1.0, 2.0].map(|y| Vec3::new(k as f32, y, 0.0))), 35e-6);
/// thin(&mut groom, &[0.3; 1000]);
/// assert!((295..=305).contains(&groom.strand_count()));
/// ```
///
/// # Panics
/// If `shares` does not have an entry for each strand.
pub fn thin(groom: &mut Groom, shares: &[f32]) {
    assert_eq!(shares.len(), groom.strand_count(), "a share for each strand");
    let element = |s: usize| (0.5 + s as f64 * std::f64::consts::SQRT_2).fract();
    keep_strands(groom, |s| element(s) < f64::from(shares[s]));
}

/// Returns the guides of the kept strands, by their new indices.
fn guides_of(groom: &Groom, kept: &[usize], moved: &[u32]) -> Vec<GuideWeights> {
    if groom.guides.is_empty() {
        return Vec::new();
    }
    let root = |s: usize| groom.strand(s)[0];
    let left = |s: u32| moved[s as usize] != u32::MAX;
    let mut guides: Vec<u32> =
        kept.iter().flat_map(|s| groom.guides[*s].guides).filter(|guide| left(*guide)).collect();
    guides.sort_unstable();
    guides.dedup();
    let of = |s: &usize| {
        let own = groom.guides[*s];
        let sum: f32 = own.guides.iter().zip(own.weights).filter(|(g, _)| left(**g)).map(|(_, w)| w).sum();
        if sum > 0.0 {
            let first = own.guides.into_iter().zip(own.weights).find(|(g, w)| left(*g) && *w > 0.0);
            let spare = first.map_or(0, |(g, _)| moved[g as usize]);
            return GuideWeights {
                guides: own.guides.map(|g| if left(g) { moved[g as usize] } else { spare }),
                weights: [0, 1, 2].map(|k| if left(own.guides[k]) { own.weights[k] / sum } else { 0.0 }),
            };
        }
        let far = |g: &u32| root(*g as usize).distance_squared(root(*s));
        let nearest = guides.iter().copied().min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(*s as u32);
        GuideWeights { guides: [moved[nearest as usize]; 3], weights: [1.0, 0.0, 0.0] }
    };
    kept.iter().map(of).collect()
}

/// Keeps the entries of these strands. An empty array stays empty.
fn pick<T: Clone>(array: &mut Vec<T>, kept: &[usize]) {
    if !array.is_empty() {
        *array = kept.iter().map(|s| array[*s].clone()).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, Vec3};

    fn two() -> Groom {
        let strand = |x: f32| [0.0, 1.0, 3.0, 4.0].map(|y| Vec3::new(x, -y, 0.0));
        Groom {
            radii: vec![4.0, 3.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0],
            ..Groom::from_strands([strand(0.0), strand(1.0)], 1.0)
        }
    }

    #[test]
    fn a_cut_strand_ends_where_it_was_cut_and_keeps_its_thickness_there() {
        let mut groom = two();
        cut(&mut groom, &[0.5, 2.0]);
        let y: Vec<f32> = groom.strand(0).iter().map(|p| -p.y).collect();
        assert_eq!(y, [0.0, 0.5, 1.5, 2.0]);
        assert_eq!(groom.radii[..4], [4.0, 3.5, 2.5, 2.0]);
        assert_eq!(groom.strand(1), two().strand(1));
        cut(&mut groom, &[0.0, 1.0]);
        assert_eq!(groom.strand_length(0), 0.0);
    }

    #[test]
    fn kept_strands_keep_their_values() {
        let mut groom = two();
        groom.points.extend_from_within(..4);
        groom.radii.extend_from_within(..4);
        groom.offsets.push(12);
        groom.root_uvs = vec![Vec2::ZERO, Vec2::X, Vec2::Y];
        groom.groups = vec![5, 6, 7];
        let weights = |guides| GuideWeights { guides, weights: [0.5, 0.25, 0.25] };
        groom.guides = vec![weights([0, 1, 2]), weights([1, 0, 2]), weights([1, 1, 1])];
        keep_strands(&mut groom, |s| s != 1);
        assert_eq!((groom.strand_count(), &groom.groups[..], groom.root_uvs[1]), (2, &[5, 7][..], Vec2::Y));
        assert_eq!((groom.offsets.as_slice(), groom.radii.len()), (&[0, 4, 8][..], 8));
        // Two thirds and one third of what is left; and the nearest guide, which has the same root.
        assert_eq!(groom.guides[0].guides, [0, 0, 1]);
        assert!(
            groom.guides[0]
                .weights
                .iter()
                .zip([2.0 / 3.0, 0.0, 1.0 / 3.0])
                .all(|(a, b)| (a - b).abs() < 1e-6)
        );
        assert_eq!((groom.guides[1].guides, groom.guides[1].weights[0]), ([0; 3], 1.0));
        keep_strands(&mut groom, |_| false);
        assert_eq!((groom.strand_count(), groom.point_count()), (0, 0));
    }
}
