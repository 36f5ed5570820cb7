//! Selects the guide strands, and the guides that each hair follows.

use crate::groom::{Groom, GuideWeights};
use crate::parallel::prelude::*;
use glam::Vec3;

/// Weight of the difference in shape of two strands, relative to the distance of their roots [1]. Hairs on
/// either side of a parting have nearby roots but should not follow each other.
const SHAPE_WEIGHT: f32 = 0.25;

/// Smallest extent of the guides' roots that determines a cell [m].
const MIN_EXTENT: f32 = 1e-4;

/// Smallest cell of the search for guides [m].
const MIN_CELL: f32 = 1e-5;

/// Number of nearest guides considered for each hair before shape decides.
const MAX_CANDIDATES: usize = 8;

/// Chooses about `count` guides spread over the scalp. Each group gets a number in proportion to its strands,
/// rounded, and at least one, so there are more than `count` where many groups are small. Within a group, the
/// strand farthest from all chosen ones is added repeatedly (farthest-point sampling; Gonzalez 1985).
///
/// Returns strand indices in increasing order, or all strands if there are no more than `count`.
///
/// For an example, see [`follow`](crate::follow).
///
/// # Panics
/// If a strand has no points and there are fewer guides than strands.
pub fn choose_guides(groom: &Groom, count: usize) -> Vec<u32> {
    let strands = groom.strand_count();
    if count >= strands {
        return (0..strands as u32).collect();
    }
    let mut groups: Vec<Vec<u32>> = Vec::new();
    for s in 0..strands {
        let g = groom.group(s) as usize;
        if groups.len() <= g {
            groups.resize(g + 1, Vec::new());
        }
        groups[g].push(s as u32);
    }
    let mut chosen: Vec<u32> = groups
        .into_iter()
        .filter(|g| !g.is_empty())
        .flat_map(|group| {
            let share = (count as f64 * group.len() as f64 / strands as f64).round().max(1.0) as usize;
            farthest_points(groom, group, share)
        })
        .collect();
    chosen.sort_unstable();
    chosen
}

fn farthest_points(groom: &Groom, group: Vec<u32>, count: usize) -> Vec<u32> {
    /// Roots processed by one task. The size is fixed, so that ties are resolved alike for any number of
    /// threads.
    const CHUNK: usize = 4096;
    /// Squared distance of a chosen strand. It is less than that of every other strand, so that none is chosen
    /// twice where the remaining strands have the roots of chosen ones.
    const CHOSEN: f32 = -1.0;
    if count >= group.len() {
        return group;
    }
    let roots: Vec<Vec3> = group.iter().map(|s| groom.strand(*s as usize)[0]).collect();
    let mut distances = vec![f32::MAX; roots.len()];
    let mut chosen = Vec::with_capacity(count);
    let mut next = 0;
    for _ in 0..count {
        chosen.push(group[next]);
        distances[next] = CHOSEN;
        let p = roots[next];
        let farther = |a: (f32, usize), b: (f32, usize)| {
            if b.0 > a.0 || (b.0 == a.0 && b.1 < a.1) { b } else { a }
        };
        next = distances
            .par_chunks_mut(CHUNK)
            .zip(roots.par_chunks(CHUNK))
            .enumerate()
            .map(|(c, (distances, roots))| {
                let mut best = (f32::MIN, usize::MAX);
                for (i, (d, r)) in distances.iter_mut().zip(roots).enumerate() {
                    *d = d.min(r.distance_squared(p));
                    best = farther(best, (*d, c * CHUNK + i));
                }
                best
            })
            .reduce(|| (f32::MIN, usize::MAX), farther)
            .1;
    }
    chosen
}

