//! Limits on the distance of strands from the origin: the resolution of single precision decreases with
//! distance.

use super::Groom;
use glam::Affine3A;
use std::fmt;

/// Largest coordinate that is simulated [m]. Beyond it, single precision resolves no better than 6 cm, and
/// products of lengths may overflow.
pub const MAX_COORDINATE: f32 = 1e6;

/// Distance from the origin within which strands of any size are accepted [m]: positions are resolved to 8
/// µm.
const ALWAYS_PRECISE_DISTANCE: f32 = 128.0;

/// Largest spacing of adjacent floats relative to a segment [1]: the segment's direction is then known to
/// within a degree.
const MAX_SPACING: f32 = 0.02;

/// Error for a strand that is too far from the origin for the length of its segments.
///
/// For an example, see [`first_imprecise`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Imprecise {
    /// Index of the strand.
    pub strand: usize,
    /// Largest coordinate of its nearest point, in absolute value [m].
    pub distance: f32,
    /// Spacing of adjacent floats at that distance [m].
    pub resolution: f32,
    /// Median length of its segments, or the mean if the median is zero [m].
    pub segment: f32,
}

impl fmt::Display for Imprecise {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { strand, distance, resolution, segment } = self;
        write!(
            f,
            "strand {strand} is {distance:.4} m from the origin, where single precision resolves {resolution:.1e} m, and its segments are {segment:.1e} m \
             long: move the scene nearer to the origin"
        )
    }
}

/// Returns the first strand whose segments are too short for its distance from the origin, or that is beyond
/// [`MAX_COORDINATE`]. Single outlying points do not count; [`sanitize`](super::sanitize) corrects them.
///
/// ```
/// use glam::Vec3;
/// use hairspring::groom::{Groom, first_imprecise};
///
/// // Segments of 1 mm, 10 km from the origin.
/// let strand: Vec<Vec3> = (0..8).map(|i| Vec3::new(1e4, 0.001 * i as f32, 0.0)).collect();
/// let found = first_imprecise(&Groom::from_strands([strand], 35e-6)).unwrap();
/// assert_eq!((found.strand, found.distance), (0, 1e4));
/// ```
pub fn first_imprecise(groom: &Groom) -> Option<Imprecise> {
    first_imprecise_moved(groom, &Affine3A::IDENTITY)
}

/// Like [`first_imprecise`], for a groom that is moved rigidly by `by`.
///
/// ```
/// use hairspring::{
///     glam::{Affine3A, Vec3},
///     groom::{Groom, first_imprecise_moved},
/// };
///
/// let strand: Vec<Vec3> = (0..8).map(|i| Vec3::Y * (0.001 * i as f32)).collect();
/// let groom = Groom::from_strands([strand], 35e-6);
/// assert!(first_imprecise_moved(&groom, &Affine3A::from_translation(Vec3::X * 1e4)).is_some());
/// ```
pub fn first_imprecise_moved(groom: &Groom, by: &Affine3A) -> Option<Imprecise> {
    let of_strand = |strand: usize| {
        let points = groom.strand(strand);
        let finite = points.iter().filter(|p| p.is_finite());
        let distance = finite
            .map(|p| by.transform_point3(*p).abs().max_element())
            .reduce(f32::min)
            .filter(|d| *d > ALWAYS_PRECISE_DISTANCE)?;
        let mut segments: Vec<f32> =
            points.windows(2).map(|w| w[0].distance(w[1])).filter(|length| !length.is_nan()).collect();
        segments.sort_by(f32::total_cmp);
        let mean = segments.iter().sum::<f32>() / segments.len().max(1) as f32;
        let segment =
            segments.get(segments.len() / 2).copied().filter(|median| *median > 0.0).unwrap_or(mean);
        let resolution = distance.next_up() - distance;
        let coarse = segment > 0.0 && resolution > MAX_SPACING * segment;
        (coarse || distance > MAX_COORDINATE).then_some(Imprecise { strand, distance, resolution, segment })
    };
    (0..groom.strand_count()).find_map(of_strand)
}
