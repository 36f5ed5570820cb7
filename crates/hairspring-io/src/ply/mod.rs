//! Strands from PLY files (Turk, "The PLY Polygon File Format", 1994): ascii, and binary of both byte orders.
//!
//! The element `vertex` has the points: `x`, `y`, `z` of any type, and optionally `radius` or `width`, and `red`,
//! `green` and `blue` (sRGB if they are whole numbers of 8 or 16 bits, otherwise linear, 0 to 1). The file names its
//! strands in one of three ways, of which the first counts:
//!
//! - an element `strand` or `polyline` with a list `vertex_indices`, root first;
//! - a property `strand`, `strand_id` or `hair_id` of the vertices, which is the same for the points of a
//!   strand, root first;
//! - an element `edge` with `vertex1` and `vertex2`. Edges are joined to polylines. Of the two ends of a polyline, the
//!   vertex that comes first is the root.

mod file;
mod rows;

use crate::{
    Place, Problem,
    chains::{self, Chains},
    strands::Read,
    text,
    units::FileUnits,
};
use file::Payload;
use hairspring::groom::Groom;
use ply_rs_bw::ply::{ElementDef, Header, PropertyType};
use rows::{Edge, Skipped, Strand, Vertex};
use std::collections::HashMap;

/// Properties of a vertex that name its strand.
const STRANDS: [&str; 3] = ["strand", "strand_id", "hair_id"];
/// Lists of the vertices of a strand.
const LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Reads the strands of a PLY file, in its own units.
///
/// # Errors
/// Returns an error for a header or a row that violates the format, for a file without vertices or strands, and for
/// edges that branch or form a loop.
///
/// ```
/// let file = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
///             element edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n\
///             0 0 0\n0 0.2 0\n0 0.1 0\n0 2\n2 1\n";
/// let groom = hairspring_io::ply::parse(file.as_bytes())?;
/// assert_eq!(groom.strand(0).iter().map(|p| p.y).collect::<Vec<_>>(), [0.0, 0.1, 0.2]);
/// # Ok::<(), hairspring_io::Problem>(())
/// ```
pub fn parse(data: &[u8]) -> Result<Groom, Problem> {
    read(data).map(Read::in_file_units)
}

/// How a file names its strands.
#[derive(Clone, Copy, PartialEq)]
enum Source {
    Lists,
    Ids,
    Edges,
}

/// Strands as indices of vertices.
#[derive(Default)]
struct Indices {
    /// Vertices, strand after strand.
    order: Vec<u32>,
    /// Index in `order` of each strand's first vertex, and the length of `order` at the end.
    offsets: Vec<u32>,
    /// Vertices without a strand.
    unused: usize,
}

pub(crate) fn read(data: &[u8]) -> Result<Read, Problem> {
    let opened = file::open(data)?;
    let header = &opened.header;
    let source = source(header)?;
    let data = &file::readable_rows(&opened, data);
    let mut payload = Payload::new(&opened, data);
    let (mut vertices, mut edges, mut strands) = (Vec::new(), Vec::new(), Vec::new());
    for element in header.elements.values() {
        match element.name.as_str() {
            "vertex" => vertices = payload.rows::<Vertex>(element)?,
            "edge" if source == Source::Edges => edges = payload.rows::<Edge>(element)?,
            _ if source == Source::Lists && has_list(element) => {
                strands.append(&mut payload.rows::<Strand>(element)?);
            }
            _ => drop(payload.rows::<Skipped>(element)?),
        }
    }
    payload.finish()?;
    if u32::try_from(vertices.len()).is_err() {
        return Err(Problem::limit(Place::Whole, "more than 4 billion vertices; split the file"));
    }
    let indices = match source {
        Source::Lists => of_lists(&strands, vertices.len())?,
        Source::Ids => of_ids(&vertices),
        Source::Edges => {
            let edges: Vec<[u32; 2]> = edges.iter().map(|edge| edge.0).collect();
            if let Some(vertex) = edges.iter().flatten().find(|v| **v as usize >= vertices.len()) {
                let text =
                    format!("an edge names vertex {vertex}, but the file has {} vertices", vertices.len());
                return Err(Problem::whole(text));
            }
            let Chains { order, offsets } = chains::join(&edges)?;
            let unused = vertices.len() - order.len();
            Indices { order, offsets, unused }
        }
    };
    Ok(strands_of(header, &vertices, indices, source))
}

/// Returns how the file names its strands.
fn source(header: &Header) -> Result<Source, Problem> {
    let vertex = header.elements.get("vertex");
    let has = |name: &str| vertex.is_some_and(|vertex| is_number(vertex, name));
    if !["x", "y", "z"].iter().all(|name| has(name)) {
        let text = "the header declares no element `vertex` with the properties x, y and z; export the points of the strands";
        return Err(Problem::whole(text));
    }
    let edge = header.elements.get("edge");
    if header.elements.values().any(has_list) {
        Ok(Source::Lists)
    } else if STRANDS.iter().any(|name| has(name)) {
        Ok(Source::Ids)
    } else if edge.is_some_and(|edge| is_number(edge, "vertex1") && is_number(edge, "vertex2")) {
        Ok(Source::Edges)
    } else {
        let has = match faces(header) {
            0 => "points".into(),
            faces => format!("{faces} faces"),
        };
        Err(Problem::whole(format!(
            "the file has {has} but no strands: expected an element `edge` (vertex1, vertex2), an element `strand` with a list `vertex_indices`, or a property `strand` of the vertices; export curves, not a mesh"
        )))
    }
}

