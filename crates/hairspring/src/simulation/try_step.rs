//! A step that checks its input, for engines whose input may be wrong.

use super::{Simulation, StepInput, StepReport};
use crate::{
    air::{Air, Flow, Source},
    collide::MovingCollider,
    math::RigidTransform,
};

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
    /// The shape of this collider has a NaN or an infinite number.
    #[error("the shape of collider {0} is not finite")]
    Shape(usize),
    /// The directional wind has a NaN or an infinite number.
    #[error("the velocity, `gust` or `gust_rate` of the wind is not finite")]
    Wind,
    /// The time at the start of the frame is NaN or infinite [s].
    #[error("the time of the air must be finite [s], not {0}")]
    Time(f64),
    /// This wind source has a NaN or an infinite number.
    #[error("wind source {0} is not finite")]
    Source(usize),
    /// The strength or the size of the turbulence is NaN or infinite.
    #[error("the `strength` or `size` of the turbulence is not finite")]
    Turbulence,
}

impl Simulation {
    /// Advances all strands like [`Simulation::step`], after checking the input.
    ///
    /// ```
    /// use hairspring::{prelude::*, simulation::StepError};
    ///
    /// let strand: Vec<Vec3> = (0..8).map(|i| Vec3::NEG_Y * (0.01 * i as f32)).collect();
    /// let mut simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).build()?;
    /// let refused = simulation.try_step(&StepInput::new(1.0 / 60.0, RigidTransform::IDENTITY, &[]));
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
        if !is_finite(&input.anchor) {
            return Err(StepError::Anchor);
        }
        if let Some(root) = input.roots.iter().position(|pose| !is_finite(pose)) {
            return Err(StepError::Root(root));
        }
        let unplaced = |o: &MovingCollider| !(is_finite(&o.start) && is_finite(&o.end));
        if let Some(collider) = input.colliders.iter().position(unplaced) {
            return Err(StepError::Collider(collider));
        }
        if let Some(collider) = input.colliders.iter().position(|o| !o.shape.is_finite()) {
            return Err(StepError::Shape(collider));
        }
        check_air(&input.air)?;
        Ok(self.step(input))
    }
}

fn check_air(air: &Air) -> Result<(), StepError> {
    let Air { wind, time, sources, turbulence } = air;
    if !(wind.velocity.is_finite() && wind.gust.is_finite() && wind.gust_rate.is_finite()) {
        return Err(StepError::Wind);
    }
    if !time.is_finite() {
        return Err(StepError::Time(*time));
    }
    if let Some(source) = sources.iter().position(|source| !is_finite_source(source)) {
        return Err(StepError::Source(source));
    }
    if !(turbulence.strength.is_finite() && turbulence.size.is_finite()) {
        return Err(StepError::Turbulence);
    }
    Ok(())
}

/// Returns whether all numbers of a pose are finite.
pub(super) fn is_finite(pose: &RigidTransform) -> bool {
    pose.translation.is_finite() && pose.rotation.is_finite()
}

/// Returns whether all numbers of a wind source are finite.
fn is_finite_source(source: &Source) -> bool {
    let (vectors, numbers) = match source.flow {
        Flow::Point { center, radius, speed } => ([center, center], [radius, speed, 0.0]),
        Flow::Vortex { center, axis, radius, speed } => ([center, axis], [radius, speed, 0.0]),
        Flow::Fan { center, axis, radius, speed, spread } => ([center, axis], [radius, speed, spread]),
    };
    is_finite(&source.pose)
        && source.factor.is_finite()
        && vectors.iter().all(|v| v.is_finite())
        && numbers.iter().all(|x| x.is_finite())
}
