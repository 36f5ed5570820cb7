//! The banded direct solver: LDLᵀ without pivoting, blocks of `B` unknowns a point, one sweep down, one up.
//!
//! ```text
//!          point i   i+1  i+2           a window of N = B (half-bandwidth + 1) unknowns, upper triangle
//!   i    [ D  U  U ]                    eliminating point i:
//!   i+1  [    D  U ]                      l = u / d,   A −= l uᵀ,   b −= l b_i
//!   i+2  [       D ]                    for each of its B unknowns
//! ```
//!
//! Right-looking, so that the rows below the one being eliminated can still be assembled while it goes: the matrix
//! is never stored, only the factors `l` and `y = b / d`. By single unknowns rather than by inverted blocks: it is a
//! third fewer operations, because all of the symmetry is used. Golub & Van Loan, *Matrix Computations*, 4th ed., §4.1.2, §4.3.5.

use super::lanes::{F, M3, Row, Sym3, V3, load, store};
use fearless_simd::{mask32x8, prelude::*};

/// `body` once for each index below 12, the widest window: loops over constants that must not stay loops, so that the
/// window's entries are registers (the compiler unrolls no nest of this size).
macro_rules! each {
    ($i:ident, $body:block) => {
        each!(@ $i, $body, 0 1 2 3 4 5 6 7 8 9 10 11)
    };
    (@ $i:ident, $body:block, $($k:literal)*) => {
        $({
            let $i: usize = $k;
            $body
        })*
    };
}

/// Rows of factors that [`Band::eliminate`] writes for a point.
pub const fn factor_rows(block: usize, window: usize) -> usize {
    // Row r of the block keeps its l of the N − 1 − r unknowns after it, and y.
    block * window - block * (block - 1) / 2
}

/// The part of the matrix that is being worked on, of eight strands: the unknowns of a point and of the half-bandwidth
/// after it, `N` in all, `B` a point of which the first three are its displacement.
pub struct Band<S: Simd, const B: usize, const N: usize> {
    /// Entry (r, c) for c ≥ r.
    a: [[F<S>; N]; N],
    /// Right-hand side.
    b: [F<S>; N],
}

