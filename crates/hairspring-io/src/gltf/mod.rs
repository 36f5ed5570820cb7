//! Reader for glTF 2.0 (Khronos, ISO/IEC 12113): `.glb`, `.vrm`, and `.gltf` with its buffers embedded or in
//! separate files.
//!
//! Every mesh follows its joints: skinned meshes by their weights, others rigidly with the node that holds
//! them. Morph targets are applied with their default weights, and animations move them. Animations are resampled
//! at a fixed rate, with a sample at every key if the keys are at a usual rate. Textures, cameras and lights are not read. Where a groom is read, lines are its strands.

mod accessor;
mod animation;
mod container;
mod curves;
mod instances;
mod json;
mod late;
mod mesh;
mod mesh_notes;
mod morph;
mod nodes;
mod primitive;
mod sampling;
mod scales;
mod skeleton;
mod uri;

use crate::{Problem, strands::Read, text, units::apply_to_body};
use glam::{Affine3A, Quat};
use hairspring::{
    body::{Body, Clip, Skin},
    groom::Groom,
};
use hairspring_scene::VertexCache;
use json::Animation;
pub use morph::Morphs;
use skeleton::Skeleton;

/// A body and the motions from the same file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Character {
    /// Mesh, joints and weights.
    pub body: Body,
    /// Motions of its joints.
    pub clips: Vec<Clip>,
    /// Motion of its vertices, in files without a skeleton.
    pub vertex_cache: Option<VertexCache>,
    /// Morph targets that the motions move.
    pub morphs: Morphs,
}

/// Reads a glTF file, and returns notes about what was left out. The format is in meters, Y up. `sibling` returns
/// the bytes of a file next to it, and is asked for each file once.
///
/// # Errors
/// Returns an error for JSON that violates the format, a required extension that is not supported, compressed
/// meshes, accessors outside their buffers, a node that is its own ancestor, or more vertices or animation samples
/// than a file of its size may have.
pub fn parse(
    data: &[u8],
    sibling: &dyn Fn(&str) -> Option<Vec<u8>>,
) -> Result<(Character, Vec<String>), Problem> {
    let (document, buffers) = container::open(data, sibling)?;
    let mut notes = Vec::new();
    let skeleton = Skeleton::read(&document, &buffers, &mut notes)?;
    let mesh::Moved { mesh, joints, weights, objects } =
        mesh::read(&document, &buffers, &skeleton, &mut notes)?;
    let (clips, morphs) = animation::clips(&document, &buffers, &skeleton, objects, &mut notes)?;
    let skin = Skin { joints, weights, inverse_bind: skeleton.inverse_bind };
    let body = Body { mesh, joints: skeleton.joints, skin: Some(skin) };
    let mut character = Character { body, clips, morphs, vertex_cache: None };
    if document.looks_backward() {
        apply_to_body(&mut character.body, &mut character.clips, 1.0, HALF_TURN);
        character.morphs.convert(1.0, HALF_TURN);
        notes.push(turned_note());
    }
    Ok((character, notes))
}

/// A rotation by 180° about Y.
const HALF_TURN: Quat = Quat::from_xyzw(0.0, 1.0, 0.0, 0.0);

/// The note about a file that looks along -Z.
fn turned_note() -> String {
    "the file is a VRM 0.x avatar, which looks along -Z; it is turned to look along +Z; hair that was made for it as it is needs `transform.rotation = [0, 180, 0]`".into()
}

/// Reads the lines of a glTF file as the strands of a groom, root first. The format is in meters, Y up. `sibling` returns the
/// bytes of a file next to it, and is asked for each file once.
///
/// # Errors
/// Returns an error for a file without lines, lines that branch or have no ends, and see [`parse`].
pub fn parse_groom(data: &[u8], sibling: &dyn Fn(&str) -> Option<Vec<u8>>) -> Result<Groom, Problem> {
    read_groom(data, sibling).map(Read::in_file_units)
}

/// Reads the lines of a glTF file.
pub(crate) fn read_groom(data: &[u8], sibling: &dyn Fn(&str) -> Option<Vec<u8>>) -> Result<Read, Problem> {
    let (document, buffers) = container::open(data, sibling)?;
    curves::read(&document, &buffers)
}

/// Returns whether all primitives of a glTF file are lines, and it has some.
pub(crate) fn holds_only_lines(data: &[u8]) -> bool {
    container::document(data).is_ok_and(|document| curves::are_all(&document))
}

/// Returns the transform, or `None` if it is singular or not finite.
fn invertible(m: Affine3A) -> Option<Affine3A> {
    let determinant = m.matrix3.determinant();
    (m.is_finite() && determinant.is_finite() && determinant.abs() > 1e-20 && m.inverse().is_finite())
        .then_some(m)
}

/// Returns the name of the animation with this index as the program shows it.
fn animation_name((index, animation): (usize, &Animation)) -> String {
    given(&animation.name).map_or_else(|| format!("animation{index}"), text::name)
}

/// Returns a name that is not blank.
fn given(name: &Option<String>) -> Option<&str> {
    name.as_deref().filter(|name| !name.trim().is_empty())
}
