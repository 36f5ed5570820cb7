//! One strand of a simulation: views of its model and its state. What is not part of a solver reads and writes
//! strands only through them, so that it does not depend on the memory layout.
//!
//! Particle `i` counts from the root. Particle `j * stride` is point `j` of the strand; the springs model has an
//! extra particle between two points.

use super::{Simulation, strand_model::StrandModel, strand_state::StrandState};
use crate::{
    simd::lanes::{LANES, Row},
    strand::tile::{Elastic, TileLayout, multipliers, rest, root, segment_contact, springs, state, strand},
};
use glam::{DVec3, Quat, Vec3};

/// One strand, for reading.
#[derive(Clone, Copy)]
pub(super) struct StrandRef<'a> {
    model: &'a StrandModel,
    state: &'a StrandState,
    /// Its lane, counted over all tiles.
    lane: usize,
}

impl Simulation {
    /// The strand in lane `lane`, counted over all tiles.
    pub(super) fn strand(&self, lane: usize) -> StrandRef<'_> {
        StrandRef { model: &self.model, state: &self.state, lane }
    }

    /// All simulated strands, in the order given to [`Simulation::builder`].
    pub(super) fn each_strand(&self) -> impl ExactSizeIterator<Item = StrandRef<'_>> {
        self.model.lane_of_strand.iter().map(|lane| self.strand(*lane as usize))
    }

    /// The strand in lane `lane`, counted over all tiles, for writing.
    pub(super) fn strand_mut(&mut self, lane: usize) -> StrandMut<'_> {
        StrandMut::new(&self.model, &mut self.state, lane)
    }
}

impl<'a> StrandRef<'a> {
    fn tile(self) -> TileLayout {
        self.model.tiles[self.lane / LANES]
    }

    fn constant(self, row: usize) -> f32 {
        self.model.strand[self.lane / LANES][row].0[self.lane % LANES]
    }

    /// The motion of its root.
    fn root_motion(self, row: usize) -> f32 {
        self.state.roots[self.lane / LANES][row].0[self.lane % LANES]
    }

    fn root_position(self, row: usize) -> Vec3 {
        Vec3::from([0, 1, 2].map(|k| self.root_motion(row + k)))
    }

    fn rest(self, i: usize, row: usize) -> f32 {
        self.model.rest[self.at(i)][row].0[self.lane % LANES]
    }

    fn value(self, i: usize, row: usize) -> f32 {
        self.state.points[self.at(i)][row].0[self.lane % LANES]
    }

    fn vector(self, i: usize, row: usize) -> Vec3 {
        let rows = &self.state.points[self.at(i)][row..];
        Vec3::from([0, 1, 2].map(|k| rows[k].0[self.lane % LANES]))
    }

    /// Index of particle `i` in the arrays of points.
    fn at(self, i: usize) -> usize {
        self.tile().first as usize + i
    }

    /// Its index in the groom.
    pub fn index(self) -> usize {
        self.model.groom_strands[self.lane] as usize
    }

    /// Its elastic model.
    pub fn elastic(self) -> Elastic {
        self.tile().model
    }

    /// Particles for each point except the last.
    pub fn stride(self) -> usize {
        self.elastic().stride()
    }

    /// Number of points, as in the groom.
    pub fn point_count(self) -> usize {
        self.model.groom.range(self.index()).len()
    }

    /// Number of particles.
    pub fn particle_count(self) -> usize {
        (self.point_count() - 1) * self.stride() + 1
    }

    /// World position of its root at the end of the last step [m].
    pub fn root(self) -> Vec3 {
        let local = self.root_position(root::END);
        let (m, t) = self.state.anchor.matrix();
        // The same arithmetic as in the kernel, so that a body at rest gives bitwise the same position.
        m.x_axis * local.x + m.y_axis * local.y + m.z_axis * local.z + t
    }

    /// Root positions relative to the anchor at the start and at the end of the last step [m].
    pub fn local_roots(self) -> [Vec3; 2] {
        [root::START, root::END].map(|row| self.root_position(row))
    }

    /// World rotation of its root since rest.
    pub fn root_rotation(self) -> Quat {
        let local = Quat::from_array([0, 1, 2, 3].map(|k| self.root_motion(root::TURN_END + k)));
        self.state.anchor.rotation * local
    }

    /// The frame's normal on the first segment, in the world.
    pub fn root_normal(self) -> DVec3 {
        let normal = Vec3::from([0, 1, 2].map(|k| self.constant(strand::NORMAL + k)));
        (self.root_rotation() * normal).as_dvec3()
    }

    /// Relaxation time of bending at particle `i` [s].
    pub fn damping(self, i: usize) -> f32 {
        self.constant(strand::DAMPING) * self.multiplier(i, multipliers::DAMPING).unwrap_or(1.0)
    }

