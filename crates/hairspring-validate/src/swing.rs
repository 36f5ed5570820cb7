//! The swing test: some strands of a scene swing freely in empty space. It compares integrators by what they
//! do to the energy.
//!
//! The strands start as the groom has them, free of stress, with fixed roots. Gravity is tilted, so they fall
//! and swing. There is no contact and nothing drives them. Without air and fiber damping, an exact integrator
//! would conserve the total energy.

use crate::bench::FRAME;
use glam::{Quat, Vec3};
use hairspring::settings::{Integrator, Solver};
use hairspring::{
    air::Air,
    groom::Groom,
    material::Material,
    math::RigidTransform,
    simulation::{Energy, Measure, Simulation, StepInput, StepReport},
};
use hairspring_scene::Scene;
use std::sync::Arc;

/// Rotation of gravity about the Z axis [degrees], so that hanging hair swings widely.
pub const TILT: f32 = 45.0;

/// Gravity used for a scene that has none [m/s²].
const EARTH: Vec3 = Vec3::new(0.0, -9.81, 0.0);

/// A sample of a scene's strands, which can be swung repeatedly.
#[derive(Clone, Debug)]
pub struct Sample {
    groom: Arc<Groom>,
    /// One for each strand.
    materials: Vec<Material>,
    gravity: Vec3,
    solver: Solver,
}

impl Sample {
    /// Samples about `count` strands of the scene, 1 or more, or all if there are no more. They are evenly
    /// spread over each groom in order, in proportion to its size. The strand with the shortest segment is
    /// always included, because it determines the longest stable step of an explicit method.
    pub fn new(scene: &Scene, count: usize) -> Self {
        let mut sample = Groom { offsets: vec![0], ..Groom::default() };
        let mut materials = Vec::new();
        let all: usize = scene.grooms.iter().map(|g| g.groom.strand_count()).sum();
        let shortest = |groom: &Groom, s: usize| {
            groom.strand(s).windows(2).skip(1).map(|w| w[0].distance_squared(w[1])).fold(f32::MAX, f32::min)
        };
        let stiffest = scene
            .grooms
            .iter()
            .enumerate()
            .flat_map(|(g, scene)| (0..scene.groom.strand_count()).map(move |s| (g, s)))
            .map(|(g, s)| (shortest(&scene.grooms[g].groom, s), g, s))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        for (g, from) in scene.grooms.iter().enumerate() {
            let strands = from.groom.strand_count();
            let share = (count * strands).div_ceil(all.max(1)).min(strands);
            let mut chosen: Vec<usize> = (0..share).map(|k| (2 * k + 1) * strands / (2 * share)).collect();
            if let Some((_, _, s)) = stiffest.filter(|(_, at, s)| *at == g && !chosen.contains(s)) {
                chosen.pop();
                chosen.push(s);
            }
            for s in chosen {
                let range = from.groom.range(s);
                sample.points.extend_from_slice(&from.groom.points[range.clone()]);
                sample.radii.extend_from_slice(&from.groom.radii[range]);
                sample.offsets.push(sample.points.len() as u32);
                sample.groups.push(materials.len() as u16);
                sample.scales.push(from.groom.scale(s));
                let material = from.materials.get(from.groom.group(s) as usize).or(from.materials.last());
                materials.push(material.cloned().unwrap_or_default());
            }
        }
        let gravity = if scene.gravity == Vec3::ZERO { EARTH } else { scene.gravity };
        Self {
            groom: Arc::new(sample),
            materials,
            gravity: Quat::from_rotation_z(TILT.to_radians()) * gravity,
            solver: Solver { sag_free: false, ..scene.solver },
        }
    }

    /// Removes air drag and fiber damping, so that only the integrator dissipates energy.
    pub fn without_losses(mut self) -> Self {
        self.materials.iter_mut().for_each(|m| (m.damping, m.drag) = (0.0, 0.0));
        self
    }

