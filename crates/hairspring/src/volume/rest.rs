//! What is measured once, at rest: the cell, each point's part of the hair's volume, and how full each cell is.

use super::{
    field::Field,
    splat::{Extent, OwnRows, ROOM, Sums, Tiles, Units, own},
    window::{Chart, Placed, Window},
};
use crate::{
    collide::Rigid,
    strand::{
        lanes::LANES,
        tile::{StateRows, StrandRows},
    },
};
use glam::{IVec3, Vec3};
use rayon::prelude::*;

/// Points that a cell with any should hold at rest, in the mean: the sum over a cell and its neighbours is then of some 150 points, and
/// rough to 8 % if they lie at random.
const POINTS_A_CELL: f32 = 8.0;

/// Rounds in which points find their rooms: after three a hair-filled cell is full to 2 % or better.
const ROUNDS: usize = 3;

/// Largest room of a point [cells]: a lone one fills its own cell and a third of what is around it.
const MOST_ROOM: f32 = 4.0;

/// What may be fuller than at rest before it counts [1]: above the rounding of a turned head, far below what is seen.
const SLACK: f32 = 1.02;

/// The smallest cell that holds [`POINTS_A_CELL`] points at rest, and is no smaller than the mean segment `shortest` [m], above 0.
pub fn cell_for(tiles: &Tiles, anchor: &Rigid, shortest: f32) -> f32 {
    let mut cell = shortest;
    let mut occupied: Vec<u64> = Vec::new();
    for _ in 0..64 {
        let chart = Chart::new(anchor, cell);
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
        occupied.dedup();
        if points >= POINTS_A_CELL * occupied.len() as f32 || occupied.len() <= 1 {
            break;
        }
        cell *= 1.1;
    }
    cell
}

/// How full cells are at rest, where that is more than full.
#[derive(Default)]
pub struct Rest {
    window: Window,
    fill: Vec<f32>,
}

impl Rest {
    /// How much fuller than it may be a cell of `window` is, when it is this full; 0 or less: it is not [1].
    pub fn excess(&self, window: &Window, cell: usize, fill: f32) -> f32 {
        let at = if *window == self.window { Some(cell) } else { self.window.index(window.place(cell)) };
        fill - SLACK * at.map_or(1.0, |at| self.fill[at].max(1.0))
    }

    /// Gives every point its room, such that hair at rest fills the cells that it is in, and remembers the rest.
    pub fn measure(
        &mut self,
        (strand, state): (&[StrandRows], &[StateRows]),
        firsts: &[u32],
        own: &mut [OwnRows],
        chart: &Chart,
        (sums, field): (&mut Sums, &mut Field),
    ) {
        let extent = Extent::of(&Tiles { firsts, strand, state, own }, chart);
        if !(extent.lo.is_finite() && extent.hi.is_finite()) {
            return;
        }
        let window = Window::around(extent.lo, extent.hi);
        // Any mass will do, rooms are sums of their own.
        let units = Units { mass: 1.0, momentum: 0.0, speed: 0.0 };
        for round in 0..=ROUNDS {
            sums.clear(window.nodes());
            sums.add(&Tiles { firsts, strand, state, own }, chart, &window, &units);
            field.collect(window, &units, std::slice::from_ref(sums));
            if round == ROUNDS {
                break;
            }
            for (rows, first) in strand.iter().zip(firsts.windows(2)) {
                let mut places = chart.roots(rows, window.lo);
                for i in first[0] as usize..first[1] as usize {
                    chart.walk(&mut places, &state[i]);
                    let placed = Placed::new(&places, &window);
                    let room = &mut own[i][own::ROOM].0;
                    for (room, cell) in room.iter_mut().zip(placed.cell) {
                        let fill = field.fill[cell as usize];
                        if *room > 0.0 && fill > 0.0 {
                            *room = (*room / fill).round().clamp(1.0, MOST_ROOM * ROOM);
                        }
                    }
                }
            }
        }
        self.window = window;
        self.fill.clone_from(&field.fill);
    }
}

/// The box that strands with roots in one box (`lo`, `hi`) and no longer than `length` can reach.
pub fn reach((lo, hi): (Vec3, Vec3), length: f32) -> (Vec3, Vec3) {
    (lo - length, hi + length)
}
