//! Springs that attach points to a moving manipulator: a grab or a tie.
//!
//! ```text
//! a = ω² (T − x) + 2ζω (Ṫ − v)        ω = 2πf,   |T − x| ω² ≤ MAX_ACCELERATION at the start of a frame
//! ```
//!
//! T moves linearly from its position at the start of the frame to that at the end. If the manipulator is
//! inside a body, T is at the nearest point outside, so hair is pulled around a head and not into it.

use super::StrandView;
use crate::{collide::FrameColliders, math::RigidTransform};
use glam::Vec3;

/// Maximum acceleration of a bond due to the position error at the start of a frame [m/s²]: a thousand times
/// gravity, ten times what whipping hair needs. Beyond it the attachment lags behind, so a hand that jumps
/// away does not tear the hair.
const MAX_ACCELERATION: f32 = 1e4;

/// Maximum speed at which points are moved relative to their root [m/s], about that of a fast hand. The
/// remaining distance is covered in later frames.
const MAX_SPEED: f32 = 20.0;

/// Smallest stiffness over mass that is divided by [1/s²].
const MIN_STIFFNESS: f32 = 1e-6;

/// Spring parameters of the bonds.
#[derive(Clone, Copy)]
pub(crate) struct Spring {
    /// Natural frequency of a free point on the spring [Hz].
    pub pull: f32,
    /// Damping ratio, relative to critical [1].
    pub damping: f32,
}

/// One attached point.
#[derive(Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Bond {
    /// Index of its strand in the groom.
    pub strand: u32,
    /// Lane of the strand in the simulation.
    pub place: u32,
    /// Index of the point in the strand.
    pub point: u32,
    /// Position at which it was attached, in the manipulator's space [m].
    pub from: Vec3,
    /// Target position in that space [m].
    pub to: Vec3,
}

impl Bond {
    /// Returns the target at the fraction `share` of the way from `from` to `to` [m], in the manipulator's
    /// space.
    pub fn at(&self, share: f32) -> Vec3 {
        self.from.lerp(self.to, share)
    }
}

/// Bonds, sorted by strand and point.
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Bonds(pub Vec<Bond>);

impl Bonds {
    /// Sorts `bonds`.
    pub fn new(mut bonds: Vec<Bond>) -> Self {
        bonds.sort_unstable_by_key(|b| (b.strand, b.point));
        Self(bonds)
    }

    /// Applies the springs of a strand, while the manipulator moves between two `poses` and the target
    /// fraction between two `shares`.
    pub fn act(
        &self,
        spring: Spring,
        poses: [RigidTransform; 2],
        shares: [f32; 2],
        bodies: &FrameColliders,
        strand: &mut StrandView,
    ) {
        let number = strand.strand as u32;
        let first = self.0.partition_point(|b| b.strand < number);
        if self.0.get(first).is_none_or(|b| b.strand != number) {
            return;
        }
        let omega = std::f32::consts::TAU * spring.pull;
        let stiffness = omega * omega;
        let farthest = MAX_ACCELERATION / stiffness.max(MIN_STIFFNESS);
        let roots = strand.roots();
        let root_displacement = roots[1].translation - roots[0].translation;
        let dt = strand.frame.dt;
        let (mut x, mut reached) = (Vec3::ZERO, 0);
        for bond in self.0[first..].iter().take_while(|b| b.strand == number) {
            while reached < bond.point {
                reached += 1;
                x += strand.segment(reached as usize).0;
            }
            let clearance = strand.clearance(bond.point as usize);
            let [from, to] = [0, 1].map(|k| poses[k].transform_point(bond.at(shares[k])));
            let from = bodies.out(from, clearance) - roots[0].translation;
            let to = bodies.out_at_end(to, clearance) - roots[1].translation;
            let displacement = (to - from).clamp_length_max(MAX_SPEED * dt);
            let from = x + (from - x).clamp_length_max(farthest);
            strand.add_position_spring(bond.point as usize, [from, from + displacement], stiffness);
            strand.add_velocity_drag(
                bond.point as usize,
                (displacement + root_displacement) / dt,
                2.0 * spring.damping * omega,
            );
        }
    }
}
