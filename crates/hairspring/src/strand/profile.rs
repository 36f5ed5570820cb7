//! Which unknowns of a band meet, and so how its factors lie in memory.
//!
//! ```text
//! rows of a point    [ u of unknown 0, y₀ │ u of unknown 1, y₁ │ … │ −1/d of each │ w, u of its far spring, if it has one ]
//! ```

/// Which unknowns meet in a window of `N` unknowns, `B` a point: those of the window's first point with those after them.
#[derive(Clone, Copy)]
pub struct Profile<const B: usize, const N: usize> {
    /// Largest distance of two unknowns that meet.
    half: usize,
    /// Whether all that meets between the window's first point and its last is one spring, see [`LongRangeSpring`](super::band::LongRangeSpring).
    far: bool,
}

impl<const B: usize, const N: usize> Profile<B, N> {
    /// Points before a point that meet it.
    pub const REACH: usize = (N - 1) / B;

    /// Unknowns meet none more than `half` after them.
    pub const fn within(half: usize) -> Self {
        Self { half, far: false }
    }

    /// All of the window meets, but its first point and its last along one direction only.
    pub const fn far() -> Self {
        Self { half: N - 1, far: true }
    }

    /// Whether the window's first point and its last are held by one spring.
    pub const fn is_far(self) -> bool {
        self.far
    }

    /// Rows of factors a point.
    pub const fn rows(self) -> usize {
        self.pivot(0) + B + if self.far { B + 3 } else { 0 }
    }

    /// The last unknown of the window that unknown `r` meets, but for a far spring's.
    pub const fn last(self, r: usize) -> usize {
        let last = if self.far { N - B - 1 } else { N - 1 };
        if r + self.half < last { r + self.half } else { last }
    }

    /// The first row that belongs to unknown `r` of the point: its row of the matrix after the diagonal, then its right-hand side.
    pub const fn row(self, r: usize) -> usize {
        let (mut row, mut k) = (0, 0);
        while k < r {
            row += self.last(k) - k + 1;
            k += 1;
        }
        row
    }

    /// The row with −1/d of unknown `r`'s pivot d.
    pub const fn pivot(self, r: usize) -> usize {
        self.row(B) + r
    }

    /// The row with unknown `r`'s part in the far spring; after the last, the spring's direction, 3 rows.
    pub const fn far_row(self, r: usize) -> usize {
        self.pivot(B) + r
    }

    /// Where entry (r, c) of the window is before its point is eliminated, from the rows of the window's first point on: where its factor will be.
    pub const fn said(self, r: usize, c: usize) -> usize {
        let (own, first) = (r % B, r / B * B);
        let row = if c > r { self.row(own) + c - r - 1 } else { self.pivot(own) };
        first / B * self.rows() + row
    }

    /// The same of the right-hand side of unknown `r`.
    pub const fn said_right(self, r: usize) -> usize {
        let own = r % B;
        r / B * self.rows() + self.row(own) + self.last(own) - own
    }
}
