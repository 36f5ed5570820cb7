//! The nodes of a glTF file: which ones the scene has, which of them are drawn, and their transforms.

use super::json::{self, Document};
use crate::Problem;
use glam::{Mat4, Quat, Vec3};
use hairspring::body::Trs;

/// The nodes of the scene.
pub(super) struct Walk {
    /// Parents before children.
    pub order: Vec<usize>,
    /// Shape `[nodes]`.
    pub parents: Vec<Option<usize>>,
    /// Whether the node is part of the scene; shape `[nodes]`.
    pub reached: Vec<bool>,
    /// Whether it is, and is visible with all its ancestors; shape `[nodes]`.
    pub drawn: Vec<bool>,
    /// Number of objects with meshes that are hidden.
    pub hidden: usize,
}

/// Walks the default scene, and notes the objects that are left out.
pub(super) fn walk(document: &Document, notes: &mut Vec<String>) -> Result<Walk, Problem> {
    let count = document.nodes.len();
    let mut parents: Vec<Option<usize>> = vec![None; count];
    let missing =
        |n: usize| Problem::whole(format!("the file refers to node {n}, but has only {count} nodes"));
    for (n, node) in document.nodes.iter().enumerate() {
        for c in &node.children {
            *parents.get_mut(*c).ok_or_else(|| missing(*c))? = Some(n);
        }
    }
    let scene = match document.scene {
        Some(scene) => Some(document.scenes.get(scene).ok_or_else(|| {
            let scenes = document.scenes.len();
            Problem::whole(format!(
                "the default scene is {scene}, but the file has {scenes} scenes; export it again"
            ))
        })?),
        None => document.scenes.first(),
    };
    let listed = scene.map_or(&[][..], |scene| &scene.nodes);
    if let Some(n) = listed.iter().find(|n| **n >= count) {
        return Err(missing(*n));
    }
    let mut stack: Vec<usize> = match listed {
        [] => (0..count).filter(|n| parents[*n].is_none()).collect(),
        listed => listed.to_vec(),
    };
    if scene.is_some() && listed.is_empty() && count > 0 {
        notes.push("the scene of the file lists no objects, so all are read; export one scene".into());
    }
    stack.iter().for_each(|n| parents[*n] = None);
    stack.reverse();
    let (mut order, mut reached, mut drawn) = (Vec::new(), vec![false; count], vec![false; count]);
    while let Some(n) = stack.pop() {
        if std::mem::replace(&mut reached[n], true) {
            return Err(Problem::whole(format!(
                "node {n} appears twice in the scene, or is its own ancestor"
            )));
        }
        order.push(n);
        drawn[n] = document.nodes[n].is_visible() && parents[n].is_none_or(|parent| drawn[parent]);
        for c in document.nodes[n].children.iter().rev() {
            parents[*c] = Some(n);
            stack.push(*c);
        }
    }
    let with_mesh = || (0..count).filter(|n| document.nodes[*n].mesh.is_some());
    match with_mesh().filter(|n| !reached[*n]).count() {
        0 => {}
        count => notes.push(format!(
            "{count} objects with meshes are not in the file's default scene and are left out; export one scene"
        )),
    }
    let hidden = with_mesh().filter(|n| reached[*n] && !drawn[*n]).count();
    if hidden > 0 {
        notes.push(format!(
            "{hidden} objects with meshes are hidden (KHR_node_visibility) and are left out; show them before the export to keep them"
        ));
    }
    Ok(Walk { order, parents, reached, drawn, hidden })
}

/// Largest difference of a matrix from that of its scale, rotation and translation, over its largest scale [1].
const SHEAR: f32 = 1e-3;

/// The local transform of node `index`.
pub(super) fn local(node: &json::Node, index: usize) -> Result<Trs, Problem> {
    let trs = match &node.matrix {
        Some(matrix) => {
            let matrix = Mat4::from_cols_array(matrix);
            if let Some(axis) = (0..3).find(|k| matrix.col(*k).truncate() == Vec3::ZERO) {
                return Err(Problem::whole(format!(
                    "the matrix of node {index} has a scale of 0 along {}, so that its rotation is unknown; give the node a scale above 0, or delete it",
                    ["x", "y", "z"][axis]
                )));
            }
            let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
            let without = Mat4::from_scale_rotation_translation(scale, rotation, translation);
            let most = SHEAR * scale.abs().max_element();
            if without.is_finite() && !without.abs_diff_eq(matrix, most) {
                return Err(Problem::whole(format!(
                    "the matrix of node {index} has shear, but a node is read as scale, rotation and translation; export without shear"
                )));
            }
            Trs { translation, rotation, scale }
        }
        None => Trs {
            translation: node.translation.map_or(Vec3::ZERO, Vec3::from),
            rotation: node.rotation.map_or(Quat::IDENTITY, Quat::from_array),
            scale: node.scale.map_or(Vec3::ONE, Vec3::from),
        },
    };
    let length = trs.rotation.length();
    if !(trs.translation.is_finite() && trs.scale.is_finite() && length.is_finite()) {
        return Err(Problem::whole(format!(
            "the transform of node {index} is not finite; reset it in the modeling program and export again"
        )));
    }
    if length <= 1e-6 {
        return Err(Problem::whole(format!(
            "the rotation of node {index} is 0, 0, 0, 0, which is no rotation; reset it in the modeling program and export again"
        )));
    }
    Ok(Trs { rotation: trs.rotation.normalize(), ..trs })
}
