//! Hair-hair interaction on a grid. In intervals of 1/240 s, the mass and momentum of all simulated points
//! are splatted to a grid. Each point receives one acceleration in return, which stays constant for the
//! interval. The strands' solver sees only this acceleration.
//!
//! ```text
//! node    M = Σ w m,   V = Σ w m v / M                         (Petrovic 2005)
//! point   a = Σ w (A + β V + R V) − Σ w (β + R) v,   β = (1 − e^(−friction dt)) / dt
//! ```
//!
//! - A is the acceleration from the nodes' pressure, by one of two methods: `density` (Petrovic 2005) or
//!   `incompressible` (McAdams 2009).
//! - β is friction: the exact relaxation of the velocity toward that of the surrounding hair. It cannot
//!   overshoot, does not damp common motion, and conserves momentum, because at every node the sum over the
//!   points Σ m w (V − v) is 0. With A = (V⁺ − V)/dt, the fraction e^(−friction dt) of the velocity comes
//!   from FLIP and the rest from PIC (Zhu & Bridson 2005, like McAdams 2009). This blend does not depend on
//!   the length of the interval.
//! - R is the drag matrix of hair that crosses other hair, see `crossing`. Pressure and friction do not
//!   detect strands that pass through each other within a cell.
//!
//! All terms are rates, or exact for an interval of any length, and the length of intervals does not depend
//! on the frame rate (`simulation/strand_parts.rs`). The results therefore depend as little on the frame rate
//! as the strands do.
//!
//! # Correspondence to the five steps of McAdams 2009
//! - Steps 1 and 2 (positions and velocities free of collisions, and the effect of forces on velocities) are
//!   the strands' state and solve.
//! - Step 3, the volume correction, comes before step 2 instead of after it. It is part of the implicit
//!   solve, so it stretches no strand.
//! - Step 4, contact between individual strands where the grid is too coarse, so that sheets of straight hair
//!   do not pass through each other, is `strand_contact`, which can be enabled in addition.
//! - Contact with the body and step 5, the new positions, end every substep as they do without the volume.
//!
//! # Cost
//! For the bounds, 12 bytes of a point's position are read. For the sums, 24 bytes of position and velocity
//! and 8 bytes of constant data are read. For the acceleration, 24 bytes are read again, 12 are written here,
//! 24 are changed in the sum of all external accelerations, and 12 are read by the substeps. Each point adds
//! 64 integers at eight nodes and reads 96 values. Measured on one core with SSE2, for the bench scene with
//! 96,000 points in 21,000 nodes: 56 ns per point and exchange for `density`, 117 for `incompressible` (solve
//! of 34,000 nodes). This includes the cold caches that the strands find afterward, and tiles that run one
//! substep at a time. A frame of 1/60 s has four exchanges.
//!
//! # Limitations
//! Follow hairs are moved only by their guides.

mod brakes;
mod conjugate;
mod crossing;
mod density;
mod field;
mod gather;
mod grid_bounds;
mod incompressible;
mod rest;
mod rest_fill;
mod sample;
mod splat;
#[cfg(test)]
mod tests;

use crate::parallel::prelude::*;
use crate::{
    collide::ColliderPose,
    math::RigidTransform,
    settings::{self, VolumeMethod},
    simd::lanes::Row,
    strand::tile::{RootRows, StateRows},
};
use brakes::fill_push;
use crossing::Crossing;
use field::Field;
use glam::{Mat3, Vec3};
use grid_bounds::{GridBounds, GridTransform};
use incompressible::Projection;
use rest::{Rest, RestCells, RestSpacing, StrandsAtRest};
pub(crate) use sample::Density;
use splat::{Extent, OwnRows, Sums, Tiles, Units, own};

/// Maximum number of nodes: enough for a head of long hair spread in every direction, in cells of a
/// centimeter. It takes 75 MB for each thread.
const MAX_NODES: f32 = (1 << 21) as f32;

/// Number of nodes beyond the hair, along each axis [cells].
const RING_NODES: f32 = 6.0;

/// Maximum distance of a cell from the anchor [cells], where single precision resolves a quarter of a cell.
const MAX_DISTANCE: f32 = (1 << 22) as f32;

/// Smallest mean segment length that determines a cell [m].
const MIN_SEGMENT: f32 = 1e-4;

/// Maximum number of threads that sum separately: each has a grid, and the grids must be added up.
const MAX_GRIDS: usize = 8;

