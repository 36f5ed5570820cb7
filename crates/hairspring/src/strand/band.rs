//! Banded direct solver: LDLᵀ without pivoting, in blocks of `B` unknowns a point, with one downward and one
//! upward sweep.
//!
//! ```text
//!          point i   i+1  i+2           a window of N = B (half-bandwidth + 1) unknowns, upper triangle
//!   i    [ D  U  U ]                    eliminating point i, for each of its B unknowns r:
//!   i+1  [    D  U ]           u_r = A_r − Σ (u_kr / d_k) u_k,   y_r = b_r − Σ (u_kr / d_k) y_k    over k < r
//!   i+2  [       D ]           d_r = u_rr;                    upward:    x_r = (y_r − Σ u_rc x_c) / d_r
//! ```
//!
//! The factorization is left-looking. A row is assembled, combined in registers with all rows that were
//! eliminated before it, and written once, as `u` and `y`. Contributions of elements to later points are
//! stored in memory, in the place of those points' factors, until the sweep reaches them. No window of the
//! matrix is carried from point to point.
//!
//! The elimination works on single unknowns instead of inverted blocks. It uses all of the symmetry, which
//! saves a third of the operations. Golub & Van Loan, *Matrix Computations*, 4th ed., §4.1.2, §4.3.5. A
//! [`Profile`] defines which unknowns are coupled.

use super::{profile::Profile, system::System};
use crate::simd::lanes::{F, Mask, Simd, Sym3, V3, Work, load, store};
use std::{
    ops::Range,
    sync::atomic::{Ordering, compiler_fence},
};

/// The initial value of sums: −0 is the exact additive identity of floating-point numbers, including 0 and
/// −0, so the compiler can remove the addition.
const NEGATIVE_ZERO: f32 = -0.0;

/// The part of the matrix that is currently worked on, for eight strands: the unknowns of one point and those
/// within the half-bandwidth after it, `N` in all. Each point has `B` unknowns, of which the first three are
/// its displacement.
pub struct Band<S: Simd, const B: usize, const N: usize> {
    /// Entry (r, c) for c ≥ r.
    a: [[F<S>; N]; N],
    /// Right-hand side.
    b: [F<S>; N],
    /// The spring between the window's first point and its last.
    far: LongRangeSpring<S>,
}

/// A spring between the window's first point and its last. Nothing else couples these two points, because
/// every element that was eliminated before has a shorter reach.
///
/// Their block of the matrix is therefore −k u uᵀ, of rank one. Eliminating the first point turns it into −w
/// uᵀ, with w = L⁻¹ k u, which again has rank one. Three numbers thus replace the nine of the block. The last
/// point receives no other contribution of the first; the spring leaves (k − wᵀ D⁻¹ w) u uᵀ on it.
#[derive(Clone, Copy)]
struct LongRangeSpring<S: Simd> {
    /// Unit vector from the first point to the last, or zero.
    u: V3<S>,
    /// Stiffness [N/m].
    k: F<S>,
    /// Tension [N].
    pull: F<S>,
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

impl<S: Simd, const B: usize, const N: usize> Band<S, B, N> {
    /// An empty window.
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        let nothing = F::<S>::splat(simd, NEGATIVE_ZERO);
        let far = LongRangeSpring { u: V3::zero(simd), k: nothing, pull: nothing };
        Self { a: [[nothing; N]; N], b: [nothing; N], far }
    }

    /// Sets the spring between the window's first point and its last, with direction `u`, stiffness `k` and
    /// tension `pull`. Requires a [far](Profile::far) profile.
    #[inline(always)]
    pub fn add_long_range_spring(&mut self, u: V3<S>, k: F<S>, pull: F<S>) {
        self.add_diagonal(0, Sym3::outer(u, k));
        self.add_force(0, u * pull);
        self.far = LongRangeSpring { u, k, pull };
    }

