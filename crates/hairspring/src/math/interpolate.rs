//! Ways with times: between which of its keys something is. A body or a prop that goes by keys, a hand and a charged ball all have such a way; what their
//! keys hold differs, and how they go from one to the next.

/// The keys around `time` [s], by their numbers, and how far it is from the one to the other, 0 to 1; before the first and after the last, that one twice. Of
/// `count` keys, each is `at` a time [s], later than the one before. `None` without keys.
pub fn between(count: usize, at: impl Fn(usize) -> f32, time: f64) -> Option<(usize, usize, f32)> {
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
            assert_eq!(between(3, |k| times[k], time), Some(right), "{time} s");
        }
        assert_eq!(between(0, |_| 0.0, 1.0), None);
    }
}
