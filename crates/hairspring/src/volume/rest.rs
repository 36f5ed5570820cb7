//! Measurements at rest, made once: the cell size, each point's rest volume, and the fill of each cell.

use super::{
    field::Field,
    grid_bounds::{GridBounds, GridTransform},
    rest_fill::{RestFill, point},
    splat::{Extent, OwnRows, REST_VOLUME_UNITS, Sums, Tiles, Units, own},
};
use crate::parallel::prelude::*;
use crate::{
    math::RigidTransform,
    simd::lanes::LANES,
    strand::tile::{RootRows, StateRows},
};
use glam::{IVec3, Vec3};

/// Mean number of points that an occupied cell should hold at rest. A cell and its neighbors then contain
/// about 150 points, whose number varies by 8 % if they are placed at random.
const POINTS_A_CELL: f32 = 8.0;

/// Largest rest volume of a point [cells]: a single point fills its own cell and a third of the surrounding
/// ones.
const MAX_REST_VOLUME: f32 = 4.0;

/// Fill ratio above which a cell counts as overfull [1]. It exceeds the variation from hair that moves
/// through the cells, and is hardly visible.
const SLACK: f32 = 1.1;

/// Factor by which a cell grows until it holds enough points [1].
pub const CELL_GROWTH: f32 = 1.1;

/// Largest number of tries at a cell size: the last cell is 400 times as large as the first.
const MAX_TRIES: usize = 64;

/// Bits of a cell's coordinate in its key. Three coordinates fit in 64 bits. Coordinates that differ by a multiple of
/// 2²¹ cells share a key.
const KEY_BITS: u32 = 21;

/// The distribution of hair at rest.
pub struct RestSpacing {
    /// Smallest cell that holds [`POINTS_A_CELL`] points on average and is no smaller than the mean segment
    /// [m].
    pub cell: f32,
    /// Distance of adjacent strands [m].
    pub spacing: f32,
}

impl RestSpacing {
    /// Measures the distribution of hair at rest, with a mean segment of `segment` [m], above 0.
    ///
    /// The spacing is that of the strands around an average point. With N points in a cell of edge c, the length
    /// of other strands per volume around it is n = ℓ Σ N (N − 1) / (c³ Σ N). Then n strands pass through a unit
    /// cross-section, at a spacing of 1/√n.
    pub fn measure(tiles: &Tiles, anchor: &RigidTransform, segment: f32) -> Self {
        let (mut cell, mut spacing) = (segment, segment);
        let mut occupied: Vec<u64> = Vec::new();
        for _ in 0..MAX_TRIES {
            let transform = GridTransform::new(anchor, cell);
            occupied.clear();
            for (roots, state, own) in tiles.iter() {
                let mut places = transform.roots(roots, IVec3::ZERO);
                for (at, own) in state.iter().zip(own) {
                    transform.advance(&mut places, at);
                    for lane in (0..LANES).filter(|lane| own[own::MASS].0[*lane] > 0.0) {
                        let mask = (1 << KEY_BITS) - 1;
                        let key = |k: usize| (places[k][lane].floor() as i64 & mask) as u64;
                        occupied.push(key(2) << (2 * KEY_BITS) | key(1) << KEY_BITS | key(0));
                    }
                }
            }
            let points = occupied.len() as f32;
            occupied.par_sort_unstable();
            let cells = || occupied.chunk_by(|a, b| a == b).map(|cell| cell.len() as f64);
            let (count, pairs) = (cells().count(), cells().map(|n| n * (n - 1.0)).sum::<f64>());
            let density = segment * pairs as f32 / (cell.powi(3) * points);
            spacing = density.sqrt().recip().min(cell);
            if points >= POINTS_A_CELL * count as f32 || count <= 1 {
                break;
            }
            cell *= CELL_GROWTH;
        }
        Self { cell, spacing }
    }
}

/// The strands whose rest volumes are computed.
pub struct StrandsAtRest<'a> {
    /// Shape `[tiles]`.
    pub roots: &'a [RootRows],
    /// Shape `[points]` of all tiles.
    pub state: &'a [StateRows],
    /// Index of each tile's first point, followed by the end.
    pub firsts: &'a [u32],
}

/// The cells that hair at rest fills.
pub struct RestCells<'a> {
    /// Pose of the anchor, in whose space the cells are.
    pub anchor: &'a RigidTransform,
    /// Edge of the grid's cells [m].
    pub grid: f32,
    /// Edge of the cells that hair at rest occupies [m].
    pub fine: f32,
}

