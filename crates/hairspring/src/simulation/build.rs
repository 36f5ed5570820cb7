//! Builds tiles from a groom: rest shapes and the sag-free start.

use super::{
    Simulation, SimulationBuilder,
    carried_air::{AirInHair, CarriedAir},
    cpu_solver::CpuSolver,
    layout::Order,
    manipulators::Manipulators,
    multipliers::{self, arc_lengths},
    strand_model::{StrandModel, material_of},
    strand_state::StrandState,
    teleport::Motion,
};
use crate::parallel::prelude::*;
use crate::strand::tile::TileLayout;
use crate::{
    air::{Noise, OcclusionSampler, WindOcclusion},
    collide::ColliderPose,
    forces::{ForceBuffers, HairField},
    groom::{Groom, StrandScale},
    material::{Material, Model},
    math::RigidTransform,
    settings::{Integrator, Solver},
    simd::lanes::{LANES, Row},
    strand::{
        drag::{AIR_KINEMATIC_VISCOSITY, AIR_VISCOSITY},
        frame_context::FrameContext,
        model::stretch::stiffening,
        rest_shape::{Fiber, RestShape, Start, rest_shape},
        section::{Section, is_round},
        tile::{
            Elastic, RestRows, RootRows, SegmentContactRows, StateRows, StrandRows, history, rest, root,
            springs, state, strand,
        },
        truss::{particles, truss},
    },
};
use fearless_simd::Level;
use glam::{DVec3, Vec3};
use std::{borrow::Cow, sync::Arc};

impl Simulation {
    /// Creates the simulation that a valid builder describes.
    pub(super) fn from_builder(builder: SimulationBuilder) -> Self {
        let SimulationBuilder { groom, strands, materials, solver, gravity, anchor, colliders, .. } = builder;
        let strands = &*strands;
        let materials = if materials.is_empty() { vec![Material::default()] } else { materials.to_vec() };
        let material = |s: usize| material_of(&materials, &groom, s);
        let balanced = if solver.sag_free { gravity.as_dvec3() } else { DVec3::ZERO };
        let elastic: Vec<(Elastic, bool)> = strands
            .par_iter()
            .map(|s| {
                let (s, material) = (*s as usize, material(*s as usize));
                let (points, scale) = (groom.strand(s), groom.scale(s));
                let model = elastic(material, scale, points, &solver);
                let radii = radii(material, &groom, s);
                let sections = sections(material, scale, points);
                let fiber = fiber(material, scale, model, &solver, (&radii, &sections));
                (model, needs_double(model, &simulated_points(model, points), &fiber, balanced))
            })
            .collect();
        let coils = elastic.iter().zip(strands).filter(|((model, _), s)| {
            *model == Elastic::Rod && material(**s as usize).model == Model::Curvature
        });
        let coils = coils.count();
        let Order { groom_strands, strand_of_lane, lane_of_strand, models } =
            Order::new(&groom, strands, &elastic);
        let mut first = 0;
        let tiles: Vec<TileLayout> = groom_strands
            .chunks(LANES)
            .zip(models)
            .map(|(lane, (model, double))| {
                let strands = || lane.iter().filter(|s| **s != u32::MAX).map(|s| *s as usize);
                let points = strands().map(|s| groom.range(s).len()).max().unwrap_or(0).max(3);
                let points = ((points - 1) * model.stride() + 1) as u32;
                let flat = model == Elastic::Rod && strands().any(|s| !is_round(material(s), groom.scale(s)));
                let place = TileLayout { first, points, model, flat, double };
                first += points;
                place
            })
            .collect();
        let second_order = solver.integrator == Integrator::Bdf2;

        let model = StrandModel {
            strand: vec![[Row::default(); strand::ROWS]; tiles.len()],
            rest: vec![[Row::default(); rest::ROWS]; first as usize],
            multipliers: Vec::new(),
            rest_penetration: Vec::new(),
            passes: Vec::new(),
            carried_air: CarriedAir::default(),
            tethers: Vec::new(),
            tensions: Default::default(),
            longest: strands.iter().map(|s| groom.strand_length(*s as usize)).fold(0.0, f32::max),
            longest_segment: strands
                .iter()
                .flat_map(|s| groom.strand(*s as usize).windows(2).map(|w| w[0].distance(w[1])))
                .fold(0.0, f32::max),
            multiplicity: vec![groom.strand_count() as f32 / strands.len() as f32; groom.strand_count()],
            start: Start::default(),
            materials,
            groom,
            groom_strands,
            strand_of_lane,
            lane_of_strand,
            tiles,
            solver,
            gravity,
            rest_anchor: anchor,
        };
        let state = StrandState {
            anchor,
            roots: vec![[Row::default(); root::ROWS]; model.tiles.len()],
            points: vec![[Row::default(); state::ROWS]; first as usize],
            history: vec![[Row::default(); history::ROWS]; if second_order { first as usize } else { 0 }],
            contact_age: vec![Row::default(); model.tiles.len()],
            segment_contacts: vec![
                SegmentContactRows::default();
                if solver.segment_contacts { first as usize } else { 0 }
            ],
            holds: vec![Vec::new(); model.tiles.len()],
            manipulators: Manipulators::default(),
            charged: Vec::new(),
            motion: Motion::default(),
            last_h: 0.0,
        };
        let mut simulation = Simulation::with_parts(Arc::new(model), state);
        simulation.fill(colliders);
        let rest_penetration = simulation.authored_depths(colliders);
        let passes = simulation.authored_passes(colliders);
        let tethers = simulation.tethers();
        let multipliers = multipliers::constants(&simulation.model);
        let springs = simulation.model.tiles.iter().any(|tile| tile.model == Elastic::Springs);
        let rows = |at: usize| simulation.state.points.iter().map(|rows| rows[at]).collect();
        let tensions = [rows(state::TENSION), if springs { rows(springs::SIDE) } else { Vec::new() }];
        let model = Arc::make_mut(&mut simulation.model);
        model.start.coils = coils;
        (model.tensions, model.rest_penetration, model.tethers) = (tensions, rest_penetration, tethers);
        (model.multipliers, model.passes) = (multipliers, passes);
        simulation
    }