    /// Adds the [pending rows](Band::store_pending) of the strand's `i`th point to the window's first point.
    /// [`Band::eliminate`] does this itself.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub fn load_pending(&mut self, simd: S, profile: Profile<B, N>, i: usize, factors: &mut [Work]) {
        let rows = profile.rows();
        let ahead = &mut factors[(i + Profile::<B, N>::REACH) * rows..][..rows];
        each!(r of 0 1 2 3, {
            if r < B {
                each!(c, {
                    if c >= r && c + B < N {
                        self.a[r][c] += load(simd, &ahead[profile.pending_row(r, c)]);
                    }
                });
                self.b[r] += load(simd, &ahead[profile.pending_right_row(r)]);
            }
        });
        ahead.fill(Work::default());
    }

    /// Stores the window's entries for `points`, counted from the window's first, where the factors of those
    /// points will be, and adds the entries that were stored there before. The rows `ahead` begin with those
    /// of the next point.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn store_pending(&self, simd: S, profile: Profile<B, N>, points: Range<usize>, ahead: &mut [Work]) {
        let add = |value: F<S>, row: &mut Work, before: bool| {
            store(if before { value + load(simd, row) } else { value }, row);
        };
        each!(r, {
            if r + B < N && points.contains(&(r / B + 1)) {
                each!(c, {
                    if c >= r && c + B < N {
                        add(self.a[r + B][c + B], &mut ahead[profile.pending_row(r, c)], c + 2 * B < N);
                    }
                });
                add(self.b[r + B], &mut ahead[profile.pending_right_row(r)], r + 2 * B < N);
            }
        });
    }

    /// Adds `v` to the column of unknown `k` of point `q`, in the rows of the displacement of point `p`. The
    /// two points may be in any order.
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

    /// Fixes unknown `k` of the window's first point: removes its coupling to all other unknowns and sets its
    /// right-hand side to zero.
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

    /// Decouples the first point from all others in the strands where it is not `free`.
    #[inline(always)]
    pub fn decouple_first(&mut self, simd: S, free: Mask<S>) {
        let zero = F::<S>::splat(simd, 0.0);
        let one = F::<S>::splat(simd, 1.0);
        for r in 0..B {
            for c in r..N {
                self.a[r][c] = free.select(self.a[r][c], if c == r { one } else { zero });
            }
        }
    }

    /// Eliminates the window's first point, the strand's `i`th, and [stores](Band::store_pending) the pending
    /// entries of the other points.
    ///
    /// The factors of the point follow in `factors` on those of the points before it. `factors` begins with
    /// zeros for twice [`Profile::REACH`] points. The first half stands for the missing points before the
    /// root, the second for points without pending entries.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    #[allow(clippy::needless_range_loop, reason = "columns count in the row and in the factors")]
    pub fn eliminate(&mut self, simd: S, profile: Profile<B, N>, i: usize, factors: &mut [Work]) {
        let minus_one = F::<S>::splat(simd, -1.0);
        let mut pivots = [minus_one; B];
        let (rows, reach) = (profile.rows(), Profile::<B, N>::REACH);
        // The factors of a long-range spring and all pending entries together exceed the registers, so
        // entries of later points are stored as early as possible.
        let late = if profile.is_far() { reach } else { 1 };
        let (own, after) = factors[i * rows..][..(2 * reach + 1) * rows].split_at_mut((reach + 1) * rows);
        self.store_pending(simd, profile, 1..late, after);
        let LongRangeSpring { u, k: mut left, mut pull } = self.far;
        let mut w = [F::<S>::splat(simd, NEGATIVE_ZERO); B];
        for (w, u) in w.iter_mut().zip([u.x, u.y, u.z]) {
            *w = u * left;
        }
        each!(r of 0 1 2 3, {
            if r < B {
                let (mut row, mut right) = (self.a[r], self.b[r]);
                // The pending entries of the row are loaded here, where they are added, and not at the top of
                // the loop over points. Otherwise the compiler copies the whole window from one stack slot to
                // another at every point, which is an eighth of all instructions.
                let ahead = &own[reach * rows..][..rows];
                for c in r..N - B {
                    row[c] += load(simd, &ahead[profile.pending_row(r, c)]);
                }
                right += load(simd, &ahead[profile.pending_right_row(r)]);
                each!(back of 3 2 1 0, {
                    if back <= reach {
                        // The fence itself is free. Without it the compiler loads all factors long before
                        // they are used and has to spill them: a sixth more instructions.
                        compiler_fence(Ordering::SeqCst);
                        let point = &own[(reach - back) * rows..][..rows];
                        // The contribution of the previous point's long-range spring to this row.
                        let mut long_range = F::<S>::splat(simd, NEGATIVE_ZERO);
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
                                if profile.is_far() {
                                    if back == 0 {
                                        w[r] = l.mul_add(w[k], w[r]);
                                    } else {
                                        long_range = l.mul_add(load(simd, &point[profile.far_row(k)]), long_range);
                                    }
                                }
                            }
                        });
                        if profile.is_far() && back > 0 && back < reach {
                            let at = (reach - back) * B;
                            let u = V3::load(simd, &point[profile.far_row(B)..]);
                            for (c, u) in [u.x, u.y, u.z].into_iter().enumerate() {
                                row[at + c] = (-long_range).mul_add(u, row[at + c]);
                            }
                        }
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
                if profile.is_far() {
                    store(w[r], &mut point[profile.far_row(r)]);
                    let l = w[r] * pivots[r];
                    left = l.mul_add(w[r], left);
                    pull = l.mul_add(right, pull);
                }
            }
        });
        if profile.is_far() {
            u.store(&mut own[reach * rows..][profile.far_row(B)..rows]);
            self.store_pending_long_range(u, left, pull);
        }
        self.store_pending(simd, profile, late..reach + 1, after);
    }

    /// Adds the remaining part of the long-range spring to the window's last point, once the first has been
    /// eliminated or skipped.
    #[inline(always)]
    fn store_pending_long_range(&mut self, u: V3<S>, left: F<S>, pull: F<S>) {
        self.add_diagonal(Profile::<B, N>::REACH, Sym3::outer(u, left));
        self.add_force(Profile::<B, N>::REACH, -(u * pull));
    }

    /// Advances past the strand's `i`th point without eliminating it. The points after it are not coupled to
    /// it.
    #[inline(always)]
    pub fn skip_row(&mut self, simd: S, profile: Profile<B, N>, i: usize, factors: &mut [Work]) {
        let (rows, reach) = (profile.rows(), Profile::<B, N>::REACH);
        let (own, after) = factors[(i + reach) * rows..][..(reach + 1) * rows].split_at_mut(rows);
        own.fill(Work::default());
        if profile.is_far() {
            let LongRangeSpring { u, k, pull } = self.far;
            self.store_pending_long_range(u, k, pull);
        }
        self.store_pending(simd, profile, 1..reach + 1, after);
    }
}

