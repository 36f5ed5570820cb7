//! Convex hulls. Inside, the distance is the maximum over the planes of the faces; outside, it is that to the
//! nearest point of the faces.
//!
//! ```text
//!   inside   d = max n·p − c           over the faces' planes (n, c)
//!   outside  d = min |p − q|, q on a face that p is in front of: the nearest point lies on such a face
//! ```

use crate::{
    body::nearest_on_triangle,
    simd::lanes::{F, Mask, Simd, V3},
};
use glam::Vec3;
use parry3d::transformation::try_convex_hull;

/// Tolerance relative to the hull's radius, within which a point counts as on the surface and triangles as
/// coplanar: `f32` has 24 bits.
const TOUCH: f32 = 1e-5;

/// Minimum thickness relative to the hull's radius. Points that are coplanar within this have no inside.
const THIN: f32 = 1e-3;

/// Amplitudes of random joggling relative to the hull's radius, tried until quickhull contains all points.
/// Quickhull may lose points that are coplanar or nearly so (joggled input: Barber, Dobkin & Huhdanpaa 1996,
/// *The Quickhull Algorithm for Convex Hulls*).
const JOGGLES: [f32; 4] = [0.0, 1e-6, 1e-5, 1e-4];

/// A convex solid, given by its faces. Each face costs about ten instructions for eight points that touch the
/// hull, so a hull of a hundred faces is about as fast as a distance field. A shape with more faces should be
/// given as a mesh.
///
/// For an example, see [`collide`](crate::collide).
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    faces: Vec<Face>,
    /// Bounding sphere: center and radius [m].
    bounds: (Vec3, f32),
}

#[derive(Clone, Debug, PartialEq)]
struct Face {
    /// Outward unit normal.
    normal: Vec3,
    /// Offset of the plane along the normal [m].
    offset: f32,
    /// Triangles of the face, counter-clockwise seen from outside.
    triangles: Vec<[Vec3; 3]>,
}

impl Face {
    /// Returns the height of `p` above the face's plane [m].
    fn height(&self, p: Vec3) -> f32 {
        self.normal.dot(p) - self.offset
    }
}

impl Hull {
    /// Returns the smallest width across one of its faces [m]: that of a plate is its thickness.
    #[must_use]
    pub fn thickness(&self) -> f32 {
        let corners = || self.triangles().flatten();
        let depth = |face: &Face| corners().map(|p| -face.height(p)).fold(0.0, f32::max);
        self.faces.iter().map(depth).fold(f32::INFINITY, f32::min)
    }

    /// Creates the convex hull of points [m]. Returns `None` if they span no volume. Points that are not
    /// finite are ignored.
    pub fn new(points: &[Vec3]) -> Option<Self> {
        let points = || points.iter().filter(|p| p.is_finite());
        let lo = points().fold(Vec3::INFINITY, |lo, p| lo.min(*p));
        let hi = points().fold(Vec3::NEG_INFINITY, |hi, p| hi.max(*p));
        let (center, radius) = (lo.midpoint(hi), 0.5 * lo.distance(hi));
        if !(radius > 0.0 && radius.is_finite()) {
            return None;
        }
        // Normalize to the origin and unit radius, so that the tolerances do not depend on the scale.
        let unit: Vec<Vec3> = points().map(|p| (*p - center) / radius).collect();
        if thickness(&unit) < THIN {
            return None;
        }
        let mut hull = JOGGLES.iter().find_map(|size| {
            let hull = Self::of_unit(&joggled(&unit, *size))?;
            let holds = |p: &Vec3| hull.deepest(*p).0 < TOUCH + 2.0 * size;
            unit.iter().all(holds).then_some(hull)
        })?;
        for face in &mut hull.faces {
            face.triangles.iter_mut().flatten().for_each(|p| *p = *p * radius + center);
            face.offset = face.offset * radius + face.normal.dot(center);
        }
        Some(Self { bounds: (center, radius), ..hull })
    }

    /// Returns the triangles of its faces [m], counter-clockwise seen from outside.
    pub fn triangles(&self) -> impl Iterator<Item = [Vec3; 3]> {
        self.faces.iter().flat_map(|face| &face.triangles).copied()
    }

    /// Builds the hull of points around the origin with a radius of about 1.
    fn of_unit(points: &[Vec3]) -> Option<Self> {
        let points: Vec<_> = points.iter().map(|p| p.to_array().into()).collect();
        let (corners, triangles) = try_convex_hull(&points).ok()?;
        let corners: Vec<Vec3> = corners.iter().map(|p| Vec3::from(p.to_array())).collect();
        let mut hull = Self { faces: Vec::new(), bounds: (Vec3::ZERO, 1.0) };
        for triangle in triangles {
            let [a, b, c] = triangle.map(|i| corners[i as usize]);
            if let Some(normal) = (b - a).cross(c - a).try_normalize() {
                hull.add(normal, [a, b, c]);
            }
        }
        (hull.faces.len() >= 4).then_some(hull)
    }

