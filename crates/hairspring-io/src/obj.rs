//! Reader for Wavefront `.obj` meshes (Alias|Wavefront, "Object Files", 1995): vertices, polygons, groups.
//!
//! Vertices keep the file's order and are not split at texture seams, so that a closed mesh stays closed and
//! per-vertex weights fit. Each vertex takes the first texture coordinate that a face gives it. Normals are
//! computed. Materials are not read: a scene file sets the color.

use crate::{
    Place, Problem,
    text::{as_text, finite, shortened},
};
use glam::{Vec2, Vec3};
use hairspring::body::{Mesh, Part};

/// Color of a surface whose file does not specify one: a neutral light gray, linear RGB.
pub(crate) const DEFAULT_COLOR: Vec3 = Vec3::splat(0.5);
/// Roughness of a surface whose file does not specify one: skin and cloth are rather matte.
pub(crate) const DEFAULT_ROUGHNESS: f32 = 0.6;

/// Reads an `.obj` file, in its own units.
///
/// # Errors
/// Returns an error for an invalid number, or for a face that refers to a missing vertex.
pub fn parse(data: &[u8]) -> Result<Mesh, Problem> {
    let text = as_text(data);
    let mut mesh = Mesh::default();
    let mut uvs: Vec<Vec2> = Vec::new();
    let mut vertex_uv: Vec<u32> = Vec::new();
    let mut parts = Parts::default();
    let mut face: Vec<u32> = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line_number = i + 1;
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => mesh.positions.push(Vec3::from(numbers(&mut words, line_number, "a vertex")?)),
            Some("vt") => uvs.push(Vec2::from(numbers(&mut words, line_number, "a texture coordinate")?)),
            Some("f") => {
                face.clear();
                vertex_uv.resize(mesh.positions.len(), u32::MAX);
                for corner in words {
                    let mut fields = corner.split('/');
                    let v = index(fields.next().unwrap_or(""), mesh.positions.len(), line_number, "vertex")?;
                    if let Some(uv) = fields.next().filter(|f| !f.is_empty()) {
                        let uv = index(uv, uvs.len(), line_number, "texture coordinate")?;
                        let slot = &mut vertex_uv[v as usize];
                        *slot = if *slot == u32::MAX { uv } else { *slot };
                    }
                    face.push(v);
                }
                // A polygon becomes a fan of triangles around its first corner.
                for w in face.get(1..).unwrap_or_default().windows(2) {
                    mesh.triangles.push([face[0], w[0], w[1]]);
                }
            }
            Some("g" | "o") => {
                let name = words.collect::<Vec<_>>().join(" ");
                parts.begin(name, mesh.triangles.len());
            }
            _ => {}
        }
    }
    if u32::try_from(mesh.positions.len()).is_err() || u32::try_from(mesh.triangles.len()).is_err() {
        return Err(Problem::limit(Place::Whole, "more than 4 billion vertices or triangles"));
    }
    if vertex_uv.iter().any(|uv| *uv != u32::MAX) {
        vertex_uv.resize(mesh.positions.len(), u32::MAX);
        mesh.uvs = vertex_uv.iter().map(|uv| uvs.get(*uv as usize).copied().unwrap_or_default()).collect();
    }
    mesh.parts = parts.finish(mesh.triangles.len());
    mesh.compute_normals();
    Ok(mesh)
}

/// Reads the next `N` words as numbers.
fn numbers<'a, const N: usize>(
    words: &mut impl Iterator<Item = &'a str>,
    line: usize,
    what: &str,
) -> Result<[f32; N], Problem> {
    let mut out = [0.0; N];
    for x in &mut out {
        let word = words.next().unwrap_or("");
        *x = finite(word).ok_or_else(|| {
            Problem::line(line, format!("expected {what} of {N} numbers, found `{}`", shortened(word)))
        })?;
    }
    Ok(out)
}

/// Converts an `.obj` reference to an index from 0. A reference counts from 1, or from the end if it is
/// negative.
fn index(word: &str, count: usize, line: usize, what: &str) -> Result<u32, Problem> {
    let n: i64 = word.parse().map_err(|_| {
        Problem::line(line, format!("expected a face of vertex numbers, found `{}`", shortened(word)))
    })?;
    let i = if n < 0 { count as i64 + n } else { n - 1 };
    if (0..count as i64).contains(&i) {
        Ok(i as u32)
    } else {
        Err(Problem::line(line, format!("the face names {what} {n}, but only {count} are defined so far")))
    }
}

/// Collects runs of triangles under their names.
#[derive(Default)]
struct Parts {
    parts: Vec<Part>,
    name: String,
    start: usize,
}

impl Parts {
    fn begin(&mut self, name: String, triangles: usize) {
        self.close(triangles);
        self.name = name;
    }

    fn close(&mut self, triangles: usize) {
        if triangles > self.start {
            self.parts.push(Part {
                name: self.name.clone(),
                triangles: self.start as u32..triangles as u32,
                color: DEFAULT_COLOR,
                roughness: DEFAULT_ROUGHNESS,
            });
            self.start = triangles;
        }
    }

    /// Returns all parts; none if the file names none.
    fn finish(mut self, triangles: usize) -> Vec<Part> {
        self.close(triangles);
        if self.parts.iter().all(|p| p.name.is_empty()) { Vec::new() } else { self.parts }
    }
}
