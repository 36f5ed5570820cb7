//! Lookup of the two keyframes around a time. Keyed bodies and props, hands and the charged ball all use it;
//! what a key holds and how two keys are interpolated differs between them.

/// Returns the indices of the two keys around `time` [s] and the interpolation fraction between them, 0 to 1.
/// Before the first key and after the last, both indices are that key. `at` returns the time of a key [s];
/// the `count` keys are in ascending order of time. Returns `None` if there are no keys.
///
/// ```
/// use hairspring::math::find_keys;
///
/// let times = [1.0, 2.0, 4.0];
/// assert_eq!(find_keys(3, |k| times[k], 3.5), Some((1, 2, 0.75)));
/// ```
pub fn find_keys(count: usize, at: impl Fn(usize) -> f32, time: f64) -> Option<(usize, usize, f32)> {
    let last = count.checked_sub(1)?;
    let at = |key| f64::from(at(key));
    let next = (0..count).take_while(|key| at(*key) <= time).count();
    let (a, b) = (next.saturating_sub(1), next.min(last));
    let share = if a < b { ((time - at(a)) / (at(b) - at(a))).clamp(0.0, 1.0) } else { 0.0 };
    Some((a, b, share as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_between_the_keys_around_it_and_at_the_ends_outside() {
        let times = [1.0, 2.0, 4.0];
        for (time, right) in [
            (0.0, (0, 0, 0.0)),
            (1.0, (0, 1, 0.0)),
            (1.5, (0, 1, 0.5)),
            (2.0, (1, 2, 0.0)),
            (3.5, (1, 2, 0.75)),
            (4.0, (2, 2, 0.0)),
            (9.0, (2, 2, 0.0)),
        ] {
            assert_eq!(find_keys(3, |k| times[k], time), Some(right), "{time} s");
        }
        assert_eq!(find_keys(0, |_| 0.0, 1.0), None);
    }
}
