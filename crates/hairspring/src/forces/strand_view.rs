//! One strand as seen by an external force: its points at the start of a frame, and the force buffers to
//! write to.

use super::{FrameMotion, strand_batch::ForceTile};
use crate::{
    math::RigidTransform,
    strand::tile::{StateRows, anisotropic_drag, position_spring, rest, root, state, strand},
};
use glam::{Quat, Vec3};

/// One strand in a frame. Points are numbered as in the groom. The extra particles of the springs model are
/// skipped.
///
/// For an example, see [`ForceField`](super::ForceField).
///
/// Point indices must be less than [`StrandView::point_count`]. A method may panic for a larger index, or access
/// padding that belongs to no point.
pub struct StrandView<'a> {
    /// Index of the strand in the groom.
    pub(crate) strand: usize,
    pub(crate) frame: &'a FrameMotion,
    pub(super) lane: usize,
    pub(super) tile: ForceTile<'a>,
}

impl std::fmt::Debug for StrandView<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("StrandView")
            .field("index", &self.strand)
            .field("points", &self.point_count())
            .finish_non_exhaustive()
    }
}

impl<'a> StrandView<'a> {
    /// Returns the index of the strand in the groom.
    pub fn index(&self) -> usize {
        self.strand
    }

    /// Returns the number of points. The root drives the first two.
    pub fn point_count(&self) -> usize {
        self.tile.strand[strand::POINTS].0[self.lane] as usize
    }

    /// Particles for each point of the strand.
    fn stride(&self) -> usize {
        self.tile.layout.model.stride()
    }

    /// Returns the length of the frame [s].
    pub fn dt(&self) -> f32 {
        self.frame.dt
    }

    /// Returns the root's world transform since rest, at the start and at the end of the frame.
    pub fn roots(&self) -> [RigidTransform; 2] {
        let number = |row: usize| self.tile.roots[row].0[self.lane];
        let [start, end] = self.frame.anchor;
        [(start, root::START, root::TURN_START), (end, root::END, root::TURN_END)].map(
            |(anchor, place, turn)| RigidTransform {
                translation: anchor.transform_point(Vec3::from([0, 1, 2].map(|k| number(place + k)))),
                rotation: anchor.rotation * Quat::from_array([0, 1, 2, 3].map(|k| number(turn + k))),
            },
        )
    }

