//! Joins the simulated strands of all grooms into one simulation, so that hair of different grooms interacts.

use super::hair::StagedHair;
use crate::Scene;
use hairspring::{
    collide::ColliderPose, groom::Groom, material::Material, math::RigidTransform, settings::Solver,
    simulation::Simulation,
};
use std::sync::Arc;

/// Creates the simulation of all of `hair` at rest, groom after groom. Settings are the scene's, except for
/// the solver's. The anchor is at `anchor`, and colliders are at `obstacles`.
pub(super) fn simulation(
    hair: &[StagedHair],
    scene: &Scene,
    solver: Solver,
    anchor: RigidTransform,
    obstacles: &[ColliderPose],
) -> Simulation {
    let (groom, materials) = join(hair);
    let strands: Vec<u32> = (0..groom.strand_count() as u32).collect();
    let mut simulation = Simulation::builder(Arc::new(groom))
        .strands(&strands)
        .materials(&materials)
        .solver(solver)
        .gravity(scene.gravity)
        .anchor(anchor)
        .colliders_at_rest(obstacles)
        .build()
        .unwrap();
    simulation.set_hair_multiplicity(hair.iter().flat_map(StagedHair::hairs).collect());
    simulation.set_self_occlusion(obstacles);
    simulation.set_volume(&scene.volume);
    simulation.set_wind_occlusion(&scene.wind_occlusion);
    simulation.set_neighbours(&scene.neighbours);
    simulation
}

/// Joins the simulated strands into one groom with the data that a simulation needs. The materials of the
/// grooms are concatenated.
fn join(hair: &[StagedHair]) -> (Groom, Vec<Material>) {
    let mut all = Groom { offsets: vec![0], ..Groom::default() };
    let mut materials = Vec::new();
    for hair in hair {
        let (groom, own) = (hair.groom(), hair.materials());
        let first = materials.len();
        materials.extend_from_slice(own);
        if own.is_empty() {
            materials.push(Material::default());
        }
        let last = materials.len() - 1;
        for s in hair.simulated_strands().iter().map(|s| *s as usize) {
            all.points.extend_from_slice(groom.strand(s));
            all.radii.extend_from_slice(&groom.radii[groom.range(s)]);
            all.offsets.push(all.points.len() as u32);
            // A group beyond the end uses the last material of its groom.
            all.groups.push((first + groom.group(s) as usize).min(last) as u16);
            all.scales.push(groom.scale(s));
        }
    }
    (all, materials)
}
