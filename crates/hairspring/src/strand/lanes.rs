//! Eight strands at once: vectors and small matrices whose every number is a SIMD register of eight lanes.
//!
//! A *row* is one number of eight strands, as it lies in memory. The instruction set is chosen at run time by
//! `fearless_simd`; everything here is inlined into the kernel that was dispatched.

use fearless_simd::{f32x8, prelude::*};
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// Strands in a tile: the lanes of an AVX2 register of `f32`.
pub const LANES: usize = 8;

/// One number of each of the tile's eight strands.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(32))]
pub struct Row(pub [f32; LANES]);

/// Eight numbers in a register.
pub type F<S> = f32x8<S>;

#[inline(always)]
pub fn load<S: Simd>(simd: S, row: &Row) -> F<S> {
    F::simd_from(simd, row.0)
}

#[inline(always)]
pub fn store<S: Simd>(value: F<S>, row: &mut Row) {
    value.store_slice(&mut row.0);
}

/// A 3-vector of each strand.
#[derive(Clone, Copy)]
pub struct V3<S: Simd> {
    pub x: F<S>,
    pub y: F<S>,
    pub z: F<S>,
}

impl<S: Simd> V3<S> {
    #[inline(always)]
    pub fn splat(simd: S, v: glam::Vec3) -> Self {
        Self { x: F::splat(simd, v.x), y: F::splat(simd, v.y), z: F::splat(simd, v.z) }
    }

    #[inline(always)]
    pub fn zero(simd: S) -> Self {
        Self::splat(simd, glam::Vec3::ZERO)
    }

    /// Three rows that follow each other.
    #[inline(always)]
    pub fn load(simd: S, rows: &[Row]) -> Self {
        Self { x: load(simd, &rows[0]), y: load(simd, &rows[1]), z: load(simd, &rows[2]) }
    }

    #[inline(always)]
    pub fn store(self, rows: &mut [Row]) {
        store(self.x, &mut rows[0]);
        store(self.y, &mut rows[1]);
        store(self.z, &mut rows[2]);
    }

    #[inline(always)]
    pub fn dot(self, o: Self) -> F<S> {
        self.x.mul_add(o.x, self.y.mul_add(o.y, self.z * o.z))
    }

    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        Self {
            x: self.y.mul_sub(o.z, self.z * o.y),
            y: self.z.mul_sub(o.x, self.x * o.z),
            z: self.x.mul_sub(o.y, self.y * o.x),
        }
    }

    /// `self * s + o`.
    #[inline(always)]
    pub fn mul_add(self, s: F<S>, o: Self) -> Self {
        Self { x: self.x.mul_add(s, o.x), y: self.y.mul_add(s, o.y), z: self.z.mul_add(s, o.z) }
    }

    /// Length, and the unit vector; (tiny, zero) for a zero vector.
    #[inline(always)]
    pub fn length_and_unit(self) -> (F<S>, Self) {
        let length = self.dot(self).max(1e-30).sqrt();
        (length, self * (F::splat(length.simd, 1.0) / length))
    }

    #[inline(always)]
    pub fn select(mask: fearless_simd::mask32x8<S>, a: Self, b: Self) -> Self {
        Self { x: mask.select(a.x, b.x), y: mask.select(a.y, b.y), z: mask.select(a.z, b.z) }
    }
}

impl<S: Simd> Add for V3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { x: self.x + o.x, y: self.y + o.y, z: self.z + o.z }
    }
}

impl<S: Simd> Sub for V3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { x: self.x - o.x, y: self.y - o.y, z: self.z - o.z }
    }
}

impl<S: Simd> AddAssign for V3<S> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<S: Simd> SubAssign for V3<S> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl<S: Simd> Neg for V3<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z }
    }
}

impl<S: Simd> Mul<F<S>> for V3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: F<S>) -> Self {
        Self { x: self.x * s, y: self.y * s, z: self.z * s }
    }
}

/// A rotation of each strand, a unit quaternion (x, y, z, w).
#[derive(Clone, Copy)]
pub struct Q4<S: Simd> {
    v: V3<S>,
    w: F<S>,
}

impl<S: Simd> Q4<S> {
    /// Four rows that follow each other: x, y, z, w.
    #[inline(always)]
    pub fn load(simd: S, rows: &[Row]) -> Self {
        Self { v: V3::load(simd, rows), w: load(simd, &rows[3]) }
    }

