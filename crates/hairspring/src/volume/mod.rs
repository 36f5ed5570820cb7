//! Hair on hair, as a volume: in intervals of 1/240 s all simulated points leave their mass and momentum on a lattice, and take from it
//! one acceleration each, which is frozen for the interval and all that the strands' solver sees.
//!
//! ```text
//! node    M = Σ w m,   V = Σ w m v / M                         (Petrovic 2005)
//! point   a = Σ w (A + β V + R V) − Σ w (β + R) v,   β = (1 − e^(−friction dt)) / dt
//! ```
//!
//! - A is what the nodes' pressure does, by one of two methods: `density` (Petrovic 2005) or `incompressible` (McAdams 2009).
//! - β is friction: the exact relaxation of the velocity relative to that of the hair around. It cannot overshoot, brakes no common motion, and
//!   keeps momentum, because Σ m over the points of w (V − v) is 0 at every node. With A = (V⁺ − V)/dt, e^(−friction dt) of the velocity comes by
//!   FLIP and the rest by PIC (Zhu & Bridson 2005, as McAdams 2009), in a blend that does not depend on the length of the interval.
//! - R is what hair takes from hair that goes across it, a matrix, see `crossing`. Pressure and friction do not know of strands that go through each other within a cell.
//!
//! All of it is a rate or exact for an interval of any length, and intervals are as long at any frame rate (`simulation/strand_parts.rs`): results depend on the frame
//! rate as little as the strands do.
//!
//! # The five steps of McAdams 2009 here
//! - Steps 1 and 2, positions and velocities free of collision and what forces make of the velocities, are the strands' state and their solve.
//! - Step 3, the volume's correction, comes before step 2 instead of after it: it goes into the implicit solve, so that it stretches no strand.
//! - Step 4, contact strand by strand where the lattice is too coarse to see it, so that webs of straight hair are not gone through, is
//!   `neighbours`, switched on beside it.
//! - Contact with the body and step 5, the new positions, end every substep as without it.
//!
//! # Cost
//! A point's 12 bytes of position are read for the window, its 24 of position and velocity and 8 of its own for the sums, 24 again for the
//! acceleration, which is 12 to write here, 24 to change in the sum of all that acts, and 12 to read by the substeps. It adds 64 whole numbers at eight nodes and takes 96.
//! Measured on one core with SSE2, bench scene of 96,000 points in 21,000 nodes: 56 ns a point and exchange for `density`, 117 for `incompressible` (solve of
//! 34,000 nodes), caches that the strands then find cold and tiles that run one substep at a time included; a frame of 1/60 s has four exchanges.
//!
//! # Missing
//! Followers are moved by their guides alone.

mod brakes;
mod conjugate;
mod crossing;
mod density;
mod field;
mod gather;
mod grid_bounds;
mod incompressible;
mod rest;
mod sample;
mod splat;
#[cfg(test)]
mod tests;

use crate::{
    collide::ColliderPose,
    math::RigidTransform,
    settings::{self, VolumeMethod},
    simd::lanes::Row,
    strand::tile::{StateRows, StrandRows},
};
use brakes::fill_push;
use crossing::Crossing;
use field::Field;
use glam::{Mat3, Vec3};
use grid_bounds::{GridBounds, GridTransform};
use incompressible::Projection;
use rayon::prelude::*;
use rest::Rest;
pub(crate) use sample::Density;
use splat::{Extent, OwnRows, Sums, Tiles, Units, own};

/// Most nodes of a window: those of a head of long hair in every direction in cells of a centimetre, and 75 MB for each thread.
const MOST_NODES: f32 = (1 << 21) as f32;

/// Nodes of a window beyond its hair, along each axis [cells].
const RING: f32 = 6.0;

/// Farthest cell from the anchor: single precision knows places there to a quarter of one.
const FARTHEST: f32 = (1 << 22) as f32;

/// Most threads that sum by themselves: each has a grid to be added up.
const MOST_GRIDS: usize = 8;

