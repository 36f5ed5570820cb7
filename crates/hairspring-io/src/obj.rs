//! Reader for Wavefront `.obj` files (Alias|Wavefront, "Object Files", 1995): vertices, polygons, groups. Polylines
//! are the strands of a groom.
//!
//! Vertices keep the file's order and are not split at texture seams, so that a closed mesh stays closed and
//! per-vertex weights fit. Each vertex takes the first texture coordinate that a face gives it. Normals are
//! computed. Materials are not read: a scene file sets the color.

use crate::{
    Place, Problem, color,
    left_out::{CALLS, LeftOut, UNMAPPED},
    polygon::triangulate,
    polylines::Polylines,
    strands::Read,
    text::{self, Lines, as_text, finite, remedy, shortened, without_comment},
    units::FileUnits,
};
use glam::{Vec2, Vec3};
use hairspring::{
    body::{Mesh, Part},
    groom::Groom,
};
use std::{borrow::Cow, iter::Enumerate};

/// Number of polylines from which on a name for each of them is that of a strand, not of a group.
const NAMED_STRANDS: usize = 64;

/// Color of a surface whose file does not specify one: a neutral light gray, linear RGB.
pub const DEFAULT_COLOR: Vec3 = Vec3::splat(0.5);
/// Roughness of a surface whose file does not specify one: skin and cloth are rather matte.
pub const DEFAULT_ROUGHNESS: f32 = 0.6;

/// Reads the mesh of an `.obj` file, in its own units.
///
/// # Errors
/// Returns an error for an invalid number, for a face that refers to a missing vertex, or for a file without faces.
pub fn parse(data: &[u8]) -> Result<Mesh, Problem> {
    parse_with_notes(data).map(|(mesh, _)| mesh)
}

/// Reads the mesh of an `.obj` file, in its own units, and notes about what was left out.
pub(crate) fn parse_with_notes(data: &[u8]) -> Result<(Mesh, Vec<String>), Problem> {
    let text = as_text(data);
    let mut mesh = Mesh::default();
    let mut uvs: Vec<Vec2> = Vec::new();
    let mut vertex_uv: Vec<u32> = Vec::new();
    let mut parts = Parts::default();
    let mut face: Vec<u32> = Vec::new();
    let mut left_out = LeftOut::default();
    for (line_number, line) in statements(&text) {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                mesh.positions.push(vertex(&mut words, line_number)?);
                if let Some(color) = color(words, line_number)? {
                    left_out.uncolored += mesh.positions.len() - 1 - mesh.colors.len();
                    mesh.colors.resize(mesh.positions.len() - 1, Vec3::ZERO);
                    mesh.colors.push(color);
                }
            }
            Some("vt") => uvs.push(texture_coordinate(&mut words, line_number)?),
            Some("f" | "fo") => {
                face.clear();
                vertex_uv.resize(mesh.positions.len(), u32::MAX);
                for corner in words {
                    let counts = [mesh.positions.len(), uvs.len()];
                    let (v, uv) = corner_of(corner, counts, line_number, &mut left_out.unmapped)?;
                    if let Some(uv) = uv {
                        let slot = &mut vertex_uv[v as usize];
                        *slot = if *slot == u32::MAX { uv } else { *slot };
                    }
                    face.push(v);
                }
                without_repeats(&mut face);
                left_out.faces += usize::from(face.len() < 3);
                if !triangulate(&mesh.positions, &face, &mut mesh.triangles) {
                    left_out.concave += 1;
                }
            }
            Some("l") => left_out.lines += 1,
            Some("p") => left_out.points += words.count(),
            Some("call") => left_out.calls += 1,
            Some("curv" | "curv2" | "surf") => left_out.surfaces += 1,
            Some("g" | "o") => {
                let name = words.collect::<Vec<_>>().join(" ");
                parts.begin(text::name(&name), mesh.triangles.len());
            }
            _ => {}
        }
    }
    if u32::try_from(mesh.positions.len()).is_err() || u32::try_from(mesh.triangles.len()).is_err() {
        return Err(Problem::limit(Place::Whole, "more than 4 billion vertices or triangles"));
    }
    if mesh.triangles.is_empty() {
        if left_out.lines > 0 {
            // Polylines that are wrong are so for a groom, too.
            read_groom(data)?;
        }
        return Err(Problem::whole(left_out.instead_of_faces()));
    }
    if vertex_uv.iter().any(|uv| *uv != u32::MAX) {
        vertex_uv.resize(mesh.positions.len(), u32::MAX);
        mesh.uvs = vertex_uv.iter().map(|uv| uvs.get(*uv as usize).copied().unwrap_or_default()).collect();
    }
    if !mesh.colors.is_empty() {
        left_out.uncolored += mesh.positions.len() - mesh.colors.len();
    }
    let mut notes = left_out.notes();
    notes.extend(text::encoding_note(data));
    if !mesh.colors.is_empty() {
        mesh.colors.resize(mesh.positions.len(), Vec3::ZERO);
        notes.extend(color::into_range(&mut mesh.colors));
    }
    mesh.parts = parts.finish(mesh.triangles.len());
    mesh.compute_normals();
    Ok((mesh, notes))
}

