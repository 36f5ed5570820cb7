//! The energy of the strands, by form. A swing without losses would conserve the total.

use super::Simulation;
use crate::parallel::prelude::*;
use crate::{
    settings::Integrator,
    simd::lanes::LANES,
    strand::{
        model::{
            bend::{FOLDED, transport_normal},
            rod::{FOLDING, curved_joint},
            springs::{BEND, Progressive, TORSION},
            stretch::STRETCH,
        },
        tile::{Elastic, rest, springs, state, strand},
    },
};
use glam::{DVec3, Quat};
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
            .places
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
            let stride = self.model.tiles[place / LANES].model.stride();
            let mut particles = self.particles(place).enumerate().skip(stride);
            let mut at = particles.next().unwrap_or_default().1.as_dvec3();
            let mut energy = 0.0;
            for (i, x) in particles {
                // An extra particle falls to the center of its segment.
                let from = (i - 1) / stride * stride;
                let step = down * (self.rest(place, from, rest::LENGTH) as f64 / stride as f64);
                at += step;
                let way = at - x.as_dvec3();
                energy += self.rest(place, i, rest::MASS) as f64 * gravity.dot(way);
            }
            energy
        };
        self.model.places.iter().map(|place| fall(*place as usize)).sum()
    }

    /// Number of points of the strand in lane `place`.
    pub(super) fn points(&self, place: usize) -> usize {
        self.model.groom.range(self.model.lanes[place] as usize).len()
    }

    /// Tension of the segment that begins at point `i` [N].
    pub(super) fn tension(&self, place: usize, i: usize) -> f32 {
        let (tile, lane) = (place / LANES, place % LANES);
        self.state.points[self.model.tiles[tile].first as usize + i][state::TENSION].0[lane]
    }

    fn strand_energy(&self, place: usize) -> Energy {
        let gravity = self.model.gravity.as_dvec3();
        let root = self.root_position(place).as_dvec3();
        let (tile, n) = (place / LANES, self.simulated_points(place));
        let stride = self.model.tiles[tile].model.stride();
        let mut energy = Energy::default();
        for (i, x) in self.particles(place).enumerate().skip(stride + 1) {
            let mass = self.rest(place, i, rest::MASS) as f64;
            let v = self.vector(place, i, state::V).as_dvec3();
            energy.kinetic += 0.5 * mass * v.length_squared();
            energy.gravitational -= mass * gravity.dot(root + x.as_dvec3());
        }
        let integrator = self.model.solver.integrator;
        let per_mass =
            if self.state.last_h > 0.0 { STRETCH as f64 / (self.state.last_h as f64).powi(2) } else { 0.0 };
        let spring = match integrator {
            Integrator::ExplicitEuler | Integrator::Verlet => Spring::Fiber,
            Integrator::Ftl | Integrator::Dftl => Spring::None,
            Integrator::BackwardEuler | Integrator::Bdf2 => Spring::PerMass(
                per_mass * self.state.strand[tile][strand::STIFFENING].0[place % LANES] as f64,
            ),
            Integrator::LocalGlobal => Spring::PerMass(per_mass),
        };
        if matches!(spring, Spring::None) {
            return energy;
        }
        // In these integrators, tension is a force. In the direct solver it is a multiplier, which does no
        // work on a segment of constant length.
        let pulls = !matches!(integrator, Integrator::BackwardEuler | Integrator::Bdf2);
        let axial = self.state.strand[tile][strand::AXIAL].0[place % LANES] as f64;
        let way = |i: usize, j: usize| -> DVec3 {
            (i + 1..=j).map(|k| self.vector(place, k, state::EDGE).as_dvec3()).sum()
        };
        for i in (stride..n - 1).step_by(stride) {
            let length = self.rest(place, i, rest::LENGTH) as f64;
            let k = match spring {
                Spring::None => 0.0,
                Spring::Fiber => axial / length,
                Spring::PerMass(rate) => self.rest(place, i, rest::MASS) as f64 * rate,
            };
            let longer = way(i, i + stride).length() - length;
            let tension = if pulls { self.tension(place, i) as f64 } else { 0.0 };
            energy.stretching += longer * (tension + 0.5 * k * longer);
        }
        match self.model.tiles[tile].model {
            Elastic::Springs => self.add_springs(place, &way, &mut energy),
            model => self.add_joints(place, model, &|i| way(i, i + 1), &mut energy),
        }
        energy
    }

    /// Adds the bend and torsion springs between particles that are `way` apart. The triangles count as
    /// rigid, and the altitude springs as inactive.
    fn add_springs(&self, place: usize, way: &dyn Fn(usize, usize) -> DVec3, energy: &mut Energy) {
        let n = self.simulated_points(place);
        let mut spring = |i: usize, far: usize, (stiffness, length): (usize, usize), law: Progressive| {
            let rest = self.rest(place, i, length) as f64;
            let stretched = law.pull(way(i, i + far).length() - rest, rest).1;
            energy.bending += self.rest(place, i, stiffness) as f64 * stretched;
        };
        for i in 0..n - 3 {
            spring(i, 3, (springs::K3, springs::L3), TORSION);
            if i % 2 == 1 {
                spring(i, 2, (springs::K2, springs::L2), BEND);
            }
        }
    }

    /// Adds bending and twisting of the joints between segments `e`. Frames are transported as in the kernel.
    fn add_joints(&self, place: usize, model: Elastic, e: &dyn Fn(usize) -> DVec3, energy: &mut Energy) {
        let (tile, lane) = (place / LANES, place % LANES);
        let rows = &self.state.strand[tile];
        let row = |at: usize| rows[at].0[lane];
        let turn = Quat::from_array([0, 1, 2, 3].map(|k| row(strand::TURN_END + k)));
        let normal = glam::Vec3::from_array([0, 1, 2].map(|k| row(strand::NORMAL + k)));
        let mut m0 = (self.state.anchor.rotation * turn * normal).as_dvec3();
        let (ratio, flat) = (row(strand::TWIST_RATIO) as f64, row(strand::FLAT) as f64);
        let mut u0 = e(0).normalize_or_zero();
        for j in 1..self.points(place) - 1 {
            let length = |i: usize| self.rest(place, i, rest::LENGTH) as f64;
            let u1 = e(j).normalize_or_zero();
            let stiffness = self.rest(place, j, rest::BEND) as f64;
            let local = DVec3::from_array([0, 1, 2].map(|k| self.rest(place, j, rest::TURN + k) as f64));
            let d = m0 * local.x + u0.cross(m0) * local.y + u0 * local.z;
            let r = e(j) / length(j) - e(j - 1) / length(j - 1) - d;
            energy.bending += 0.5 * stiffness * r.length_squared();
            let carried = transport_normal(m0, u0, u1);
            let mut m1 = carried;
            if model == Elastic::Rod {
                let own = self.vector(place, j, state::NORMAL).as_dvec3();
                let across = own - u1 * own.dot(u1);
                if across.length_squared() > 1e-6 {
                    m1 = across.normalize();
                }
                let half = carried.cross(m1).dot(u1) / (carried.dot(m1) + 1.0).max(FOLDED as f64);
                let tau = 4.0 * half / (1.0 + (1.0 + half * half).sqrt());
                let z = (0.5 * (u0 + u1).length_squared() / FOLDING as f64).min(1.0);
                let twist = z * (2.0 - z) * (tau - self.rest(place, j, rest::TWIST) as f64);
                energy.twisting += 0.5 * stiffness * ratio * curved_joint(local.z) * twist * twist;
                let wider = m0.dot(e(j) / length(j) - u0) - local.x;
                energy.bending += 0.5 * stiffness * flat * wider * wider;
            }
            (m0, u0) = (m1, u1);
        }
    }
}