/// The hair volume of some simulated strands: measurements at rest, and buffers.
pub(crate) struct Volume {
    settings: settings::Volume,
    /// Edge of a cell [m].
    cell: f32,
    /// See [`VolumeReport::requested_cell`].
    requested: f32,
    /// The box that hair can reach with its roots at rest, in the anchor's space [m].
    reach: (Vec3, Vec3),
    /// Length of the longest strand [m].
    length: f32,
    /// Distance of adjacent strands at rest [m].
    spacing: f32,
    /// Length of strand per unit of mass [m].
    per_mass: f32,
    /// Index of each tile's first point, followed by the end.
    firsts: Vec<u32>,
    own: Vec<OwnRows>,
    points: usize,
    /// Sum of the points' masses relative to the largest.
    total: f64,
    rest: Rest,
    /// Accelerations of the points in this interval; shape `[points]` of all tiles [m/s²].
    acceleration: Vec<[Row; 3]>,
    sums: Vec<Sums>,
    field: Field,
    pressures: Vec<f32>,
    projection: Projection,
    /// Result of [`fill_ratio`] at rest and at the start of the last interval.
    taken_up: [f64; 2],
}

/// Report of a simulation's hair volume.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct VolumeReport {
    /// Edge of a cell [m].
    pub cell: f32,
    /// Edge of a cell in the settings, or the one that suits the density of the hair [m]. `cell` is larger if there would
    /// be more than two million cells.
    pub requested_cell: f32,
    /// Number of grid nodes in the last interval.
    pub nodes: usize,
    /// Volume of the hair at the start of the last interval relative to that at rest [1]. The volume is
    /// Σ min(fill, 1) over the cells, relative to rest. Overlapping strands lose volume.
    pub volume_ratio: f64,
}

/// State at the start of an interval: the anchor, and the fraction of their motion in the frame that roots
/// have completed [1].
pub(crate) struct Now {
    pub anchor: RigidTransform,
    pub gone: f32,
}

impl Now {
    fn transform(&self, cell: f32) -> GridTransform {
        GridTransform::on_the_way(&self.anchor, cell, self.gone)
    }
}

/// Strands at rest, from which the volume is built.
pub(crate) struct AtRest<'a> {
    /// Index of each tile's first point, followed by the end.
    pub firsts: Vec<u32>,
    /// Mass of each point [kg], 0 for particles that are not points of a strand; shape `[points]` of all
    /// tiles.
    pub mass: Vec<Row>,
    /// Shape `[tiles]`.
    pub roots: &'a [RootRows],
    /// Shape `[points]` of all tiles.
    pub state: &'a [StateRows],
    /// Pose of the anchor.
    pub anchor: RigidTransform,
    /// Mean segment length of the strands [m].
    pub segment: f32,
    /// Length of the longest strand [m].
    pub length: f32,
}

