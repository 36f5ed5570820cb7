//! Holds: points that are pinned, pulled or loaded, and clamped ends.

use super::Simulation;
use crate::{
    simd::lanes::{LANES, Row},
    strand::tile::{Elastic, HoldRows, hold},
};
use glam::Vec3;

/// A hold on one point, with the integrators `backward-euler` and `bdf2`; the others ignore holds.
///
/// ```
/// use hairspring::{prelude::*, simulation::Hold};
///
/// let strand: Vec<Vec3> = (0..8).map(|i| Vec3::NEG_Y * (0.01 * i as f32)).collect();
/// let tip = strand[7];
/// let mut simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).build()?;
/// // The tip is pinned where it is.
/// simulation.set_holds(&[Hold { strand: 0, point: 7, target: Some(tip), ..Default::default() }]);
/// # Ok::<(), hairspring::simulation::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hold {
    /// The strand, as an index into those given to [`Simulation::builder`].
    pub strand: u32,
    /// The point of the strand; 2 or more, because the root drives the first two.
    pub point: u32,
    /// World position of the target at the end of the next frame [m]; `None` if the point is free.
    pub target: Option<Vec3>,
    /// Displacement of the target in the next frame [m]. After that, the target is at rest.
    pub displacement: Vec3,
    /// Stiffness of the spring that pulls the point to the target [N/m], above 0; `None` if the point is
    /// pinned. A pin must stay within the reach of the hair between the root, or another pin, and the point, and move by
    /// less than a segment in a frame. Otherwise the strand is torn: the strain limit does not hold.
    pub stiffness: Option<f32>,
    /// Force on the point [N].
    pub force: Vec3,
    /// Whether the frame of the segment that begins at this point keeps its twist (in models with twist). If
    /// the segment's two points are held as well, the strand is clamped there.
    pub clamped: bool,
}

impl Simulation {
    /// Holds these points from now on, and releases all others. Only the integrators `backward-euler` and `bdf2` apply
    /// holds; the others ignore them.
    ///
    /// # Panics
    /// If a strand or a point does not exist, or the root drives the point.
    pub fn set_holds(&mut self, holds: &[Hold]) {
        self.state.holds.iter_mut().for_each(Vec::clear);
        for held in holds {
            let place = self.model.lane_of_strand[held.strand as usize] as usize;
            let (model, points) = (self.strand(place).elastic(), self.strand(place).point_count());
            assert!(
                (2..points).contains(&(held.point as usize)),
                "a held point must exist and must not be driven"
            );
            let point = held.point * model.stride() as u32;
            let (tile, lane) = (&mut self.state.holds[place / LANES], place % LANES);
            let at = tile.iter().position(|h| h.point == point).unwrap_or_else(|| {
                tile.push(HoldRows { point, rows: [Row::default(); hold::ROWS] });
                tile.len() - 1
            });
            let rows = &mut tile[at].rows;
            let target = held.target.unwrap_or_default();
            for k in 0..3 {
                rows[hold::TARGET + k].0[lane] = target[k];
                rows[hold::FORCE + k].0[lane] = held.force[k];
                rows[hold::DISPLACEMENT + k].0[lane] = held.displacement[k];
            }
            let fast = held.target.is_some() && held.stiffness.is_none();
            rows[hold::PINNED].0[lane] = if fast { 1.0 } else { 0.0 };
            rows[hold::STIFFNESS].0[lane] = held.target.and(held.stiffness).unwrap_or(0.0);
            rows[hold::CLAMPED].0[lane] = if held.clamped { 1.0 } else { 0.0 };
            let next = |h: &&Hold| h.strand == held.strand && h.point == held.point + 1;
            let end = holds.iter().find(next).and_then(|h| h.target);
            if let (Elastic::Springs, true, Some(start), Some(end)) = (model, held.clamped, held.target, end)
            {
                self.hold_extra(place, point, [start, end]);
            }
        }
        self.state.holds.iter_mut().for_each(|tile| tile.sort_by_key(|h| h.point));
    }

    /// Puts the targets at rest after they have reached their positions.
    pub(super) fn end_holds(&mut self) {
        for held in self.state.holds.iter_mut().flatten() {
            held.rows[hold::DISPLACEMENT..hold::DISPLACEMENT + 3].fill(Row::default());
        }
    }

    /// Pins the extra particle after particle `point` of the springs model to its triangle over the segment
    /// between `ends`, on the side where it currently is.
    fn hold_extra(&mut self, place: usize, point: u32, ends: [Vec3; 2]) {
        let edge = |i: u32| self.strand(place).edge((point + i) as usize);
        let (tile, lane) = (place / LANES, place % LANES);
        let aside = 0.5 * (edge(1) - edge(2));
        let along = (ends[1] - ends[0]).normalize_or_zero();
        let across = aside.reject_from(along).normalize_or_zero() * aside.length();
        let target = 0.5 * (ends[0] + ends[1]) + across;
        let mut rows = [Row::default(); hold::ROWS];
        for k in 0..3 {
            rows[hold::TARGET + k].0[lane] = target[k];
        }
        rows[hold::PINNED].0[lane] = 1.0;
        let extra = point + 1;
        match self.state.holds[tile].iter_mut().find(|h| h.point == extra) {
            None => self.state.holds[tile].push(HoldRows { point: extra, rows }),
            Some(held) => {
                for (row, new) in held.rows.iter_mut().zip(rows) {
                    row.0[lane] = new.0[lane];
                }
            }
        }
    }
}