    /// Assembles a simulation without force fields, hair volume or strand contact.
    fn with_parts(model: Arc<StrandModel>, state: StrandState) -> Self {
        let level = super::levels().next().unwrap_or_else(Level::new);
        Simulation {
            model,
            state,
            force_fields: Vec::new(),
            forces_added: 0,
            forces: ForceBuffers::default(),
            hair_field: HairField::default(),
            air_in_hair: AirInHair::default(),
            volume: None,
            neighbours: None,
            noise: Noise::default(),
            wind_occlusion: WindOcclusion::default(),
            occlusion: OcclusionSampler::default(),
            frame: FrameContext::default(),
            solver: Box::new(CpuSolver { level }),
            level,
            group_user_data: Vec::new(),
        }
    }

    /// Creates another simulation of the same strands, which shares the rest shapes and materials with this
    /// one. It starts from the current state of this one, without its force fields, hair volume, strand
    /// contact and wind occlusion. Its memory is about 60 % of that of a simulation of its own.
    pub fn instance(&self) -> Self {
        let mut other = Self::with_parts(self.model.clone(), self.state.clone());
        other.use_level(self.level);
        other.frame.segments = self.frame.segments;
        other.group_user_data.clone_from(&self.group_user_data);
        other
    }

    fn fill(&mut self, colliders: &[ColliderPose]) {
        let gravity = if self.model.solver.sag_free { self.model.gravity.as_dvec3() } else { DVec3::ZERO };
        let anchor = self.state.anchor;
        let model = Arc::make_mut(&mut self.model);
        let (groom, solver) = (&*model.groom, model.solver);
        let material = |s: usize| material_of(&model.materials, groom, s);

        let mut rest_of = model.rest.as_mut_slice();
        let mut state_of = self.state.points.as_mut_slice();
        let mut work = Vec::with_capacity(model.tiles.len());
        let strands = self.state.roots.iter_mut().zip(&mut model.strand);
        for ((tile, lanes), (roots, strand)) in
            model.tiles.iter().zip(model.groom_strands.chunks(LANES)).zip(strands)
        {
            let (rest, more_rest) = rest_of.split_at_mut(tile.points as usize);
            let (state, more_state) = state_of.split_at_mut(tile.points as usize);
            (rest_of, state_of) = (more_rest, more_state);
            work.push((tile, lanes, (roots, strand), rest, state));
        }
        model.start = work
            .into_par_iter()
            .with_min_len(16)
            .map(|(tile, lanes, (roots, strand), rest, state)| {
                let model = tile.model;
                let mut start = Start::default();
                for (lane, s) in lanes.iter().enumerate() {
                    let mut into = Lane {
                        lane,
                        roots: &mut *roots,
                        strand: &mut *strand,
                        rest: &mut *rest,
                        state: &mut *state,
                    };
                    if *s == u32::MAX {
                        into.write_idle();
                        continue;
                    }
                    let s = *s as usize;
                    let material = material(s);
                    let scale = groom.scale(s);
                    let points = simulated_points(model, groom.strand(s));
                    let radii = radii(material, groom, s);
                    let sections = sections(material, scale, groom.strand(s));
                    let fiber = fiber(material, scale, model, &solver, (&radii, &sections));
                    let fiber = Fiber { double: tile.double, ..fiber };
                    let shape = shape(model, &points, &fiber, gravity);
                    start = start + shape.start;
                    into.write_strand(&points, &shape, anchor, colliders);
                    let radius = radii.iter().sum::<f32>() / radii.len() as f32;
                    let rows = &mut *into.strand;
                    write_surface(rows, lane, material, scale);
                    rows[strand::REYNOLDS].0[lane] = 2.0 * radius / AIR_KINEMATIC_VISCOSITY;
                    rows[strand::DAMPING].0[lane] = material.damping * scale.damping;
                    rows[strand::TWIST_RATIO].0[lane] = sections[0].twist_ratio;
                    rows[strand::FLAT].0[lane] = sections[0].flat;
                    let points = groom.range(s).len();
                    rows[strand::POINTS].0[lane] = points as f32;
                    rows[strand::STIFFENING].0[lane] = stiffening(points);
                    rows[strand::AXIAL].0[lane] = material.young * std::f32::consts::PI * radius * radius;
                }
                start
            })
            .sum();
    }
}

