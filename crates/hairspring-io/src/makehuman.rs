//! Reader for MakeHuman rigs: `base.obj` with a rig and weights in JSON (MPFB 2 of the MakeHuman community,
//! `data/rigs/standard`).
//!
//! The head of a bone is the center of a group of helper vertices of the mesh (`joint-…`), or of vertices
//! that are listed one by one. Bones have no rotation in the rest pose: skinning needs only their positions,
//! and retargeting aligns the bones.

use crate::{Character, Place, Problem, skin::four_heaviest};
use glam::{Affine3A, Vec3};
use hairspring::body::{Body, Joint, Mesh, Skin, Trs};
use serde::Deserialize;
use std::collections::{BTreeMap, HashMap};

/// Meters in one unit of MakeHuman's meshes [m]: decimeters.
pub(crate) const SCALE: f32 = 0.1;

/// One bone of a rig file. Fields that are not needed here are ignored.
#[derive(Deserialize)]
struct Bone {
    head: End,
    parent: String,
}

/// How the position of a bone's end is defined.
#[derive(Deserialize)]
struct End {
    strategy: String,
    cube_name: Option<String>,
    vertex_indices: Option<Vec<u32>>,
    vertex_index: Option<u32>,
}

#[derive(Deserialize)]
struct WeightFile {
    weights: BTreeMap<String, Vec<(u32, f32)>>,
}

/// Combines a mesh, its rig and its weights into a skinned body, in the mesh's own units.
///
/// # Errors
/// Returns an error if the JSON has another structure, if bones form a cycle, or if a vertex, group or bone
/// that is referred to does not exist. The problem says which of the files it is in.
pub fn parse(mesh: Mesh, rig: &[u8], weights: &[u8]) -> Result<Character, Problem> {
    let bones: BTreeMap<String, Bone> = json(rig, "rig")?;
    let WeightFile { weights } = json(weights, "weights")?;
    if bones.len() > u16::MAX as usize {
        return Err(Problem::limit(Place::Whole, "the rig has more than 65,535 bones"));
    }
    let groups = group_centers(&mesh);
    let order = parents_first(&bones)?;
    let index: HashMap<&str, usize> = order.iter().enumerate().map(|(i, name)| (*name, i)).collect();
    let places: Vec<Vec3> =
        order.iter().map(|name| place(&mesh, &groups, name, &bones[*name].head)).collect::<Result<_, _>>()?;
    let joints = order.iter().enumerate().map(|(i, name)| {
        let parent = index.get(bones[*name].parent.as_str()).copied();
        let from = parent.map_or(Vec3::ZERO, |p| places[p]);
        let rest = Trs { translation: places[i] - from, ..Trs::default() };
        Joint { name: (*name).to_owned(), parent: parent.map(|p| p as u32), rest }
    });
    let joints = joints.collect();
    let inverse_bind = places.iter().map(|p| Affine3A::from_translation(-*p)).collect();
    let mut pairs: Vec<Vec<(u16, f32)>> = vec![Vec::new(); mesh.positions.len()];
    for (name, list) in &weights {
        let bone = *index.get(name.as_str()).ok_or_else(|| {
            Problem::whole(format!("the weights name bone {name:?}, which the rig does not have"))
        })?;
        for (vertex, weight) in list {
            let of = pairs.get_mut(*vertex as usize).ok_or_else(|| {
                Problem::whole(format!(
                    "the weights name vertex {vertex} of a mesh of {}",
                    mesh.positions.len()
                ))
            })?;
            of.push((bone as u16, *weight));
        }
    }
    let (of, weights) = pairs.into_iter().map(four_heaviest).unzip();
    let skin = Skin { joints: of, weights, inverse_bind };
    Ok(Character { body: Body { mesh, joints, skin: Some(skin) }, ..Character::default() })
}

fn json<'a, T: Deserialize<'a>>(data: &'a [u8], what: &str) -> Result<T, Problem> {
    serde_json::from_slice(data).map_err(|e| Problem::line(e.line(), format!("invalid {what} file: {e}")))
}

/// Center of each named group's vertices.
fn group_centers(mesh: &Mesh) -> HashMap<&str, Vec3> {
    let mut centers = HashMap::new();
    for part in &mesh.parts {
        let mut vertices: Vec<u32> = mesh.triangles
            [part.triangles.start as usize..part.triangles.end as usize]
            .iter()
            .flatten()
            .copied()
            .collect();
        vertices.sort_unstable();
        vertices.dedup();
        let sum: Vec3 = vertices.iter().map(|v| mesh.positions[*v as usize]).sum();
        centers.insert(part.name.as_str(), sum / vertices.len() as f32);
    }
    centers
}

/// Names of the bones, parents first.
fn parents_first(bones: &BTreeMap<String, Bone>) -> Result<Vec<&str>, Problem> {
    let mut children: HashMap<&str, Vec<&str>> = HashMap::new();
    for (name, bone) in bones {
        // The empty name stands for "no parent".
        if name.is_empty() {
            return Err(Problem::whole("a bone of the rig has no name"));
        }
        if !bone.parent.is_empty() && !bones.contains_key(&bone.parent) {
            return Err(Problem::whole(format!(
                "bone {name:?} has parent {:?}, which the rig does not have",
                bone.parent
            )));
        }
        children.entry(&bone.parent).or_default().push(name);
    }
    let mut order = Vec::new();
    let mut stack: Vec<&str> = children.get("").cloned().unwrap_or_default();
    while let Some(name) = stack.pop() {
        order.push(name);
        stack.extend(children.get(name).into_iter().flatten());
    }
    if order.len() < bones.len() {
        return Err(Problem::whole("the bones of the rig form a cycle"));
    }
    Ok(order)
}

/// Position of an end of bone `name` [file units].
fn place(mesh: &Mesh, groups: &HashMap<&str, Vec3>, name: &str, end: &End) -> Result<Vec3, Problem> {
    let missing = |what: &str| {
        Problem::whole(format!("bone {name:?} is placed at {what}, which the mesh does not have"))
    };
    let vertex =
        |v: &u32| mesh.positions.get(*v as usize).copied().ok_or_else(|| missing(&format!("vertex {v}")));
    match (end.strategy.as_str(), &end.cube_name, &end.vertex_indices, end.vertex_index) {
        ("CUBE", Some(group), ..) => groups
            .get(group.as_str())
            .copied()
            .ok_or_else(|| missing(&format!("the middle of group {group:?}"))),
        ("MEAN", _, Some(vertices), _) if !vertices.is_empty() => {
            let sum: Vec3 = vertices.iter().map(vertex).sum::<Result<_, _>>()?;
            Ok(sum / vertices.len() as f32)
        }
        ("VERTEX", _, _, Some(v)) => vertex(&v),
        (strategy, ..) => {
            let text = format!(
                "bone {name:?} is placed by {strategy:?}; expected CUBE, MEAN or VERTEX with the vertices that it needs"
            );
            Err(Problem::whole(text))
        }
    }
}
