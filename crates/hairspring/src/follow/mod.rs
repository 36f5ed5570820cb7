//! Follow hairs: the hairs that are not simulated but interpolated from up to three guides.
//!
//! Each guide moves a point p₀ of the rest pose rigidly. Let g₀ be the guide's rest point at the same arc
//! length, x its current position and R the rotation of the guide's frame there since rest:
//!
//! ```text
//! p = Σ w (x + R (p₀ − g₀))
//! ```
//!
//! This keeps the rest offset in the guide's frame without storing an offset. At rest R = I, and p = p₀ up to
//! rounding.
//!
//! # Example
//! ```
//! use glam::{Quat, Vec3};
//! use hairspring::{
//!     follow::{Follow, assign_guides, choose_guides},
//!     groom::Groom,
//!     settings::Effects,
//! };
//! use std::sync::Arc;
//!
//! let strand = |s| (0..8).map(|i| Vec3::new(0.01 * s as f32, -0.01 * i as f32, 0.0)).collect::<Vec<_>>();
//! let groom = Arc::new(Groom::from_strands((0..10).map(strand), 35e-6));
//! let guides = choose_guides(&groom, 2);
//! let weights = assign_guides(&groom, &guides);
//! let mut follow = Follow::new(groom.clone(), &guides, &weights, Effects::default(), &[]);
//! // The guides move by 1 m; `Simulation::write_points` gives their points in a program.
//! let moved: Vec<Vec3> = guides.iter().flat_map(|s| groom.strand(*s as usize)).map(|p| *p + Vec3::Z).collect();
//! follow.update_guide_transforms(&moved, &[Quat::IDENTITY; 2]);
//! let mut all = vec![Vec3::ZERO; groom.point_count()];
//! follow.interpolation(&moved, &[]).place(&mut all);
//! assert!(all.iter().zip(&groom.points).all(|(p, rest)| p.distance(*rest + Vec3::Z) < 1e-5));
//! ```

mod carry;
mod choose;
mod keep_out;
mod sheet_side;
mod style;

pub use choose::{assign_guides, choose_guides};

use crate::parallel::prelude::*;
use crate::{
    collide::{ColliderPose, MovingCollider},
    groom::{Groom, GuideWeights},
    settings::Effects,
    simd::dispatch::dispatch,
};
use fearless_simd::Level;
use glam::{Affine3A, Quat, Vec3};
use std::sync::Arc;

/// The static part of the interpolation: which guides each hair of a groom follows, and at which points of
/// them.
///
/// For an example, see [`follow`](crate::follow).
#[derive(Clone, Debug)]
pub struct FollowLayout {
    /// The groom, with the points of the rest pose.
    pub groom: Arc<Groom>,
    /// Guides of each strand as indices into `guides`, and weights; shape `[strands]`.
    pub weights: Vec<GuideWeights>,
    /// Strand indices of the guides, in the order of their points.
    pub guides: Vec<u32>,
    /// First point of each guide in the array of all guide points, followed by its length; shape `[guides +
    /// 1]`.
    pub guide_offsets: Vec<u32>,
    /// Index of each strand among the guides; `u32::MAX` for follow hairs; shape `[strands]`.
    pub guide_indices: Vec<u32>,
    /// Coordinate of each point on each of its guides, as a 16-bit fraction of the guide's points; shape
    /// `[points]`.
    pub guide_coordinates: Vec<[u16; 3]>,
    /// Smallest signed distance from a collider that each point may have, 0 or less [m]; shape `[points]`.
    pub clearance: Vec<f32>,
    /// Whether a thin shell separates each point from its first guide in the rest pose. Such points may be on
    /// either side of shells. Shape `[points]`; empty if there is no such point.
    pub apart: Vec<bool>,
}

