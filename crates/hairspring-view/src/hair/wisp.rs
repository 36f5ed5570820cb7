//! Draws a strand that represents several hairs as several hairs next to each other, each with its own path
//! and brightness.
//!
//! A strand that represents eight could be drawn eight times as wide, but would then look like a ribbon. A
//! wisp (Watanabe & Suenaga 1992, "A Trigonal Prism-Based Method for Hair Image Generation") of thinner hairs
//! covers the same area and looks like hair. Projection, shading and sorting are done once per strand; only
//! blending is done for each hair. Everything happens in screen space, so the hairs of a wisp have the same
//! depth.

use super::segment::{Piece, Segment};
use glam::{Vec2, Vec3};

/// Maximum number of hairs of a wisp.
const MOST: usize = 4;
/// Distance of the outermost hairs from the strand, relative to its width. They fill the space of the hairs
/// that are not drawn.
const SPREAD: f32 = 0.9;
/// Amplitude of the deviation of a hair from its position in the wisp, relative to the strand's width. It
/// makes hairs cross.
const STRAY: f32 = 0.45;
/// Period of the deviation, in points of the strand.
const WAVE: f32 = 11.0;
/// Fraction of the spread that is lost toward the tip, so that locks are pointed.
const POINTED: f32 = 0.75;
/// Brightness variation of a hair relative to the strand.
const TINT: f32 = 0.3;
const GOLDEN: f32 = 0.618_034;

/// The number of hairs that a strand is drawn as.
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

    /// Maximum distance from the center of a strand at which it is drawn, relative to its width.
    pub fn reach(self) -> f32 {
        let share = 1.0 / self.count as f32;
        if self.is_one() { 0.5 } else { SPREAD * (1.0 - share) + STRAY + 0.5 * share }
    }

    /// The hairs of the segment from point `i` on, of a strand with `points` points.
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
        // A number for the strand, kept small so that later operations do not lose precision.
        let strand = (strand % 4096 * MOST as u32) as f32;
        // All possible hairs are computed, so that they fit into lanes.
        for k in 0..MOST {
            // Multiples of the golden ratio differ from those of neighbors in the wisp and in the groom.
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
    /// Fraction of the strand's width for each hair.
    share: f32,
    /// Unit of displacement across the strand at both ends [pixels].
    across: [Vec2; 2],
    /// Displacement of each hair at both ends, in that unit.
    ways: [[f32; 2]; MOST],
    /// Brightness of each hair relative to the strand.
    tints: [f32; MOST],
}

impl Hairs {
    /// Number of hairs.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.count
    }

    /// One hair of a piece of the segment. `along` is the start and end of the piece as fractions of the
    /// segment.
    #[inline(always)]
    pub fn piece(&self, hair: usize, piece: &Piece, along: [f32; 2]) -> Piece {
        let [from, to] = [0, 1].map(|end| self.across[end] * self.ways[hair][end]);
        let way = |u: f32| from + (to - from) * u;
        // The alpha component stays unchanged.
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

/// A wave from −1 to 1 with period 1, composed of parabolas.
#[inline(always)]
fn wave(x: f32) -> f32 {
    let x = x - x.floor() - 0.5;
    16.0 * x * (0.5 - x.abs())
}
