//! Precision of the solve: eight strands at a time in single precision, or four at a time in double.
//!
//! The kernels are generic over a [`Simd`] token. [`Single`] holds the eight strands of a tile in one
//! `f32x8`. [`Double`] holds one half of the tile in one `f64x4`, and the tile is run once for each half.
//! State and rest shape stay in single precision in memory; the scratch memory of the solve has the precision
//! of the token. Stiff strands need `Double`: see [`Fiber::stiffest`](super::rest_shape::Fiber::stiffest).

use crate::simd::lanes::{Row, Work};
use fearless_simd::{f32x8, mask32x8};
#[cfg(not(one_lane))]
use fearless_simd::{f64x4, mask64x4, prelude::*};

/// SIMD arithmetic on some strands of a tile. All functions work lane by lane.
pub trait Simd: Copy {
    /// The instruction set.
    type Native: fearless_simd::Simd;
    /// One number for each strand.
    type Real: Copy;
    /// One boolean for each strand.
    type Mask: Copy;
    /// Relative error of one rounding: half a unit in the last place [1].
    const ROUNDING: f32;

    /// The instruction set's token.
    fn native(self) -> Self::Native;
    /// The same number for all strands.
    fn splat(self, value: f32) -> Self::Real;
    /// Loads the lanes of this token's strands from eight numbers.
    fn load(self, row: &[f32]) -> Self::Real;
    /// Stores the lanes of this token's strands in eight numbers.
    fn store(self, value: Self::Real, row: &mut [f32]);
    /// Reads a row of scratch memory.
    fn load_work(self, row: &Work) -> Self::Real;
    /// Writes a row of scratch memory.
    fn store_work(self, value: Self::Real, row: &mut Work);
    /// Converts to single precision. The lanes of the other strands repeat those of this token's.
    fn to_single(self, value: Self::Real) -> f32x8<Self::Native>;
    /// Converts from single precision.
    #[expect(clippy::wrong_self_convention, reason = "the token is the receiver of all conversions")]
    fn from_single(self, value: f32x8<Self::Native>) -> Self::Real;
    /// Converts from a mask of eight strands.
    fn mask_from_single(self, mask: mask32x8<Self::Native>) -> Self::Mask;
    /// Returns the number of one lane.
    fn lane(value: Self::Real, lane: usize) -> f32;

    /// a + b.
    fn add(a: Self::Real, b: Self::Real) -> Self::Real;
    /// a − b.
    fn sub(a: Self::Real, b: Self::Real) -> Self::Real;
    /// a · b.
    fn mul(a: Self::Real, b: Self::Real) -> Self::Real;
    /// a / b.
    fn div(a: Self::Real, b: Self::Real) -> Self::Real;
    /// −a.
    fn neg(a: Self::Real) -> Self::Real;
    /// a · b + c.
    fn mul_add(a: Self::Real, b: Self::Real, c: Self::Real) -> Self::Real;
    /// a · b − c.
    fn mul_sub(a: Self::Real, b: Self::Real, c: Self::Real) -> Self::Real;
    /// Square root.
    fn sqrt(a: Self::Real) -> Self::Real;
    /// Absolute value.
    fn abs(a: Self::Real) -> Self::Real;
    /// Largest integer that is at most a.
    fn floor(a: Self::Real) -> Self::Real;
    /// Maximum.
    fn max(a: Self::Real, b: Self::Real) -> Self::Real;
    /// Minimum.
    fn min(a: Self::Real, b: Self::Real) -> Self::Real;
    /// Maximum; if one operand is NaN, the other one.
    fn max_precise(a: Self::Real, b: Self::Real) -> Self::Real;

