//! Builds a simulation from a groom and its settings.

use super::{Simulation, strand_model::material_of, try_step::is_finite};
use crate::{
    collide::ColliderPose,
    groom::Groom,
    material::Material,
    math::RigidTransform,
    settings::{OutOfRange, Solver, Validate, validate_gravity},
};
use glam::Vec3;
use std::{borrow::Cow, sync::Arc};

/// Describes a [`Simulation`]; see [`Simulation::builder`].
///
/// For an example, see [`Simulation::builder`].
pub struct SimulationBuilder<'a> {
    pub(super) groom: Arc<Groom>,
    pub(super) strands: Cow<'a, [u32]>,
    pub(super) materials: &'a [Material],
    pub(super) solver: Solver,
    pub(super) gravity: Vec3,
    pub(super) anchor: RigidTransform,
    pub(super) colliders: &'a [ColliderPose],
    pub(super) group_user_data: &'a [u128],
}

impl std::fmt::Debug for SimulationBuilder<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SimulationBuilder")
            .field("strands", &self.strands.len())
            .field("materials", &self.materials.len())
            .field("solver", &self.solver)
            .field("gravity", &self.gravity)
            .field("anchor", &self.anchor)
            .field("colliders", &self.colliders.len())
            .finish_non_exhaustive()
    }
}

/// The reason that a simulation cannot be built.
///
/// ```
/// use glam::Vec3;
/// use hairspring::{groom::Groom, simulation::{BuildError, Simulation}};
///
/// let short = Groom::from_strands([[Vec3::ZERO, Vec3::Y]], 35e-6);
/// let refused = Simulation::builder(short).build().err();
/// assert_eq!(refused, Some(BuildError::TooFewPoints { strand: 0, points: 2 }));
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// A strand that the groom does not have.
    #[error("strand {strand} was requested, but the groom has only {count}")]
    NoSuchStrand {
        /// The requested strand.
        strand: u32,
        /// Strands of the groom.
        count: usize,
    },
    /// A strand is too short to be simulated.
    #[error("strand {strand} has {points} points, but a simulated strand needs at least 3")]
    TooFewPoints {
        /// The strand.
        strand: u32,
        /// Its points.
        points: usize,
    },
    /// A coordinate of the groom is NaN or infinite.
    #[error("strand {strand} has a coordinate that is not finite; `groom::sanitize` repairs such grooms")]
    NotFinite {
        /// The strand.
        strand: u32,
    },
    /// A radius of the groom that is used is not finite and above 0.
    #[error(
        "strand {strand} has the radius {radius} m at a point, which must be finite and above 0; `groom::sanitize` \
         repairs such grooms"
    )]
    Radius {
        /// The strand.
        strand: u32,
        /// The radius [m].
        radius: f32,
    },
    /// A multiplier of a strand is out of range.
    #[error("the multipliers of strand {strand}: {error}")]
    Scale {
        /// The strand.
        strand: u32,
        /// The multiplier.
        error: OutOfRange,
    },
    /// An array of the groom has the wrong length.
    #[error("the groom's array `{array}` has {length} entries instead of {expected}")]
    GroomArray {
        /// The field of [`Groom`].
        array: &'static str,
        /// Its length.
        length: usize,
        /// The length that it must have.
        expected: usize,
    },
    /// A setting of the solver is out of range.
    #[error("solver: {0}")]
    Solver(OutOfRange),
    /// A setting of a material is out of range.
    #[error("material {index}: {error}")]
    Material {
        /// The material.
        index: usize,
        /// The setting.
        error: OutOfRange,
    },
    /// Gravity is out of range.
    #[error(transparent)]
    Gravity(OutOfRange),
    /// The rest pose of the anchor is not finite.
    #[error("the rest pose of the anchor must consist of finite numbers")]
    Anchor,
}

impl Simulation {
    /// Describes a simulation of the strands of `groom`.
    ///
    /// ```
    /// use hairspring::{groom::Groom, simulation::Simulation};
    /// use glam::Vec3;
    ///
    /// let strand: Vec<Vec3> = (0..16).map(|i| Vec3::NEG_Y * (0.01 * i as f32)).collect();
    /// let simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).build()?;
    /// assert_eq!(simulation.point_count(), 16);
    /// # Ok::<(), hairspring::simulation::BuildError>(())
    /// ```
    pub fn builder<'a>(groom: impl Into<Arc<Groom>>) -> SimulationBuilder<'a> {
        let groom = groom.into();
        SimulationBuilder {
            strands: (0..groom.strand_count() as u32).collect(),
            groom,
            materials: &[],
            solver: Solver::default(),
            gravity: Vec3::new(0.0, -9.81, 0.0),
            anchor: RigidTransform::default(),
            colliders: &[],
            group_user_data: &[],
        }
    }
}

