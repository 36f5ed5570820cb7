//! How thick segments are where they meet others: as much as there was room for at rest.

use super::{closest::closest, grid::Grid, hair::Hair};

/// Share of the room at rest that two segments take up [1]: rounding must not make them touch there.
const TAKEN: f32 = 0.999;

/// Sets the radii of all segments, from strands at rest: `asked` [m], or half of the mean distance to the nearest other strand, and nowhere more than half of
/// that distance. Returns the largest.
pub fn find_radii(asked: Option<f32>, hair: &mut Hair, grid: &mut Grid) -> f32 {
    let segments: Vec<u32> = hair.segments().collect();
    let length = |hair: &Hair, s: u32| hair.ends(s)[0].distance(hair.ends(s)[1]);
    let mean =
        segments.iter().map(|s| f64::from(length(hair, *s))).sum::<f64>() / segments.len().max(1) as f64;
    // Where no radius is asked for, strands farther off than a segment is long count as that far.
    let within = asked.map_or(mean as f32, |radius| 2.0 * radius);
    let mut nearest = vec![within; hair.x.len()];
    grid.sort_still(hair, 0.5 * within);
    grid.pairs(hair, |pair| {
        let [a, b] = pair.map(|s| hair.ends(s));
        let (s, t) = closest(a, b);
        let distance = a[0].lerp(a[1], s).distance(b[0].lerp(b[1], t));
        for s in pair {
            nearest[s as usize] = nearest[s as usize].min(distance);
        }
    });
    let room =
        segments.iter().map(|s| f64::from(nearest[*s as usize])).sum::<f64>() / segments.len().max(1) as f64;
    let radius = asked.unwrap_or(0.5 * room as f32);
    for s in segments {
        hair.radius[s as usize] = radius.min(0.5 * TAKEN * nearest[s as usize]);
    }
    radius
}
