//! Joins the meshes of a glTF file to one mesh in the rest pose.

use super::{
    accessor::{Buffers, accessor, colors, components},
    given, instances,
    json::{self, Attributes, Document, Path, Primitive, Target, compressed},
    mesh_notes::LeftOut,
    morph,
    primitive::{NodeOf, name},
    skeleton::{Skeleton, SkinPlace},
};
use crate::{Place, Problem, bytes::with_room, color, obj::DEFAULT_COLOR, skin::four_heaviest, text};
use glam::{Affine3A, Mat3A, Vec2, Vec3};
use hairspring::body::{Mesh, Part};
use std::collections::{HashMap, HashSet};

/// Maximum number of vertices, and of triangles, of all meshes together. A file may use one array many times.
const MAX_ELEMENTS: usize = 8_000_000;

/// Vertices, and triangles, that a file of any size may have. A larger file may have one more for each byte.
const ELEMENTS: usize = 1_000_000;

/// Difference of a sum of weights from 1 that is due to rounding: weights may have 8 bits.
const WEIGHT_ROUNDING: f32 = 0.05;

/// A mesh, and what moves its vertices.
pub(super) struct Moved {
    pub mesh: Mesh,
    /// Four joints of each vertex.
    pub joints: Vec<[u16; 4]>,
    /// The weights of these joints.
    pub weights: Vec<[f32; 4]>,
    /// The morph targets that animations move.
    pub objects: Vec<morph::Object>,
}

/// Reads the meshes of all nodes of the scene.
pub(super) fn read(
    document: &Document,
    buffers: &Buffers<'_>,
    skeleton: &Skeleton,
    notes: &mut Vec<String>,
) -> Result<Moved, Problem> {
    let channels = document.animations.iter().flat_map(|animation| &animation.channels);
    let weights = channels.filter(|channel| channel.target.path == Path::Weights);
    let mut build = Build {
        document,
        buffers,
        skeleton,
        most: buffers.size().saturating_add(ELEMENTS).min(MAX_ELEMENTS),
        mesh: Mesh::default(),
        joints: Vec::new(),
        weights: Vec::new(),
        animated: weights.filter_map(|channel| channel.target.node).collect(),
        targets: Vec::new(),
        left_out: LeftOut::default(),
    };
    let mut objects = Vec::new();
    for (index, node) in document.nodes.iter().enumerate() {
        let Some(mesh) = node.mesh.filter(|_| skeleton.draws(index)) else { continue };
        let missing =
            || Problem::whole(format!("node {index} names mesh {mesh}, which the file does not have"));
        let named = document.meshes.get(mesh).ok_or_else(missing)?;
        // A skin moves its mesh to the joints, wherever its node and copies of the node are.
        build.left_out.copies += usize::from(node.skin.is_some() && node.instances().is_some());
        let copies = match node.skin {
            Some(_) => vec![Affine3A::IDENTITY],
            None => instances::read(document, buffers, node, index)?,
        };
        for copy in copies {
            // Primitives of one mesh often share their vertices, and only differ in indices and material.
            let mut shared = HashMap::new();
            for (k, primitive) in named.primitives.iter().enumerate() {
                let node = NodeOf { node, index, mesh: named, mesh_index: mesh, copy, primitive: k };
                build.primitive(&node, primitive, &mut shared)?;
            }
        }
        if !build.targets.is_empty() {
            objects.push(morph::Object { node: index, targets: std::mem::take(&mut build.targets) });
        }
    }
    build.left_out.note(notes);
    let Build { mut mesh, joints, weights, .. } = build;
    notes.extend(color::into_range(&mut mesh.colors));
    if mesh.normals.contains(&Vec3::ZERO) {
        let given = std::mem::take(&mut mesh.normals);
        mesh.compute_normals();
        let given = given.into_iter().zip(&mut mesh.normals);
        given.filter(|(n, _)| *n != Vec3::ZERO).for_each(|(n, slot)| *slot = n);
    }
    Ok(Moved { mesh, joints, weights, objects })
}

/// What a mesh consists of, except its triangles.
type Vertices<'a> = (&'a Attributes, &'a [Target]);

/// The mesh under construction; primitives are appended one by one.
struct Build<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    skeleton: &'a Skeleton,
    /// Maximum number of vertices, and of triangles.
    most: usize,
    mesh: Mesh,
    joints: Vec<[u16; 4]>,
    weights: Vec<[f32; 4]>,
    /// Nodes whose morph targets an animation moves.
    animated: HashSet<usize>,
    /// The morph targets of the current node, if an animation moves them.
    targets: Vec<morph::Target>,
    left_out: LeftOut,
}

