//! Measurements of the authored groom: distances of points from their roots, depths of segments inside bodies, and
//! points deep inside meshes.

use super::{
    Simulation,
    build::simulated_points,
    multipliers::{MIN_LENGTH, arc_lengths},
};
use crate::parallel::prelude::*;
use crate::{
    collide::{ColliderPose, ColliderShape},
    material::profile_at,
    simd::lanes::{LANES, Row},
};
use glam::Vec3;

/// Depth from which on a point that is authored inside a mesh does not touch that mesh [m].
///
/// Other points may stay at their authored depth and rest on the surface at that depth. Deep inside a mesh with ears, a
/// nose and a neck, such a surface has edges where the nearest skin changes sides, and hair on them never comes to rest.
const MIN_PASSING_DEPTH: f32 = 5e-3;

impl Simulation {
    /// Returns the largest distance of each point from its root, see `Tile::tether_lengths`.
    pub(super) fn tethers(&self) -> Vec<Row> {
        if self.model.materials.iter().all(|m| m.tether == 0.0) {
            return Vec::new();
        }
        let mut reach = vec![Row([f32::INFINITY; LANES]); self.state.points.len()];
        for (place, s) in self.model.groom_strands.iter().enumerate().filter(|(_, s)| **s != u32::MAX) {
            let s = *s as usize;
            let material = self.model.material(s);
            if material.tether == 0.0 {
                continue;
            }
            let tether = material.tether * self.model.groom.scale(s).tether;
            let tile = self.model.tiles[place / LANES];
            let points = self.model.groom.strand(s);
            let lengths = arc_lengths(points);
            let whole = lengths[lengths.len() - 1].max(MIN_LENGTH);
            let mut before = 0.0f32;
            for (k, p) in points.iter().enumerate() {
                // Where a coil turns back toward its root, at least the distance that the length of hair
                // permits.
                let segment = p.distance(points[k.saturating_sub(1)]);
                let tether = tether * profile_at(&material.tether_profile, lengths[k] / whole) as f32;
                before = (tether.max(1.0) * p.distance(points[0])).max(before - segment);
                reach[tile.first as usize + k * tile.model.stride()].0[place % LANES] = before;
            }
        }
        reach
    }

    /// Returns the depth of the segment that ends at each point at rest, see `Tile::rest_penetration`.
    pub(super) fn authored_depths(&self, colliders: &[ColliderPose]) -> Vec<Row> {
        self.each_authored_point(|points, stride, i| {
            let [a, b] = [points[i - stride], points[i]];
            let depth = colliders.iter().map(|o| o.least_distance(a, b).min(o.distance(a)));
            depth.fold(0.0, f32::min)
        })
    }

    /// Returns the mesh that each point does not touch, see `StrandModel::passes`.
    pub(super) fn authored_passes(&self, colliders: &[ColliderPose]) -> Vec<Row> {
        self.each_authored_point(|points, _, i| {
            deep_inside(points[i], colliders).map_or(0.0, |k| (k + 1) as f32)
        })
    }

    /// Returns a value for each point of the strands that the root does not drive: `of(points, stride, i)`, and 0 for the
    /// driven points. Rows past the end of a strand repeat its last point. The result is empty if all values are 0.
    fn each_authored_point(&self, of: impl Fn(&[Vec3], usize, usize) -> f32 + Sync) -> Vec<Row> {
        let tiles: Vec<Vec<Row>> = self
            .model
            .tiles
            .par_iter()
            .zip(self.model.groom_strands.par_chunks(LANES))
            .map(|(tile, lanes)| {
                let mut rows = vec![Row::default(); tile.points as usize];
                for (lane, s) in lanes.iter().enumerate().filter(|(_, s)| **s != u32::MAX) {
                    let points = simulated_points(tile.model, self.model.groom.strand(*s as usize));
                    let stride = tile.model.stride();
                    for i in (2 * stride..points.len()).step_by(stride) {
                        rows[i].0[lane] = of(&points, stride, i);
                    }
                    let last = rows[points.len() - 1].0[lane];
                    rows[points.len()..].iter_mut().for_each(|row| row.0[lane] = last);
                }
                rows
            })
            .collect();
        let none = tiles.iter().flatten().all(|row| row.0 == [0.0; LANES]);
        if none { Vec::new() } else { tiles.concat() }
    }
}

/// Returns the index of the mesh that `p` is more than [`MIN_PASSING_DEPTH`] inside of; of several, the one in which it
/// is deepest.
fn deep_inside(p: Vec3, colliders: &[ColliderPose]) -> Option<usize> {
    let meshes = colliders.iter().enumerate().filter(|(_, o)| matches!(o.shape, ColliderShape::Field(_)));
    let depths = meshes.map(|(k, o)| (k, o.distance(p))).filter(|(_, d)| *d < -MIN_PASSING_DEPTH);
    depths.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
}
