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
//!
//! If no animation moves the joints, and the file is saved in another pose than the bind pose, that is the rest pose. The
//! matrices M of the joints W B, with the transforms W of their nodes, differ then, and move the vertices of a skin by
//! their weighted M.

mod bind;

use super::{
    accessor::Buffers,
    given,
    json::Document,
    nodes::{Walk, local, walk},
};
use crate::{Place, Problem, text};
use glam::Affine3A;
use hairspring::body::{Joint, Trs};

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
    /// Shape `[skins]`; `None` for those that no mesh of the scene has.
    pub skins: Vec<Option<SkinPlace>>,
    /// Joint of each node; `None` if the node is not a joint.
    joint_of: Vec<Option<u16>>,
    /// Whether the node is part of the scene and visible; shape `[nodes]`.
    drawn: Vec<bool>,
    /// Rest transform of each joint in world space, with scales of 0; places rigid meshes.
    saved: Vec<Affine3A>,
}

impl Skeleton {
    pub(super) fn read(
        document: &Document,
        buffers: &Buffers<'_>,
        notes: &mut Vec<String>,
    ) -> Result<Self, Problem> {
        let Walk { order, parents, reached, drawn, .. } = walk(document, notes)?;
        let needed = needed(document, &parents, &reached)?;
        let nodes = &document.nodes;
        let mut joint_of: Vec<Option<u16>> = vec![None; nodes.len()];
        let (mut joints, mut defaults) = (Vec::new(), Vec::new());
        for &n in order.iter().filter(|n| needed[**n]) {
            let index = u16::try_from(joints.len())
                .map_err(|_| Problem::limit(Place::Whole, "more than 65,536 joints"))?;
            joint_of[n] = Some(index);
            let rest = local(&nodes[n], n)?;
            let name = given(&nodes[n].name).map_or_else(|| format!("node{n}"), text::name);
            joints.push(Joint { name, parent: parents[n].and_then(|p| joint_of[p]).map(u32::from), rest });
            defaults.push(rest);
        }
        let mut skeleton = Self {
            joints,
            inverse_bind: Vec::new(),
            defaults,
            skins: Vec::new(),
            joint_of,
            drawn,
            saved: Vec::new(),
        };
        notes.extend(skeleton.flattened());
        skeleton.bind(document, buffers, notes)?;
        Ok(skeleton)
    }

    /// Returns a note about the joints that the file scales to 0, if there are any.
    fn flattened(&self) -> Option<String> {
        let mut flat = self.joints.iter().filter(|joint| is_flat(&joint.rest));
        let first = flat.next()?;
        let more = match flat.count() {
            0 => String::new(),
            n => format!(" and {n} more"),
        };
        Some(format!(
            "the joint {:?}{more} has a scale of 0, so that what it moves has no size, and hair on it is held rigidly; scale or delete it in the modeling program",
            first.name
        ))
    }

    /// Whether `node` is part of the scene and visible.
    pub(super) fn draws(&self, node: usize) -> bool {
        self.drawn[node]
    }

    /// Returns the joint that belongs to `node`.
    pub(super) fn joint_of(&self, node: usize) -> Option<u16> {
        self.joint_of[node]
    }

    /// Returns the rest transform and the joint of a node that holds a rigid mesh.
    pub(super) fn rigid(&self, node: usize) -> (Affine3A, u16) {
        let joint = self.joint_of[node].unwrap_or(0);
        (self.saved[joint as usize], joint)
    }
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

/// Smallest scale of a joint whose transform can be inverted in single precision [1].
const SMALLEST_SCALE: f32 = 1e-6;

/// Whether a joint has no size along one of its axes.
fn is_flat(rest: &Trs) -> bool {
    rest.scale.abs().min_element() < SMALLEST_SCALE
}

/// World transforms of all joints from their local transforms.
fn world(joints: &[Joint], local: impl Fn(usize) -> Affine3A) -> Vec<Affine3A> {
    let mut world: Vec<Affine3A> = Vec::with_capacity(joints.len());
    for (j, joint) in joints.iter().enumerate() {
        world.push(joint.parent.map_or(local(j), |p| world[p as usize] * local(j)));
    }
    world
}
