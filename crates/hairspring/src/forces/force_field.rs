//! External forces that a user of the library adds.

use super::StrandView;
use std::sync::Arc;

/// An external force on hair, evaluated once a frame and strand, and constant over the substeps of the frame.
///
/// It reads positions and velocities at the start of the frame, and adds accelerations, springs and drag to
/// points. Springs and drag are implicit: they are part of the solve and stable at any stiffness. See
/// [`Simulation::add_force`](crate::simulation::Simulation::add_force).
///
/// ```
/// use hairspring::forces::{ForceField, StrandView};
/// use glam::Vec3;
///
/// /// Pulls all points toward a place.
/// struct Attractor { center: Vec3, stiffness: f32 }
///
/// impl ForceField for Attractor {
///     fn apply(&self, strand: &mut StrandView) {
///         let [start, end] = strand.roots();
///         for i in 2..strand.point_count() {
///             let target = [self.center - start.translation, self.center - end.translation];
///             strand.add_position_spring(i, target, self.stiffness);
///         }
///     }
/// }
/// ```
pub trait ForceField: Send + Sync {
    /// Adds the force on one strand. It is called on several threads at once, in no particular order.
    fn apply(&self, strand: &mut StrandView);
}

/// A force that several simulations share, or that the caller keeps.
impl<T: ForceField + ?Sized> ForceField for Arc<T> {
    fn apply(&self, strand: &mut StrandView) {
        (**self).apply(strand);
    }
}