    /// a > b.
    fn gt(a: Self::Real, b: Self::Real) -> Self::Mask;
    /// a < b.
    fn lt(a: Self::Real, b: Self::Real) -> Self::Mask;
    /// a ≥ b.
    fn ge(a: Self::Real, b: Self::Real) -> Self::Mask;
    /// a ≤ b.
    fn le(a: Self::Real, b: Self::Real) -> Self::Mask;
    /// a = b.
    fn eq(a: Self::Real, b: Self::Real) -> Self::Mask;
    /// The same boolean for all strands.
    fn mask_splat(self, value: bool) -> Self::Mask;
    /// a where the mask is true, else b.
    fn select(mask: Self::Mask, a: Self::Real, b: Self::Real) -> Self::Real;
    /// Logical AND.
    fn and(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Logical OR.
    fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Logical NOT.
    fn not(a: Self::Mask) -> Self::Mask;
    /// Whether the mask is true for any strand.
    fn any_true(mask: Self::Mask) -> bool;

    /// Runs `f` compiled for the instruction set.
    #[inline(always)]
    fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
        fearless_simd::Simd::vectorize(self.native(), f)
    }

    /// The token of the whole tile in single precision.
    #[inline(always)]
    fn single(self) -> Single<Self::Native> {
        Single(self.native())
    }
}

/// Eight strands in single precision.
#[derive(Clone, Copy)]
pub struct Single<L>(pub L);

/// Four of a tile's eight strands in double precision.
#[cfg(not(one_lane))]
#[derive(Clone, Copy)]
pub struct Double<L> {
    /// The instruction set.
    pub native: L,
    /// Which half of the tile: 0 or 1.
    pub half: usize,
}

/// Definitions shared by both precisions.
macro_rules! lane_by_lane {
    ($real:ident, $mask:ident) => {
        type Native = L;
        type Real = $real<L>;
        type Mask = $mask<L>;

        #[inline(always)]
        fn add(a: Self::Real, b: Self::Real) -> Self::Real {
            a + b
        }

        #[inline(always)]
        fn sub(a: Self::Real, b: Self::Real) -> Self::Real {
            a - b
        }

        #[inline(always)]
        fn mul(a: Self::Real, b: Self::Real) -> Self::Real {
            a * b
        }

        #[inline(always)]
        fn div(a: Self::Real, b: Self::Real) -> Self::Real {
            a / b
        }

        #[inline(always)]
        fn neg(a: Self::Real) -> Self::Real {
            -a
        }

        #[inline(always)]
        fn mul_add(a: Self::Real, b: Self::Real, c: Self::Real) -> Self::Real {
            a.mul_add(b, c)
        }

        #[inline(always)]
        fn mul_sub(a: Self::Real, b: Self::Real, c: Self::Real) -> Self::Real {
            a.mul_sub(b, c)
        }

        #[inline(always)]
        fn sqrt(a: Self::Real) -> Self::Real {
            a.sqrt()
        }

        #[inline(always)]
        fn abs(a: Self::Real) -> Self::Real {
            a.abs()
        }

        #[inline(always)]
        fn floor(a: Self::Real) -> Self::Real {
            a.floor()
        }

        #[inline(always)]
        fn max(a: Self::Real, b: Self::Real) -> Self::Real {
            a.max(b)
        }

        #[inline(always)]
        fn min(a: Self::Real, b: Self::Real) -> Self::Real {
            a.min(b)
        }

        #[inline(always)]
        fn max_precise(a: Self::Real, b: Self::Real) -> Self::Real {
            a.max_precise(b)
        }

        #[inline(always)]
        fn gt(a: Self::Real, b: Self::Real) -> Self::Mask {
            a.simd_gt(b)
        }

        #[inline(always)]
        fn lt(a: Self::Real, b: Self::Real) -> Self::Mask {
            a.simd_lt(b)
        }

        #[inline(always)]
        fn ge(a: Self::Real, b: Self::Real) -> Self::Mask {
            a.simd_ge(b)
        }

        #[inline(always)]
        fn le(a: Self::Real, b: Self::Real) -> Self::Mask {
            a.simd_le(b)
        }

        #[inline(always)]
        fn eq(a: Self::Real, b: Self::Real) -> Self::Mask {
            a.simd_eq(b)
        }

        #[inline(always)]
        fn mask_splat(self, value: bool) -> Self::Mask {
            $mask::splat(self.native(), value)
        }

        #[inline(always)]
        fn select(mask: Self::Mask, a: Self::Real, b: Self::Real) -> Self::Real {
            mask.select(a, b)
        }

        #[inline(always)]
        fn and(a: Self::Mask, b: Self::Mask) -> Self::Mask {
            a & b
        }

        #[inline(always)]
        fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask {
            a | b
        }

        #[inline(always)]
        fn not(a: Self::Mask) -> Self::Mask {
            !a
        }

        #[inline(always)]
        fn any_true(mask: Self::Mask) -> bool {
            mask.any_true()
        }
    };
}

