//! All simulated strands, as strand contact sees them: their points, strand after strand. A segment has the
//! index of its first point.
//!
//! Strands that are identical at rest are merged into one with the mass of all. They overlap completely and
//! occupy no separate volume, so a contact with one is a contact with all.

use glam::Vec3;
use std::ops::Range;

/// Positions, velocities and masses of points, and radii of segments.
#[derive(Default)]
pub(crate) struct Hair {
    /// World position of each point [m].
    pub x: Vec<Vec3>,
    /// Velocity of each point [m/s].
    pub v: Vec<Vec3>,
    /// Inverse mass [1/kg]; 0 for driven and pinned points.
    pub inverse_mass: Vec<f32>,
    /// Strand of each point.
    pub of: Vec<u32>,
    /// First point of each strand, and the end of the last.
    first: Vec<u32>,
    /// How many simulated strands each strand represents.
    alike: Vec<u32>,
    /// For each simulated strand, its merged strand, and whether it is the first of that.
    shown: Vec<(u32, bool)>,
    /// Bending stiffness of the joint at each point, including damping in a substep; 0 at ends [N m].
    pub bend: Vec<f32>,
    /// Inverse rest length of the segment that begins at each point; 0 at tips [1/m].
    pub inverse_length: Vec<f32>,
    /// Radius of the segment that begins at each point; 0 at tips [m].
    pub radius: Vec<f32>,
}

impl Hair {
    /// Adds a simulated strand that is identical to the merged strand `strand`.
    pub fn add_same(&mut self, strand: u32) {
        self.shown.push((strand, false));
        self.alike[strand as usize] += 1;
    }

    /// Adds a simulated strand with this number of points.
    pub fn add_strand(&mut self, points: usize) {
        let (strand, count) = (self.strand_count() as u32, self.x.len() + points);
        if self.first.is_empty() {
            self.first.push(0);
        }
        self.first.push(count as u32);
        self.alike.push(1);
        self.shown.push((strand, true));
        self.x.resize(count, Vec3::ZERO);
        self.v.resize(count, Vec3::ZERO);
        self.inverse_mass.resize(count, 0.0);
        self.bend.resize(count, 0.0);
        self.inverse_length.resize(count, 0.0);
        self.of.resize(count, strand);
        self.radius.resize(count, 0.0);
    }

    /// Number of merged strands.
    pub fn strand_count(&self) -> usize {
        self.first.len().saturating_sub(1)
    }

    /// Number of simulated strands.
    pub fn shown_count(&self) -> usize {
        self.shown.len()
    }

    /// Merged strand of the simulated strand `k`.
    pub fn shown(&self, k: usize) -> usize {
        self.shown[k].0 as usize
    }

    /// If the simulated strand `k` is the first of its merged strand, returns how many that represents.
    pub fn shown_first(&self, k: usize) -> Option<f32> {
        let (strand, first) = self.shown[k];
        first.then(|| self.alike[strand as usize] as f32)
    }

    /// Point indices of a strand.
    pub fn strand(&self, s: usize) -> Range<usize> {
        self.first[s] as usize..self.first[s + 1] as usize
    }

    /// Point indices of each strand.
    pub fn strands(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        (0..self.strand_count()).map(|s| self.strand(s))
    }

    /// Indices of all segments.
    pub fn segments(&self) -> impl Iterator<Item = u32> + '_ {
        self.of.windows(2).enumerate().filter(|(_, s)| s[0] == s[1]).map(|(i, _)| i as u32)
    }

    /// Positions of the two ends of a segment [m].
    pub fn ends(&self, segment: u32) -> [Vec3; 2] {
        let i = segment as usize;
        [self.x[i], self.x[i + 1]]
    }

    /// Size in memory [bytes].
    pub fn bytes(&self) -> usize {
        self.x.len() * (2 * size_of::<Vec3>() + 4 * size_of::<f32>() + size_of::<u32>())
            + (self.first.len() + self.alike.len() + 2 * self.shown.len()) * size_of::<u32>()
    }
}
