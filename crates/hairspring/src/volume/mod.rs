//! Hair on hair, as a volume: once an exchange interval all simulated points leave their mass and momentum on a lattice, and take from it
//! one acceleration each, which is frozen for the interval and all that the strands' solver sees.
//!
//! ```text
//! node    M = Σ w m,   V = Σ w m v / M                         (Petrovic 2005)
//! point   a = Σ w (A + β V) − (Σ w β) v,   β = (1 − e^(−friction dt)) / dt
//! ```
//!
//! A is what the nodes' pressure does, by one of two methods: `density` (Petrovic 2005) or `incompressible` (McAdams 2009). The rest is
//! friction: the exact relaxation of the velocity relative to that of the hair around. It cannot overshoot, brakes no common motion, and
//! keeps momentum, because Σ m over the points of w (V − v) is 0 at every node. With A = (V⁺ − V)/dt, e^(−friction dt) of the velocity comes by
//! FLIP and the rest by PIC (Zhu & Bridson 2005, as McAdams 2009), in a blend that does not depend on the frame rate.
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
//! acceleration, which is 12 to write and 12 to read by the substeps: 92 bytes, 5 ns at 20 GB/s. It adds 32 whole numbers at eight nodes and takes
//! 32: some 250 operations, 10 ns on one core in registers of four. Measured on one core, beside other work: 3 ns for the window, 14 for the sums,
//! 10 for the acceleration, each by itself; `hairspring --threads 1 bench --hair-hair` takes 41 ns a point and frame longer than without, caches that
//! the strands then find cold included. A node costs 1 to 3 ns; the solve of `incompressible`, 20,000 full cells, 4 to 8 ms on two cores.
//!
//! # Missing
//! Followers are moved by their guides alone.

mod conjugate;
mod density;
mod field;
mod gather;
mod incompressible;
mod rest;
mod sample;
mod splat;
#[cfg(test)]
mod tests;
mod window;

use crate::{
    collide::Rigid,
    scene::{self, VolumeMethod},
    simulation::MovingObstacle,
    strand::{
        lanes::Row,
        tile::{StateRows, StrandRows},
    },
};
use field::Field;
use glam::{Mat3, Vec3};
use incompressible::Projection;
use rayon::prelude::*;
use rest::Rest;
pub(crate) use sample::Density;
use splat::{Extent, OwnRows, Sums, Tiles, Units, own};
use window::{Chart, Window};

/// Most nodes of a window: those of a head of long hair in every direction in cells of a centimetre, and 40 MB for each thread.
const MOST_NODES: f32 = (1 << 21) as f32;

/// Nodes of a window beyond its hair, along each axis [cells].
const RING: f32 = 6.0;

/// Farthest cell from the anchor: single precision knows places there to a quarter of one.
const FARTHEST: f32 = (1 << 22) as f32;

/// Most threads that sum by themselves: each has a grid to be added up.
const MOST_GRIDS: usize = 8;

/// The hair volume of some simulated strands: what is known of their rest, and memory.
pub(crate) struct Volume {
    settings: scene::Volume,
    /// Edge of a cell [m].
    cell: f32,
    /// Whether the cell is larger than was asked for, so that their number stays bounded.
    grown: bool,
    /// The box that hair can reach from where its roots are at rest, in the anchor's space [m].
    reach: (Vec3, Vec3),
    /// Length of the longest strand [m].
    length: f32,
    /// Index of each tile's first point, and of the first after the last.
    firsts: Vec<u32>,
    own: Vec<OwnRows>,
    points: usize,
    /// Sum of the points' masses over the largest.
    total: f64,
    rest: Rest,
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
    pub anchor: Rigid,
    /// Mean segment of the strands [m].
    pub segment: f32,
    /// The longest strand [m].
    pub length: f32,
}