/// Writes drag and friction of the strand in a lane, with the multipliers of its groom.
pub(super) fn write_surface(rows: &mut StrandRows, lane: usize, material: &Material, scale: StrandScale) {
    rows[strand::DRAG].0[lane] = material.drag * scale.drag * AIR_VISCOSITY;
    rows[strand::FRICTION].0[lane] = (material.friction * scale.friction).min(1.0);
    rows[strand::FRICTION_KINETIC].0[lane] = material.friction_kinetic;
}

/// Shortest simulated segment, over the length of its strand [1]. Single precision resolves a point far from
/// the root to 6e-8 of its distance. That is a thousandth of a segment of this length; the direction of a
/// shorter one is noise.
const MIN_SEGMENT_LENGTH: f32 = 5e-5;

/// Returns the particles that a model simulates for a strand: the strand's points, and extra particles
/// between them if the model has any. Points are moved apart along the strand where a segment is shorter than
/// [`MIN_SEGMENT_LENGTH`] allows.
pub(super) fn simulated_points(model: Elastic, points: &[Vec3]) -> Cow<'_, [Vec3]> {
    let mut points = Cow::Borrowed(points);
    let shortest = MIN_SEGMENT_LENGTH * points.windows(2).map(|w| w[0].distance(w[1])).sum::<f32>();
    let short = |w: &[Vec3]| w[0].distance(w[1]) < shortest;
    if points.windows(2).any(short) {
        let own = points.to_mut();
        let chord = own[own.len() - 1] - own[0];
        let mut along = own.windows(2).map(|w| w[1] - w[0]).find(|e| e.length() >= shortest).unwrap_or(chord);
        for i in 1..own.len() {
            let e = own[i] - own[i - 1];
            if e.length() < shortest {
                own[i] = own[i - 1] + along.normalize_or(Vec3::Y) * (1.01 * shortest);
            } else {
                along = e;
            }
        }
    }
    match model {
        Elastic::Springs => Cow::Owned(particles(&points)),
        Elastic::Straight | Elastic::Curvature | Elastic::Rod => points,
    }
}

