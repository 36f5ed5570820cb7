//! Follow hairs: every hair that is not simulated, carried by up to three guides.
//!
//! A follow point p₀ of the rest pose is taken along by each of its guides as a rigid piece: with g₀ the guide's rest point at the same
//! arc length, x where it is now and R how the guide's frame has turned there,
//!
//! ```text
//! p = Σ w (x + R (p₀ − g₀))
//! ```
//!
//! which is the rest offset kept in the guide's frame without an offset to store: at rest R = I and p = p₀ to the
//! bit of a rounding.

mod carry;
mod choose;
mod keep_out;
mod style;

pub use choose::{assign_guides, choose_guides};

use crate::{
    collide::{ColliderPose, MovingCollider},
    groom::{Groom, GuideWeights},
    settings::Effects,
    simd::dispatch::dispatch,
};
use fearless_simd::Level;
use glam::{Affine3A, Quat, Vec3};
use rayon::prelude::*;
use std::sync::Arc;

/// Which hairs of a groom follow which guides, and where on them: what stays while a scene plays.
#[derive(Clone, Debug)]
pub struct FollowLayout {
    /// The groom: points of the rest pose.
    pub groom: Arc<Groom>,
    /// Guides of each strand as indices into `guides`, and weights; shape `[strands]`.
    pub weights: Vec<GuideWeights>,
    /// The guide strands, in the order of their points.
    pub guides: Vec<u32>,
    /// First point of each guide in the array of all guides' points, and their number at the end; shape `[guides + 1]`.
    pub guide_offsets: Vec<u32>,
    /// For every strand its place among the guides; `u32::MAX` for follow hairs; shape `[strands]`.
    pub guide_of: Vec<u32>,
    /// Where along each of its guides a point rides: fraction of the guide's points, 16 bits; shape `[points]`.
    pub ride: Vec<[u16; 3]>,
    /// How deep each point may be inside a collider, 0 or less [m]; shape `[points]`.
    pub clearance: Vec<f32>,
}

/// The follow hairs of one groom: settings, and the frames of the guides in the current frame.
///
/// # Missing
/// Levels of detail.
pub struct Follow {
    layout: Arc<FollowLayout>,
    effects: Effects,
    /// From the rest pose to now, of each guide point.
    carriers: Vec<Affine3A>,
}

/// What places the follow hairs of one groom as they are now: here, by [`HairInterpolation::place`], or by a viewer on a graphics card.
#[derive(Clone, Copy)]
pub struct HairInterpolation<'a> {
    /// What stays.
    pub layout: &'a Arc<FollowLayout>,
    /// What is laid over the hairs.
    pub effects: Effects,
    /// From the rest pose to now, of each guide point; shape `[guide points]`.
    pub carriers: &'a [Affine3A],
    /// Points of all guides now [m]; shape `[guide points]`.
    pub guide_points: &'a [Vec3],
    /// What hairs are kept out of, as it is at the end of the frame.
    pub obstacles: &'a [MovingCollider],
}

impl std::fmt::Debug for HairInterpolation<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Followed {{ {} guides }}", self.layout.guides.len())
    }
}

impl FollowLayout {
    /// The places of one strand's three guides among all guides' points.
    fn guide_ranges(&self, strand: usize) -> [std::ops::Range<usize>; 3] {
        self.weights[strand].guides.map(|g| self.guide_range(g as usize))
    }

    /// Where the points of a guide, by its place among the guides, are among all guides' points.
    pub fn guide_range(&self, guide: usize) -> std::ops::Range<usize> {
        self.guide_offsets[guide] as usize..self.guide_offsets[guide + 1] as usize
    }

    /// Place of a strand among the guides, if it is one.
    pub fn guide(&self, strand: usize) -> Option<usize> {
        Some(self.guide_of[strand]).filter(|guide| *guide != u32::MAX).map(|guide| guide as usize)
    }

