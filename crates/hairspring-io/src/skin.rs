//! Skinning weights of a vertex or a root.

/// Removes weights that are negative or not finite, and scales the rest to a sum of 1. If nothing is left,
/// the first joint gets all the weight.
pub(crate) fn normalised(weights: [f32; 4]) -> [f32; 4] {
    let clean = weights.map(|w| if w.is_finite() && w > 0.0 { w } else { 0.0 });
    let sum: f32 = clean.iter().sum();
    if sum.is_finite() && sum > 0.0 { clean.map(|w| w / sum) } else { [1.0, 0.0, 0.0, 0.0] }
}

/// Returns the four largest of any number of `(joint, weight)` pairs, normalized.
pub(crate) fn four_heaviest(mut pairs: Vec<(u16, f32)>) -> ([u16; 4], [f32; 4]) {
    pairs.sort_by(|a, b| b.1.total_cmp(&a.1));
    let at = |i: usize| pairs.get(i).copied().unwrap_or((0, 0.0));
    let four = [at(0), at(1), at(2), at(3)];
    (four.map(|p| p.0), normalised(four.map(|p| p.1)))
}