impl<S: Simd, const B: usize, const N: usize> Band<S, B, N> {
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        let zero = F::<S>::splat(simd, 0.0);
        Self { a: [[zero; N]; N], b: [zero; N] }
    }

    /// Adds to one entry: unknown `j` of point `p` of the window with unknown `k` of point `q`, in the upper triangle.
    #[inline(always)]
    pub fn add(&mut self, (p, j): (usize, usize), (q, k): (usize, usize), value: F<S>) {
        self.a[p * B + j][q * B + k] += value;
    }

    /// Adds a symmetric block to the displacement of point `p`.
    #[inline(always)]
    pub fn add_diagonal(&mut self, p: usize, m: Sym3<S>) {
        let o = p * B;
        self.a[o][o] += m.xx;
        self.a[o][o + 1] += m.xy;
        self.a[o][o + 2] += m.xz;
        self.a[o + 1][o + 1] += m.yy;
        self.a[o + 1][o + 2] += m.yz;
        self.a[o + 2][o + 2] += m.zz;
    }

    /// Adds `s` times the identity to the displacement of point `p`.
    #[inline(always)]
    pub fn add_identity(&mut self, p: usize, s: F<S>) {
        for k in 0..3 {
            self.a[p * B + k][p * B + k] += s;
        }
    }

    /// Adds `m` to the block of the displacements of points `p` < `q`.
    #[inline(always)]
    pub fn add_block(&mut self, p: usize, q: usize, m: &M3<S>) {
        for r in 0..3 {
            let (row, o) = (m.rows[r], &mut self.a[p * B + r]);
            o[q * B] += row.x;
            o[q * B + 1] += row.y;
            o[q * B + 2] += row.z;
        }
    }

    /// Adds `v` to the column of unknown `k` of point `q` in the rows of the displacement of point `p`, wherever the two are.
    #[inline(always)]
    pub fn add_column(&mut self, p: usize, (q, k): (usize, usize), v: V3<S>) {
        let c = q * B + k;
        for (j, value) in [v.x, v.y, v.z].into_iter().enumerate() {
            let r = p * B + j;
            self.a[r.min(c)][r.max(c)] += value;
        }
    }

    /// Adds a force to the displacement of point `p` [N].
    #[inline(always)]
    pub fn add_force(&mut self, p: usize, f: V3<S>) {
        self.b[p * B] += f.x;
        self.b[p * B + 1] += f.y;
        self.b[p * B + 2] += f.z;
    }

    /// Adds to the right-hand side of unknown `k` of point `p`.
    #[inline(always)]
    pub fn add_right(&mut self, (p, k): (usize, usize), value: F<S>) {
        self.b[p * B + k] += value;
    }

    /// The right-hand side of the displacement of the window's first point.
    #[inline(always)]
    pub fn force(&self) -> V3<S> {
        V3 { x: self.b[0], y: self.b[1], z: self.b[2] }
    }

    /// The right-hand side of unknown `k` of the window's first point.
    #[cfg(test)]
    pub fn right(&self, k: usize) -> F<S> {
        self.b[k]
    }

    /// Holds unknown `k` of the window's first point where it is: its rows are cut off from the rest.
    #[inline(always)]
    pub fn hold(&mut self, simd: S, k: usize) {
        let zero = F::<S>::splat(simd, 0.0);
        for r in 0..k {
            self.a[r][k] = zero;
        }
        for c in k + 1..N {
            self.a[k][c] = zero;
        }
        self.a[k][k] = F::splat(simd, 1.0);
        self.b[k] = zero;
    }

    /// Cuts the first point off from the rest in the strands where it is not `free`.
    #[inline(always)]
    pub fn cut(&mut self, simd: S, free: mask32x8<S>) {
        let zero = F::<S>::splat(simd, 0.0);
        let one = F::<S>::splat(simd, 1.0);
        for r in 0..B {
            for c in r..N {
                self.a[r][c] = free.select(self.a[r][c], if c == r { one } else { zero });
            }
        }
    }

    /// Sets the right-hand side of unknown `k` of the first point.
    #[inline(always)]
    pub fn set_right(&mut self, k: usize, value: F<S>) {
        self.b[k] = value;
    }

    /// Eliminates the window's first point, writes its factors, and moves the window on by a point; what enters is zero.
    #[inline(always)]
    pub fn eliminate(&mut self, simd: S, factors: &mut [Row]) {
        let one = F::<S>::splat(simd, 1.0);
        let factors = &mut factors[..factor_rows(B, N)];
        let mut l = [[one; N]; B];
        each!(r, {
            if r < B {
                each!(k, {
                    if k < r {
                        each!(c, {
                            if c >= r && c < N {
                                self.a[r][c] = (-l[k][r]).mul_add(self.a[k][c], self.a[r][c]);
                            }
                        });
                        self.b[r] = (-l[k][r]).mul_add(self.b[k], self.b[r]);
                    }
                });
                let at = r * N - r * r.saturating_sub(1) / 2;
                let inverse = one / self.a[r][r];
                each!(c, {
                    if c > r && c < N {
                        l[r][c] = self.a[r][c] * inverse;
                        store(l[r][c], &mut factors[at + c - r - 1]);
                    }
                });
                store(self.b[r] * inverse, &mut factors[at + N - r - 1]);
            }
        });
        each!(r, {
            if r >= B && r < N {
                each!(k, {
                    if k < B {
                        each!(c, {
                            if c >= r && c < N {
                                self.a[r][c] = (-l[k][r]).mul_add(self.a[k][c], self.a[r][c]);
                            }
                        });
                        self.b[r] = (-l[k][r]).mul_add(self.b[k], self.b[r]);
                    }
                });
            }
        });
        self.shift(simd);
    }

    /// Moves the window on by a point without eliminating the first.
    #[inline(always)]
    pub fn shift(&mut self, simd: S) {
        let zero = F::<S>::splat(simd, 0.0);
        each!(r, {
            if r + B < N {
                each!(c, {
                    if c >= r && c + B < N {
                        self.a[r][c] = self.a[r + B][c + B];
                    }
                });
                self.b[r] = self.b[r + B];
            }
        });
        each!(c, {
            if c + B >= N && c < N {
                each!(r, {
                    if r <= c {
                        self.a[r][c] = zero;
                    }
                });
                self.b[c] = zero;
            }
        });
    }
}

/// The sweep up: the unknowns of a point, put before those of the points after it in `x`.
#[inline(always)]
pub fn back_substitute<S: Simd, const B: usize, const N: usize>(simd: S, factors: &[Row], x: &mut [F<S>; N]) {
    let factors = &factors[..factor_rows(B, N)];
    let after = *x;
    each!(k, {
        if k >= B && k < N {
            x[k] = after[k - B];
        }
    });
    each!(back, {
        if back < B {
            let r = B - 1 - back;
            let at = r * N - r * r.saturating_sub(1) / 2;
            let mut sum = load(simd, &factors[at + N - 1 - r]);
            each!(c, {
                if c > r && c < N {
                    sum = (-load(simd, &factors[at + c - r - 1])).mul_add(x[c], sum);
                }
            });
            x[r] = sum;
        }
    });
}
