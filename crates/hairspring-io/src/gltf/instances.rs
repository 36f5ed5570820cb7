//! The copies of a mesh that a node draws in the place of one (`EXT_mesh_gpu_instancing`).

use super::{
    accessor::{Buffers, components},
    json::{Document, Node},
};
use crate::{Problem, bytes::with_room};
use glam::{Affine3A, Quat, Vec3};

/// Returns the transforms of the copies in the space of node `index`; one that changes nothing for a node without copies.
pub(super) fn read(
    document: &Document,
    buffers: &Buffers<'_>,
    node: &Node,
    index: usize,
) -> Result<Vec<Affine3A>, Problem> {
    let Some(instances) = node.instances() else { return Ok(vec![Affine3A::IDENTITY]) };
    let wrong = |what: &str| {
        Problem::whole(format!(
            "the copies of node {index} (EXT_mesh_gpu_instancing) {what}; export without instancing"
        ))
    };
    let vectors = |accessor: Option<usize>, what: &str| {
        let read = |accessor| components::<3>(document, accessor, buffers, what);
        accessor.map(read).transpose()
    };
    let translations = vectors(instances.translation, "translations of copies")?;
    let scales = vectors(instances.scale, "scales of copies")?;
    let read_rotations = |accessor| components::<4>(document, accessor, buffers, "rotations of copies");
    let rotations = instances.rotation.map(read_rotations).transpose()?;
    let counts = [&translations, &scales].map(|list| list.as_ref().map(Vec::len));
    let mut counts = counts.into_iter().chain([rotations.as_ref().map(Vec::len)]).flatten();
    let Some(count) = counts.next() else { return Ok(vec![Affine3A::IDENTITY]) };
    if counts.any(|other| other != count) {
        return Err(wrong("have not the same number of translations, rotations and scales"));
    }
    let vector = |list: &Option<Vec<[f64; 3]>>, k: usize, default: Vec3| {
        list.as_ref().map_or(default, |list| list[k].map(|x| x as f32).into())
    };
    let mut transforms = with_room(count)?;
    for k in 0..count {
        let rotation =
            rotations.as_ref().map_or(Quat::IDENTITY, |list| Quat::from_array(list[k].map(|x| x as f32)));
        let (scale, translation) = (vector(&scales, k, Vec3::ONE), vector(&translations, k, Vec3::ZERO));
        let transform = Affine3A::from_scale_rotation_translation(scale, rotation.normalize(), translation);
        if !transform.is_finite() {
            return Err(wrong("have a transform that is not finite, or a rotation of 0, 0, 0, 0"));
        }
        transforms.push(transform);
    }
    Ok(transforms)
}
