//! Forces of the user on the hair of a stage.

use super::Stage;
use hairspring::{
    forces::ForceField,
    simulation::{ForceId, Simulation},
};
use std::sync::Arc;

impl Stage {
    /// Adds a force on all simulated strands, until it is removed. Strands are counted in the order of
    /// [`Stage::simulated_offsets`]. See [`Simulation::add_force`].
    pub fn add_force(&mut self, force: impl ForceField + 'static) -> ForceId {
        self.simulation.add_force(force)
    }

    /// Removes a force and returns it; `None` if there is no such force.
    pub fn remove_force(&mut self, id: ForceId) -> Option<Arc<dyn ForceField>> {
        self.simulation.remove_force(id)
    }

    /// Returns the simulation of the guides of all grooms, one groom after the other.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// Returns the index of the first point of each simulated strand in [`Simulation::write_points`], then the number of
    /// points; shape `[simulated strands + 1]`.
    pub fn simulated_offsets(&self) -> Vec<u32> {
        let lengths = self.hair.iter().flat_map(|hair| {
            hair.simulated_strands().iter().map(|s| hair.groom().range(*s as usize).len() as u32)
        });
        std::iter::once(0)
            .chain(lengths.scan(0, |points, length| {
                *points += length;
                Some(*points)
            }))
            .collect()
    }
}
