//! Selects which nodes of a glTF file are joints, and computes their rest pose.
//!
//! A node is a joint if a skin, an animation or a rigid mesh uses it, or if one of its children is a joint.
//! The rest pose is the bind pose: the transforms of a skin's joints when its mesh is undeformed. It is moved
//! into the scene by M, the transform of the skin's first root joint: vertices v become M v, and inverse bind
//! matrices B become B M⁻¹. Every pose is then exactly the one that the file describes.
//!
//! A body has one rest pose, but skins of one skeleton may have different bind poses. A later skin is placed at the
//! joints that earlier skins have bound. If its matrices still differ at a joint by C = B₁⁻¹ B₂, its vertices move
//! by their weighted C into the rest pose.

use super::{
    accessor::{Buffers, components},
    invertible,
    json::{self, Document},
};
use crate::{Place, Problem, text};
use glam::{Affine3A, Mat4, Quat, Vec3};
use hairspring::body::{Joint, Trs};
use std::collections::HashMap;

/// The joints of one skin, and the transform of its meshes.
pub(super) struct SkinPlace {
    /// Index in the skeleton of each of the skin's joints.
    pub joints: Vec<u16>,
    /// Transforms a vertex of the skin's meshes into the rest pose.
    pub placed: Affine3A,
    /// What moves a placed vertex from the bind pose of this skin to the rest pose, for each joint that it
    /// follows; shape `[joints]`, or empty if the two poses are the same.
    pub corrections: Vec<Affine3A>,
}

/// The joints of a file.
pub(super) struct Skeleton {
    /// Parents before children.
    pub joints: Vec<Joint>,
    /// Transforms a rest-pose vertex into each joint's space; shape `[joints]`.
    pub inverse_bind: Vec<Affine3A>,
    /// Local transforms of the nodes as the file has them, used if an animation has no channel; shape
    /// `[joints]`.
    pub defaults: Vec<Trs>,
    /// Shape `[skins]`.
    pub skins: Vec<SkinPlace>,
    /// Joint of each node; `None` if the node is not a joint.
    joint_of: Vec<Option<u16>>,
    /// Whether the node is part of the scene; shape `[nodes]`.
    reached: Vec<bool>,
    /// Rest transform of each joint in world space.
    world: Vec<Affine3A>,
}

impl Skeleton {
    pub(super) fn read(
        document: &Document,
        buffers: &Buffers<'_>,
        notes: &mut Vec<String>,
    ) -> Result<Self, Problem> {
        let (order, parents, reached) = walk(document, notes)?;
        let needed = needed(document, &parents, &reached)?;
        let nodes = &document.nodes;
        let mut joint_of: Vec<Option<u16>> = vec![None; nodes.len()];
        let (mut joints, mut defaults) = (Vec::new(), Vec::new());
        for &n in order.iter().filter(|n| needed[**n]) {
            let index = u16::try_from(joints.len())
                .map_err(|_| Problem::limit(Place::Whole, "more than 65,536 joints"))?;
            joint_of[n] = Some(index);
            let rest = local(&nodes[n], n)?;
            let name = nodes[n].name.as_deref().map_or_else(|| format!("node{n}"), text::name);
            joints.push(Joint { name, parent: parents[n].and_then(|p| joint_of[p]).map(u32::from), rest });
            defaults.push(rest);
        }
        let mut skeleton = Self {
            joints,
            inverse_bind: Vec::new(),
            defaults,
            skins: Vec::new(),
            joint_of,
            reached,
            world: Vec::new(),
        };
        notes.extend(skeleton.flattened());
        skeleton.bind(document, buffers, notes)?;
        Ok(skeleton)
    }

