//! The banded direct solver: LDLᵀ without pivoting, blocks of `B` unknowns a point, one sweep down, one up.
//!
//! ```text
//!          point i   i+1  i+2           a window of N = B (half-bandwidth + 1) unknowns, upper triangle
//!   i    [ D  U  U ]                    eliminating point i, for each of its B unknowns r:
//!   i+1  [    D  U ]                      u_r = A_r − Σ (u_kr / d_k) u_k,   y_r = b_r − Σ (u_kr / d_k) y_k    over the k before r
//!   i+2  [       D ]                      d_r = u_rr;                    up again:   x_r = (y_r − Σ u_rc x_c) / d_r
//! ```
//!
//! Left-looking: a row is assembled, meets all that were eliminated before it in registers, and is written once, as `u` and `y`. What elements say of the
//! points ahead waits in memory until then, where those points' factors will be: no window of the matrix is carried through the walk. By single unknowns
//! rather than by inverted blocks: it is a third fewer operations, because all of the symmetry is used. Golub & Van Loan, *Matrix
//! Computations*, 4th ed., §4.1.2, §4.3.5. Which unknowns meet is said by a [`Profile`].

use super::{
    lanes::{F, M3, Row, Sym3, V3, load, store},
    profile::Profile,
};
use fearless_simd::{mask32x8, prelude::*};
use std::sync::atomic::{Ordering, compiler_fence};

/// The zero that a sum begins with: adding to −0 is exact for every number, 0 and −0 included, and so costs nothing.
const NOTHING: f32 = -0.0;

/// A part of the matrix and the right-hand side that elements add to, of eight strands: some points that follow each other, `B` unknowns each, of which the
/// first three are its displacement. Upper triangle only: the first of two unknowns is never after the second.
pub trait System<S: Simd, const B: usize> {
    /// Adds to one entry: unknown `j` of point `p` with unknown `k` of point `q`.
    fn add(&mut self, pj: (usize, usize), qk: (usize, usize), value: F<S>);

    /// Adds to the right-hand side of unknown `k` of point `p`.
    fn add_right(&mut self, pk: (usize, usize), value: F<S>);

    /// Adds a symmetric block to the displacement of point `p`.
    #[inline(always)]
    fn add_diagonal(&mut self, p: usize, m: Sym3<S>) {
        self.add((p, 0), (p, 0), m.xx);
        self.add((p, 0), (p, 1), m.xy);
        self.add((p, 0), (p, 2), m.xz);
        self.add((p, 1), (p, 1), m.yy);
        self.add((p, 1), (p, 2), m.yz);
        self.add((p, 2), (p, 2), m.zz);
    }

    /// Adds `s` times the identity to the displacement of point `p`.
    #[inline(always)]
    fn add_identity(&mut self, p: usize, s: F<S>) {
        self.add_identity_block(p, p, s);
    }

    /// Adds `s` times the identity to the block of the displacements of points `p` ≤ `q`.
    #[inline(always)]
    fn add_identity_block(&mut self, p: usize, q: usize, s: F<S>) {
        for k in 0..3 {
            self.add((p, k), (q, k), s);
        }
    }

    /// Adds `m` to the block of the displacements of points `p` < `q`.
    #[inline(always)]
    fn add_block(&mut self, p: usize, q: usize, m: &M3<S>) {
        for (r, row) in m.rows.into_iter().enumerate() {
            self.add((p, r), (q, 0), row.x);
            self.add((p, r), (q, 1), row.y);
            self.add((p, r), (q, 2), row.z);
        }
    }

    /// Adds a force to the displacement of point `p` [N].
    #[inline(always)]
    fn add_force(&mut self, p: usize, f: V3<S>) {
        self.add_right((p, 0), f.x);
        self.add_right((p, 1), f.y);
        self.add_right((p, 2), f.z);
    }
}

impl<S: Simd, const B: usize, const N: usize> System<S, B> for Band<S, B, N> {
    #[inline(always)]
    fn add(&mut self, (p, j): (usize, usize), (q, k): (usize, usize), value: F<S>) {
        self.a[p * B + j][q * B + k] += value;
    }

