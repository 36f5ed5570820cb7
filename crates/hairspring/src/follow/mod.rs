//! Follow hairs: every hair that is not simulated, carried by up to three guides.
//!
//! A follow point p₀ of the rest pose is taken along by each of its guides as a rigid piece: with g₀ the guide's rest point at the same
//! arc length, x where it is now and R how the guide's frame has turned there,
//!
//! ```text
//! p = Σ w (x + R (p₀ − g₀))
//! ```
//!
//! which is the rest offset kept in the guide's frame (DESIGN §7) without an offset to store: at rest R = I and p = p₀ to the
//! bit of a rounding.

mod carry;
mod choose;
mod keep_out;
mod style;

pub use choose::{assign_guides, choose_guides};

use crate::{
    collide::ObstaclePose,
    groom::{Groom, GuideWeights},
    scene::Effects,
};
use fearless_simd::{Level, dispatch};
use glam::{Affine3A, Quat, Vec3};
use rayon::prelude::*;
use std::sync::Arc;

/// The follow hairs of one groom: settings, and the frames of the guides in the current frame.
///
/// # Missing
/// Drawing-time interpolation on a GPU; levels of detail.
pub struct Follow {
    groom: Arc<Groom>,
    /// Guides of each strand as indices into `guides`, and weights; shape `[strands]`.
    weights: Vec<GuideWeights>,
    /// The guide strands, in the order of their points in [`Follow::place`].
    guides: Vec<u32>,
    /// First point of each guide in the array of all guides' points, and their number at the end.
    guide_offsets: Vec<u32>,
    /// For every strand its place among the guides; `u32::MAX` for follow hairs.
    guide_of: Vec<u32>,
    /// Where along each of its guides a point rides: fraction of the guide's points, 16 bits; shape `[points]`.
    ride: Vec<[u16; 3]>,
    /// How deep each point may be inside a collider, 0 or less [m]; shape `[points]`.
    clearance: Vec<f32>,
    effects: Effects,
    /// From the rest pose to now, of each guide point.
    carriers: Vec<Affine3A>,
}

impl Follow {
    /// Prepares the follow hairs of `groom`.
    ///
    /// - `guides`: the simulated strands.
    /// - `weights`: of every strand, naming strands of the groom that are in `guides`; shape `[strands]`.
    /// - `obstacles`: colliders at rest: points that start inside may stay as deep as they are.
    pub fn new(
        groom: Arc<Groom>,
        guides: &[u32],
        weights: &[GuideWeights],
        effects: Effects,
        obstacles: &[ObstaclePose],
    ) -> Self {
        let mut guide_of = vec![u32::MAX; groom.strand_count()];
        let mut guide_offsets = vec![0];
        for (k, s) in guides.iter().enumerate() {
            guide_of[*s as usize] = k as u32;
            guide_offsets.push(guide_offsets[k] + groom.range(*s as usize).len() as u32);
        }
        let weights: Vec<GuideWeights> = weights
            .iter()
            .map(|w| GuideWeights { guides: w.guides.map(|g| guide_of[g as usize]), weights: w.weights })
            .collect();
        let ride = carry::rides(&groom, guides, &weights);
        let clearance = groom
            .points
            .par_iter()
            .map(|p| obstacles.iter().map(|o| o.distance(*p)).fold(0.0, f32::min))
            .collect();
        let carriers = vec![Affine3A::IDENTITY; *guide_offsets.last().unwrap_or(&0) as usize];
        Self {
            groom,
            weights,
            guides: guides.to_vec(),
            guide_offsets,
            guide_of,
            ride,
            clearance,
            effects,
            carriers,
        }
    }

    /// Lays other effects over the follow hairs from the next [`Follow::place`] on; whether they are other ones.
    pub fn set_effects(&mut self, effects: Effects) -> bool {
        std::mem::replace(&mut self.effects, effects) != effects
    }

