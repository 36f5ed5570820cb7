//! Assignment of strands to tiles of eight.
//!
//! The strands of a tile share an elastic model and a precision, have similar numbers of points, and are
//! neighbors in space. Neighbors have contacts at the same time, so little work is wasted where the kernel
//! runs a step for all eight because one needs it. They also access the same part of a distance field and of
//! the volume grid. The assignment does not change results, because the lanes of a tile are independent.

use crate::{
    groom::{Groom, MortonCurve},
    simd::lanes::LANES,
    strand::tile::Elastic,
};
use std::cmp::Reverse;

/// Assignment of strands to lanes.
pub(super) struct Order {
    /// Index of the groom's strand in every lane, `u32::MAX` where there is none; shape `[tiles * LANES]`.
    pub groom_strands: Vec<u32>,
    /// Index into the requested strands for each lane, `u32::MAX` where there is none; shape `[tiles *
    /// LANES]`.
    pub strand_of_lane: Vec<u32>,
    /// The lane of each requested strand; shape `[strands]`.
    pub lane_of_strand: Vec<u32>,
    /// The elastic model of each tile, and whether the tile is solved in double precision.
    pub models: Vec<(Elastic, bool)>,
}

impl Order {
    /// Assigns `strands` (indices of `groom`). `elastic` holds the model of each, and whether it is solved in
    /// double precision.
    pub fn new(groom: &Groom, strands: &[u32], elastic: &[(Elastic, bool)]) -> Self {
        // Strands are compared by their middle points, because roots are close together.
        let middle = |s: u32| {
            let points = groom.strand(s as usize);
            points[points.len() / 2]
        };
        let curve = MortonCurve::covering_points(strands.iter().map(|s| middle(*s)));
        let mut order: Vec<u32> = (0..strands.len() as u32).collect();
        order.sort_by_cached_key(|k| {
            let strand = strands[*k as usize];
            let points = groom.range(strand as usize).len();
            (elastic[*k as usize], Reverse(points), curve.index(middle(strand)))
        });
        let mut lane_of_strand = vec![0; strands.len()];
        let mut strand_of_lane: Vec<u32> = Vec::with_capacity(strands.len().next_multiple_of(LANES));
        let mut models = Vec::new();
        for k in order {
            let model = elastic[k as usize];
            if models.last().is_some_and(|last| *last != model) {
                strand_of_lane.resize(strand_of_lane.len().next_multiple_of(LANES), u32::MAX);
            }
            if strand_of_lane.len().is_multiple_of(LANES) {
                models.push(model);
            }
            lane_of_strand[k as usize] = strand_of_lane.len() as u32;
            strand_of_lane.push(k);
        }
        strand_of_lane.resize(strand_of_lane.len().next_multiple_of(LANES), u32::MAX);
        let groom_strands =
            strand_of_lane.iter().map(|k| strands.get(*k as usize).copied().unwrap_or(u32::MAX)).collect();
        Self { groom_strands, strand_of_lane, lane_of_strand, models }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Strands with these numbers of points, each at its position along x.
    fn groom(strands: &[(usize, f32)]) -> Groom {
        let strand = |(points, x): &(usize, f32)| {
            let x = *x;
            (0..*points).map(|i| Vec3::new(x, -0.01 * i as f32, 0.0)).collect::<Vec<_>>()
        };
        Groom::from_strands(strands.iter().map(strand), 35e-6)
    }

    #[test]
    fn neighbours_of_like_counts_share_a_tile() {
        // Alternating between two places, as a file may have them. One strand in nine has more points.
        let strands: Vec<(usize, f32)> =
            (0..36).map(|k| (if k % 9 == 0 { 12 } else { 8 }, if k % 2 == 0 { -0.1 } else { 0.1 })).collect();
        let groom = groom(&strands);
        let all: Vec<u32> = (0..36).collect();
        let order = Order::new(&groom, &all, &[(Elastic::Rod, false); 36]);
        assert_eq!(order.models, [(Elastic::Rod, false); 5]);
        let tiles: Vec<&[u32]> = order.groom_strands.chunks(LANES).collect();
        for s in [0, 9, 18, 27] {
            assert!(tiles[0].contains(&s), "the four of 12 points come first: {:?}", tiles[0]);
        }
        for tile in &tiles[1..4] {
            let sides = tile.iter().filter(|s| **s != u32::MAX).map(|s| s % 2);
            assert!(sides.clone().min() == sides.max() || *tile == tiles[2], "{tile:?}");
        }
        for (k, place) in order.lane_of_strand.iter().enumerate() {
            assert_eq!(order.groom_strands[*place as usize], k as u32);
        }
    }

    #[test]
    fn a_tile_has_one_model() {
        let groom = groom(&[(8, 0.0); 5]);
        let elastic = [Elastic::Rod, Elastic::Springs, Elastic::Rod, Elastic::Springs, Elastic::Rod]
            .map(|model| (model, false));
        let order = Order::new(&groom, &[4, 3, 2, 1, 0], &elastic);
        assert_eq!(order.models.len(), 2);
        for (k, strand) in [4, 3, 2, 1, 0].into_iter().enumerate() {
            let place = order.lane_of_strand[k] as usize;
            assert_eq!((order.groom_strands[place], order.models[place / LANES]), (strand, elastic[k]));
        }
        assert_eq!(order.groom_strands.iter().filter(|s| **s == u32::MAX).count(), 11);
    }

    #[test]
    fn nothing_is_in_order() {
        let order = Order::new(&Groom::default(), &[], &[]);
        assert!(order.groom_strands.is_empty() && order.lane_of_strand.is_empty() && order.models.is_empty());
    }
}
