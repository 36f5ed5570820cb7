//! The polylines of an `.obj` file, which are the strands of a groom.

use crate::{
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

    /// Joins segments of a group that share an end, in any order and direction, if the file has nothing but segments.
    /// Returns a note if there are any. With a vertex of more than two segments, nothing is joined.
    pub fn join(&mut self) -> Option<String> {
        self.uvs.sort_unstable();
        if self.has_polylines {
            return None;
        }
        let mut vertices: Vec<(usize, u32)> = Vec::with_capacity(self.order.len());
        let mut edges: Vec<Vec<[u32; 2]>> = vec![Vec::new(); self.groups.count()];
        for (line, group) in self.offsets.windows(2).zip(&self.groups.of_strands) {
            let line = &self.order[line[0] as usize..line[1] as usize];
            vertices.extend(line.iter().map(|vertex| (*group, *vertex)));
            edges[*group].extend(line.windows(2).map(|edge| [edge[0], edge[1]]));
        }
        vertices.sort_unstable();
        vertices.windows(2).find(|pair| pair[0] == pair[1])?;
        let joined: Vec<Chains> =
            edges.iter().map(|edges| chains::join(edges)).collect::<Result<_, _>>().ok()?;
        let before = self.offsets.len() - 1;
        (self.order, self.offsets) = (Vec::new(), vec![0]);
        self.groups.of_strands.clear();
        for (group, chains) in joined.into_iter().enumerate() {
            let first = self.order.len() as u32;
            self.order.extend(chains.order);
            self.offsets.extend(chains.offsets.iter().skip(1).map(|end| first + end));
            self.groups.of_strands.resize(self.offsets.len() - 1, group);
        }
        Some(format!("{before} lines that share their ends are joined to {} strands", self.offsets.len() - 1))
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
