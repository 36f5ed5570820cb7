//! Splats points to the grid: mass, momentum, direction, energy and rest volume are distributed to the
//! corners of a point's cell.
//!
//! Sums are integers, so the result is bitwise identical in any order, and each thread can have its own grid.

use super::grid_bounds::{GridBounds, GridTransform, Placed, nearest};
use crate::{
    simd::lanes::{LANES, Row},
    strand::tile::{RootRows, StateRows, state},
};
use glam::{IVec3, Vec3};

/// Constant data of a point of eight strands.
pub mod own {
    /// Mass relative to the largest point's; 0 for particles that are not points of a strand [1].
    pub const MASS: usize = 0;
    /// Rest volume of the point, an integer in units of 1/[`super::REST_VOLUME_UNITS`] of a cell.
    pub const REST_VOLUME: usize = 1;
    /// Number of rows per point.
    pub const ROWS: usize = 2;
}

/// Constant data of a point of eight strands.
pub type OwnRows = [Row; own::ROWS];

/// Units of rest volume per cell. A typical point has an eighth of a cell, so its contribution to each corner
/// is accurate to 1/10,000, and to a tenth if cells are ten times as large.
pub const REST_VOLUME_UNITS: f32 = 524288.0;

/// Limit of the speed [m/s], so that a single unstable strand does not reduce the precision of the others.
const MAX_SPEED: f32 = 50.0;

/// A range of consecutive tiles.
#[derive(Clone, Copy)]
pub struct Tiles<'a> {
    /// Index of each tile's first point, followed by the end.
    pub firsts: &'a [u32],
    /// Shape `[tiles]`.
    pub roots: &'a [RootRows],
    /// Shape `[points]` of all tiles, like `own`.
    pub state: &'a [StateRows],
    /// Shape `[points]` of all tiles.
    pub own: &'a [OwnRows],
}

impl<'a> Tiles<'a> {
    /// Returns the number of tiles.
    pub fn count(&self) -> usize {
        self.roots.len()
    }

    /// Iterates over each tile's strands and points.
    pub fn iter(&self) -> impl Iterator<Item = (&'a RootRows, &'a [StateRows], &'a [OwnRows])> {
        let (state, own) = (self.state, self.own);
        self.roots.iter().zip(self.firsts.windows(2)).map(move |(roots, first)| {
            let points = first[0] as usize..first[1] as usize;
            (roots, &state[points.clone()], &own[points])
        })
    }

    /// Returns one of `parts` parts of about equal size.
    pub fn part(&self, part: usize, parts: usize) -> Self {
        let at = |k: usize| k * self.count() / parts;
        let (a, b) = (at(part), at(part + 1));
        Self { firsts: &self.firsts[a..=b], roots: &self.roots[a..b], ..*self }
    }
}

/// Bounding box of the points, bounding box of their roots, and the maximum speed.
#[derive(Clone, Copy)]
pub struct Extent {
    /// Lowest corner [cells].
    pub lo: Vec3,
    /// Highest corner [cells].
    pub hi: Vec3,
    /// Lowest and highest corner of the roots' box [cells].
    pub roots: [Vec3; 2],
    /// Largest component of a velocity relative to `carried`, at most [`MAX_SPEED`] [m/s].
    pub speed: f32,
}

