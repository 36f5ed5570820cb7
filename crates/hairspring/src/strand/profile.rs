//! Which unknowns of a band meet, and so how its factors lie in memory.
//!
//! ```text
//! rows of a point    [ u of unknown 0, y₀ │ u of unknown 1, y₁ │ … │ −1/d of each ]
//! ```

/// Which unknowns meet in a window of `N` unknowns, `B` a point: those of the window's first point with those after them.
#[derive(Clone, Copy)]
pub struct Profile<const B: usize, const N: usize> {
    /// Largest distance of two unknowns that meet.
    half: usize,
}

impl<const B: usize, const N: usize> Profile<B, N> {
    /// Points before a point that meet it.
    pub const REACH: usize = (N - 1) / B;

    /// Unknowns meet none more than `half` after them.
    pub const fn within(half: usize) -> Self {
        Self { half }
    }

    /// Rows of factors a point.
    pub const fn rows(self) -> usize {
        self.pivot(0) + B
    }

    /// The last unknown of the window that unknown `r` meets.
    pub const fn last(self, r: usize) -> usize {
        if r + self.half < N { r + self.half } else { N - 1 }
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
