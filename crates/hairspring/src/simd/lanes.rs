//! SIMD arithmetic on the strands of a tile: vectors and small matrices whose numbers are SIMD registers with
//! one lane for each strand.
//!
//! A *row* is one number for each of eight strands, as stored in memory. `fearless_simd` selects the
//! instruction set at run time; the tile determines the precision (see `precision`). All functions are
//! inlined into the dispatched kernel.

pub use super::precision::{Simd, Single};
use fearless_simd::f32x8;
use glam::Mat3;
use std::ops::{
    Add, AddAssign, BitAnd, BitAndAssign, BitOr, BitOrAssign, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};

/// Strands in a tile: the lanes of an AVX2 register of `f32`.
pub const LANES: usize = 8;

/// One number of each of the tile's eight strands, in single precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(32))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Row(pub [f32; LANES]);

/// One number for each strand that is being solved, in the precision of the solve: eight `f32` or four `f64`.
/// Zero has the same bits in both.
#[derive(Clone, Copy, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(32))]
pub struct Work([u64; 4]);

/// Rows that [`load`] and [`store`] accept.
pub trait Stored {
    /// Loads the row into a register.
    fn load<S: Simd>(&self, simd: S) -> F<S>;
    /// Stores a register in the row.
    fn store<S: Simd>(&mut self, value: F<S>);
}

impl Stored for Row {
    #[inline(always)]
    fn load<S: Simd>(&self, simd: S) -> F<S> {
        F::from_slice(simd, &self.0)
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, value: F<S>) {
        value.store_slice(&mut self.0);
    }
}

impl Stored for Work {
    #[inline(always)]
    fn load<S: Simd>(&self, simd: S) -> F<S> {
        F { value: simd.load_work(self), simd }
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, value: F<S>) {
        value.simd.store_work(value.value, self);
    }
}

#[inline(always)]
pub fn load<S: Simd>(simd: S, row: &impl Stored) -> F<S> {
    row.load(simd)
}

#[inline(always)]
pub fn store<S: Simd>(value: F<S>, row: &mut impl Stored) {
    row.store(value);
}

/// A number for each strand, in a register.
#[derive(Clone, Copy)]
pub struct F<S: Simd> {
    value: S::Real,
    /// The SIMD token.
    pub simd: S,
}

/// A boolean for each strand.
#[derive(Clone, Copy)]
pub struct Mask<S: Simd>(S::Mask);

/// A number for each strand, or one number for all.
pub trait Number<S: Simd> {
    /// Returns the number in a register.
    fn number(self, simd: S) -> S::Real;
}

impl<S: Simd> Number<S> for f32 {
    #[inline(always)]
    fn number(self, simd: S) -> S::Real {
        simd.splat(self)
    }
}

impl<S: Simd> Number<S> for F<S> {
    #[inline(always)]
    fn number(self, _: S) -> S::Real {
        self.value
    }
}

impl<S: Simd> F<S> {
    #[inline(always)]
    pub fn splat(simd: S, value: f32) -> Self {
        Self { value: simd.splat(value), simd }
    }

    /// Loads the lanes of this token's strands from eight numbers.
    #[inline(always)]
    pub fn from_slice(simd: S, row: &[f32]) -> Self {
        Self { value: simd.load(row), simd }
    }

    /// Stores the lanes of this token's strands in eight numbers.
    #[inline(always)]
    pub fn store_slice(self, row: &mut [f32]) {
        self.simd.store(self.value, row);
    }

    /// Converts from a register of eight `f32`.
    #[inline(always)]
    pub fn from_native(simd: S, value: f32x8<S::Native>) -> Self {
        Self { value: simd.from_single(value), simd }
    }

    /// Converts to single precision.
    #[inline(always)]
    pub fn single(self) -> F<Single<S::Native>> {
        F { value: self.simd.to_single(self.value), simd: self.simd.single() }
    }

