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

use super::{Simulation, carried_air::CarriedAir, strand_ref::StrandRef};
use crate::{
    settings::Integrator,
    simd::lanes::{LANES, Row},
    strand::{
        model::bend::transport_normal,
        tile::{Elastic, history, rest, springs, state},
        truss::{ASIDE, normal_of, side},
    },
};
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// Smallest squared length of a segment that is divided by [m²].
const MIN_SQUARED_SEGMENT: f64 = 1e-24;

impl Simulation {
    /// Continues from the state of `old` with the settings of `self`, which must be new. Every strand keeps
    /// its position and motion, and may be as deep in colliders as it was authored there. Manipulators and
    /// force fields stay active; holds of [`Simulation::set_holds`] are released.
    ///
    /// # Panics
    /// If the two do not simulate the same strands in the same order, with the same numbers of points.
    pub fn take_over(&mut self, old: &Simulation) {
        let as_long = |s: u32| {
            let [own, other] = [&*self, old].map(|of| of.model.groom.range(s as usize).len());
            own == other
        };
        let same = self.strands().eq(old.strands()) && self.strands().all(as_long);
        assert!(same, "both must have the same strands in the same order, with the same numbers of points");
        self.use_level(old.level);
        self.state.anchor = old.state.anchor;
        self.state.motion = old.state.motion;
        self.state.last_h = old.state.last_h;
        self.force_fields.clone_from(&old.force_fields);
        self.forces_added = self.forces_added.max(old.forces_added);
        self.frame.segments = old.frame.segments;
        self.state.charged.clone_from(&old.state.charged);
        let points = self.state.points.len();
        let as_long = |was: &[Row]| vec![Row::default(); if was.is_empty() { 0 } else { points }];
        let model = Arc::make_mut(&mut self.model);
        model.rest_penetration = as_long(&old.model.rest_penetration);
        model.passes = as_long(&old.model.passes);
        let mut lanes = vec![u32::MAX; old.model.groom_strands.len()];
        for k in 0..self.model.lane_of_strand.len() {
            let (place, from) = (self.model.lane_of_strand[k] as usize, old.model.lane_of_strand[k] as usize);
            lanes[from] = place as u32;
            let rows = &mut self.state.roots[place / LANES];
            for (row, was) in rows.iter_mut().zip(&old.state.roots[from / LANES]) {
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
        // The shares of slip are those of the old simulation.
        if !self.model.carried_air.is_empty() || !old.model.carried_air.is_empty() {
            let model = Arc::make_mut(&mut self.model);
            model.carried_air = CarriedAir::new(model);
        }
        self.take_over_manipulators(old, &lanes);
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
        let contact = |at| at == state::NORMAL_FORCE || at >= state::FRICTION_STRETCH;
        let kept = |at: usize| !forces && (tensions.contains(&Some(at)) || contact(at));
        let (tile, was) = (self.model.tiles[place / LANES], old.model.tiles[from / LANES]);
        let (lane, from_lane) = (place % LANES, from % LANES);
        for i in 0..tile.points.min(was.points) {
            let (to, from) = ((tile.first + i) as usize, (was.first + i) as usize);
            for at in (0..state::ROWS).filter(|at| !kept(*at)) {
                self.state.points[to][at].0[lane] = old.state.points[from][at].0[from_lane];
            }
            let model = Arc::make_mut(&mut self.model);
            for at in [rest::CLEARANCE, rest::SLIP] {
                model.rest[to][at].0[lane] = old.model.rest[from][at].0[from_lane];
            }
            if let Some(authored) = model.rest_penetration.get_mut(to) {
                authored.0[lane] = old.model.rest_penetration[from].0[from_lane];
            }
            if let Some(passes) = model.passes.get_mut(to) {
                passes.0[lane] = old.model.passes[from].0[from_lane];
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
        let source = old.strand(from);
        let edge = |j: usize| (1..=was).map(|k| source.edge(j * was + k)).sum::<Vec3>();
        let velocity = |j: usize| source.velocity(j * was);
        for j in 0..source.point_count() {
            let (i, i_was) = (j * stride, j * was);
            self.strand_mut(place).set_velocity(i, velocity(j));
            let at = self.model.tiles[place / LANES].first as usize + i;
            let was_at = old.model.tiles[from / LANES].first as usize + i_was;
            let model = Arc::make_mut(&mut self.model);
            for row in [rest::CLEARANCE, rest::SLIP] {
                model.rest[at][row].0[place % LANES] = old.model.rest[was_at][row].0[from % LANES];
            }
            if let Some(authored) = model.rest_penetration.get_mut(at) {
                authored.0[place % LANES] = source.rest_penetration(i_was);
            }
            if let Some(passes) = model.passes.get_mut(at) {
                passes.0[place % LANES] = old.model.passes[was_at].0[from % LANES];
            }
            if let (true, Some(span), Some(was)) =
                (forces, self.state.segment_contacts.get_mut(at), old.state.segment_contacts.get(was_at))
            {
                span.iter_mut().zip(was).for_each(|(row, was)| row.0[place % LANES] = was.0[from % LANES]);
            }
            if forces {
                let mut strand = self.strand_mut(place);
                strand.set_normal_force(i, source.normal_force(i_was));
                strand.set_friction_stretch(i, source.friction_stretch(i_was));
                if stride == was {
                    strand.set_tension(i, source.tension(i_was));
                }
            }
        }
        let mut strand = self.strand_mut(place);
        for (j, normal) in frames(source).into_iter().enumerate() {
            let i = j * stride;
            if stride == 1 {
                strand.set_edge(i + 1, edge(j));
                strand.set_normal(i, normal.as_vec3());
                continue;
            }
            // The triangle over the segment, rotating with it.
            let (e, [a, b]) = (edge(j).as_dvec3(), [velocity(j), velocity(j + 1)].map(Vec3::as_dvec3));
            let length = f64::from(strand.get().rest_length(i));
            let aside = side(j, e.normalize_or(DVec3::Y), normal) * (ASIDE * length);
            let spin = e.cross(b - a) / e.length_squared().max(MIN_SQUARED_SEGMENT);
            strand.set_edge(i + 1, (0.5 * e + aside).as_vec3());
            strand.set_edge(i + 2, (0.5 * e - aside).as_vec3());
            strand.set_velocity(i + 1, (0.5 * (a + b) + spin.cross(aside)).as_vec3());
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
                history[history::DISPLACEMENT + k].0[lane] = v * self.state.last_h;
            }
        }
    }
}

/// Returns the frame's normal on each segment of a strand; shape `[points − 1]`.
fn frames(strand: StrandRef) -> Vec<DVec3> {
    let mut normal = strand.root_normal();
    let mut before = None;
    (0..strand.point_count() - 1)
        .map(|j| {
            let e = strand.segment(j);
            let t = e.normalize_or(before.unwrap_or(DVec3::Y));
            if let Some(before) = before {
                normal = transport_normal(normal, before, t);
            }
            let own = match strand.elastic() {
                Elastic::Rod if j > 0 => strand.normal(j).as_dvec3(),
                Elastic::Springs => {
                    let extra = strand.edge(2 * j + 1).as_dvec3() - 0.5 * e;
                    normal_of(j, t, extra.reject_from_normalized(t).normalize_or_zero())
                }
                Elastic::Straight | Elastic::Curvature | Elastic::Rod => DVec3::ZERO,
            };
            normal = own.reject_from_normalized(t).normalize_or(normal);
            before = Some(t);
            normal
        })
        .collect()
}