/// One step of the upward sweep: solves for the unknowns of a point and puts them in `x`, before those of the
/// points after it.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn back_substitute<S: Simd, const B: usize, const N: usize>(
    simd: S,
    profile: Profile<B, N>,
    factors: &[Work],
    x: &mut [F<S>; N],
) {
    let factors = &factors[..profile.rows()];
    let after = *x;
    each!(k, {
        if k >= B && k < N {
            x[k] = after[k - B];
        }
    });
    let mut far = F::<S>::splat(simd, NEGATIVE_ZERO);
    if profile.is_far() {
        let at = Profile::<B, N>::REACH * B;
        let u = V3::load(simd, &factors[profile.far_row(B)..]);
        far = -u.dot(V3 { x: x[at], y: x[at + 1], z: x[at + 2] });
    }
    each!(back of 0 1 2 3, {
        if back < B {
            let r = B - 1 - back;
            let (at, end) = (profile.row(r), profile.last(r));
            let mut sum = -load(simd, &factors[at + end - r]);
            if profile.is_far() {
                sum = load(simd, &factors[profile.far_row(r)]).mul_add(far, sum);
            }
            // The most recent results are used last: the sums of three unknowns form one dependency chain
            // from tip to root.
            for c in (r + 1..end + 1).rev() {
                sum = load(simd, &factors[at + c - r - 1]).mul_add(x[c], sum);
            }
            x[r] = sum * load(simd, &factors[profile.pivot(r)]);
        }
    });
}
