//! What is known of a single point, by its strand (an index of those given to [`Simulation::new`]) and its number in it.

use super::Simulation;
use crate::{
    simd::lanes::LANES,
    strand::tile::{rest, state},
};
use glam::{DVec3, Vec3};

impl Simulation {
    /// Tension of the segment from point `i` to the next, at the tip of the last one, as the last substep found it [N].
    pub fn tension_at(&self, strand: usize, i: usize) -> f32 {
        let (place, segment) = self.segment(strand, i);
        self.tension(place, segment * self.stride(place))
    }

    /// How much longer that segment is than at rest, over its length [1].
    pub fn stretch_at(&self, strand: usize, i: usize) -> f32 {
        let (place, segment) = self.segment(strand, i);
        let (stride, first) = (self.stride(place), segment * self.stride(place));
        let edges = (first + 1..=first + stride).map(|k| self.vector(place, k, state::EDGE).as_dvec3());
        let length = f64::from(self.rest(place, first, rest::LENGTH));
        (edges.sum::<DVec3>().length() / length - 1.0) as f32
    }

    /// Speed of point `i` [m/s].
    pub fn speed_at(&self, strand: usize, i: usize) -> f32 {
        let place = self.places[strand] as usize;
        self.vector(place, i * self.stride(place), state::V).length()
    }

    /// Force with which a collider holds point `i` out, as the last substep found it; 0 where none does [N].
    pub fn contact_at(&self, strand: usize, i: usize) -> f32 {
        let place = self.places[strand] as usize;
        let at = self.tiles[place / LANES].first as usize + i * self.stride(place);
        self.state[at][state::NORMAL_FORCE].0[place % LANES]
    }

    /// How full of hair `place` in the world was when the volume was last measured, over what it is at rest [1]; 0 where nothing asks for the hair's volume.
    pub fn density_at(&self, place: Vec3) -> f32 {
        self.volume.as_ref().map_or(0.0, |volume| volume.density(self.settings.anchor).fill(place))
    }

    /// Lane of a strand, and the segment from point `i`, or the last one.
    fn segment(&self, strand: usize, i: usize) -> (usize, usize) {
        let place = self.places[strand] as usize;
        (place, i.min(self.points(place) - 2))
    }

    fn stride(&self, place: usize) -> usize {
        self.tiles[place / LANES].model.stride()
    }
}