    /// Returns a note about the joints that the file scales to 0, if there are any.
    fn flattened(&self) -> Option<String> {
        let mut flat = self.joints.iter().filter(|joint| joint.rest.scale.abs().min_element() == 0.0);
        let first = flat.next()?;
        let more = match flat.count() {
            0 => String::new(),
            n => format!(" and {n} more"),
        };
        Some(format!(
            "the joint {:?}{more} has a scale of 0, so that what it moves has no size; scale or delete it in the modeling program",
            first.name
        ))
    }

    /// Whether `node` is part of the scene.
    pub(super) fn reached(&self, node: usize) -> bool {
        self.reached[node]
    }

    /// Returns the joint that belongs to `node`.
    pub(super) fn joint_of(&self, node: usize) -> Option<u16> {
        self.joint_of[node]
    }

    /// Returns the rest transform and the joint of a node that holds a rigid mesh.
    pub(super) fn rigid(&self, node: usize) -> (Affine3A, u16) {
        let joint = self.joint_of[node].unwrap_or(0);
        (self.world[joint as usize], joint)
    }

    /// Moves joints into the bind pose and fills the inverse bind matrices.
    fn bind(
        &mut self,
        document: &Document,
        buffers: &Buffers<'_>,
        notes: &mut Vec<String>,
    ) -> Result<(), Problem> {
        let node_world = world(&self.joints, |j| self.defaults[j].to_affine());
        let mut skins = Vec::with_capacity(document.skins.len());
        for (index, skin) in document.skins.iter().enumerate() {
            skins.push(self.skin_of(document, skin, index, buffers)?);
        }
        // Skins of parents come first, because the rest pose of a joint depends on that of its parents.
        let root = |skin: &SkinOf| skin.joints.iter().copied().min();
        let mut order: Vec<usize> = (0..skins.len()).collect();
        order.sort_by_key(|s| root(&skins[*s]));
        let mut bound: Vec<Option<Affine3A>> = vec![None; self.joints.len()];
        let mut places: Vec<Option<SkinPlace>> = skins.iter().map(|_| None).collect();
        for s in order {
            let SkinOf { joints, binds } = std::mem::take(&mut skins[s]);
            let singular = || Problem::whole(format!("skin {s} has a matrix that cannot be inverted"));
            // The root is the joint with the lowest index, since parents come before children.
            let root = joints.iter().zip(&binds).min_by_key(|(j, _)| **j);
            let placed = match root {
                Some((j, b)) => self.rest_world(&bound, &node_world, *j, buffers)? * *b,
                None => Affine3A::IDENTITY,
            };
            let placed = invertible(placed).ok_or_else(singular)?;
            let back = placed.inverse();
            let mut corrections = vec![Affine3A::IDENTITY; joints.len()];
            let mut slots: Vec<usize> = (0..joints.len()).collect();
            slots.sort_by_key(|slot| joints[*slot]);
            // The correction of each joint of this skin, for the joints below it.
            let mut corrected: HashMap<u16, Affine3A> = HashMap::new();
            for slot in slots {
                let j = joints[slot];
                let bind = invertible(binds[slot] * back).ok_or_else(singular)?;
                corrections[slot] = match bound[j as usize] {
                    // An earlier skin has another bind pose: the vertices are moved to that one.
                    Some(earlier) => {
                        let correction = earlier.inverse() * bind;
                        if is_identity(correction) { Affine3A::IDENTITY } else { correction }
                    }
                    None => {
                        let correction = self.ancestor(&corrected, j, buffers)?.unwrap_or(Affine3A::IDENTITY);
                        let moved =
                            if correction == Affine3A::IDENTITY { bind } else { bind * correction.inverse() };
                        bound[j as usize] = Some(moved);
                        correction
                    }
                };
                corrected.insert(j, corrections[slot]);
            }
            let differs = corrections.iter().any(|c| *c != Affine3A::IDENTITY);
            if differs {
                notes.push(format!(
                    "skin {s} has another bind pose than a skin before it, and its mesh is moved to that one; export all meshes in one rest pose if a joint looks pinched"
                ));
            }
            let corrections = if differs { corrections } else { Vec::new() };
            places[s] = Some(SkinPlace { joints, placed, corrections });
        }
        self.skins = places.into_iter().flatten().collect();
        let mut rest: Vec<Affine3A> = Vec::with_capacity(self.joints.len());
        for (j, joint) in self.joints.iter_mut().enumerate() {
            let parent = joint.parent.map_or(Affine3A::IDENTITY, |p| rest[p as usize]);
            if let Some(bind) = bound[j] {
                let (scale, rotation, translation) =
                    (parent.inverse() * bind.inverse()).to_scale_rotation_translation();
                let trs = Trs { translation, rotation, scale };
                // If the bind pose is sheared or degenerate, the node keeps its own transform. Skinning is
                // exact either way.
                if translation.is_finite() && rotation.is_finite() && scale.is_finite() {
                    joint.rest = trs;
                }
            }
            rest.push(parent * joint.rest.to_affine());
        }
        self.inverse_bind = bound
            .iter()
            .zip(&rest)
            .map(|(bind, rest)| bind.or(invertible(*rest).map(|r| r.inverse())).unwrap_or(Affine3A::IDENTITY))
            .collect();
        self.world = rest;
        Ok(())
    }

