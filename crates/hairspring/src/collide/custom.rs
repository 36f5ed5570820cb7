//! Collider shapes that a user of the library defines.

use super::ColliderShape;
use crate::simd::lanes::{F, LANES, Row, Simd, V3, load};
use glam::Vec3;
use std::{fmt::Debug, sync::Arc};

/// A collider shape given by its signed distance.
///
/// The solver calls it for single points near its bounds. It is used as
/// [`ColliderShape::Custom`], moves as a rigid body, and does not deform.
///
/// ```
/// use hairspring::collide::{Collider, ColliderShape};
/// use glam::Vec3;
/// use std::sync::Arc;
///
/// /// A torus around Y.
/// #[derive(Debug)]
/// struct Torus { major: f32, minor: f32 }
///
/// impl Collider for Torus {
///     fn distance_and_normal(&self, p: Vec3) -> (f32, Vec3) {
///         let ring = Vec3::new(p.x, 0.0, p.z).normalize_or(Vec3::X) * self.major;
///         ((p - ring).length() - self.minor, (p - ring).normalize_or(Vec3::Y))
///     }
///     fn bounds(&self) -> (Vec3, f32) {
///         (Vec3::ZERO, self.major + self.minor)
///     }
///     fn half_thickness(&self) -> f32 {
///         self.minor
///     }
/// }
///
/// let shape = ColliderShape::Custom(Arc::new(Torus { major: 0.1, minor: 0.02 }));
/// assert!(shape.distance(Vec3::X * 0.1) < 0.0);
/// ```
pub trait Collider: Debug + Send + Sync {
    /// Returns the distance from `p` to the surface [m], negative inside, and the outward unit normal at the
    /// nearest place of the surface, both in the collider's own space. The normal is the gradient of the
    /// distance. A distance that is too small outside is safe; one that is too large lets hair in.
    fn distance_and_normal(&self, p: Vec3) -> (f32, Vec3);

    /// Returns a ball that contains the whole shape: center and radius [m]. The radius may be infinite.
    fn bounds(&self) -> (Vec3, f32);

    /// Returns about half of the thickness where the shape is thickest [m]. A shape that moves by more than
    /// half of it in a substep makes the frame take more substeps. Default: the radius of [`Self::bounds`].
    fn half_thickness(&self) -> f32 {
        self.bounds().1
    }
}

impl ColliderShape {
    /// Makes a collider shape of a [`Collider`].
    pub fn custom(collider: impl Collider + 'static) -> Self {
        Self::Custom(Arc::new(collider))
    }
}

/// Returns the distances and normals of eight points, one call for each.
#[inline(never)]
fn rows(collider: &dyn Collider, points: &[Row; 3]) -> [Row; 4] {
    let mut out = [Row::default(); 4];
    for lane in 0..LANES {
        let p = Vec3::from(points.map(|row| row.0[lane]));
        let (distance, normal) = collider.distance_and_normal(p);
        out[0].0[lane] = distance;
        (out[1].0[lane], out[2].0[lane], out[3].0[lane]) = (normal.x, normal.y, normal.z);
    }
    out
}

/// [`Collider::distance_and_normal`] for eight points.
#[inline(always)]
pub(super) fn distance_lanes<S: Simd>(collider: &dyn Collider, simd: S, p: V3<S>) -> (F<S>, V3<S>) {
    let mut points = [Row::default(); 3];
    p.store(&mut points);
    let [distance, normal @ ..] = rows(collider, &points);
    (load(simd, &distance), V3::load(simd, &normal))
}