/// Fill of the cells at rest, where that is above 1.
#[derive(Default)]
pub struct Rest {
    bounds: GridBounds,
    fill: Vec<f32>,
}

impl Rest {
    /// Returns the excess of a cell of `bounds` with this fill over the allowed fill; 0 or less if there is
    /// none [1].
    pub fn over_density(&self, bounds: &GridBounds, cell: usize, fill: f32) -> f32 {
        let at = if *bounds == self.bounds { Some(cell) } else { self.bounds.index(bounds.place(cell)) };
        fill - SLACK * at.map_or(1.0, |at| self.fill[at].max(1.0))
    }

    /// Computes the rest volume of every point, such that hair at rest fills the cells that it occupies.
    /// These are cells of `cells.fine` [m], or of the grid if they are smaller. Then stores the fill of the grid's
    /// cells at rest. `sums` and `field` are working memory.
    ///
    /// A rest volume should be the space between strands, wherever the bundle lies in the grid. Rest volumes
    /// are therefore not chosen to fill larger cells, which hair occupies only partly. For the same reason
    /// they are computed in a single pass, from the fill with equal rest volumes, and not iterated until
    /// cells at the surface are as full as those inside.
    pub fn measure(
        &mut self,
        StrandsAtRest { roots, state, firsts }: StrandsAtRest,
        own: &mut [OwnRows],
        RestCells { anchor, grid: cell, fine }: RestCells,
        (sums, field): (&mut Sums, &mut Field),
    ) {
        let fine = cell.min(fine);
        let transform = GridTransform::new(anchor, fine);
        // Volume of a fine cell in units of the grid's cell.
        let share = (fine / cell).powi(3);
        let tiles = Tiles { firsts, roots, state, own };
        let Some(GridBounds { lo, .. }) = bounds(&tiles, &transform) else { return };
        let fill_at_rest = RestFill::new(&tiles, &transform, lo);
        for (rows, first) in roots.iter().zip(firsts.windows(2)) {
            let mut places = transform.roots(rows, lo);
            for i in first[0] as usize..first[1] as usize {
                transform.advance(&mut places, &state[i]);
                let rest_volumes = own[i][own::REST_VOLUME].0.iter_mut().enumerate();
                for (lane, rest_volume) in rest_volumes.filter(|(_, rest_volume)| **rest_volume > 0.0) {
                    let fill = fill_at_rest.at(point(&places, lane));
                    if fill > 0.0 {
                        *rest_volume = ((*rest_volume / fill).min(MAX_REST_VOLUME * REST_VOLUME_UNITS)
                            * share)
                            .round()
                            .max(1.0);
                    }
                }
            }
        }
        let transform = GridTransform::new(anchor, cell);
        let Some(bounds) = fill(&Tiles { firsts, roots, state, own }, &transform, sums, field) else {
            return;
        };
        self.bounds = bounds;
        self.fill.clone_from(&field.fill);
    }
}

/// Returns the bounds of the hair, or `None` if there is none.
fn bounds(tiles: &Tiles, transform: &GridTransform) -> Option<GridBounds> {
    let extent = Extent::of(tiles, transform, Vec3::ZERO);
    (extent.lo.is_finite() && extent.hi.is_finite()).then(|| GridBounds::around(extent.lo, extent.hi))
}

/// Computes the fill of the cells. Returns the bounds of the hair, or `None` if there is none.
fn fill(tiles: &Tiles, transform: &GridTransform, sums: &mut Sums, field: &mut Field) -> Option<GridBounds> {
    let bounds = bounds(tiles, transform)?;
    // Only the rest volumes are used here, so any unit of mass will do.
    let units = Units { mass: 1.0, momentum: 0.0, energy: 0.0, speed: 0.0, carried: Vec3::ZERO };
    sums.clear(bounds.nodes());
    sums.add(tiles, transform, &bounds, &units);
    field.collect(bounds, &units, std::slice::from_ref(sums));
    Some(bounds)
}

/// Returns the box that strands of at most `length` can reach, if their roots are in the box (`lo`, `hi`).
pub fn reach((lo, hi): (Vec3, Vec3), length: f32) -> (Vec3, Vec3) {
    (lo - length, hi + length)
}
