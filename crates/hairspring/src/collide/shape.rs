//! Collider shapes: the distance and normal in a shape's own space, for one point and for eight.

use super::{Collider, Hull, SignedDistanceField, ThinShell, custom};
use crate::simd::lanes::{F, Simd, V3, transform};
use glam::{Mat3, Vec3};
use std::sync::Arc;

/// Smallest squared length of a capsule's axis that is divided by [m²].
const MIN_SQUARED_AXIS: f32 = 1e-12;

/// A collider shape in its own space.
///
/// For an example, see [`collide`](crate::collide).
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum ColliderShape {
    /// A ball around `center` [m].
    Sphere {
        /// Center [m].
        center: Vec3,
        /// Radius [m].
        radius: f32,
    },
    /// All points nearer than `radius` to the segment `a`–`b` [m].
    Capsule {
        /// One end of the axis [m].
        a: Vec3,
        /// The other end [m].
        b: Vec3,
        /// Radius [m].
        radius: f32,
    },
    /// A box.
    Cuboid {
        /// Center [m].
        center: Vec3,
        /// Half-extents along the axes [m].
        half: Vec3,
        /// Orthogonal unit vectors along the edges.
        axes: Mat3,
    },
    /// A half-space, on the side of a plane that its normal points away from: a floor, a wall, a slope.
    Plane {
        /// A point on the plane [m].
        point: Vec3,
        /// Unit normal, pointing out of the solid.
        normal: Vec3,
    },
    /// The interior of a closed mesh.
    Field(Arc<SignedDistanceField>),
    /// The convex hull of some points.
    Hull(Arc<Hull>),
    /// All points nearer to an open mesh than its thickness.
    Sheet(Arc<ThinShell>),
    /// A shape of the user's own.
    Custom(Arc<dyn Collider>),
}

impl ColliderShape {
    /// Returns the radius of a round shape [m]: infinite for a plane, and 0 for a shape that may have edges.
    pub(crate) fn roundness(&self) -> f32 {
        match self {
            ColliderShape::Plane { .. } => f32::INFINITY,
            ColliderShape::Sphere { radius, .. } | ColliderShape::Capsule { radius, .. } => *radius,
            _ => 0.0,
        }
    }

    /// Returns whether all numbers of the shape are finite; of a field, a hull or a sheet, whether its bounds are. A shape of
    /// the user's own may be unbounded.
    pub(crate) fn is_finite(&self) -> bool {
        match self {
            ColliderShape::Sphere { center, radius } => center.is_finite() && radius.is_finite(),
            ColliderShape::Capsule { a, b, radius } => a.is_finite() && b.is_finite() && radius.is_finite(),
            ColliderShape::Cuboid { center, half, axes } => {
                center.is_finite() && half.is_finite() && axes.is_finite()
            }
            ColliderShape::Plane { point, normal } => point.is_finite() && normal.is_finite(),
            ColliderShape::Field(_) | ColliderShape::Hull(_) | ColliderShape::Sheet(_) => {
                let (center, radius) = self.bounds();
                center.is_finite() && radius.is_finite()
            }
            ColliderShape::Custom(_) => true,
        }
    }

    /// Returns whether the shape is known to be convex. The deepest point of a segment is then searched for exactly.
    pub(crate) fn is_convex(&self) -> bool {
        matches!(
            self,
            ColliderShape::Sphere { .. }
                | ColliderShape::Capsule { .. }
                | ColliderShape::Cuboid { .. }
                | ColliderShape::Plane { .. }
                | ColliderShape::Hull(_)
        )
    }

    /// Returns the distance from `p` [m] in the collider's own space, negative inside.
    pub fn distance(&self, p: Vec3) -> f32 {
        self.distance_and_normal(p).0
    }

