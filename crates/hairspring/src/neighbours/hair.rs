//! All simulated strands that may meet, as points one after the other: what is known of them for good, and how they move in a frame.

use super::{closest::closest, near::Near};
use crate::simulation::{Met, Simulation};
use glam::{Mat3, Vec3};
use rayon::prelude::*;

/// How far along a strand a push is felt within a frame [m]. Bending spreads as √(t √(EI/ρA)), with √(EI/ρA) = (r/2) √(E/ρ) = 0.03 m²/s
/// for a human hair (r = 35 µm, E = 3.9 GPa): 22 mm in 1/60 s. A style's stiffness is in it as the fourth root, and is left out.
const FELT: f32 = 0.022;

/// Segments of mean length as far as which the next strand is looked for where no thickness is set [1].
const SIGHT: f32 = 4.0;

/// The strands of all simulations. A segment has the index of its first point.
#[derive(Default)]
pub struct Hair {
    pub members: Vec<Member>,
    /// Number of each point's strand.
    strand: Vec<u32>,
    /// Mass of each point [kg].
    pub mass: Vec<f32>,
    /// One over the mass that moves with each point in a frame [1/kg].
    pub mobility: Vec<f32>,
    /// Radius of each segment [m].
    pub radius: Vec<f32>,
    /// Contacts of each segment in the last frame.
    pub contacts: Vec<u32>,
    /// Places at the start of the frame, from a common origin [m].
    pub start: Vec<Vec3>,
    /// Velocities that the frame would end with if strands did not meet anew [m/s], and the way that they would go in it [m].
    pub free: Vec<Free>,
    /// The way that they went [m].
    pub way: Vec<Vec3>,
    /// What they do to each other.
    pub met: Vec<Met>,
}

/// The points of one simulation.
pub struct Member {
    pub first: usize,
    pub points: usize,
    /// Where each strand of its groom begins, from `first`; what is not simulated, at 0.
    pub firsts: Vec<u32>,
    /// Whether any of its numbers turned non-finite in the frame.
    pub broken: bool,
}

/// A point in a frame in which strands do not meet anew.
#[derive(Clone, Copy, Default)]
pub struct Free {
    pub velocity: Vec3,
    pub way: Vec3,
}

impl Hair {
    /// The strands of `simulations` as they are now; `thickness` as in the settings.
    pub fn new(simulations: &[&Simulation], thickness: Option<f32>) -> Self {
        let mut hair = Self::default();
        let mut strands = 0;
        for simulation in simulations {
            let first = hair.mass.len();
            let mut firsts = vec![0; simulation.groom_strands()];
            hair.mass.extend(simulation.masses());
            let mut at = 0;
            for (s, points) in simulation.strands().zip(simulation.counts()) {
                firsts[s as usize] = at as u32;
                hair.strand.extend(std::iter::repeat_n(strands, points));
                strands += 1;
                at += points;
            }
            hair.members.push(Member { first, points: at, firsts, broken: false });
        }
        let points = hair.mass.len();
        hair.start.resize(points, Vec3::ZERO);
        hair.contacts.resize(points, 0);
        hair.free.resize(points, Free::default());
        hair.way.resize(points, Vec3::ZERO);
        hair.met.resize(points, Met::default());
        hair.begin(simulations.iter().map(|s| &**s));
        hair.weigh();
        hair.radius = hair.radii(thickness);
        hair
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> usize {
        let each = 2 * size_of::<u32>()
            + 3 * size_of::<f32>()
            + 2 * size_of::<Vec3>()
            + size_of::<Free>()
            + size_of::<Met>();
        self.len() * each
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.strand.len()
    }

    /// Whether a segment begins at point `i`.
    pub fn is_segment(&self, i: usize) -> bool {
        self.strand.get(i + 1) == Some(&self.strand[i])
    }

    /// Whether both ends of segment `i` are driven by the skin.
    pub fn is_driven(&self, i: usize) -> bool {
        i == 0 || self.strand[i - 1] != self.strand[i]
    }

    /// Whether point `i` is driven by the skin.
    pub fn is_driven_point(&self, i: usize) -> bool {
        i < 2 || self.strand[i - 2] != self.strand[i]
    }

    /// Whether two segments are of one strand.
    pub fn same_strand(&self, a: usize, b: usize) -> bool {
        self.strand[a] == self.strand[b]
    }

    /// Ends of segment `i` at the start of the frame.
    pub fn ends(&self, i: usize) -> [Vec3; 2] {
        [self.start[i], self.start[i + 1]]
    }

    /// Takes in where points are at the start of a frame.
    pub fn begin<'a>(&mut self, simulations: impl Iterator<Item = &'a Simulation>) {
        let mut origin = None;
        for (member, simulation) in self.members.iter().zip(simulations) {
            let anchor = simulation.anchor();
            let origin = *origin.get_or_insert(anchor.translation);
            let mut out = self.start[member.first..].iter_mut();
            simulation.see_points(&anchor, origin, |x, _| _ = out.next().map(|out| *out = x));
        }
    }