    /// Converts from single precision.
    #[inline(always)]
    pub fn from_single(simd: S, o: F<Single<S::Native>>) -> Self {
        Self::from_native(simd, o.value)
    }

    /// Returns the number of one lane.
    #[inline(always)]
    pub fn lane(self, lane: usize) -> f32 {
        S::lane(self.value, lane)
    }

    #[inline(always)]
    fn with(self, value: S::Real) -> Self {
        Self { value, ..self }
    }

    /// `self * by + plus`.
    #[inline(always)]
    pub fn mul_add(self, by: impl Number<S>, plus: impl Number<S>) -> Self {
        self.with(S::mul_add(self.value, by.number(self.simd), plus.number(self.simd)))
    }

    /// `self * by - minus`.
    #[inline(always)]
    pub fn mul_sub(self, by: impl Number<S>, minus: impl Number<S>) -> Self {
        self.with(S::mul_sub(self.value, by.number(self.simd), minus.number(self.simd)))
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.with(S::sqrt(self.value))
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        self.with(S::abs(self.value))
    }

    #[inline(always)]
    pub fn floor(self) -> Self {
        self.with(S::floor(self.value))
    }

    #[inline(always)]
    pub fn max(self, o: impl Number<S>) -> Self {
        self.with(S::max(self.value, o.number(self.simd)))
    }

    #[inline(always)]
    pub fn min(self, o: impl Number<S>) -> Self {
        self.with(S::min(self.value, o.number(self.simd)))
    }

    #[inline(always)]
    pub fn max_precise(self, o: impl Number<S>) -> Self {
        self.with(S::max_precise(self.value, o.number(self.simd)))
    }

    #[inline(always)]
    pub fn simd_gt(self, o: impl Number<S>) -> Mask<S> {
        Mask(S::gt(self.value, o.number(self.simd)))
    }

    #[inline(always)]
    pub fn simd_lt(self, o: impl Number<S>) -> Mask<S> {
        Mask(S::lt(self.value, o.number(self.simd)))
    }

    #[inline(always)]
    pub fn simd_ge(self, o: impl Number<S>) -> Mask<S> {
        Mask(S::ge(self.value, o.number(self.simd)))
    }

    #[inline(always)]
    pub fn simd_le(self, o: impl Number<S>) -> Mask<S> {
        Mask(S::le(self.value, o.number(self.simd)))
    }

    #[inline(always)]
    pub fn simd_eq(self, o: impl Number<S>) -> Mask<S> {
        Mask(S::eq(self.value, o.number(self.simd)))
    }
}

macro_rules! operators {
    ($($trait:ident $name:ident $($assign:ident $assign_name:ident)?;)*) => {$(
        impl<S: Simd, N: Number<S>> $trait<N> for F<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, o: N) -> Self {
                self.with(S::$name(self.value, o.number(self.simd)))
            }
        }

        impl<S: Simd> $trait<F<S>> for f32 {
            type Output = F<S>;

            #[inline(always)]
            fn $name(self, o: F<S>) -> F<S> {
                o.with(S::$name(o.simd.splat(self), o.value))
            }
        }

        $(impl<S: Simd, N: Number<S>> $assign<N> for F<S> {
            #[inline(always)]
            fn $assign_name(&mut self, o: N) {
                self.value = S::$name(self.value, o.number(self.simd));
            }
        })?
    )*};
}

operators! {
    Add add AddAssign add_assign;
    Sub sub SubAssign sub_assign;
    Mul mul MulAssign mul_assign;
    Div div;
}

impl<S: Simd> Neg for F<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.with(S::neg(self.value))
    }
}

impl<S: Simd> Mask<S> {
    #[inline(always)]
    pub fn splat(simd: S, value: bool) -> Self {
        Self(simd.mask_splat(value))
    }

    /// Converts from a mask of the whole tile.
    #[inline(always)]
    pub fn from_single(simd: S, mask: Mask<Single<S::Native>>) -> Self {
        Self(simd.mask_from_single(mask.0))
    }