/// Selects the elastic model of a strand.
fn elastic(material: &Material, scale: StrandScale, points: &[Vec3], solver: &Solver) -> Elastic {
    let coiled = turning(points) > COILED;
    // Only a strand that starts straight and free of load needs no rest turn.
    let straight = !solver.sag_free && is_straight(points);
    match material.model {
        // The local–global solver only supports a constant matrix and the curvature model.
        _ if solver.integrator == Integrator::LocalGlobal => Elastic::Curvature,
        Model::Springs => Elastic::Springs,
        Model::Curvature if straight => Elastic::Straight,
        Model::Curvature if coiled => Elastic::Rod,
        Model::Curvature => Elastic::Curvature,
        Model::Rod => Elastic::Rod,
        Model::Auto if straight && is_round(material, scale) => Elastic::Straight,
        Model::Auto => Elastic::Rod,
    }
}

/// Total turn of a strand above which the rod replaces the curvature model [rad]: half a turn. The curvature model's force
/// neglects its effect on the frames farther along the strand, so curled hair gains energy. Without damping, some waves
/// above this limit whirl for ever after they fall from their authored shape.
const COILED: f32 = std::f32::consts::PI;

/// Sum of the turns at a strand's joints [rad].
fn turning(points: &[Vec3]) -> f32 {
    let turn = |w: &[Vec3]| {
        let (a, b) = (w[1] - w[0], w[2] - w[1]);
        a.cross(b).length().atan2(a.dot(b))
    };
    points.windows(3).map(turn).sum()
}

/// Largest change of tangent at a joint of a strand that counts as straight [rad]. Below it, the effect of
/// twist is invisible.
const STRAIGHT: f32 = 1e-4;

fn is_straight(points: &[Vec3]) -> bool {
    let tangent = |w: &[Vec3]| (w[1] - w[0]).normalize_or_zero();
    points.windows(3).all(|w| tangent(&w[0..2]).distance(tangent(&w[1..3])) < STRAIGHT)
}

/// Radius at each point of strand `s` [m].
fn radii(material: &Material, groom: &Groom, s: usize) -> Vec<f32> {
    material.radii(groom.strand(s), groom.scale(s)).unwrap_or_else(|| groom.radii[groom.range(s)].to_vec())
}

/// Cross section at each of the strand's `points`.
fn sections(material: &Material, scale: StrandScale, points: &[Vec3]) -> Vec<Section> {
    let lengths = arc_lengths(points);
    let whole = lengths[lengths.len() - 1].max(multipliers::MIN_LENGTH);
    lengths.iter().map(|length| Section::new(material, scale, length / whole)).collect()
}

/// The fiber of a strand that is solved in single precision, from its radii and sections.
fn fiber<'a>(
    material: &'a Material,
    scale: StrandScale,
    model: Elastic,
    solver: &Solver,
    (radii, sections): (&'a [f32], &'a [Section]),
) -> Fiber<'a> {
    Fiber {
        radii,
        density: material.density as f64,
        mass_profile: &material.mass_profile,
        young: (material.young * material.bend * scale.bend) as f64,
        bend_profile: &material.bend_profile,
        sections,
        substep: super::step::substep_length(solver),
        // The matrix of the springs model includes damping, but accounting for it here would cost more
        // stiffness than rounding costs accuracy.
        damping: if model == Elastic::Springs {
            0.0
        } else {
            let most = material.damping_profile.iter().copied().fold(0.0, f32::max);
            (material.damping * scale.damping * most) as f64
        },
        double: false,
        twists: !matches!(model, Elastic::Straight | Elastic::Curvature),
    }
}

/// Computes the rest shape of a strand for a model.
fn shape(model: Elastic, points: &[Vec3], fiber: &Fiber, gravity: DVec3) -> RestShape {
    match model {
        Elastic::Springs => truss(points, fiber, gravity),
        Elastic::Straight | Elastic::Curvature | Elastic::Rod => rest_shape(points, fiber, gravity),
    }
}

