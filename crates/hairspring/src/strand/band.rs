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

use super::{profile::Profile, system::System};
use crate::simd::lanes::{F, Mask, Simd, Sym3, V3, Work, load, store};
use std::{
    ops::Range,
    sync::atomic::{Ordering, compiler_fence},
};

/// The zero that a sum begins with: adding to −0 is exact for every number, 0 and −0 included, and so costs nothing.
const NOTHING: f32 = -0.0;

/// The part of the matrix that is being worked on, of eight strands: the unknowns of a point and of the half-bandwidth
/// after it, `N` in all, `B` a point of which the first three are its displacement.
pub struct Band<S: Simd, const B: usize, const N: usize> {
    /// Entry (r, c) for c ≥ r.
    a: [[F<S>; N]; N],
    /// Right-hand side.
    b: [F<S>; N],
    /// Between the first point and the last.
    far: LongRangeSpring<S>,
}

/// A spring between the window's first point and its last, which nothing else couples: all that was eliminated before reaches less far. So their block of the
/// matrix is −k u uᵀ, of rank one, and stays that: eliminating the first point makes −w uᵀ of it, with w = L⁻¹ k u. Three numbers stand for nine in all
/// that meets the block, and on the last point, where nothing else of the first comes, the spring leaves (k − wᵀ D⁻¹ w) u uᵀ.
#[derive(Clone, Copy)]
struct LongRangeSpring<S: Simd> {
    /// Its direction, a unit vector from the first point to the last; or zero.
    u: V3<S>,
    /// Its stiffness [N/m].
    k: F<S>,
    /// With how much it pulls [N].
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
    /// A window of whose points nothing has been said.
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        let nothing = F::<S>::splat(simd, NOTHING);
        let far = LongRangeSpring { u: V3::zero(simd), k: nothing, pull: nothing };
        Self { a: [[nothing; N]; N], b: [nothing; N], far }
    }

    /// Sets the spring between the window's first point and its last, of a [far](Profile::far) profile: it has direction `u` and stiffness `k`, and `pull`s.
    #[inline(always)]
    pub fn add_long_range_spring(&mut self, u: V3<S>, k: F<S>, pull: F<S>) {
        self.add_diagonal(0, Sym3::outer(u, k));
        self.add_force(0, u * pull);
        self.far = LongRangeSpring { u, k, pull };
    }

    /// Takes up what was [left](Band::leave) of the window's first point, the strand's `i`th, which [`Band::eliminate`] does by itself.
    #[inline(always)]
    pub fn load_pending(&mut self, simd: S, profile: Profile<B, N>, i: usize, factors: &mut [Work]) {
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
        ahead.fill(Work::default());
    }

    /// Leaves what was said of these `points` after the window's first where their factors will be, with what was left of them before: in the rows `ahead`,
    /// which begin with the next point's.
    #[inline(always)]
    fn store_pending(&self, simd: S, profile: Profile<B, N>, points: Range<usize>, ahead: &mut [Work]) {
        let add = |value: F<S>, row: &mut Work, before: bool| {
            store(if before { value + load(simd, row) } else { value }, row);
        };
        each!(r, {
            if r + B < N && points.contains(&(r / B + 1)) {
                each!(c, {
                    if c >= r && c + B < N {
                        add(self.a[r + B][c + B], &mut ahead[profile.said(r, c)], c + 2 * B < N);
                    }
                });
                add(self.b[r + B], &mut ahead[profile.said_right(r)], r + 2 * B < N);
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
    pub fn with_checked_lengths(&mut self, simd: S, free: Mask<S>) {
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
    pub fn eliminate(&mut self, simd: S, profile: Profile<B, N>, i: usize, factors: &mut [Work]) {
        let minus_one = F::<S>::splat(simd, -1.0);
        let mut pivots = [minus_one; B];
        let (rows, reach) = (profile.rows(), Profile::<B, N>::REACH);
        // A far spring's factors and all that is said of points ahead are too many for the registers: the sooner it is left, the better.
        let late = if profile.is_far() { reach } else { 1 };
        let (own, after) = factors[i * rows..][..(2 * reach + 1) * rows].split_at_mut((reach + 1) * rows);
        self.store_pending(simd, profile, 1..late, after);
        let LongRangeSpring { u, k: mut left, mut pull } = self.far;
        let mut w = [F::<S>::splat(simd, NOTHING); B];
        for (w, u) in w.iter_mut().zip([u.x, u.y, u.z]) {
            *w = u * left;
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
                        // What the far spring of the point before has of this row.
                        let mut of_far = F::<S>::splat(simd, NOTHING);
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
                                        of_far = l.mul_add(load(simd, &point[profile.far_row(k)]), of_far);
                                    }
                                }
                            }
                        });
                        if profile.is_far() && back > 0 && back < reach {
                            let at = (reach - back) * B;
                            let u = V3::load(simd, &point[profile.far_row(B)..]);
                            for (c, u) in [u.x, u.y, u.z].into_iter().enumerate() {
                                row[at + c] = (-of_far).mul_add(u, row[at + c]);
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

    /// Says of the window's last point what is left of the far spring once the first has been eliminated or passed.
    #[inline(always)]
    fn store_pending_long_range(&mut self, u: V3<S>, left: F<S>, pull: F<S>) {
        self.add_diagonal(Profile::<B, N>::REACH, Sym3::outer(u, left));
        self.add_force(Profile::<B, N>::REACH, -(u * pull));
    }

    /// Moves on past the strand's `i`th point without eliminating it: those after it meet nothing of it.
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

/// The sweep up: the unknowns of a point, put before those of the points after it in `x`.
#[inline(always)]
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
    let mut far = F::<S>::splat(simd, NOTHING);
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
            // Those found last come last: the sums of three unknowns are one chain from tip to root.
            for c in (r + 1..end + 1).rev() {
                sum = load(simd, &factors[at + c - r - 1]).mul_add(x[c], sum);
            }
            x[r] = sum * load(simd, &factors[profile.pivot(r)]);
        }
    });
}
