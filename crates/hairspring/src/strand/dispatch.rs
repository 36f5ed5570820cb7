//! Where code that is written once for all instruction sets is compiled for each of them, and the one is chosen that runs.

/// Runs an expression with the instructions of a level, as [`fearless_simd::dispatch!`].
///
/// In the library's own unit tests with those of AVX2, whatever the level: the kernels are most of what there is to compile, and a test of what they compute
/// needs them once. That they compute the same on every instruction set is tested from outside of the library.
#[cfg(all(test, target_arch = "x86_64"))]
macro_rules! dispatch {
    ($level:expr, $simd:pat => $op:expr) => {{
        let level: fearless_simd::Level = $level;
        let avx2 =
            level.as_avx2().expect("a processor with AVX2, which the library's unit tests are compiled for");
        let $simd = avx2;
        fearless_simd::Simd::vectorize(
            avx2,
            #[inline(always)]
            || $op,
        )
    }};
}

#[cfg(all(test, target_arch = "x86_64"))]
pub(crate) use dispatch;
#[cfg(not(all(test, target_arch = "x86_64")))]
pub(crate) use fearless_simd::dispatch;