/// Returns up to three guides for each strand, weighted by the inverse squared difference in root position
/// and shape. The guides are of the strand's own group if that has any. A guide follows itself. A strand with points that
/// are not finite, or farther from all guides than single precision can square, follows one guide. `guides` must not be
/// empty.
///
/// For an example, see [`follow`](crate::follow).
///
/// # Panics
/// If `guides` is empty, names a strand that does not exist, or a strand has no points.
pub fn assign_guides(groom: &Groom, guides: &[u32]) -> Vec<GuideWeights> {
    let grid = RootGrid::new(groom, guides);
    let mut is_guide = vec![false; groom.strand_count()];
    guides.iter().for_each(|g| is_guide[*g as usize] = true);
    (0..groom.strand_count())
        .into_par_iter()
        .with_min_len(256)
        .map(|s| {
            // Other guides with the same root and shape are just as near.
            if is_guide[s] {
                return weights(&[(0.0, s as u32)]);
            }
            let near = grid.nearest(groom, groom.strand(s)[0], groom.group(s));
            let mut scored: Vec<(f32, u32)> =
                near.into_iter().map(|g| (difference(groom, s, g as usize), g)).collect();
            scored.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            weights(&scored)
        })
        .collect()
}

/// Returns the first three of `scored` (difference [m], guide), with weights.
fn weights(scored: &[(f32, u32)]) -> GuideWeights {
    let (first, guide) = scored[0];
    let mut out = GuideWeights { guides: [guide; 3], weights: [1.0, 0.0, 0.0] };
    // From a distance that is not finite, or whose square is not, all guides are equally far: one is enough.
    if first <= 1e-7 || !(first * first).is_finite() {
        return out;
    }
    for (k, (d, g)) in scored.iter().filter(|(d, _)| d.is_finite()).take(3).enumerate() {
        out.guides[k] = *g;
        out.weights[k] = 1.0 / (d * d);
    }
    let sum: f32 = out.weights.iter().sum();
    out.weights = out.weights.map(|w| w / sum);
    out
}

/// Returns the difference of two strands [m]: the distance of their roots, plus a fraction of the difference
/// of their middles and tips relative to the roots.
fn difference(groom: &Groom, a: usize, b: usize) -> f32 {
    let (a, b) = (groom.strand(a), groom.strand(b));
    let shape = |part: usize| {
        let offset = |s: &[Vec3]| s[(s.len() - 1) * part / 2] - s[0];
        (offset(a) - offset(b)).length()
    };
    a[0].distance(b[0]) + SHAPE_WEIGHT * (shape(1) + shape(2)) * 0.5
}

/// A hash grid of the guides by their root positions.
struct RootGrid {
    cell: f32,
    cells: std::collections::HashMap<[i32; 3], Vec<u32>>,
    by_group: Vec<Vec<u32>>,
    all: Vec<u32>,
}

impl RootGrid {
    fn new(groom: &Groom, guides: &[u32]) -> Self {
        let roots: Vec<Vec3> = guides.iter().map(|g| groom.strand(*g as usize)[0]).collect();
        let lo = roots.iter().copied().fold(Vec3::MAX, Vec3::min);
        let hi = roots.iter().copied().fold(Vec3::MIN, Vec3::max);
        // Aims at about two guides in each cell, for a surface of the size of the bounding box.
        let size = (hi - lo).max_element().max(MIN_EXTENT);
        let cell = (size * (2.0 / guides.len() as f32).sqrt()).max(MIN_CELL);
        let mut grid = Self { cell, cells: Default::default(), by_group: Vec::new(), all: guides.to_vec() };
        for (g, root) in guides.iter().zip(&roots) {
            grid.cells.entry(grid.key(*root)).or_default().push(*g);
            let group = groom.group(*g as usize) as usize;
            if grid.by_group.len() <= group {
                grid.by_group.resize(group + 1, Vec::new());
            }
            grid.by_group[group].push(*g);
        }
        grid
    }

    fn key(&self, p: Vec3) -> [i32; 3] {
        (p / self.cell).floor().as_ivec3().to_array()
    }

