//! Carrying hair along with the head as if it were stiff: a teleport, a jump that is none of the motion, and inertia that is scaled down.
//!
//! ```text
//! motion of a frame   M = anchor(end) · anchor(start)⁻¹
//! carried by          M                    where M is a jump, or `teleport` is called
//!                     M^(1 − inertia)      else: the solver sees the rest of the motion only
//! ```
//!
//! What is carried keeps its shape, its tensions and its velocities, all turned as the head is. With inertia 0, hair on a moving head hangs as on one that
//! stands still.

use super::{Simulation, StepInput};
use crate::{
    body::is_teleport,
    math::RigidTransform,
    simd::lanes::Row,
    strand::tile::{Elastic, history, state},
};
use glam::{Mat3, Quat, Vec3};
use rayon::prelude::*;

/// How the anchor moved in the last frame, which a jump is told by.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Motion {
    /// Velocity of its origin [m/s].
    velocity: Vec3,
    /// Rotation vector over time [rad/s].
    spin: Vec3,
}

impl Simulation {
    /// Moves all hair at once, with its shape and its motion, by a rotation about the world's origin and then a translation [m]. The next step starts
    /// there: its anchor, roots and obstacles are expected where the same move takes them.
    pub fn teleport(&mut self, by: RigidTransform) {
        let turn = Mat3::from_quat(by.rotation);
        for tile in &self.tiles {
            let points = tile.first as usize..(tile.first + tile.points) as usize;
            let state = &mut self.state[points.clone()];
            // In the springs model the rows of a normal hold tensions.
            let normals = if tile.model == Elastic::Springs { None } else { Some(state::NORMAL) };
            state.par_iter_mut().with_min_len(1024).for_each(|rows| {
                [Some(state::EDGE), Some(state::V), normals]
                    .into_iter()
                    .flatten()
                    .for_each(|at| rotate(&turn, &mut rows[at..at + 3]));
            });
            if let Some(history) = self.history.get_mut(points) {
                for rows in history {
                    rotate(&turn, &mut rows[history::V..history::V + 3]);
                    rotate(&turn, &mut rows[history::WAY..history::WAY + 3]);
                }
            }
        }
        if let Some(neighbours) = &mut self.neighbours {
            neighbours.turn(by.rotation);
        }
        self.carry_tools(&by);
        self.settings.anchor = by.after(&self.settings.anchor);
        self.motion.velocity = turn * self.motion.velocity;
        self.motion.spin = turn * self.motion.spin;
    }

    /// Carries the hair along before a frame as far as its setting says, or all the way where the anchor jumps; returns what it was carried by.
    pub(super) fn carry_along(&mut self, drive: &StepInput) -> Option<RigidTransform> {
        let solver = self.settings.solver;
        let way = drive.anchor.after(&self.settings.anchor.inverse());
        let moved = drive.anchor.translation - self.settings.anchor.translation;
        let turned = way.rotation.to_scaled_axis();
        let expected = Quat::from_scaled_axis(self.motion.spin * drive.dt);
        let off = (moved - self.motion.velocity * drive.dt).length();
        let turned_off = way.rotation.angle_between(expected);
        let jumped = is_teleport(off, turned_off, solver.teleport_distance, f64::from(drive.dt));
        // A jump too is what the next frame is judged by: where it was one, hair is carried once more, by as little as the head then moves; where it
        // was the start of a ride, the ride is felt.
        let now = Motion { velocity: moved / drive.dt, spin: turned / drive.dt };
        let by = if jumped {
            way
        } else if solver.inertia < 1.0 {
            self.settings
                .anchor
                .lerp(&drive.anchor, 1.0 - solver.inertia)
                .after(&self.settings.anchor.inverse())
        } else {
            self.motion = now;
            return None;
        };
        self.teleport(by);
        self.motion = now;
        Some(by)
    }
}

/// Turns a vector of eight lanes.
fn rotate(turn: &Mat3, rows: &mut [Row]) {
    let [x, y, z] = [0, 1, 2].map(|k| rows[k].0);
    for (k, row) in rows.iter_mut().enumerate() {
        let [a, b, c] = [turn.x_axis[k], turn.y_axis[k], turn.z_axis[k]];
        for (lane, out) in row.0.iter_mut().enumerate() {
            *out = a * x[lane] + b * y[lane] + c * z[lane];
        }
    }
}
