//! What is measured once, at rest: the cell, each point's part of the hair's volume, and how full each cell is.

use super::{
    field::Field,
    grid_bounds::{GridBounds, GridTransform, Placed},
    splat::{Extent, OwnRows, ROOM, Sums, Tiles, Units, own},
};
use crate::{
    math::RigidTransform,
    simd::lanes::LANES,
    strand::tile::{StateRows, StrandRows},
};
use glam::{IVec3, Vec3};
use rayon::prelude::*;

/// Points that a cell with any should hold at rest, in the mean: the sum over a cell and its neighbours is then of some 150 points, and
/// rough to 8 % if they lie at random.
const POINTS_A_CELL: f32 = 8.0;

/// Largest room of a point [cells]: a lone one fills its own cell and a third of what is around it.
const MOST_ROOM: f32 = 4.0;

/// What may be fuller than at rest before it counts [1]: above what cells are filled unevenly by where they lie in hair that moves through them, and hardly seen.
const SLACK: f32 = 1.1;

/// How hair lies at rest.
pub struct Grain {
    /// The smallest cell that holds [`POINTS_A_CELL`] points, and is no smaller than the mean segment [m].
    pub cell: f32,
    /// Distance of neighbouring strands [m].
    pub spacing: f32,
}

/// How hair with a mean segment of `segment` [m], above 0, lies at rest.
///
/// The spacing is that of the strands around the mean point: with N points in a cell of edge c, n = ℓ Σ N (N − 1) / (c³ Σ N) is the length of
/// the others' strands per volume around it, whose cross-section each shares with n others: 1/√n apart.
pub fn grain(tiles: &Tiles, anchor: &RigidTransform, segment: f32) -> Grain {
    let (mut cell, mut spacing) = (segment, segment);
    let mut occupied: Vec<u64> = Vec::new();
    for _ in 0..64 {
        let chart = GridTransform::new(anchor, cell);
        occupied.clear();
        for (strand, state, own) in tiles.iter() {
            let mut places = chart.roots(strand, IVec3::ZERO);
            for (at, own) in state.iter().zip(own) {
                chart.walk(&mut places, at);
                for lane in (0..LANES).filter(|lane| own[own::MASS].0[*lane] > 0.0) {
                    let key = |k: usize| (places[k][lane].floor() as i64 & 0x1f_ffff) as u64;
                    occupied.push(key(2) << 42 | key(1) << 21 | key(0));
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
        cell *= 1.1;
    }
    Grain { cell, spacing }
}

/// How full cells are at rest, where that is more than full.
#[derive(Default)]
pub struct Rest {
    window: GridBounds,
    fill: Vec<f32>,
}

impl Rest {
    /// How much fuller than it may be a cell of `window` is, when it is this full; 0 or less: it is not [1].
    pub fn over_density(&self, window: &GridBounds, cell: usize, fill: f32) -> f32 {
        let at = if *window == self.window { Some(cell) } else { self.window.index(window.place(cell)) };
        fill - SLACK * at.map_or(1.0, |at| self.fill[at].max(1.0))
    }

    /// Gives every point its room, such that hair at rest fills the cells of `grain` [m] that it is in, or those of the lattice where they are smaller, and
    /// remembers how full those of the lattice are, of `cell` [m].
    ///
    /// Rooms are to be what is between strands, wherever a bundle goes in the lattice. So they are not such that larger cells are full, all of each that hair
    /// reaches into; and they are found once, by how full cells are when all rooms are the same, and not until those at the surface are as full as those inside.
    pub fn measure(
        &mut self,
        tiles: (&[StrandRows], &[StateRows], &[u32]),
        own: &mut [OwnRows],
        (anchor, cell, grain): (&RigidTransform, f32, f32),
        (sums, field): (&mut Sums, &mut Field),
    ) {
        let (strand, state, firsts) = tiles;
        let fine = cell.min(grain);
        let chart = GridTransform::new(anchor, fine);
        // What is a cell of the fine lattice, in the lattice's.
        let share = (fine / cell).powi(3);
        let Some(window) = fill(&Tiles { firsts, strand, state, own }, &chart, sums, field) else { return };
        for (rows, first) in strand.iter().zip(firsts.windows(2)) {
            let mut places = chart.roots(rows, window.lo);
            for i in first[0] as usize..first[1] as usize {
                chart.walk(&mut places, &state[i]);
                let placed = Placed::new(&places, &window);
                let room = &mut own[i][own::ROOM].0;
                for (room, cell) in room.iter_mut().zip(placed.cell) {
                    let fill = field.fill[cell as usize];
                    if *room > 0.0 && fill > 0.0 {
                        *room = ((*room / fill).min(MOST_ROOM * ROOM) * share).round().max(1.0);
                    }
                }
            }
        }
        let chart = GridTransform::new(anchor, cell);
        let Some(window) = fill(&Tiles { firsts, strand, state, own }, &chart, sums, field) else { return };
        self.window = window;
        self.fill.clone_from(&field.fill);
    }
}

/// Finds how full the cells of hair are; the window around it, or `None` where there is none.
fn fill(tiles: &Tiles, chart: &GridTransform, sums: &mut Sums, field: &mut Field) -> Option<GridBounds> {
    let extent = Extent::of(tiles, chart, Vec3::ZERO);
    if !(extent.lo.is_finite() && extent.hi.is_finite()) {
        return None;
    }
    let window = GridBounds::around(extent.lo, extent.hi);
    // Any mass will do, rooms are sums of their own.
    let units = Units { mass: 1.0, momentum: 0.0, energy: 0.0, speed: 0.0, carried: Vec3::ZERO };
    sums.clear(window.nodes());
    sums.add(tiles, chart, &window, &units);
    field.collect(window, &units, std::slice::from_ref(sums));
    Some(window)
}

/// The box that strands with roots in one box (`lo`, `hi`) and no longer than `length` can reach.
pub fn reach((lo, hi): (Vec3, Vec3), length: f32) -> (Vec3, Vec3) {
    (lo - length, hi + length)
}
