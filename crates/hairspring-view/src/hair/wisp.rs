//! Hairs of which one strand stands for many, drawn as many: side by side, each with a way and a brightness of its own.
//!
//! A strand that stands for eight may be drawn eight times as wide, and is a ribbon. As a wisp (Watanabe & Suenaga 1992, "A Trigonal Prism-Based Method for Hair Image
//! Generation") of hairs an eighth of that wide it covers as much, reads as hair, and is placed, shaded, filed and sorted once: what is left to do for each hair
//! is to blend it. All of it happens on the screen, so that hairs of a wisp do not part in depth.

use super::segment::{Piece, Segment};
use glam::{Vec2, Vec3};

/// Most hairs of a wisp.
const MOST: usize = 4;
/// How far from the strand its outermost hairs lie, over its width: they fill the room of those that are left out.
const SPREAD: f32 = 0.9;
/// How far a hair strays from its place in the wisp, over the strand's width, so that hairs cross.
const STRAY: f32 = 0.45;
/// In how many points of the strand it goes to and fro.
const WAVE: f32 = 11.0;
/// How much of that is gone at the tip: locks end in a point.
const POINTED: f32 = 0.75;
/// How much brighter or darker than the strand a hair is.
const TINT: f32 = 0.3;
const GOLDEN: f32 = 0.618_034;

/// How many hairs a strand is drawn as.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wisp {
    count: u32,
}

impl Wisp {
    pub fn new(count: u32) -> Self {
        Self { count: count.clamp(1, MOST as u32) }
    }

    /// Whether strands are drawn as they are.
    pub fn is_one(self) -> bool {
        self.count == 1
    }

    /// How far from its middle a strand is drawn, over its width.
    pub fn reach(self) -> f32 {
        let share = 1.0 / self.count as f32;
        if self.is_one() { 0.5 } else { SPREAD * (1.0 - share) + STRAY + 0.5 * share }
    }

    /// The hairs of a segment from point `i` on, of `points`, of this strand.
    #[inline(always)]
    pub fn hairs(self, segment: &Segment, strand: u32, i: usize, points: usize) -> Hairs {
        let share = 1.0 / self.count as f32;
        let per_point = 1.0 / (points.max(2) - 1) as f32;
        let room = |point: f32| 1.0 - POINTED * (point * per_point).powi(3);
        let point = i as f32;
        let [a, b] = segment.across();
        let across = [a * (segment.a.width() * room(point)), b * (segment.b.width() * room(point + 1.0))];
        let mut hairs =
            Hairs { count: self.count as usize, share, across, ways: [[0.0; 2]; _], tints: [0.0; _] };
        // A strand's own number, small enough for what follows to keep its digits.
        let strand = (strand % 4096 * MOST as u32) as f32;
        // All that there may be, so that they lie in lanes.
        for k in 0..MOST {
            // Multiples of the golden ratio: unlike its neighbours in the wisp and in the groom.
            let phase = (strand + k as f32) * GOLDEN;
            let place = SPREAD * ((2 * k + 1) as f32 * share - 1.0);
            let way = |point: f32| place + STRAY * wave(point * (1.0 / WAVE) + phase);
            hairs.ways[k] = [way(point), way(point + 1.0)];
            hairs.tints[k] = 1.0 + TINT * wave(7.0 * phase);
        }
        hairs
    }
}

/// The hairs of a segment.
pub(crate) struct Hairs {
    count: usize,
    /// Part of the strand's width that each has.
    share: f32,
    /// Across the strand, as far as the wisp's unit is long [pixels], at both ends.
    across: [Vec2; 2],
    /// How many of that each hair lies aside at both ends.
    ways: [[f32; 2]; MOST],
    /// How bright each is, over the strand.
    tints: [f32; MOST],
}

impl Hairs {
    /// How many there are.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.count
    }

    /// One hair of a piece of the segment, which goes `along` from one share of it to another.
    #[inline(always)]
    pub fn piece(&self, hair: usize, piece: &Piece, along: [f32; 2]) -> Piece {
        let [from, to] = [0, 1].map(|end| self.across[end] * self.ways[hair][end]);
        let way = |u: f32| from + (to - from) * u;
        // What a hair hides stays.
        let light = Vec3::splat(self.tints[hair]).extend(1.0);
        Piece {
            a: piece.a + way(along[0]),
            b: piece.b + way(along[1]),
            width: piece.width.map(|w| w * self.share),
            color: piece.color.map(|c| c * light),
            ..*piece
        }
    }
}

/// A wave from −1 to 1 of period 1, of parabolas.
#[inline(always)]
fn wave(x: f32) -> f32 {
    let x = x - x.floor() - 0.5;
    16.0 * x * (0.5 - x.abs())
}
