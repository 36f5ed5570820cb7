//! All simulated strands as their neighbours see them: points one after the other, strand after strand. A segment is known by its first point.
//!
//! Strands that are the same at rest are one here, of the mass of all: they are in each other, have no room of their own, and what meets one meets all.

use glam::Vec3;
use std::ops::Range;

/// Places, velocities and masses of points, and how thick the segments are.
#[derive(Default)]
pub(crate) struct Hair {
    /// Place of each point in the world [m].
    pub x: Vec<Vec3>,
    /// Its velocity [m/s].
    pub v: Vec<Vec3>,
    /// Inverse of its mass [1/kg]; 0 where it is driven or held fast.
    pub inverse_mass: Vec<f32>,
    /// Strand that it is of.
    pub of: Vec<u32>,
    /// First point of each strand, and of the first after the last.
    first: Vec<u32>,
    /// How many simulated strands each is.
    alike: Vec<u32>,
    /// Which strand each simulated one is, and whether it is the first that is.
    shown: Vec<(u32, bool)>,
    /// Bending stiffness of the joint at it, its damping in a substep included; 0 at ends [N m].
    pub bend: Vec<f32>,
    /// Inverse of the rest length of the segment from it, 0 at tips [1/m].
    pub inverse_length: Vec<f32>,
    /// Radius of the segment from it, 0 at tips [m].
    pub radius: Vec<f32>,
}

impl Hair {
    /// Adds a simulated strand that is the same as `strand`.
    pub fn add_same(&mut self, strand: u32) {
        self.shown.push((strand, false));
        self.alike[strand as usize] += 1;
    }

    /// Adds a simulated strand of so many points.
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

    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.first.len().saturating_sub(1)
    }

    /// Number of simulated strands.
    pub fn shown_count(&self) -> usize {
        self.shown.len()
    }

    /// Which strand the simulated one `k` is.
    pub fn shown(&self, k: usize) -> usize {
        self.shown[k].0 as usize
    }

    /// How many are the same as the simulated strand `k`, itself among them, where it is the first of them.
    pub fn shown_first(&self, k: usize) -> Option<f32> {
        let (strand, first) = self.shown[k];
        first.then(|| self.alike[strand as usize] as f32)
    }

    /// Points of a strand.
    pub fn strand(&self, s: usize) -> Range<usize> {
        self.first[s] as usize..self.first[s + 1] as usize
    }

    /// Points of all strands.
    pub fn strands(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        (0..self.strand_count()).map(|s| self.strand(s))
    }

    /// All segments.
    pub fn segments(&self) -> impl Iterator<Item = u32> + '_ {
        self.of.windows(2).enumerate().filter(|(_, s)| s[0] == s[1]).map(|(i, _)| i as u32)
    }

    /// The ends of a segment [m].
    pub fn ends(&self, segment: u32) -> [Vec3; 2] {
        let i = segment as usize;
        [self.x[i], self.x[i + 1]]
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> usize {
        self.x.len() * (2 * size_of::<Vec3>() + 4 * size_of::<f32>() + size_of::<u32>())
            + (self.first.len() + self.alike.len() + 2 * self.shown.len()) * size_of::<u32>()
    }
}