    /// Reads a skin's joints and inverse bind matrices.
    fn skin_of(
        &self,
        document: &Document,
        skin: &json::Skin,
        index: usize,
        buffers: &Buffers<'_>,
    ) -> Result<SkinOf, Problem> {
        let joint = |n: &usize| self.joint_of.get(*n).copied().flatten();
        let joints: Option<Vec<u16>> = skin.joints.iter().map(joint).collect();
        let joints =
            joints.ok_or_else(|| Problem::whole(format!("skin {index} has a joint outside the scene")))?;
        let binds = match skin.inverse_bind_matrices {
            Some(accessor) => components::<16>(document, accessor, buffers, "inverse bind matrices")?
                .iter()
                .map(|m| Affine3A::from_mat4(Mat4::from_cols_array(&m.map(|x| x as f32))))
                .collect(),
            None => vec![Affine3A::IDENTITY; joints.len()],
        };
        if binds.len() < joints.len() {
            return Err(Problem::whole(format!("skin {index} has fewer inverse bind matrices than joints")));
        }
        Ok(SkinOf { joints, binds })
    }

    /// Returns the rest transform of joint `j` in world space: that of the skin that binds it or, above or
    /// without any, by the node's own transforms.
    fn rest_world(
        &self,
        bound: &[Option<Affine3A>],
        node_world: &[Affine3A],
        j: u16,
        buffers: &Buffers<'_>,
    ) -> Result<Affine3A, Problem> {
        let (mut at, mut below) = (usize::from(j), Affine3A::IDENTITY);
        loop {
            if let Some(bind) = bound[at] {
                return Ok(bind.inverse() * below);
            }
            buffers.spend(1)?;
            below = self.defaults[at].to_affine() * below;
            match self.joints[at].parent {
                Some(parent) => at = parent as usize,
                None => return Ok(node_world[usize::from(j)]),
            }
        }
    }

    /// Returns the value of the nearest ancestor of joint `j` that has one.
    fn ancestor(
        &self,
        values: &HashMap<u16, Affine3A>,
        j: u16,
        buffers: &Buffers<'_>,
    ) -> Result<Option<Affine3A>, Problem> {
        let mut at = self.joints[usize::from(j)].parent;
        while let Some(parent) = at {
            if let Some(value) = values.get(&(parent as u16)) {
                return Ok(Some(*value));
            }
            buffers.spend(1)?;
            at = self.joints[parent as usize].parent;
        }
        Ok(None)
    }
}

/// A skin of the file.
#[derive(Default)]
struct SkinOf {
    /// Shape `[joints]`.
    joints: Vec<u16>,
    /// Inverse bind matrices; shape `[joints]`, or longer.
    binds: Vec<Affine3A>,
}

