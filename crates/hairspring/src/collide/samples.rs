//! Signed distance fields from arrays of samples.

use super::{
    SignedDistanceField,
    lattice::{Lattice, MAX_NODES},
    sdf::PADDING,
};
use glam::{UVec3, Vec3};

/// Error returned by `SignedDistanceField::from_samples`.
///
/// ```
/// use glam::{UVec3, Vec3};
/// use hairspring::collide::{FieldError, SignedDistanceField};
///
/// let refused = SignedDistanceField::from_samples(Vec3::ZERO, -1.0, UVec3::splat(2), vec![1.0; 8]);
/// assert_eq!(refused, Err(FieldError::Cell(-1.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldError {
    /// The cell is not finite and above 0.
    #[error("the cell must be finite and above 0 [m], not {0}")]
    Cell(f32),
    /// The origin is not finite.
    #[error("the origin must be three finite numbers [m]")]
    Origin,
    /// An axis has fewer than 2 nodes, or the field has too many.
    #[error("a field needs 2 or more nodes along each axis and at most {max} in all, not {0}", max = MAX_NODES)]
    Size(UVec3),
    /// The array does not have one sample for each node.
    #[error("a field of {nodes} nodes needs as many samples, not {samples}")]
    Count {
        /// Nodes of the field.
        nodes: usize,
        /// Samples of the array.
        samples: usize,
    },
    /// A sample is NaN or infinite.
    #[error("sample {0} is not finite")]
    NotFinite(usize),
}

impl SignedDistanceField {
    /// Makes a field from an array of signed distances [m], negative inside.
    ///
    /// Node (x, y, z) is at `origin + cell * (x, y, z)` [m], and its sample at the index
    /// `(z * size.y + y) * size.x + x`. Between nodes, the distance is interpolated linearly along each axis.
    /// Outside of the grid, the distance to the grid is added to the nearest sample, so the outermost samples
    /// should be positive.
    ///
    /// ```
    /// use hairspring::collide::SignedDistanceField;
    /// use glam::{UVec3, Vec3};
    ///
    /// // A ball of 5 cm, in cells of 1 cm.
    /// let (origin, cell, size) = (Vec3::splat(-0.1), 0.01, UVec3::splat(21));
    /// let node = |k: u32| UVec3::new(k % 21, k / 21 % 21, k / 441).as_vec3() * cell + origin;
    /// let samples = (0..9261).map(|k| node(k).length() - 0.05).collect();
    /// let field = SignedDistanceField::from_samples(origin, cell, size, samples)?;
    /// assert!((field.distance_and_normal(Vec3::X * 0.05).0).abs() < 1e-3);
    /// # Ok::<(), hairspring::collide::FieldError>(())
    /// ```
    ///
    /// # Errors
    /// See [`FieldError`].
    pub fn from_samples(
        origin: Vec3,
        cell: f32,
        size: UVec3,
        mut samples: Vec<f32>,
    ) -> Result<Self, FieldError> {
        if !(cell.is_finite() && cell > 0.0) {
            return Err(FieldError::Cell(cell));
        }
        if !origin.is_finite() {
            return Err(FieldError::Origin);
        }
        let nodes = size.to_array().into_iter().try_fold(1usize, |all, n| all.checked_mul(n as usize));
        let nodes = nodes.filter(|n| size.min_element() >= 2 && *n <= MAX_NODES);
        let nodes = nodes.ok_or(FieldError::Size(size))?;
        if samples.len() != nodes {
            return Err(FieldError::Count { nodes, samples: samples.len() });
        }
        if let Some(bad) = samples.iter().position(|d| !d.is_finite()) {
            return Err(FieldError::NotFinite(bad));
        }
        samples.resize(nodes + PADDING, f32::MAX);
        let mut field = Self::default();
        field.lattice = Lattice::new(origin, cell, size);
        field.distances = samples;
        field.nearest = vec![0; nodes];
        field.mark_inside();
        Ok(field)
    }
}
