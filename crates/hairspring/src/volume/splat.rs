//! Points to lattice: mass, momentum, direction, energy and room to the corners of a point's cell.
//!
//! Sums are whole numbers, so that they have the same bits in any order, and each thread may have a grid of its own.

use super::grid_bounds::{GridBounds, GridTransform, Placed, nearest};
use crate::{
    simd::lanes::{LANES, Row},
    strand::tile::{StateRows, StrandRows, state},
};
use glam::{IVec3, Vec3};

/// What is known of one point of eight strands for good.
pub mod own {
    /// Mass over the largest of all points'; 0 for what is no point of a strand [1].
    pub const MASS: usize = 0;
    /// The part of the hair's rest volume that is the point's, a whole number of [`super::ROOM`]ths of a cell.
    pub const ROOM: usize = 1;
    /// Rows a point.
    pub const ROWS: usize = 2;
}

/// What is known of one point of eight strands for good.
pub type OwnRows = [Row; own::ROWS];

/// Units of room in a cell: a point's room, about an eighth of a cell, is then known to a ten thousandth at each corner, and to a tenth in cells ten times as
/// large.
pub const ROOM: f32 = 524288.0;

/// Speed that counts as no more [m/s]: one strand that is gone wild takes no digits from the others.
const FASTEST: f32 = 50.0;

/// Some tiles that follow each other.
#[derive(Clone, Copy)]
pub struct Tiles<'a> {
    /// Index of each one's first point, and of the first after the last.
    pub firsts: &'a [u32],
    /// Shape `[tiles]`.
    pub strand: &'a [StrandRows],
    /// Shape `[points]` of all tiles, as `own`.
    pub state: &'a [StateRows],
    /// Shape `[points]` of all tiles.
    pub own: &'a [OwnRows],
}

impl<'a> Tiles<'a> {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.strand.len()
    }

    /// Each tile's strands and points.
    pub fn iter(&self) -> impl Iterator<Item = (&'a StrandRows, &'a [StateRows], &'a [OwnRows])> {
        let (state, own) = (self.state, self.own);
        self.strand.iter().zip(self.firsts.windows(2)).map(move |(strand, first)| {
            let points = first[0] as usize..first[1] as usize;
            (strand, &state[points.clone()], &own[points])
        })
    }

    /// The `part`th of `parts` that are about as large.
    pub fn part(&self, part: usize, parts: usize) -> Self {
        let at = |k: usize| k * self.count() / parts;
        let (a, b) = (at(part), at(part + 1));
        Self { firsts: &self.firsts[a..=b], strand: &self.strand[a..b], ..*self }
    }
}

/// The box that points are in, that of their roots, and the fastest of them.
#[derive(Clone, Copy)]
pub struct Extent {
    /// Lowest corner [cells].
    pub lo: Vec3,
    /// Highest corner [cells].
    pub hi: Vec3,
    /// Lowest and highest corner of the roots' [cells].
    pub roots: [Vec3; 2],
    /// Largest component of a velocity relative to that of the roots, at most [`FASTEST`] [m/s].
    pub speed: f32,
}

/// The velocity that all are counted from: the middle of what those of the roots are [m/s]. Hair that is carried along at 5 m/s, and moves by 1 cm/s against its
/// neighbours, would lose the digits of that.
pub fn root_velocity(tiles: &Tiles) -> Vec3 {
    let (mut lo, mut hi) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for (_, state, own) in tiles.iter() {
        for lane in (0..LANES).filter(|lane| own[0][own::MASS].0[*lane] > 0.0) {
            let v = Vec3::from([0, 1, 2].map(|k: usize| state[0][state::V + k].0[lane]));
            if v.is_finite() {
                (lo, hi) = (lo.min(v), hi.max(v));
            }
        }
    }
    let middle = 0.5 * (lo + hi);
    if middle.is_finite() { middle } else { Vec3::ZERO }
}