impl Volume {
    /// Creates the volume of strands at rest. Returns `None` if there is no mass, or if the method is off and
    /// `measured` is false.
    pub fn new(settings: &settings::Volume, measured: bool, at: AtRest) -> Option<Self> {
        let largest = at.mass.iter().flat_map(|m| m.0).fold(0.0, f32::max);
        if (settings.method == VolumeMethod::Off && !measured) || largest <= 0.0 {
            return None;
        }
        // Initially, rest volumes are proportional to the masses; they are computed below.
        let mut own: Vec<OwnRows> = at
            .mass
            .iter()
            .map(|m| {
                [m.0.map(|m| m / largest), m.0.map(|m| (m / largest * splat::REST_VOLUME_UNITS / 8.0).ceil())]
                    .map(Row)
            })
            .collect();
        let tiles = Tiles { firsts: &at.firsts, roots: at.roots, state: at.state, own: &own };
        let rest_spacing = RestSpacing::measure(&tiles, &at.anchor, at.segment.max(MIN_SEGMENT));
        let requested = settings.cell.unwrap_or(rest_spacing.cell);
        // Hair reaches no farther from its roots than its length.
        let extent = Extent::of(&tiles, &GridTransform::new(&at.anchor, 1.0), Vec3::ZERO);
        let reach = rest::reach(extent.roots.into(), at.length);
        let size = (reach.1 - reach.0).max(Vec3::splat(requested));
        let mut cell = requested;
        let farthest = reach.0.abs().max(reach.1.abs()).max_element();
        while (size / cell + RING_NODES + 1.0).element_product() > MAX_NODES || farthest / cell > MAX_DISTANCE
        {
            cell *= rest::CELL_GROWTH;
        }
        let masses = || own.iter().flat_map(|o| o[own::MASS].0).filter(|m| *m > 0.0);
        let (points, total) = (masses().count(), masses().map(f64::from).sum::<f64>());
        let mut volume = Self {
            settings: *settings,
            cell,
            requested,
            reach,
            length: at.length,
            spacing: rest_spacing.spacing,
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
        let strands = StrandsAtRest { roots: at.roots, state: at.state, firsts: &volume.firsts };
        // The extent of the hair in these cells is at most twice the distance.
        let fine = rest_spacing.cell.max(2.0 * farthest / MAX_DISTANCE);
        let cells = RestCells { anchor: &at.anchor, grid: cell, fine };
        volume.rest.measure(strands, &mut own, cells, work);
        volume.own = own;
        volume.taken_up = [fill_ratio(&volume.field.fill); 2];
        Some(volume)
    }

    /// Reserves memory for a grid around everything that hair can reach, and a grid for each thread, so that
    /// no step allocates.
    fn reserve(&mut self) {
        let nodes = self.most_nodes();
        let grids = crate::parallel::current_num_threads().clamp(1, MAX_GRIDS);
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

    /// Returns the report, see [`VolumeReport`].
    pub fn report(&self) -> VolumeReport {
        let nodes = self.field.bounds.nodes();
        VolumeReport {
            cell: self.cell,
            requested_cell: self.requested,
            nodes,
            volume_ratio: self.taken_up[1] / self.taken_up[0],
        }
    }

    /// Returns the memory used for the points, in bytes, without the grid.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.own[..]) + size_of_val(&self.acceleration[..])
    }

    /// Returns whether it acts on the points.
    pub fn acts(&self) -> bool {
        self.settings.method != VolumeMethod::Off
    }

    /// Returns the maximum number of nodes.
    pub fn most_nodes(&self) -> usize {
        GridBounds::around(self.reach.0 / self.cell, self.reach.1 / self.cell).nodes()
    }

    /// Returns the density at its last measurement, with the anchor at `anchor`.
    pub fn density(&self, anchor: RigidTransform) -> Density<'_> {
        Density::new(&self.field, self.cell, anchor)
    }

    /// Returns the grid bounds for hair of this extent, limited to what it can reach from its roots; hair
    /// beyond is ignored. If roots have moved so far from their rest position in the anchor's space that
    /// there would be too many nodes, the bounds are those reachable from the rest position, and hair
    /// elsewhere does not interact.
    fn bounds(&self, extent: &Extent) -> GridBounds {
        let rest = [self.reach.0 / self.cell, self.reach.1 / self.cell];
        let within = |[lo, hi]: [Vec3; 2]| [extent.lo, extent.hi].map(|corner| corner.clamp(lo, hi));
        let reach = rest::reach((extent.roots[0], extent.roots[1]), self.length / self.cell);
        let [mut lo, mut hi] = within([rest[0].min(reach.0), rest[1].max(reach.1)]);
        let far = lo.abs().max(hi.abs()).max_element();
        if (hi - lo + RING_NODES).element_product() > MAX_NODES || far > MAX_DISTANCE {
            [lo, hi] = within(rest);
        }
        GridBounds::around(lo, hi)
    }

    /// Begins a frame and clears the accelerations. Each interval's pressures start from those of the
    /// previous interval, except for the first of a frame, so that a frame depends only on positions and
    /// velocities.
    pub fn begin_frame(&mut self) {
        self.projection.clear();
        self.acceleration.fill([Row::default(); 3]);
    }

    /// Measures the hair at the start of an interval.
    pub fn measure(&mut self, (roots, state): (&[RootRows], &[StateRows]), now: &Now) {
        self.reserve();
        let transform = now.transform(self.cell);
        let tiles = Tiles { firsts: &self.firsts, roots, state, own: &self.own };
        let parts = crate::parallel::current_num_threads().clamp(1, self.sums.len());
        let carried = splat::root_velocity(&tiles);
        let extent = (0..parts)
            .into_par_iter()
            .map(|part| Extent::of(&tiles.part(part, parts), &transform, carried))
            .reduce(|| Extent::NONE, Extent::with);
        let bounds = self.bounds(&extent);
        let units = Units::new(self.points, self.total, (extent.speed, carried));
        let sums = &mut self.sums[..parts];
        sums.par_iter_mut().enumerate().for_each(|(part, sums)| {
            sums.clear(bounds.nodes());
            sums.add(&tiles.part(part, parts), &transform, &bounds, &units);
        });
        self.field.collect(bounds, &units, sums);
        self.taken_up[1] = fill_ratio(&self.field.fill);
    }

