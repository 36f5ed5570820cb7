//! Joins the simulated strands of all grooms into one simulation, so that hair of different grooms interacts.

use super::hair::StagedHair;
use crate::Scene;
use hairspring::{
    collide::ColliderPose, groom::Groom, material::Material, math::RigidTransform, settings::Solver,
    simulation::Simulation,
};
use std::sync::Arc;

/// Creates the simulation of all of `hair` at rest, groom after groom. Settings are the scene's, except for
/// the solver's. `anchor` and `colliders` are the poses of the anchor and the colliders.
pub(super) fn simulation(
    hair: &[StagedHair],
    scene: &Scene,
    solver: Solver,
    anchor: RigidTransform,
    colliders: &[ColliderPose],
) -> Simulation {
    let (groom, materials) =
        (join(hair, |hair| hair.simulated_strands().to_vec(), usize::MAX), materials(hair));
    let strands: Vec<u32> = (0..groom.strand_count() as u32).collect();
    let mut simulation = Simulation::builder(Arc::new(groom))
        .strands(&strands)
        .materials(&materials)
        .solver(solver)
        .gravity(scene.gravity)
        .anchor(anchor)
        .colliders_at_rest(colliders)
        .build()
        .unwrap();
    simulation.set_hair_multiplicity(hair.iter().flat_map(StagedHair::hairs).collect());
    simulation.set_self_occlusion(colliders);
    simulation.set_volume(&scene.volume).expect("settings of a scene are in range");
    simulation.set_wind_occlusion(&scene.wind_occlusion).expect("settings of a scene are in range");
    simulation.set_neighbours(&scene.neighbours).expect("settings of a scene are in range");
    simulation
}

/// The materials of all grooms, one groom after the other; at least one for each.
pub(super) fn materials(hair: &[StagedHair]) -> Vec<Material> {
    let default = [Material::default()];
    hair.iter().flat_map(|hair| own_materials(hair, &default)).cloned().collect()
}

fn own_materials<'a>(hair: &'a StagedHair, default: &'a [Material]) -> &'a [Material] {
    if hair.materials().is_empty() { default } else { hair.materials() }
}

/// Joins strands `of` each hair into one groom with the data that a simulation needs. Of a strand with more than
/// `most` points (2 or more), so many are kept.
pub(super) fn join(hair: &[StagedHair], of: impl Fn(&StagedHair) -> Vec<u32>, most: usize) -> Groom {
    let mut all = Groom { offsets: vec![0], ..Groom::default() };
    let mut first = 0;
    for hair in hair {
        let groom = hair.groom();
        let last = first + hair.materials().len().max(1) - 1;
        for s in of(hair).into_iter().map(|s| s as usize) {
            let range = groom.range(s);
            let kept = range.len().min(most);
            for k in 0..kept {
                let at =
                    range.start + if kept < range.len() { k * (range.len() - 1) / (kept - 1) } else { k };
                all.points.push(groom.points[at]);
                all.radii.push(groom.radii[at]);
            }
            all.offsets.push(all.points.len() as u32);
            // A group beyond the end uses the last material of its groom.
            all.groups.push((first + groom.group(s) as usize).min(last) as u16);
            all.scales.push(groom.scale(s));
        }
        first = last + 1;
    }
    all
}