    /// Between `self` (`t` = 0) and `o` (`t` = 1) on the chord, normalised. `o` must lie on the near side.
    #[inline(always)]
    pub fn nlerp(self, o: Self, t: F<S>) -> Self {
        let v = (o.v - self.v).mul_add(t, self.v);
        let w = (o.w - self.w).mul_add(t, self.w);
        let inv = F::splat(w.simd, 1.0) / v.dot(v).mul_add(1.0, w * w).max(1e-30).sqrt();
        Self { v: v * inv, w: w * inv }
    }

    #[inline(always)]
    pub fn rotate(self, p: V3<S>) -> V3<S> {
        // p + 2w(v×p) + 2v×(v×p)
        let t = self.v.cross(p);
        let t = t + t;
        self.v.cross(t) + t.mul_add(self.w, p)
    }
}

/// A symmetric 3×3 matrix of each strand.
#[derive(Clone, Copy)]
pub struct Sym3<S: Simd> {
    pub xx: F<S>,
    pub xy: F<S>,
    pub xz: F<S>,
    pub yy: F<S>,
    pub yz: F<S>,
    pub zz: F<S>,
}

impl<S: Simd> Sym3<S> {
    /// `s` times the identity.
    #[inline(always)]
    pub fn scaled_identity(s: F<S>) -> Self {
        let o = F::splat(s.simd, 0.0);
        Self { xx: s, xy: o, xz: o, yy: s, yz: o, zz: s }
    }

    /// `s` u uᵀ.
    #[inline(always)]
    pub fn outer(u: V3<S>, s: F<S>) -> Self {
        let v = u * s;
        Self { xx: u.x * v.x, xy: u.x * v.y, xz: u.x * v.z, yy: u.y * v.y, yz: u.y * v.z, zz: u.z * v.z }
    }

    #[inline(always)]
    pub fn add_identity(self, s: F<S>) -> Self {
        Self { xx: self.xx + s, yy: self.yy + s, zz: self.zz + s, ..self }
    }

    /// The full matrix.
    #[inline(always)]
    pub fn full(self) -> M3<S> {
        M3 {
            rows: [
                V3 { x: self.xx, y: self.xy, z: self.xz },
                V3 { x: self.xy, y: self.yy, z: self.yz },
                V3 { x: self.xz, y: self.yz, z: self.zz },
            ],
        }
    }

    /// `self` − Aᵀ B, where the product is known to be symmetric.
    #[inline(always)]
    pub fn minus_transposed_product(self, a: &M3<S>, b: &M3<S>) -> Self {
        let [a0, a1, a2] = a.rows;
        let [b0, b1, b2] = b.rows;
        Self {
            xx: minus_products(self.xx, [(a0.x, b0.x), (a1.x, b1.x), (a2.x, b2.x)]),
            xy: minus_products(self.xy, [(a0.x, b0.y), (a1.x, b1.y), (a2.x, b2.y)]),
            xz: minus_products(self.xz, [(a0.x, b0.z), (a1.x, b1.z), (a2.x, b2.z)]),
            yy: minus_products(self.yy, [(a0.y, b0.y), (a1.y, b1.y), (a2.y, b2.y)]),
            yz: minus_products(self.yz, [(a0.y, b0.z), (a1.y, b1.z), (a2.y, b2.z)]),
            zz: minus_products(self.zz, [(a0.z, b0.z), (a1.z, b1.z), (a2.z, b2.z)]),
        }
    }

    /// The inverse of a positive definite matrix, by cofactors.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        let Self { xx, xy, xz, yy, yz, zz } = self;
        let cxx = yy.mul_sub(zz, yz * yz);
        let cxy = xz.mul_sub(yz, xy * zz);
        let cxz = xy.mul_sub(yz, xz * yy);
        let det = xx.mul_add(cxx, xy.mul_add(cxy, xz * cxz));
        let inv = F::splat(xx.simd, 1.0) / det;
        Self {
            xx: cxx * inv,
            xy: cxy * inv,
            xz: cxz * inv,
            yy: xx.mul_sub(zz, xz * xz) * inv,
            yz: xy.mul_sub(xz, xx * yz) * inv,
            zz: xx.mul_sub(yy, xy * xy) * inv,
        }
    }

    #[inline(always)]
    pub fn mul_vec(self, v: V3<S>) -> V3<S> {
        V3 {
            x: self.xx.mul_add(v.x, self.xy.mul_add(v.y, self.xz * v.z)),
            y: self.xy.mul_add(v.x, self.yy.mul_add(v.y, self.yz * v.z)),
            z: self.xz.mul_add(v.x, self.yz.mul_add(v.y, self.zz * v.z)),
        }
    }

    /// `self` B.
    #[inline(always)]
    pub fn mul_mat(self, b: &M3<S>) -> M3<S> {
        M3 {
            rows: [
                combine(b, V3::zero(self.xx.simd), [self.xx, self.xy, self.xz]),
                combine(b, V3::zero(self.xx.simd), [self.xy, self.yy, self.yz]),
                combine(b, V3::zero(self.xx.simd), [self.xz, self.yz, self.zz]),
            ],
        }
    }
}

