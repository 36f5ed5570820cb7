//! Weights of a vertex or a root over its joints.

/// `weights` without what is negative or not finite, summing to 1; all on the first joint where nothing is left.
pub(crate) fn normalised(weights: [f32; 4]) -> [f32; 4] {
    let clean = weights.map(|w| if w.is_finite() && w > 0.0 { w } else { 0.0 });
    let sum: f32 = clean.iter().sum();
    if sum.is_finite() && sum > 0.0 { clean.map(|w| w / sum) } else { [1.0, 0.0, 0.0, 0.0] }
}

/// The four heaviest of any number of `(joint, weight)` pairs, normalised.
pub(crate) fn four_heaviest(mut pairs: Vec<(u16, f32)>) -> ([u16; 4], [f32; 4]) {
    pairs.sort_by(|a, b| b.1.total_cmp(&a.1));
    let at = |i: usize| pairs.get(i).copied().unwrap_or((0, 0.0));
    let four = [at(0), at(1), at(2), at(3)];
    (four.map(|p| p.0), normalised(four.map(|p| p.1)))
}