impl<'a> SimulationBuilder<'a> {
    /// Sets the simulated strands, as indices of the groom. Default: all. Their order is that of the roots in
    /// [`StepInput`](super::StepInput) and of [`Simulation::write_points`].
    pub fn strands(mut self, strands: &'a [u32]) -> Self {
        self.strands = Cow::Borrowed(strands);
        self
    }

    /// Sets the material of each group of the groom. A group past the end uses the last one. Default: one
    /// default material.
    pub fn materials(mut self, materials: &'a [Material]) -> Self {
        self.materials = materials;
        self
    }

    /// Sets time steps, integrator and contact.
    pub fn solver(mut self, solver: Solver) -> Self {
        self.solver = solver;
        self
    }

    /// Sets gravity [m/s²]. Default (0, −9.81, 0). With `solver.sag_free`, the groom is in balance under it.
    pub fn gravity(mut self, gravity: Vec3) -> Self {
        self.gravity = gravity;
        self
    }

    /// Sets the rest pose of the frame that roots move with. Default: the identity.
    pub fn anchor(mut self, anchor: RigidTransform) -> Self {
        self.anchor = anchor;
        self
    }

    /// Sets the colliders at rest. Points that start inside may stay at their depth. Pass the colliders here and in
    /// each step in the same order. A point that starts more than 5 mm inside a [distance
    /// field](crate::collide::ColliderShape::Field) ignores that collider. Default: none.
    pub fn colliders_at_rest(mut self, colliders: &'a [ColliderPose]) -> Self {
        self.colliders = colliders;
        self
    }

    /// Sets the user data of each group of the groom; see [`Simulation::group_user_data`]. A group past
    /// the end has 0. Default: 0 for all.
    pub fn group_user_data(mut self, user_data: &'a [u128]) -> Self {
        self.group_user_data = user_data;
        self
    }

    /// Builds the simulation, at rest.
    ///
    /// # Errors
    /// If a strand, an array of the groom or a setting is invalid: see [`BuildError`].
    pub fn build(self) -> Result<Simulation, BuildError> {
        self.check()?;
        let group_user_data = self.group_user_data.to_vec();
        let mut simulation = Simulation::from_builder(self);
        simulation.group_user_data = group_user_data;
        Ok(simulation)
    }

    fn check(&self) -> Result<(), BuildError> {
        let groom = &self.groom;
        let (count, points) = (groom.strand_count(), groom.point_count());
        let end = groom.offsets.last().copied().unwrap_or(0) as usize;
        let arrays = [
            ("points", points, end, true),
            ("radii", groom.radii.len(), points, true),
            ("groups", groom.groups.len(), count, false),
            ("scales", groom.scales.len(), count, false),
        ];
        for (array, length, expected, needed) in arrays {
            if length != expected && (needed || length > 0) {
                return Err(BuildError::GroomArray { array, length, expected });
            }
        }
        if let Some(s) = groom.offsets.windows(2).position(|w| w[0] > w[1]) {
            let (length, expected) = (groom.offsets[s + 1] as usize, groom.offsets[s] as usize);
            return Err(BuildError::GroomArray { array: "offsets", length, expected });
        }
        for &strand in &*self.strands {
            if strand as usize >= count {
                return Err(BuildError::NoSuchStrand { strand, count });
            }
            let points = groom.strand(strand as usize);
            if points.len() < 3 {
                return Err(BuildError::TooFewPoints { strand, points: points.len() });
            }
            if !points.iter().all(|p| p.is_finite()) {
                return Err(BuildError::NotFinite { strand });
            }
            self.check_fiber(strand)?;
        }
        self.solver.validate().map_err(BuildError::Solver)?;
        for (index, material) in self.materials.iter().enumerate() {
            material.validate().map_err(|error| BuildError::Material { index, error })?;
        }
        validate_gravity(self.gravity).map_err(BuildError::Gravity)?;
        if !is_finite(&self.anchor) {
            return Err(BuildError::Anchor);
        }
        Ok(())
    }

    /// Checks the radii and multipliers of a strand. Radii of the groom are not used if the material has one.
    fn check_fiber(&self, strand: u32) -> Result<(), BuildError> {
        let (groom, s) = (&self.groom, strand as usize);
        groom.scale(s).validate().map_err(|error| BuildError::Scale { strand, error })?;
        // The default material has no radius.
        if !self.materials.is_empty() && material_of(self.materials, groom, s).radius.is_some() {
            return Ok(());
        }
        let radii = &groom.radii[groom.range(s)];
        match radii.iter().find(|radius| !(radius.is_finite() && **radius > 0.0)) {
            Some(&radius) => Err(BuildError::Radius { strand, radius }),
            None => Ok(()),
        }
    }
}
