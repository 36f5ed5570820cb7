//! The polylines of an `.obj` file, which are the strands of a groom.

use crate::{
    Problem,
    chains::{self, Chains},
    strand_attributes::StrandGroups,
};

/// The polylines of a file, as vertices.
#[derive(Default)]
pub(crate) struct Polylines {
    /// Vertices, polyline after polyline.
    pub order: Vec<u32>,
    /// Index in `order` of each polyline's first vertex, and the length of `order` at the end.
    pub offsets: Vec<u32>,
    /// Vertices with texture coordinates, and those.
    uvs: Vec<[u32; 2]>,
    /// Whether a line has more than two vertices.
    pub has_polylines: bool,
    /// The group of each polyline.
    pub groups: StrandGroups,
    /// The last name of a group or an object, or empty.
    name: String,
    /// Index of the group of that name, if it has a polyline.
    group: Option<usize>,
}

impl Polylines {
    /// Begins the group called `name`.
    pub fn begin_group(&mut self, name: String) {
        (self.name, self.group) = (name, None);
    }

    /// Starts a line at a vertex. Some programs write each segment as a line of its own: one that begins where the
    /// line before it ends continues the polyline, in the same group.
    pub fn begin(&mut self, corner: (u32, Option<u32>)) {
        if self.offsets.is_empty() {
            self.offsets.push(0);
        }
        let group = *self.group.get_or_insert_with(|| self.groups.index(&self.name));
        if self.order.last() != Some(&corner.0) || self.groups.of_strands.last() != Some(&group) {
            self.offsets.push(self.order.len() as u32);
            self.groups.of_strands.push(group);
            self.push(corner);
        }
    }

    /// Adds a vertex to the last polyline.
    pub fn push(&mut self, (vertex, uv): (u32, Option<u32>)) {
        self.order.push(vertex);
        self.uvs.extend(uv.map(|uv| [vertex, uv]));
        if let Some(end) = self.offsets.last_mut() {
            *end = self.order.len() as u32;
        }
    }

    /// Joins segments of a group in any order and direction, if the file has nothing but segments. Two are joined where
    /// one ends and the other begins, and where the numbers of their vertices increase or decrease through both. Other
    /// vertices of two or more segments are roots that strands share, or branches, where strands stay separate.
    /// Returns notes about what was joined, and about branches.
    pub fn join(&mut self) -> Vec<String> {
        self.uvs.sort_unstable();
        if self.has_polylines {
            return Vec::new();
        }
        let mut segments: Vec<Vec<Segment>> = vec![Vec::new(); self.groups.count()];
        for (line, (of, group)) in self.offsets.windows(2).zip(&self.groups.of_strands).enumerate() {
            let vertices = &self.order[of[0] as usize..of[1] as usize];
            segments[*group]
                .extend(vertices.windows(2).map(|ends| Segment { ends: [ends[0], ends[1]], line }));
        }
        let mut branches = 0;
        let joined: Result<Vec<Chains>, _> =
            segments.iter().map(|segments| join_segments(segments, &mut branches)).collect();
        let mut notes = Vec::new();
        if branches > 0 {
            notes.push(format!(
                "strands branch at {branches} vertices, but a strand has one root and one tip; they are separate strands there; export the curves, not a mesh"
            ));
        }
        let before = self.offsets.len().saturating_sub(1);
        let Ok(joined) = joined else { return notes };
        if joined.iter().map(|chains| chains.offsets.len() - 1).sum::<usize>() == before {
            return notes;
        }
        (self.order, self.offsets) = (Vec::new(), vec![0]);
        self.groups.of_strands.clear();
        for (group, chains) in joined.into_iter().enumerate() {
            let first = self.order.len() as u32;
            self.order.extend(chains.order);
            self.offsets.extend(chains.offsets.iter().skip(1).map(|end| first + end));
            self.groups.of_strands.resize(self.offsets.len() - 1, group);
        }
        let strands = self.offsets.len() - 1;
        notes.push(format!("{before} lines that share their ends are joined to {strands} strands"));
        notes
    }

    /// Number of polylines that end where they begin.
    pub fn closed(&self) -> usize {
        let ends = |line: &&[u32]| self.order[line[0] as usize] == self.order[line[1] as usize - 1];
        self.offsets.windows(2).filter(|line| line[1] - line[0] > 2).filter(ends).count()
    }

    /// The first vertex of each polyline.
    pub fn roots(&self) -> impl Iterator<Item = u32> {
        self.offsets
            .iter()
            .take(self.offsets.len().saturating_sub(1))
            .map(|first| self.order[*first as usize])
    }

    /// Index of the texture coordinates of a vertex.
    pub fn uv(&self, vertex: u32) -> Option<u32> {
        let at = self.uvs.partition_point(|uv| uv[0] < vertex);
        self.uvs.get(at).filter(|uv| uv[0] == vertex).map(|uv| uv[1])
    }
}

/// Two vertices of a line, in its direction.
#[derive(Clone, Copy)]
struct Segment {
    ends: [u32; 2],
    /// Index of the line.
    line: usize,
}

/// Joins the segments of a group to strands. Adds the number of vertices where strands branch to `branches`.
fn join_segments(segments: &[Segment], branches: &mut usize) -> Result<Chains, Problem> {
    // Vertex, segment, and whether the segment ends there.
    let mut ends: Vec<(u32, usize, bool)> = (segments.iter().enumerate())
        .flat_map(|(k, segment)| [(segment.ends[0], k, false), (segment.ends[1], k, true)])
        .collect();
    ends.sort_unstable();
    // Ends that are not joined get a copy of their vertex each, in the order of the vertices.
    let mut copies: Vec<u32> = Vec::with_capacity(ends.len());
    let mut edges = vec![[0u32; 2]; segments.len()];
    let mut shared_roots = Vec::new();
    for at in ends.chunk_by(|a, b| a.0 == b.0) {
        let ending = at.iter().filter(|end| end.2).count();
        *branches += usize::from(at.len() > 2 && (1..at.len()).contains(&ending));
        let alone = continue_each_other(at, segments);
        let mut open = None;
        for (vertex, segment, ends_here) in at {
            let line = segments[*segment].line;
            let id = match open.take() {
                Some((id, before)) if alone || before == line => id,
                _ => {
                    let id = copies.len() as u32;
                    copies.push(*vertex);
                    open = Some((id, line));
                    id
                }
            };
            edges[*segment][usize::from(*ends_here)] = id;
            if !alone && ending == 0 && at.len() > 1 {
                shared_roots.push(id);
            }
        }
    }
    let mut chains = chains::join(&edges)?;
    for of in chains.offsets.windows(2) {
        let strand = &mut chains.order[of[0] as usize..of[1] as usize];
        let is_root = |id: Option<&u32>| id.is_some_and(|id| shared_roots.binary_search(id).is_ok());
        if is_root(strand.last()) && !is_root(strand.first()) {
            strand.reverse();
        }
    }
    chains.order.iter_mut().for_each(|id| *id = copies[*id as usize]);
    Ok(chains)
}

/// Returns whether the ends at a vertex are those of two segments that continue each other.
fn continue_each_other(at: &[(u32, usize, bool)], segments: &[Segment]) -> bool {
    let [(vertex, a, a_ends), (_, b, b_ends)] = *at else { return false };
    let other = |segment: usize, ends_here: bool| segments[segment].ends[usize::from(!ends_here)];
    let mut others = [other(a, a_ends), other(b, b_ends)];
    others.sort_unstable();
    a_ends != b_ends || (others[0] < vertex && vertex < others[1])
}