impl<'a> Build<'a> {
    /// Appends a primitive. `shared` has the first vertex and the number of the vertices that are already there.
    fn primitive(
        &mut self,
        node: &NodeOf<'a>,
        primitive: &'a Primitive,
        shared: &mut HashMap<Vertices<'a>, (usize, usize)>,
    ) -> Result<(), Problem> {
        // Copies of a mesh, and nodes that share one, visit a primitive any number of times.
        self.buffers.spend(1)?;
        self.check(self.mesh.parts.len())?;
        let Some(position) = primitive.attributes.position else {
            self.left_out.positionless += 1;
            return Ok(());
        };
        if primitive.is_only_draco(self.document) {
            return Err(compressed("KHR_draco_mesh_compression"));
        }
        let mode = primitive.mode.unwrap_or(4);
        if !(4..=6).contains(&mode) {
            self.left_out.lines += 1;
            return Ok(());
        }
        let placed = match node.node.skin {
            Some(skin) => {
                let missing = || {
                    let text = format!("node {} names skin {skin}, which the file does not have", node.index);
                    Problem::whole(text)
                };
                let place = self.skeleton.skins.get(skin).and_then(Option::as_ref).ok_or_else(missing)?;
                primitive.attributes.has_joints().then_some(place)
            }
            None => None,
        };
        self.left_out.rigid += usize::from(node.node.skin.is_some() && placed.is_none());
        let key = (&primitive.attributes, primitive.targets.as_slice());
        let (first, count) = match shared.get(&key) {
            Some(vertices) => *vertices,
            None => {
                let vertices = self.vertices(node, primitive, position, placed)?;
                shared.insert(key, vertices);
                vertices
            }
        };
        let transform =
            placed.map_or_else(|| self.skeleton.rigid(node.index).0 * node.copy, |place| place.placed);
        self.triangles(primitive, mode, (first, count), transform.matrix3.determinant() < 0.0, node)
    }

    /// Appends the vertices of a primitive. Returns the index of the first, and their number.
    fn vertices(
        &mut self,
        node: &NodeOf<'_>,
        primitive: &Primitive,
        position: usize,
        skin: Option<&SkinPlace>,
    ) -> Result<(usize, usize), Problem> {
        let (document, buffers) = (self.document, self.buffers);
        let first = self.mesh.positions.len();
        self.check(first.saturating_add(accessor(document, position, "positions")?.count))?;
        let mut positions = vectors(document, position, buffers, "positions")?;
        let count = positions.len();
        let whole = |given: usize, what: &str| {
            let text = format!("it has {count} positions but {given} {what}; export it again");
            if given == count { Ok(()) } else { Err(node.wrong(&text)) }
        };
        let mut normals = match primitive.attributes.normal {
            Some(normals) => vectors(document, normals, buffers, "normals")?,
            None => vec![Vec3::ZERO; count],
        };
        whole(normals.len(), "normals")?;
        self.morph(node, primitive, &mut positions, &mut normals)?;
        if let Some(v) = positions.iter().position(|p| !p.is_finite()) {
            return Err(node.wrong(&format!(
                "the position of vertex {v} is not finite; repair the mesh in the modeling program"
            )));
        }
        // Transform into the rest pose: by the skin's bind space, or by the node that holds the mesh.
        let (placed, own_joint) = match skin {
            Some(skin) => (skin.placed, 0),
            None => {
                let (placed, joint) = self.skeleton.rigid(node.index);
                (placed * node.copy, joint)
            }
        };
        let turned = placed.matrix3.inverse().transpose();
        normals.iter_mut().for_each(|n| *n = (turned * *n).normalize_or_zero());
        positions.iter_mut().for_each(|p| *p = placed.transform_point3(*p));
        let corrections = match skin {
            Some(skin) => self.weigh(node, primitive, skin, &mut positions, &mut normals)?,
            None => {
                self.joints.resize(first + count, [own_joint, 0, 0, 0]);
                self.weights.resize(first + count, [1.0, 0.0, 0.0, 0.0]);
                Vec::new()
            }
        };
        if self.animated.contains(&node.index) {
            let rest = |v: usize, by: Vec3| {
                let by = placed.matrix3 * by;
                corrections.get(v).map_or(by, |correction| *correction * by)
            };
            morph::add_targets(
                &mut self.targets,
                (document, buffers),
                (primitive, &node.place(), node.weights()),
                (first, count),
                rest,
            )?;
        }
        self.mesh.positions.append(&mut positions);
        self.mesh.normals.append(&mut normals);
        if let Some(uvs) = primitive.attributes.uv {
            let uvs = components::<2>(document, uvs, buffers, "texture coordinates")?;
            whole(uvs.len(), "texture coordinates")?;
            self.mesh.uvs.resize(first, Vec2::ZERO);
            // v is downward from the upper edge in glTF.
            self.mesh.uvs.extend(uvs.into_iter().map(|[u, v]| Vec2::new(u as f32, 1.0 - v as f32)));
        } else if !self.mesh.uvs.is_empty() {
            self.mesh.uvs.resize(first + count, Vec2::ZERO);
        }
        // Colors are not needed to draw or to simulate: those that cannot be read are left out.
        let read = primitive.attributes.color.map(|color| colors(document, color, buffers).ok());
        let right = read.as_ref().and_then(Option::as_ref).filter(|colors| colors.len() == count);
        self.left_out.colors += usize::from(read.is_some() && right.is_none());
        if let Some(colors) = right {
            self.mesh.colors.resize(first, Vec3::ZERO);
            self.mesh.colors.extend(colors);
        } else if !self.mesh.colors.is_empty() {
            self.mesh.colors.resize(first + count, Vec3::ZERO);
        }
        Ok((first, count))
    }

