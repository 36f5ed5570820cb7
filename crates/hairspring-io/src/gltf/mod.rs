//! Reader for glTF 2.0 (Khronos, ISO/IEC 12113): `.glb`, and `.gltf` with its buffers embedded or in separate
//! files.
//!
//! Every mesh follows its joints: skinned meshes by their weights, others rigidly with the node that holds
//! them. Animations are resampled at 60 Hz. Textures, morph targets, cameras and lights are not read.

mod accessor;
mod animation;
mod container;
mod skeleton;

use crate::{Place, Problem, obj::DEFAULT_COLOR, skin::four_heaviest};
use accessor::{Buffers, components};
use glam::{Affine3A, Vec2, Vec3};
use gltf::mesh::{Mode, Semantic};
use hairspring::body::{Body, Clip, Mesh, Part, Skin};
use skeleton::Skeleton;

/// A body and the motions from the same file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Character {
    /// Mesh, joints and weights.
    pub body: Body,
    /// Motions of its joints.
    pub clips: Vec<Clip>,
}

/// Maximum number of vertices, and of triangles, of all meshes together. A file may use one array many times.
const MAX_ELEMENTS: usize = 8_000_000;

/// Reads a glTF file. The format is in meters, Y up. `sibling` returns the bytes of a file next to it.
///
/// # Errors
/// Returns an error for JSON that violates the format, a required extension that is not supported, accessors
/// outside their buffers, a node that is its own ancestor, or more than eight million vertices.
pub fn parse(
    data: &[u8],
    sibling: &dyn Fn(&str) -> Option<Vec<u8>>,
) -> Result<(Character, Vec<String>), Problem> {
    let (document, buffers) = container::open(data, sibling)?;
    let mut notes = Vec::new();
    let skeleton = Skeleton::read(&document, &buffers)?;
    let mut build = Build {
        skeleton: &skeleton,
        mesh: Mesh::default(),
        joints: Vec::new(),
        weights: Vec::new(),
        skipped: 0,
    };
    for node in document.nodes() {
        if let (Some(mesh), true) = (node.mesh(), skeleton.reached(node.index())) {
            for primitive in mesh.primitives() {
                build.primitive(&node, &mesh, &primitive, &buffers)?;
            }
        }
    }
    if build.skipped > 0 {
        notes.push(format!("{} primitives of lines, points, strips or fans are not read", build.skipped));
    }
    let Build { mut mesh, joints, weights, .. } = build;
    if mesh.normals.contains(&Vec3::ZERO) {
        let given = std::mem::take(&mut mesh.normals);
        mesh.compute_normals();
        let given = given.into_iter().zip(&mut mesh.normals);
        given.filter(|(n, _)| *n != Vec3::ZERO).for_each(|(n, slot)| *slot = n);
    }
    let clips = animation::clips(&document, &buffers, &skeleton, &mut notes)?;
    let skin = Skin { joints, weights, inverse_bind: skeleton.inverse_bind };
    Ok((Character { body: Body { mesh, joints: skeleton.joints, skin: Some(skin) }, clips }, notes))
}

/// The mesh under construction; primitives are appended one by one.
struct Build<'a> {
    skeleton: &'a Skeleton,
    mesh: Mesh,
    joints: Vec<[u16; 4]>,
    weights: Vec<[f32; 4]>,
    skipped: usize,
}

