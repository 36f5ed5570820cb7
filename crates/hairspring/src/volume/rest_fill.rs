//! Fill of the cells that hair at rest occupies, in a sparse grid.
//!
//! These cells are as fine as the hair and not enlarged where hair is in places far apart, so a dense grid of them would
//! have no bound. The memory of this one is in proportion to the number of points.

use super::{
    grid_bounds::{GridTransform, lowest_corner, nearest, trilinear},
    splat::{REST_VOLUME_UNITS, Tiles, own},
};
use crate::simd::lanes::LANES;
use glam::{IVec3, Vec3};
use std::collections::HashMap;

/// Fill of the cells of a grid that hold points.
pub struct RestFill(HashMap<IVec3, f32>);

impl RestFill {
    /// Computes the fill from the rest volumes of the points. Cells are counted from the node `lo`.
    pub fn new(tiles: &Tiles, transform: &GridTransform, lo: IVec3) -> Self {
        // Integer sums, which are the same in any order.
        let mut cells: HashMap<IVec3, [u32; 8]> = HashMap::new();
        for (roots, state, own) in tiles.iter() {
            let mut places = transform.roots(roots, lo);
            for (at, own) in state.iter().zip(own) {
                transform.advance(&mut places, at);
                for lane in 0..LANES {
                    let (rest_volume, at) = (own[own::REST_VOLUME].0[lane], point(&places, lane));
                    if rest_volume > 0.0 && at.is_finite() {
                        let cell = cell(at);
                        let sums = cells.entry(cell).or_default();
                        for (sum, weight) in sums.iter_mut().zip(trilinear((at - cell.as_vec3()).to_array()))
                        {
                            *sum = sum.saturating_add(nearest(rest_volume * weight) as u32);
                        }
                    }
                }
            }
        }
        let mut nodes: HashMap<IVec3, u32> = HashMap::new();
        for (cell, sums) in &cells {
            for (corner, sum) in corners(*cell).zip(sums) {
                let node = nodes.entry(corner).or_default();
                *node = node.saturating_add(*sum);
            }
        }
        let rest_volume = |node: IVec3| nodes[&node] as f32 * (1.0 / REST_VOLUME_UNITS);
        Self(cells.into_keys().map(|c| (c, 0.125 * corners(c).map(rest_volume).sum::<f32>())).collect())
    }

    /// Returns the fill of the cell that contains `at`, relative to the node `lo` [cells]; 0 if it is empty.
    pub fn at(&self, at: Vec3) -> f32 {
        if at.is_finite() { self.0.get(&cell(at)).copied().unwrap_or(0.0) } else { 0.0 }
    }
}

/// Returns the position of one of eight points.
pub fn point(places: &[[f32; LANES]; 3], lane: usize) -> Vec3 {
    Vec3::from(places.map(|row| row[lane]))
}

/// Returns the lowest corner of the cell that contains a finite point.
fn cell(at: Vec3) -> IVec3 {
    IVec3::from(at.to_array().map(|x| nearest(lowest_corner(x))))
}

/// Returns the corners of a cell; x fastest, then y, then z.
fn corners(cell: IVec3) -> impl Iterator<Item = IVec3> {
    (0..8).map(move |k| cell + IVec3::new(k & 1, k >> 1 & 1, k >> 2))
}