/// The follow hairs of one groom: styling settings, and the transforms of the guides in the current frame.
///
/// # Limitations
/// There are no levels of detail.
///
/// For an example, see [`follow`](crate::follow).
pub struct Follow {
    layout: Arc<FollowLayout>,
    effects: Effects,
    /// Transform from rest to the current pose for each guide point.
    guide_transforms: Vec<Affine3A>,
}

/// All data needed to place the follow hairs of one groom in the current frame, either on the CPU by
/// [`HairInterpolation::place`] or by a renderer on the GPU.
///
/// For an example, see [`follow`](crate::follow).
#[derive(Clone, Copy)]
pub struct HairInterpolation<'a> {
    /// The static part.
    pub layout: &'a Arc<FollowLayout>,
    /// Styling of the follow hairs.
    pub effects: Effects,
    /// Transform from rest to the current pose for each guide point; shape `[guide points]`.
    pub guide_transforms: &'a [Affine3A],
    /// Current positions of all guide points [m]; shape `[guide points]`.
    pub guide_points: &'a [Vec3],
    /// Colliders that hairs are kept out of, at their poses at the end of the frame.
    pub colliders: &'a [MovingCollider],
}

impl std::fmt::Debug for Follow {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Follow")
            .field("strands", &self.layout.weights.len())
            .field("guides", &self.layout.guides.len())
            .field("effects", &self.effects)
            .finish_non_exhaustive()
    }
}

impl std::fmt::Debug for HairInterpolation<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "HairInterpolation {{ {} guides }}", self.layout.guides.len())
    }
}

impl FollowLayout {
    /// Returns the ranges of one strand's three guides in the array of all guide points.
    fn guide_ranges(&self, strand: usize) -> [std::ops::Range<usize>; 3] {
        self.weights[strand].guides.map(|g| self.guide_range(g as usize))
    }

    /// Returns the range of a guide, given by its index among the guides, in the array of all guide points.
    ///
    /// # Panics
    /// If there is no such guide.
    pub fn guide_range(&self, guide: usize) -> std::ops::Range<usize> {
        self.guide_offsets[guide] as usize..self.guide_offsets[guide + 1] as usize
    }

    /// Returns the index of a strand among the guides, or `None` if it is not a guide.
    ///
    /// # Panics
    /// If there is no such strand.
    pub fn guide(&self, strand: usize) -> Option<usize> {
        Some(self.guide_indices[strand]).filter(|guide| *guide != u32::MAX).map(|guide| guide as usize)
    }

    /// Returns the phases of a strand's curl and of the four waves of its flyaway noise, in this order, 0 to
    /// 2π [rad].
    pub fn phases(strand: u32) -> [f32; 5] {
        style::phases(strand)
    }
}

impl Follow {
    /// Creates the follow hairs of `groom`.
    ///
    /// - `guides`: the simulated strands.
    /// - `weights`: for every strand, strands of the groom that are in `guides`; shape `[strands]`. Weights that do not
    ///   sum to 1 are divided by their sum. If all three are 0, the strand follows its first guide.
    /// - `colliders`: colliders at rest. Points that start inside may stay as deep as they are.
    ///
    /// # Panics
    /// If `guides` or `weights` name a strand that does not exist or is no guide, `weights` is too short, a weight is
    /// negative or not finite, or a guide has fewer than 2 points.
    pub fn new(
        groom: Arc<Groom>,
        guides: &[u32],
        weights: &[GuideWeights],
        effects: Effects,
        colliders: &[ColliderPose],
    ) -> Self {
        let mut guide_indices = vec![u32::MAX; groom.strand_count()];
        let mut guide_offsets = vec![0];
        for (k, s) in guides.iter().enumerate() {
            assert!(groom.range(*s as usize).len() >= 2, "guide {s} must have at least 2 points");
            guide_indices[*s as usize] = k as u32;
            guide_offsets.push(guide_offsets[k] + groom.range(*s as usize).len() as u32);
        }
        let weights: Vec<GuideWeights> = weights
            .iter()
            .map(|w| GuideWeights {
                guides: w.guides.map(|g| guide_indices[g as usize]),
                weights: normalized(w.weights),
            })
            .collect();
        let guide_coordinates = carry::rides(&groom, guides, &weights);
        let clearance = groom
            .points
            .par_iter()
            .map(|p| colliders.iter().map(|o| o.distance(*p)).fold(0.0, f32::min))
            .collect();
        let apart = sheet_side::apart(&groom, guides, &weights, &guide_coordinates, colliders);
        let guide_transforms = vec![Affine3A::IDENTITY; *guide_offsets.last().unwrap_or(&0) as usize];
        let guides = guides.to_vec();
        let layout = FollowLayout {
            groom,
            weights,
            guides,
            guide_offsets,
            guide_indices,
            guide_coordinates,
            clearance,
            apart,
        };
        Self { layout: Arc::new(layout), effects, guide_transforms }
    }

