//! Dispatch on instruction sets: kernels that are written once are compiled for each instruction set, and the
//! right one is chosen at run time.
//!
//! Compiling the kernels takes most of the build time. Builds that need not be fast have them for one instruction set
//! ([`only`]), and their longer functions are not inlined: builds without optimization (`unoptimized`, see `build.rs`), such
//! as an engine's first one, and the library's own unit tests. Tests outside the library check that the results agree on every instruction set.

/// Runs an expression with the instructions of `level`, in single precision; see
/// [`fearless_simd::dispatch!`].
#[cfg(not(all(any(test, unoptimized), target_arch = "x86_64")))]
macro_rules! dispatch {
    ($level:expr, $simd:pat => $op:expr) => {
        fearless_simd::dispatch!($level, native => {
            let $simd = crate::simd::lanes::Single(native);
            $op
        })
    };
}

/// Runs an expression in single precision, with the only instructions of this build.
#[cfg(all(any(test, unoptimized), target_arch = "x86_64"))]
macro_rules! dispatch {
    ($level:expr, $simd:pat => $op:expr) => {{
        let native = crate::simd::dispatch::only($level);
        crate::simd::dispatch::whole_tile!(native, $simd => $op)
    }};
}

/// Runs an expression in double precision, once for each half of a tile. Compiled for AVX2 and SSE2 only,
/// because AVX-512 offers no advantage for four numbers.
#[cfg(all(target_arch = "x86_64", not(one_lane), not(any(test, unoptimized))))]
macro_rules! dispatch_double {
    ($level:expr, $simd:pat => $op:expr) => {{
        let level: fearless_simd::Level = $level;
        if let Some(native) = level.as_avx2() {
            crate::simd::dispatch::both_halves!(native, $simd => $op);
        } else if let Some(native) = level.as_sse2() {
            crate::simd::dispatch::both_halves!(native, $simd => $op);
        }
    }};
}

/// Runs an expression in double precision, once for each half of a tile, with the only instructions of this build.
#[cfg(all(any(test, unoptimized), target_arch = "x86_64"))]
macro_rules! dispatch_double {
    ($level:expr, $simd:pat => $op:expr) => {{
        let native = crate::simd::dispatch::only($level);
        crate::simd::dispatch::both_halves!(native, $simd => $op);
    }};
}

/// Runs an expression for the integrators that exist for comparison, in double precision if `$double`. Compiled
/// for AVX2 and SSE2 only, to keep the build short.
#[cfg(all(target_arch = "x86_64", not(one_lane), not(any(test, unoptimized))))]
macro_rules! dispatch_comparison {
    ($level:expr, $double:expr, $simd:pat => $op:expr) => {{
        let level: fearless_simd::Level = $level;
        if $double {
            crate::simd::dispatch::dispatch_double!(level, $simd => $op);
        } else if let Some(native) = level.as_avx2() {
            crate::simd::dispatch::whole_tile!(native, $simd => $op);
        } else if let Some(native) = level.as_sse2() {
            crate::simd::dispatch::whole_tile!(native, $simd => $op);
        }
    }};
}

/// Runs an expression for the integrators that exist for comparison, on other processors and in builds for one
/// instruction set.
#[cfg(not(all(target_arch = "x86_64", not(one_lane), not(any(test, unoptimized)))))]
macro_rules! dispatch_comparison {
    ($level:expr, $double:expr, $simd:pat => $op:expr) => {{
        if $double {
            crate::simd::dispatch::dispatch_double!($level, $simd => $op);
        } else {
            crate::simd::dispatch::dispatch!($level, $simd => $op);
        }
    }};
}

/// Runs an expression with these instructions in single precision.
#[cfg(all(target_arch = "x86_64", not(one_lane)))]
macro_rules! whole_tile {
    ($native:ident, $simd:pat => $op:expr) => {{
        let $simd = crate::simd::lanes::Single($native);
        fearless_simd::Simd::vectorize(
            $native,
            #[inline(always)]
            || $op,
        )
    }};
}

/// Runs an expression with these instructions in double precision, once for each half of a tile.
#[cfg(all(target_arch = "x86_64", not(one_lane)))]
macro_rules! both_halves {
    ($native:ident, $simd:pat => $op:expr) => {
        fearless_simd::Simd::vectorize(
            $native,
            #[inline(always)]
            || {
                for half in 0..2 {
                    let $simd = crate::simd::precision::Double { native: $native, half };
                    $op
                }
            },
        )
    };
}

/// Runs an expression in double precision, once for each half of a tile.
#[cfg(all(not(target_arch = "x86_64"), not(one_lane)))]
macro_rules! dispatch_double {
    ($level:expr, $simd:pat => $op:expr) => {
        fearless_simd::dispatch!($level, native => {
            for half in 0..2 {
                let $simd = crate::simd::precision::Double { native, half };
                $op
            }
        })
    };
}

/// The build without SIMD has single precision only.
#[cfg(one_lane)]
macro_rules! dispatch_double {
    ($level:expr, $simd:pat => $op:expr) => {
        crate::simd::dispatch::dispatch!($level, $simd => $op)
    };
}

/// The instructions of a build for one instruction set, whatever the level: every processor has them.
#[cfg(all(any(test, unoptimized), target_arch = "x86_64"))]
pub(crate) fn only(level: fearless_simd::Level) -> fearless_simd::x86::Sse2 {
    level.as_sse2().expect("SSE2 is part of x86-64")
}

#[cfg(all(target_arch = "x86_64", not(one_lane)))]
pub(crate) use {both_halves, whole_tile};
pub(crate) use {dispatch, dispatch_comparison, dispatch_double};
