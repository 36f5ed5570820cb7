//! One strand, as an effect sees it: where its points are at the start of a frame, and what acts on them in it.

use super::Frame;
use crate::{
    collide::Rigid,
    strand::{
        lanes::Row,
        tile::{StateRows, StrandRows, damp, grip, state, strand},
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
    pub(super) state: &'a [StateRows],
    pub(super) push: &'a mut [[Row; 3]],
    pub(super) grip: &'a mut [[Row; grip::ROWS]],
    pub(super) damp: &'a mut [[Row; damp::ROWS]],
    pub(super) air: &'a mut [[Row; 3]],
}

impl Surrounded<'_> {
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

    /// Place from the root [m] and velocity [m/s] of every point of the strand at the start of the frame, root first; and points of padding.
    pub fn points(&self) -> impl Iterator<Item = (Vec3, Vec3)> + '_ {
        let vector = |rows: &StateRows, at: usize| Vec3::from([0, 1, 2].map(|k| rows[at + k].0[self.lane]));
        let particles = self.state.iter().scan(Vec3::ZERO, move |x, rows| {
            *x += vector(rows, state::EDGE);
            Some((*x, vector(rows, state::V)))
        });
        particles.step_by(self.stride)
    }

    /// Accelerates point `i` by `a` [m/s²].
    pub fn push(&mut self, i: usize, a: Vec3) {
        let rows = &mut self.push[i * self.stride];
        for (row, a) in rows.iter_mut().zip(a.to_array()) {
            row.0[self.lane] += a;
        }
    }

    /// Pulls point `i` to `place`, which is from where the root is [m], by a spring of `stiffness` over the point's mass [1/s²].
    pub fn pull(&mut self, i: usize, place: Vec3, stiffness: f32) {
        self.grip[i * self.stride][grip::STIFFNESS].0[self.lane] += stiffness;
        self.push(i, place * stiffness);
    }

    /// Lets point `i` take on `velocity` [m/s] at `rate` [1/s].
    pub fn carry(&mut self, i: usize, velocity: Vec3, rate: f32) {
        self.grip[i * self.stride][grip::BRAKE].0[self.lane] += rate;
        self.push(i, velocity * rate);
    }

    /// Brakes point `i` by `rates` over its mass, a symmetric matrix by its entries xx, xy, xz, yy, yz, zz [1/s].
    pub fn damp(&mut self, i: usize, rates: &[f32; damp::ROWS]) {
        for (row, rate) in self.damp[i * self.stride].iter_mut().zip(rates) {
            row.0[self.lane] += rate;
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