    /// Reynolds number over the speed of the air across the fiber, d/ν [s/m].
    pub fn reynolds(self) -> f32 {
        self.constant(strand::REYNOLDS)
    }

    /// Stretching stiffness EA [N].
    pub fn axial_stiffness(self) -> f32 {
        self.constant(strand::AXIAL)
    }

    /// Stiffness of its segments relative to that of a short strand [1].
    pub fn stiffening(self) -> f32 {
        self.constant(strand::STIFFENING)
    }

    /// Twisting over bending stiffness at particle `i`, GJ/EI [1].
    pub fn twist_ratio(self, i: usize) -> f32 {
        self.multiplier(i, multipliers::TWIST_RATIO).unwrap_or(self.constant(strand::TWIST_RATIO))
    }

    /// Relative additional bending stiffness at particle `i` in the plane of the frame's normal, ΔB/B [1].
    pub fn flatness(self, i: usize) -> f32 {
        self.multiplier(i, multipliers::FLAT).unwrap_or(self.constant(strand::FLAT))
    }

    /// A constant that varies along the strand, at particle `i`; `None` if no material has such a profile.
    fn multiplier(self, i: usize, row: usize) -> Option<f32> {
        Some(self.model.multipliers.get(self.at(i))?[row].0[self.lane % LANES])
    }

    /// Vector from the particle before to particle `i` [m].
    pub fn edge(self, i: usize) -> Vec3 {
        self.vector(i, state::EDGE)
    }

    /// Vector of the strand's segment `j`, between points `j` and `j + 1` [m].
    pub fn segment(self, j: usize) -> DVec3 {
        self.between(j * self.stride(), (j + 1) * self.stride())
    }

    /// Vector from particle `i` to particle `j` [m].
    pub fn between(self, i: usize, j: usize) -> DVec3 {
        (i + 1..=j).map(|k| self.edge(k).as_dvec3()).sum()
    }

    /// Positions of all particles, relative to the root [m].
    pub fn particles(self) -> impl Iterator<Item = Vec3> + 'a {
        (0..self.particle_count()).scan(Vec3::ZERO, move |x, i| {
            *x += self.edge(i);
            Some(*x)
        })
    }

    /// World positions of all points [m].
    pub fn points(self) -> impl Iterator<Item = Vec3> + 'a {
        let root = self.root();
        self.particles().step_by(self.stride()).map(move |x| root + x)
    }

    /// Velocity of particle `i` [m/s].
    pub fn velocity(self, i: usize) -> Vec3 {
        self.vector(i, state::V)
    }

    /// The frame's normal on the segment from particle `i` on; not in the springs model.
    pub fn normal(self, i: usize) -> Vec3 {
        self.vector(i, state::NORMAL)
    }

    /// Tension of the segment that begins at particle `i` [N].
    pub fn tension(self, i: usize) -> f32 {
        self.value(i, state::TENSION)
    }

    /// Contact force of a collider on particle `i` [N]; 0 without contact.
    pub fn normal_force(self, i: usize) -> f32 {
        self.value(i, state::NORMAL_FORCE)
    }

    /// Stretch of the friction spring between particle `i` and a collider [m]; 0 without contact.
    pub fn friction_stretch(self, i: usize) -> Vec3 {
        self.vector(i, state::FRICTION_STRETCH)
    }

    /// Contact of a collider with the segment that ends at particle `i`: its place on the segment, from 0 at the
    /// start to 1 at the end, and its force [N]; 0 without contact.
    pub fn segment_contact(self, i: usize) -> (f32, f32) {
        let rows = self.state.segment_contacts.get(self.at(i));
        let value = |rows: &[Row], row: usize| rows[row].0[self.lane % LANES];
        rows.map_or((1.0, 0.0), |rows| {
            (value(rows, segment_contact::AT), value(rows, segment_contact::FORCE))
        })
    }

    /// Rest length of the strand's segment that begins at particle `i` [m].
    pub fn rest_length(self, i: usize) -> f32 {
        self.rest(i, rest::LENGTH)
    }

    /// Mass of particle `i` [kg].
    pub fn mass(self, i: usize) -> f32 {
        self.rest(i, rest::MASS)
    }

    /// Bending stiffness of the joint at particle `i` [N m]; not in the springs model.
    pub fn bend(self, i: usize) -> f32 {
        self.rest(i, rest::BEND)
    }

    /// Rest change of tangent at the joint at particle `i`, in the frame of the segment before it [1]; not in the
    /// springs model.
    pub fn rest_turn(self, i: usize) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|k| f64::from(self.rest(i, rest::TURN + k))))
    }

    /// Rest twist φ of the joint at particle `i`, as 4 tan(φ/4) [1]; rod model only.
    pub fn rest_twist(self, i: usize) -> f32 {
        self.rest(i, rest::TWIST)
    }

    /// Stiffness [N/m] and rest length [m] of the spring from particle `i` to the second after it, which is an
    /// extra particle; springs model only.
    pub fn bend_spring(self, i: usize) -> [f32; 2] {
        [springs::K2, springs::L2].map(|row| self.rest(i, row))
    }

    /// Stiffness [N/m] and rest length [m] of the spring from particle `i` to the third after it; springs model only.
    pub fn torsion_spring(self, i: usize) -> [f32; 2] {
        [springs::K3, springs::L3].map(|row| self.rest(i, row))
    }

    /// Smallest permitted signed distance of particle `i` from a collider, 0 or less [m].
    pub fn clearance(self, i: usize) -> f32 {
        self.rest(i, rest::CLEARANCE)
    }

    /// Authored depth of the segment that ends at particle `i`, 0 or less [m].
    pub fn rest_penetration(self, i: usize) -> f32 {
        self.model.rest_penetration.get(self.at(i)).map_or(0.0, |row| row.0[self.lane % LANES])
    }

    /// Returns whether particle `i` passes through the collider with index `k`, because it was authored deep inside.
    pub fn passes(self, i: usize, k: usize) -> bool {
        let passes = |row: &Row| row.0[self.lane % LANES] == (k + 1) as f32;
        self.model.passes.get(self.at(i)).is_some_and(passes)
    }
}