    /// Returns the distance [m] and outward unit normal at `p` [m] in the collider's own space.
    pub fn distance_and_normal(&self, p: Vec3) -> (f32, Vec3) {
        let ball = |d: Vec3, radius: f32| (d.length() - radius, d.normalize_or(Vec3::Y));
        match self {
            ColliderShape::Sphere { center, radius } => ball(p - *center, *radius),
            ColliderShape::Capsule { a, b, radius } => {
                let axis = *b - *a;
                let t = ((p - *a).dot(axis) / axis.length_squared().max(MIN_SQUARED_AXIS)).clamp(0.0, 1.0);
                ball(p - (*a + axis * t), *radius)
            }
            ColliderShape::Cuboid { center, half, axes } => {
                let l = axes.transpose() * (p - *center);
                let q = l.abs() - *half;
                let most = q.max_element();
                let (distance, normal) = if most <= 0.0 {
                    // Out through the nearest face.
                    let face = [Vec3::X, Vec3::Y, Vec3::Z]
                        [usize::from(q.x < most) + usize::from(q.x < most && q.y < most)];
                    (most, face)
                } else {
                    let out = q.max(Vec3::ZERO);
                    (out.length(), out.normalize())
                };
                (distance, *axes * Vec3::select(l.cmplt(Vec3::ZERO), -normal, normal))
            }
            ColliderShape::Plane { point, normal } => ((p - *point).dot(*normal), *normal),
            ColliderShape::Field(grid) => grid.distance_and_normal(p),
            ColliderShape::Hull(hull) => hull.distance_and_normal(p),
            ColliderShape::Sheet(sheet) => sheet.distance_and_normal(p),
            ColliderShape::Custom(custom) => custom.distance_and_normal(p),
        }
    }

    /// Returns the number of equal time slices of a frame. It is 1 except for skinned meshes whose surface
    /// moves fast.
    pub(crate) fn time_slices(&self) -> usize {
        match self {
            ColliderShape::Field(grid) => grid.previous_slices.len() + 1,
            ColliderShape::Sheet(sheet) => sheet.previous_slices.len() + 1,
            _ => 1,
        }
    }

    /// Returns the shape in one of its time slices, numbered from 0 in order of time.
    pub(crate) fn time_slice(&self, number: usize) -> ColliderShape {
        match self {
            ColliderShape::Field(grid) => {
                ColliderShape::Field(grid.previous_slices.get(number).unwrap_or(grid).clone())
            }
            ColliderShape::Sheet(sheet) => {
                ColliderShape::Sheet(sheet.previous_slices.get(number).unwrap_or(sheet).clone())
            }
            _ => self.clone(),
        }
    }

    /// Sets the shapes of all time slices of a frame but the last, which is `self`. They must be of the same
    /// kind. Only fields and shells have time slices.
    pub fn set_previous_slices(&mut self, earlier: Vec<ColliderShape>) {
        if self.time_slices() == 1 && earlier.is_empty() {
            // `make_mut` would copy a shape that is shared.
            return;
        }
        let earlier = earlier.into_iter();
        match self {
            ColliderShape::Field(grid) => {
                let field = |shape| if let ColliderShape::Field(grid) = shape { Some(grid) } else { None };
                Arc::make_mut(grid).previous_slices = earlier.filter_map(field).collect();
            }
            ColliderShape::Sheet(sheet) => {
                let open = |shape| if let ColliderShape::Sheet(sheet) = shape { Some(sheet) } else { None };
                Arc::make_mut(sheet).previous_slices = earlier.filter_map(open).collect();
            }
            _ => {}
        }
    }

    /// Returns half of the thickness where the shape is thickest [m]: about the depth of its deepest point.
    /// Infinite for a plane.
    pub fn half_thickness(&self) -> f32 {
        match self {
            ColliderShape::Sphere { radius, .. } | ColliderShape::Capsule { radius, .. } => *radius,
            ColliderShape::Cuboid { half, .. } => half.min_element(),
            ColliderShape::Plane { .. } => f32::INFINITY,
            ColliderShape::Field(grid) => -grid.distances.iter().copied().fold(0.0, f32::min),
            ColliderShape::Hull(hull) => -hull.distance_and_normal(hull.bounds().0).0,
            ColliderShape::Sheet(sheet) => sheet.thickness(),
            ColliderShape::Custom(custom) => custom.half_thickness(),
        }
    }