impl<S: Simd> Mul<F<S>> for Sym3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: F<S>) -> Self {
        Self {
            xx: self.xx * s,
            xy: self.xy * s,
            xz: self.xz * s,
            yy: self.yy * s,
            yz: self.yz * s,
            zz: self.zz * s,
        }
    }
}

impl<S: Simd> Add for Sym3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self {
            xx: self.xx + o.xx,
            xy: self.xy + o.xy,
            xz: self.xz + o.xz,
            yy: self.yy + o.yy,
            yz: self.yz + o.yz,
            zz: self.zz + o.zz,
        }
    }
}

/// A 3×3 matrix of each strand, by rows.
#[derive(Clone, Copy)]
pub struct M3<S: Simd> {
    pub rows: [V3<S>; 3],
}

impl<S: Simd> M3<S> {
    #[inline(always)]
    pub fn zero(simd: S) -> Self {
        M3 { rows: [V3::zero(simd); 3] }
    }

    /// Nine rows that follow each other.
    #[inline(always)]
    pub fn load(simd: S, rows: &[Row]) -> Self {
        M3 { rows: [V3::load(simd, &rows[0..3]), V3::load(simd, &rows[3..6]), V3::load(simd, &rows[6..9])] }
    }

    #[inline(always)]
    pub fn store(self, rows: &mut [Row]) {
        self.rows[0].store(&mut rows[0..3]);
        self.rows[1].store(&mut rows[3..6]);
        self.rows[2].store(&mut rows[6..9]);
    }

    #[inline(always)]
    pub fn mul_vec(&self, v: V3<S>) -> V3<S> {
        V3 { x: self.rows[0].dot(v), y: self.rows[1].dot(v), z: self.rows[2].dot(v) }
    }

    /// `o` − selfᵀ v.
    #[inline(always)]
    pub fn transposed_mul_sub_from(&self, v: V3<S>, o: V3<S>) -> V3<S> {
        let [a, b, c] = self.rows;
        a.mul_add(-v.x, b.mul_add(-v.y, c.mul_add(-v.z, o)))
    }

    /// `self` − Aᵀ B.
    #[inline(always)]
    pub fn minus_transposed_product(self, a: &M3<S>, b: &M3<S>) -> Self {
        let [a0, a1, a2] = a.rows;
        M3 {
            rows: [
                combine(b, self.rows[0], [-a0.x, -a1.x, -a2.x]),
                combine(b, self.rows[1], [-a0.y, -a1.y, -a2.y]),
                combine(b, self.rows[2], [-a0.z, -a1.z, -a2.z]),
            ],
        }
    }
}

impl<S: Simd> Sub<Sym3<S>> for M3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Sym3<S>) -> Self {
        let o = o.full().rows;
        M3 { rows: [self.rows[0] - o[0], self.rows[1] - o[1], self.rows[2] - o[2]] }
    }
}

impl<S: Simd> Sub for M3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        M3 { rows: [self.rows[0] - o.rows[0], self.rows[1] - o.rows[1], self.rows[2] - o.rows[2]] }
    }
}

// Functions, not closures, wherever lanes are computed: a closure is not always inlined into the dispatched kernel, and
// then every operation is a call.

/// `s` − Σ pairs' products.
#[inline(always)]
fn minus_products<S: Simd>(s: F<S>, p: [(F<S>, F<S>); 3]) -> F<S> {
    let s = (-p[0].0).mul_add(p[0].1, s);
    let s = (-p[1].0).mul_add(p[1].1, s);
    (-p[2].0).mul_add(p[2].1, s)
}

/// `r` + Σ c_k times row k of `b`.
#[inline(always)]
fn combine<S: Simd>(b: &M3<S>, r: V3<S>, c: [F<S>; 3]) -> V3<S> {
    b.rows[0].mul_add(c[0], b.rows[1].mul_add(c[1], b.rows[2].mul_add(c[2], r)))
}
