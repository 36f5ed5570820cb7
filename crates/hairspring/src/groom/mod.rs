//! Grooms: the strands of a hairstyle as authored, in flat arrays.
//!
//! # Example
//! ```
//! use glam::Vec3;
//! use hairspring::groom::{Groom, sanitize};
//!
//! let strand = [Vec3::ZERO, Vec3::NEG_Y * 0.01, Vec3::splat(f32::NAN), Vec3::NEG_Y * 0.03];
//! let mut groom = Groom::from_strands([strand], 35e-6);
//! let repairs = sanitize(&mut groom);
//! assert_eq!((repairs.non_finite_points, repairs.total()), (1, 1));
//! assert!((groom.strand_length(0) - 0.03).abs() < 1e-6);
//! ```

mod bind;
mod curve;
mod grow;
mod precision;
mod sanitize;
mod stray;
mod thicken;
mod trim;

pub use bind::{RootBinding, bind_roots, bind_roots_where};
pub use curve::MortonCurve;
pub use grow::{Growth, grow, grow_along};
pub use precision::{Imprecise, MAX_COORDINATE, first_imprecise, first_imprecise_moved};
pub use sanitize::{Repairs, sanitize};
pub use stray::has_stray_point;
pub use thicken::{Thicken, thicken};
pub use trim::{cut, keep_strands, thin};

use crate::settings::{Check, Validate, check};
use glam::{Vec2, Vec3};

/// The strands of a hairstyle: the points of all strands one after the other, in meters, right-handed, Y up.
///
/// Strand `s` owns the points `offsets[s]..offsets[s + 1]`, root first. A groom is input data: it does not
/// change during the simulation.
///
/// Per-strand arrays are either empty or `strand_count()` long; per-point arrays are either empty or
/// `point_count()` long.
///
/// For an example, see [`groom`](crate::groom).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Groom {
    /// Positions, root to tip, strand after strand [m]; shape `[points]`.
    pub points: Vec<Vec3>,
    /// Fiber radius at each point [m]; shape `[points]`, never empty when `points` is not.
    pub radii: Vec<f32>,
    /// Index of each strand's first point, followed by the number of points; shape `[strands + 1]` (`[0]` for
    /// a groom without strands).
    pub offsets: Vec<u32>,
    /// Binding of each root to the scalp mesh; shape `[strands]`, or empty while unbound.
    pub roots: Vec<RootBinding>,
    /// Group of each strand (a part of the style: fringe, ponytail, …), as an index into `group_names`; shape
    /// `[strands]`, or empty: all strands are in group 0.
    pub groups: Vec<u16>,
    /// Names of the groups; may be shorter than the highest group index.
    pub group_names: Vec<String>,
    /// Texture coordinates of each root on the scalp; shape `[strands]`, or empty.
    pub root_uvs: Vec<Vec2>,
    /// Linear RGB color of each point, 0 to 1; shape `[points]`, or empty: the material's color.
    pub colors: Vec<Vec3>,
    /// Per-strand multipliers of the group's material; shape `[strands]`, or empty: all 1.
    pub scales: Vec<StrandScale>,
    /// Guides of each strand, as given by the file; shape `[strands]`, or empty: guides are chosen by the
    /// `follow` module.
    pub guides: Vec<GuideWeights>,
}

/// Root radius of a strand if the file has none [m]: 35 µm, a typical human hair (see `material`).
pub const DEFAULT_RADIUS: f32 = 35e-6;

/// Largest multiplier of a parameter of a material, for a strand or along it.
pub(crate) const MAX_FACTOR: f32 = 1e4;

/// Smallest multiplier of a parameter that may not be 0.
pub(crate) const MIN_FACTOR: f32 = 1e-4;

/// Dimensionless multipliers of the group's material for one strand, 0 to 10,000 each. Default: all 1.
///
/// ```
/// use hairspring::groom::StrandScale;
///
/// let stiff = StrandScale { bend: 2.0, ..Default::default() };
/// assert_eq!((stiff.bend, stiff.drag), (2.0, 1.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrandScale {
    /// Multiplier of the bending stiffness.
    pub bend: f32,
    /// Multiplier of the air drag.
    pub drag: f32,
    /// Multiplier of the fiber's damping.
    pub damping: f32,
    /// Multiplier of the global shape's frequency.
    pub global_shape: f32,
    /// Multiplier of friction. The product is clamped to 1.
    pub friction: f32,
    /// Multiplier of the static charge.
    pub charge: f32,
    /// Multiplier of `Material::radius`, 0.0001 or more. It has no effect on radii of the groom.
    pub radius: f32,
    /// Multiplier of the flatness, which is 0.05 to 1.
    pub flatness: f32,
    /// Multiplier of the tether, which is at least 1.
    pub tether: f32,
}

impl Default for StrandScale {
    fn default() -> Self {
        Self {
            bend: 1.0,
            drag: 1.0,
            damping: 1.0,
            global_shape: 1.0,
            friction: 1.0,
            charge: 1.0,
            radius: 1.0,
            flatness: 1.0,
            tether: 1.0,
        }
    }
}