    #[inline(always)]
    pub fn select(self, a: F<S>, b: F<S>) -> F<S> {
        a.with(S::select(self.0, a.value, b.value))
    }

    #[inline(always)]
    pub fn any_true(self) -> bool {
        S::any_true(self.0)
    }
}

impl<S: Simd> BitAnd for Mask<S> {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, o: Self) -> Self {
        Self(S::and(self.0, o.0))
    }
}

impl<S: Simd> BitAndAssign for Mask<S> {
    #[inline(always)]
    fn bitand_assign(&mut self, o: Self) {
        *self = *self & o;
    }
}

impl<S: Simd> BitOr for Mask<S> {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, o: Self) -> Self {
        Self(S::or(self.0, o.0))
    }
}

impl<S: Simd> BitOrAssign for Mask<S> {
    #[inline(always)]
    fn bitor_assign(&mut self, o: Self) {
        *self = *self | o;
    }
}

impl<S: Simd> Not for Mask<S> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(S::not(self.0))
    }
}

/// A 3-vector for each strand.
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

    /// Loads three consecutive rows.
    #[inline(always)]
    pub fn load(simd: S, rows: &[impl Stored]) -> Self {
        Self { x: load(simd, &rows[0]), y: load(simd, &rows[1]), z: load(simd, &rows[2]) }
    }

    #[inline(always)]
    pub fn store(self, rows: &mut [impl Stored]) {
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

    /// Converts to single precision.
    #[inline(always)]
    pub fn single(self) -> V3<Single<S::Native>> {
        V3 { x: self.x.single(), y: self.y.single(), z: self.z.single() }
    }

    /// Converts from single precision.
    #[inline(always)]
    pub fn from_single(simd: S, v: V3<Single<S::Native>>) -> Self {
        let [x, y, z] = [v.x, v.y, v.z].map(|v| F::from_single(simd, v));
        Self { x, y, z }
    }

    /// `self * s + o`.
    #[inline(always)]
    pub fn mul_add(self, s: F<S>, o: Self) -> Self {
        Self { x: self.x.mul_add(s, o.x), y: self.y.mul_add(s, o.y), z: self.z.mul_add(s, o.z) }
    }

    /// Returns the length and the unit vector; (tiny, zero) for a zero vector.
    #[inline(always)]
    pub fn length_and_unit(self) -> (F<S>, Self) {
        let length = self.dot(self).max(1e-30).sqrt();
        (length, self * (F::splat(length.simd, 1.0) / length))
    }

    #[inline(always)]
    pub fn is_not_zero(self) -> Mask<S> {
        self.dot(self).simd_gt(0.0)
    }

    #[inline(always)]
    pub fn select(mask: Mask<S>, a: Self, b: Self) -> Self {
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

/// A rotation for each strand: a unit quaternion (x, y, z, w).
#[derive(Clone, Copy)]
pub struct Q4<S: Simd> {
    v: V3<S>,
    w: F<S>,
}

impl<S: Simd> Q4<S> {
    /// Loads four consecutive rows: x, y, z, w.
    #[inline(always)]
    pub fn load(simd: S, rows: &[impl Stored]) -> Self {
        Self { v: V3::load(simd, rows), w: load(simd, &rows[3]) }
    }

    /// Interpolates linearly from `self` (`t` = 0) to `o` (`t` = 1) and normalizes. The two must lie in the
    /// same hemisphere.
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

/// A symmetric 3×3 matrix for each strand.
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

/// A 3×3 matrix for each strand, stored by rows.
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

/// Multiplies one matrix, the same for all lanes, by a vector in each lane.
#[inline(always)]
pub fn transform<S: Simd>(simd: S, m: &Mat3, v: V3<S>) -> V3<S> {
    V3::splat(simd, m.x_axis) * v.x + V3::splat(simd, m.y_axis) * v.y + V3::splat(simd, m.z_axis) * v.z
}
