//! Report of hair that starts inside colliders.

use super::{Stage, hair::StagedHair, initial_push::passes_through_shell};
use hairspring::collide::{ColliderPose, MovingCollider};
use std::fmt;

/// Report of hair that starts inside colliders, where it may stay as deep as it is, and of hair that starts through
/// a sheet. Hair beneath the skin together with its root is not included.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct StartsInside {
    /// Number of simulated strands with a point inside a collider.
    pub strands: usize,
    /// Depth of the deepest of these points [m].
    pub depth: f32,
    /// Number of simulated strands that pass through a sheet.
    pub through_sheets: usize,
    /// Number of simulated strands of the scene.
    pub all: usize,
    /// Whether a collider or a sheet of the scene is among these colliders, and not only a mesh of the body.
    pub in_colliders: bool,
}

impl fmt::Display for StartsInside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { strands, depth, through_sheets, all, in_colliders } = *self;
        let inside = format!("{strands} start inside a collider, up to {:.1} mm deep", 1e3 * depth);
        let through = format!("{through_sheets} pass through a sheet");
        let what = match (strands, through_sheets) {
            (0, _) => through,
            (_, 0) => inside,
            _ => format!("{inside}, and {through}"),
        };
        write!(f, "of {all} simulated strands, {what}; they may stay so")?;
        if in_colliders {
            write!(
                f,
                "; to push hair out before the scene begins, add `initial = \"push\"` to the [[collider]] or [[sheet]]"
            )?;
        }
        Ok(())
    }
}

impl Stage {
    /// Returns a report if hair starts inside colliders. It describes the current state, so it is called before the
    /// first step.
    pub fn starts_inside(&self) -> Option<StartsInside> {
        let measure = self.measure();
        let own = self.body.sheets_and_colliders();
        let poses: Vec<ColliderPose> = own.iter().map(MovingCollider::end_pose).collect();
        let strands = self.hair.iter().flat_map(StagedHair::simulated_points);
        let through = |points: &&[glam::Vec3]| poses.iter().any(|pose| passes_through_shell(pose, points));
        let through_sheets = strands.filter(through).count();
        let in_colliders = through_sheets > 0 || self.simulation.measure(&own).started_inside_strands > 0;
        (measure.started_inside_strands > 0 || through_sheets > 0).then_some(StartsInside {
            strands: measure.started_inside_strands,
            depth: measure.started_inside_depth as f32,
            through_sheets,
            all: self.simulation.strand_count(),
            in_colliders,
        })
    }
}
