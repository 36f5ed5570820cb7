//! From a groom to tiles: rest shapes, sag-free start, and the order of strands.

use super::{Simulation, TilePlace};
use crate::{
    collide::{ObstaclePose, Rigid},
    groom::Groom,
    material::Material,
    scene::Solver,
    strand::{
        interval::Interval,
        lanes::{LANES, Row},
        rest_shape::{Fibre, RestShape, rest_shape},
        tile::{RestRows, StateRows, StrandRows, rest, state, strand},
    },
};
use fearless_simd::Level;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::sync::Arc;

/// What a simulation is told once; only the anchor's pose changes.
pub(super) struct Settings {
    pub(super) solver: Solver,
    pub(super) gravity: Vec3,
    /// Where the anchor was at the end of the last step.
    pub(super) anchor: Rigid,
}

/// Viscosity of air at 25 °C [Pa s].
const AIR_VISCOSITY: f32 = 1.85e-5;

impl Simulation {
    /// Takes up `strands` (indices of `groom`, each with three points or more) at rest.
    ///
    /// - `materials`: fibre of each group of the groom; a group past the end uses the last; empty: the default.
    /// - `gravity`: [m/s²]; with `solver.sag_free` the groom is put in balance under it.
    /// - `anchor`: the frame that roots will be given to move with, at rest.
    /// - `obstacles`: what the hair meets, at rest: points that start inside may stay as deep as they are.
    pub fn new(
        groom: Arc<Groom>,
        strands: &[u32],
        materials: &[Material],
        solver: Solver,
        gravity: Vec3,
        anchor: Rigid,
        obstacles: &[ObstaclePose],
    ) -> Self {
        // Strands of like counts share tiles; a stable sort keeps neighbours together.
        let mut order: Vec<u32> = (0..strands.len() as u32).collect();
        order.sort_by_key(|k| std::cmp::Reverse(groom.range(strands[*k as usize] as usize).len()));
        let mut places = vec![0; strands.len()];
        for (place, k) in order.iter().enumerate() {
            places[*k as usize] = place as u32;
        }
        let mut lanes: Vec<u32> = order.iter().map(|k| strands[*k as usize]).collect();
        lanes.resize(strands.len().next_multiple_of(LANES), u32::MAX);
        let mut first = 0;
        let tiles: Vec<TilePlace> = lanes
            .chunks(LANES)
            .map(|lane| {
                let count = |s: &u32| {
                    if *s == u32::MAX { 0 } else { groom.range(*s as usize).len() }
                };
                let points = lane.iter().map(count).max().unwrap_or(0).max(3) as u32;
                let place = TilePlace { first, points };
                first += points;
                place
            })
            .collect();

        let mut simulation = Simulation {
            strand: vec![[Row::default(); strand::ROWS]; tiles.len()],
            rest: vec![[Row::default(); rest::ROWS]; first as usize],
            state: vec![[Row::default(); state::ROWS]; first as usize],
            groom,
            lanes,
            tiles,
            settings: Settings { solver, gravity, anchor },
            interval: Interval::default(),
            level: Level::new(),
            places,
            stiffened: 0,
        };
        simulation.fill(materials, obstacles);
        simulation
    }

    fn fill(&mut self, materials: &[Material], obstacles: &[ObstaclePose]) {
        let fallback = Material::default();
        let material = |group: u16| materials.get(group as usize).or(materials.last()).unwrap_or(&fallback);
        let gravity =
            if self.settings.solver.sag_free { self.settings.gravity.as_dvec3() } else { DVec3::ZERO };
        let groom = &*self.groom;
        let anchor = self.settings.anchor;

        let mut rest_of = self.rest.as_mut_slice();
        let mut state_of = self.state.as_mut_slice();
        let mut work = Vec::with_capacity(self.tiles.len());
        for ((tile, lanes), strand) in self.tiles.iter().zip(self.lanes.chunks(LANES)).zip(&mut self.strand) {
            let (rest, more_rest) = rest_of.split_at_mut(tile.points as usize);
            let (state, more_state) = state_of.split_at_mut(tile.points as usize);
            (rest_of, state_of) = (more_rest, more_state);
            work.push((lanes, strand, rest, state));
        }
        self.stiffened = work
            .into_par_iter()
            .with_min_len(16)
            .map(|(lanes, strand, rest, state)| {
                let mut stiffened = 0;
                for (lane, s) in lanes.iter().enumerate() {
                    let mut into = Lane { lane, strand: &mut *strand, rest: &mut *rest, state: &mut *state };
                    if *s == u32::MAX {
                        into.write_idle();
                        continue;
                    }
                    let s = *s as usize;
                    let material = material(groom.group(s));
                    let scale = groom.scale(s);
                    let radii: Vec<f32> = match material.radius {
                        Some(r) => vec![r; groom.range(s).len()],
                        None => groom.radii[groom.range(s)].to_vec(),
                    };
                    // GJ/EI of a round fibre: G πr⁴/2 over E πr⁴/4. The style's multiplier is over both.
                    let twist_ratio = 2.0 * material.shear / material.young;
                    let fibre = Fibre {
                        radii: &radii,
                        density: material.density as f64,
                        young: (material.young * material.bend * scale.bend) as f64,
                        tip: material.bend_tip as f64,
                        twist_ratio: twist_ratio as f64,
                    };
                    let points = groom.strand(s);
                    let shape = rest_shape(points, &fibre, gravity);
                    stiffened += shape.stiffened;
                    into.write_strand(points, &shape, anchor, obstacles);
                    let radius = radii.iter().sum::<f32>() / radii.len() as f32;
                    let rows = &mut *into.strand;
                    rows[strand::DRAG].0[lane] =
                        material.drag * scale.drag * drag_rate(radius, material.density);
                    rows[strand::DAMPING].0[lane] = material.damping * scale.damping;
                    rows[strand::FRICTION].0[lane] = material.friction;
                    let bent = shape.points.iter().any(|p| p.turn.length() > STRAIGHT);
                    rows[strand::TWIST_RATIO].0[lane] = if bent { twist_ratio } else { 0.0 };
                }
                stiffened
            })
            .sum();
    }
}

