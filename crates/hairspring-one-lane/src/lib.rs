//! The part of `fearless_simd` that Hairspring uses, with one lane at a time.
//!
//! `hairspring-scalar` is Hairspring's library built against this crate. It has the same source files and the
//! same memory layout with eight strands per tile, but every operation is on one number, and [`dispatch!`]
//! runs its code for one lane after another. The scalar fallback of fearless_simd writes out eight lanes
//! inside one function, which takes the compiler more than twenty minutes for our kernel.
//!
//! Products are not fused, and the maximum of two numbers is chosen as in SSE2, so results are bit-identical
//! to those of `sse2`. The compiler may still combine adjacent operations of one strand into one instruction,
//! as in any program.

use std::{
    marker::PhantomData,
    ops::{
        Add, AddAssign, BitAnd, BitAndAssign, BitOr, BitOrAssign, Div, Index, Mul, MulAssign, Neg, Not, Sub,
        SubAssign,
    },
};

/// The items of `use fearless_simd::prelude::*`.
pub mod prelude {
    pub use crate::Simd;
}

/// An instruction set: one lane of eight.
pub trait Simd: Copy {
    /// Index of the lane, 0 to 7.
    fn lane(self) -> usize;

    /// Runs `f` with the instructions of the set.
    #[inline(always)]
    fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
        f()
    }
}

/// The only available instruction set.
#[derive(Clone, Copy, Debug)]
pub struct Scalar(usize);

impl Scalar {
    /// Selects one of the eight lanes.
    pub fn of(lane: usize) -> Self {
        Self(lane)
    }
}

impl Simd for Scalar {
    #[inline(always)]
    fn lane(self) -> usize {
        // Always below eight, which removes bounds checks.
        self.0 & 7
    }
}

/// An unavailable instruction set.
#[derive(Clone, Copy, Debug)]
pub enum Absent {}

/// The instruction sets that can be requested.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "fearless_simd says what they are")]
pub enum Level {
    Scalar,
    Sse2(Absent),
    Avx2(Absent),
    Avx512(Absent),
}

#[expect(missing_docs, reason = "fearless_simd says what they are")]
#[expect(clippy::new_without_default, reason = "as there")]
impl Level {
    pub fn new() -> Self {
        Self::Scalar
    }

    pub fn as_sse2(self) -> Option<Absent> {
        None
    }

    pub fn as_avx2(self) -> Option<Absent> {
        None
    }

    pub fn as_avx512(self) -> Option<Absent> {
        None
    }
}

/// Runs a statement for each of the eight lanes.
#[macro_export]
macro_rules! dispatch {
    ($level:expr, $simd:pat => $statement:expr) => {{
        let _: $crate::Level = $level;
        for lane in 0..8 {
            let $simd = $crate::Scalar::of(lane);
            $statement
        }
    }};
}

/// One lane of eight numbers.
#[expect(non_camel_case_types, reason = "fearless_simd's name")]
#[derive(Clone, Copy, Debug)]
pub struct f32x8<S> {
    value: f32,
    /// The lane.
    pub simd: S,
}

/// Four numbers in memory order, not lanes.
#[expect(non_camel_case_types, reason = "fearless_simd's name")]
#[derive(Clone, Copy, Debug)]
pub struct f32x4<S> {
    values: [f32; 4],
    simd: S,
}

/// One lane of eight booleans.
#[expect(non_camel_case_types, reason = "fearless_simd's name")]
#[derive(Clone, Copy, Debug)]
pub struct mask32x8<S> {
    value: bool,
    simd: PhantomData<S>,
}

/// A value for one lane of eight numbers: the lane itself, or a number that is the same in all lanes.
pub trait Number<S> {
    /// Returns the number.
    fn number(self) -> f32;
}

impl<S> Number<S> for f32 {
    #[inline(always)]
    fn number(self) -> f32 {
        self
    }
}

impl<S> Number<S> for f32x8<S> {
    #[inline(always)]
    fn number(self) -> f32 {
        self.value
    }
}

#[expect(missing_docs, reason = "fearless_simd says what they do")]
impl<S: Simd> f32x8<S> {
    #[inline(always)]
    fn with(self, value: f32) -> Self {
        Self { value, ..self }
    }

    #[inline(always)]
    fn is(self, value: bool) -> mask32x8<S> {
        mask32x8 { value, simd: PhantomData }
    }

    #[inline(always)]
    pub fn splat(simd: S, value: f32) -> Self {
        Self { value, simd }
    }

    #[inline(always)]
    pub fn simd_from(simd: S, row: [f32; 8]) -> Self {
        Self { value: row[simd.lane()], simd }
    }

    #[inline(always)]
    pub fn from_slice(simd: S, row: &[f32]) -> Self {
        Self { value: row[simd.lane()], simd }
    }

    #[inline(always)]
    pub fn store_slice(self, row: &mut [f32]) {
        row[self.simd.lane()] = self.value;
    }

    #[inline(always)]
    pub fn mul_add(self, by: impl Number<S>, plus: impl Number<S>) -> Self {
        self.with(self.value * by.number() + plus.number())
    }

