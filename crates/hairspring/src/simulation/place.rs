//! Sets a pose without motion: every strand in its rest shape, placed at its root.

use super::Simulation;
use crate::{math::RigidTransform, simd::lanes::LANES, strand::tile::strand};

impl Simulation {
    /// Puts every strand at rest in its authored shape at the given roots (world pose, rotation since rest),
    /// in the order given to [`Simulation::builder`]. `anchor` is as in a step.
    ///
    /// # Panics
    /// If `roots` is not as long as [`Simulation::strand_count`].
    pub fn place(&mut self, anchor: RigidTransform, roots: &[RigidTransform]) {
        assert_eq!(roots.len(), self.model.places.len(), "one root pose for each simulated strand");
        self.state.anchor = anchor;
        let turn = anchor.rotation.inverse();
        for (k, root) in roots.iter().enumerate() {
            let place = self.model.places[k] as usize;
            let (tile, lane) = (place / LANES, place % LANES);
            let rows = &mut self.state.strand[tile];
            let p = anchor.inverse_point(root.translation).to_array();
            let q = (turn * root.rotation).to_array();
            for at in [strand::ROOT_START, strand::ROOT_END] {
                for (k, v) in p.into_iter().chain(q).enumerate() {
                    rows[at + k].0[lane] = v;
                }
            }
        }
        self.reset();
    }
}
