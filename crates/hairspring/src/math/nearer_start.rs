//! The start pose of something that may have been teleported with the hair.

/// Returns the start of a frame of something that may or may not have moved with hair that was teleported: `start`,
/// or `carried`, the start if it moved along. The one nearer to the end is used. `distance` returns the distance from
/// the end, in any increasing measure.
pub(crate) fn nearer_start<T>(start: T, carried: T, distance: impl Fn(&T) -> f32) -> T {
    if distance(&carried) < distance(&start) { carried } else { start }
}