/// Whether a correction of a bind pose is only rounding: below 0.1 mm within a meter.
fn is_identity(correction: Affine3A) -> bool {
    correction.abs_diff_eq(Affine3A::IDENTITY, 1e-4)
}

/// Lists the nodes of the scene with parents first, the parent of each node, and which nodes are reached.
#[allow(clippy::type_complexity)]
pub(super) fn walk(
    document: &Document,
    notes: &mut Vec<String>,
) -> Result<(Vec<usize>, Vec<Option<usize>>, Vec<bool>), Problem> {
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
    let (mut order, mut reached) = (Vec::new(), vec![false; count]);
    while let Some(n) = stack.pop() {
        if std::mem::replace(&mut reached[n], true) {
            return Err(Problem::whole(format!(
                "node {n} appears twice in the scene, or is its own ancestor"
            )));
        }
        order.push(n);
        for c in document.nodes[n].children.iter().rev() {
            parents[*c] = Some(n);
            stack.push(*c);
        }
    }
    let outside =
        document.nodes.iter().zip(&reached).filter(|(node, reached)| node.mesh.is_some() && !**reached);
    match outside.count() {
        0 => {}
        count => notes.push(format!(
            "{count} objects with meshes are not in the file's default scene and are left out; export one scene"
        )),
    }
    Ok((order, parents, reached))
}

/// Marks the nodes that must be joints: those that skins, animations and rigid meshes use, and all their
/// ancestors.
fn needed(document: &Document, parents: &[Option<usize>], reached: &[bool]) -> Result<Vec<bool>, Problem> {
    let mut needed = vec![false; parents.len()];
    let skins = document.skins.iter().flat_map(|s| &s.joints).copied();
    let channels = document.animations.iter().flat_map(|a| &a.channels);
    let animated = channels.filter_map(|c| c.target.node);
    let meshes = document.nodes.iter().enumerate().filter_map(|(n, node)| Some((n, node.mesh?, node.skin)));
    let is_rigid: Vec<bool> =
        document.meshes.iter().map(|m| m.primitives.iter().any(|p| !p.attributes.has_joints())).collect();
    let rigid = meshes
        .filter(|(_, mesh, skin)| skin.is_none() || is_rigid.get(*mesh).copied().unwrap_or(false))
        .map(|(n, ..)| n);
    for first in skins.chain(animated).chain(rigid) {
        let is_reached = reached.get(first).ok_or_else(|| {
            Problem::whole(format!("the file refers to node {first}, but has only {} nodes", parents.len()))
        })?;
        let mut at = Some(first).filter(|_| *is_reached);
        while let Some(n) = at.filter(|n| !needed[*n]) {
            needed[n] = true;
            at = parents[n];
        }
    }
    Ok(needed)
}

/// Largest difference of a matrix from that of its scale, rotation and translation, over its largest scale [1].
const SHEAR: f32 = 1e-3;

/// The local transform of node `index`.
pub(super) fn local(node: &json::Node, index: usize) -> Result<Trs, Problem> {
    let trs = match &node.matrix {
        Some(matrix) => {
            let matrix = Mat4::from_cols_array(matrix);
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
    if !(trs.translation.is_finite() && trs.scale.is_finite() && length.is_finite() && length > 1e-6) {
        return Err(Problem::whole(format!(
            "the transform of node {index} is not finite, or its rotation is zero"
        )));
    }
    Ok(Trs { rotation: trs.rotation.normalize(), ..trs })
}

/// World transforms of all joints from their local transforms.
fn world(joints: &[Joint], local: impl Fn(usize) -> Affine3A) -> Vec<Affine3A> {
    let mut world: Vec<Affine3A> = Vec::with_capacity(joints.len());
    for (j, joint) in joints.iter().enumerate() {
        world.push(joint.parent.map_or(local(j), |p| world[p as usize] * local(j)));
    }
    world
}