    /// Adds a triangle, in units of the radius, to the face that it lies in.
    fn add(&mut self, normal: Vec3, triangle: [Vec3; 3]) {
        let lies_in = |f: &Face| {
            f.normal.dot(normal) > 0.0 && triangle.iter().all(|p| (f.normal.dot(*p) - f.offset).abs() < TOUCH)
        };
        // The plane is placed at the outermost corner of its triangle, so that no corner is outside.
        let offset = triangle.iter().fold(f32::MIN, |most, p| most.max(normal.dot(*p)));
        match self.faces.iter_mut().find(|f| lies_in(f)) {
            Some(face) => face.triangles.push(triangle),
            None => self.faces.push(Face { normal, offset, triangles: vec![triangle] }),
        }
    }

    /// Returns a bounding sphere: center and radius [m].
    pub(super) fn bounds(&self) -> (Vec3, f32) {
        self.bounds
    }

    /// Returns the planes of its faces: outward unit normal and offset along it [m]. Inside, the distance is
    /// the maximum of the distances to the planes.
    pub fn planes(&self) -> impl ExactSizeIterator<Item = (Vec3, f32)> + '_ {
        self.faces.iter().map(|f| (f.normal, f.offset))
    }

    /// Returns the distance [m], negative inside, and the outward unit normal at `p` [m].
    pub fn distance_and_normal(&self, p: Vec3) -> (f32, Vec3) {
        let depth = |f: &Face| f.normal.dot(p) - f.offset;
        let deepest = self
            .faces
            .iter()
            .fold((f32::MIN, Vec3::Y), |most, f| if depth(f) > most.0 { (depth(f), f.normal) } else { most });
        if deepest.0 <= TOUCH * self.bounds.1 {
            return deepest;
        }
        let visible = self.faces.iter().filter(|f| f.height(p) > 0.0).flat_map(|f| &f.triangles);
        let way = visible.fold(Vec3::INFINITY, |best, t| {
            let at = nearest_on_triangle(p, *t);
            let way = p - (t[0] * at.x + t[1] * at.y + t[2] * at.z);
            if way.length_squared() < best.length_squared() { way } else { best }
        });
        (way.length(), way.normalize_or(deepest.1))
    }

    /// Returns the maximum height of `p` above the planes of the faces [m], negative inside, and that plane's
    /// normal.
    fn deepest(&self, p: Vec3) -> (f32, Vec3) {
        let heights = self.faces.iter().map(|f| (f.height(p), f.normal));
        heights.fold((f32::MIN, Vec3::Y), |most, face| if face.0 > most.0 { face } else { most })
    }

    /// Returns which of eight segments are not entirely in front of any face. The segments end at `p` and
    /// have the edge vector `e`. The others are outside.
    #[inline(always)]
    pub(super) fn may_be_inside<S: Simd>(&self, simd: S, p: V3<S>, e: V3<S>) -> Mask<S> {
        let mut most = F::<S>::splat(simd, f32::MIN);
        for face in &self.faces {
            let n = V3::splat(simd, face.normal);
            most = most.max(n.dot(p) - n.dot(e).max(0.0) - face.offset);
            if !most.simd_le(0.0).any_true() {
                break;
            }
        }
        most.simd_le(0.0)
    }

    /// [`Hull::distance_and_normal`] for eight points.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub(super) fn distance_lanes<S: Simd>(&self, simd: S, p: V3<S>) -> (F<S>, V3<S>) {
        let (mut most, mut normal) = (F::<S>::splat(simd, f32::MIN), V3::zero(simd));
        for face in &self.faces {
            let n = V3::splat(simd, face.normal);
            let depth = n.dot(p) - face.offset;
            normal = V3::select(depth.simd_gt(most), n, normal);
            most = most.max(depth);
        }
        let outside = most.simd_gt(TOUCH * self.bounds.1);
        if !outside.any_true() {
            return (most, normal);
        }
        let (mut best, mut way) = (F::<S>::splat(simd, f32::MAX), normal);
        for face in &self.faces {
            let n = V3::splat(simd, face.normal);
            let height = n.dot(p) - face.offset;
            let visible = height.simd_gt(0.0);
            if visible.any_true() {
                for triangle in &face.triangles {
                    let to = from_triangle(simd, p, triangle, (n, height));
                    let size = to.dot(to);
                    let nearer = visible & size.simd_lt(best);
                    best = nearer.select(size, best);
                    way = V3::select(nearer, to, way);
                }
            }
        }
        let (distance, out) = way.length_and_unit();
        (outside.select(distance, most), V3::select(outside, out, normal))
    }
}

/// Returns the maximum distance of the points from a plane through three points that are far apart.
fn thickness(points: &[Vec3]) -> f32 {
    let farthest = |far: &dyn Fn(Vec3) -> f32| {
        points.iter().fold(points[0], |best, p| if far(*p) > far(best) { *p } else { best })
    };
    let a = farthest(&|p| p.distance_squared(points[0]));
    let b = farthest(&|p| p.distance_squared(a));
    let line = (b - a).normalize_or_zero();
    let c = farthest(&|p| line.cross(p - a).length_squared());
    let normal = (b - a).cross(c - a).normalize_or_zero();
    points.iter().fold(0.0, |most, p| most.max(normal.dot(*p - a).abs()))
}