/// Reads the polylines of an `.obj` file as the strands of a groom, in its own units.
///
/// # Errors
/// Returns an error for an invalid number, or for a line that refers to a missing vertex.
pub fn parse_groom(data: &[u8]) -> Result<Groom, Problem> {
    read_groom(data).map(Read::in_file_units)
}

/// Returns whether an `.obj` file has polylines and no face before them.
pub(crate) fn holds_polylines(data: &[u8]) -> bool {
    let text = as_text(data);
    let first = statements(&text).find_map(|(_, line)| match line.split_whitespace().next() {
        Some("f" | "fo") => Some(false),
        Some("l") => Some(true),
        _ => None,
    });
    first == Some(true)
}

/// Reads the polylines of an `.obj` file. The first point of each is its root. Those below a name (`g`, `o`) are a group.
pub(crate) fn read_groom(data: &[u8]) -> Result<Read, Problem> {
    let text = as_text(data);
    let (mut vertices, mut uvs): (Vec<Vec3>, Vec<Vec2>) = (Vec::new(), Vec::new());
    let mut lines = Polylines::default();
    let (mut faces, mut points, mut colored, mut undefined, mut calls) =
        (0usize, 0usize, 0usize, 0usize, 0usize);
    for (line_number, line) in statements(&text) {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                vertices.push(vertex(&mut words, line_number)?);
                colored += usize::from(color(words, line_number)?.is_some());
            }
            Some("vt") => uvs.push(texture_coordinate(&mut words, line_number)?),
            Some("f" | "fo") => faces += 1,
            Some("p") => points += words.count(),
            Some("call") => calls += 1,
            Some("l") => {
                let counts = [vertices.len(), uvs.len()];
                let mut rest = words.map(|word| corner_of(word, counts, line_number, &mut undefined));
                let Some(root) = rest.next().transpose()? else { continue };
                let Some(first) = rest.next() else {
                    points += 1;
                    continue;
                };
                lines.begin(root);
                lines.push(first?);
                for corner in rest {
                    lines.push(corner?);
                    lines.has_polylines = true;
                }
                if u32::try_from(lines.order.len()).is_err() {
                    return Err(Problem::limit(Place::Line(line_number), "more than 4 billion points"));
                }
            }
            Some("g" | "o") => {
                let name = words.collect::<Vec<_>>().join(" ");
                lines.begin_group(text::name(&name));
            }
            _ => {}
        }
    }
    if lines.order.is_empty() {
        return Err(Problem::whole(
            "the file has no polylines (`l`), which are the strands of a groom; export the curves, not a mesh",
        ));
    }
    let mut notes: Vec<String> = text::encoding_note(data).into_iter().collect();
    notes.extend(lines.join());
    let closed = lines.closed();
    let root_uvs: Vec<_> =
        lines.roots().map(|root| lines.uv(root).and_then(|uv| uvs.get(uv as usize))).collect();
    let mapped = root_uvs.iter().flatten().count();
    let mut groom = Groom {
        points: lines.order.iter().map(|v| vertices[*v as usize]).collect(),
        root_uvs: match mapped {
            0 => Vec::new(),
            _ => root_uvs.iter().map(|uv| uv.copied().unwrap_or_default()).collect(),
        },
        offsets: lines.offsets,
        ..Groom::default()
    };
    if groom.strand_count() >= NAMED_STRANDS && lines.groups.count() == groom.strand_count() {
        notes.push("each polyline has its own name, so names are not used as groups".into());
    } else {
        notes.extend(lines.groups.apply(&mut groom));
    }
    let unmapped = if mapped > 0 { groom.strand_count() - mapped } else { 0 };
    for (count, text) in [
        (faces, "faces are left out, because a groom is read from polylines"),
        (points, "points and polylines of one point are left out"),
        (calls, CALLS),
        (closed, "closed polylines are opened at their first point, which is the root"),
        (undefined, UNMAPPED),
        (unmapped, "strands have no texture coordinates and get 0, 0; give each root one"),
        (colored, "vertices have a color, which is not used; write a .ply to keep it"),
    ] {
        if count > 0 {
            notes.push(format!("{count} {text}"));
        }
    }
    Ok(Read { groom, radii: None, true_radii: false, units: FileUnits::default(), notes })
}

