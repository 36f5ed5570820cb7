//! Strands as their neighbours see them: where points are and how heavy, and a frame that can be run again.

use super::Simulation;
use crate::{
    around::Surrounded,
    collide::Rigid,
    strand::{
        lanes::LANES,
        tile::{damp, rest, state, strand},
    },
};
use glam::Vec3;

/// What neighbours do to one point in a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Met {
    /// Acceleration [m/s²].
    pub push: Vec3,
    /// Damping over its mass, see `damp` [1/s].
    pub damp: [f32; damp::ROWS],
}

impl Simulation {
    /// How many points each simulated strand has, in the order given to [`Simulation::new`].
    pub(crate) fn counts(&self) -> impl Iterator<Item = usize> + '_ {
        self.strands().map(|s| self.groom.range(s as usize).len())
    }

    /// Where the anchor was at the end of the last frame.
    pub(crate) fn anchor(&self) -> Rigid {
        self.settings.anchor
    }

    /// Mass [kg] of every simulated point, in the order of [`Simulation::write_points`].
    pub(crate) fn masses(&self) -> impl Iterator<Item = f32> + '_ {
        self.places.iter().zip(self.counts()).flat_map(move |(&place, points)| {
            let stride = self.tiles[place as usize / LANES].model.stride();
            (0..points).map(move |i| self.rest(place as usize, i * stride, rest::MASS))
        })
    }

    /// Shows every simulated point to `see`, in the order of [`Simulation::write_points`]: its place from `origin` [m], and its velocity [m/s].
    /// `anchor` is where the anchor is now.
    pub(crate) fn see_points(&self, anchor: &Rigid, origin: Vec3, mut see: impl FnMut(Vec3, Vec3)) {
        let (turn, translation) = anchor.matrix();
        for (&place, points) in self.places.iter().zip(self.counts()) {
            let (place, tile) = (place as usize, self.tiles[place as usize / LANES]);
            let rows = &self.strand[place / LANES][strand::ROOT_END..];
            let root = Vec3::from([0, 1, 2].map(|k| rows[k].0[place % LANES]));
            let root = turn * root + (translation - origin);
            let stride = tile.model.stride();
            for (i, x) in self.particles(place).step_by(stride).enumerate().take(points) {
                see(root + x, self.vector(place, i * stride, state::V));
            }
        }
    }

    /// Keeps what the frame that has begun starts with.
    pub(crate) fn remember(&mut self) {
        self.before.0.clone_from(&self.state);
        self.before.1.clone_from(&self.history);
    }

    /// Back to the start of the frame that has been run.
    pub(crate) fn rewind(&mut self) {
        self.state.copy_from_slice(&self.before.0);
        self.history.copy_from_slice(&self.before.1);
    }

    /// Adds what neighbours do to the points in a frame of `dt` [s] that takes the anchor to `anchor`: `met` in the order of
    /// [`Simulation::write_points`], where the strand of the groom with index s begins at `firsts[s]`.
    pub(crate) fn meet(&mut self, (anchor, dt): (Rigid, f32), firsts: &[u32], met: &[Met]) {
        let groom = self.groom.clone();
        let act = |strand: &mut Surrounded| {
            let first = firsts[strand.strand] as usize;
            let points = groom.range(strand.strand).len();
            for (i, met) in met[first..first + points].iter().enumerate().skip(2) {
                if met.damp != [0.0; damp::ROWS] || met.push != Vec3::ZERO {
                    strand.push(i, met.push);
                    strand.damp(i, &met.damp);
                }
            }
        };
        self.surround((anchor, dt), &act);
    }

    /// Number of strands of the groom, simulated or not.
    pub(crate) fn groom_strands(&self) -> usize {
        self.groom.strand_count()
    }
}
