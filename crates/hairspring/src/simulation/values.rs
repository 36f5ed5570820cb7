//! State of single points, by strand (an index into those given to [`Simulation::builder`]) and index in the
//! strand.

use super::Simulation;
use crate::{
    simd::lanes::LANES,
    strand::tile::{rest, state},
};
use glam::{DVec3, Vec3};

impl Simulation {
    /// Tension of the segment from point `i` to the next, from the last substep [N]. At the tip, that of the
    /// last segment.
    ///
    /// # Panics
    /// If there is no such strand.
    pub fn tension_at(&self, strand: usize, i: usize) -> f32 {
        let (place, segment) = self.segment(strand, i);
        self.tension(place, segment * self.stride(place))
    }

    /// Strain of that segment: extension over rest length [1].
    ///
    /// # Panics
    /// If there is no such strand.
    pub fn stretch_at(&self, strand: usize, i: usize) -> f32 {
        let (place, segment) = self.segment(strand, i);
        let (stride, first) = (self.stride(place), segment * self.stride(place));
        let edges = (first + 1..=first + stride).map(|k| self.vector(place, k, state::EDGE).as_dvec3());
        let length = f64::from(self.rest(place, first, rest::LENGTH));
        (edges.sum::<DVec3>().length() / length - 1.0) as f32
    }

    /// Speed of point `i` [m/s].
    ///
    /// # Panics
    /// If there is no such strand or point.
    pub fn speed_at(&self, strand: usize, i: usize) -> f32 {
        let place = self.place_of(strand, i);
        self.vector(place, i * self.stride(place), state::V).length()
    }

    /// Contact force of a collider on point `i`, from the last substep; 0 without contact [N].
    ///
    /// # Panics
    /// If there is no such strand or point.
    pub fn contact_at(&self, strand: usize, i: usize) -> f32 {
        let place = self.place_of(strand, i);
        let at = self.model.tiles[place / LANES].first as usize + i * self.stride(place);
        self.state.points[at][state::NORMAL_FORCE].0[place % LANES]
    }

    /// Fill ratio at the world position `place`: hair when the volume was last measured, relative to rest
    /// [1]; 0 if there is no hair volume.
    pub fn density_at(&self, place: Vec3) -> f32 {
        self.volume.as_ref().map_or(0.0, |volume| volume.density(self.state.anchor).fill(place))
    }

    /// Lane of a strand that has a point `i`.
    fn place_of(&self, strand: usize, i: usize) -> usize {
        let place = self.model.places[strand] as usize;
        assert!(i < self.points(place), "strand {strand} has no point {i}");
        place
    }

    /// Lane of a strand, and the segment that begins at point `i`, or the last one.
    fn segment(&self, strand: usize, i: usize) -> (usize, usize) {
        let place = self.model.places[strand] as usize;
        (place, i.min(self.points(place) - 2))
    }

    fn stride(&self, place: usize) -> usize {
        self.model.tiles[place / LANES].model.stride()
    }
}
