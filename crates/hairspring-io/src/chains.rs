//! Joins edges between vertices to polylines.

use crate::Problem;

/// No vertex.
const NONE: usize = usize::MAX;

/// Polylines of vertices.
pub(crate) struct Chains {
    /// Vertices, polyline after polyline.
    pub order: Vec<u32>,
    /// Index in `order` of each polyline's first vertex, and the length of `order` at the end.
    pub offsets: Vec<u32>,
}

/// Joins edges between numbered vertices to polylines. Of the two ends of a polyline, the vertex with the lower number is
/// its root. Polylines are in the order of their roots.
///
/// # Errors
/// Returns an error for a vertex with more than two edges, and for a polyline without ends.
pub(crate) fn join(edges: &[[u32; 2]]) -> Result<Chains, Problem> {
    // The work depends on the number of edges only, because many lines may share one large array of vertices.
    let mut vertices: Vec<u32> = edges.iter().flatten().copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    let slot_of = |vertex: u32| vertices.partition_point(|v| *v < vertex);
    let mut neighbors = vec![[NONE; 2]; vertices.len()];
    for edge in edges {
        let [a, b] = edge.map(slot_of);
        for (from, to) in [(a, b), (b, a)] {
            let Some(free) = neighbors[from].iter_mut().find(|slot| **slot == NONE) else {
                let text = format!(
                    "vertex {} has more than two edges, but a strand does not branch; export the curves, not a mesh",
                    vertices[from]
                );
                return Err(Problem::whole(text));
            };
            *free = to;
        }
    }
    let mut chains = Chains { order: Vec::with_capacity(vertices.len()), offsets: vec![0] };
    let mut joined = vec![false; vertices.len()];
    for first in 0..vertices.len() {
        if joined[first] || neighbors[first][1] != NONE {
            continue;
        }
        let (mut before, mut at) = (NONE, first);
        while at != NONE {
            joined[at] = true;
            chains.order.push(vertices[at]);
            let [a, b] = neighbors[at];
            (before, at) = (at, if a == before { b } else { a });
        }
        chains.offsets.push(chains.order.len() as u32);
    }
    match joined.iter().position(|joined| !joined) {
        Some(slot) => Err(Problem::whole(format!(
            "the edges at vertex {} form a loop, but a strand has a root and a tip; cut the curve open",
            vertices[slot]
        ))),
        None => Ok(chains),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_in_any_order_and_direction_form_polylines() {
        let chains = join(&[[5, 1], [1, 7], [20, 30], [0, 7], [60, 30]]).unwrap();
        assert_eq!(chains.order, [0, 7, 1, 5, 20, 30, 60]);
        assert_eq!(chains.offsets, [0, 4, 7]);
    }

    #[test]
    fn branches_and_loops_are_errors() {
        let error = |edges: &[[u32; 2]]| join(edges).err().unwrap().text;
        assert!(error(&[[0, 9], [9, 2], [3, 9]]).contains("vertex 9 has more than two edges"));
        assert!(error(&[[7, 9], [9, 8], [8, 7]]).contains("vertex 7 form a loop"));
        assert!(error(&[[0, 1], [0, 1]]).contains("a loop"));
        assert!(error(&[[2, 2]]).contains("vertex 2 form a loop"));
    }
}
