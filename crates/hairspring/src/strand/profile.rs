//! The coupling pattern of a band, and the memory layout of its factors that follows from it.
//!
//! ```text
//! rows of a point    [ u of unknown 0, y₀ │ u of unknown 1, y₁ │ … │ −1/d of each │ w, u of its spring ]
//! ```

/// The coupling pattern of a window of `N` unknowns, `B` a point: which unknowns the window's first point is
/// coupled to.
#[derive(Clone, Copy)]
pub struct Profile<const B: usize, const N: usize> {
    /// Largest distance between two coupled unknowns.
    half: usize,
    /// Whether a single spring is the only coupling between the window's first point and its last; see
    /// [`LongRangeSpring`](super::band::LongRangeSpring).
    far: bool,
}

impl<const B: usize, const N: usize> Profile<B, N> {
    /// Number of preceding points that a point is coupled to.
    pub const REACH: usize = (N - 1) / B;

    /// Each unknown is coupled to at most the `half` unknowns after it.
    pub const fn within(half: usize) -> Self {
        Self { half, far: false }
    }

    /// All unknowns of the window are coupled; its first point and its last are coupled along one direction
    /// only.
    pub const fn far() -> Self {
        Self { half: N - 1, far: true }
    }

    /// Whether a single spring couples the window's first point and its last.
    pub const fn is_far(self) -> bool {
        self.far
    }

    /// Rows of factors a point.
    pub const fn rows(self) -> usize {
        self.pivot(0) + B + if self.far { B + 3 } else { 0 }
    }

    /// The last unknown of the window that unknown `r` is coupled to, not counting a long-range spring.
    pub const fn last(self, r: usize) -> usize {
        let last = if self.far { N - B - 1 } else { N - 1 };
        if r + self.half < last { r + self.half } else { last }
    }

    /// The first row of unknown `r` of the point. Its row of the matrix after the diagonal comes first, then
    /// its right-hand side.
    pub const fn row(self, r: usize) -> usize {
        let (mut row, mut k) = (0, 0);
        while k < r {
            row += self.last(k) - k + 1;
            k += 1;
        }
        row
    }

    /// The row with −1/d for the pivot d of unknown `r`.
    pub const fn pivot(self, r: usize) -> usize {
        self.row(B) + r
    }

    /// The row with unknown `r`'s component of the long-range spring. The spring's direction follows the last
    /// component, in 3 rows.
    pub const fn far_row(self, r: usize) -> usize {
        self.pivot(B) + r
    }

    /// The row that holds the pending entry (r, c) of the window before its point is eliminated, relative to
    /// the rows of the window's first point. It is the row of the entry's future factor.
    pub const fn pending_row(self, r: usize, c: usize) -> usize {
        let (own, first) = (r % B, r / B * B);
        let row = if c > r { self.row(own) + c - r - 1 } else { self.pivot(own) };
        first / B * self.rows() + row
    }

    /// The row that holds the pending right-hand side of unknown `r`, relative to the rows of the window's first
    /// point.
    pub const fn pending_right_row(self, r: usize) -> usize {
        let own = r % B;
        r / B * self.rows() + self.row(own) + self.last(own) - own
    }
}