    /// Checks a number of vertices or triangles.
    fn check(&self, count: usize) -> Result<(), Problem> {
        if count > self.most {
            let text = format!(
                "more than {} vertices or triangles for a file of {} bytes; export fewer copies, or reduce the meshes",
                self.most,
                self.buffers.size()
            );
            return Err(Problem::limit(Place::Whole, text));
        }
        Ok(())
    }

    /// Adds the morph targets of a primitive with their default weights: those of the node, or of the mesh.
    fn morph(
        &self,
        node: &NodeOf<'_>,
        primitive: &Primitive,
        positions: &mut [Vec3],
        normals: &mut [Vec3],
    ) -> Result<(), Problem> {
        let weights = node.weights();
        for (target, weight) in primitive.targets.iter().zip(weights).filter(|(_, w)| **w != 0.0) {
            for (accessor, values, what) in [
                (target.position, &mut *positions, "positions of a morph target"),
                (target.normal, &mut *normals, "normals of a morph target"),
            ] {
                let Some(accessor) = accessor else { continue };
                let added = vectors(self.document, accessor, self.buffers, what)?;
                if added.len() != values.len() {
                    let text = format!(
                        "it has {} vertices but {} {what}; export it again",
                        values.len(),
                        added.len()
                    );
                    return Err(node.wrong(&text));
                }
                values.iter_mut().zip(added).for_each(|(value, added)| *value += added * *weight);
            }
            if target.position.is_some() && target.normal.is_none() {
                // Zero normals are computed from the shape later.
                normals.fill(Vec3::ZERO);
            }
        }
        Ok(())
    }

    /// Joints and weights of a skinned primitive's vertices: the four largest weights of all its sets. Moves the
    /// vertices to the rest pose if it is not the bind pose of their skin, and returns the linear part of that for each
    /// vertex.
    fn weigh(
        &mut self,
        node: &NodeOf<'_>,
        primitive: &Primitive,
        skin: &SkinPlace,
        positions: &mut [Vec3],
        normals: &mut [Vec3],
    ) -> Result<Vec<Mat3A>, Problem> {
        let (document, buffers, count) = (self.document, self.buffers, positions.len());
        let (mut sets, mut linear) = (Vec::new(), Vec::new());
        for (joints, weights) in primitive.attributes.weight_sets() {
            sets.push((
                components::<4>(document, joints, buffers, "joints")?,
                components::<4>(document, weights, buffers, "weights")?,
            ));
        }
        if sets.iter().any(|(j, w)| j.len() != count || w.len() != count) {
            let text = "it has a skin and needs joints and weights for each of its vertices; export it again";
            return Err(node.wrong(text));
        }
        let slots = u16::try_from(skin.joints.len()).unwrap_or(u16::MAX);
        let joint_of = |slot: u16| skin.joints.get(usize::from(slot)).copied().unwrap_or(0);
        for v in 0..count {
            let mut pairs = Vec::with_capacity(4 * sets.len());
            let wrong = |w: &f64| !(w.is_finite() && *w >= 0.0);
            self.left_out.wrong_weights += usize::from(sets.iter().any(|(_, all)| all[v].iter().any(wrong)));
            for (joints, weights) in &sets {
                for (j, w) in joints[v].iter().zip(weights[v]) {
                    let w = if wrong(&w) { 0.0 } else { w };
                    // Programs leave any number in the slots that they do not use.
                    let (slot, used) = (*j as u16, w > 0.0);
                    if used && *j >= f64::from(slots) {
                        return Err(node.wrong(&format!(
                            "vertex {v} names joint {j} of a skin of {slots}; export it together with all joints"
                        )));
                    }
                    pairs.push((if slot < slots { slot } else { 0 }, w as f32));
                }
            }
            let used = pairs.iter().filter(|(_, w)| *w > 0.0).count();
            self.left_out.unweighted += usize::from(used == 0);
            self.left_out.crowded += usize::from(used > 4);
            let sum: f32 = pairs.iter().map(|(_, w)| w).sum();
            self.left_out.unnormalized += usize::from(used > 0 && (sum - 1.0).abs() > WEIGHT_ROUNDING);
            let (slots, weights) = four_heaviest(pairs);
            if !skin.corrections.is_empty() {
                let correction =
                    |k: usize| skin.corrections.get(usize::from(slots[k])).map(|c| (*c, weights[k]));
                let (p, n) = (positions[v], normals[v]);
                let sum = |f: &dyn Fn(Affine3A) -> Vec3| -> Vec3 {
                    (0..4).filter_map(correction).map(|(c, w)| f(c) * w).sum()
                };
                positions[v] = sum(&|c| c.transform_point3(p));
                normals[v] = sum(&|c| c.matrix3.inverse().transpose() * n).normalize_or_zero();
                let parts = (0..4).filter_map(correction).map(|(c, w)| c.matrix3 * w);
                linear.push(parts.fold(Mat3A::ZERO, |sum, part| sum + part));
            }
            self.joints.push(slots.map(joint_of));
            self.weights.push(weights);
        }
        Ok(linear)
    }

