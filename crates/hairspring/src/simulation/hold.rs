//! What holds or pulls points from outside: pins, loads, clamped ends.

use super::Simulation;
use crate::strand::{
    lanes::{LANES, Row},
    tile::{HoldRows, hold},
};
use glam::Vec3;

/// One point held or pulled.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hold {
    /// The strand, as an index of those given to [`Simulation::new`].
    pub strand: u32,
    /// The point of it; 2 or more, because the first two are driven by the root.
    pub point: u32,
    /// Where the point is held, in the world [m]; `None`: it is free.
    pub target: Option<Vec3>,
    /// Force on it [N].
    pub force: Vec3,
    /// Whether the frame of the segment from this point keeps its twist (rod model). With the segment's two points held, the strand is
    /// clamped there.
    pub clamped: bool,
}

impl Simulation {
    /// Holds these points from now on, and lets go of all others.
    ///
    /// # Panics
    /// If a strand or a point is none of the simulation's.
    pub fn set_holds(&mut self, holds: &[Hold]) {
        self.holds = if holds.is_empty() { Vec::new() } else { vec![Vec::new(); self.tiles.len()] };
        for held in holds {
            let place = self.places[held.strand as usize] as usize;
            let points = self.groom.range(self.lanes[place] as usize).len();
            assert!(
                (2..points).contains(&(held.point as usize)),
                "a held point is of the strand and is not driven"
            );
            let (tile, lane) = (&mut self.holds[place / LANES], place % LANES);
            let at = tile.iter().position(|h| h.point == held.point).unwrap_or_else(|| {
                tile.push(HoldRows { point: held.point, rows: [Row::default(); hold::ROWS] });
                tile.len() - 1
            });
            let rows = &mut tile[at].rows;
            let target = held.target.unwrap_or_default();
            for k in 0..3 {
                rows[hold::TARGET + k].0[lane] = target[k];
                rows[hold::FORCE + k].0[lane] = held.force[k];
            }
            rows[hold::PINNED].0[lane] = if held.target.is_some() { 1.0 } else { 0.0 };
            rows[hold::CLAMPED].0[lane] = if held.clamped { 1.0 } else { 0.0 };
        }
        self.holds.iter_mut().for_each(|tile| tile.sort_by_key(|h| h.point));
    }
}