/// Returns the reference velocity: the midpoint of the range of the roots' velocities [m/s]. Without it, hair
/// that moves at 5 m/s with the head and by 1 cm/s relative to its neighbors would lose the precision of the
/// latter.
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
    /// The extent of no points.
    pub const NONE: Self = Self {
        lo: Vec3::INFINITY,
        hi: Vec3::NEG_INFINITY,
        roots: [Vec3::INFINITY, Vec3::NEG_INFINITY],
        speed: 0.0,
    };

    /// Computes the extent of these points, with velocities relative to `carried` [m/s]. Values that are not
    /// finite are ignored.
    pub fn of(tiles: &Tiles, transform: &GridTransform, carried: Vec3) -> Self {
        let (mut lo, mut hi) = ([[f32::INFINITY; LANES]; 3], [[f32::NEG_INFINITY; LANES]; 3]);
        let mut speed = [0.0_f32; LANES];
        let mut roots = Self::NONE.roots;
        for (motion, state, own) in tiles.iter() {
            let mut places = transform.roots(motion, IVec3::ZERO);
            for lane in (0..LANES).filter(|lane| own[0][own::MASS].0[*lane] > 0.0) {
                let root = Vec3::from([0, 1, 2].map(|k: usize| places[k][lane]));
                if root.is_finite() {
                    roots = [roots[0].min(root), roots[1].max(root)];
                }
            }
            for (at, own) in state.iter().zip(own) {
                transform.advance(&mut places, at);
                for lane in 0..LANES {
                    let counts = own[own::MASS].0[lane] > 0.0;
                    for k in 0..3 {
                        let p = places[k][lane];
                        // Comparisons that are false for a NaN.
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
        Self { lo: lo.map(least).into(), hi: hi.map(most).into(), roots, speed: most(speed).min(MAX_SPEED) }
    }

    /// Returns the extent of the points of both.
    pub fn with(self, other: Self) -> Self {
        Self {
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
            roots: [self.roots[0].min(other.roots[0]), self.roots[1].max(other.roots[1])],
            speed: self.speed.max(other.speed),
        }
    }
}

/// Integer units in which mass and momentum are counted.
#[derive(Clone, Copy)]
pub struct Units {
    /// Number of units in the largest point's mass.
    pub mass: f32,
    /// Units of momentum of that mass at 1 m/s [s/m].
    pub momentum: f32,
    /// Units of m |v|² of that mass at 1 m/s [s²/m²].
    pub energy: f32,
    /// Largest component of a velocity relative to `carried` [m/s].
    pub speed: f32,
    /// Reference velocity of the points [m/s].
    pub carried: Vec3,
}

/// Maximum number of units in a point, since [`nearest`] rounds them.
const MAX_UNITS: f32 = (1 << 21) as f32;

impl Units {
    /// Chooses units as fine as possible without overflow, even if one node held all `points`, with a `total`
    /// mass relative to the largest, and speeds up to `speed` [m/s] relative to `carried` [m/s]. The sum of
    /// 320,000 points in one node stays below 2³¹, with a precision of one part in 6,000 for each.
    pub fn new(points: usize, total: f64, (speed, carried): (f32, Vec3)) -> Self {
        // Each may be rounded up by half a unit.
        let most = (f64::from(i32::MAX) - 0.5 * points as f64) / total.max(1.0);
        let mass = (most.max(1.0).log2().floor().exp2() as f32).min(MAX_UNITS);
        let speed = speed.max(f32::MIN_POSITIVE.sqrt());
        Self { mass, momentum: mass / speed, energy: mass / (3.0 * speed * speed), speed, carried }
    }
}

/// Sums at the nodes of the grid bounds.
#[derive(Default)]
pub struct Sums {
    /// For each node: momentum along x, y, z; mass; the mass-weighted sum of strand directions along x, y, z;
    /// the sum of m |v|².
    pub nodes: Vec<i32>,
    /// Rest volume of the points at each node.
    pub rest_volumes: Vec<u32>,
}

/// Number of values per node.
pub const VALUES_PER_NODE: usize = 8;

impl Sums {
    /// Reserves memory for at most `nodes` nodes.
    pub fn reserve(&mut self, nodes: usize) {
        self.nodes.reserve_exact((nodes * VALUES_PER_NODE).saturating_sub(self.nodes.len()));
        self.rest_volumes.reserve_exact(nodes.saturating_sub(self.rest_volumes.len()));
    }

    /// Resizes to `nodes` nodes and sets all sums to 0.
    pub fn clear(&mut self, nodes: usize) {
        self.nodes.clear();
        self.nodes.resize(nodes * VALUES_PER_NODE, 0);
        self.rest_volumes.clear();
        self.rest_volumes.resize(nodes, 0);
    }

    /// Adds points to the nodes of `bounds`.
    pub fn add(&mut self, tiles: &Tiles, transform: &GridTransform, bounds: &GridBounds, units: &Units) {
        let [_, _, row, _, slab, _, both, _] = bounds.corners();
        let (per_speed, per_energy) = (units.momentum / units.mass, units.energy / units.mass);
        for (roots, state, own) in tiles.iter() {
            let mut places = transform.roots(roots, bounds.lo);
            for (at, own) in state.iter().zip(own) {
                transform.advance(&mut places, at);
                let placed = Placed::new(&places, bounds);
                // Momentum, mass, direction, energy and rest volume of eight points.
                let mut there = placed.inside;
                for k in 0..3 {
                    let Row(v) = &at[state::V + k];
                    for lane in 0..LANES {
                        // 0 for finite numbers, else NaN.
                        there[lane] = if v[lane] * 0.0 == 0.0 { there[lane] } else { 0.0 };
                    }
                }
                let mut counted = [[0.0; LANES]; VALUES_PER_NODE];
                let mut rest_volume = [0.0; LANES];
                for lane in 0..LANES {
                    counted[3][lane] = own[own::MASS].0[lane] * there[lane] * units.mass;
                    rest_volume[lane] = own[own::REST_VOLUME].0[lane] * there[lane];
                    let edge = [0, 1, 2].map(|k: usize| at[state::EDGE + k].0[lane]);
                    let length = (edge[0] * edge[0] + edge[1] * edge[1] + edge[2] * edge[2]).sqrt();
                    // The edge vector to a root has no direction.
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
                    let point: [f32; VALUES_PER_NODE] = std::array::from_fn(|k| counted[k][lane]);
                    for (k, corner) in [0, row, slab, both].into_iter().enumerate() {
                        let Some(pair) = self.nodes[(cell + corner) * VALUES_PER_NODE..]
                            .first_chunk_mut::<{ 2 * VALUES_PER_NODE }>()
                        else {
                            continue;
                        };
                        let [a, b] = [placed.weights[2 * k][lane], placed.weights[2 * k + 1][lane]];
                        for c in 0..VALUES_PER_NODE {
                            pair[c] = pair[c].wrapping_add(nearest(point[c] * a));
                        }
                        for c in 0..VALUES_PER_NODE {
                            pair[VALUES_PER_NODE + c] =
                                pair[VALUES_PER_NODE + c].wrapping_add(nearest(point[c] * b));
                        }
                        for (sum, weight) in self.rest_volumes[cell + corner..].iter_mut().zip([a, b]) {
                            *sum = sum.saturating_add(nearest(rest_volume[lane] * weight) as u32);
                        }
                    }
                }
            }
        }
    }
}
