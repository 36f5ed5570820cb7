//! Sets a pose without motion: every strand in its rest shape, placed at its root.

use super::Simulation;
use crate::math::RigidTransform;

impl Simulation {
    /// Puts every strand at rest in its authored shape at the given roots (world pose, rotation since rest),
    /// in the order given to [`Simulation::builder`]. `anchor` is as in a step.
    ///
    /// # Panics
    /// If `roots` is not as long as [`Simulation::strand_count`].
    pub fn place(&mut self, anchor: RigidTransform, roots: &[RigidTransform]) {
        assert_eq!(roots.len(), self.model.lane_of_strand.len(), "one root pose for each simulated strand");
        self.state.anchor = anchor;
        let turn = anchor.rotation.inverse();
        for (k, root) in roots.iter().enumerate() {
            let lane = self.model.lane_of_strand[k] as usize;
            self.strand_mut(lane)
                .set_root(anchor.inverse_transform_point(root.translation), turn * root.rotation);
        }
        self.reset();
    }
}
