//! Rigid motion of the hair with the head: teleports, discontinuities that are not part of the motion, and
//! scaled inertia.
//!
//! ```text
//! motion of a frame   M = anchor(end) · anchor(start)⁻¹
//! hair is moved by    M                    if M is a teleport, or `teleport` is called
//!                     M^(1 − inertia)      otherwise: the solver sees only the rest of the motion
//! ```
//!
//! Hair that is moved rigidly keeps its shape, its tensions and its velocities, all rotated with the head.
//! With inertia 0, hair on a moving head hangs as on one at rest.

use super::{Simulation, StepInput};
use crate::parallel::prelude::*;
use crate::{
    body::is_teleport,
    math::{RigidTransform, angle_between},
    simd::lanes::Row,
    strand::tile::{Elastic, history, state},
};
use glam::{Mat3, Quat, Vec3};

/// Motion of the anchor in the last frame, used to detect teleports.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Motion {
    /// Velocity of the anchor's origin [m/s].
    velocity: Vec3,
    /// Rotation vector over time [rad/s].
    spin: Vec3,
}

impl Simulation {
    /// Moves all hair rigidly, including its motion, by a rotation about the world's origin and then a
    /// translation [m]. The next step starts there: its anchor, roots and colliders must be moved in the same
    /// way.
    pub fn teleport(&mut self, by: RigidTransform) {
        let turn = Mat3::from_quat(by.rotation);
        for tile in &self.model.tiles {
            let points = tile.first as usize..(tile.first + tile.points) as usize;
            let state = &mut self.state.points[points.clone()];
            // In the springs model the rows of a normal hold tensions.
            let normals = if tile.model == Elastic::Springs { None } else { Some(state::NORMAL) };
            state.par_iter_mut().with_min_len(1024).for_each(|rows| {
                [Some(state::EDGE), Some(state::V), normals]
                    .into_iter()
                    .flatten()
                    .for_each(|at| rotate(&turn, &mut rows[at..at + 3]));
            });
            if let Some(history) = self.state.history.get_mut(points) {
                for rows in history {
                    rotate(&turn, &mut rows[history::V..history::V + 3]);
                    rotate(&turn, &mut rows[history::DISPLACEMENT..history::DISPLACEMENT + 3]);
                }
            }
        }
        if let Some(neighbours) = &mut self.neighbours {
            neighbours.turn(by.rotation);
        }
        self.carry_manipulators(&by);
        self.state.anchor = by * self.state.anchor;
        self.state.motion.velocity = turn * self.state.motion.velocity;
        self.state.motion.spin = turn * self.state.motion.spin;
    }

    /// Moves the hair rigidly before a frame: by the part that `inertia` leaves, or completely if the anchor
    /// teleports. Returns the applied motion.
    pub(super) fn carry_along(&mut self, input: &StepInput) -> Option<RigidTransform> {
        let solver = self.model.solver;
        let motion = input.anchor * self.state.anchor.inverse();
        let moved = input.anchor.translation - self.state.anchor.translation;
        let turned = motion.rotation.to_scaled_axis();
        let expected = Quat::from_scaled_axis(self.state.motion.spin * input.dt);
        let off = (moved - self.state.motion.velocity * input.dt).length();
        let turned_off = angle_between(motion.rotation, expected);
        let jumped = is_teleport(off, turned_off, solver.teleport_distance, f64::from(input.dt));
        // The next frame is compared with the motion of a teleport, too. After a single jump, hair is thus
        // moved rigidly once more, by as little as the head then moves. If it was the start of a fast motion,
        // the solver sees the motion from the next frame on.
        let now = Motion { velocity: moved / input.dt, spin: turned / input.dt };
        let by = if jumped {
            motion
        } else if solver.inertia < 1.0 {
            self.state.anchor.lerp(&input.anchor, 1.0 - solver.inertia) * self.state.anchor.inverse()
        } else {
            self.state.motion = now;
            return None;
        };
        self.teleport(by);
        self.state.motion = now;
        Some(by)
    }
}

/// Rotates a vector in eight lanes.
fn rotate(turn: &Mat3, rows: &mut [Row]) {
    let [x, y, z] = [0, 1, 2].map(|k| rows[k].0);
    for (k, row) in rows.iter_mut().enumerate() {
        let [a, b, c] = [turn.x_axis[k], turn.y_axis[k], turn.z_axis[k]];
        for (lane, out) in row.0.iter_mut().enumerate() {
            *out = a * x[lane] + b * y[lane] + c * z[lane];
        }
    }
}