    /// Returns the nearest [`MAX_CANDIDATES`] guides of the group by root position, or of any group if it has
    /// none.
    fn nearest(&self, groom: &Groom, p: Vec3, group: u16) -> Vec<u32> {
        let own = self.by_group.get(group as usize).filter(|g| !g.is_empty());
        let pool = own.unwrap_or(&self.all);
        let fits = |g: u32| own.is_none() || groom.group(g as usize) == group;
        let wanted = MAX_CANDIDATES.min(pool.len());
        let mut found: Vec<(f32, u32)> = Vec::new();
        let k = self.key(p);
        for ring in 0..6 {
            found.clear();
            for x in -ring..=ring {
                for y in -ring..=ring {
                    for z in -ring..=ring {
                        let cell = [k[0].saturating_add(x), k[1].saturating_add(y), k[2].saturating_add(z)];
                        let guides = self.cells.get(&cell).into_iter().flatten().filter(|g| fits(**g));
                        found.extend(guides.map(|g| (groom.strand(*g as usize)[0].distance_squared(p), *g)));
                    }
                }
            }
            if found.len() >= wanted {
                break;
            }
        }
        if found.len() < wanted {
            found = pool.iter().map(|g| (groom.strand(*g as usize)[0].distance_squared(p), *g)).collect();
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.into_iter().take(MAX_CANDIDATES).map(|f| f.1).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lawn(side: usize) -> Groom {
        let mut groom = Groom::from_strands(
            (0..side * side).map(|k| {
                let root = Vec3::new((k % side) as f32, 0.0, (k / side) as f32) * 0.001;
                [root, root + Vec3::Y * 0.01, root + Vec3::Y * 0.02]
            }),
            35e-6,
        );
        groom.groups = (0..side * side).map(|k| (k % side * 2 / side) as u16).collect();
        groom
    }

    #[test]
    fn guides_are_spread_and_every_group_has_its_share() {
        let groom = lawn(60);
        let guides = choose_guides(&groom, 100);
        assert!((98..=102).contains(&guides.len()), "{} guides", guides.len());
        let left = guides.iter().filter(|g| groom.group(**g as usize) == 0).count();
        assert!((48..=52).contains(&left), "{left} of the left half");
        // An area of 3,600 mm² leaves 36 mm² for each guide, so no two are nearer than 3 mm.
        for a in &guides {
            for b in &guides {
                let d = groom.strand(*a as usize)[0].distance(groom.strand(*b as usize)[0]);
                assert!(a == b || groom.group(*a as usize) != groom.group(*b as usize) || d > 0.003);
            }
        }
    }

    /// Strands of equal shape, `strands` at each of three roots.
    fn tufts(strands: usize) -> Groom {
        let strand = |k: usize| {
            let root = Vec3::X * (0.01 * (k / strands) as f32);
            [root, root + Vec3::Y * 0.01, root + Vec3::Y * 0.02]
        };
        Groom::from_strands((0..3 * strands).map(strand), 35e-6)
    }

    #[test]
    fn no_strand_is_chosen_twice_if_roots_coincide() {
        let groom = tufts(12);
        for count in [1, 2, 3, 4, 20, 35] {
            let guides = choose_guides(&groom, count);
            assert_eq!(guides.len(), count);
            assert!(guides.is_sorted_by(|a, b| a < b), "a strand is chosen twice: {guides:?}");
        }
        // All three roots have a guide before any has two.
        assert_eq!(choose_guides(&groom, 3), [0, 12, 24]);
    }

    #[test]
    fn a_guide_follows_itself_if_roots_coincide() {
        let groom = tufts(12);
        let guides: Vec<u32> = (0..30).collect();
        let weights = assign_guides(&groom, &guides);
        for g in guides {
            let of_guide = &weights[g as usize];
            assert_eq!((of_guide.guides[0], of_guide.weights[0]), (g, 1.0));
        }
    }

    #[test]
    fn a_hair_follows_guides_of_its_own_group_and_a_guide_itself() {
        let groom = lawn(40);
        let guides = choose_guides(&groom, 60);
        let weights = assign_guides(&groom, &guides);
        for (s, w) in weights.iter().enumerate() {
            assert!((w.weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
            assert!(w.guides.iter().all(|g| groom.group(*g as usize) == groom.group(s)));
            if guides.contains(&(s as u32)) {
                assert_eq!((w.guides[0], w.weights[0]), (s as u32, 1.0));
            }
        }
    }
}
