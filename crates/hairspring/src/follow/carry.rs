//! Transforms of the guides, applied to the hairs that follow them.

use crate::groom::{Groom, GuideWeights};
use crate::parallel::prelude::*;
use glam::{Affine3A, Mat3A, Quat, Vec3, Vec3A};

/// Returns the coordinate of every point on each of its guides: the position at the same arc length, or the
/// tip if the guide is shorter.
pub(super) fn rides(groom: &Groom, guides: &[u32], weights: &[GuideWeights]) -> Vec<[u16; 3]> {
    let arcs = |s: usize| {
        let mut arc = 0.0;
        let mut out = vec![0.0];
        for w in groom.strand(s).windows(2) {
            arc += w[0].distance(w[1]);
            out.push(arc);
        }
        out
    };
    let guide_arcs: Vec<Vec<f32>> = guides.par_iter().map(|s| arcs(*s as usize)).collect();
    let of_strand = |s: usize| {
        let own = arcs(s);
        let w = weights[s];
        (0..own.len())
            .map(|i| w.guides.map(|g| position(&guide_arcs[g as usize], own[i])))
            .collect::<Vec<_>>()
    };
    (0..groom.strand_count()).into_par_iter().flat_map_iter(of_strand).collect()
}

/// Smallest length of a segment that is divided by [m].
const MIN_LENGTH: f32 = 1e-9;

/// Returns the position of arc length `at` among increasing `arcs`, as a 16-bit fraction of the points.
fn position(arcs: &[f32], at: f32) -> u16 {
    let last = arcs.len() - 1;
    let i = arcs.partition_point(|a| *a <= at).clamp(1, last) - 1;
    let t = ((at - arcs[i]) / (arcs[i + 1] - arcs[i]).max(MIN_LENGTH)).clamp(0.0, 1.0);
    ((i as f32 + t) / last as f32 * u16::MAX as f32).round() as u16
}

/// Computes the transform from rest to the current pose at every guide point. The rotation is that of the
/// root, parallel-transported by the smallest rotations between the rest tangents and the current ones.
pub(super) fn update_guide_transforms(
    groom: &Groom,
    guides: &[u32],
    offsets: &[u32],
    points: &[Vec3],
    turns: &[Quat],
    guide_transforms: &mut [Affine3A],
) {
    super::split_by(guide_transforms, offsets).into_par_iter().enumerate().with_min_len(16).for_each(
        |(k, out)| {
            let rest = groom.strand(guides[k] as usize);
            let now = &points[offsets[k] as usize..offsets[k + 1] as usize];
            let mut turn = turns[k];
            for i in 0..rest.len() {
                let (a, b) = if i + 1 < rest.len() { (i, i + 1) } else { (i - 1, i) };
                let was = (turn * (rest[b] - rest[a])).try_normalize();
                if let (Some(was), Some(is)) = (was, (now[b] - now[a]).try_normalize()) {
                    turn = (Quat::from_rotation_arc(was, is) * turn).normalize();
                }
                let m = Mat3A::from_quat(turn);
                out[i] = Affine3A { matrix3: m, translation: Vec3A::from(now[i]) - m * Vec3A::from(rest[i]) };
            }
        },
    );
}

/// Applies the guides' transforms to the rest points of one strand.
pub(super) fn carry(
    rest: &[Vec3],
    weights: &GuideWeights,
    guide_transforms: [&[Affine3A]; 3],
    ride: &[[u16; 3]],
    out: &mut [Vec3],
) {
    for ((p0, ride), p) in rest.iter().zip(ride).zip(out) {
        let p0 = Vec3A::from(*p0);
        let mut sum = Vec3A::ZERO;
        for k in 0..3 {
            let w = weights.weights[k];
            if w == 0.0 {
                continue;
            }
            let last = guide_transforms[k].len() - 1;
            let at = ride[k] as f32 * (last as f32 / u16::MAX as f32);
            let i = (at as usize).min(last - 1);
            let t = at - i as f32;
            let [a, b] =
                [&guide_transforms[k][i], &guide_transforms[k][i + 1]].map(|m| m.transform_point3a(p0));
            sum += (a + (b - a) * t) * w;
        }
        *p = sum.into();
    }
}
