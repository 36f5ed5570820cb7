//! Report of hair that starts inside colliders.

use super::{Stage, hair::StagedHair, initial_push::passes_through_shell};
use glam::Vec3;
use hairspring::collide::{ColliderPose, ColliderShape, MovingCollider};
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
    /// Whether a collider or a sheet of the scene that could push hair out and does not is among these colliders.
    pub in_keeping: bool,
    /// Whether one that pushes hair out is among them: it did not get all of it out.
    pub in_pushing: bool,
    /// Number of simulated strands whose root is inside a shape that pushes hair out, which cannot move roots.
    pub roots_in_pushing: usize,
}

impl fmt::Display for StartsInside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { strands, depth, through_sheets, all, in_keeping, in_pushing, roots_in_pushing } = *self;
        if roots_in_pushing > 0 {
            write!(
                f,
                "of {all} simulated strands, {roots_in_pushing} have their root in a [[collider]] with `initial = \"push\"`, \
                 which cannot push them out; make it smaller, or use a [[sheet]] for a hat"
            )?;
            if strands == 0 && through_sheets == 0 {
                return Ok(());
            }
            write!(f, "; ")?;
        }
        let inside = format!("{strands} start inside a collider, up to {:.1} mm deep", 1e3 * depth);
        let through = format!("{through_sheets} pass through a sheet");
        let what = match (strands, through_sheets) {
            (0, _) => through,
            (_, 0) => inside,
            _ => format!("{inside}, and {through}"),
        };
        write!(f, "of {all} simulated strands, {what}; they may stay so")?;
        if in_keeping {
            write!(
                f,
                "; to push hair out before the scene begins, add `initial = \"push\"` to the [[collider]] or [[sheet]]"
            )?;
        }
        if strands > 0 && !in_keeping && !in_pushing {
            write!(
                f,
                "; move the groom out of the mesh, or give the body a [collision] mesh that the groom lies on"
            )?;
        }
        if in_pushing {
            write!(
                f,
                "; a [[collider]] or [[sheet]] with `initial = \"push\"` could not push all hair out: make it larger, \
                 or let the hair lie flat or end outside of it"
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
        let through = |colliders: &[MovingCollider]| {
            let poses: Vec<ColliderPose> = colliders.iter().map(MovingCollider::end_pose).collect();
            let strands = self.hair.iter().flat_map(StagedHair::simulated_points);
            strands.filter(|points| poses.iter().any(|pose| passes_through_shell(pose, points))).count()
        };
        let [keeping, pushing] = [false, true].map(|pushing| self.body.sheets_and_colliders(pushing));
        let through_sheets = through(&[&keeping[..], &pushing].concat());
        let is_in = |colliders: &[MovingCollider]| {
            through(colliders) > 0 || self.simulation.measure(colliders).started_inside_strands > 0
        };
        let shapes: Vec<ColliderPose> = pushing
            .iter()
            .filter(|collider| !matches!(collider.shape, ColliderShape::Sheet(_)))
            .map(MovingCollider::end_pose)
            .collect();
        let strands = self.hair.iter().flat_map(StagedHair::simulated_points);
        let in_shape = |points: &&[Vec3]| shapes.iter().any(|shape| shape.distance(points[0]) < 0.0);
        let roots_in_pushing = strands.filter(in_shape).count();
        let any = measure.started_inside_strands > 0 || through_sheets > 0 || roots_in_pushing > 0;
        any.then_some(StartsInside {
            strands: measure.started_inside_strands,
            depth: measure.started_inside_depth as f32,
            through_sheets,
            all: self.simulation.strand_count(),
            in_keeping: is_in(&keeping),
            in_pushing: is_in(&pushing),
            roots_in_pushing,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_advises_only_what_the_scene_does_not_do_yet() {
        let start = StartsInside {
            strands: 12,
            depth: 0.004,
            through_sheets: 3,
            all: 40,
            in_keeping: false,
            in_pushing: false,
            roots_in_pushing: 0,
        };
        let report = |in_keeping, in_pushing| StartsInside { in_keeping, in_pushing, ..start }.to_string();
        let (advice, limit) = ("add `initial = \"push\"`", "could not push all hair out");
        assert!(report(true, false).contains(advice) && !report(true, false).contains(limit));
        assert!(report(false, true).contains(limit) && !report(false, true).contains(advice));
        assert!(!report(false, false).contains("push"), "the body's own meshes do not push");
        let roots = StartsInside { strands: 0, through_sheets: 0, roots_in_pushing: 7, ..start }.to_string();
        assert!(roots.contains("7 have their root in") && !roots.contains("start inside"), "{roots}");
    }
}
