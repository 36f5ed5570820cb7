//! The interface through which elements add entries to the matrix and the right-hand side: either to the
//! current window, or to rows in memory ahead of it.

use super::profile::Profile;
use crate::simd::lanes::{F, M3, Simd, Sym3, V3, Work, load, store};

/// A part of the matrix and the right-hand side of eight strands: some consecutive points with `B` unknowns
/// each, of which the first three are the displacement. Only the upper triangle is stored: the first of two
/// unknowns is never after the second.
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

/// Entries of a window's points, except the last, that are added before the sweep reaches its first point.
/// They are stored in memory, for forces that act on few points. If those were added to the window itself,
/// the compiler would have to keep the whole window in memory across a rare branch.
pub struct PendingRows<'a, const B: usize, const N: usize> {
    rows: &'a mut [Work],
    profile: Profile<B, N>,
}

impl<'a, const B: usize, const N: usize> PendingRows<'a, B, N> {
    /// Rows of the points from the strand's `i`th on.
    #[inline(always)]
    pub fn new(profile: Profile<B, N>, i: usize, factors: &'a mut [Work]) -> Self {
        let (rows, reach) = (profile.rows(), Profile::<B, N>::REACH);
        Self { rows: &mut factors[(i + reach) * rows..][..reach * rows], profile }
    }
}

impl<S: Simd, const B: usize, const N: usize> System<S, B> for PendingRows<'_, B, N> {
    #[inline(always)]
    fn add(&mut self, (p, j): (usize, usize), (q, k): (usize, usize), value: F<S>) {
        let row = &mut self.rows[self.profile.pending_row(p * B + j, q * B + k)];
        store(load(value.simd, row) + value, row);
    }

    #[inline(always)]
    fn add_right(&mut self, (p, k): (usize, usize), value: F<S>) {
        let row = &mut self.rows[self.profile.pending_right_row(p * B + k)];
        store(load(value.simd, row) + value, row);
    }
}