impl<L: fearless_simd::Simd> Simd for Single<L> {
    lane_by_lane!(f32x8, mask32x8);

    const ROUNDING: f32 = 0.5 * f32::EPSILON;

    #[inline(always)]
    fn native(self) -> L {
        self.0
    }

    #[inline(always)]
    fn splat(self, value: f32) -> f32x8<L> {
        f32x8::splat(self.0, value)
    }

    #[inline(always)]
    fn load(self, row: &[f32]) -> f32x8<L> {
        f32x8::from_slice(self.0, row)
    }

    #[inline(always)]
    fn store(self, value: f32x8<L>, row: &mut [f32]) {
        value.store_slice(row);
    }

    #[inline(always)]
    fn load_work(self, row: &Work) -> f32x8<L> {
        self.load(&bytemuck::cast_ref::<Work, Row>(row).0)
    }

    #[inline(always)]
    fn store_work(self, value: f32x8<L>, row: &mut Work) {
        self.store(value, &mut bytemuck::cast_mut::<Work, Row>(row).0);
    }

    #[inline(always)]
    fn to_single(self, value: f32x8<L>) -> f32x8<L> {
        value
    }

    #[inline(always)]
    fn from_single(self, value: f32x8<L>) -> f32x8<L> {
        value
    }

    #[inline(always)]
    fn mask_from_single(self, mask: mask32x8<L>) -> mask32x8<L> {
        mask
    }

    #[inline(always)]
    fn lane(value: f32x8<L>, lane: usize) -> f32 {
        value[lane]
    }
}

#[cfg(not(one_lane))]
impl<L: fearless_simd::Simd> Simd for Double<L> {
    lane_by_lane!(f64x4, mask64x4);

    const ROUNDING: f32 = (0.5 * f64::EPSILON) as f32;

    #[inline(always)]
    fn native(self) -> L {
        self.native
    }

    #[inline(always)]
    fn splat(self, value: f32) -> f64x4<L> {
        f64x4::splat(self.native, f64::from(value))
    }

    #[inline(always)]
    fn load(self, row: &[f32]) -> f64x4<L> {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| f64::from(row[4 * self.half + k]));
        f64x4::from_slice(self.native, &[a, b, c, d])
    }

    #[inline(always)]
    fn store(self, value: f64x4<L>, row: &mut [f32]) {
        for k in 0..4 {
            row[4 * self.half + k] = value[k] as f32;
        }
    }

    #[inline(always)]
    fn load_work(self, row: &Work) -> f64x4<L> {
        f64x4::from_slice(self.native, bytemuck::cast_ref::<Work, [f64; 4]>(row))
    }

    #[inline(always)]
    fn store_work(self, value: f64x4<L>, row: &mut Work) {
        value.store_slice(bytemuck::cast_mut::<Work, [f64; 4]>(row));
    }

    #[inline(always)]
    fn to_single(self, value: f64x4<L>) -> f32x8<L> {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| value[k] as f32);
        f32x8::from_slice(self.native, &[a, b, c, d, a, b, c, d])
    }

    #[inline(always)]
    fn from_single(self, value: f32x8<L>) -> f64x4<L> {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| f64::from(value[k]));
        f64x4::from_slice(self.native, &[a, b, c, d])
    }

    #[inline(always)]
    fn mask_from_single(self, mask: mask32x8<L>) -> mask64x4<L> {
        let (one, zero) = (f32x8::splat(self.native, 1.0), f32x8::splat(self.native, 0.0));
        Self::gt(self.from_single(mask.select(one, zero)), self.splat(0.5))
    }

    #[inline(always)]
    fn lane(value: f64x4<L>, lane: usize) -> f32 {
        value[lane % 4] as f32
    }
}