impl Extent {
    /// Of no points.
    pub const NONE: Self = Self {
        lo: Vec3::INFINITY,
        hi: Vec3::NEG_INFINITY,
        roots: [Vec3::INFINITY, Vec3::NEG_INFINITY],
        speed: 0.0,
    };

    /// Of these points, velocities counted from `carried` [m/s]; what is not finite does not count.
    pub fn of(tiles: &Tiles, chart: &GridTransform, carried: Vec3) -> Self {
        let (mut lo, mut hi) = ([[f32::INFINITY; LANES]; 3], [[f32::NEG_INFINITY; LANES]; 3]);
        let mut speed = [0.0_f32; LANES];
        let mut roots = Self::NONE.roots;
        for (strand, state, own) in tiles.iter() {
            let mut places = chart.roots(strand, IVec3::ZERO);
            for lane in (0..LANES).filter(|lane| own[0][own::MASS].0[*lane] > 0.0) {
                let root = Vec3::from([0, 1, 2].map(|k: usize| places[k][lane]));
                if root.is_finite() {
                    roots = [roots[0].min(root), roots[1].max(root)];
                }
            }
            for (at, own) in state.iter().zip(own) {
                chart.walk(&mut places, at);
                for lane in 0..LANES {
                    let counts = own[own::MASS].0[lane] > 0.0;
                    for k in 0..3 {
                        let p = places[k][lane];
                        // Comparisons that a NaN fails.
                        lo[k][lane] = if counts & (p < lo[k][lane]) { p } else { lo[k][lane] };
                        hi[k][lane] = if counts & (p > hi[k][lane]) { p } else { hi[k][lane] };
                        let v = (at[state::V + k].0[lane] - carried[k]).abs();
                        speed[lane] = if counts & (v > speed[lane]) { v } else { speed[lane] };
                    }
                }
            }
        }
        let least = |row: [f32; LANES]| row.into_iter().fold(f32::INFINITY, f32::min);
        let most = |row: [f32; LANES]| row.into_iter().fold(f32::NEG_INFINITY, f32::max);
        Self { lo: lo.map(least).into(), hi: hi.map(most).into(), roots, speed: most(speed).min(FASTEST) }
    }

    /// Of the points of both.
    pub fn with(self, other: Self) -> Self {
        Self {
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
            roots: [self.roots[0].min(other.roots[0]), self.roots[1].max(other.roots[1])],
            speed: self.speed.max(other.speed),
        }
    }
}

/// The whole numbers that mass and momentum are counted in.
#[derive(Clone, Copy)]
pub struct Units {
    /// Units in the largest point's mass.
    pub mass: f32,
    /// Units of momentum of that mass at 1 m/s [s/m].
    pub momentum: f32,
    /// Units of m |v|² of that mass at 1 m/s [s²/m²].
    pub energy: f32,
    /// Largest component of a velocity relative to `carried` [m/s].
    pub speed: f32,
    /// The velocity that those of points are counted from [m/s].
    pub carried: Vec3,
}

/// Most units in a point: they are rounded by [`nearest`].
const MOST_UNITS: f32 = (1 << 21) as f32;

impl Units {
    /// As fine as they can be while a node could hold all `points`, of `total` mass over the largest one's, and none faster than `speed`
    /// [m/s] relative to `carried` [m/s]: the sum of what 320,000 points could leave in one node is below 2³¹, each to one part in 6,000.
    pub fn new(points: usize, total: f64, (speed, carried): (f32, Vec3)) -> Self {
        // Each may be rounded up by half a unit.
        let most = (f64::from(i32::MAX) - 0.5 * points as f64) / total.max(1.0);
        let mass = (most.max(1.0).log2().floor().exp2() as f32).min(MOST_UNITS);
        let speed = speed.max(f32::MIN_POSITIVE.sqrt());
        Self { mass, momentum: mass / speed, energy: mass / (3.0 * speed * speed), speed, carried }
    }
}

/// Sums at the nodes and cells of a window.
#[derive(Default)]
pub struct Sums {
    /// Of each node: momentum along x, y, z, mass, the sum of the directions of strands times their mass along x, y, z, and the sum of m |v|².
    pub nodes: Vec<i32>,
    /// Room of the points at each node.
    pub rooms: Vec<u32>,
}