impl Volume {
    /// The volume of strands at rest; `None` where there is nothing to it, or where it is off and not to be `measured` either.
    pub fn new(settings: &scene::Volume, measured: bool, at: AtRest) -> Option<Self> {
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
        let asked = settings.cell.unwrap_or_else(|| rest::cell_for(&tiles, &at.anchor, at.segment.max(1e-4)));
        // Hair reaches no farther from its roots than it is long.
        let extent = Extent::of(&tiles, &Chart::new(&at.anchor, 1.0));
        let reach = rest::reach((extent.lo, extent.hi), at.length);
        let size = (reach.1 - reach.0).max(Vec3::splat(asked));
        let cell = asked.max((size.element_product() / (0.5 * MOST_NODES)).cbrt());
        let masses = || own.iter().flat_map(|o| o[own::MASS].0).filter(|m| *m > 0.0);
        let (points, total) = (masses().count(), masses().map(f64::from).sum());
        let mut volume = Self {
            settings: *settings,
            cell,
            grown: cell > asked,
            reach,
            length: at.length,
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
        let chart = Chart::new(&at.anchor, cell);
        let work = (&mut volume.sums[0], &mut volume.field);
        volume.rest.measure((at.strand, at.state), &volume.firsts, &mut own, &chart, work);
        volume.own = own;
        volume.taken_up = [taken_up(&volume.field.fill); 2];
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
        size_of_val(&self.own[..])
    }

    /// Whether it does anything to the points.
    pub fn acts(&self) -> bool {
        self.settings.method != VolumeMethod::Off
    }

    /// Most nodes that it ever has.
    pub fn most_nodes(&self) -> usize {
        Window::around(self.reach.0 / self.cell, self.reach.1 / self.cell).nodes()
    }

    /// How full of hair every place was when it was last measured, and the anchor at `anchor`.
    pub fn density(&self, anchor: Rigid) -> Density<'_> {
        Density::new(&self.field, self.cell, anchor)
    }

    /// The window of hair of this extent, as far as it can reach from its roots: what is beyond is lost. Where roots have gone so far from where they are at
    /// rest in the anchor's space that nodes would be too many, it is what hair reaches from there; what is elsewhere then meets nothing.
    fn window(&self, extent: &Extent) -> Window {
        let rest = [self.reach.0 / self.cell, self.reach.1 / self.cell];
        let within = |[lo, hi]: [Vec3; 2]| [extent.lo, extent.hi].map(|corner| corner.clamp(lo, hi));
        let reach = rest::reach((extent.roots[0], extent.roots[1]), self.length / self.cell);
        let [mut lo, mut hi] = within([rest[0].min(reach.0), rest[1].max(reach.1)]);
        let far = lo.abs().max(hi.abs()).max_element();
        if (hi - lo + RING).element_product() > MOST_NODES || far > FARTHEST {
            [lo, hi] = within(rest);
        }
        Window::around(lo, hi)
    }

    /// Measures where hair is, at the start of an interval, where the anchor is at `anchor`.
    pub fn measure(&mut self, (strand, state): (&[StrandRows], &[StateRows]), anchor: &Rigid) {
        self.reserve();
        let chart = Chart::new(anchor, self.cell);
        let tiles = Tiles { firsts: &self.firsts, strand, state, own: &self.own };
        let parts = rayon::current_num_threads().clamp(1, self.sums.len());
        let extent = (0..parts)
            .into_par_iter()
            .map(|part| Extent::of(&tiles.part(part, parts), &chart))
            .reduce(|| Extent::NONE, Extent::with);
        let window = self.window(&extent);
        let units = Units::new(self.points, self.total, extent.speed);
        let sums = &mut self.sums[..parts];
        sums.par_iter_mut().enumerate().for_each(|(part, sums)| {
            sums.clear(window.nodes());
            sums.add(&tiles.part(part, parts), &chart, &window, &units);
        });
        self.field.collect(window, &units, sums);
        self.taken_up[1] = taken_up(&self.field.fill);
    }

    /// Finds the accelerations of all points for an interval of `dt` [s] that has been measured: `push` [m/s²], shape `[points]` of all tiles.
    pub fn exchange(
        &mut self,
        dt: f32,
        (strand, state): (&[StrandRows], &[StateRows]),
        anchor: &Rigid,
        obstacles: (&[MovingObstacle], Option<&Rigid>),
        push: &mut [[Row; 3]],
    ) {
        match self.settings.method {
            VolumeMethod::Off => {}
            VolumeMethod::Density => self.press(dt, anchor),
            VolumeMethod::Incompressible => self.project(dt, anchor, obstacles),
        }
        let chart = Chart::new(anchor, self.cell);
        let tiles = Tiles { firsts: &self.firsts, strand, state, own: &self.own };
        gather::all(&tiles, &chart, &self.field.window, &self.field.push, push);
    }

