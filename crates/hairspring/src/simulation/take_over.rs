//! Takes over the state of another simulation of the same strands: the settings may differ, positions and
//! motion are kept.
//!
//! Where a strand's elastic model differs, the state that both models share is converted:
//!
//! ```text
//! edges, velocities, contact, depths     unchanged, at the strand's own points
//! frames                                 the rod stores them; the truss has them in its extra particles;
//!                                        the other models transport them from the root
//! extra particles                        beside their segments, on the frame's side, rotating with them
//! tensions                               unchanged between models with the same segments;
//!                                        between those and the truss, the tensions of the rest shape
//! ```

use super::Simulation;
use crate::{
    settings::Integrator,
    simd::lanes::{LANES, Row},
    strand::{
        model::bend::transport_normal,
        tile::{Elastic, history, rest, springs, state, strand},
        truss::{ASIDE, normal_of, side},
    },
};
use glam::{DVec3, Quat, Vec3};
use std::sync::Arc;

impl Simulation {
    /// Continues from the state of `old` with the settings of `self`, which must be new. Every strand keeps
    /// its position and motion, and may be as deep in colliders as it was authored there. Manipulators and
    /// force fields stay active; holds of [`Simulation::set_holds`] are released.
    ///
    /// # Panics
    /// If the two do not simulate the same strands in the same order.
    pub fn take_over(&mut self, old: &Simulation) {
        assert!(self.strands().eq(old.strands()), "both must have the same strands in the same order");
        self.solver.level = old.solver.level;
        self.state.anchor = old.state.anchor;
        self.state.motion = old.state.motion;
        self.state.last_h = old.state.last_h;
        self.force_fields.clone_from(&old.force_fields);
        self.interval.segments = old.interval.segments;
        self.state.charged.clone_from(&old.state.charged);
        Arc::make_mut(&mut self.model).rest_penetration = if old.model.rest_penetration.is_empty() {
            Vec::new()
        } else {
            vec![Row::default(); self.state.points.len()]
        };
        let mut lanes = vec![u32::MAX; old.model.lanes.len()];
        for k in 0..self.model.places.len() {
            let (place, from) = (self.model.places[k] as usize, old.model.places[k] as usize);
            lanes[from] = place as u32;
            let rows = &mut self.state.strand[place / LANES];
            for (row, was) in rows[..strand::FIRST].iter_mut().zip(&old.state.strand[from / LANES]) {
                row.0[place % LANES] = was.0[from % LANES];
            }
            self.state.contact_age[place / LANES].0[place % LANES] =
                old.state.contact_age[from / LANES].0[from % LANES];
            if self.model.tiles[place / LANES].model == old.model.tiles[from / LANES].model {
                self.take_rows(place, old, from);
            } else {
                self.take_points(place, old, from);
            }
        }
        if let (Some(neighbours), Some(old)) = (&mut self.neighbours, &old.neighbours) {
            neighbours.set_contacts(old.contacts());
        }
        self.take_over_tools(old, &lanes);
    }

    /// Returns whether the integrator updates tensions and contact forces in every substep and carries them
    /// to the next. Other integrators do not change them.
    fn carries_forces(&self) -> bool {
        matches!(self.model.solver.integrator, Integrator::BackwardEuler | Integrator::Bdf2)
    }

    /// Copies a strand with the same model, row by row.
    fn take_rows(&mut self, place: usize, old: &Simulation, from: usize) {
        let model = self.model.tiles[place / LANES].model;
        let forces = self.carries_forces() && old.carries_forces();
        let tensions = [Some(state::TENSION), (model == Elastic::Springs).then_some(springs::SIDE)];
        let kept = |at: usize| !forces && (tensions.contains(&Some(at)) || at == state::NORMAL_FORCE);
        let (tile, was) = (self.model.tiles[place / LANES], old.model.tiles[from / LANES]);
        let (lane, from_lane) = (place % LANES, from % LANES);
        for i in 0..tile.points.min(was.points) {
            let (to, from) = ((tile.first + i) as usize, (was.first + i) as usize);
            for at in (0..state::ROWS).filter(|at| !kept(*at)) {
                self.state.points[to][at].0[lane] = old.state.points[from][at].0[from_lane];
            }
            for at in [rest::CLEARANCE, rest::EXPOSURE] {
                Arc::make_mut(&mut self.model).rest[to][at].0[lane] = old.model.rest[from][at].0[from_lane];
            }
            if let Some(sunk) = Arc::make_mut(&mut self.model).rest_penetration.get_mut(to) {
                sunk.0[lane] = old.model.rest_penetration[from].0[from_lane];
            }
            if let (true, Some(span), Some(was)) =
                (forces, self.state.segment_contacts.get_mut(to), old.state.segment_contacts.get(from))
            {
                span.iter_mut().zip(was).for_each(|(row, was)| row.0[lane] = was.0[from_lane]);
            }
            if let (Some(history), Some(was)) = (self.state.history.get_mut(to), old.state.history.get(from))
            {
                history.iter_mut().zip(was).for_each(|(row, was)| row.0[lane] = was.0[from_lane]);
            }
        }
        if old.state.history.is_empty() {
            self.begin_history(place);
        }
    }

