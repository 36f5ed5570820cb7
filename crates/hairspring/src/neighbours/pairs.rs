//! Which pairs of segments may touch in a frame.

use super::{hair::Hair, near::Near};
use rayon::prelude::*;

/// Most neighbours of a segment, of those after it in order: the nearest.
const MOST: usize = 16;

/// How much farther than they touch pairs are looked for [1], and where bonds may be: one that is twice as long is gone.
const MARGIN: f32 = 1.05;
const BOND: f32 = 2.0;

/// The pairs of a frame.
pub struct Pairs {
    of: Vec<Following>,
}

/// Segments near one, of those after it in order.
#[derive(Clone, Copy)]
struct Following {
    count: usize,
    near: [(f32, u32); MOST],
}

impl Following {
    const NONE: Self = Self { count: 0, near: [(0.0, 0); MOST] };

    /// Adds a segment at a distance [m], or puts it in the place of the farthest.
    fn add(&mut self, found: (f32, u32)) {
        if self.count < MOST {
            self.near[self.count] = found;
            self.count += 1;
        } else if let Some(farthest) =
            self.near.iter_mut().max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
            && found < *farthest
        {
            *farthest = found;
        }
    }
}

impl Pairs {
    /// Memory for pairs of `segments`.
    pub fn new(segments: usize) -> Self {
        Self { of: vec![Following::NONE; segments] }
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.of[..])
    }

    /// Finds the pairs that may touch in the frame, by the way that both go if they do not, and where there are `bonds` those that may hold
    /// together; returns how many.
    pub fn find(&mut self, hair: &Hair, near: &mut Near, bonds: bool) -> usize {
        let margin = if bonds { BOND } else { MARGIN };
        let thickest = hair.radius.iter().copied().fold(0.0, f32::max);
        let longest = hair.middles().map(|(i, _)| hair.length(i as usize)).fold(0.0, f32::max);
        // How far any may go, beside the mean.
        let moving = || hair.middles().map(|(i, _)| hair.free[i as usize].way);
        let mean = moving().map(|way| way.as_dvec3()).sum::<glam::DVec3>() / moving().count().max(1) as f64;
        let fastest = moving().map(|way| way.distance(mean.as_vec3())).fold(0.0, f32::max);
        let most = longest + 4.0 * thickest;
        let cell = longest + 2.0 * margin * thickest + (4.0 * fastest).min(most);
        near.sort(cell.max(1e-6), hair.middles());
        let near = &*near;
        self.of.par_iter_mut().enumerate().with_min_len(64).for_each(|(a, following)| {
            following.count = 0;
            if !hair.is_segment(a) || !hair.is_finite(a) {
                return;
            }
            near.around(hair.middle(a), |b| {
                let other = b as usize;
                if other <= a || hair.same_strand(a, other) {
                    return;
                }
                // No point of one comes nearer to a point of the other than their ends do, relative to each other.
                let way = |i: usize, j: usize| hair.free[i].way.distance(hair.free[j].way);
                let closing =
                    way(a, other).max(way(a + 1, other)).max(way(a, other + 1)).max(way(a + 1, other + 1));
                let within = margin * (hair.radius[a] + hair.radius[other]) + (2.0 * closing).min(most);
                let apart = hair.middle(a).distance(hair.middle(other));
                if apart > within + 0.5 * (hair.length(a) + hair.length(other)) {
                    return;
                }
                let distance = hair.distance(a, other);
                if distance < within {
                    following.add((distance, b));
                }
            });
            following.near[..following.count].sort_unstable_by_key(|(_, b)| *b);
        });
        self.of.iter().map(|following| following.count).sum()
    }

    /// All of them, sorted, each with the lesser index first.
    pub fn iter(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.of.iter().enumerate().flat_map(|(a, following)| {
            following.near[..following.count].iter().map(move |(_, b)| [a as u32, *b])
        })
    }
}