    /// Creates the same hairs with the same guides for another rest pose: that of `groom`, with `colliders`.
    ///
    /// # Panics
    /// If `groom` has other strands or other numbers of points.
    pub fn with_rest_pose(&self, groom: Arc<Groom>, colliders: &[ColliderPose]) -> Self {
        let FollowLayout { guides, weights, .. } = &*self.layout;
        let name = |w: &GuideWeights| GuideWeights { guides: w.guides.map(|g| guides[g as usize]), ..*w };
        Self::new(groom, guides, &weights.iter().map(name).collect::<Vec<_>>(), self.effects, colliders)
    }

    /// Replaces the styling of the follow hairs and returns the previous one.
    pub fn set_effects(&mut self, effects: Effects) -> Effects {
        std::mem::replace(&mut self.effects, effects)
    }

    /// Computes the current transforms of the guides.
    ///
    /// - `guide_points`: current points of all guides [m], as written by `Simulation::write_points`.
    /// - `turns`: rotation of each guide's root since rest.
    ///
    /// # Panics
    /// If an array is too short.
    pub fn update_guide_transforms(&mut self, guide_points: &[Vec3], turns: &[Quat]) {
        let FollowLayout { groom, guides, guide_offsets, .. } = &*self.layout;
        carry::update_guide_transforms(
            groom,
            guides,
            guide_offsets,
            guide_points,
            turns,
            &mut self.guide_transforms,
        );
    }

    /// Returns the data of the current frame: the last computed transforms, with guides at `guide_points` [m]
    /// and `colliders`.
    pub fn interpolation<'a>(
        &'a self,
        guide_points: &'a [Vec3],
        colliders: &'a [MovingCollider],
    ) -> HairInterpolation<'a> {
        let Self { layout, effects, guide_transforms } = self;
        HairInterpolation { layout, effects: *effects, guide_transforms, guide_points, colliders }
    }

    /// Returns the index of a strand among the guides, or `None` if it is not a guide.
    ///
    /// # Panics
    /// If there is no such strand.
    pub fn guide(&self, strand: usize) -> Option<usize> {
        self.layout.guide(strand)
    }

    /// Returns the range of a guide, given by its index among the guides, in the array of all guide points.
    ///
    /// # Panics
    /// If there is no such guide.
    pub fn guide_range(&self, guide: usize) -> std::ops::Range<usize> {
        self.layout.guide_range(guide)
    }

    /// Returns the index among the guides of the first guide of a strand, or its own if it is a guide.
    ///
    /// # Panics
    /// If there is no such strand.
    pub fn first_guide(&self, strand: usize) -> usize {
        self.guide(strand).unwrap_or(self.layout.weights[strand].guides[0] as usize)
    }

    /// Writes one value for each point of all strands, given the values of all guide points. Guides keep
    /// their own values; follow hairs interpolate those of their first guide.
    ///
    /// # Panics
    /// If an array is too short.
    pub fn interpolate_values(&self, of_guides: &[f32], out: &mut [f32]) {
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
            for (value, ride) in out.iter_mut().zip(&layout.guide_coordinates[layout.groom.range(s)]) {
                let at = f32::from(ride[0]) * (last as f32 / f32::from(u16::MAX));
                let i = (at as usize).min(last - 1);
                *value = lead[i] + (lead[i + 1] - lead[i]) * (at - i as f32);
            }
        });
    }

    /// Returns the memory used, in bytes.
    pub fn bytes(&self) -> usize {
        let FollowLayout { weights, guide_coordinates, clearance, apart, .. } = &*self.layout;
        size_of_val(&weights[..])
            + size_of_val(&guide_coordinates[..])
            + size_of_val(&clearance[..])
            + size_of_val(&apart[..])
            + size_of_val(&self.guide_transforms[..])
    }
}

