//! The strands of consecutive tiles, as external forces see them.

use super::{FrameMotion, StrandView};
use crate::{
    simd::lanes::{LANES, Row},
    strand::{
        tile::{RestRows, RootRows, StateRows, StrandRows, TileLayout, anisotropic_drag, position_spring},
        tile_arrays::{access, tile_arrays},
    },
};

tile_arrays! {
    /// Eight strands, with the force buffers of their points.
    tile ForceTile;
    /// A range of tiles, with the force buffers of their points.
    range StrandBatch;
    per tile {
        /// Index in the groom of the strand in each lane; `u32::MAX` in unused lanes.
        lanes: shared [u32; LANES],
        roots: shared RootRows,
        strand: shared StrandRows,
    }
    per point {
        rest: shared RestRows,
        /// See [`StrandView::air_cell`]; empty if no air is carried.
        air_cell: shared [u32; LANES],
        state: shared StateRows,
        external_acceleration: unique [Row; 3],
        position_spring: unique [Row; position_spring::ROWS],
        anisotropic_drag: unique [Row; anisotropic_drag::ROWS],
        wind_delta: unique [Row; 3],
    }
}

/// Number of tiles that one task processes.
const TILES_PER_TASK: usize = 32;

impl StrandBatch<'_> {
    /// Calls `act` for every strand, in parallel.
    pub fn each(&mut self, frame: &FrameMotion, act: &(impl Fn(&mut StrandView) + Sync)) {
        let count = self.tiles.len();
        if count > TILES_PER_TASK {
            let (mut a, mut b) = self.reborrow().split(count / 2);
            crate::parallel::join(|| a.each(frame, act), || b.each(frame, act));
            return;
        }
        for k in 0..count {
            let mut tile = self.tile(k);
            for lane in 0..LANES {
                let strand = tile.lanes[lane];
                if strand != u32::MAX {
                    act(&mut StrandView { strand: strand as usize, frame, lane, tile: tile.reborrow() });
                }
            }
        }
    }
}
