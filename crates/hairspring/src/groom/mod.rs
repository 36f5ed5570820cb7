//! A groom: the strands of one hairstyle as flat arrays, as an artist made them.

mod bind;
mod curve;
mod grow;
mod precision;
mod sanitize;
mod thicken;

pub use bind::{RootBinding, bind_roots, bind_roots_where};
pub use curve::Curve;
pub use grow::{Growth, grow};
pub use precision::{Imprecise, MAX_COORDINATE, first_imprecise};
pub use sanitize::{Repairs, sanitize};
pub use thicken::{Thicken, thicken};

use glam::{Vec2, Vec3};

/// The strands of a hairstyle: points of all strands one after the other, in metres, right-handed, Y up.
///
/// Strand `s` owns the points `offsets[s]..offsets[s + 1]`, root first. A groom is data, not state:
/// nothing in it changes while it is simulated.
///
/// Per-strand arrays are empty, or `strand_count()` long; per-point arrays are empty, or `point_count()` long.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Groom {
    /// Positions, root to tip, strand after strand [m]; shape `[points]`.
    pub points: Vec<Vec3>,
    /// Fibre radius at each point [m]; shape `[points]`, never empty when `points` is not.
    pub radii: Vec<f32>,
    /// Index of each strand's first point, and the number of points at the end; shape `[strands + 1]`
    /// (`[0]` for a groom without strands).
    pub offsets: Vec<u32>,
    /// Where each root sits on the scalp mesh; shape `[strands]`, or empty while unbound.
    pub roots: Vec<RootBinding>,
    /// Group (part of the style: fringe, ponytail, …) of each strand, an index into `group_names`;
    /// shape `[strands]`, or empty: all strands in group 0.
    pub groups: Vec<u16>,
    /// Names of the groups; may be shorter than the highest group index.
    pub group_names: Vec<String>,
    /// Texture coordinates of each root on the scalp; shape `[strands]`, or empty.
    pub root_uvs: Vec<Vec2>,
    /// Linear RGB colour of each point, 0 to 1; shape `[points]`, or empty: the material's colour.
    pub colors: Vec<Vec3>,
    /// Per-strand multipliers over the group's material; shape `[strands]`, or empty: all one.
    pub scales: Vec<StrandScale>,
    /// The guides that drive each strand, as the file gives them; shape `[strands]`, or empty: the follow room chooses.
    pub guides: Vec<GuideWeights>,
}

/// Root radius of a strand in a file that says nothing [m]: 35 µm, the typical human hair (see `material`).
pub const DEFAULT_RADIUS: f32 = 35e-6;

/// Dimensionless multipliers over the group's material for one strand. Default: all 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrandScale {
    /// Over bending stiffness; 0 or more.
    pub bend: f32,
    /// Over the drag of the air; 0 or more.
    pub drag: f32,
    /// Over the damping of the fibre; 0 or more.
    pub damping: f32,
    /// Over the pull of the global shape; 0 or more.
    pub global_shape: f32,
}

impl Default for StrandScale {
    fn default() -> Self {
        Self { bend: 1.0, drag: 1.0, damping: 1.0, global_shape: 1.0 }
    }
}

/// Up to three guide strands (indices of strands of the same groom) and their weights, which sum to 1.
///
/// Unused places hold weight 0 and repeat the first guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideWeights {
    /// Strand indices of the guides.
    pub guides: [u32; 3],
    /// Weight of each guide, 0 to 1.
    pub weights: [f32; 3],
}

impl Groom {
    /// A groom of the given strands (each a root-to-tip list of points [m]), all of one radius [m].
    pub fn from_strands<S: AsRef<[Vec3]>>(strands: impl IntoIterator<Item = S>, radius: f32) -> Self {
        let mut groom = Groom { offsets: vec![0], ..Groom::default() };
        for strand in strands {
            groom.points.extend_from_slice(strand.as_ref());
            groom.offsets.push(groom.points.len() as u32);
        }
        groom.radii = vec![radius; groom.points.len()];
        groom
    }

    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Number of points in all strands.
    pub fn point_count(&self) -> usize {
        self.points.len()
    }

    /// Index range of the points of strand `s`.
    pub fn range(&self, s: usize) -> std::ops::Range<usize> {
        self.offsets[s] as usize..self.offsets[s + 1] as usize
    }

    /// The points of strand `s`, root first [m].
    pub fn strand(&self, s: usize) -> &[Vec3] {
        &self.points[self.range(s)]
    }

    /// Group of strand `s`; 0 where the groom has none.
    pub fn group(&self, s: usize) -> u16 {
        self.groups.get(s).copied().unwrap_or(0)
    }

    /// Multipliers of strand `s`; all 1 where the groom has none.
    pub fn scale(&self, s: usize) -> StrandScale {
        self.scales.get(s).copied().unwrap_or_default()
    }

    /// Length of strand `s` along its points [m].
    pub fn strand_length(&self, s: usize) -> f32 {
        self.strand(s).windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    /// Smallest box around all points, `(min, max)` [m]; `None` without points.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let first = *self.points.first()?;
        Some(self.points.iter().fold((first, first), |(lo, hi), p| (lo.min(*p), hi.max(*p))))
    }
}
