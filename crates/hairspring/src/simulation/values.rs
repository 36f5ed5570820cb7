//! State of single points, by strand (an index into those given to [`Simulation::builder`]) and index in the
//! strand.

use super::{Simulation, strand_ref::StrandRef};
use glam::Vec3;

impl Simulation {
    /// Tension of the segment from point `i` to the next, from the last substep [N]. At the tip, that of the
    /// last segment.
    ///
    /// # Panics
    /// If there is no such strand.
    pub fn tension_at(&self, strand: usize, i: usize) -> f32 {
        let (strand, segment) = self.segment(strand, i);
        strand.tension(segment * strand.stride())
    }

    /// Strain of that segment: extension over rest length [1].
    ///
    /// # Panics
    /// If there is no such strand.
    pub fn stretch_at(&self, strand: usize, i: usize) -> f32 {
        let (strand, segment) = self.segment(strand, i);
        let length = f64::from(strand.rest_length(segment * strand.stride()));
        (strand.segment(segment).length() / length - 1.0) as f32
    }

    /// Speed of point `i` [m/s].
    ///
    /// # Panics
    /// If there is no such strand or point.
    pub fn speed_at(&self, strand: usize, i: usize) -> f32 {
        let strand = self.strand_with_point(strand, i);
        strand.velocity(i * strand.stride()).length()
    }

    /// Contact force of a collider on point `i`, from the last substep; 0 without contact [N].
    ///
    /// # Panics
    /// If there is no such strand or point.
    pub fn contact_at(&self, strand: usize, i: usize) -> f32 {
        let strand = self.strand_with_point(strand, i);
        strand.normal_force(i * strand.stride())
    }

    /// Fill ratio at the world position `place`: hair when the volume was last measured, relative to rest
    /// [1]; 0 if there is no hair volume.
    pub fn density_at(&self, place: Vec3) -> f32 {
        self.volume.as_ref().map_or(0.0, |volume| volume.density(self.state.anchor).fill(place))
    }

    /// A strand that has a point `i`.
    fn strand_with_point(&self, strand: usize, i: usize) -> StrandRef<'_> {
        let view = self.strand(self.model.lane_of_strand[strand] as usize);
        assert!(i < view.point_count(), "strand {strand} has no point {i}");
        view
    }

    /// A strand, and its segment that begins at point `i`, or the last one.
    fn segment(&self, strand: usize, i: usize) -> (StrandRef<'_>, usize) {
        let strand = self.strand(self.model.lane_of_strand[strand] as usize);
        (strand, i.min(strand.point_count() - 2))
    }
}
