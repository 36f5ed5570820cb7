//! Measurements of the authored groom: distances of points from their roots, and depths of segments inside
//! bodies.

use super::{Simulation, along::arc_lengths, build::simulated_points};
use crate::parallel::prelude::*;
use crate::{
    collide::ColliderPose,
    material::profile_at,
    simd::lanes::{LANES, Row},
};

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
            let whole = lengths[lengths.len() - 1].max(1e-9);
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
        let tiles: Vec<Vec<Row>> = self
            .model
            .tiles
            .par_iter()
            .zip(self.model.groom_strands.par_chunks(LANES))
            .map(|(tile, lanes)| {
                let mut depths = vec![Row::default(); tile.points as usize];
                for (lane, s) in lanes.iter().enumerate().filter(|(_, s)| **s != u32::MAX) {
                    let points = simulated_points(tile.model, self.model.groom.strand(*s as usize));
                    let stride = tile.model.stride();
                    for i in (2 * stride..points.len()).step_by(stride) {
                        let [a, b] = [points[i - stride], points[i]];
                        let depth = colliders.iter().map(|o| o.least_distance(a, b).min(o.distance(a)));
                        depths[i].0[lane] = depth.fold(0.0, f32::min);
                    }
                }
                depths
            })
            .collect();
        let none = tiles.iter().flatten().all(|row| row.0 == [0.0; LANES]);
        if none { Vec::new() } else { tiles.concat() }
    }
}
