//! Points bound to places in something that moves: what a grab holds, and what a tie holds.
//!
//! ```text
//! a = ω² (T − x) + 2ζω (Ṫ − v)        ω = 2πf,   |T − x| ω² no more than FIRMEST at the start of a frame
//! ```
//!
//! T goes straight from where it is at the start of the frame to where it is at its end. Where what holds it is inside of a body, T is at the nearest place
//! outside: hair is pulled around a head and not into it.

use super::StrandView;
use crate::{collide::FrameColliders, math::RigidTransform};
use glam::Vec3;

/// Most that a bond pulls for what a point is off at the start of a frame [m/s²]: a thousand times its weight, ten times what whipping hair needs. What
/// is pulled farther slips: a hand that jumps away does not tear.
const FIRMEST: f32 = 1e4;

/// Fastest that what holds takes points along, against their root [m/s], as fast as a hand moves; the rest of its way is made up for later.
const FASTEST: f32 = 20.0;

/// How bonds pull.
#[derive(Clone, Copy)]
pub(crate) struct Spring {
    /// How fast a lone point would swing about its place [Hz].
    pub pull: f32,
    /// Damping over the critical [1].
    pub damping: f32,
}

/// One bound point.
#[derive(Clone, Copy)]
pub(crate) struct Bond {
    /// Its strand, as an index of the groom.
    pub strand: u32,
    /// Lane of the strand in the simulation.
    pub place: u32,
    /// The point.
    pub point: u32,
    /// Where it was bound, in the space of what holds it [m].
    pub from: Vec3,
    /// Where it is taken, in that space [m].
    pub to: Vec3,
}

impl Bond {
    /// Where it is held at a `share` of the way [m], in the space of what holds it.
    pub fn at(&self, share: f32) -> Vec3 {
        self.from.lerp(self.to, share)
    }
}

/// Bonds, sorted by strand and point.
#[derive(Clone)]
pub(crate) struct Bonds(pub Vec<Bond>);

impl Bonds {
    /// Sorted.
    pub fn new(mut bonds: Vec<Bond>) -> Self {
        bonds.sort_unstable_by_key(|b| (b.strand, b.point));
        Self(bonds)
    }

    /// Pulls the bound points of a strand while what holds them goes between two `poses` and its ramp between two `shares`.
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
        let farthest = FIRMEST / stiffness.max(1e-6);
        let roots = strand.roots();
        let root_way = roots[1].translation - roots[0].translation;
        let dt = strand.frame.dt;
        let (mut x, mut reached) = (Vec3::ZERO, 0);
        for bond in self.0[first..].iter().take_while(|b| b.strand == number) {
            while reached < bond.point {
                reached += 1;
                x += strand.segment(reached as usize).0;
            }
            let clearance = strand.clearance(bond.point as usize);
            let [from, to] = [0, 1].map(|k| poses[k].point(bond.at(shares[k])));
            let from = bodies.out(from, clearance) - roots[0].translation;
            let to = bodies.out_at_end(to, clearance) - roots[1].translation;
            let way = (to - from).clamp_length_max(FASTEST * dt);
            let from = x + (from - x).clamp_length_max(farthest);
            strand.add_position_spring(bond.point as usize, [from, from + way], stiffness);
            strand.add_velocity_drag(
                bond.point as usize,
                (way + root_way) / dt,
                2.0 * spring.damping * omega,
            );
        }
    }
}
