//! Poses of roots that move rigidly with the anchor.

use super::Simulation;
use crate::math::RigidTransform;

impl Simulation {
    /// Returns the roots of a scalp that moves rigidly with the anchor, for [`StepInput`](super::StepInput) and
    /// [`Simulation::place`]: every simulated strand at its authored root, moved from the rest pose of the anchor, see
    /// [`SimulationBuilder::anchor`](super::SimulationBuilder::anchor), to `anchor`.
    ///
    /// ```
    /// use hairspring::prelude::*;
    ///
    /// let strand: Vec<Vec3> = (1..9).map(|i| Vec3::Y * (0.01 * i as f32)).collect();
    /// let simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).build()?;
    /// let roots = simulation.rigid_roots(RigidTransform::from_translation(Vec3::X));
    /// assert_eq!(roots[0].translation, Vec3::new(1.0, 0.01, 0.0));
    /// # Ok::<(), BuildError>(())
    /// ```
    pub fn rigid_roots(&self, anchor: RigidTransform) -> Vec<RigidTransform> {
        let rest = self.model.rest_anchor;
        // Without rounding for an anchor that is at the origin at rest.
        let motion = if rest == RigidTransform::IDENTITY { anchor } else { anchor * rest.inverse() };
        let root = |s: u32| self.model.groom.strand(s as usize)[0];
        self.strands()
            .map(|s| RigidTransform::new(motion.transform_point(root(s)), motion.rotation))
            .collect()
    }
}
