//! The energy of the strands, by form. A swing without losses would conserve the total.

use super::{Simulation, strand_ref::StrandRef};
use crate::parallel::prelude::*;
use crate::{
    settings::Integrator,
    strand::{
        model::{
            bend::{FOLDED, transport_normal},
            rod::{FOLDING, curved_joint},
            springs::{BEND, Progressive, TORSION},
            stretch::STRETCH,
        },
        tile::Elastic,
    },
};
use std::ops::Add;

/// Energy of all simulated strands [J], without the first two points of each strand, which its root drives.
///
/// For an example, see [`simulation`](crate::simulation).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Energy {
    /// ½ m v² of the points.
    pub kinetic: f64,
    /// −m g·x of the points, relative to the origin of the world.
    pub gravitational: f64,
    /// Springs model: energy of its springs. Other models: ½ B |r|² of the joints, and ½ ΔB (m·r)² of flat
    /// fibers (see `strand/model/bend.rs`, `rod.rs`).
    pub bending: f64,
    /// ½ GJ/L̄ (τ − τ⁰)² of the joints; rod model only.
    pub twisting: f64,
    /// T (ℓ − L) + ½ k (ℓ − L)² of the segments.
    pub stretching: f64,
}

impl Energy {
    /// Total energy [J].
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravitational + self.bending + self.twisting + self.stretching
    }
}

impl Add for Energy {
    type Output = Self;

    fn add(self, o: Self) -> Self {
        Self {
            kinetic: self.kinetic + o.kinetic,
            gravitational: self.gravitational + o.gravitational,
            bending: self.bending + o.bending,
            twisting: self.twisting + o.twisting,
            stretching: self.stretching + o.stretching,
        }
    }
}

/// The spring that an integrator puts along a segment.
#[derive(Clone, Copy)]
enum Spring {
    /// No spring: the segment keeps its length by construction.
    None,
    /// The fiber's own stiffness, EA/L.
    Fiber,
    /// Stiffness as a multiple of the mass of the point before the segment [1/s²].
    PerMass(f64),
}

impl Simulation {
    /// Returns the current energy, with the springs of the selected integrator: the explicit ones stretch the
    /// fiber itself, the implicit ones use a softer spring instead (`strand/model/stretch.rs`), and follow
    /// the leader has neither stretch nor bending. An exact integrator would conserve the total. NaN if a
    /// strand's state is NaN.
    pub fn energy(&self) -> Energy {
        // Summed in a fixed order: bitwise independent of the number of threads.
        let strands: Vec<Energy> = self
            .model
            .lane_of_strand
            .par_iter()
            .with_min_len(64)
            .map(|place| self.strand_energy(*place as usize))
            .collect();
        strands.into_iter().fold(Energy::default(), Add::add)
    }

    /// The energy that the free points would gain by falling until every strand hangs straight down from its
    /// driven segment [J]: the most that a swing under gravity alone can convert to motion.
    pub fn energy_to_fall(&self) -> f64 {
        let gravity = self.model.gravity.as_dvec3();
        let down = gravity.normalize_or_zero();
        let fall = |place: usize| {
            let strand = self.strand(place);
            let stride = strand.stride();
            let mut particles = strand.particles().enumerate().skip(stride);
            let mut at = particles.next().unwrap_or_default().1.as_dvec3();
            let mut energy = 0.0;
            for (i, x) in particles {
                // An extra particle falls to the center of its segment.
                let from = (i - 1) / stride * stride;
                let step = down * (f64::from(strand.rest_length(from)) / stride as f64);
                at += step;
                let displacement = at - x.as_dvec3();
                energy += f64::from(strand.mass(i)) * gravity.dot(displacement);
            }
            energy
        };
        self.model.lane_of_strand.iter().map(|place| fall(*place as usize)).sum()
    }

