//! Selects which nodes of a glTF file are joints, and computes their rest pose.
//!
//! A node is a joint if a skin, an animation or a rigid mesh uses it, or if one of its children is a joint.
//! The rest pose is the bind pose: the transforms of a skin's joints when its mesh is undeformed. It is moved
//! into the scene by M, the transform of the skin's first root joint: vertices v become M v, and inverse bind
//! matrices B become B M⁻¹. Every pose is then exactly the one that the file describes.

use super::{
    accessor::{Buffers, components},
    invertible,
};
use crate::{Place, Problem};
use glam::{Affine3A, Mat4, Quat, Vec3};
use hairspring::body::{Joint, Trs};

/// The joints of one skin, and the transform of its meshes.
pub(super) struct SkinPlace {
    /// Index in the skeleton of each of the skin's joints.
    pub joints: Vec<u16>,
    /// Transforms a vertex of the skin's meshes into the rest pose.
    pub placed: Affine3A,
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
    pub(super) fn read(document: &gltf::Document, buffers: &Buffers) -> Result<Self, Problem> {
        let (order, parents, reached) = walk(document)?;
        let needed = needed(document, &parents, &reached);
        let nodes: Vec<gltf::Node<'_>> = document.nodes().collect();
        let mut joint_of: Vec<Option<u16>> = vec![None; nodes.len()];
        let (mut joints, mut defaults) = (Vec::new(), Vec::new());
        for &n in order.iter().filter(|n| needed[**n]) {
            let index = u16::try_from(joints.len())
                .map_err(|_| Problem::limit(Place::Whole, "more than 65,536 joints"))?;
            joint_of[n] = Some(index);
            let rest = local(&nodes[n])?;
            let name = nodes[n].name().map_or_else(|| format!("node{n}"), str::to_owned);
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
        skeleton.bind(document, buffers)?;
        Ok(skeleton)
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
    fn bind(&mut self, document: &gltf::Document, buffers: &Buffers) -> Result<(), Problem> {
        let node_world = world(&self.joints, |j| self.defaults[j].to_affine());
        let mut bound: Vec<Option<Affine3A>> = vec![None; self.joints.len()];
        for skin in document.skins() {
            let joints: Option<Vec<u16>> = skin.joints().map(|n| self.joint_of[n.index()]).collect();
            let joints = joints.ok_or_else(|| {
                Problem::whole(format!("skin {} has a joint outside the scene", skin.index()))
            })?;
            let binds = match skin.inverse_bind_matrices() {
                Some(accessor) => components::<16>(&accessor, buffers, "inverse bind matrices")?
                    .iter()
                    .map(|m| Affine3A::from_mat4(Mat4::from_cols_array(&m.map(|x| x as f32))))
                    .collect(),
                None => vec![Affine3A::IDENTITY; joints.len()],
            };
            if binds.len() < joints.len() {
                return Err(Problem::whole(format!(
                    "skin {} has fewer inverse bind matrices than joints",
                    skin.index()
                )));
            }
            // The root is the joint with the lowest index, since parents come before children.
            let root = joints.iter().zip(&binds).min_by_key(|(j, _)| **j);
            let placed = root.map_or(Affine3A::IDENTITY, |(j, b)| node_world[*j as usize] * *b);
            let singular =
                || Problem::whole(format!("skin {} has a matrix that cannot be inverted", skin.index()));
            let placed = invertible(placed).ok_or_else(singular)?;
            for (j, bind) in joints.iter().zip(&binds) {
                let bind = invertible(*bind * placed.inverse()).ok_or_else(singular)?;
                bound[*j as usize].get_or_insert(bind);
            }
            self.skins.push(SkinPlace { joints, placed });
        }
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
}

/// Lists the nodes of the scene with parents first, the parent of each node, and which nodes are reached.
#[allow(clippy::type_complexity)]
fn walk(document: &gltf::Document) -> Result<(Vec<usize>, Vec<Option<usize>>, Vec<bool>), Problem> {
    let count = document.nodes().len();
    let children: Vec<Vec<usize>> =
        document.nodes().map(|n| n.children().map(|c| c.index()).collect()).collect();
    let mut parents: Vec<Option<usize>> = vec![None; count];
    for (n, list) in children.iter().enumerate() {
        list.iter().for_each(|c| parents[*c] = Some(n));
    }
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let mut stack: Vec<usize> = match scene {
        Some(scene) => scene.nodes().map(|n| n.index()).collect(),
        None => (0..count).filter(|n| parents[*n].is_none()).collect(),
    };
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
        for c in children[n].iter().rev() {
            parents[*c] = Some(n);
            stack.push(*c);
        }
    }
    Ok((order, parents, reached))
}

/// Marks the nodes that must be joints: those that skins, animations and rigid meshes use, and all their
/// ancestors.
fn needed(document: &gltf::Document, parents: &[Option<usize>], reached: &[bool]) -> Vec<bool> {
    let mut needed = vec![false; parents.len()];
    let skins = document.skins().flat_map(|s| s.joints().map(|n| n.index()).collect::<Vec<_>>());
    let animated = document
        .animations()
        .flat_map(|a| a.channels().map(|c| c.target().node().index()).collect::<Vec<_>>());
    let rigid = document.nodes().filter(|n| n.mesh().is_some() && n.skin().is_none()).map(|n| n.index());
    for first in skins.chain(animated).chain(rigid).filter(|n| reached[*n]).collect::<Vec<_>>() {
        let mut at = Some(first);
        while let Some(n) = at.filter(|n| !needed[*n]) {
            needed[n] = true;
            at = parents[n];
        }
    }
    needed
}

/// A node's local transform.
fn local(node: &gltf::Node<'_>) -> Result<Trs, Problem> {
    let (t, r, s) = node.transform().decomposed();
    let trs = Trs { translation: Vec3::from(t), rotation: Quat::from_array(r), scale: Vec3::from(s) };
    let length = trs.rotation.length();
    if !(trs.translation.is_finite() && trs.scale.is_finite() && length.is_finite() && length > 1e-6) {
        return Err(Problem::whole(format!(
            "the transform of node {} is not finite, or its rotation is zero",
            node.index()
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
