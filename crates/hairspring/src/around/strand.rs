//! One strand, as an effect sees it: where its points are at the start of a frame, and what acts on them in it.

use super::Frame;
use crate::{
    collide::Rigid,
    strand::{
        lanes::Row,
        tile::{RestRows, StateRows, StrandRows, grip, rest, state, strand, tines},
    },
};
use glam::{Quat, Vec3};

/// One strand in a frame. Points are counted as the groom does; the extra particles of the springs model go with them.
pub(crate) struct Surrounded<'a> {
    /// The strand, as an index of the groom.
    pub strand: usize,
    /// The frame.
    pub frame: &'a Frame,
    pub(super) lane: usize,
    pub(super) stride: usize,
    pub(super) rows: &'a StrandRows,
    pub(super) rest: &'a [RestRows],
    pub(super) state: &'a [StateRows],
    pub(super) push: &'a mut [[Row; 3]],
    pub(super) grip: &'a mut [[Row; grip::ROWS]],
    pub(super) tines: &'a mut [[Row; tines::ROWS]],
    pub(super) air: &'a mut [[Row; 3]],
}

impl<'a> Surrounded<'a> {
    /// The root at the start and at the end of the frame: place and rotation since rest, in the world.
    pub fn roots(&self) -> [Rigid; 2] {
        let number = |row: usize| self.rows[row].0[self.lane];
        let [start, end] = self.frame.anchor;
        [(start, strand::ROOT_START, strand::TURN_START), (end, strand::ROOT_END, strand::TURN_END)].map(
            |(anchor, root, turn)| Rigid {
                translation: anchor.point(Vec3::from([0, 1, 2].map(|k| number(root + k)))),
                rotation: anchor.rotation * Quat::from_array([0, 1, 2, 3].map(|k| number(turn + k))),
            },
        )
    }

    /// Place from the root [m] and velocity [m/s] of every point of the strand at the start of the frame, root first.
    pub fn points(&self) -> impl Iterator<Item = (Vec3, Vec3)> + use<'a> {
        let (state, lane) = (self.state, self.lane);
        let vector = move |rows: &StateRows, at: usize| Vec3::from([0, 1, 2].map(|k| rows[at + k].0[lane]));
        let particles = state.iter().scan(Vec3::ZERO, move |x, rows| {
            *x += vector(rows, state::EDGE);
            Some((*x, vector(rows, state::V)))
        });
        particles.step_by(self.stride).take(self.rows[strand::POINTS].0[lane] as usize)
    }

    /// Length of hair that is point `i`'s: half of the segments around it [m].
    pub fn length(&self, i: usize) -> f32 {
        let length = |i: usize| self.rest[i * self.stride][rest::LENGTH].0[self.lane];
        0.5 * (length(i) + if i > 0 { length(i - 1) } else { 0.0 })
    }

    /// Mass of point `i` [kg].
    pub fn mass(&self, i: usize) -> f32 {
        self.rest[i * self.stride][rest::MASS].0[self.lane]
    }

    /// How deep point `i` may be inside a collider, 0 or less [m].
    pub fn clearance(&self, i: usize) -> f32 {
        self.rest[i * self.stride][rest::CLEARANCE].0[self.lane]
    }

    /// From point `i − 1` to point `i` at the start of the frame [m], and the velocity of point `i` [m/s]; `i` is 1 or more.
    pub fn step(&self, i: usize) -> (Vec3, Vec3) {
        let vector = |i: usize, at: usize| Vec3::from([0, 1, 2].map(|k| self.state[i][at + k].0[self.lane]));
        let last = i * self.stride;
        let edge = (last + 1 - self.stride..=last).map(|i| vector(i, state::EDGE)).sum();
        (edge, vector(last, state::V))
    }

    /// Accelerates point `i` by `a` [m/s²].
    pub fn push(&mut self, i: usize, a: Vec3) {
        let rows = &mut self.push[i * self.stride];
        for (row, a) in rows.iter_mut().zip(a.to_array()) {
            row.0[self.lane] += a;
        }
    }

    /// Pulls point `i` to a place that goes from `from` to `to` in the frame, both from where the root is then [m], by a spring of `stiffness` over
    /// the point's mass [1/s²].
    pub fn pull(&mut self, i: usize, [from, to]: [Vec3; 2], stiffness: f32) {
        let rows = &mut self.grip[i * self.stride];
        rows[grip::STIFFNESS].0[self.lane] += stiffness;
        for (row, way) in rows[grip::WAY..].iter_mut().zip((to - from).to_array()) {
            row.0[self.lane] += way * stiffness;
        }
        self.push(i, to * stiffness);
    }

    /// Lets point `i` take on `velocity` [m/s] at `rate` [1/s].
    pub fn carry(&mut self, i: usize, velocity: Vec3, rate: f32) {
        self.grip[i * self.stride][grip::BRAKE].0[self.lane] += rate;
        self.push(i, velocity * rate);
    }

    /// Lets point `i` take on `velocity` [m/s] across its strand at `rate` [1/s].
    pub fn carry_across(&mut self, i: usize, velocity: Vec3, rate: f32) {
        let rows = &mut self.tines[i * self.stride];
        rows[tines::BRAKE].0[self.lane] += rate;
        for (row, carry) in rows[tines::CARRY..].iter_mut().zip((velocity * rate).to_array()) {
            row.0[self.lane] += carry;
        }
    }

    /// Moves the air at point `i` by `velocity` [m/s], on top of the wind of all points.
    pub fn blow(&mut self, i: usize, velocity: Vec3) {
        let rows = &mut self.air[i * self.stride];
        for (row, v) in rows.iter_mut().zip(velocity.to_array()) {
            row.0[self.lane] += v;
        }
    }
}
