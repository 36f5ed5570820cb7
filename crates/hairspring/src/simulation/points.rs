//! Positions and velocities of the simulated points as plain arrays.

use super::{Simulation, strand_ref::StrandMut};
use crate::strand::{model::bend::transport_normal, tile::Elastic};
use glam::{DVec3, Vec3};

/// The reason that [`Simulation::set_points`] refused its input.
///
/// ```
/// use hairspring::{prelude::*, simulation::PointsError};
///
/// let strand: Vec<Vec3> = (0..8).map(|i| Vec3::NEG_Y * (0.01 * i as f32)).collect();
/// let mut simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).build()?;
/// let refused = simulation.set_points(&[], &[]);
/// assert_eq!(refused, Err(PointsError::Count { points: 0, velocities: 0, expected: 8 }));
/// # Ok::<(), hairspring::simulation::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PointsError {
    /// An array has another length than the number of simulated points.
    #[error("{points} points and {velocities} velocities were given for {expected} simulated points")]
    Count {
        /// The given points.
        points: usize,
        /// The given velocities.
        velocities: usize,
        /// The simulated points.
        expected: usize,
    },
    /// The position or the velocity of this point is not finite.
    #[error("the position or the velocity of point {0} is not finite")]
    NotFinite(usize),
}

impl Simulation {
    /// Writes the velocity of every simulated point [m/s], in the order of [`Simulation::write_points`]; `out`
    /// has the shape `[point_count]`.
    ///
    /// # Panics
    /// If `out` is too short.
    pub fn write_velocities(&self, out: &mut [Vec3]) {
        let mut out = out.iter_mut();
        for strand in self.model.lane_of_strand.iter().map(|lane| self.strand(*lane as usize)) {
            for i in 0..strand.point_count() {
                *out.next().expect("one velocity for each point") = strand.velocity(i * strand.stride());
            }
        }
    }

    /// Moves all points to `points` [m] with `velocities` [m/s], both in the order of
    /// [`Simulation::write_points`], of shape `[point_count]`. Frames rotate with their segments by the
    /// smallest rotation. Tensions and contact forces stay. A strand whose first point is not at its root is
    /// translated there, since roots are driven.
    ///
    /// # Errors
    /// If an array has another length, or a number is not finite: see [`PointsError`]. The state is then
    /// unchanged.
    pub fn set_points(&mut self, points: &[Vec3], velocities: &[Vec3]) -> Result<(), PointsError> {
        let expected = self.point_count();
        if [points.len(), velocities.len()] != [expected; 2] {
            let (points, velocities) = (points.len(), velocities.len());
            return Err(PointsError::Count { points, velocities, expected });
        }
        if let Some(k) = points.iter().zip(velocities).position(|(p, v)| !(p.is_finite() && v.is_finite())) {
            return Err(PointsError::NotFinite(k));
        }
        let mut first = 0;
        for k in 0..self.model.lane_of_strand.len() {
            let place = self.model.lane_of_strand[k] as usize;
            let own = first..first + self.strand(place).point_count();
            first = own.end;
            self.set_strand(place, &points[own.clone()], &velocities[own]);
        }
        Ok(())
    }

    fn set_strand(&mut self, place: usize, points: &[Vec3], velocities: &[Vec3]) {
        let mut strand = self.strand_mut(place);
        let (model, stride) = (strand.get().elastic(), strand.get().stride());
        for (i, w) in points.windows(2).enumerate() {
            set_segment(&mut strand, i, w[1] - w[0]);
            if model == Elastic::Springs {
                strand.set_velocity(i * stride + 1, velocities[i].midpoint(velocities[i + 1]));
            }
        }
        for (i, v) in velocities.iter().enumerate() {
            strand.set_velocity(i * stride, *v);
        }
        self.begin_history(place);
    }
}

/// Sets the vector of segment `j` to `new` [m]. The segment's frame is rotated by the smallest rotation between the old and
/// the new vector. So is the offset of the extra particle of the springs model from the middle of the segment.
pub(super) fn set_segment(strand: &mut StrandMut<'_>, j: usize, new: Vec3) {
    let (model, stride) = (strand.get().elastic(), strand.get().stride());
    let first = j * stride;
    let old: Vec3 = (1..=stride).map(|k| strand.get().edge(first + k)).sum();
    let turn = |v: Vec3| {
        let [from, to] = [old, new].map(|e| e.as_dvec3().normalize_or(DVec3::Y));
        transport_normal(v.as_dvec3(), from, to).as_vec3()
    };
    if model == Elastic::Springs {
        let aside = strand.get().edge(first + 1) - 0.5 * old;
        let aside = turn(aside).normalize_or_zero() * aside.length();
        strand.set_edge(first + 1, 0.5 * new + aside);
        strand.set_edge(first + 2, 0.5 * new - aside);
    } else {
        let normal = strand.get().normal(first);
        strand.set_normal(first, turn(normal));
        strand.set_edge(first + 1, new);
    }
}