    /// The inverse of the mass that moves with each point.
    fn weigh(&mut self) {
        let along: Vec<f32> = (0..self.len())
            .scan(0.0, |sum, i| {
                *sum += if i > 0 && self.is_segment(i - 1) {
                    self.start[i].distance(self.start[i - 1])
                } else {
                    0.0
                };
                Some(*sum)
            })
            .collect();
        let moved = |i: usize| {
            let felt = |j: &usize| self.same_strand(i, *j) && (along[*j] - along[i]).abs() <= FELT;
            let rootward: f32 = (0..i).rev().take_while(felt).map(|j| self.mass[j]).sum();
            let tipward: f32 = (i..self.len()).take_while(felt).map(|j| self.mass[j]).sum();
            // The end of a beam gives way four times as easily as its middle.
            0.5 * rootward + 1.5 * tipward
        };
        self.mobility = (0..self.len()).into_par_iter().map(|i| 1.0 / moved(i)).collect();
    }

    /// Half the distance of each segment to the next strand, or half the thickness where that is less.
    fn radii(&self, thickness: Option<f32>) -> Vec<f32> {
        let lengths = || (0..self.len()).filter(|i| self.is_segment(*i)).map(|i| self.length(i));
        let (sum, count) = lengths().fold((0.0_f64, 0_usize), |(sum, n), l| (sum + f64::from(l), n + 1));
        let mean = (sum / count.max(1) as f64) as f32;
        let longest = lengths().fold(0.0, f32::max);
        let sight = thickness.unwrap_or(SIGHT * mean).max(1e-6);
        let mut near = Near::default();
        near.sort(longest + sight, self.middles());
        let next: Vec<f32> = (0..self.len())
            .into_par_iter()
            .map(|a| {
                let mut least = sight;
                if self.is_segment(a) && self.is_finite(a) {
                    near.around(self.middle(a), |b| {
                        if !self.same_strand(a, b as usize) {
                            least = least.min(self.distance(a, b as usize));
                        }
                    });
                }
                least
            })
            .collect();
        let roots = || (0..self.len()).filter(|i| self.is_driven(*i)).map(|i| f64::from(next[i]));
        let most = thickness.unwrap_or((roots().sum::<f64>() / roots().count().max(1) as f64) as f32);
        next.iter().map(|next| 0.5 * next.min(most)).collect()
    }

    /// Length of segment `i` now [m].
    pub fn length(&self, i: usize) -> f32 {
        self.start[i].distance(self.start[i + 1])
    }

    /// The middle of segment `i`.
    pub fn middle(&self, i: usize) -> Vec3 {
        0.5 * (self.start[i] + self.start[i + 1])
    }

    /// The middles of all segments that are somewhere.
    pub fn middles(&self) -> impl Iterator<Item = (u32, Vec3)> + Clone {
        let there = |i: &usize| self.is_segment(*i) && self.is_finite(*i);
        (0..self.len()).filter(there).map(|i| (i as u32, self.middle(i)))
    }

    /// Whether what is known of the ends of segment `i` are numbers.
    pub fn is_finite(&self, i: usize) -> bool {
        (i..i + 2).all(|i| {
            self.start[i].is_finite() && self.free[i].way.is_finite() && self.free[i].velocity.is_finite()
        })
    }

    /// Distance of two segments at the start of the frame [m].
    pub fn distance(&self, a: usize, b: usize) -> f32 {
        let (a, b) = (self.ends(a), self.ends(b));
        let (s, t) = closest(a, b);
        a[0].lerp(a[1], s).distance(b[0].lerp(b[1], t))
    }

    /// Brakes point `i` by `rates` [1/s] to `velocity` [m/s].
    pub fn brake(&mut self, i: usize, rates: Mat3, velocity: Vec3) {
        let met = &mut self.met[i];
        met.push += rates * velocity;
        let [x, y, z] = [rates.x_axis, rates.y_axis, rates.z_axis];
        for (sum, rate) in met.damp.iter_mut().zip([x.x, x.y, x.z, y.y, y.z, z.z]) {
            *sum += rate;
        }
    }
}
