//! Contact radii of segments: as large as the space at rest allows.

use super::{closest::closest, grid::Grid, hair::Hair};

/// Share of the space at rest that two segments occupy [1]. It is below 1 so that rounding does not make them
/// touch there.
const OCCUPIED_SHARE: f32 = 0.999;

/// Sets the radii of all segments, from strands at rest, and returns the largest. The radius is `radius_setting` [m],
/// or half the mean distance to the nearest other strand if that is `None`, but at most half the segment's
/// own distance.
pub fn find_radii(radius_setting: Option<f32>, hair: &mut Hair, grid: &mut Grid) -> f32 {
    let segments: Vec<u32> = hair.segments().collect();
    let length = |hair: &Hair, s: u32| hair.ends(s)[0].distance(hair.ends(s)[1]);
    let mean =
        segments.iter().map(|s| f64::from(length(hair, *s))).sum::<f64>() / segments.len().max(1) as f64;
    // Without a given radius, distances beyond the mean segment length are clamped to it.
    let within = radius_setting.map_or(mean as f32, |radius| 2.0 * radius);
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
    let radius = radius_setting.unwrap_or(0.5 * room as f32);
    for s in segments {
        hair.radius[s as usize] = radius.min(0.5 * OCCUPIED_SHARE * nearest[s as usize]);
    }
    radius
}
