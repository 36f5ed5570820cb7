//! The model of the simulated strands: everything about them that a step does not change.

use super::carried_air::CarriedAir;
use crate::{
    groom::Groom,
    material::Material,
    math::RigidTransform,
    settings::Solver,
    simd::lanes::Row,
    strand::{
        rest_shape::Start,
        tile::{MultiplierRows, RestRows, StrandRows, TileLayout},
    },
};
use glam::Vec3;
use std::sync::Arc;

/// Rest shapes, masses, stiffness, materials and memory layout of the simulated strands.
///
/// Several simulations can share one model: see [`Simulation::instance`](super::Simulation::instance). Functions that
/// change it between steps, such as [`Simulation::update_settings`](super::Simulation::update_settings) and
/// [`Simulation::take_over`](super::Simulation::take_over), copy it first if it is shared.
#[derive(Clone)]
pub(crate) struct StrandModel {
    pub(super) groom: Arc<Groom>,
    /// Strand of the groom in each lane, tile after tile; `u32::MAX` in lanes without one.
    pub(super) groom_strands: Vec<u32>,
    /// Index into the caller's strands for each lane; `u32::MAX` in lanes without one.
    pub(super) strand_of_lane: Vec<u32>,
    /// Lane of each simulated strand, in the order that the caller named them.
    pub(super) lane_of_strand: Vec<u32>,
    pub(super) tiles: Vec<TileLayout>,
    /// Constants of whole strands; shape `[tiles]`.
    pub(super) strand: Vec<StrandRows>,
    /// Rest shapes; shape `[points]` of all tiles.
    pub(super) rest: Vec<RestRows>,
    /// Multipliers of the strands' constants at each particle; as long as `rest`, or empty if no material has a
    /// profile of drag, damping or friction.
    pub(super) multipliers: Vec<MultiplierRows>,
    /// Authored depth of the segment that ends at each point, 0 or less [m]; as long as `rest`, or empty if no
    /// segment was authored inside a collider.
    pub(super) rest_penetration: Vec<Row>,
    /// 1 + index of the collider that each point does not touch, because it was authored deep inside; 0 for the other
    /// points. As long as `rest`, or empty if there is no such point.
    pub(super) passes: Vec<Row>,
    /// The air that dense hair carries along.
    pub(super) carried_air: CarriedAir,
    /// Largest distance of each point from its root [m]; empty if no material has a tether.
    pub(super) tethers: Vec<Row>,
    /// Tensions of the rest shape: of segments and, in the springs model, of the triangles' sides. Shapes as
    /// `rest`; the second is empty without springs.
    pub(super) tensions: [Vec<Row>; 2],
    /// Length of the longest strand [m].
    pub(super) longest: f32,
    /// Length of the longest segment [m].
    pub(super) longest_segment: f32,
    /// Number of hairs that each strand of the groom represents; shape `[strands of the groom]`.
    pub(super) multiplicity: Vec<f32>,
    /// At least one; a group past the end uses the last one.
    pub(super) materials: Vec<Material>,
    pub(super) solver: Solver,
    /// Gravity [m/s²].
    pub(super) gravity: Vec3,
    /// Pose of the anchor at rest.
    pub(super) rest_anchor: RigidTransform,
    pub(super) start: Start,
}

impl StrandModel {
    /// Material of a strand of the groom.
    pub(super) fn material(&self, strand: usize) -> &Material {
        material_of(&self.materials, &self.groom, strand)
    }
}

/// Returns the material of a strand of `groom`, of one or more `materials`: that of its group. A group past the end
/// uses the last one.
pub(super) fn material_of<'a>(materials: &'a [Material], groom: &Groom, strand: usize) -> &'a Material {
    &materials[(groom.group(strand) as usize).min(materials.len() - 1)]
}
