//! Strand contact in the simulation: contacts between strands are solved between substeps.

use super::{Simulation, points::set_segment};
use crate::settings::{self, OutOfRange, Validate};
use crate::{
    simd::lanes::LANES,
    strand::{frame_context::FrameContext, tile::hold},
    strand_contact::{Hair, Neighbours, NeighboursReport},
};
use glam::{Mat3, Vec3};
use std::collections::HashMap;

impl Simulation {
    /// Enables or disables strand contact. The current pose counts as the rest pose, in which the contact
    /// radius of segments is limited by the available space.
    ///
    /// # Errors
    /// If a setting is out of range; then nothing changes.
    pub fn set_neighbours(&mut self, settings: &settings::Neighbours) -> Result<(), OutOfRange> {
        settings.validate()?;
        let mut hair = Hair::default();
        if settings.on {
            let mut known = HashMap::new();
            for place in &self.model.lane_of_strand {
                let strand = self.model.groom_strands[*place as usize] as usize;
                let points = self.model.groom.strand(strand);
                let next = hair.strand_count() as u32;
                let bits: &[u32] = bytemuck::cast_slice(points);
                match *known.entry((self.model.groom.group(strand), bits)).or_insert(next) {
                    same if same != next => hair.add_same(same),
                    _ => hair.add_strand(points.len()),
                }
            }
            self.copy_points((1.0, self.state.anchor.matrix()), f32::INFINITY, &mut hair);
        }
        self.neighbours = Neighbours::new(settings, hair).map(Box::new);
        Ok(())
    }

    /// Statistics of the strand contacts; `None` if they are disabled.
    pub fn neighbours(&self) -> Option<NeighboursReport> {
        self.neighbours.as_ref().map(|neighbours| neighbours.report())
    }

    /// Adds the carried contact loads to the velocities of all points before a substep.
    pub(super) fn apply_contact_loads(&mut self, neighbours: &mut Neighbours, h: f32) {
        neighbours.apply_warm_start(h);
        let kicks = &neighbours.hair.v;
        self.each_velocity(&neighbours.hair, |i, _, rows| {
            rows.into_iter().zip(kicks[i].to_array()).for_each(|(row, kick)| *row += kick);
        });
    }

    /// Solves the strand contacts at the end of the frame's substep `number`.
    pub(super) fn solve_strand_contacts(
        &mut self,
        neighbours: &mut Neighbours,
        frame: &FrameContext,
        number: usize,
    ) {
        let substep = &frame.substeps[number];
        self.copy_points((substep.fraction, substep.anchor), frame.h, &mut neighbours.hair);
        neighbours.solve_contacts(frame.h);
        let hair = &neighbours.hair;
        self.each_velocity(hair, |i, first, rows| {
            if hair.inverse_mass[i] > 0.0 && first {
                rows.into_iter().zip(hair.v[i].to_array()).for_each(|(row, v)| *row = v);
            } else if hair.inverse_mass[i] > 0.0 {
                let change = neighbours.change(i).to_array();
                rows.into_iter().zip(change).for_each(|(row, change)| *row += change);
            }
        });
        self.move_points(neighbours, frame.h);
    }

    /// Moves all points by `h` [s] times the change of their velocity by the contacts. Segments keep their lengths.
    fn move_points(&mut self, neighbours: &Neighbours, h: f32) {
        let hair = &neighbours.hair;
        for k in 0..self.model.lane_of_strand.len() {
            let mut strand = self.strand_mut(self.model.lane_of_strand[k] as usize);
            for (j, i) in hair.strand(hair.shown(k)).skip(1).enumerate() {
                let turn = h * (neighbours.change(i) - neighbours.change(i - 1));
                if turn != Vec3::ZERO {
                    let old = strand.get().segment(j).as_vec3();
                    set_segment(&mut strand, j, (old + turn).normalize_or(old) * old.length());
                }
            }
        }
    }

    /// Copies positions, velocities, masses and bending stiffness of all points to `hair`, for a substep of
    /// `h` [s]. The pair holds the fraction of the frame and the anchor's pose at that time.
    fn copy_points(&self, (fraction, (m, t)): (f32, (Mat3, Vec3)), h: f32, hair: &mut Hair) {
        let mut i = 0;
        for (k, place) in self.model.lane_of_strand.iter().map(|p| *p as usize).enumerate() {
            let Some(alike) = hair.shown_first(k) else { continue };
            let strand = self.strand(place);
            let stride = strand.stride();
            let [start, end] = strand.local_roots();
            let mut x = m * start.lerp(end, fraction) + t;
            for j in 0..strand.particle_count() {
                x += strand.edge(j);
                if j.is_multiple_of(stride) {
                    hair.x[i] = x;
                    hair.v[i] = strand.velocity(j);
                    let free = j >= strand.elastic().driven();
                    hair.inverse_mass[i] = if free { (alike * strand.mass(j)).recip() } else { 0.0 };
                    let length = strand.rest_length(j);
                    hair.inverse_length[i] = if length > 0.0 { length.recip() } else { 0.0 };
                    // The bending springs of the springs model do not act at its points, and their effect
                    // here is small.
                    hair.bend[i] = if stride == 1 {
                        alike * strand.bend(j) * (1.0 + strand.damping(j) / h)
                    } else {
                        0.0
                    };
                    i += 1;
                }
            }
            let start = i - strand.point_count();
            for held in &self.state.holds[place / LANES] {
                if held.rows[hold::PINNED].0[place % LANES] > 0.0 {
                    hair.inverse_mass[start + held.point as usize / stride] = 0.0;
                }
            }
        }
    }

    /// Calls `see` with the velocity of every point, strand by strand in the order given to
    /// [`Simulation::builder`]: the index of the point in `hair`, and whether its strand is the first of its
    /// merged strands.
    fn each_velocity(&mut self, hair: &Hair, mut see: impl FnMut(usize, bool, [&mut f32; 3])) {
        for k in 0..self.model.lane_of_strand.len() {
            let mut strand = self.strand_mut(self.model.lane_of_strand[k] as usize);
            let stride = strand.get().stride();
            let first = hair.shown_first(k).is_some();
            for (j, i) in hair.strand(hair.shown(k)).enumerate() {
                see(i, first, strand.velocity_mut(j * stride));
            }
        }
    }
}
