//! Places the skins of a glTF file, and gives the joints their rest pose.

use super::{Skeleton, SkinPlace, is_flat, world};
use crate::{
    Problem,
    gltf::{
        accessor::{Buffers, components},
        invertible,
        json::{self, Document, Path},
    },
};
use glam::{Affine3A, Mat4, Vec3};
use hairspring::body::Trs;
use std::collections::{HashMap, HashSet};

/// A skin of the file.
struct SkinOf {
    /// Shape `[joints]`.
    joints: Vec<u16>,
    /// Inverse bind matrices; `None` if one cannot be inverted and no vertex uses it. Shape `[joints]`.
    binds: Vec<Option<Affine3A>>,
}

impl SkinOf {
    /// The joint with the lowest index, since parents come before children, and its inverse bind matrix.
    fn root(&self) -> Option<(u16, Affine3A)> {
        let bound = self.joints.iter().zip(&self.binds).filter_map(|(j, bind)| Some((*j, (*bind)?)));
        bound.min_by_key(|(j, _)| *j)
    }

    /// Whether all its matrices are the same although joints are at different places in `world`: no pose has the mesh
    /// undeformed.
    fn has_no_bind_pose(&self, world: &[Affine3A]) -> bool {
        let bound = || self.joints.iter().zip(&self.binds).filter_map(|(j, bind)| Some((*j, (*bind)?)));
        let Some((first, bind)) = bound().next() else { return false };
        let (first, place) = (world[usize::from(first)], |j: u16| world[usize::from(j)]);
        bound().all(|(_, other)| other.abs_diff_eq(bind, 1e-6))
            && bound().any(|(j, _)| !place(j).abs_diff_eq(first, 1e-4))
    }

    /// Whether joints with these transforms deform the meshes of the skin.
    fn is_posed(&self, world: &[Affine3A]) -> bool {
        let placed = self.root().and_then(|(j, bind)| invertible(world[usize::from(j)] * bind));
        let Some(back) = placed.map(|placed| placed.inverse()) else { return false };
        let bound = self.joints.iter().zip(&self.binds).filter_map(|(j, bind)| Some((*j, (*bind)?)));
        bound.into_iter().any(|(j, bind)| !is_identity(world[usize::from(j)] * bind * back))
    }
}

