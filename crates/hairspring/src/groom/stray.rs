//! Stray points of a strand: points far from their place.

use glam::Vec3;

/// Length of a segment to a stray point, at least, over that of the strand's median segment [1].
const STRAY: f32 = 20.0;

/// Length of a segment to a stray point, at least [m].
const STRAY_LENGTH: f32 = 0.1;

/// Length below which a segment says nothing about the spacing of a strand's points [m].
const DOUBLED: f32 = 1e-5;

/// Returns whether a point of a strand [m] probably lies far from its place: a segment is longer than 10 cm and than 20
/// times the median segment. Segments of 10 µm and less do not count. [`sanitize`](super::sanitize) keeps such points.
///
/// ```
/// use glam::Vec3;
/// use hairspring::groom::has_stray_point;
///
/// let mut strand = [0, 1, 2, 3, 4].map(|i| Vec3::Y * (1.6 + 0.03 * i as f32));
/// assert!(!has_stray_point(&strand));
/// strand[0] = Vec3::ZERO;
/// assert!(has_stray_point(&strand));
/// ```
pub fn has_stray_point(strand: &[Vec3]) -> bool {
    stray_length(strand).is_some()
}

/// Returns the length above which a segment leads to a stray point [m], if the strand has such a segment.
pub(super) fn stray_length(points: &[Vec3]) -> Option<f32> {
    let lengths = || points.windows(2).map(|w| w[0].distance(w[1]));
    let longest = lengths().fold(0.0, f32::max);
    if longest <= STRAY_LENGTH {
        return None;
    }
    let mut lengths: Vec<f32> = lengths().filter(|length| *length > DOUBLED).collect();
    lengths.sort_by(f32::total_cmp);
    let median = lengths[(lengths.len() - 1) / 2];
    let limit = (STRAY * median).max(STRAY_LENGTH);
    (longest > limit).then_some(limit)
}
