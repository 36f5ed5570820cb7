//! A step that checks its input, for engines whose input may be wrong.

use super::{Simulation, StepInput, StepReport};
use crate::math::RigidTransform;

/// The reason that [`Simulation::try_step`] refused its input.
///
/// For an example, see [`Simulation::try_step`].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// The number of root poses is not that of the simulated strands.
    #[error("{roots} root poses were given for {strands} simulated strands")]
    RootCount {
        /// The given root poses.
        roots: usize,
        /// The simulated strands.
        strands: usize,
    },
    /// The length of the frame is not finite and above 0 [s].
    #[error("`dt` must be finite and above 0 [s], not {0}")]
    Dt(f32),
    /// The pose of the anchor has a NaN or an infinite number.
    #[error("the pose of the anchor is not finite")]
    Anchor,
    /// The pose of this root has a NaN or an infinite number.
    #[error("the pose of root {0} is not finite")]
    Root(usize),
    /// A pose of this collider has a NaN or an infinite number.
    #[error("a pose of collider {0} is not finite")]
    Collider(usize),
    /// The velocity of the directional wind has a NaN or an infinite number.
    #[error("the velocity of the wind is not finite")]
    Wind,
}

impl Simulation {
    /// Advances all strands like [`Simulation::step`], after checking the input.
    ///
    /// ```
    /// use hairspring::{prelude::*, simulation::StepError};
    ///
    /// let strand: Vec<Vec3> = (0..8).map(|i| Vec3::NEG_Y * (0.01 * i as f32)).collect();
    /// let mut simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).build()?;
    /// let anchor = RigidTransform::default();
    /// let input = StepInput { dt: 1.0 / 60.0, anchor, roots: &[], colliders: &[], air: Air::default() };
    /// let refused = simulation.try_step(&input);
    /// assert_eq!(refused, Err(StepError::RootCount { roots: 0, strands: 1 }));
    /// # Ok::<(), hairspring::simulation::BuildError>(())
    /// ```
    ///
    /// # Errors
    /// See [`StepError`]; the state is then unchanged.
    pub fn try_step(&mut self, input: &StepInput) -> Result<StepReport, StepError> {
        let (roots, strands) = (input.roots.len(), self.strand_count());
        if roots != strands {
            return Err(StepError::RootCount { roots, strands });
        }
        if !(input.dt.is_finite() && input.dt > 0.0) {
            return Err(StepError::Dt(input.dt));
        }
        let broken = |pose: &RigidTransform| !(pose.translation.is_finite() && pose.rotation.is_finite());
        if broken(&input.anchor) {
            return Err(StepError::Anchor);
        }
        if let Some(root) = input.roots.iter().position(broken) {
            return Err(StepError::Root(root));
        }
        if let Some(collider) = input.colliders.iter().position(|o| broken(&o.start) || broken(&o.end)) {
            return Err(StepError::Collider(collider));
        }
        if !input.air.wind.velocity.is_finite() {
            return Err(StepError::Wind);
        }
        Ok(self.step(input))
    }
}