impl Build<'_> {
    fn primitive(
        &mut self,
        node: &gltf::Node<'_>,
        mesh: &gltf::Mesh<'_>,
        primitive: &gltf::Primitive<'_>,
        buffers: &Buffers,
    ) -> Result<(), Problem> {
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            return Ok(());
        };
        if primitive.mode() != Mode::Triangles {
            self.skipped += 1;
            return Ok(());
        }
        let (first, first_triangle) = (self.mesh.positions.len(), self.mesh.triangles.len());
        let corners = primitive.indices().map_or(positions.count(), |i| i.count());
        if first + positions.count() > MAX_ELEMENTS || first_triangle + corners / 3 > MAX_ELEMENTS {
            return Err(Problem::limit(
                Place::Whole,
                format!("more than {MAX_ELEMENTS} vertices or triangles"),
            ));
        }
        let positions: Vec<Vec3> = components::<3>(&positions, buffers, "positions")?
            .into_iter()
            .map(|p| p.map(|x| x as f32).into())
            .collect();
        if positions.iter().any(|p| !p.is_finite()) {
            return Err(Problem::whole("a vertex position is not finite"));
        }
        let count = positions.len();
        let whole = |given: usize, what: &str| {
            let text = format!("a mesh has {count} positions but {given} {what}");
            if given == count { Ok(()) } else { Err(Problem::whole(text)) }
        };
        // Transform into the rest pose: by the skin's bind space, or by the node that holds the mesh.
        let (placed, own_joint) = match node.skin() {
            Some(skin) => (self.skeleton.skins[skin.index()].placed, 0),
            None => self.skeleton.rigid(node.index()),
        };
        let turned = placed.matrix3.inverse().transpose();
        match primitive.get(&Semantic::Normals) {
            Some(normals) => {
                let normals = components::<3>(&normals, buffers, "normals")?;
                whole(normals.len(), "normals")?;
                self.mesh.normals.extend(
                    normals
                        .into_iter()
                        .map(|n| (turned * Vec3::from(n.map(|x| x as f32))).normalize_or_zero()),
                );
            }
            None => self.mesh.normals.resize(first + count, Vec3::ZERO),
        }
        if let Some(uvs) = primitive.get(&Semantic::TexCoords(0)) {
            let uvs = components::<2>(&uvs, buffers, "texture coordinates")?;
            whole(uvs.len(), "texture coordinates")?;
            self.mesh.uvs.resize(first, Vec2::ZERO);
            self.mesh.uvs.extend(uvs.into_iter().map(|uv| Vec2::from(uv.map(|x| x as f32))));
        } else if !self.mesh.uvs.is_empty() {
            self.mesh.uvs.resize(first + count, Vec2::ZERO);
        }
        self.mesh.positions.extend(positions.iter().map(|p| placed.transform_point3(*p)));
        match node.skin() {
            Some(skin) => self.weigh(primitive, &self.skeleton.skins[skin.index()].joints, count, buffers)?,
            None => {
                self.joints.resize(first + count, [own_joint, 0, 0, 0]);
                self.weights.resize(first + count, [1.0, 0.0, 0.0, 0.0]);
            }
        }
        let indices: Vec<u32> = match primitive.indices() {
            Some(accessor) => {
                components::<1>(&accessor, buffers, "indices")?.into_iter().map(|[i]| i as u32).collect()
            }
            None => (0..count as u32).collect(),
        };
        if let Some(i) = indices.iter().find(|i| **i as usize >= count) {
            return Err(Problem::whole(format!("a triangle names vertex {i} of a mesh of {count}")));
        }
        let mirrored = placed.matrix3.determinant() < 0.0;
        self.mesh.triangles.extend(indices.chunks_exact(3).map(|t| {
            let [a, b, c] = [t[0], t[1], t[2]].map(|i| i + first as u32);
            if mirrored { [a, c, b] } else { [a, b, c] }
        }));
        self.part(mesh, primitive, first_triangle);
        Ok(())
    }

    /// Joints and weights of a skinned primitive's vertices: the four largest weights of all its sets.
    fn weigh(
        &mut self,
        primitive: &gltf::Primitive<'_>,
        skin_joints: &[u16],
        count: usize,
        buffers: &Buffers,
    ) -> Result<(), Problem> {
        let mut sets = Vec::new();
        // Four sets are sixteen weights per vertex, more than any program writes.
        for set in 0..4 {
            let pair = primitive.get(&Semantic::Joints(set)).zip(primitive.get(&Semantic::Weights(set)));
            let Some((joints, weights)) = pair else { break };
            sets.push((
                components::<4>(&joints, buffers, "joints")?,
                components::<4>(&weights, buffers, "weights")?,
            ));
        }
        if sets.is_empty() || sets.iter().any(|(j, w)| j.len() != count || w.len() != count) {
            return Err(Problem::whole(
                "a mesh that has a skin needs joints and weights for each of its vertices",
            ));
        }
        for v in 0..count {
            let mut pairs = Vec::with_capacity(4 * sets.len());
            for (joints, weights) in &sets {
                for (j, w) in joints[v].iter().zip(weights[v]) {
                    let joint = skin_joints.get(*j as usize).ok_or_else(|| {
                        Problem::whole(format!("a vertex names joint {j} of a skin of {}", skin_joints.len()))
                    })?;
                    pairs.push((*joint, w as f32));
                }
            }
            let (joints, weights) = four_heaviest(pairs);
            self.joints.push(joints);
            self.weights.push(weights);
        }
        Ok(())
    }

    /// Ends the part that began at `first_triangle`.
    fn part(&mut self, mesh: &gltf::Mesh<'_>, primitive: &gltf::Primitive<'_>, first_triangle: usize) {
        let material = primitive.material();
        let pbr = material.pbr_metallic_roughness();
        let [r, g, b, _] = pbr.base_color_factor();
        let mesh_name = mesh.name().map_or_else(|| format!("mesh{}", mesh.index()), str::to_owned);
        let name = match material.name() {
            Some(material) => format!("{mesh_name}.{material}"),
            None => mesh_name,
        };
        let color = if material.index().is_some() { Vec3::new(r, g, b) } else { DEFAULT_COLOR };
        self.mesh.parts.push(Part {
            name,
            triangles: first_triangle as u32..self.mesh.triangles.len() as u32,
            color,
            roughness: pbr.roughness_factor(),
        });
    }
}

/// Returns the transform, or `None` if it is singular or not finite.
fn invertible(m: Affine3A) -> Option<Affine3A> {
    let determinant = m.matrix3.determinant();
    (m.is_finite() && determinant.is_finite() && determinant.abs() > 1e-20 && m.inverse().is_finite())
        .then_some(m)
}