    /// Returns the number of strands.
    pub fn strand_count(&self) -> usize {
        self.groom.strand_count()
    }

    /// Returns the length of the shortest segment that is not driven by a root [m].
    pub fn shortest_segment(&self) -> f32 {
        let segments = |s: usize| self.groom.strand(s).windows(2).skip(1).map(|w| w[0].distance(w[1]));
        (0..self.strand_count()).flat_map(segments).fold(f32::INFINITY, f32::min)
    }

    /// Returns the shortest time in which sound crosses a free segment, L √(ρ/E) [s]. This is about the
    /// longest stable step of an explicit method: h ω must stay below 2, and the highest natural frequency of
    /// a chain is ω = 2 √(E/ρ) / L.
    pub fn sound_time(&self) -> f64 {
        let of = |s: usize| {
            let shortest = self
                .groom
                .strand(s)
                .windows(2)
                .skip(1)
                .map(|w| w[0].distance(w[1]))
                .fold(f32::INFINITY, f32::min);
            f64::from(shortest) * f64::from(self.materials[s].density / self.materials[s].young).sqrt()
        };
        (0..self.strand_count()).map(of).fold(f64::INFINITY, f64::min)
    }
}

/// A sample in motion, advanced by steps of any length.
pub struct Swing {
    simulation: Simulation,
    roots: Vec<RigidTransform>,
    /// Step length in simulation time [s].
    step: f32,
    /// Ratio of simulation speed to real time.
    pace: f64,
}

impl Swing {
    /// Creates the sample at rest, to be advanced by steps of `h` [s], above 0.
    pub fn new(sample: &Sample, integrator: Integrator, h: f64) -> Self {
        // A simulation takes no step longer than a frame. A longer step is therefore simulated as a frame of
        // a faster world: velocities scale with the pace, accelerations and stiffnesses with its square, and
        // lengths stay. Drag grows slightly more, since its coefficient is that of the larger Reynolds
        // number.
        let pace = (h / FRAME as f64).max(1.0);
        let (p, p2) = (pace as f32, (pace * pace) as f32);
        let materials: Vec<Material> = sample
            .materials
            .iter()
            .map(|m| Material {
                young: m.young * p2,
                shear: m.shear * p2,
                damping: m.damping / p,
                drag: m.drag * p,
                ..m.clone()
            })
            .collect();
        let all: Vec<u32> = (0..sample.strand_count() as u32).collect();
        let roots = (0..sample.strand_count())
            .map(|s| RigidTransform { translation: sample.groom.strand(s)[0], ..RigidTransform::default() })
            .collect();
        let simulation = Simulation::builder(sample.groom.clone())
            .strands(&all)
            .materials(&materials)
            .solver(Solver { substeps: 1, integrator, ..sample.solver })
            .gravity(sample.gravity * p2)
            .build()
            .unwrap();
        Self { simulation, roots, step: (h / pace) as f32, pace }
    }

    /// Advances by one step.
    pub fn step(&mut self) -> StepReport {
        self.simulation.step(&StepInput {
            dt: self.step,
            anchor: RigidTransform::default(),
            roots: &self.roots,
            colliders: &[],
            air: Air::default(),
        })
    }

    /// Returns the current measurements.
    pub fn measure(&self) -> Measure {
        let mut measure = self.simulation.measure(&[]);
        measure.speed_max /= self.pace;
        measure
    }

    /// Returns the current energy [J].
    pub fn energy(&self) -> Energy {
        let mut energy = self.simulation.energy();
        let p2 = self.pace * self.pace;
        for part in [
            &mut energy.kinetic,
            &mut energy.gravitational,
            &mut energy.bending,
            &mut energy.twisting,
            &mut energy.stretching,
        ] {
            *part /= p2;
        }
        energy
    }

    /// Returns the energy that could still be released by falling [J]; see [`Simulation::energy_to_fall`].
    pub fn energy_to_fall(&self) -> f64 {
        self.simulation.energy_to_fall() / (self.pace * self.pace)
    }
}