    /// Appends the triangles of a primitive, which end a part of the mesh. `vertices` are the index of the first
    /// vertex, and their number.
    fn triangles(
        &mut self,
        primitive: &Primitive,
        mode: u32,
        vertices: (usize, usize),
        mirrored: bool,
        node: &NodeOf<'_>,
    ) -> Result<(), Problem> {
        let (first, count) = vertices;
        let first_triangle = self.mesh.triangles.len();
        let corners = match primitive.indices {
            Some(indices) => accessor(self.document, indices, "indices")?.count,
            None => count,
        };
        let of_corners = if mode == 4 { corners / 3 } else { corners.saturating_sub(2) };
        self.check(first_triangle.saturating_add(of_corners))?;
        let indices: Vec<u32> = match primitive.indices {
            Some(indices) => {
                let indices = components::<1>(self.document, indices, self.buffers, "indices")?;
                indices.into_iter().map(|[i]| i as u32).collect()
            }
            None => (0..count as u32).collect(),
        };
        if let Some(i) = indices.iter().find(|i| **i as usize >= count) {
            return Err(node.wrong(&format!("a triangle names vertex {i} of {count}; export it again")));
        }
        let mut triangles: Vec<[u32; 3]> = with_room(of_corners)?;
        // Strips and fans: glTF 2.0 §3.7.2.1. A triangle of a strip with two equal corners joins two strips.
        let is_area = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        match mode {
            4 => {
                self.left_out.incomplete += usize::from(!indices.len().is_multiple_of(3));
                triangles.extend(indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]));
            }
            5 => {
                let strip = indices.windows(3).enumerate();
                let strip =
                    strip.map(|(i, t)| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] });
                triangles.extend(strip.filter(is_area));
            }
            _ => {
                let fan = indices.get(1..).unwrap_or_default().windows(2).map(|t| [indices[0], t[0], t[1]]);
                triangles.extend(fan.filter(is_area));
            }
        }
        self.mesh.triangles.extend(triangles.into_iter().map(|t| {
            let [a, b, c] = t.map(|i| i + first as u32);
            if mirrored { [a, c, b] } else { [a, b, c] }
        }));
        self.part(node, primitive, first_triangle)
    }

    /// Ends the part that began at `first_triangle`.
    fn part(
        &mut self,
        node: &NodeOf<'_>,
        primitive: &Primitive,
        first_triangle: usize,
    ) -> Result<(), Problem> {
        let default = json::Material::default();
        let material = match primitive.material {
            Some(index) => self.document.materials.get(index).ok_or_else(|| {
                node.wrong(&format!("it names material {index}, which the file does not have"))
            })?,
            None => &default,
        };
        let surface = &material.pbr_metallic_roughness;
        let [r, g, b, _] = surface.base_color_factor;
        let mesh_name = name(node.mesh, node.mesh_index);
        let part_name = match given(&material.name) {
            Some(material) => format!("{mesh_name}.{}", text::name(material)),
            None => mesh_name,
        };
        let color = if primitive.material.is_some() { Vec3::new(r, g, b) } else { DEFAULT_COLOR };
        self.mesh.parts.push(Part {
            name: part_name,
            triangles: first_triangle as u32..self.mesh.triangles.len() as u32,
            color,
            roughness: surface.roughness_factor,
        });
        Ok(())
    }
}

/// Reads an accessor of vectors.
pub(super) fn vectors(
    document: &Document,
    index: usize,
    buffers: &Buffers<'_>,
    what: &str,
) -> Result<Vec<Vec3>, Problem> {
    let read = components::<3>(document, index, buffers, what)?;
    Ok(read.into_iter().map(|p| p.map(|x| x as f32).into()).collect())
}