impl Skeleton {
    /// Moves joints into the rest pose and fills the inverse bind matrices.
    pub(super) fn bind(
        &mut self,
        document: &Document,
        buffers: &Buffers<'_>,
        notes: &mut Vec<String>,
    ) -> Result<(), Problem> {
        let node_world = world(&self.joints, |j| self.defaults[j].to_affine());
        let mut used = vec![false; document.skins.len()];
        for skin in self.skinned(document).filter_map(|node| node.skin) {
            // The mesh that names a missing skin is refused later.
            if let Some(used) = used.get_mut(skin) {
                *used = true;
            }
        }
        let mut skins = Vec::with_capacity(used.len());
        for (index, skin) in document.skins.iter().enumerate() {
            skins.push(if used[index] { Some(self.skin_of(document, skin, index, buffers)?) } else { None });
        }
        let mut bound: Vec<Option<Affine3A>> = vec![None; self.joints.len()];
        let moves_joints = document.animations.iter().flat_map(|a| &a.channels).any(|channel| {
            let is_moved = matches!(channel.target.path, Path::Translation | Path::Rotation | Path::Scale);
            is_moved && channel.target.node.is_some_and(|node| self.joint_of(node).is_some())
        });
        let unbound = skins.iter().position(|s| s.as_ref().is_some_and(|s| s.has_no_bind_pose(&node_world)));
        let places = if let Some(skin) = unbound {
            notes.push(format!(
                "skin {skin} has no bind pose, because its inverse bind matrices are missing or all the same, so the body rests in the pose in which it is saved; export it with its bind pose if this is not intended"
            ));
            self.in_saved_pose(&skins, &node_world)?
        } else if !moves_joints && skins.iter().flatten().any(|skin| skin.is_posed(&node_world)) {
            notes.push(
                "the file has no motion and its joints are saved in another pose than the bind pose, so the body rests in the saved pose; export it in the bind pose, or with a motion, if this is not intended"
                    .into(),
            );
            self.in_saved_pose(&skins, &node_world)?
        } else {
            self.in_bind_pose(&skins, &node_world, &mut bound, buffers, notes)?
        };
        self.skins = places;
        let mut rest: Vec<Affine3A> = Vec::with_capacity(self.joints.len());
        let mut saved: Vec<Affine3A> = Vec::with_capacity(self.joints.len());
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
            let above = joint.parent.map_or(Affine3A::IDENTITY, |p| saved[p as usize]);
            saved.push(above * joint.rest.to_affine());
            // The vertices stay without size, but hair and colliders move with the joint rigidly.
            if is_flat(&joint.rest) {
                joint.rest.scale = Vec3::ONE;
            }
            rest.push(parent * joint.rest.to_affine());
        }
        self.inverse_bind = bound
            .iter()
            .zip(&rest)
            .map(|(bind, rest)| bind.or(invertible(*rest).map(|r| r.inverse())).unwrap_or(Affine3A::IDENTITY))
            .collect();
        self.saved = saved;
        Ok(())
    }

    /// Places the meshes of each skin where the joints have them that the file is saved with.
    fn in_saved_pose(
        &self,
        skins: &[Option<SkinOf>],
        node_world: &[Affine3A],
    ) -> Result<Vec<Option<SkinPlace>>, Problem> {
        let place = |(s, skin): (usize, &Option<SkinOf>)| {
            let Some(skin) = skin else { return Ok(None) };
            let (joint, placed) =
                skin.root().map_or((0, Affine3A::IDENTITY), |(j, b)| (j, node_world[usize::from(j)] * b));
            let back = invertible(placed).ok_or_else(|| self.flat(s, joint))?.inverse();
            let correction = |(j, bind): (&u16, &Option<Affine3A>)| {
                bind.map_or(Affine3A::IDENTITY, |bind| node_world[usize::from(*j)] * bind * back)
            };
            let corrections = if skin.is_posed(node_world) {
                skin.joints.iter().zip(&skin.binds).map(correction).collect()
            } else {
                Vec::new()
            };
            Ok(Some(SkinPlace { joints: skin.joints.clone(), placed, corrections }))
        };
        skins.iter().enumerate().map(place).collect()
    }

    /// Places the meshes of each skin in the bind pose, which is written to `bound`.
    fn in_bind_pose(
        &self,
        skins: &[Option<SkinOf>],
        node_world: &[Affine3A],
        bound: &mut [Option<Affine3A>],
        buffers: &Buffers<'_>,
        notes: &mut Vec<String>,
    ) -> Result<Vec<Option<SkinPlace>>, Problem> {
        // Skins of parents come first, because the rest pose of a joint depends on that of its parents.
        let first = |skin: &SkinOf| skin.joints.iter().copied().min();
        let mut order: Vec<(usize, &SkinOf)> =
            skins.iter().enumerate().filter_map(|(s, skin)| Some((s, skin.as_ref()?))).collect();
        order.sort_by_key(|(_, skin)| first(skin));
        let mut places: Vec<Option<SkinPlace>> = skins.iter().map(|_| None).collect();
        for (s, skin) in order {
            let SkinOf { joints, binds } = skin;
            let (root, placed) = match skin.root() {
                Some((j, bind)) => (j, self.rest_world(bound, node_world, j, buffers)? * bind),
                None => (0, Affine3A::IDENTITY),
            };
            let placed = invertible(placed).ok_or_else(|| self.flat(s, root))?;
            let back = placed.inverse();
            let mut corrections = vec![Affine3A::IDENTITY; joints.len()];
            let mut slots: Vec<usize> = (0..joints.len()).collect();
            slots.sort_by_key(|slot| joints[*slot]);
            // The correction of each joint of this skin, for the joints below it.
            let mut corrected: HashMap<u16, Affine3A> = HashMap::new();
            for slot in slots {
                let (j, Some(bind)) = (joints[slot], binds[slot]) else { continue };
                let bind = invertible(bind * back).ok_or_else(|| self.flat(s, j))?;
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
            places[s] = Some(SkinPlace { joints: joints.clone(), placed, corrections });
        }
        Ok(places)
    }

    /// The error for a skin that a joint without size holds.
    fn flat(&self, skin: usize, joint: u16) -> Problem {
        let name = self.joints.get(usize::from(joint)).map_or("", |joint| &joint.name);
        Problem::whole(format!(
            "skin {skin} has no size, because its joint {name:?} or one above it has a scale of 0; scale the joint in the modeling program and export again"
        ))
    }

    /// The nodes that draw a mesh with a skin.
    fn skinned<'a>(&'a self, document: &'a Document) -> impl Iterator<Item = &'a json::Node> {
        let nodes = document.nodes.iter().zip(&self.drawn);
        nodes.filter(|(node, drawn)| **drawn && node.mesh.is_some() && node.skin.is_some()).map(|(n, _)| n)
    }

    /// Reads a skin's joints and inverse bind matrices.
    fn skin_of(
        &self,
        document: &Document,
        skin: &json::Skin,
        index: usize,
        buffers: &Buffers<'_>,
    ) -> Result<SkinOf, Problem> {
        let joint = |n: &usize| {
            self.joint_of.get(*n).copied().flatten().ok_or_else(|| {
                Problem::whole(format!(
                    "skin {index} has node {n} as a joint, which is not in the file's default scene; export the skeleton together with the mesh"
                ))
            })
        };
        let joints: Vec<u16> = skin.joints.iter().map(joint).collect::<Result<_, _>>()?;
        let Some(accessor) = skin.inverse_bind_matrices else {
            let binds = vec![Some(Affine3A::IDENTITY); joints.len()];
            return Ok(SkinOf { joints, binds });
        };
        let matrices = components::<16>(document, accessor, buffers, "inverse bind matrices")?;
        if matrices.len() < joints.len() {
            return Err(Problem::whole(format!(
                "skin {index} has {} inverse bind matrices for {} joints; export it again",
                matrices.len(),
                joints.len()
            )));
        }
        let matrix = |m: &[f64; 16]| Affine3A::from_mat4(Mat4::from_cols_array(&m.map(|x| x as f32)));
        let binds: Vec<Option<Affine3A>> =
            matrices.iter().take(joints.len()).map(|m| invertible(matrix(m))).collect();
        if binds.contains(&None) {
            let followed = self.followed(document, index, buffers)?;
            if let Some(slot) =
                (0..binds.len()).find(|slot| binds[*slot].is_none() && followed.contains(slot))
            {
                return Err(Problem::whole(format!(
                    "the inverse bind matrix of the joint {:?} in skin {index} cannot be inverted, but vertices follow the joint; bind the mesh to the skeleton again and export it",
                    self.joints[usize::from(joints[slot])].name
                )));
            }
        }
        Ok(SkinOf { joints, binds })
    }

    /// The joints of a skin that vertices follow.
    fn followed(
        &self,
        document: &Document,
        skin: usize,
        buffers: &Buffers<'_>,
    ) -> Result<HashSet<usize>, Problem> {
        let mut followed = HashSet::new();
        let nodes = self.skinned(document).filter(|node| node.skin == Some(skin));
        let meshes: HashSet<usize> = nodes.filter_map(|node| node.mesh).collect();
        let primitives =
            meshes.iter().filter_map(|mesh| document.meshes.get(*mesh)).flat_map(|m| &m.primitives);
        for (joints, weights) in primitives.flat_map(|primitive| primitive.attributes.weight_sets()) {
            let joints = components::<4>(document, joints, buffers, "joints")?;
            let weights = components::<4>(document, weights, buffers, "weights")?;
            let pairs = joints.as_flattened().iter().zip(weights.as_flattened());
            followed.extend(pairs.filter(|(_, weight)| **weight > 0.0).map(|(joint, _)| *joint as usize));
        }
        Ok(followed)
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

/// Whether a correction of a bind pose is only rounding: below 0.1 mm within a meter.
fn is_identity(correction: Affine3A) -> bool {
    correction.abs_diff_eq(Affine3A::IDENTITY, 1e-4)
}
