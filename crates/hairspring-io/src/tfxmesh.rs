//! Reader for TressFX `.tfxmesh`: a skinned collision mesh as text (written by the TressFX exporter for
//! Maya). It holds `numOfBones` with the index and name of each; `numOfVertices`, each with position, normal,
//! four joints and four weights; `numOfTriangles`.
//!
//! The file has no skeleton: joints are known by name only and are at the origin in the rest pose.

use crate::{
    Problem,
    obj::{DEFAULT_COLOR, DEFAULT_ROUGHNESS},
    skin::normalised,
    text::{Words, as_text, lines, without_comment},
};
use glam::{Affine3A, Vec3};
use hairspring::body::{Body, Joint, Mesh, Part, Skin, Trs};

/// Reads a `.tfxmesh` file, in its own units.
///
/// # Errors
/// Returns an error for missing sections, indices out of order or out of range, or a truncated file.
pub fn parse(data: &[u8]) -> Result<Body, Problem> {
    // Comments run to the end of their line. Replacing them by blanks keeps the line numbers.
    let text: String = lines(&as_text(data)).map(without_comment).collect::<Vec<_>>().join("\n");
    let mut words = Words::new(&text);
    let bones = count(&mut words, "numOfBones", u16::MAX as usize, text.len() / 2)?;
    let mut joints = Vec::with_capacity(bones);
    for i in 0..bones {
        in_order(&mut words, i, "bone")?;
        let name = words.rest_of_line().join(" ");
        if name.is_empty() {
            return Err(Problem::line(words.line(), format!("bone {i} has no name")));
        }
        joints.push(Joint { name, parent: None, rest: Trs::default() });
    }
    let vertices = count(&mut words, "numOfVertices", u32::MAX as usize, text.len() / 30)?;
    let mut mesh = Mesh::default();
    let mut skin =
        Skin { joints: Vec::new(), weights: Vec::new(), inverse_bind: vec![Affine3A::IDENTITY; bones] };
    for i in 0..vertices {
        in_order(&mut words, i, "vertex")?;
        mesh.positions.push(words.vector("a position")?);
        mesh.normals.push(words.vector("a normal")?.normalize_or(Vec3::Y));
        let mut of = [0u16; 4];
        for j in &mut of {
            *j = words.number("a joint's index")?;
            if *j as usize >= bones.max(1) {
                return Err(Problem::line(
                    words.line(),
                    format!("vertex {i} names joint {j}, but there are {bones}"),
                ));
            }
        }
        let mut weights = [0.0; 4];
        for w in &mut weights {
            *w = words.finite("a weight")?;
        }
        skin.joints.push(of);
        skin.weights.push(normalised(weights));
    }
    let triangles = count(&mut words, "numOfTriangles", u32::MAX as usize, text.len() / 8)?;
    for i in 0..triangles {
        in_order(&mut words, i, "triangle")?;
        let mut corners = [0u32; 3];
        for c in &mut corners {
            *c = words.number("a vertex index")?;
            if *c as usize >= vertices {
                return Err(Problem::line(
                    words.line(),
                    format!("triangle {i} names vertex {c}, but there are {vertices}"),
                ));
            }
        }
        mesh.triangles.push(corners);
    }
    mesh.parts = vec![Part {
        name: "mesh".into(),
        triangles: 0..triangles as u32,
        color: DEFAULT_COLOR,
        roughness: DEFAULT_ROUGHNESS,
    }];
    if joints.is_empty() {
        return Ok(Body::rigid(mesh));
    }
    Ok(Body { mesh, joints, skin: Some(skin) })
}

/// Reads the count after the word `name`. It is at most `limit`, and no more than the rest of the file has
/// room for.
fn count(words: &mut Words<'_>, name: &str, limit: usize, room: usize) -> Result<usize, Problem> {
    words.expect(name)?;
    let n: usize = words.number("a count")?;
    if n > limit || n > room {
        let most = limit.min(room);
        return Err(Problem::line(
            words.line(),
            format!("{name} is {n}, but a file of this size has room for at most {most}"),
        ));
    }
    Ok(n)
}

/// Checks the index at the start of a record, which counts up.
fn in_order(words: &mut Words<'_>, i: usize, what: &str) -> Result<(), Problem> {
    let found: usize = words.number(&format!("{what} {i}"))?;
    if found == i {
        Ok(())
    } else {
        Err(Problem::line(words.line(), format!("expected {what} {i}, found {found}: they must be in order")))
    }
}