/// Numbers a node.
pub const NODE: usize = 8;

impl Sums {
    /// Room for so many nodes ever.
    pub fn reserve(&mut self, nodes: usize) {
        self.nodes.reserve_exact((nodes * NODE).saturating_sub(self.nodes.len()));
        self.rooms.reserve_exact(nodes.saturating_sub(self.rooms.len()));
    }

    /// So many nodes, all 0.
    pub fn clear(&mut self, nodes: usize) {
        self.nodes.clear();
        self.nodes.resize(nodes * NODE, 0);
        self.rooms.clear();
        self.rooms.resize(nodes, 0);
    }

    /// Adds points to the nodes of `window`.
    pub fn add(&mut self, tiles: &Tiles, chart: &GridTransform, window: &GridBounds, units: &Units) {
        let [_, _, row, _, slab, _, both, _] = window.corners();
        let (per_speed, per_energy) = (units.momentum / units.mass, units.energy / units.mass);
        for (strand, state, own) in tiles.iter() {
            let mut places = chart.roots(strand, window.lo);
            for (at, own) in state.iter().zip(own) {
                chart.walk(&mut places, at);
                let placed = Placed::new(&places, window);
                // Momentum, mass, direction and energy, and room, of eight points.
                let mut there = placed.inside;
                for k in 0..3 {
                    let Row(v) = &at[state::V + k];
                    for lane in 0..LANES {
                        // 0 for finite numbers, else NaN.
                        there[lane] = if v[lane] * 0.0 == 0.0 { there[lane] } else { 0.0 };
                    }
                }
                let mut counted = [[0.0; LANES]; NODE];
                let mut room = [0.0; LANES];
                for lane in 0..LANES {
                    counted[3][lane] = own[own::MASS].0[lane] * there[lane] * units.mass;
                    room[lane] = own[own::ROOM].0[lane] * there[lane];
                    let edge = [0, 1, 2].map(|k: usize| at[state::EDGE + k].0[lane]);
                    let length = (edge[0] * edge[0] + edge[1] * edge[1] + edge[2] * edge[2]).sqrt();
                    // The edge to a root has no direction.
                    let share = if length > 0.0 { counted[3][lane] / length } else { 0.0 };
                    for k in 0..3 {
                        counted[4 + k][lane] = if there[lane] > 0.0 { edge[k] * share } else { 0.0 };
                    }
                }
                for k in 0..3 {
                    let Row(v) = &at[state::V + k];
                    for lane in 0..LANES {
                        let v = v[lane] - units.carried[k];
                        let high = if v < units.speed { v } else { units.speed };
                        let v = if high > -units.speed { high } else { -units.speed };
                        counted[k][lane] = v * (counted[3][lane] * per_speed);
                        counted[7][lane] += v * v * (counted[3][lane] * per_energy);
                    }
                }
                for lane in 0..LANES {
                    let cell = placed.cell[lane] as usize;
                    let point: [f32; NODE] = std::array::from_fn(|k| counted[k][lane]);
                    for (k, corner) in [0, row, slab, both].into_iter().enumerate() {
                        let Some(pair) =
                            self.nodes[(cell + corner) * NODE..].first_chunk_mut::<{ 2 * NODE }>()
                        else {
                            continue;
                        };
                        let [a, b] = [placed.weights[2 * k][lane], placed.weights[2 * k + 1][lane]];
                        for c in 0..NODE {
                            pair[c] = pair[c].wrapping_add(nearest(point[c] * a));
                        }
                        for c in 0..NODE {
                            pair[NODE + c] = pair[NODE + c].wrapping_add(nearest(point[c] * b));
                        }
                        for (sum, weight) in self.rooms[cell + corner..].iter_mut().zip([a, b]) {
                            *sum = sum.saturating_add(nearest(room[lane] * weight) as u32);
                        }
                    }
                }
            }
        }
    }
}