    /// Acceleration by the pressure of crowded cells.
    fn press(&mut self, dt: f32, anchor: &Rigid) {
        let (field, rest, window) = (&self.field, &self.rest, self.field.window);
        let excess = |cell: usize| rest.excess(&window, cell, field.fill[cell]);
        density::pressures(field, excess, &mut self.pressures);
        let push = density::Push::new(field, &self.pressures, self.settings.pressure, self.cell, dt);
        let turn = Mat3::from_quat(anchor.rotation);
        let friction = friction(&self.settings, dt);
        fill_push(&mut self.field, friction, |n, mass| turn * push.at(n, mass));
    }

    /// Acceleration that makes velocities free of divergence where hair is full.
    fn project(&mut self, dt: f32, anchor: &Rigid, obstacles: (&[MovingObstacle], Option<&Rigid>)) {
        let (field, rest, window, cell) = (&self.field, &self.rest, self.field.window, self.cell);
        let turn = Mat3::from_quat(anchor.rotation);
        let back = turn.transpose();
        let to_lattice = |n: usize, node: &[f32; 4]| {
            let place = anchor.point(window.place(n).as_vec3() * cell);
            match solid(obstacles, place, dt) {
                Some(v) => (back * v, true),
                None => (back * Vec3::new(node[0], node[1], node[2]), false),
            }
        };
        let regain = self.settings.regain.min(1.0 / dt);
        let wanted = |c: usize| {
            4.0 * cell * regain * rest.excess(&window, c, field.fill[c]).clamp(0.0, density::MOST_EXCESS)
        };
        self.projection.project(field, to_lattice, wanted);
        let projection = &self.projection;
        let friction = friction(&self.settings, dt);
        fill_push(&mut self.field, friction, |n, _| turn * projection.change(n) / dt);
    }
}

/// The part of the points' rooms that is filled once [1]: what is fuller than full has lost it.
fn taken_up(fill: &[f32]) -> f64 {
    let (all, once) = fill
        .iter()
        .fold((0.0, 0.0), |(all, once), fill| (all + f64::from(*fill), once + f64::from(fill.min(1.0))));
    if all > 0.0 { once / all } else { 1.0 }
}

/// β of full cells for intervals of `dt` [s] [1/s].
fn friction(settings: &scene::Volume, dt: f32) -> f32 {
    -(-settings.friction * dt).exp_m1() / dt
}

/// Writes what points take from each node: `acceleration` by index and mass, and friction.
fn fill_push(field: &mut Field, friction: f32, acceleration: impl Fn(usize, f32) -> Vec3 + Sync) {
    let (window, nodes, fill) = (field.window, &field.nodes, &field.fill);
    let (slab, corners) = (window.slab(), window.corners());
    field.push.par_chunks_mut(slab).enumerate().for_each(|(z, push)| {
        for (k, push) in push.iter_mut().enumerate() {
            let n = z * slab + k;
            let [x, y, z, mass] = nodes[n];
            *push = [0.0; 4];
            if mass > 0.0 {
                // Hair rubs as far as there is hair: a lone strand meets none.
                let full: f32 = corners.iter().map(|corner| fill[n - corner]).sum();
                let beta = friction * (0.125 * full).min(1.0);
                let a = acceleration(n, mass);
                *push = [a.x + beta * x, a.y + beta * y, a.z + beta * z, beta];
            }
        }
    });
}

/// Velocity of the collider that `place` [m] is in at the start of an interval of `dt` [s] before which hair was carried along, in the world [m/s].
fn solid((obstacles, carried): (&[MovingObstacle], Option<&Rigid>), place: Vec3, dt: f32) -> Option<Vec3> {
    obstacles.iter().find_map(|o| {
        let local = o.start(carried).inverse_point(place);
        (o.shape.distance(local) < 0.0).then(|| (o.end.point(local) - place) / dt)
    })
}
