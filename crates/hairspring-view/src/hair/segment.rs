//! One segment of a strand on the screen: four points of a smooth curve, and the straight pieces that it is
//! drawn with.

use glam::{Vec2, Vec4};

/// Maximum number of pieces per segment.
pub(crate) const MAX_PIECES: f32 = 16.0;

/// A point of a strand on the screen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dot {
    /// Position [pixels].
    pub at: Vec2,
    /// Fraction of the frame's depth range, 0 to 1.
    pub depth: f32,
    /// Width [pixels], with a minus sign if the strand does not continue to the next point.
    width: f32,
}

impl Dot {
    /// A point without a successor.
    pub const END: Self = Self { at: Vec2::ZERO, depth: 0.0, width: -0.0 };

    /// Creates a point; `linked` says whether the strand continues to the next point.
    #[inline(always)]
    pub fn new(at: Vec2, depth: f32, width: f32, linked: bool) -> Self {
        Self { at, depth, width: if linked { width } else { -width } }
    }

    /// Whether the strand continues to the next point.
    #[inline(always)]
    pub fn linked(&self) -> bool {
        self.width.is_sign_positive()
    }

    /// Width [pixels].
    #[inline(always)]
    pub fn width(&self) -> f32 {
        self.width.abs()
    }

    #[inline(always)]
    fn mix(&self, other: &Self, at: Vec2, u: f32) -> Self {
        let mix = |a: f32, b: f32| a + (b - a) * u;
        Self { at, depth: mix(self.depth, other.depth), width: mix(self.width(), other.width()) }
    }
}

/// A straight piece of a strand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    /// Ends [pixels].
    pub a: Vec2,
    pub b: Vec2,
    /// Fraction of the frame's depth range, 0 to 1, at both ends.
    pub depth: [f32; 2],
    /// Width at both ends [pixels].
    pub width: [f32; 2],
    /// Linear RGB and −1 at both ends: what a coverage adds to (red, green, blue, transmittance).
    pub color: [Vec4; 2],
    /// Whether the strand begins at `a`, and whether it ends at `b`.
    pub cap: [bool; 2],
}

/// The part of a strand between two points, with the directions of its neighbors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    pub a: Dot,
    pub b: Dot,
    /// Unit directions of the previous segment, of this one and of the next one; zero if there is none.
    before: Vec2,
    here: Vec2,
    next: Vec2,
    /// Length [pixels].
    length: f32,
}

impl Segment {
    /// Creates the segment from the second to the third of four consecutive points, in coordinates relative
    /// to `origin`. Points without a link are ignored.
    #[inline(always)]
    pub fn new([z, a, b, c]: &[Dot; 4], origin: Vec2) -> Self {
        let d = b.at - a.at;
        Self {
            before: if z.linked() { (a.at - z.at).normalize_or_zero() } else { Vec2::ZERO },
            here: d.normalize_or_zero(),
            next: if b.linked() { (c.at - b.at).normalize_or_zero() } else { Vec2::ZERO },
            length: d.length(),
            a: Dot { at: a.at - origin, ..*a },
            b: Dot { at: b.at - origin, ..*b },
        }
    }

    /// Unit normals of the curve at both ends, equal for both segments at a joint.
    #[inline(always)]
    pub fn across(&self) -> [Vec2; 2] {
        [self.before, self.next].map(|other| (other + self.here).normalize_or(self.here).perp())
    }

    /// The straight pieces of the curve, which deviate from it by at most `tolerance` [pixels].
    ///
    /// Tangents at the joints bisect the angle there. This is a Catmull-Rom curve with chord-length
    /// parameterization, which has no loops or overshoot if points are spaced unevenly.
    #[inline(always)]
    pub fn pieces(&self, tolerance: f32, color: [Vec4; 2]) -> Pieces<'_> {
        let (before, here, next) = (self.before, self.here, self.next);
        let turn = |other: Vec2| if other == Vec2::ZERO { 0.0 } else { (other - here).length() };
        let bend = self.length * 0.0625 * (turn(before) + turn(next));
        let count = (bend / tolerance).sqrt().ceil().clamp(1.0, MAX_PIECES);
        // A NaN tolerance gives one piece.
        let count = if count.is_nan() { 1.0 } else { count };
        let tangents = match count > 1.0 {
            true => [
                (before + here).normalize_or(here) * self.length,
                (here + next).normalize_or(here) * self.length,
            ],
            false => [Vec2::ZERO; 2],
        };
        Pieces { segment: self, color, count, tangents, done: 0.0, last: (self.a, color[0]) }
    }
}

/// Pieces of a segment, from its start to its end.
pub(crate) struct Pieces<'a> {
    segment: &'a Segment,
    color: [Vec4; 2],
    count: f32,
    tangents: [Vec2; 2],
    done: f32,
    /// End of the last piece, and the color there.
    last: (Dot, Vec4),
}

impl Pieces<'_> {
    /// Start and end of the last piece, as fractions of the segment.
    #[inline(always)]
    pub fn along(&self) -> [f32; 2] {
        [self.done - 1.0, self.done].map(|done| done / self.count)
    }
}

impl Iterator for Pieces<'_> {
    type Item = Piece;

    #[inline(always)]
    fn next(&mut self) -> Option<Piece> {
        if self.done >= self.count {
            return None;
        }
        let Segment { a: first, b: end, before, next, .. } = self.segment;
        let (a, from) = self.last;
        let starts = self.done == 0.0 && *before == Vec2::ZERO;
        self.done += 1.0;
        let closes = self.done == self.count;
        let (b, to) = if closes {
            (*end, self.color[1])
        } else {
            let u = self.done / self.count;
            let at = hermite(first.at, end.at, self.tangents[0], self.tangents[1], u);
            (first.mix(end, at, u), self.color[0] + (self.color[1] - self.color[0]) * u)
        };
        self.last = (b, to);
        Some(Piece {
            a: a.at,
            b: b.at,
            depth: [a.depth, b.depth],
            width: [a.width(), b.width()],
            color: [from, to],
            cap: [starts, closes && *next == Vec2::ZERO],
        })
    }
}

/// Cubic through `a` and `b` with tangents `ta` and `tb`.
#[inline(always)]
fn hermite(a: Vec2, b: Vec2, ta: Vec2, tb: Vec2, u: f32) -> Vec2 {
    let (u2, u3) = (u * u, u * u * u);
    a * (2.0 * u3 - 3.0 * u2 + 1.0) + b * (3.0 * u2 - 2.0 * u3) + ta * (u3 - 2.0 * u2 + u) + tb * (u3 - u2)
}