    fn strand_energy(&self, place: usize) -> Energy {
        let gravity = self.model.gravity.as_dvec3();
        let strand = self.strand(place);
        let root = strand.root().as_dvec3();
        let (n, stride) = (strand.particle_count(), strand.stride());
        let mut energy = Energy::default();
        for (i, x) in strand.particles().enumerate().skip(stride + 1) {
            let mass = f64::from(strand.mass(i));
            let v = strand.velocity(i).as_dvec3();
            energy.kinetic += 0.5 * mass * v.length_squared();
            energy.gravitational -= mass * gravity.dot(root + x.as_dvec3());
        }
        let integrator = self.model.solver.integrator;
        let per_mass =
            if self.state.last_h > 0.0 { STRETCH as f64 / (self.state.last_h as f64).powi(2) } else { 0.0 };
        let spring = match integrator {
            Integrator::ExplicitEuler | Integrator::Verlet => Spring::Fiber,
            Integrator::Ftl | Integrator::Dftl => Spring::None,
            Integrator::BackwardEuler | Integrator::Bdf2 => {
                Spring::PerMass(per_mass * f64::from(strand.stiffening()))
            }
            Integrator::LocalGlobal => Spring::PerMass(per_mass),
        };
        if matches!(spring, Spring::None) {
            return energy;
        }
        // In these integrators, tension is a force. In the direct solver it is a multiplier, which does no
        // work on a segment of constant length.
        let pulls = !matches!(integrator, Integrator::BackwardEuler | Integrator::Bdf2);
        for i in (stride..n - 1).step_by(stride) {
            let length = f64::from(strand.rest_length(i));
            let k = match spring {
                Spring::None => 0.0,
                Spring::Fiber => f64::from(strand.axial_stiffness()) / length,
                Spring::PerMass(rate) => f64::from(strand.mass(i)) * rate,
            };
            let longer = strand.between(i, i + stride).length() - length;
            let tension = if pulls { f64::from(strand.tension(i)) } else { 0.0 };
            energy.stretching += longer * (tension + 0.5 * k * longer);
        }
        match strand.elastic() {
            Elastic::Springs => add_springs(strand, &mut energy),
            _ => add_joints(strand, &mut energy),
        }
        energy
    }
}

/// Adds the bend and torsion springs. The triangles count as rigid, and the altitude springs as inactive.
fn add_springs(strand: StrandRef, energy: &mut Energy) {
    let mut spring = |[i, far]: [usize; 2], [stiffness, rest]: [f32; 2], law: Progressive| {
        let rest = f64::from(rest);
        let stretched = law.pull(strand.between(i, i + far).length() - rest, rest).1;
        energy.bending += f64::from(stiffness) * stretched;
    };
    for i in 0..strand.particle_count() - 3 {
        spring([i, 3], strand.torsion_spring(i), TORSION);
        if i % 2 == 1 {
            spring([i, 2], strand.bend_spring(i), BEND);
        }
    }
}

/// Adds bending and twisting of the joints. Frames are transported as in the kernel.
fn add_joints(strand: StrandRef, energy: &mut Energy) {
    let e = |j: usize| strand.segment(j);
    let length = |j: usize| f64::from(strand.rest_length(j));
    let mut m0 = strand.root_normal();
    let mut u0 = e(0).normalize_or_zero();
    for j in 1..strand.point_count() - 1 {
        let u1 = e(j).normalize_or_zero();
        let stiffness = f64::from(strand.bend(j));
        let (ratio, flat) = (f64::from(strand.twist_ratio(j)), f64::from(strand.flatness(j)));
        let local = strand.rest_turn(j);
        let d = m0 * local.x + u0.cross(m0) * local.y + u0 * local.z;
        let r = e(j) / length(j) - e(j - 1) / length(j - 1) - d;
        energy.bending += 0.5 * stiffness * r.length_squared();
        let carried = transport_normal(m0, u0, u1);
        let mut m1 = carried;
        if strand.elastic() == Elastic::Rod {
            let own = strand.normal(j).as_dvec3();
            let across = own - u1 * own.dot(u1);
            if across.length_squared() > 1e-6 {
                m1 = across.normalize();
            }
            let half = carried.cross(m1).dot(u1) / (carried.dot(m1) + 1.0).max(FOLDED as f64);
            let tau = 4.0 * half / (1.0 + (1.0 + half * half).sqrt());
            let z = (0.5 * (u0 + u1).length_squared() / FOLDING as f64).min(1.0);
            let twist = z * (2.0 - z) * (tau - f64::from(strand.rest_twist(j)));
            energy.twisting += 0.5 * stiffness * ratio * curved_joint(local.z) * twist * twist;
            let wider = m0.dot(e(j) / length(j) - u0) - local.x;
            energy.bending += 0.5 * stiffness * flat * wider * wider;
        }
        (m0, u0) = (m1, u1);
    }
}