/// Returns weights with the sum 1. Those that have it up to rounding are unchanged.
fn normalized(weights: [f32; 3]) -> [f32; 3] {
    let valid = weights.iter().all(|w| w.is_finite() && *w >= 0.0);
    assert!(valid, "weights of guides must be finite and 0 or more, not {weights:?}");
    let sum: f32 = weights.iter().sum();
    match sum {
        0.0 => [1.0, 0.0, 0.0],
        _ if (sum - 1.0).abs() < 1e-5 => weights,
        _ => weights.map(|w| w / sum),
    }
}

impl HairInterpolation<'_> {
    /// Writes all points of the groom [m]. Guides keep their points; follow hairs are interpolated and moved
    /// out of the colliders. Of a thin shell, they stay on the side of their first guide.
    ///
    /// # Panics
    /// If an array has another shape.
    pub fn place(&self, out: &mut [Vec3]) {
        self.place_every(1, &self.layout.groom.offsets, out);
    }

    /// Like [`Self::place`], but only for every `every`-th strand (1 or more), starting with the first. Used
    /// to draw fewer hairs.
    ///
    /// - `offsets`: first point of each of these strands in `out`, followed by the end; shape `[strands +
    ///   1]`.
    ///
    /// # Panics
    /// If an array has another shape.
    pub fn place_every(&self, every: usize, offsets: &[u32], out: &mut [Vec3]) {
        let poses: Vec<ColliderPose> = self.colliders.iter().map(MovingCollider::end_pose).collect();
        let strands = split_by(out, offsets).into_par_iter().enumerate();
        strands.with_min_len(64).for_each(|(s, strand)| self.place_strand(s * every, &poses, strand));
    }

    /// Like [`Self::place`], for one strand and the collider poses `poses`.
    ///
    /// # Panics
    /// If there is no such strand, or `strand` has another number of points.
    pub fn place_strand(&self, s: usize, poses: &[ColliderPose], strand: &mut [Vec3]) {
        let layout = &**self.layout;
        if let Some(guide) = layout.guide(s) {
            strand.copy_from_slice(&self.guide_points[layout.guide_range(guide)]);
            return;
        }
        let range = layout.groom.range(s);
        let guides = layout.guide_ranges(s);
        let lead = &self.guide_points[guides[0].clone()];
        let (rest, ride) = (&layout.groom.points[range.clone()], &layout.guide_coordinates[range.clone()]);
        carry::carry(rest, &layout.weights[s], guides.map(|g| &self.guide_transforms[g]), ride, strand);
        if self.effects != Effects::default() {
            style::apply_styling(&self.effects, s as u32, lead, ride, strand);
        }
        let apart = layout.apart.get(range.clone());
        sheet_side::keep_on_side(poses, lead, ride, apart, strand);
        let clearance = &layout.clearance[range];
        dispatch!(Level::new(), simd => keep_out::keep_out(simd, poses, strand, clearance));
    }
}

/// Splits `array` at `offsets`.
///
/// ```
/// use hairspring::follow::split_by;
///
/// let mut values = [1, 2, 3];
/// assert_eq!(split_by(&mut values, &[0, 1, 3]), [&[1][..], &[2, 3]]);
/// ```
///
/// # Panics
/// If the offsets descend or go past the end of the array.
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
