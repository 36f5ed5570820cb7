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
    F::from_slice(simd, &row.0)
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
    /// Six rows that follow each other: xx, xy, xz, yy, yz, zz.
    #[inline(always)]
    pub fn load(simd: S, rows: &[Row; 6]) -> Self {
        let [xx, xy, xz, yy, yz, zz] = rows.each_ref().map(|row| load(simd, row));
        Self { xx, xy, xz, yy, yz, zz }
    }

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

    /// `self * s + o`.
    #[inline(always)]
    pub fn mul_add(self, s: F<S>, o: Self) -> Self {
        Self {
            xx: self.xx.mul_add(s, o.xx),
            xy: self.xy.mul_add(s, o.xy),
            xz: self.xz.mul_add(s, o.xz),
            yy: self.yy.mul_add(s, o.yy),
            yz: self.yz.mul_add(s, o.yz),
            zz: self.zz.mul_add(s, o.zz),
        }
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

impl<S: Simd> Mul<V3<S>> for Sym3<S> {
    type Output = V3<S>;
    #[inline(always)]
    fn mul(self, v: V3<S>) -> V3<S> {
        let M3 { rows } = self.full();
        V3 { x: rows[0].dot(v), y: rows[1].dot(v), z: rows[2].dot(v) }
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

impl<S: Simd> Sub for Sym3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self {
            xx: self.xx - o.xx,
            xy: self.xy - o.xy,
            xz: self.xz - o.xz,
            yy: self.yy - o.yy,
            yz: self.yz - o.yz,
            zz: self.zz - o.zz,
        }
    }
}

/// A 3×3 matrix of each strand, by rows.
#[derive(Clone, Copy)]
pub struct M3<S: Simd> {
    pub rows: [V3<S>; 3],
}

impl<S: Simd> M3<S> {
    /// `self` + selfᵀ.
    #[inline(always)]
    pub fn plus_transposed(&self) -> Sym3<S> {
        let [a, b, c] = self.rows;
        Sym3 { xx: a.x + a.x, xy: a.y + b.x, xz: a.z + c.x, yy: b.y + b.y, yz: b.z + c.y, zz: c.z + c.z }
    }
}

impl<S: Simd> Add for M3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        M3 { rows: [self.rows[0] + o.rows[0], self.rows[1] + o.rows[1], self.rows[2] + o.rows[2]] }
    }
}

impl<S: Simd> Sub for M3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        M3 { rows: [self.rows[0] - o.rows[0], self.rows[1] - o.rows[1], self.rows[2] - o.rows[2]] }
    }
}

impl<S: Simd> Neg for M3<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        M3 { rows: [-self.rows[0], -self.rows[1], -self.rows[2]] }
    }
}