/// The statements of a file, with the number of their first line, counted from 1. A line that ends in a backslash
/// goes on in the next one. A comment ends a statement of numbers.
fn statements(text: &str) -> Statements<'_> {
    Statements { lines: text::lines(text).enumerate() }
}

struct Statements<'a> {
    lines: Enumerate<Lines<'a>>,
}

impl<'a> Iterator for Statements<'a> {
    type Item = (usize, Cow<'a, str>);

    fn next(&mut self) -> Option<Self::Item> {
        let (i, first) = self.lines.next()?;
        // The text of comments, names and paths may end in a backslash, or contain a number sign.
        let keyword = first.split_whitespace().next().unwrap_or("");
        if keyword.starts_with('#') || matches!(keyword, "o" | "g" | "usemtl" | "mtllib") {
            return Some((i + 1, Cow::Borrowed(first)));
        }
        let numbers = |line: &'a str| without_comment(line).trim_end();
        let Some(start) = numbers(first).strip_suffix('\\') else {
            return Some((i + 1, Cow::Borrowed(numbers(first))));
        };
        let mut statement = start.to_owned();
        for (_, line) in self.lines.by_ref() {
            statement.push(' ');
            match numbers(line).strip_suffix('\\') {
                Some(line) => statement.push_str(line),
                None => {
                    statement.push_str(numbers(line));
                    break;
                }
            }
        }
        Some((i + 1, Cow::Owned(statement)))
    }
}

/// Reads the position of a vertex.
fn vertex<'a>(words: &mut impl Iterator<Item = &'a str>, line: usize) -> Result<Vec3, Problem> {
    Ok(Vec3::from(numbers(words, line, "a vertex")?))
}

/// Removes corners of a face that follow themselves, around the face. They span no area.
fn without_repeats(face: &mut Vec<u32>) {
    face.dedup();
    while face.len() > 1 && face.first() == face.last() {
        face.pop();
    }
}

/// The color of a vertex, which some programs write after its position: three numbers. Other numbers there, such as a
/// weight, are not used.
fn color<'a>(words: impl Iterator<Item = &'a str>, line: usize) -> Result<Option<Vec3>, Problem> {
    let mut numbers = [0.0; 3];
    let mut count = 0;
    for word in words {
        let number = word.parse().map_err(|_| expected("only numbers after a vertex", word, line))?;
        if let Some(slot) = numbers.get_mut(count) {
            *slot = number;
        }
        count += 1;
    }
    Ok((count == 3).then(|| Vec3::from(numbers)))
}

/// Reads a texture coordinate of one number or more.
fn texture_coordinate<'a>(words: &mut impl Iterator<Item = &'a str>, line: usize) -> Result<Vec2, Problem> {
    let [u] = numbers(words, line, "a texture coordinate")?;
    let mut words = words.peekable();
    let [v] = match words.peek() {
        Some(_) => numbers(&mut words, line, "a texture coordinate")?,
        None => [0.0],
    };
    Ok(Vec2::new(u, v))
}

/// Reads a corner of a face or a point of a line: the vertex and, if it has one, the texture coordinate.
/// `counts` are those of the vertices and texture coordinates so far. A number of a texture coordinate before any is
/// defined is counted in `undefined`.
fn corner_of(
    word: &str,
    counts: [usize; 2],
    line: usize,
    undefined: &mut usize,
) -> Result<(u32, Option<u32>), Problem> {
    let mut fields = word.split('/');
    let v = index(fields.next().unwrap_or(""), counts[0], line, "vertex")?;
    let uv = fields.next().filter(|f| !f.is_empty());
    if counts[1] == 0 && uv.is_some_and(|uv| uv.parse::<i64>().is_ok()) {
        *undefined += 1;
        return Ok((v, None));
    }
    let uv = uv.map(|uv| index(uv, counts[1], line, "texture coordinate")).transpose()?;
    Ok((v, uv))
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
        *x = finite(word).ok_or_else(|| expected(&format!("{what} of {}", plural(N)), word, line))?;
    }
    Ok(out)
}

/// Says that `what` was expected, and what was found.
fn expected(what: &str, word: &str, line: usize) -> Problem {
    let found = match word {
        "" => "but the line ends".into(),
        _ => format!("found `{}`{}", shortened(word), remedy(word)),
    };
    Problem::line(line, format!("expected {what}, {found}"))
}

/// `1 number`, `3 numbers`.
fn plural(count: usize) -> String {
    format!("{count} number{}", if count == 1 { "" } else { "s" })
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
        Err(Problem::line(
            line,
            format!("the face or line names {what} {n}, but only {count} are defined so far"),
        ))
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