    /// Converts a strand with another model, point by point.
    fn take_points(&mut self, place: usize, old: &Simulation, from: usize) {
        let [stride, was] =
            [self.model.tiles[place / LANES].model, old.model.tiles[from / LANES].model].map(Elastic::stride);
        let forces = self.carries_forces() && old.carries_forces();
        let edge = |j: usize| (1..=was).map(|k| old.vector(from, j * was + k, state::EDGE)).sum::<Vec3>();
        let velocity = |j: usize| old.vector(from, j * was, state::V);
        for j in 0..self.points(place) {
            let (i, i_was) = (j * stride, j * was);
            self.set_vector(place, i, state::V, velocity(j));
            let at = self.model.tiles[place / LANES].first as usize + i;
            for row in [rest::CLEARANCE, rest::EXPOSURE] {
                Arc::make_mut(&mut self.model).rest[at][row].0[place % LANES] = old.rest(from, i_was, row);
            }
            if let Some(sunk) = Arc::make_mut(&mut self.model).rest_penetration.get_mut(at) {
                sunk.0[place % LANES] = old.sunk(from, i_was);
            }
            let was_at = old.model.tiles[from / LANES].first as usize + i_was;
            if let (true, Some(span), Some(was)) =
                (forces, self.state.segment_contacts.get_mut(at), old.state.segment_contacts.get(was_at))
            {
                span.iter_mut().zip(was).for_each(|(row, was)| row.0[place % LANES] = was.0[from % LANES]);
            }
            if forces {
                let rows = &mut self.state.points[at];
                let was_at = &old.state.points[was_at];
                rows[state::NORMAL_FORCE].0[place % LANES] = was_at[state::NORMAL_FORCE].0[from % LANES];
                if stride == was {
                    rows[state::TENSION].0[place % LANES] = was_at[state::TENSION].0[from % LANES];
                }
            }
        }
        for (j, normal) in old.frames(from).into_iter().enumerate() {
            let i = j * stride;
            if stride == 1 {
                self.set_vector(place, i + 1, state::EDGE, edge(j));
                self.set_vector(place, i, state::NORMAL, normal.as_vec3());
                continue;
            }
            // The triangle over the segment, rotating with it.
            let (e, [a, b]) = (edge(j).as_dvec3(), [velocity(j), velocity(j + 1)].map(Vec3::as_dvec3));
            let length = f64::from(self.rest(place, i, rest::LENGTH));
            let aside = side(j, e.normalize_or(DVec3::Y), normal) * (ASIDE * length);
            let spin = e.cross(b - a) / e.length_squared().max(1e-24);
            self.set_vector(place, i + 1, state::EDGE, (0.5 * e + aside).as_vec3());
            self.set_vector(place, i + 2, state::EDGE, (0.5 * e - aside).as_vec3());
            self.set_vector(place, i + 1, state::V, (0.5 * (a + b) + spin.cross(aside)).as_vec3());
        }
        self.begin_history(place);
    }

    /// Initializes the history of the second-order integrator as if the strand had moved at its current
    /// velocity.
    pub(super) fn begin_history(&mut self, place: usize) {
        let (tile, lane) = (self.model.tiles[place / LANES], place % LANES);
        let points = tile.first as usize..(tile.first + tile.points) as usize;
        for (history, state) in
            self.state.history.iter_mut().zip(&self.state.points).take(points.end).skip(points.start)
        {
            for k in 0..3 {
                let v = state[state::V + k].0[lane];
                history[history::V + k].0[lane] = v;
                history[history::WAY + k].0[lane] = v * self.state.last_h;
            }
        }
    }

    /// Returns the frame's normal on each segment of the strand in lane `place`; shape `[points − 1]`.
    fn frames(&self, place: usize) -> Vec<DVec3> {
        let (tile, lane) = (place / LANES, place % LANES);
        let (model, rows) = (self.model.tiles[tile].model, &self.state.strand[tile]);
        let turn = Quat::from_array([0, 1, 2, 3].map(|k| rows[strand::TURN_END + k].0[lane]));
        let normal = Vec3::from_array([0, 1, 2].map(|k| rows[strand::NORMAL + k].0[lane]));
        let mut normal = (self.state.anchor.rotation * turn * normal).as_dvec3();
        let stride = model.stride();
        let mut before = None;
        (0..self.points(place) - 1)
            .map(|j| {
                let e: DVec3 =
                    (1..=stride).map(|k| self.vector(place, j * stride + k, state::EDGE).as_dvec3()).sum();
                let t = e.normalize_or(before.unwrap_or(DVec3::Y));
                if let Some(before) = before {
                    normal = transport_normal(normal, before, t);
                }
                let own = match model {
                    Elastic::Rod if j > 0 => self.vector(place, j, state::NORMAL).as_dvec3(),
                    Elastic::Springs => {
                        let extra = self.vector(place, 2 * j + 1, state::EDGE).as_dvec3() - 0.5 * e;
                        normal_of(j, t, extra.reject_from_normalized(t).normalize_or_zero())
                    }
                    _ => DVec3::ZERO,
                };
                normal = own.reject_from_normalized(t).normalize_or(normal);
                before = Some(t);
                normal
            })
            .collect()
    }

    pub(super) fn set_vector(&mut self, place: usize, i: usize, component: usize, v: Vec3) {
        let (tile, lane) = (place / LANES, place % LANES);
        let rows = &mut self.state.points[self.model.tiles[tile].first as usize + i][component..];
        (rows[0].0[lane], rows[1].0[lane], rows[2].0[lane]) = (v.x, v.y, v.z);
    }
}