/// The hair volume of some simulated strands: what is known of their rest, and memory.
pub(crate) struct Volume {
    settings: settings::Volume,
    /// Edge of a cell [m].
    cell: f32,
    /// Whether the cell is larger than was asked for, so that their number stays bounded.
    grown: bool,
    /// The box that hair can reach from where its roots are at rest, in the anchor's space [m].
    reach: (Vec3, Vec3),
    /// Length of the longest strand [m].
    length: f32,
    /// Distance of neighbouring strands at rest [m].
    spacing: f32,
    /// Length of strand in each mass of 1 [m].
    per_mass: f32,
    /// Index of each tile's first point, and of the first after the last.
    firsts: Vec<u32>,
    own: Vec<OwnRows>,
    points: usize,
    /// Sum of the points' masses over the largest.
    total: f64,
    rest: Rest,
    /// What acts on the points in this interval, shape `[points]` of all tiles [m/s²].
    acceleration: Vec<[Row; 3]>,
    sums: Vec<Sums>,
    field: Field,
    pressures: Vec<f32>,
    projection: Projection,
    /// What hair took up of its cells at rest and at the start of the last interval, see [`taken_up`].
    taken_up: [f64; 2],
}

/// What is known of a simulation's hair volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeReport {
    /// Edge of a cell [m].
    pub cell: f32,
    /// Whether that is larger than was asked for, so that the number of cells stays bounded.
    pub grown: bool,
    /// Nodes of the lattice that the last interval used.
    pub nodes: usize,
    /// The volume that the hair took up at the start of the last interval, over that at rest [1]. The volume is that of its cells as far as
    /// they are filled, none more than once: where strands crowd into each other's room, theirs is lost.
    pub share: f64,
}

/// When an interval begins: where the anchor is then, and which part of their way in the frame roots have gone [1].
pub(crate) struct Now {
    pub anchor: RigidTransform,
    pub gone: f32,
}

impl Now {
    fn chart(&self, cell: f32) -> GridTransform {
        GridTransform::on_the_way(&self.anchor, cell, self.gone)
    }
}

/// Strands at rest, as a simulation is built.
pub(crate) struct AtRest<'a> {
    /// Index of each tile's first point, and of the first after the last.
    pub firsts: Vec<u32>,
    /// Mass of each point [kg], 0 for what is no point of a strand; shape `[points]` of all tiles.
    pub mass: Vec<Row>,
    /// Shape `[tiles]`.
    pub strand: &'a [StrandRows],
    /// Shape `[points]` of all tiles.
    pub state: &'a [StateRows],
    /// Where the anchor is.
    pub anchor: RigidTransform,
    /// Mean segment of the strands [m].
    pub segment: f32,
    /// The longest strand [m].
    pub length: f32,
}

impl Volume {
    /// The volume of strands at rest; `None` where there is nothing to it, or where it is off and not to be `measured` either.
    pub fn new(settings: &settings::Volume, measured: bool, at: AtRest) -> Option<Self> {
        let largest = at.mass.iter().flat_map(|m| m.0).fold(0.0, f32::max);
        if (settings.method == VolumeMethod::Off && !measured) || largest <= 0.0 {
            return None;
        }
        // Rooms begin as the masses are, and are found below.
        let mut own: Vec<OwnRows> = at
            .mass
            .iter()
            .map(|m| {
                [m.0.map(|m| m / largest), m.0.map(|m| (m / largest * splat::ROOM / 8.0).ceil())].map(Row)
            })
            .collect();
        let tiles = Tiles { firsts: &at.firsts, strand: at.strand, state: at.state, own: &own };
        let grain = rest::grain(&tiles, &at.anchor, at.segment.max(1e-4));
        let asked = settings.cell.unwrap_or(grain.cell);
        // Hair reaches no farther from its roots than it is long.
        let extent = Extent::of(&tiles, &GridTransform::new(&at.anchor, 1.0), Vec3::ZERO);
        let reach = rest::reach((extent.lo, extent.hi), at.length);
        let size = (reach.1 - reach.0).max(Vec3::splat(asked));
        let mut cell = asked.max((size.element_product() / (0.5 * MOST_NODES)).cbrt());
        // Around hair in two places far apart, most of the lattice is the ring.
        let farthest = reach.0.abs().max(reach.1.abs()).max_element();
        while (size / cell + RING + 1.0).element_product() > MOST_NODES || farthest / cell > FARTHEST {
            cell *= 1.1;
        }
        let masses = || own.iter().flat_map(|o| o[own::MASS].0).filter(|m| *m > 0.0);
        let (points, total) = (masses().count(), masses().map(f64::from).sum::<f64>());
        let mut volume = Self {
            settings: *settings,
            cell,
            grown: cell > asked,
            reach,
            length: at.length,
            spacing: grain.spacing,
            per_mass: at.segment * (points as f64 / total) as f32,
            acceleration: vec![
                [Row::default(); 3];
                if settings.method == VolumeMethod::Off { 0 } else { at.state.len() }
            ],
            firsts: at.firsts,
            own: Vec::new(),
            points,
            total,
            rest: Rest::default(),
            sums: Vec::new(),
            field: Field::default(),
            pressures: Vec::new(),
            projection: Projection::default(),
            taken_up: [1.0; 2],
        };
        volume.reserve();
        let work = (&mut volume.sums[0], &mut volume.field);
        let cells = (&at.anchor, cell, grain.cell);
        volume.rest.measure((at.strand, at.state, &volume.firsts), &mut own, cells, work);
        volume.own = own;
        volume.taken_up = [fill_ratio(&volume.field.fill); 2];
        Some(volume)
    }