    #[inline(always)]
    pub fn mul_sub(self, by: impl Number<S>, minus: impl Number<S>) -> Self {
        self.with(self.value * by.number() - minus.number())
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.with(self.value.sqrt())
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        self.with(self.value.abs())
    }

    #[inline(always)]
    pub fn floor(self) -> Self {
        self.with(self.value.floor())
    }

    #[inline(always)]
    pub fn max(self, o: impl Number<S>) -> Self {
        let o = o.number();
        self.with(if self.value > o { self.value } else { o })
    }

    #[inline(always)]
    pub fn min(self, o: impl Number<S>) -> Self {
        let o = o.number();
        self.with(if self.value < o { self.value } else { o })
    }

    #[inline(always)]
    pub fn max_precise(self, o: impl Number<S>) -> Self {
        self.with(self.value.max(o.number()))
    }

    #[inline(always)]
    pub fn simd_gt(self, o: impl Number<S>) -> mask32x8<S> {
        self.is(self.value > o.number())
    }

    #[inline(always)]
    pub fn simd_lt(self, o: impl Number<S>) -> mask32x8<S> {
        self.is(self.value < o.number())
    }

    #[inline(always)]
    pub fn simd_ge(self, o: impl Number<S>) -> mask32x8<S> {
        self.is(self.value >= o.number())
    }

    #[inline(always)]
    pub fn simd_le(self, o: impl Number<S>) -> mask32x8<S> {
        self.is(self.value <= o.number())
    }

    #[inline(always)]
    pub fn simd_eq(self, o: impl Number<S>) -> mask32x8<S> {
        self.is(self.value == o.number())
    }
}

#[expect(missing_docs, reason = "fearless_simd says what they do")]
impl<S: Simd> f32x4<S> {
    #[inline(always)]
    pub fn from_slice(simd: S, four: &[f32]) -> Self {
        Self { values: [four[0], four[1], four[2], four[3]], simd }
    }

    #[inline(always)]
    pub fn zip_low(self, o: Self) -> Self {
        self.interleave(o).0
    }

    #[inline(always)]
    pub fn interleave(self, o: Self) -> (Self, Self) {
        let ([a, b, c, d], [e, f, g, h]) = (self.values, o.values);
        (Self { values: [a, e, b, f], ..self }, Self { values: [c, g, d, h], ..self })
    }

    #[inline(always)]
    pub fn combine(self, o: Self) -> f32x8<S> {
        let ([a, b, c, d], [e, f, g, h]) = (self.values, o.values);
        f32x8::simd_from(self.simd, [a, b, c, d, e, f, g, h])
    }
}

#[expect(missing_docs, reason = "fearless_simd says what they do")]
impl<S: Simd> mask32x8<S> {
    #[inline(always)]
    pub fn splat(_: S, value: bool) -> Self {
        Self { value, simd: PhantomData }
    }

    #[inline(always)]
    pub fn select(self, a: f32x8<S>, b: f32x8<S>) -> f32x8<S> {
        if self.value { a } else { b }
    }

    #[inline(always)]
    pub fn any_true(self) -> bool {
        self.value
    }
}

impl<S> Index<usize> for f32x8<S> {
    type Output = f32;

    /// The number, for any lane. Code that writes out all lanes stores this value for the others too, where
    /// it is not read.
    #[inline(always)]
    fn index(&self, _: usize) -> &f32 {
        &self.value
    }
}

macro_rules! operators {
    ($($trait:ident $name:ident, $($assign:ident $assign_name:ident)?;)*) => {$(
        impl<S: Simd, N: Number<S>> $trait<N> for f32x8<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, o: N) -> Self {
                self.with(self.value.$name(o.number()))
            }
        }

        impl<S: Simd> $trait<f32x8<S>> for f32 {
            type Output = f32x8<S>;

            #[inline(always)]
            fn $name(self, o: f32x8<S>) -> f32x8<S> {
                o.with(self.$name(o.value))
            }
        }

        $(impl<S: Simd, N: Number<S>> $assign<N> for f32x8<S> {
            #[inline(always)]
            fn $assign_name(&mut self, o: N) {
                self.value.$assign_name(o.number());
            }
        })?
    )*};
}

operators! {
    Add add, AddAssign add_assign;
    Sub sub, SubAssign sub_assign;
    Mul mul, MulAssign mul_assign;
    Div div,;
}

impl<S: Simd> Neg for f32x8<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.with(-self.value)
    }
}

macro_rules! logic {
    ($($trait:ident $name:ident, $assign:ident $assign_name:ident;)*) => {$(
        impl<S: Simd> $trait for mask32x8<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, o: Self) -> Self {
                Self { value: self.value.$name(o.value), ..self }
            }
        }

        impl<S: Simd> $assign for mask32x8<S> {
            #[inline(always)]
            fn $assign_name(&mut self, o: Self) {
                self.value.$assign_name(o.value);
            }
        }
    )*};
}

logic! {
    BitAnd bitand, BitAndAssign bitand_assign;
    BitOr bitor, BitOrAssign bitor_assign;
}

impl<S: Simd> Not for mask32x8<S> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self { value: !self.value, ..self }
    }
}