impl Validate for StrandScale {
    fn checks(&self) -> Vec<Check> {
        let Self { bend, drag, damping, global_shape, friction, charge, radius, flatness, tether } = *self;
        let factors = [
            ("bend", bend),
            ("drag", drag),
            ("damping", damping),
            ("global_shape", global_shape),
            ("friction", friction),
            ("charge", charge),
            ("flatness", flatness),
            ("tether", tether),
        ];
        let factors = factors.map(|(key, x)| check((0.0..=MAX_FACTOR).contains(&x), key, "0 to 10000"));
        let radius = check((MIN_FACTOR..=MAX_FACTOR).contains(&radius), "radius", "0.0001 to 10000");
        factors.into_iter().chain([radius]).collect()
    }
}

/// Up to three guide strands (indices of strands of the same groom) and their weights, which sum to 1
/// ([`Follow::new`](crate::follow::Follow::new) divides them by their sum).
///
/// Unused entries have weight 0 and repeat the first guide.
///
/// For an example, see [`follow`](crate::follow).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideWeights {
    /// Strand indices of the guides.
    pub guides: [u32; 3],
    /// Weight of each guide, 0 to 1.
    pub weights: [f32; 3],
}

impl Groom {
    /// Reverses the points of every strand, with their radii and colors, so that the root is at the other end.
    /// Removes the bindings of the roots.
    pub fn reverse(&mut self) {
        self.reverse_strands(|_, _| true);
    }

    /// Reverses each strand that `reversed` selects by its index and points, and returns their number. Removes the
    /// bindings of the roots if there are any.
    ///
    /// ```
    /// use hairspring::{glam::Vec3, groom::Groom};
    ///
    /// let strand = [Vec3::Y * 0.2, Vec3::Y * 0.1, Vec3::ZERO];
    /// let mut groom = Groom::from_strands([strand], 40e-6);
    /// // The root is the lower end.
    /// assert_eq!(groom.reverse_strands(|_, points| points[0].y > points[2].y), 1);
    /// assert_eq!(groom.points[0], Vec3::ZERO);
    /// ```
    pub fn reverse_strands(&mut self, reversed: impl Fn(usize, &[Vec3]) -> bool) -> usize {
        let mut count = 0;
        for s in 0..self.strand_count() {
            if !reversed(s, self.strand(s)) {
                continue;
            }
            count += 1;
            let run = self.range(s);
            self.points[run.clone()].reverse();
            if let Some(radii) = self.radii.get_mut(run.clone()) {
                radii.reverse();
            }
            if let Some(colors) = self.colors.get_mut(run) {
                colors.reverse();
            }
        }
        if count > 0 {
            self.roots.clear();
        }
        count
    }

    /// Creates a groom from strands, each a list of points from root to tip [m], all with the same radius
    /// [m].
    pub fn from_strands<S: AsRef<[Vec3]>>(strands: impl IntoIterator<Item = S>, radius: f32) -> Self {
        let mut groom = Groom { offsets: vec![0], ..Groom::default() };
        for strand in strands {
            groom.points.extend_from_slice(strand.as_ref());
            groom.offsets.push(groom.points.len() as u32);
        }
        groom.radii = vec![radius; groom.points.len()];
        groom
    }

    /// Returns the number of strands.
    pub fn strand_count(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Returns the number of points in all strands.
    pub fn point_count(&self) -> usize {
        self.points.len()
    }

    /// Returns the index range of the points of strand `s`.
    ///
    /// # Panics
    /// If there is no strand `s`.
    pub fn range(&self, s: usize) -> std::ops::Range<usize> {
        self.offsets[s] as usize..self.offsets[s + 1] as usize
    }

    /// Returns the points of strand `s`, root first [m].
    ///
    /// # Panics
    /// If there is no strand `s`, or the arrays do not fit together.
    pub fn strand(&self, s: usize) -> &[Vec3] {
        &self.points[self.range(s)]
    }

    /// Returns the group of strand `s`; 0 if the groom has no groups.
    pub fn group(&self, s: usize) -> u16 {
        self.groups.get(s).copied().unwrap_or(0)
    }

    /// Returns the multipliers of strand `s`; all 1 if the groom has none.
    pub fn scale(&self, s: usize) -> StrandScale {
        self.scales.get(s).copied().unwrap_or_default()
    }

    /// Returns the length of strand `s` along its points [m].
    ///
    /// # Panics
    /// If there is no strand `s`, or the arrays do not fit together.
    pub fn strand_length(&self, s: usize) -> f32 {
        self.strand(s).windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    /// Returns the bounding box of all points, `(min, max)` [m]; `None` if there are no points.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let first = *self.points.first()?;
        Some(self.points.iter().fold((first, first), |(lo, hi), p| (lo.min(*p), hi.max(*p))))
    }
}
