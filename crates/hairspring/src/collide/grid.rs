//! A signed distance field on a regular grid.

use crate::strand::lanes::{F, LANES, Row, V3, load};
use fearless_simd::prelude::*;
use glam::{UVec3, Vec3};

/// Signed distances at the nodes of a regular grid, negative inside; trilinear between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grid {
    /// Position of node (0, 0, 0) [m].
    pub origin: Vec3,
    /// Distance between neighbouring nodes [m].
    pub cell: f32,
    /// Nodes along each axis, each 2 or more.
    pub size: UVec3,
    /// Distance at each node [m], x fastest; shape `[size.z][size.y][size.x]`.
    pub distances: Vec<f32>,
    /// How far the nearest surface moved during the last interval, in the field's space [m]; the shape of `distances`,
    /// or empty: the surface is rigid.
    pub displacements: Vec<Vec3>,
}

impl Grid {
    /// Whether the surface moved in the field's own space.
    pub fn deforms(&self) -> bool {
        !self.displacements.is_empty()
    }

    /// The ball around the whole grid, outside of which nothing is inside: its middle and radius [m].
    pub fn bounds(&self) -> (Vec3, f32) {
        let half = (self.size - UVec3::ONE).as_vec3() * (0.5 * self.cell);
        (self.origin + half, half.length())
    }

    /// Distance [m] and outward unit normal at `p` [m]; outside the grid, the distance to the grid is added.
    pub fn distance_and_normal(&self, p: Vec3) -> (f32, Vec3) {
        let top = (self.size - UVec3::ONE).as_vec3();
        let g = (p - self.origin) / self.cell;
        // `max` first: a NaN becomes 0.
        let c = g.max(Vec3::ZERO).min(top - Vec3::splat(1e-3));
        let (c00, fx, fy, fz) = (self.corners(c), c.x.fract(), c.y.fract(), c.z.fract());
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let x = [0, 2, 4, 6].map(|k| mix(c00[k], c00[k + 1], fx));
        let y = [mix(x[0], x[1], fy), mix(x[2], x[3], fy)];
        let gx =
            mix(mix(c00[1] - c00[0], c00[3] - c00[2], fy), mix(c00[5] - c00[4], c00[7] - c00[6], fy), fz);
        let gradient = Vec3::new(gx, mix(x[1] - x[0], x[3] - x[2], fz), y[1] - y[0]);
        (mix(y[0], y[1], fz) + (g - c).length() * self.cell, gradient.normalize_or(Vec3::Y))
    }

    /// How far the surface nearest to `p` [m] moved in the last interval [m]; 0 for a rigid one.
    pub fn displacement(&self, p: Vec3) -> Vec3 {
        let top = (self.size - UVec3::ONE).as_vec3();
        let c = ((p - self.origin) / self.cell).max(Vec3::ZERO).min(top);
        self.displacements.get(self.index(c.round().as_uvec3())).copied().unwrap_or_default()
    }

    fn index(&self, at: UVec3) -> usize {
        ((at.z * self.size.y + at.y) * self.size.x + at.x) as usize
    }

    /// The eight distances around grid position `c` (inside the grid): x fastest, then y, then z.
    #[inline(always)]
    fn corners(&self, c: Vec3) -> [f32; 8] {
        let i = self.index(c.as_uvec3());
        let (dy, dz) = (self.size.x as usize, (self.size.x * self.size.y) as usize);
        let d = &self.distances[i..i + dz + dy + 2];
        [d[0], d[1], d[dy], d[dy + 1], d[dz], d[dz + 1], d[dz + dy], d[dz + dy + 1]]
    }

    /// [`Grid::distance_and_normal`] of eight points.
    #[inline(always)]
    pub(crate) fn distance_lanes<S: Simd>(&self, simd: S, p: V3<S>) -> (F<S>, V3<S>) {
        let top = (self.size - UVec3::ONE).as_vec3() - Vec3::splat(1e-3);
        let g = (p - V3::splat(simd, self.origin)) * F::splat(simd, 1.0 / self.cell);
        let c = V3 {
            x: g.x.max_precise(0.0).min(top.x),
            y: g.y.max_precise(0.0).min(top.y),
            z: g.z.max_precise(0.0).min(top.z),
        };
        let mut k = [Row::default(); 8];
        for lane in 0..LANES {
            let corners = self.corners(Vec3::new(c.x[lane], c.y[lane], c.z[lane]));
            for (row, corner) in k.iter_mut().zip(corners) {
                row.0[lane] = corner;
            }
        }
        let [k0, k1, k2, k3, k4, k5, k6, k7] = k;
        let k = [
            load(simd, &k0),
            load(simd, &k1),
            load(simd, &k2),
            load(simd, &k3),
            load(simd, &k4),
            load(simd, &k5),
            load(simd, &k6),
            load(simd, &k7),
        ];
        let (fx, fy, fz) = (c.x - c.x.floor(), c.y - c.y.floor(), c.z - c.z.floor());
        let x = [mix(k[0], k[1], fx), mix(k[2], k[3], fx), mix(k[4], k[5], fx), mix(k[6], k[7], fx)];
        let y = [mix(x[0], x[1], fy), mix(x[2], x[3], fy)];
        let gradient = V3 {
            x: mix(mix(k[1] - k[0], k[3] - k[2], fy), mix(k[5] - k[4], k[7] - k[6], fy), fz),
            y: mix(x[1] - x[0], x[3] - x[2], fz),
            z: y[1] - y[0],
        };
        let out = g - c;
        let beyond = out.dot(out).sqrt() * self.cell;
        (mix(y[0], y[1], fz) + beyond, gradient.length_and_unit().1)
    }
}

/// `a` at `t` = 0, `b` at 1.
#[inline(always)]
fn mix<S: Simd>(a: F<S>, b: F<S>, t: F<S>) -> F<S> {
    (b - a).mul_add(t, a)
}