/// Largest rest turn of a strand that has nothing for twist to act on [rad]: its frames turn nothing that could be seen.
const STRAIGHT: f64 = 1e-6;

/// Rate at which still air stops a lone fibre moving across itself [1/s].
///
/// Slender body in Stokes flow: force per length 4πμ v / (ln(ℓ/r) + ½) across (Batchelor 1970, eq. 8.11), with the length over
/// radius of a hair's segment of a centimetre, about 250; over the mass per length ρπr².
fn drag_rate(radius: f32, density: f32) -> f32 {
    let slenderness = (0.01 / radius).max(2.0).ln() + 0.5;
    4.0 * AIR_VISCOSITY / (slenderness * density * radius * radius)
}

/// One lane of a tile, to write.
struct Lane<'a> {
    lane: usize,
    strand: &'a mut StrandRows,
    rest: &'a mut [RestRows],
    state: &'a mut [StateRows],
}

impl Lane<'_> {
    fn write_vector(rows: &mut [Row], lane: usize, v: Vec3) {
        (rows[0].0[lane], rows[1].0[lane], rows[2].0[lane]) = (v.x, v.y, v.z);
    }

    /// A lane without a strand: three points of mass 1 that nothing moves, and no rotation.
    fn write_idle(&mut self) {
        let lane = self.lane;
        for rows in self.rest.iter_mut() {
            rows[rest::MASS].0[lane] = 1.0;
            rows[rest::CLEARANCE].0[lane] = f32::MIN;
        }
        self.strand[strand::TURN_START + 3].0[lane] = 1.0;
        self.strand[strand::TURN_END + 3].0[lane] = 1.0;
        Self::write_vector(&mut self.strand[strand::FIRST..], lane, Vec3::Y * 0.01);
        Self::write_vector(&mut self.strand[strand::NORMAL..], lane, Vec3::X);
    }

    fn write_strand(
        &mut self,
        points: &[Vec3],
        shape: &RestShape,
        anchor: Rigid,
        obstacles: &[ObstaclePose],
    ) {
        let lane = self.lane;
        let last = points.len() - 1;
        for i in 0..self.rest.len() {
            let p = shape.points[i.min(last)];
            let rows = &mut self.rest[i];
            rows[rest::MASS].0[lane] = p.mass as f32;
            if i < last {
                rows[rest::LENGTH].0[lane] = p.length as f32;
                rows[rest::BEND].0[lane] = p.bend as f32;
                rows[rest::TWIST].0[lane] = p.twist as f32;
                Self::write_vector(&mut rows[rest::TURN..], lane, p.turn.as_vec3());
                self.state[i][state::TENSION].0[lane] = p.tension as f32;
                Self::write_vector(&mut self.state[i][state::NORMAL..], lane, p.normal.as_vec3());
            }
            let at = points[i.min(last)];
            let depth = obstacles.iter().map(|o| o.distance(at)).fold(0.0_f32, f32::min);
            rows[rest::CLEARANCE].0[lane] = depth;
            Self::write_vector(&mut self.state[i][state::X..], lane, at - points[0]);
        }
        let root = anchor.inverse_point(points[0]);
        let turn = anchor.rotation.inverse();
        for (at, rotation) in [(strand::ROOT_START, strand::TURN_START), (strand::ROOT_END, strand::TURN_END)]
        {
            Self::write_vector(&mut self.strand[at..], lane, root);
            Self::write_vector(&mut self.strand[rotation..], lane, turn.xyz());
            self.strand[rotation + 3].0[lane] = turn.w;
        }
        Self::write_vector(&mut self.strand[strand::FIRST..], lane, points[1] - points[0]);
        Self::write_vector(&mut self.strand[strand::NORMAL..], lane, shape.points[0].normal.as_vec3());
    }
}
