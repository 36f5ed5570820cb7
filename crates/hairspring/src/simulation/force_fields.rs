//! External forces that the caller adds and removes between steps.

use super::Simulation;
use crate::forces::ForceField;
use std::sync::Arc;

/// Identifies a force field of a simulation. The identifier of a removed force is not used again.
///
/// For an example, see `examples/custom_force.rs`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ForceId(u32);

impl Simulation {
    /// Adds an external force, which acts in every step until it is removed. Forces act in the order in which
    /// they were added, after the built-in ones. To keep access to a force or to share it, add an [`Arc`] of it.
    pub fn add_force(&mut self, force: impl ForceField + 'static) -> ForceId {
        let id = ForceId(self.forces_added);
        self.forces_added += 1;
        self.force_fields.push((id, Arc::new(force)));
        id
    }

    /// Removes a force. Returns it, or `None` if it was already removed.
    pub fn remove_force(&mut self, id: ForceId) -> Option<Arc<dyn ForceField>> {
        let at = self.force_fields.iter().position(|(own, _)| *own == id)?;
        Some(self.force_fields.remove(at).1)
    }
}
