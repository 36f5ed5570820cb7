//! Colliders that push hair out during the pre-roll: how they move, and which hair starts inside colliders.
//!
//! ```text
//!  a shape grows in the hair                     a sheet closes in on the hair
//!    │ │ · │ │     │ (·) │     ( (   ) )           ╭───────────╮
//!    │ │ · │ │  →  │ (·) │  →  ( (   ) )           │  \ │ │ /  │  →  ╭───────╮  →   ╭────╮
//!    │ │ · │ │     │ (·) │     ( (   ) )           │   ( • )   │     │ ( • ) │      │(•) │
//! ```
//!
//! Hair that passes through a sheet cannot be pushed back by its thickness. The sheet therefore starts so large that
//! the hair does not reach it, and shrinks to its own size about the roots of that hair.

use super::{body::StagedBody, hair::StagedHair};
use crate::Shape;
use glam::Vec3;
use hairspring::{
    collide::{ColliderPose, ColliderShape, ThinShell},
    math::RigidTransform,
};
use std::sync::Arc;

/// Largest size at which a sheet starts, over its own [1].
const LARGEST: f32 = 16.0;

/// Growth of that size until no hair passes through the sheet [1].
const GROWTH: f32 = 1.25;

/// Largest motion of a sheet in a time slice, over its thickness [1].
const TRAVEL: f32 = 0.5;

/// Maximum number of time slices of a frame, a power of two.
const MOST_SLICES: usize = 64;

/// How a pushing collider moves to its own size.
pub(super) enum Motion {
    /// The shape grows from inside: its surface starts this deep [m].
    Grow(Shape, f32),
    /// The sheet shrinks about a point [m] from a multiple of its size.
    Shrink(Arc<ThinShell>, Vec3, f32),
    /// No hair is inside, and it stays as it is.
    Stay,
}

/// Returns the motion of each of the body's pushing colliders.
pub(super) fn motions(hair: &[StagedHair], body: &StagedBody) -> Vec<Motion> {
    let collider = |push: &super::body::InitialPush| &body.colliders()[push.collider];
    let strands = || hair.iter().flat_map(StagedHair::authored_points);
    let motion = |push| {
        let (collider, shape) = (collider(push), &push.shape);
        match (&collider.shape, shape) {
            (ColliderShape::Sheet(sheet), _) => shrink(sheet, &collider.end, strands()),
            (_, Some(shape)) => {
                let pose = collider.end_pose();
                let depth = strands().flatten().map(|p| -pose.distance(*p)).fold(0.0, f32::max);
                if depth > 0.0 { Motion::Grow(shape.clone(), depth) } else { Motion::Stay }
            }
            _ => Motion::Stay,
        }
    };
    body.initial_pushes().iter().map(motion).collect()
}

/// Returns the motion of a sheet at `pose` that closes in on `strands` [m].
fn shrink<'a>(
    sheet: &Arc<ThinShell>,
    pose: &RigidTransform,
    strands: impl Iterator<Item = &'a [Vec3]>,
) -> Motion {
    let own = |points: &[Vec3]| points.iter().map(|p| pose.inverse_transform_point(*p)).collect::<Vec<_>>();
    let through: Vec<Vec<Vec3>> = strands.map(own).filter(|points| passes_through(sheet, points)).collect();
    if through.is_empty() {
        return Motion::Stay;
    }
    let center = through.iter().map(|points| points[0]).sum::<Vec3>() / through.len() as f32;
    let mut large = ThinShell::default();
    let mut factor = 1.0;
    while factor < LARGEST {
        factor *= GROWTH;
        large.update_scaled(sheet, center, (factor, factor));
        if !through.iter().any(|points| passes_through(&large, points)) {
            break;
        }
    }
    Motion::Shrink(sheet.clone(), center, factor)
}

/// Returns whether a strand passes through a sheet, both in the same space.
fn passes_through(sheet: &ThinShell, points: &[Vec3]) -> bool {
    points.windows(2).any(|ends| sheet.crossing(ends[0], ends[1]).is_some())
}

/// Returns whether a strand in the world passes through a thin shell.
pub(super) fn passes_through_shell(pose: &ColliderPose, points: &[Vec3]) -> bool {
    let ColliderShape::Sheet(sheet) = pose.shape() else { return false };
    let (turn, at) = (pose.end().0.transpose(), pose.end().1);
    passes_through(sheet, &points.iter().map(|p| turn * (*p - at)).collect::<Vec<_>>())
}

impl Motion {
    /// Sets `shape` for a frame that starts and ends at these fractions of the motion.
    pub(super) fn set(&self, shape: &mut ColliderShape, (from, to): (f32, f32)) {
        match self {
            Self::Stay => {}
            Self::Grow(own, depth) => {
                if let Some(grown) = own.shrunk(depth * (1.0 - to)).collider_shape() {
                    *shape = grown;
                }
            }
            // The last frames are at rest.
            Self::Shrink(sheet, ..) if from == 1.0 => *shape = ColliderShape::Sheet(sheet.clone()),
            Self::Shrink(sheet, center, factor) => {
                // The logarithm of the size changes at a constant rate, so the sheet is slow where it is small.
                let size = |progress: f32| factor.powf(1.0 - progress);
                let radius =
                    sheet.triangles().iter().flatten().map(|p| p.distance(*center)).fold(0.0, f32::max);
                let way = (size(from) - size(to)) * radius;
                let slices = (way / (TRAVEL * sheet.thickness())).ceil() as usize;
                let slices = slices.clamp(1, MOST_SLICES).next_power_of_two();
                let mut all: Vec<ColliderShape> = (0..slices)
                    .map(|k| {
                        let at = |k: usize| size(from + (to - from) * (k as f32 / slices as f32));
                        let mut slice = ThinShell::default();
                        slice.update_scaled(sheet, *center, (at(k + 1), at(k)));
                        ColliderShape::Sheet(Arc::new(slice))
                    })
                    .collect();
                if let Some(mut last) = all.pop() {
                    last.set_previous_slices(all);
                    *shape = last;
                }
            }
        }
    }
}