    /// Returns the position relative to the root [m] and the velocity [m/s] of every point at the start of
    /// the frame, root first.
    pub fn points(&self) -> impl Iterator<Item = (Vec3, Vec3)> + use<'a> {
        let (state, lane) = (self.tile.state, self.lane);
        let vector = move |rows: &StateRows, at: usize| Vec3::from([0, 1, 2].map(|k| rows[at + k].0[lane]));
        let particles = state.iter().scan(Vec3::ZERO, move |x, rows| {
            *x += vector(rows, state::EDGE);
            Some((*x, vector(rows, state::V)))
        });
        particles.step_by(self.stride()).take(self.tile.strand[strand::POINTS].0[lane] as usize)
    }

    /// Returns the length of hair that point `i` represents: half of the adjacent segments [m].
    pub fn length(&self, i: usize) -> f32 {
        let length = |i: usize| self.tile.rest[i * self.stride()][rest::LENGTH].0[self.lane];
        0.5 * (length(i) + if i > 0 { length(i - 1) } else { 0.0 })
    }

    /// Returns the length of hair that each point represents, root first: half of the adjacent segments [m].
    pub fn lengths(&self) -> impl Iterator<Item = f32> + use<'a> {
        let (rest, lane) = (self.tile.rest, self.lane);
        let mut before = 0.0;
        let lengths = rest.iter().step_by(self.stride()).map(move |rows| {
            let after = rows[rest::LENGTH].0[lane];
            0.5 * (after + std::mem::replace(&mut before, after))
        });
        lengths.take(self.point_count())
    }

    /// Returns the mass of point `i` [kg].
    pub fn mass(&self, i: usize) -> f32 {
        self.tile.rest[i * self.stride()][rest::MASS].0[self.lane]
    }

    /// Returns the smallest signed distance from a collider that point `i` may have, 0 or less [m].
    pub fn clearance(&self, i: usize) -> f32 {
        self.tile.rest[i * self.stride()][rest::CLEARANCE].0[self.lane]
    }

    /// Returns the vector from point `i − 1` to point `i` at the start of the frame [m], and the velocity of
    /// point `i` [m/s]. `i` must be 1 or more.
    ///
    /// # Panics
    /// May panic if `i` is 0 or there is no such point.
    pub fn segment(&self, i: usize) -> (Vec3, Vec3) {
        let vector =
            |i: usize, at: usize| Vec3::from([0, 1, 2].map(|k| self.tile.state[i][at + k].0[self.lane]));
        let last = i * self.stride();
        let edge = (last + 1 - self.stride()..=last).map(|i| vector(i, state::EDGE)).sum();
        (edge, vector(last, state::V))
    }

    /// Adds the acceleration `a` [m/s²] to point `i`.
    pub fn accelerate(&mut self, i: usize, a: Vec3) {
        let rows = &mut self.tile.external_acceleration[i * self.stride()];
        for (row, a) in rows.iter_mut().zip(a.to_array()) {
            row.0[self.lane] += a;
        }
    }

    /// Adds a spring that pulls point `i` to a target. The target moves from `from` to `to` during the frame,
    /// both relative to the root at that time [m]. `stiffness` is the spring constant per mass, ω² [1/s²].
    pub fn add_position_spring(&mut self, i: usize, [from, to]: [Vec3; 2], stiffness: f32) {
        let rows = &mut self.tile.position_spring[i * self.stride()];
        rows[position_spring::STIFFNESS].0[self.lane] += stiffness;
        for (row, displacement) in
            rows[position_spring::DISPLACEMENT..].iter_mut().zip((to - from).to_array())
        {
            row.0[self.lane] += displacement * stiffness;
        }
        self.accelerate(i, to * stiffness);
    }

    /// Adds drag that relaxes the velocity of point `i` toward `velocity` [m/s] at `rate` [1/s].
    pub fn add_velocity_drag(&mut self, i: usize, velocity: Vec3, rate: f32) {
        self.tile.position_spring[i * self.stride()][position_spring::BRAKE].0[self.lane] += rate;
        self.accelerate(i, velocity * rate);
    }

    /// Adds drag that relaxes the velocity of point `i` transverse to its strand toward `velocity` [m/s] at `rate`
    /// [1/s].
    pub fn add_transverse_drag(&mut self, i: usize, velocity: Vec3, rate: f32) {
        let rows = &mut self.tile.anisotropic_drag[i * self.stride()];
        rows[anisotropic_drag::BRAKE].0[self.lane] += rate;
        for (row, carry) in
            rows[anisotropic_drag::ACCELERATION..].iter_mut().zip((velocity * rate).to_array())
        {
            row.0[self.lane] += carry;
        }
    }

    /// Adds `velocity` [m/s] to the air at point `i`, on top of the directional wind.
    pub fn add_wind(&mut self, i: usize, velocity: Vec3) {
        let rows = &mut self.tile.wind_delta[i * self.stride()];
        for (row, v) in rows.iter_mut().zip(velocity.to_array()) {
            row.0[self.lane] += v;
        }
    }

    /// Returns the cell of dense hair whose air surrounds point `i`; `u32::MAX` for the air outside.
    pub(crate) fn air_cell(&self, i: usize) -> u32 {
        self.tile.air_cell[i * self.stride()][self.lane]
    }

    /// Changes the air at point `i` from that outside the hair to that inside it, which moves at `inside` [m/s]. `uniform` is the
    /// directional wind [m/s]. See `simulation/carried_air.rs`.
    pub(crate) fn shelter_air(&mut self, i: usize, inside: Vec3, uniform: Vec3) {
        let at = i * self.stride();
        let slip = self.tile.rest[at][rest::SLIP].0[self.lane];
        let exposure = 2.0 * slip - 1.0;
        for k in 0..3 {
            let v = self.tile.state[at][state::V + k].0[self.lane];
            let delta = &mut self.tile.wind_delta[at][k].0[self.lane];
            let outer = (uniform[k] + *delta) * exposure;
            *delta = (outer + (inside[k] - 0.5 * v) * (1.0 - exposure)) / slip - uniform[k];
        }
    }
}
