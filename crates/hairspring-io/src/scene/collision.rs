//! Notes about a `[collision]` mesh that hair probably does not collide with as the scene means it to.

use super::{Reader, file::BodyFile};
use crate::units::{bounds_of, extent};
use glam::Vec3;
use hairspring::body::Mesh;
use hairspring_scene::SceneGroom;
use std::collections::HashMap;

/// Distance of the mesh from the nearest root above which it is reported [m].
const FAR: f32 = 0.5;
/// Ratio of the sizes of the mesh and the body, or its inverse, above which it is reported [1].
const UNLIKE: f32 = 20.0;

impl Reader<'_> {
    /// Adds a note for each of these: a mesh far from the roots, a mesh of another size than the body's, and a mesh that is
    /// not closed.
    pub(super) fn note_collision(
        &mut self,
        named: &BodyFile,
        mesh: &Mesh,
        body: Option<&Mesh>,
        grooms: &[SceneGroom],
    ) {
        let misplaced = far_from_roots(mesh, grooms).or_else(|| body.and_then(|body| unlike(mesh, body)));
        let notes = misplaced.into_iter().chain(open(mesh)).collect();
        self.note(&self.resolve(&named.file), notes);
    }
}

/// Describes a mesh that is far from all roots.
fn far_from_roots(mesh: &Mesh, grooms: &[SceneGroom]) -> Option<String> {
    let [low, high] = bounds_of(&mesh.positions)?;
    let strands =
        grooms.iter().flat_map(|groom| (0..groom.groom.strand_count()).map(|s| groom.groom.strand(s)));
    let roots = strands.filter_map(|points| points.first());
    let distances = roots.map(|root| root.distance(root.clamp(low, high)));
    let nearest = distances.min_by(f32::total_cmp).filter(|distance| *distance > FAR)?;
    Some(format!(
        "the [collision] mesh is {nearest:.2} m from the nearest root; set its `scale`, `up` or `transform` if that is wrong"
    ))
}

/// Describes a mesh that is much larger or smaller than the body.
fn unlike(mesh: &Mesh, body: &Mesh) -> Option<String> {
    let [size, whole] = [mesh, body].map(|mesh| extent(mesh.positions.iter().copied()));
    (size > UNLIKE * whole || UNLIKE * size < whole).then(|| {
        format!(
            "the [collision] mesh is {size:.3} m large, and the [body] {whole:.3} m; set its `scale` if that is wrong"
        )
    })
}

/// Describes a mesh that is not closed.
fn open(mesh: &Mesh) -> Option<String> {
    let edges = open_edges(mesh);
    (edges > 0).then(|| {
        format!(
            "the [collision] mesh is not closed ({edges} edges have one triangle only), so hair may sink in there; close it, or \
             use a [[sheet]]"
        )
    })
}

/// Counts the edges of one triangle only. Vertices at one place are the same: files repeat them where normals and texture
/// coordinates differ.
fn open_edges(mesh: &Mesh) -> usize {
    // Adding 0 makes -0 and 0 equal.
    let place = |v: u32| (mesh.positions[v as usize] + Vec3::ZERO).to_array().map(f32::to_bits);
    let mut triangles = HashMap::new();
    for [a, b, c] in mesh.triangles.iter().map(|triangle| triangle.map(place)) {
        for (from, to) in [(a, b), (b, c), (c, a)].into_iter().filter(|(from, to)| from != to) {
            *triangles.entry((from.min(to), from.max(to))).or_insert(0) += 1;
        }
    }
    triangles.values().filter(|count| **count == 1).count()
}