    /// Returns whether it is a solid whose [half thickness](Self::half_thickness) is less than `half` [m]. For a
    /// field, the grid's shortest side is tested first.
    pub(crate) fn is_thin(&self, half: f32) -> bool {
        match self {
            ColliderShape::Sheet(_) => false,
            ColliderShape::Field(grid) => grid.shortest_side() < 4.0 * half && self.half_thickness() < half,
            _ => self.half_thickness() < half,
        }
    }

    /// Returns a bounding sphere: center and radius [m].
    pub fn bounds(&self) -> (Vec3, f32) {
        match self {
            ColliderShape::Sphere { center, radius } => (*center, *radius),
            ColliderShape::Capsule { a, b, radius } => (a.midpoint(*b), 0.5 * a.distance(*b) + radius),
            ColliderShape::Cuboid { center, half, .. } => (*center, half.length()),
            ColliderShape::Plane { .. } => (Vec3::ZERO, f32::INFINITY),
            ColliderShape::Field(grid) => grid.bounds(),
            ColliderShape::Hull(hull) => hull.bounds(),
            ColliderShape::Sheet(sheet) => sheet.bounds(),
            ColliderShape::Custom(custom) => custom.bounds(),
        }
    }

    /// [`ColliderShape::distance_and_normal`] for eight points.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub(super) fn distance_lanes<S: Simd>(&self, simd: S, p: V3<S>) -> (F<S>, V3<S>) {
        match self {
            ColliderShape::Sphere { center, radius } => ball_lanes(p - V3::splat(simd, *center), *radius),
            ColliderShape::Capsule { a, b, radius } => {
                let axis = *b - *a;
                let from = p - V3::splat(simd, *a);
                let t = from.dot(V3::splat(simd, axis)) * (1.0 / axis.length_squared().max(MIN_SQUARED_AXIS));
                let t = t.max(0.0).min(1.0);
                ball_lanes(from - V3::splat(simd, axis) * t, *radius)
            }
            ColliderShape::Cuboid { center, half, axes } => {
                let local = transform(simd, &axes.transpose(), p - V3::splat(simd, *center));
                let (distance, normal) = cuboid_lanes(simd, local, *half);
                (distance, transform(simd, axes, normal))
            }
            ColliderShape::Plane { point, normal } => {
                let normal = V3::splat(simd, *normal);
                ((p - V3::splat(simd, *point)).dot(normal), normal)
            }
            ColliderShape::Field(grid) => grid.distance_lanes(simd, p),
            ColliderShape::Hull(hull) => hull.distance_lanes(simd, p),
            ColliderShape::Sheet(sheet) => sheet.distance_lanes(simd, p),
            ColliderShape::Custom(collider) => custom::distance_lanes(&**collider, simd, p),
        }
    }

    /// Like [`Self::distance_lanes`], but returns the gradient of the distance [1] instead of the normal.
    #[inline(always)]
    pub(super) fn slope_lanes<S: Simd>(&self, simd: S, p: V3<S>) -> (F<S>, V3<S>) {
        match self {
            ColliderShape::Field(grid) => grid.slope_lanes(simd, p),
            _ => self.distance_lanes(simd, p),
        }
    }
}

/// Returns the distance and normal of a sphere of `radius`, at `d` from its center.
#[inline(always)]
pub(super) fn ball_lanes<S: Simd>(d: V3<S>, radius: f32) -> (F<S>, V3<S>) {
    let (length, normal) = d.length_and_unit();
    (length - radius, normal)
}