    #[inline(always)]
    fn add_right(&mut self, (p, k): (usize, usize), value: F<S>) {
        self.b[p * B + k] += value;
    }
}

/// What was said of the window's points before the walk comes to the first, and of the last nothing: in memory, for what acts on few points. Were it added to
/// the window, all of that would have to be where both sides of a rare branch find it.
pub struct Said<'a, const B: usize, const N: usize> {
    rows: &'a mut [Row],
    profile: Profile<B, N>,
}

impl<'a, const B: usize, const N: usize> Said<'a, B, N> {
    /// Of the points from the strand's `i`th on.
    #[inline(always)]
    pub fn new(profile: Profile<B, N>, i: usize, factors: &'a mut [Row]) -> Self {
        let (rows, reach) = (profile.rows(), Profile::<B, N>::REACH);
        Self { rows: &mut factors[(i + reach) * rows..][..reach * rows], profile }
    }
}

impl<S: Simd, const B: usize, const N: usize> System<S, B> for Said<'_, B, N> {
    #[inline(always)]
    fn add(&mut self, (p, j): (usize, usize), (q, k): (usize, usize), value: F<S>) {
        let row = &mut self.rows[self.profile.said(p * B + j, q * B + k)];
        store(load(value.simd, row) + value, row);
    }

    #[inline(always)]
    fn add_right(&mut self, (p, k): (usize, usize), value: F<S>) {
        let row = &mut self.rows[self.profile.said_right(p * B + k)];
        store(load(value.simd, row) + value, row);
    }
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
    /// A window of whose points nothing has been said.
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        let nothing = F::<S>::splat(simd, NOTHING);
        Self { a: [[nothing; N]; N], b: [nothing; N] }
    }

    /// Takes up what was [left](Band::leave) of the window's first point, the strand's `i`th, which [`Band::eliminate`] does by itself.
    #[inline(always)]
    pub fn take_up(&mut self, simd: S, profile: Profile<B, N>, i: usize, factors: &mut [Row]) {
        let rows = profile.rows();
        let ahead = &mut factors[(i + Profile::<B, N>::REACH) * rows..][..rows];
        each!(r of 0 1 2 3, {
            if r < B {
                each!(c, {
                    if c >= r && c + B < N {
                        self.a[r][c] += load(simd, &ahead[profile.said(r, c)]);
                    }
                });
                self.b[r] += load(simd, &ahead[profile.said_right(r)]);
            }
        });
        ahead.fill(Row::default());
    }

    /// Leaves what was said of the points after the window's first where their factors will be, with what was left of them before: in the rows `ahead`,
    /// which begin with the next point's.
    #[inline(always)]
    fn leave(&self, simd: S, profile: Profile<B, N>, ahead: &mut [Row]) {
        let add = |value: F<S>, row: &mut Row, before: bool| {
            store(if before { value + load(simd, row) } else { value }, row);
        };
        each!(r, {
            if r + B < N {
                each!(c, {
                    if c >= r && c + B < N {
                        add(self.a[r + B][c + B], &mut ahead[profile.said(r, c)], c + 2 * B < N);
                    }
                });
                add(self.b[r + B], &mut ahead[profile.said_right(r)], r + 2 * B < N);
            }
        });
    }

    /// Adds `stiffness` times the square of a gradient, which is `c[p]` times `direction` at the displacement of point `p`.
    #[inline(always)]
    pub fn add_rank_one<const P: usize>(&mut self, direction: V3<S>, c: [F<S>; P], stiffness: F<S>) {
        let block = Sym3::outer(direction, stiffness);
        each!(p, {
            if p < P {
                let scaled = block * c[p];
                self.add_diagonal(p, scaled * c[p]);
                each!(q, {
                    if q > p && q < P {
                        self.add_block(p, q, &(scaled * c[q]).full());
                    }
                });
            }
        });
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

    /// Eliminates the window's first point, the strand's `i`th, and [leaves](Band::leave) what was said of the others. Its factors
    /// follow in `factors` on those of the points before it, which begin with zeros for twice [`Profile::REACH`] points: as many that there are not, and as many
    /// of which nothing has been said.
    #[inline(always)]
    #[allow(clippy::needless_range_loop, reason = "columns count in the row and in the factors")]
    pub fn eliminate(&mut self, simd: S, profile: Profile<B, N>, i: usize, factors: &mut [Row]) {
        let minus_one = F::<S>::splat(simd, -1.0);
        let mut pivots = [minus_one; B];
        let (rows, reach) = (profile.rows(), Profile::<B, N>::REACH);
        let (own, after) = factors[i * rows..][..(2 * reach + 1) * rows].split_at_mut((reach + 1) * rows);
        // What is said of three points ahead, and their factors, are too much for the registers: the sooner it is left, the better.
        let soon = reach > 2;
        if soon {
            self.leave(simd, profile, after);
        }
        each!(r of 0 1 2 3, {
            if r < B {
                let (mut row, mut right) = (self.a[r], self.b[r]);
                // What the points before have said of it is read here, where it is added to, and not carried through the walk's loop: the compiler would
                // move all of the window from one place of the stack to another at every point, an eighth of the instructions.
                let ahead = &own[reach * rows..][..rows];
                for c in r..N - B {
                    row[c] += load(simd, &ahead[profile.said(r, c)]);
                }
                right += load(simd, &ahead[profile.said_right(r)]);
                each!(back of 3 2 1 0, {
                    if back <= reach {
                        // Costs nothing by itself. Without it the compiler loads all factors long before they are used, and then has to
                        // put them back into memory: a sixth more instructions.
                        compiler_fence(Ordering::SeqCst);
                        let point = &own[(reach - back) * rows..][..rows];
                        each!(k of 0 1 2 3, {
                            let last = profile.last(k);
                            if k < B && back * B + r <= last && (back > 0 || k < r) {
                                let at = profile.row(k);
                                let a = |c: usize| load(simd, &point[at + back * B + c - k - 1]);
                                let pivot = if back == 0 { pivots[k] } else { load(simd, &point[profile.pivot(k)]) };
                                let l = a(r) * pivot;
                                for c in r..N.min(last + 1 - back * B) {
                                    row[c] = l.mul_add(a(c), row[c]);
                                }
                                right = l.mul_add(load(simd, &point[at + last - k]), right);
                            }
                        });
                    }
                });
                let point = &mut own[reach * rows..][..rows];
                let (at, last) = (profile.row(r), profile.last(r));
                for c in r + 1..last + 1 {
                    store(row[c], &mut point[at + c - r - 1]);
                }
                store(right, &mut point[at + last - r]);
                pivots[r] = minus_one / row[r];
                store(pivots[r], &mut point[profile.pivot(r)]);
            }
        });
        if !soon {
            self.leave(simd, profile, after);
        }
    }

    /// Moves on past the strand's `i`th point without eliminating it: those after it meet nothing of it.
    #[inline(always)]
    pub fn pass(&self, simd: S, profile: Profile<B, N>, i: usize, factors: &mut [Row]) {
        let (rows, reach) = (profile.rows(), Profile::<B, N>::REACH);
        let (own, after) = factors[(i + reach) * rows..][..(reach + 1) * rows].split_at_mut(rows);
        own.fill(Row::default());
        self.leave(simd, profile, after);
    }
}

/// The sweep up: the unknowns of a point, put before those of the points after it in `x`.
#[inline(always)]
pub fn back_substitute<S: Simd, const B: usize, const N: usize>(
    simd: S,
    profile: Profile<B, N>,
    factors: &[Row],
    x: &mut [F<S>; N],
) {
    let factors = &factors[..profile.rows()];
    let after = *x;
    each!(k, {
        if k >= B && k < N {
            x[k] = after[k - B];
        }
    });
    each!(back of 0 1 2 3, {
        if back < B {
            let r = B - 1 - back;
            let (at, end) = (profile.row(r), profile.last(r));
            let mut sum = -load(simd, &factors[at + end - r]);
            // Those found last come last: the sums of three unknowns are one chain from tip to root.
            for c in (r + 1..end + 1).rev() {
                sum = load(simd, &factors[at + c - r - 1]).mul_add(x[c], sum);
            }
            x[r] = sum * load(simd, &factors[profile.pivot(r)]);
        }
    });
}
