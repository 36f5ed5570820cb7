//! Changes settings of a running simulation in place, where rest shapes do not depend on them.

use super::{Simulation, build::write_surface, multipliers, strand_model::material_of};
use crate::{
    material::Material,
    settings::{OutOfRange, Solver, Validate, validate_gravity},
    simd::lanes::{LANES, Row},
    strand::tile::segment_contact,
};
use glam::Vec3;
use std::sync::Arc;

impl Simulation {
    /// Applies changed settings from the next step on, and keeps the state. Returns false and changes nothing if
    /// rest shapes depend on a changed setting: then build a new simulation with the settings, and
    /// [take over](Simulation::take_over) the state of this one. The result is the same as that, bit for bit,
    /// with the implicit integrators.
    ///
    /// | settings | in place |
    /// | --- | --- |
    /// | material | `drag`, `friction`, `friction_kinetic`, `charge`, `charge_profile`, `global_shape`, `tether`, `tether_profile` |
    /// | gravity | without `solver.sag_free` |
    /// | solver | `contact`, `segment_contacts`, `projection_iterations`, `quality`, `inertia`, `teleport_distance`, `global_shape` |
    ///
    /// `materials` are those of all groups, as in [`SimulationBuilder::materials`](super::SimulationBuilder::materials).
    ///
    /// # Errors
    /// If a setting is out of range; then nothing changes.
    pub fn update_settings(
        &mut self,
        materials: &[Material],
        solver: Solver,
        gravity: Vec3,
    ) -> Result<bool, OutOfRange> {
        materials.iter().try_for_each(Material::validate)?;
        solver.validate()?;
        validate_gravity(gravity)?;
        let default = [Material::default()];
        let materials = if materials.is_empty() { &default[..] } else { materials };
        let old = &self.model;
        let in_place = (old.gravity == gravity || !solver.sag_free)
            && same_rest_shapes_by_solver(&old.solver, &solver)
            && old.materials.len() == materials.len()
            && old.materials.iter().zip(materials).all(|(old, new)| same_rest_shapes(old, new));
        if !in_place {
            return Ok(false);
        }
        if old.materials != materials {
            let model = Arc::make_mut(&mut self.model);
            model.materials = materials.to_vec();
            for (lane, s) in model.groom_strands.iter().enumerate().filter(|(_, s)| **s != u32::MAX) {
                let s = *s as usize;
                let material = material_of(materials, &model.groom, s);
                let scale = model.groom.scale(s);
                write_surface(&mut model.strand[lane / LANES], lane % LANES, material, scale);
            }
            // The multipliers depend on friction, because friction times its profile is clamped to 1.
            let (tethers, multipliers) = (self.tethers(), multipliers::constants(&self.model));
            let model = Arc::make_mut(&mut self.model);
            (model.tethers, model.multipliers) = (tethers, multipliers);
        }
        if self.model.gravity != gravity {
            Arc::make_mut(&mut self.model).gravity = gravity;
        }
        if self.model.solver != solver {
            Arc::make_mut(&mut self.model).solver = solver;
            let points = if solver.segment_contacts { self.state.points.len() } else { 0 };
            self.state.segment_contacts.resize(points, [Row::default(); segment_contact::ROWS]);
        }
        Ok(true)
    }
}

/// Whether two materials give the same rest shapes.
fn same_rest_shapes(old: &Material, new: &Material) -> bool {
    let Material { drag, friction, friction_kinetic, charge, tether, .. } = *new;
    let kept = Material {
        drag,
        friction,
        friction_kinetic,
        charge,
        tether,
        charge_profile: new.charge_profile.clone(),
        global_shape: new.global_shape.clone(),
        tether_profile: new.tether_profile.clone(),
        ..old.clone()
    };
    kept == *new
}

/// Whether two solvers give the same rest shapes and the same arrays of state.
fn same_rest_shapes_by_solver(old: &Solver, new: &Solver) -> bool {
    let kept = Solver { substeps: old.substeps, sag_free: old.sag_free, integrator: old.integrator, ..*new };
    kept == *new
}