/// Returns the distance and normal of a box around the origin: from its faces, edges and corners outside, and
/// through the nearest face inside.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn cuboid_lanes<S: Simd>(simd: S, l: V3<S>, half: Vec3) -> (F<S>, V3<S>) {
    let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
    let q = V3 { x: l.x.abs() - half.x, y: l.y.abs() - half.y, z: l.z.abs() - half.z };
    let (length, out) = V3 { x: q.x.max(zero), y: q.y.max(zero), z: q.z.max(zero) }.length_and_unit();
    let most = q.x.max(q.y).max(q.z);
    let inside = most.simd_le(0.0);
    let [x, y] = [q.x.simd_ge(most), q.y.simd_ge(most)];
    let face = V3 {
        x: x.select(one, zero),
        y: x.select(zero, y.select(one, zero)),
        z: x.select(zero, y.select(zero, one)),
    };
    let normal = V3::select(inside, face, out);
    let toward = |l: F<S>, n: F<S>| l.simd_lt(0.0).select(-n, n);
    let normal = V3 { x: toward(l.x, normal.x), y: toward(l.y, normal.y), z: toward(l.z, normal.z) };
    (inside.select(most, length), normal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::{ColliderPose, contact};
    use crate::simd::{
        dispatch::dispatch,
        lanes::{LANES, Row},
    };
    use fearless_simd::Level;
    use glam::Quat;
    use proptest::prelude::*;

    fn vector(size: f32) -> impl Strategy<Value = Vec3> {
        (-size..size, -size..size, -size..size).prop_map(Vec3::from)
    }

    proptest! {
        /// For every shape, the distance is that to the nearest point of its surface and the normal is the
        /// direction to or from it. The results for eight points match those for one.
        #[test]
        fn a_step_along_the_normal_leads_to_the_surface(
            center in vector(0.2), half in vector(0.1), turn in vector(3.0), p in vector(0.4),
            points in prop::collection::vec(vector(0.2), 6..20),
        ) {
            let half = half.abs() + 0.01;
            // Random points span a volume; the points that proptest shrinks to need not.
            let hull = Hull::new(&points);
            prop_assume!(hull.is_some());
            let axes = Mat3::from_quat(Quat::from_scaled_axis(turn));
            let end = center + axes.x_axis * half.x;
            let shapes = [
                ColliderShape::Sphere { center, radius: half.x },
                ColliderShape::Capsule { a: center, b: end, radius: half.y },
                ColliderShape::Cuboid { center, half, axes },
                ColliderShape::Plane { point: center, normal: axes.y_axis },
                ColliderShape::Hull(Arc::new(hull.unwrap())),
                ColliderShape::Sheet(Arc::new(ThinShell::new(&points, &[[0, 1, 2]], half.x))),
            ];
            for shape in shapes {
                let (distance, normal) = shape.distance_and_normal(p);
                prop_assert!((normal.length() - 1.0).abs() < 1e-5, "{shape:?}: {normal}");
                let on = p - normal * distance;
                // Farther off than its thickness, a shell returns only a lower bound.
                let exact = !matches!(shape, ColliderShape::Sheet(_)) || distance < 0.999 * half.x;
                prop_assert!(!exact || shape.distance(on).abs() < 1e-5, "{shape:?}: {} left at {on}", shape.distance(on));
                // No part of the surface is nearer: the ball of that radius around p lies entirely on one
                // side.
                for k in 0..64 {
                    let way = Quat::from_euler(glam::EulerRot::XYZ, k as f32, 1.7 * k as f32, 0.3) * Vec3::X;
                    let other = shape.distance(p + way * (0.98 * distance.abs()));
                    prop_assert!(other * distance >= -1e-9, "{shape:?}: {other} near {distance}");
                }
                let pose = ColliderPose::new(shape.clone(), (Mat3::IDENTITY, Vec3::ZERO), (Mat3::IDENTITY, Vec3::ZERO), 1.0);
                let (lanes, normals, near) = dispatch!(Level::new(), simd => {
                    let at = V3::splat(simd, p);
                    let (d, n) = contact(simd, &pose, at);
                    let mut rows = [Row([0.0; LANES]); 3];
                    n.store(&mut rows);
                    (d.lane(3), Vec3::from(rows.map(|r| r.0[3])), pose.broadphase_test(simd, at).any_true())
                });
                prop_assert!((lanes - distance).abs() < 1e-6, "{shape:?}: {lanes}, alone {distance}");
                prop_assert!(normals.distance(normal) < 1e-3, "{shape:?}: {normals}, alone {normal}");
                prop_assert!(near || distance > 0.0, "{shape:?}: inside, and not near");
            }
        }
    }
}
