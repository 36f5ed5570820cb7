//! The height of most frames of a motion, if the first frame has another one.

use glam::Affine3A;

/// Number of frames whose heights are compared, at most.
pub(super) const HEIGHT_SAMPLES: usize = 1000;

/// Returns the height that at least half of the frames have, if less than a fifth of them has that of the first one.
/// Heights are equal within a tenth of the height of the skeleton at rest.
pub(super) fn usual_height(heights: &[f32], rest: &[Affine3A]) -> Option<f32> {
    let first = *heights.first()?;
    let top = rest.iter().map(|w| w.translation.y).fold(f32::NEG_INFINITY, f32::max);
    let near = 0.1 * (top - super::lowest(rest.iter()));
    let share =
        |of: f32| heights.iter().filter(|h| (*h - of).abs() <= near).count() as f32 / heights.len() as f32;
    let mut sorted = heights.to_vec();
    sorted.sort_by(f32::total_cmp);
    let median = sorted[sorted.len() / 2];
    let is_apart = near > 0.0 && (first - median).abs() > near;
    (is_apart && share(first) < 0.2 && share(median) >= 0.5).then_some(median)
}