/// One strand, for writing.
pub(super) struct StrandMut<'a> {
    model: &'a StrandModel,
    state: &'a mut StrandState,
    lane: usize,
}

impl<'a> StrandMut<'a> {
    /// The strand in a lane, counted over all tiles.
    pub fn new(model: &'a StrandModel, state: &'a mut StrandState, lane: usize) -> Self {
        Self { model, state, lane }
    }

    /// This strand, for reading.
    pub fn get(&self) -> StrandRef<'_> {
        StrandRef { model: self.model, state: self.state, lane: self.lane }
    }

    fn rows(&mut self, i: usize) -> &mut [Row] {
        &mut self.state.points[self.model.tiles[self.lane / LANES].first as usize + i]
    }

    fn set(&mut self, i: usize, row: usize, v: Vec3) {
        let lane = self.lane % LANES;
        let rows = &mut self.rows(i)[row..];
        (rows[0].0[lane], rows[1].0[lane], rows[2].0[lane]) = (v.x, v.y, v.z);
    }

    /// Sets the vector from the particle before to particle `i` [m].
    pub fn set_edge(&mut self, i: usize, edge: Vec3) {
        self.set(i, state::EDGE, edge);
    }

    /// Sets the velocity of particle `i` [m/s].
    pub fn set_velocity(&mut self, i: usize, v: Vec3) {
        self.set(i, state::V, v);
    }

    /// The components of the velocity of particle `i` [m/s].
    pub fn velocity_mut(&mut self, i: usize) -> [&mut f32; 3] {
        let lane = self.lane % LANES;
        let [x, y, z] = &mut self.rows(i)[state::V..state::V + 3] else { unreachable!("three components") };
        [&mut x.0[lane], &mut y.0[lane], &mut z.0[lane]]
    }

    /// Sets the frame's normal on the segment from particle `i` on.
    pub fn set_normal(&mut self, i: usize, normal: Vec3) {
        self.set(i, state::NORMAL, normal);
    }

    /// Sets the tension of the segment that begins at particle `i` [N].
    pub fn set_tension(&mut self, i: usize, tension: f32) {
        let lane = self.lane % LANES;
        self.rows(i)[state::TENSION].0[lane] = tension;
    }

    /// Sets the contact force of a collider on particle `i` [N].
    pub fn set_normal_force(&mut self, i: usize, force: f32) {
        let lane = self.lane % LANES;
        self.rows(i)[state::NORMAL_FORCE].0[lane] = force;
    }

    /// Sets the stretch of the friction spring between particle `i` and a collider [m].
    pub fn set_friction_stretch(&mut self, i: usize, stretch: Vec3) {
        self.set(i, state::FRICTION_STRETCH, stretch);
    }

    /// Sets the pose of its root relative to the anchor at rest in this frame.
    pub fn set_root(&mut self, position: Vec3, rotation: Quat) {
        let lane = self.lane % LANES;
        let rows = &mut self.state.roots[self.lane / LANES];
        for at in [root::START, root::END] {
            for (k, v) in position.to_array().into_iter().chain(rotation.to_array()).enumerate() {
                rows[at + k].0[lane] = v;
            }
        }
    }
}
