//! Finds the range of the color ramp from the visible values.

use super::View;

impl View {
    /// Updates the range of the color ramp: from 0 to the value that a fiftieth of the nonzero points exceed.
    /// While the scene plays, it is smoothed over time. A range that still changed in a paused scene would change its
    /// picture again and again.
    pub fn follow_range(&mut self, values: &[Vec<f32>], guides: bool, playing: bool) {
        if guides || values.is_empty() {
            self.range = [0.0, 1.0];
            return;
        }
        // Only nonzero values count, because some values, such as contact, are 0 at most points.
        let mut some: Vec<f32> = scattered(values).filter(|v| v.is_finite() && *v > 0.0).collect();
        if some.is_empty() {
            return;
        }
        let place = some.len() * 49 / 50;
        let (_, high, _) = some.select_nth_unstable_by(place, f32::total_cmp);
        let high = high.max(1e-12);
        // A range of a very different magnitude, from another value, is replaced immediately.
        let far = self.range[1] > 20.0 * high || self.range[1] < 0.05 * high;
        let smoothed = self.range[1] + 0.1 * (high - self.range[1]);
        self.range = [0.0, if playing && !far { smoothed } else { high }];
    }
}

/// Samples a few thousand values of each groom. A fixed stride could hit the same point of every strand, such
/// as the root.
fn scattered(values: &[Vec<f32>]) -> impl Iterator<Item = f32> {
    // Multiples of the golden ratio are evenly distributed in 0 to 1 (Weyl 1916).
    let place = |k: u32| (f64::from(k) * 0.618_033_988_749_894_9).fract();
    values.iter().filter(|v| !v.is_empty()).flat_map(move |v| {
        (0..v.len().min(4096) as u32).map(move |k| v[(place(k) * v.len() as f64) as usize])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_of_a_paused_scene_does_not_change_from_picture_to_picture() {
        let mut view = View { range: [0.0, 3.0], ..View::default() };
        let values = [vec![1.0; 50]];
        view.follow_range(&values, false, true);
        assert!(view.range[1] > 1.0 && view.range[1] < 3.0, "{:?}", view.range);
        for _ in 0..2 {
            view.follow_range(&values, false, false);
            assert_eq!(view.range, [0.0, 1.0]);
        }
    }

    #[test]
    fn values_are_sampled_evenly_along_strands_of_any_point_count() {
        for points in 2..200usize {
            // Values from 0 at the root to 1 at the tip, for enough strands that any stride would be a
            // multiple of their points.
            let along = |i: usize| (i % points) as f32 / (points - 1) as f32;
            let values = [(0..points * 2048).map(along).collect::<Vec<f32>>(), vec![0.5; 3]];
            let some: Vec<f32> = scattered(&values).collect();
            let mean = some.iter().sum::<f32>() / some.len() as f32;
            assert!((mean - 0.5).abs() < 0.02, "{points} points: {mean}");
            assert!(some.len() <= 2 * 4096);
        }
    }
}