    /// The angles at which curls and flyaways of a strand begin, 0 to 2π [rad]: the curl's, then those of the four waves of the noise.
    pub fn phases(strand: u32) -> [f32; 5] {
        style::phases(strand)
    }
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
        obstacles: &[ColliderPose],
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
        let guides = guides.to_vec();
        let layout = FollowLayout { groom, weights, guides, guide_offsets, guide_of, ride, clearance };
        Self { layout: Arc::new(layout), effects, carriers }
    }

    /// The same hairs, following the same guides, in another rest pose: that of `groom`, among `obstacles`.
    pub fn of(&self, groom: Arc<Groom>, obstacles: &[ColliderPose]) -> Self {
        let FollowLayout { guides, weights, .. } = &*self.layout;
        let name = |w: &GuideWeights| GuideWeights { guides: w.guides.map(|g| guides[g as usize]), ..*w };
        Self::new(groom, guides, &weights.iter().map(name).collect::<Vec<_>>(), self.effects, obstacles)
    }

    /// Lays other effects over the follow hairs from now on; returns those before.
    pub fn set_effects(&mut self, effects: Effects) -> Effects {
        std::mem::replace(&mut self.effects, effects)
    }

    /// Finds how the guides carry the hairs around them now.
    ///
    /// - `guide_points`: points of all guides now [m], as `Simulation::write_points` gives them.
    /// - `turns`: rotation of each guide's root since rest.
    pub fn carry(&mut self, guide_points: &[Vec3], turns: &[Quat]) {
        let FollowLayout { groom, guides, guide_offsets, .. } = &*self.layout;
        carry::update_carriers(groom, guides, guide_offsets, guide_points, turns, &mut self.carriers);
    }

    /// The hairs as they were last carried by guides that are at `guide_points` [m], among `obstacles`.
    pub fn now<'a>(
        &'a self,
        guide_points: &'a [Vec3],
        obstacles: &'a [MovingCollider],
    ) -> HairInterpolation<'a> {
        let Self { layout, effects, carriers } = self;
        HairInterpolation { layout, effects: *effects, carriers, guide_points, obstacles }
    }

    /// Place of a strand among the guides, if it is one.
    pub fn guide(&self, strand: usize) -> Option<usize> {
        self.layout.guide(strand)
    }

    /// Where the points of a guide, by its place among the guides, are among all guides' points.
    pub fn guide_range(&self, guide: usize) -> std::ops::Range<usize> {
        self.layout.guide_range(guide)
    }

    /// Place among the guides of the first that a strand follows; its own where it is one.
    pub fn first_guide(&self, strand: usize) -> usize {
        self.guide(strand).unwrap_or(self.layout.weights[strand].guides[0] as usize)
    }

    /// Writes one number a point of all strands, given those of all guides' points: guides have their own, follow hairs those of their first guide where
    /// they ride on it.
    pub fn spread(&self, of_guides: &[f32], out: &mut [f32]) {
        let layout = &*self.layout;
        let strands = split_by(out, &layout.groom.offsets);
        strands.into_par_iter().enumerate().with_min_len(64).for_each(|(s, out)| {
            let guide = self.first_guide(s);
            let lead = &of_guides[layout.guide_range(guide)];
            if self.guide(s).is_some() {
                out.copy_from_slice(lead);
                return;
            }
            let last = lead.len() - 1;
            for (value, ride) in out.iter_mut().zip(&layout.ride[layout.groom.range(s)]) {
                let at = f32::from(ride[0]) * (last as f32 / f32::from(u16::MAX));
                let i = (at as usize).min(last - 1);
                *value = lead[i] + (lead[i + 1] - lead[i]) * (at - i as f32);
            }
        });
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let FollowLayout { weights, ride, clearance, .. } = &*self.layout;
        size_of_val(&weights[..])
            + size_of_val(&ride[..])
            + size_of_val(&clearance[..])
            + size_of_val(&self.carriers[..])
    }
}

impl HairInterpolation<'_> {
    /// Writes all points of the groom [m]: guides as they are, follow hairs carried by them and kept out of the colliders.
    pub fn place(&self, out: &mut [Vec3]) {
        self.place_every(1, &self.layout.groom.offsets, out);
    }

    /// The same of every `every`-th strand from the first on, 1 or more, for a picture of fewer hairs.
    ///
    /// - `offsets`: first point of each of these in `out`, and the end; shape `[strands + 1]`.
    pub fn place_every(&self, every: usize, offsets: &[u32], out: &mut [Vec3]) {
        let poses: Vec<ColliderPose> = self.obstacles.iter().map(MovingCollider::now).collect();
        let strands = split_by(out, offsets).into_par_iter().enumerate();
        strands.with_min_len(64).for_each(|(s, strand)| self.place_strand(s * every, &poses, strand));
    }

    /// The same of one strand, kept out of `poses`.
    pub fn place_strand(&self, s: usize, poses: &[ColliderPose], strand: &mut [Vec3]) {
        let layout = &**self.layout;
        if let Some(guide) = layout.guide(s) {
            strand.copy_from_slice(&self.guide_points[layout.guide_range(guide)]);
            return;
        }
        let range = layout.groom.range(s);
        let guides = layout.guide_ranges(s);
        let lead = &self.guide_points[guides[0].clone()];
        let (rest, ride) = (&layout.groom.points[range.clone()], &layout.ride[range.clone()]);
        carry::carry(rest, &layout.weights[s], guides.map(|g| &self.carriers[g]), ride, strand);
        if self.effects != Effects::default() {
            style::lay_over(&self.effects, s as u32, lead, ride, strand);
        }
        let clearance = &layout.clearance[range];
        dispatch!(Level::new(), simd => keep_out::keep_out(simd, poses, strand, clearance));
    }
}

/// `array` cut at `offsets`.
pub fn split_by<'a, T>(array: &'a mut [T], offsets: &[u32]) -> Vec<&'a mut [T]> {
    let mut rest = array;
    let mut pieces = Vec::with_capacity(offsets.len().saturating_sub(1));
    for w in offsets.windows(2) {
        let (piece, more) = rest.split_at_mut((w[1] - w[0]) as usize);
        pieces.push(piece);
        rest = more;
    }
    pieces
}
