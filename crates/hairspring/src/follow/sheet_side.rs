//! Keeps follow hairs on the side of a thin shell that their first guide is on.
//!
//! ```text
//!    guide        follow hair
//!      ●───────║───────○         a shell pushes out only what is within its thickness: a point behind it would stay
//!      ●──────○║                 behind it, so the point moves to where the line from its guide meets the shell
//! ```

use super::style::point_on_guide;
use crate::parallel::prelude::*;
use crate::{
    collide::{ColliderPose, ColliderShape, Crossing, ThinShell},
    groom::{Groom, GuideWeights},
};
use glam::Vec3;

/// Returns the thin shells among the colliders.
fn shells(poses: &[ColliderPose]) -> impl Iterator<Item = (&ThinShell, &ColliderPose)> {
    poses.iter().filter_map(|pose| match &pose.shape {
        ColliderShape::Sheet(shell) => Some((&**shell, pose)),
        _ => None,
    })
}

/// Returns the first crossing of the line from `from` to `to` [m] with a shell at `pose`, in the world.
fn crossing(shell: &ThinShell, pose: &ColliderPose, from: Vec3, to: Vec3) -> Option<Crossing> {
    let (turn, at) = &pose.end;
    let [a, b] = [from, to].map(|p| turn.transpose() * (p - *at));
    shell.crossing(a, b).map(|crossing| Crossing { normal: *turn * crossing.normal, ..crossing })
}

/// See [`FollowLayout::apart`](super::FollowLayout::apart). `weights` refer to the indices of `guides`.
pub(super) fn apart(
    groom: &Groom,
    guides: &[u32],
    weights: &[GuideWeights],
    coordinates: &[[u16; 3]],
    colliders: &[ColliderPose],
) -> Vec<bool> {
    if shells(colliders).next().is_none() {
        return Vec::new();
    }
    let of_strand = |s: usize| {
        let lead = groom.strand(guides[weights[s].guides[0] as usize] as usize);
        groom.range(s).map(move |i| {
            let guide = point_on_guide(lead, coordinates[i][0]);
            shells(colliders).any(|(shell, pose)| crossing(shell, pose, guide, groom.points[i]).is_some())
        })
    };
    let apart: Vec<bool> = (0..groom.strand_count()).into_par_iter().flat_map_iter(of_strand).collect();
    if apart.contains(&true) { apart } else { Vec::new() }
}

/// Moves those points of a strand that a shell separates from the strand's first guide, with points `lead`, to
/// the guide's side of it. The root is not moved, and neither are points that are `apart` at rest.
pub(super) fn keep_on_side(
    colliders: &[ColliderPose],
    lead: &[Vec3],
    ride: &[[u16; 3]],
    apart: Option<&[bool]>,
    strand: &mut [Vec3],
) {
    for (shell, pose) in shells(colliders) {
        for (i, (p, ride)) in strand.iter_mut().zip(ride).enumerate().skip(1) {
            if apart.is_some_and(|apart| apart[i]) {
                continue;
            }
            let guide = point_on_guide(lead, ride[0]);
            if let Some(Crossing { fraction, normal }) = crossing(shell, pose, guide, *p) {
                *p = guide + (*p - guide) * fraction + normal * shell.thickness();
            }
        }
    }
}