    /// Computes the accelerations of all points for an interval of `dt` [s] that has been measured. They
    /// replace those of the last interval in `push` [m/s²], shape `[points]` of all tiles. `colliders` are
    /// the colliders in the first substep of the interval, of `h` [s].
    pub fn compute_accelerations(
        &mut self,
        dt: f32,
        (roots, state): (&[RootRows], &[StateRows]),
        now: &Now,
        colliders: (&[ColliderPose], f32),
        push: &mut [[Row; 3]],
    ) {
        match self.settings.method {
            VolumeMethod::Off => {}
            VolumeMethod::Density => self.press(dt, &now.anchor),
            VolumeMethod::Incompressible => self.project(dt, &now.anchor, colliders),
        }
        let tiles = Tiles { firsts: &self.firsts, roots, state, own: &self.own };
        let points = (&mut self.acceleration[..], push);
        gather::all(&tiles, &now.transform(self.cell), &self.field.bounds, &self.field.push, points);
    }

    /// Returns the drag of crossing hair in an interval of `dt` [s].
    fn crossing(&self, dt: f32) -> Crossing {
        Crossing::new(self.spacing, self.per_mass, self.cell, dt)
    }

    /// Computes the acceleration by the pressure of overfull cells.
    fn press(&mut self, dt: f32, anchor: &RigidTransform) {
        let (field, rest, bounds) = (&self.field, &self.rest, self.field.bounds);
        let excess = |cell: usize| rest.over_density(&bounds, cell, field.fill[cell]);
        density::pressures(field, excess, &mut self.pressures);
        let push = density::Push::new(field, &self.pressures, self.settings.pressure, self.cell, dt);
        let turn = Mat3::from_quat(anchor.rotation);
        let brakes = (brakes::friction(&self.settings, dt), self.crossing(dt));
        fill_push(&mut self.field, brakes, |n, mass| turn * push.at(n, mass));
    }

    /// Computes the acceleration that makes velocities free of divergence where hair is full.
    fn project(&mut self, dt: f32, anchor: &RigidTransform, colliders: (&[ColliderPose], f32)) {
        let (field, rest, bounds, cell) = (&self.field, &self.rest, self.field.bounds, self.cell);
        let turn = Mat3::from_quat(anchor.rotation);
        let back = turn.transpose();
        let to_lattice = |n: usize, node: &[f32; 4]| {
            let place = anchor.transform_point(bounds.place(n).as_vec3() * cell);
            match solid(colliders, place) {
                Some(v) => (back * v, true),
                None => (back * Vec3::new(node[0], node[1], node[2]), false),
            }
        };
        let regain = self.settings.recovery_rate.min(1.0 / dt);
        let wanted = |c: usize| {
            4.0 * cell * regain * rest.over_density(&bounds, c, field.fill[c]).clamp(0.0, density::MAX_EXCESS)
        };
        self.projection.project(field, to_lattice, wanted);
        let brakes = (brakes::friction(&self.settings, dt), self.crossing(dt));
        let projection = &self.projection;
        fill_push(&mut self.field, brakes, |n, _| turn * projection.change(n) / dt);
    }
}

/// Returns the fraction of the points' rest volume that fills cells at most once [1]. What exceeds a full
/// cell is lost.
fn fill_ratio(fill: &[f32]) -> f64 {
    let (all, once) = fill
        .iter()
        .fold((0.0, 0.0), |(all, once), fill| (all + f64::from(*fill), once + f64::from(fill.min(1.0))));
    if all > 0.0 { once / all } else { 1.0 }
}

/// Returns the velocity of the collider that contains `place` [m] at the start of a substep of `h` [s], in
/// world space [m/s].
fn solid((colliders, h): (&[ColliderPose], f32), place: Vec3) -> Option<Vec3> {
    colliders.iter().find_map(|o| {
        let local = o.start.0.transpose() * (place - o.start.1);
        (o.shape.distance(local) < 0.0).then(|| (o.end.0 * local + o.end.1 - place) / h)
    })
}