/// Moves the points randomly by up to half of `size` along each axis, deterministically (xorshift, Marsaglia
/// 2003).
fn joggled(points: &[Vec3], size: f32) -> Vec<Vec3> {
    let mut state = 1u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1 << 24) as f32 - 0.5
    };
    points.iter().map(|p| *p + Vec3::new(next(), next(), next()) * size).collect()
}

/// Returns the vector from the nearest point of a triangle to each of eight points, which are at `height`
/// along its unit normal `n`.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn from_triangle<S: Simd>(simd: S, p: V3<S>, corners: &[Vec3; 3], (n, height): (V3<S>, F<S>)) -> V3<S> {
    let (mut best, mut way) = (F::<S>::splat(simd, f32::MAX), n * height);
    let mut over = F::<S>::splat(simd, f32::MIN);
    for k in 0..3 {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let edge = V3::splat(simd, b - a);
        let from = p - V3::splat(simd, a);
        // Distance past this edge within the plane. If it is positive for none of the three edges, the point
        // projects onto the triangle.
        let past = from.dot(edge.cross(n));
        over = over.max(past);
        let t = (from.dot(edge) * (1.0 / (b - a).length_squared().max(f32::MIN_POSITIVE))).max(0.0).min(1.0);
        let to = from - edge * t;
        let size = to.dot(to);
        let nearer = size.simd_lt(best);
        best = nearer.select(size, best);
        way = V3::select(nearer, to, way);
    }
    V3::select(over.simd_gt(0.0), way, n * height)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::ColliderShape;
    use glam::Mat3;

    fn corners(size: f32) -> Vec<Vec3> {
        (0..8)
            .map(|k| Vec3::new([-1.0, 1.0][k & 1], [-2.0, 2.0][k >> 1 & 1], [-3.0, 3.0][k >> 2]) * size)
            .collect()
    }

    #[test]
    fn the_hull_of_a_boxs_corners_is_the_box_at_any_scale() {
        for size in [1e-4, 0.05, 30.0] {
            let hull = Hull::new(&corners(size)).unwrap();
            assert_eq!(hull.faces.len(), 6, "{size}");
            let cuboid = ColliderShape::Cuboid {
                center: Vec3::ZERO,
                half: Vec3::new(1.0, 2.0, 3.0) * size,
                axes: Mat3::IDENTITY,
            };
            for k in 0..500 {
                let k = k as f32;
                let p = Vec3::new((1.3 * k).sin(), (2.1 * k).cos(), (0.7 * k).sin()) * (4.5 * size);
                let (distance, want) = (hull.distance_and_normal(p).0, cuboid.distance(p));
                assert!((distance - want).abs() < 1e-5 * size, "{distance} at {p}, the box {want}");
            }
        }
    }

    /// A cube of 9 × 9 × 9 points, stretched and rotated.
    fn turned_grid() -> Vec<Vec3> {
        let turn = Mat3::from_euler(glam::EulerRot::XYZ, 0.3, 0.8, 0.2);
        let at = |k: u32| Vec3::new((k % 9) as f32, (k / 9 % 9) as f32, (k / 81) as f32) / 8.0;
        (0..729).map(|k| turn * at(k) * Vec3::new(0.1, 0.2, 0.3)).collect()
    }

    #[test]
    fn a_hull_holds_its_points_however_they_lie() {
        let sets = (0..600).map(|set| joggled(&[Vec3::ONE; 640], 1.0)[set..6 + set % 30 + set].to_vec());
        // Points that are coplanar except for noise of various amplitudes.
        let noisy = (0..40).map(|k| joggled(&turned_grid(), 10f32.powf(-8.0 + 0.15 * k as f32)));
        for points in sets.chain(noisy) {
            let hull = Hull::new(&points).unwrap();
            let out = points.iter().map(|p| hull.deepest(*p).0).fold(f32::MIN, f32::max);
            assert!(
                out.abs() < 3e-4 * hull.bounds.1,
                "the farthest of {} points is {out} m out",
                points.len()
            );
        }
    }

    #[test]
    fn points_that_span_no_volume_have_no_hull() {
        let line: Vec<Vec3> = (0..9).map(|k| Vec3::new(k as f32, 2.0 * k as f32, 0.1)).collect();
        let flat: Vec<Vec3> = corners(0.1).iter().map(|p| p.with_y(0.3 * p.x + 1.0)).collect();
        for points in
            [vec![], vec![Vec3::ONE; 20], line, flat, vec![Vec3::NAN; 9], vec![Vec3::MAX, Vec3::MIN]]
        {
            assert!(Hull::new(&points).is_none(), "{points:?}");
        }
        // Points that are not finite are ignored; duplicates and interior points change nothing.
        let mut many = corners(0.1);
        many.extend(corners(0.1));
        many.extend([Vec3::NAN, Vec3::INFINITY, Vec3::ZERO, Vec3::splat(0.05)]);
        assert_eq!(Hull::new(&many).unwrap().faces.len(), 6);
    }
}
