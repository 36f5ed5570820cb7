//! Recovery from non-finite values: a strand with NaN or infinite state is reset to its rest shape at its
//! root, so that no NaN leaves a step.

use super::{Simulation, build::simulated_points};
use crate::{
    simd::{
        dispatch::dispatch,
        lanes::{F, LANES, Row, Simd, load, store},
    },
    strand::tile::{Elastic, StateRows, springs, state},
};
use fearless_simd::Level;
use glam::{Quat, Vec3};

/// Returns whether every number of these rows is finite.
pub(super) fn all_finite(level: Level, points: &[StateRows]) -> bool {
    let mut sum = Row::default();
    dispatch!(level, simd => store(sum_of_noughts(simd, points), &mut sum));
    sum.0 == [0.0; LANES]
}

/// Returns the sum of x·0, which is 0 for finite x and NaN otherwise, without branches. Each row of a point
/// has its own sum, so that there is no dependency chain.
#[inline(always)]
fn sum_of_noughts<S: Simd>(simd: S, points: &[StateRows]) -> F<S> {
    let zero = F::splat(simd, 0.0);
    let mut sums = [zero; state::ROWS];
    for rows in points {
        for (sum, row) in sums.iter_mut().zip(rows) {
            *sum = load(simd, row).mul_add(zero, *sum);
        }
    }
    sums.into_iter().fold(zero, |all, sum| all + sum)
}

impl Simulation {
    /// Resets every strand with a non-finite number to its rest shape at its root, without motion. Returns
    /// how many were reset.
    pub(super) fn reset_non_finite(&mut self) -> usize {
        let mut count = 0;
        for place in 0..self.model.groom_strands.len() {
            let (tile, lane) = (place / LANES, place % LANES);
            let first = self.model.tiles[tile].first as usize;
            let rows = first..first + self.model.tiles[tile].points as usize;
            if self.model.groom_strands[place] != u32::MAX
                && self.state.points[rows.clone()].iter().flatten().any(|r| !r.0[lane].is_finite())
            {
                self.reset_strand(place);
                count += 1;
            } else if self.model.groom_strands[place] == u32::MAX {
                self.state.points[rows.clone()].iter_mut().flatten().for_each(|r| r.0[lane] = 0.0);
                if let Some(history) = self.state.history.get_mut(rows) {
                    history.iter_mut().flatten().for_each(|r| r.0[lane] = 0.0);
                }
            }
        }
        count
    }

    /// Resets every strand to its rest shape at the current pose of its root, without motion.
    pub fn reset(&mut self) {
        for k in 0..self.model.lane_of_strand.len() {
            self.reset_strand(self.model.lane_of_strand[k] as usize);
        }
        if let Some(neighbours) = &mut self.neighbours {
            neighbours.clear();
        }
        self.state.motion = super::teleport::Motion::default();
        self.state.last_h = 0.0;
    }

    pub(super) fn reset_strand(&mut self, place: usize) {
        let (tile, lane) = (place / LANES, place % LANES);
        let turn = self.strand(place).root_rotation();
        let turn = if turn.is_finite() { turn.normalize() } else { Quat::IDENTITY };
        let points = simulated_points(
            self.model.tiles[tile].model,
            self.model.groom.strand(self.model.groom_strands[place] as usize),
        )
        .into_owned();
        self.state.contact_age[tile].0[lane] = 0.0;
        let springs = self.model.tiles[tile].model == Elastic::Springs;
        for i in 0..self.model.tiles[tile].points as usize {
            let at = |i: usize| points[i.min(points.len() - 1)];
            let edge: Vec3 = turn * (at(i) - at(i.saturating_sub(1)));
            let at = self.model.tiles[tile].first as usize + i;
            if let Some(history) = self.state.history.get_mut(at) {
                history.iter_mut().for_each(|r| r.0[lane] = 0.0);
            }
            if let Some(span) = self.state.segment_contacts.get_mut(at) {
                span.iter_mut().for_each(|r| r.0[lane] = 0.0);
            }
            let rows = &mut self.state.points[at];
            rows.iter_mut().for_each(|row| row.0[lane] = 0.0);
            // The tension that balances the rest shape.
            rows[state::TENSION].0[lane] = self.model.tensions[0][at].0[lane];
            if springs {
                rows[springs::SIDE].0[lane] = self.model.tensions[1][at].0[lane];
            }
            for (row, x) in rows[state::EDGE..].iter_mut().zip(edge.to_array()) {
                row.0[lane] = x;
            }
        }
    }
}