/// Whether an element has a property that is a number.
fn is_number(element: &ElementDef, name: &str) -> bool {
    element.properties.get(name).is_some_and(|p| matches!(p.data_type, PropertyType::Scalar(_)))
}

/// Whether an element lists the vertices of strands.
fn has_list(element: &ElementDef) -> bool {
    let is_list = |name: &str| {
        element.properties.get(name).is_some_and(|p| matches!(p.data_type, PropertyType::List(..)))
    };
    ["strand", "polyline"].contains(&element.name.as_str()) && LISTS.iter().any(|name| is_list(name))
}

/// Number of faces.
fn faces(header: &Header) -> usize {
    header.elements.get("face").map_or(0, |face| face.count)
}

/// Returns the strands of lists of vertices.
fn of_lists(strands: &[Strand], vertices: usize) -> Result<Indices, Problem> {
    let mut indices = Indices { offsets: vec![0], ..Indices::default() };
    let mut used = vec![false; vertices];
    for (k, strand) in strands.iter().enumerate() {
        for vertex in &strand.0 {
            let Some(used) = used.get_mut(*vertex as usize) else {
                let text = format!("strand {k} names vertex {vertex}, but the file has {vertices} vertices");
                return Err(Problem::whole(text));
            };
            *used = true;
            indices.order.push(*vertex);
        }
        if !strand.0.is_empty() {
            let end = u32::try_from(indices.order.len());
            indices.offsets.push(
                end.map_err(|_| Problem::limit(Place::Whole, "more than 4 billion points; split the file"))?,
            );
        }
    }
    indices.unused = used.iter().filter(|used| !**used).count();
    Ok(indices)
}

/// Returns the strands of vertices with the same number, in the order in which they begin.
fn of_ids(vertices: &[Vertex]) -> Indices {
    let mut indices = Indices { offsets: vec![0], ..Indices::default() };
    let mut known = HashMap::new();
    let places: Vec<usize> = vertices
        .iter()
        .map(|vertex| {
            let next = known.len();
            *known.entry(vertex.strand.to_bits()).or_insert(next)
        })
        .collect();
    indices.order = (0..vertices.len() as u32).collect();
    // Stable, so that the vertices of a strand keep their order.
    indices.order.sort_by_key(|vertex| places[*vertex as usize]);
    let place = |k: usize| places[indices.order[k] as usize];
    indices.offsets.extend((1..vertices.len()).filter(|k| place(k - 1) != place(*k)).map(|k| k as u32));
    if !vertices.is_empty() {
        indices.offsets.push(vertices.len() as u32);
    }
    indices
}

/// Builds the groom from the vertices and the indices of each strand. Adds a note for each kind of data that is ignored.
fn strands_of(header: &Header, vertices: &[Vertex], indices: Indices, source: Source) -> Read {
    let has = |name: &str| is_number(&header.elements["vertex"], name);
    let points = || indices.order.iter().map(|v| &vertices[*v as usize]);
    let radii = if has("radius") {
        Some(points().map(|v| v.radius).collect())
    } else {
        has("width").then(|| points().map(|v| 0.5 * v.width).collect())
    };
    let mut groom = Groom { points: points().map(|v| v.position).collect(), ..Groom::default() };
    let has_color = ["red", "green", "blue"].iter().all(|name| has(name));
    let mut notes = Vec::new();
    if has_color {
        groom.colors = points().map(|v| v.color).collect();
    }
    let used = |name: &str| match name {
        "x" | "y" | "z" | "radius" => true,
        "width" => !has("radius"),
        "red" | "green" | "blue" => has_color,
        _ => source == Source::Ids && STRANDS.contains(&name),
    };
    let names = header.elements["vertex"].properties.keys();
    let ignored: Vec<&str> = names.map(String::as_str).filter(|name| !used(name)).collect();
    if !ignored.is_empty() {
        let (shown, more) = (ignored.len().min(12), ignored.len().saturating_sub(12));
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        notes.push(text::name(&format!(
            "the properties {}{more} of the vertices are not used",
            ignored[..shown].join(", ")
        )));
    }
    match faces(header) {
        0 => {}
        faces => notes.push(format!("{faces} faces are left out, because a groom is read from curves")),
    }
    if indices.unused > 0 {
        notes.push(format!(
            "{} vertices belong to no strand and are left out; export curves only",
            indices.unused
        ));
    }
    groom.offsets = indices.offsets;
    Read { groom, radii, true_radii: false, units: FileUnits::default(), notes }
}
