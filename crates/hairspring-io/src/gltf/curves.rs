//! Strands from the lines of a glTF file (glTF 2.0 §3.7.2.1): primitives of the modes LINES, LINE_STRIP and LINE_LOOP.

use super::{
    HALF_TURN,
    accessor::{Buffers, accessor, colors, components},
    animation_name, given, instances,
    json::{Document, Node, Primitive},
    nodes::{Walk, local, walk},
    primitive::place,
    turned_note,
};
use crate::{
    Place, Problem,
    chains::{self, Chains},
    clip_choice::unplayed_note,
    strands::Read,
    text,
    units::FileUnits,
};
use glam::{Affine3A, Vec2, Vec3};
use hairspring::groom::Groom;
use std::{collections::HashMap, rc::Rc};

/// Points that a file of any size may have. Every byte of the file adds one.
const POINTS: usize = 1_000_000;

const LINES: u32 = 1;
const LINE_LOOP: u32 = 2;
const LINE_STRIP: u32 = 3;

/// Whether all primitives of the file are lines, and it has some.
pub(super) fn are_all(document: &Document) -> bool {
    let mut primitives = document.meshes.iter().flat_map(|mesh| &mesh.primitives).peekable();
    primitives.peek().is_some() && primitives.all(is_lines)
}

/// Whether the primitive is drawn as lines. By default, it is drawn as triangles (mode 4).
fn is_lines(primitive: &Primitive) -> bool {
    (LINES..=LINE_STRIP).contains(&primitive.mode.unwrap_or(4))
}

/// Reads the lines of all nodes of the scene.
pub(super) fn read(document: &Document, buffers: &Buffers<'_>) -> Result<Read, Problem> {
    let mut notes = Vec::new();
    let Walk { order, parents, drawn, hidden, .. } = walk(document, &mut notes)?;
    let mut build = Build {
        document,
        buffers,
        most: buffers.size().saturating_add(POINTS),
        groom: Groom { offsets: vec![0], ..Groom::default() },
        radii: Vec::new(),
        groups: HashMap::new(),
        vectors: HashMap::new(),
        numbers: HashMap::new(),
        uvs: HashMap::new(),
        found: Found { hidden, ..Found::default() },
    };
    let mut world = vec![Affine3A::IDENTITY; document.nodes.len()];
    for n in order {
        let node = &document.nodes[n];
        let parent = parents[n].map_or(Affine3A::IDENTITY, |p| world[p]);
        world[n] = parent * local(node, n)?.to_affine();
        if drawn[n] {
            build.node(node, n, world[n])?;
        }
    }
    if document.looks_backward() {
        build.groom.points.iter_mut().for_each(|p| *p = HALF_TURN * *p);
        notes.push(turned_note());
    }
    let motions: Vec<String> = document.animations.iter().enumerate().map(animation_name).collect();
    let motions: Vec<&str> = motions.iter().map(String::as_str).collect();
    notes.extend(unplayed_note(&motions, " on the strands; they follow the [body]"));
    build.finish(notes)
}

/// Counts of what the nodes hold.
#[derive(Default)]
struct Found {
    /// Primitives of lines, those with a color, and those with a radius.
    lines: usize,
    colored: usize,
    thick: usize,
    /// Strands whose root has texture coordinates.
    mapped: usize,
    /// Primitives of triangles or points.
    others: usize,
    /// Primitives of lines without positions.
    positionless: usize,
    /// Closed lines.
    loops: usize,
    /// Lines that a skin or morph targets would move.
    deformed: usize,
    /// Nodes that draw copies of a mesh with a skin.
    copies: usize,
    /// Nodes with meshes that are hidden.
    hidden: usize,
    /// Primitives of segments with an odd number of ends.
    incomplete: usize,
}

/// The groom under construction.
struct Build<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    /// Maximum number of points.
    most: usize,
    groom: Groom,
    radii: Vec<f32>,
    /// Index of each group by its name.
    groups: HashMap<String, usize>,
    /// Arrays that were read, by their accessor: each line of a groom may be a primitive that shares them.
    vectors: HashMap<usize, Rc<Vec<Vec3>>>,
    numbers: HashMap<usize, Rc<Vec<f32>>>,
    uvs: HashMap<usize, Rc<Vec<Vec2>>>,
    found: Found,
}