    /// Places all strands: guides as they are, follow hairs carried by them and kept out of the colliders.
    ///
    /// - `guide_points`: points of all guides now [m], as `Simulation::write_points` gives them.
    /// - `turns`: rotation of each guide's root since rest.
    /// - `out`: all points of the groom [m].
    pub fn place(
        &mut self,
        guide_points: &[Vec3],
        turns: &[Quat],
        obstacles: &[ObstaclePose],
        out: &mut [Vec3],
    ) {
        carry::update_carriers(
            &self.groom,
            &self.guides,
            &self.guide_offsets,
            guide_points,
            turns,
            &mut self.carriers,
        );
        let groom = &*self.groom;
        let this = &*self;
        let level = Level::new();
        split_by(out, &groom.offsets).into_par_iter().enumerate().with_min_len(64).for_each(|(s, strand)| {
            let guide = this.guide_of[s];
            if guide != u32::MAX {
                let first = this.guide_offsets[guide as usize] as usize;
                strand.copy_from_slice(&guide_points[first..first + strand.len()]);
                return;
            }
            let range = groom.range(s);
            let weights = &this.weights[s];
            let matrices = weights.guides.map(|g| {
                let g = g as usize;
                &this.carriers[this.guide_offsets[g] as usize..this.guide_offsets[g + 1] as usize]
            });
            carry::carry(&groom.points[range.clone()], weights, matrices, &this.ride[range.clone()], strand);
            if this.effects != Effects::default() {
                let g = weights.guides[0] as usize;
                let lead = &guide_points[this.guide_offsets[g] as usize..this.guide_offsets[g + 1] as usize];
                style::lay_over(&this.effects, s as u32, lead, &this.ride[range.clone()], strand);
            }
            let clearance = &this.clearance[range];
            dispatch!(level, simd => keep_out::keep_out(simd, obstacles, strand, clearance));
        });
    }

    /// Place of a strand among the guides, if it is one.
    pub(crate) fn guide(&self, strand: usize) -> Option<usize> {
        Some(self.guide_of[strand]).filter(|guide| *guide != u32::MAX).map(|guide| guide as usize)
    }

    /// Place among the guides of the first that a strand follows; its own where it is one.
    pub(crate) fn first_guide(&self, strand: usize) -> usize {
        self.guide(strand).unwrap_or(self.weights[strand].guides[0] as usize)
    }

    /// Writes one number a point of all strands, given those of all guides' points: guides have their own, follow hairs those of their first guide where
    /// they ride on it.
    pub(crate) fn spread(&self, of_guides: &[f32], out: &mut [f32]) {
        let strands = split_by(out, &self.groom.offsets);
        strands.into_par_iter().enumerate().with_min_len(64).for_each(|(s, out)| {
            let guide = self.first_guide(s);
            let lead = &of_guides[self.guide_offsets[guide] as usize..self.guide_offsets[guide + 1] as usize];
            if self.guide(s).is_some() {
                out.copy_from_slice(lead);
                return;
            }
            let last = lead.len() - 1;
            for (value, ride) in out.iter_mut().zip(&self.ride[self.groom.range(s)]) {
                let at = f32::from(ride[0]) * (last as f32 / f32::from(u16::MAX));
                let i = (at as usize).min(last - 1);
                *value = lead[i] + (lead[i + 1] - lead[i]) * (at - i as f32);
            }
        });
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.weights[..])
            + size_of_val(&self.ride[..])
            + size_of_val(&self.clearance[..])
            + size_of_val(&self.carriers[..])
    }
}

/// `array` cut at `offsets`.
pub(crate) fn split_by<'a, T>(array: &'a mut [T], offsets: &[u32]) -> Vec<&'a mut [T]> {
    let mut rest = array;
    let mut pieces = Vec::with_capacity(offsets.len().saturating_sub(1));
    for w in offsets.windows(2) {
        let (piece, more) = rest.split_at_mut((w[1] - w[0]) as usize);
        pieces.push(piece);
        rest = more;
    }
    pieces
}