    /// Memory for a window around all that hair can reach, and a grid for each thread, so that no step has to ask for any.
    fn reserve(&mut self) {
        let nodes = self.most_nodes();
        let grids = rayon::current_num_threads().clamp(1, MOST_GRIDS);
        if self.sums.len() < grids {
            self.sums.resize_with(grids, Sums::default);
            self.sums.iter_mut().for_each(|sums| sums.reserve(nodes));
            self.field.reserve(nodes);
            match self.settings.method {
                VolumeMethod::Incompressible => self.projection.reserve(nodes),
                VolumeMethod::Density => self.pressures.reserve_exact(nodes),
                VolumeMethod::Off => {}
            }
        }
    }

    /// See [`VolumeReport`].
    pub fn report(&self) -> VolumeReport {
        let nodes = self.field.window.nodes();
        VolumeReport { cell: self.cell, grown: self.grown, nodes, share: self.taken_up[1] / self.taken_up[0] }
    }

    /// Bytes that it holds a strand's points in, the lattice not counted.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.own[..]) + size_of_val(&self.acceleration[..])
    }

    /// Whether it does anything to the points.
    pub fn acts(&self) -> bool {
        self.settings.method != VolumeMethod::Off
    }

    /// Most nodes that it ever has.
    pub fn most_nodes(&self) -> usize {
        GridBounds::around(self.reach.0 / self.cell, self.reach.1 / self.cell).nodes()
    }

    /// How full of hair every place was when it was last measured, and the anchor at `anchor`.
    pub fn density(&self, anchor: RigidTransform) -> Density<'_> {
        Density::new(&self.field, self.cell, anchor)
    }

    /// The window of hair of this extent, as far as it can reach from its roots: what is beyond is lost. Where roots have gone so far from where they are at
    /// rest in the anchor's space that nodes would be too many, it is what hair reaches from there; what is elsewhere then meets nothing.
    fn window(&self, extent: &Extent) -> GridBounds {
        let rest = [self.reach.0 / self.cell, self.reach.1 / self.cell];
        let within = |[lo, hi]: [Vec3; 2]| [extent.lo, extent.hi].map(|corner| corner.clamp(lo, hi));
        let reach = rest::reach((extent.roots[0], extent.roots[1]), self.length / self.cell);
        let [mut lo, mut hi] = within([rest[0].min(reach.0), rest[1].max(reach.1)]);
        let far = lo.abs().max(hi.abs()).max_element();
        if (hi - lo + RING).element_product() > MOST_NODES || far > FARTHEST {
            [lo, hi] = within(rest);
        }
        GridBounds::around(lo, hi)
    }

    /// Begins a frame in which nothing of this acts yet. Pressures of the intervals in it begin with those of the last; those of its first do not, so that a frame
    /// follows from places and velocities alone.
    pub fn begin_frame(&mut self) {
        self.projection.forget();
        self.acceleration.fill([Row::default(); 3]);
    }

    /// Measures where hair is, at the start of an interval.
    pub fn measure(&mut self, (strand, state): (&[StrandRows], &[StateRows]), now: &Now) {
        self.reserve();
        let chart = now.chart(self.cell);
        let tiles = Tiles { firsts: &self.firsts, strand, state, own: &self.own };
        let parts = rayon::current_num_threads().clamp(1, self.sums.len());
        let carried = splat::root_velocity(&tiles);
        let extent = (0..parts)
            .into_par_iter()
            .map(|part| Extent::of(&tiles.part(part, parts), &chart, carried))
            .reduce(|| Extent::NONE, Extent::with);
        let window = self.window(&extent);
        let units = Units::new(self.points, self.total, (extent.speed, carried));
        let sums = &mut self.sums[..parts];
        sums.par_iter_mut().enumerate().for_each(|(part, sums)| {
            sums.clear(window.nodes());
            sums.add(&tiles.part(part, parts), &chart, &window, &units);
        });
        self.field.collect(window, &units, sums);
        self.taken_up[1] = fill_ratio(&self.field.fill);
    }

    /// Finds the accelerations of all points for an interval of `dt` [s] that has been measured, and puts them in the place of the last interval's in
    /// `push` [m/s²], shape `[points]` of all tiles. `obstacles` are in the interval's first substep, of `h` [s].
    pub fn exchange(
        &mut self,
        dt: f32,
        (strand, state): (&[StrandRows], &[StateRows]),
        now: &Now,
        obstacles: (&[ColliderPose], f32),
        push: &mut [[Row; 3]],
    ) {
        match self.settings.method {
            VolumeMethod::Off => {}
            VolumeMethod::Density => self.press(dt, &now.anchor),
            VolumeMethod::Incompressible => self.project(dt, &now.anchor, obstacles),
        }
        let tiles = Tiles { firsts: &self.firsts, strand, state, own: &self.own };
        let points = (&mut self.acceleration[..], push);
        gather::all(&tiles, &now.chart(self.cell), &self.field.window, &self.field.push, points);
    }

    /// What crossing hair takes in an interval of `dt` [s].
    fn crossing(&self, dt: f32) -> Crossing {
        Crossing::new(self.spacing, self.per_mass, self.cell, dt)
    }

    /// Acceleration by the pressure of crowded cells.
    fn press(&mut self, dt: f32, anchor: &RigidTransform) {
        let (field, rest, window) = (&self.field, &self.rest, self.field.window);
        let excess = |cell: usize| rest.over_density(&window, cell, field.fill[cell]);
        density::pressures(field, excess, &mut self.pressures);
        let push = density::Push::new(field, &self.pressures, self.settings.pressure, self.cell, dt);
        let turn = Mat3::from_quat(anchor.rotation);
        let brakes = (brakes::friction(&self.settings, dt), self.crossing(dt));
        fill_push(&mut self.field, brakes, |n, mass| turn * push.at(n, mass));
    }

    /// Acceleration that makes velocities free of divergence where hair is full.
    fn project(&mut self, dt: f32, anchor: &RigidTransform, obstacles: (&[ColliderPose], f32)) {
        let (field, rest, window, cell) = (&self.field, &self.rest, self.field.window, self.cell);
        let turn = Mat3::from_quat(anchor.rotation);
        let back = turn.transpose();
        let to_lattice = |n: usize, node: &[f32; 4]| {
            let place = anchor.point(window.place(n).as_vec3() * cell);
            match solid(obstacles, place) {
                Some(v) => (back * v, true),
                None => (back * Vec3::new(node[0], node[1], node[2]), false),
            }
        };
        let regain = self.settings.recovery_rate.min(1.0 / dt);
        let wanted = |c: usize| {
            4.0 * cell
                * regain
                * rest.over_density(&window, c, field.fill[c]).clamp(0.0, density::MOST_EXCESS)
        };
        self.projection.project(field, to_lattice, wanted);
        let brakes = (brakes::friction(&self.settings, dt), self.crossing(dt));
        let projection = &self.projection;
        fill_push(&mut self.field, brakes, |n, _| turn * projection.change(n) / dt);
    }
}

/// The part of the points' rooms that is filled once [1]: what is fuller than full has lost it.
fn fill_ratio(fill: &[f32]) -> f64 {
    let (all, once) = fill
        .iter()
        .fold((0.0, 0.0), |(all, once), fill| (all + f64::from(*fill), once + f64::from(fill.min(1.0))));
    if all > 0.0 { once / all } else { 1.0 }
}

/// Velocity of the collider that `place` [m] is in at the start of a substep of `h` [s], in the world [m/s].
fn solid((obstacles, h): (&[ColliderPose], f32), place: Vec3) -> Option<Vec3> {
    obstacles.iter().find_map(|o| {
        let local = o.start.0.transpose() * (place - o.start.1);
        (o.shape.distance(local) < 0.0).then(|| (o.end.0 * local + o.end.1 - place) / h)
    })
}