impl Build<'_> {
    /// Appends the lines of a node, which are a group with its name or that of its mesh.
    fn node(&mut self, node: &Node, index: usize, world: Affine3A) -> Result<(), Problem> {
        let Some(mesh_index) = node.mesh else { return Ok(()) };
        let missing =
            || Problem::whole(format!("node {index} names mesh {mesh_index}, which the file does not have"));
        let mesh = self.document.meshes.get(mesh_index).ok_or_else(missing)?;
        // A skin replaces the transform of the node (§3.7.3.3), and of its copies.
        self.found.copies += usize::from(node.skin.is_some() && node.instances().is_some());
        let copies = match node.skin {
            Some(_) => vec![Affine3A::IDENTITY],
            None => instances::read(self.document, self.buffers, node, index)?
                .into_iter()
                .map(|copy| world * copy)
                .collect(),
        };
        let before = self.groom.strand_count();
        for primitive in &mesh.primitives {
            if !is_lines(primitive) {
                self.found.others += 1;
                continue;
            }
            self.found.deformed += usize::from(node.skin.is_some() || !primitive.targets.is_empty());
        }
        for world in copies {
            for (k, primitive) in mesh.primitives.iter().enumerate().filter(|(_, p)| is_lines(p)) {
                self.lines(primitive, world, &place(mesh, mesh_index, k))?;
            }
        }
        let strands = self.groom.strand_count();
        if strands > before {
            let name = given(&node.name).or(given(&mesh.name));
            let name = name.map_or_else(|| format!("node{index}"), text::name);
            let next = self.groups.len();
            let group = *self.groups.entry(name).or_insert_with_key(|name| {
                self.groom.group_names.push(name.clone());
                next
            });
            // More groups than there are numbers for are dropped at the end.
            self.groom.groups.resize(strands, u16::try_from(group).unwrap_or(u16::MAX));
        }
        Ok(())
    }

    /// Appends the lines of a primitive. `place` names it in error messages.
    fn lines(&mut self, primitive: &Primitive, world: Affine3A, place: &str) -> Result<(), Problem> {
        // Copies of a mesh visit a primitive any number of times.
        self.buffers.spend(1)?;
        let attributes = &primitive.attributes;
        let Some(position) = attributes.position else {
            self.found.positionless += 1;
            return Ok(());
        };
        self.found.lines += 1;
        let corners = match primitive.indices {
            Some(indices) => accessor(self.document, indices, "indices")?.count,
            None => accessor(self.document, position, "positions")?.count,
        };
        if self.groom.points.len().saturating_add(corners) > self.most {
            let text = format!(
                "more than {} points for a file of {} bytes; export fewer copies",
                self.most,
                self.buffers.size()
            );
            return Err(Problem::limit(Place::Whole, text));
        }
        let positions = self.vectors(position, "positions")?;
        let colors = attributes.color.map(|color| self.vectors(color, "colors")).transpose()?;
        let radii = match (attributes.radius, attributes.width) {
            (Some(radius), _) => Some((self.numbers(radius, "radii")?, 1.0)),
            (None, Some(width)) => Some((self.numbers(width, "widths")?, 0.5)),
            (None, None) => None,
        };
        let uvs = attributes.uv.map(|uv| self.uvs(uv)).transpose()?;
        for (given, what) in [
            (colors.as_ref().map(|c| c.len()), "colors"),
            (radii.as_ref().map(|r| r.0.len()), "radii"),
            (uvs.as_ref().map(|uvs| uvs.len()), "texture coordinates"),
        ] {
            if let Some(given) = given.filter(|given| *given != positions.len()) {
                return Err(Problem::whole(format!(
                    "{place}: its lines have {} positions but {given} {what}; export it again",
                    positions.len()
                )));
            }
        }
        self.found.colored += usize::from(colors.is_some());
        self.found.thick += usize::from(radii.is_some());
        let Chains { order, offsets } = self.chains(primitive, &positions, place)?;
        let size = world.matrix3.determinant().abs().cbrt();
        for first in offsets.iter().take(offsets.len() - 1) {
            let uv = uvs.as_ref().map(|uvs| uvs[order[*first as usize] as usize]);
            self.found.mapped += usize::from(uv.is_some());
            self.groom.root_uvs.push(uv.unwrap_or_default());
        }
        for v in order.into_iter().map(|v| v as usize) {
            self.groom.points.push(world.transform_point3(positions[v]));
            let color = colors.as_ref().map_or(Vec3::ONE, |colors| colors[v]);
            self.groom.colors.push(color);
            self.radii.push(radii.as_ref().map_or(0.0, |(radii, factor)| radii[v] * factor * size));
        }
        let first = self.groom.offsets.last().copied().unwrap_or(0);
        self.groom.offsets.extend(offsets.into_iter().skip(1).map(|end| first + end));
        Ok(())
    }

    /// Returns the polylines of a primitive.
    fn chains(&mut self, primitive: &Primitive, positions: &[Vec3], place: &str) -> Result<Chains, Problem> {
        let count = positions.len();
        let mut indices: Vec<u32> = match primitive.indices {
            Some(indices) => {
                let indices = components::<1>(self.document, indices, self.buffers, "indices")?;
                indices.into_iter().map(|[i]| i as u32).collect()
            }
            None => (0..count as u32).collect(),
        };
        if let Some(i) = indices.iter().find(|i| **i as usize >= count) {
            return Err(Problem::whole(format!(
                "{place}: a line names vertex {i} of an object of {count}; export it again"
            )));
        }
        if primitive.mode != Some(LINES) {
            self.found.loops += usize::from(primitive.mode == Some(LINE_LOOP));
            let offsets = if indices.is_empty() { vec![0] } else { vec![0, indices.len() as u32] };
            return Ok(Chains { order: indices, offsets });
        }
        self.found.incomplete += usize::from(!indices.len().is_multiple_of(2));
        // Some programs give each segment vertices of its own.
        for k in (2..indices.len()).step_by(2) {
            let [a, b] = [indices[k - 1], indices[k]];
            if positions[a as usize] == positions[b as usize] {
                indices[k] = a;
            }
        }
        let segments: Vec<[u32; 2]> = indices.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        chains::join(&segments)
    }

    /// Reads vectors.
    fn vectors(&mut self, index: usize, what: &str) -> Result<Rc<Vec<Vec3>>, Problem> {
        if let Some(read) = self.vectors.get(&index) {
            return Ok(read.clone());
        }
        let (document, buffers) = (self.document, self.buffers);
        let read: Vec<Vec3> = if what == "colors" {
            colors(document, index, buffers)?
        } else {
            let read = components::<3>(document, index, buffers, what)?;
            read.into_iter().map(|[x, y, z]| Vec3::new(x as f32, y as f32, z as f32)).collect()
        };
        let read = Rc::new(read);
        self.vectors.insert(index, read.clone());
        Ok(read)
    }

    /// Reads numbers.
    fn numbers(&mut self, index: usize, what: &str) -> Result<Rc<Vec<f32>>, Problem> {
        if let Some(read) = self.numbers.get(&index) {
            return Ok(read.clone());
        }
        let read = components::<1>(self.document, index, self.buffers, what)?;
        let read = Rc::new(read.into_iter().map(|[x]| x as f32).collect());
        self.numbers.insert(index, Rc::clone(&read));
        Ok(read)
    }

    /// Reads texture coordinates.
    fn uvs(&mut self, index: usize) -> Result<Rc<Vec<Vec2>>, Problem> {
        if let Some(read) = self.uvs.get(&index) {
            return Ok(read.clone());
        }
        let read = components::<2>(self.document, index, self.buffers, "texture coordinates")?;
        // v is downward from the upper edge in glTF.
        let read: Vec<Vec2> = read.into_iter().map(|[u, v]| Vec2::new(u as f32, 1.0 - v as f32)).collect();
        let read = Rc::new(read);
        self.uvs.insert(index, Rc::clone(&read));
        Ok(read)
    }

    /// Returns the finished groom. Adds a note for each kind of data that was ignored.
    fn finish(self, mut notes: Vec<String>) -> Result<Read, Problem> {
        let Self { mut groom, radii, found, groups, .. } = self;
        if found.lines == 0 {
            let has = match (found.others, found.hidden) {
                (0, 0) => "has no lines".into(),
                (0, hidden) => format!("has no lines except in {hidden} hidden objects"),
                (others, _) => format!("has {others} primitives of triangles or points but no lines"),
            };
            return Err(Problem::whole(format!(
                "the file {has}: a groom is read from primitives of the mode LINES or LINE_STRIP; export the hair as curves or loose edges, or name the file as a body"
            )));
        }
        let mut note = |count: usize, text: &str| {
            if count > 0 {
                notes.push(format!("{count} {text}"));
            }
        };
        note(
            found.others,
            "primitives of triangles or points are left out, because a groom is read from lines",
        );
        note(
            found.positionless,
            "primitives of lines have no positions (POSITION) and are left out; export the file again",
        );
        note(
            found.incomplete,
            "primitives of lines end with half a segment, which is left out; export the file again",
        );
        note(found.loops, "closed lines (LINE_LOOP) are opened at their first point, which is the root");
        note(
            found.deformed,
            "primitives of lines have a skin or morph targets and are read without them; apply them before the export",
        );
        note(
            found.copies,
            "nodes draw copies of a mesh with a skin (EXT_mesh_gpu_instancing), of which one is read; export without instancing",
        );
        if found.colored < found.lines {
            groom.colors.clear();
            if found.colored > 0 {
                note(
                    found.lines - found.colored,
                    "primitives of lines have no COLOR_0, so all colors are left out; give each one colors",
                );
            }
        }
        match found.mapped {
            0 => groom.root_uvs.clear(),
            mapped => note(
                groom.strand_count() - mapped,
                "strands have no TEXCOORD_0 and get the texture coordinates 0, 0; give each line its own",
            ),
        }
        let radii = (found.thick == found.lines).then_some(radii);
        if radii.is_none() && found.thick > 0 {
            note(
                found.lines - found.thick,
                "primitives of lines have no _RADIUS or _WIDTH, so all are left out; give each one radii",
            );
        }
        if groups.len() > usize::from(u16::MAX) + 1 {
            note(
                groups.len(),
                "objects are more than the limit of 65,536 groups, so all strands are in one group; join objects before the export",
            );
            groom.groups.clear();
            groom.group_names.clear();
        }
        let units = FileUnits { scale: Some(1.0), up: None };
        Ok(Read { groom, radii, true_radii: false, units, notes })
    }
}
