//! Poses: rotations and translations from Python.

use crate::{arrays::Floats, errors::setting};
use glam::{Mat4, Quat, Vec3};
use hairspring::math::RigidTransform;
use pyo3::prelude::*;

/// Largest difference of a rotation's columns from orthogonal unit vectors [1].
const ORTHOGONAL: f32 = 1e-3;

/// A pose argument: a 4×4 matrix that maps column vectors, in the layout of numpy (`matrix[:3, 3]` is the translation); or only
/// a translation of three numbers [m].
pub struct Pose(pub RigidTransform);

impl<'a, 'py> FromPyObject<'a, 'py> for Pose {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let given: Floats = object.extract()?;
        match given.shape() {
            [3] => Ok(Self(RigidTransform {
                translation: given.vector::<Vec3, 3>("pose")?,
                ..RigidTransform::default()
            })),
            [4, 4] => {
                let rows = <[f32; 16]>::try_from(given.numbers()?).map_err(setting_of_shape)?;
                rigid(Mat4::from_cols_array(&rows).transpose()).map(Self)
            }
            _ => Err(setting_of_shape(())),
        }
    }
}

fn setting_of_shape<E>(_: E) -> PyErr {
    setting("a pose must be a 4×4 matrix or a translation of three numbers [m]")
}

/// The rotation and translation of a matrix, which must not scale or shear.
fn rigid(m: Mat4) -> PyResult<RigidTransform> {
    let axes = glam::Mat3::from_mat4(m);
    let identity = axes.transpose() * axes - glam::Mat3::IDENTITY;
    let error = identity.to_cols_array().iter().fold(0.0f32, |most, e| most.max(e.abs()));
    if !m.w_axis.is_finite() {
        return Err(setting("the translation of a pose is not finite"));
    }
    if !(error < ORTHOGONAL && axes.determinant() > 0.0) {
        return Err(setting(
            "the matrix of a pose must rotate and translate only; it scales, shears or mirrors",
        ));
    }
    Ok(RigidTransform { rotation: Quat::from_mat3(&axes).normalize(), translation: m.w_axis.truncate() })
}

/// Poses of roots: positions `[strands, 3]` [m], and rotations since rest as quaternions `[strands, 4]` (x, y, z, w).
pub fn roots(positions: &[Vec3], rotations: Option<&[Quat]>) -> PyResult<Vec<RigidTransform>> {
    if let Some(rotations) = rotations
        && rotations.len() != positions.len()
    {
        let text = format!("{} rotations were given for {} roots", rotations.len(), positions.len());
        return Err(setting(text));
    }
    let rotation = |k: usize| match rotations {
        None => Ok(Quat::IDENTITY),
        Some(rotations) => {
            let unit = rotations[k].length();
            if !(unit.is_finite() && unit > 0.0) {
                return Err(setting(format!("rotation {k} is not a quaternion (x, y, z, w)")));
            }
            Ok(rotations[k] / unit)
        }
    };
    positions
        .iter()
        .enumerate()
        .map(|(k, p)| Ok(RigidTransform { translation: *p, rotation: rotation(k)? }))
        .collect()
}