/// Returns whether single precision cannot represent the stiffness of a strand's elements, by
/// [`Fiber::stiffest`]. Such a strand is solved in double precision, at about twice the cost.
fn needs_double(model: Elastic, points: &[Vec3], fiber: &Fiber, gravity: DVec3) -> bool {
    // The matrix of a flat fiber contains the stiffness of its stiff direction, I_max/I_min times that of the
    // other.
    let sections: Vec<Section> = fiber.sections.iter().map(|section| section.stiff()).collect();
    let stiff = Fiber { sections: &sections, ..*fiber };
    // The build without SIMD has single precision only. So has the springs model, which is for comparison
    // only.
    cfg!(not(one_lane))
        && model != Elastic::Springs
        && shape(model, points, &stiff, gravity).start.held_back > 0
}

/// One lane of a tile, for writing.
struct Lane<'a> {
    lane: usize,
    roots: &'a mut RootRows,
    strand: &'a mut StrandRows,
    rest: &'a mut [RestRows],
    state: &'a mut [StateRows],
}

impl Lane<'_> {
    fn write_vector(rows: &mut [Row], lane: usize, v: Vec3) {
        (rows[0].0[lane], rows[1].0[lane], rows[2].0[lane]) = (v.x, v.y, v.z);
    }

    /// Fills a lane without a strand: points of mass 1 without forces, and no rotation.
    fn write_idle(&mut self) {
        let lane = self.lane;
        for rows in self.rest.iter_mut() {
            rows[rest::MASS].0[lane] = 1.0;
            rows[rest::CLEARANCE].0[lane] = f32::MIN;
        }
        self.strand[strand::STIFFENING].0[lane] = 1.0;
        self.roots[root::TURN_START + 3].0[lane] = 1.0;
        self.roots[root::TURN_END + 3].0[lane] = 1.0;
        Self::write_vector(&mut self.strand[strand::FIRST..], lane, Vec3::Y * 0.01);
        Self::write_vector(&mut self.strand[strand::NORMAL..], lane, Vec3::X);
    }

    fn write_strand(
        &mut self,
        points: &[Vec3],
        shape: &RestShape,
        anchor: RigidTransform,
        colliders: &[ColliderPose],
    ) {
        let lane = self.lane;
        let last = points.len() - 1;
        for i in 0..self.rest.len() {
            let p = shape.points[i.min(last)];
            let rows = &mut self.rest[i];
            rows[rest::MASS].0[lane] = p.mass as f32;
            rows[rest::SLIP].0[lane] = 1.0;
            if i < last {
                rows[rest::LENGTH].0[lane] = p.length as f32;
                rows[rest::BEND].0[lane] = p.bend as f32;
                rows[rest::TWIST].0[lane] = p.twist as f32;
                Self::write_vector(&mut rows[rest::TURN..], lane, p.turn.as_vec3());
                self.state[i][state::TENSION].0[lane] = p.tension as f32;
                Self::write_vector(&mut self.state[i][state::NORMAL..], lane, p.normal.as_vec3());
            }
            let at = points[i.min(last)];
            let before = points[i.saturating_sub(1).min(last)];
            let depth = colliders.iter().map(|o| o.distance(at)).fold(0.0_f32, f32::min);
            rows[rest::CLEARANCE].0[lane] = depth;
            Self::write_vector(&mut self.state[i][state::EDGE..], lane, at - before);
        }
        let position = anchor.inverse_transform_point(points[0]);
        let turn = anchor.rotation.inverse();
        for (at, rotation) in [(root::START, root::TURN_START), (root::END, root::TURN_END)] {
            Self::write_vector(&mut self.roots[at..], lane, position);
            Self::write_vector(&mut self.roots[rotation..], lane, turn.xyz());
            self.roots[rotation + 3].0[lane] = turn.w;
        }
        Self::write_vector(&mut self.strand[strand::FIRST..], lane, points[1] - points[0]);
        Self::write_vector(&mut self.strand[strand::THIRD..], lane, points[2] - points[0]);
        Self::write_vector(&mut self.strand[strand::NORMAL..], lane, shape.points[0].normal.as_vec3());
    }
}
