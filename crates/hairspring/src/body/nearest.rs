//! Nearest-point queries on a mesh with a bounding volume hierarchy of axis-aligned boxes.

use super::Mesh;
use glam::Vec3;

/// Largest number of triangles in a leaf: testing a handful of triangles costs less than another level of the
/// tree.
const MAX_TRIANGLES_PER_LEAF: usize = 4;

/// A point on a triangle, with its distance from the query point.
///
/// For an example, see [`NearestTree`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPlace {
    /// Index of the triangle.
    pub triangle: u32,
    /// Barycentric coordinates of the point, each 0 to 1; sum 1.
    pub barycentric: Vec3,
    /// Squared distance from the query point [m²].
    pub distance_squared: f32,
}

/// A bounding volume hierarchy over the triangles of a mesh.
///
/// ```
/// use glam::Vec3;
/// use hairspring::body::{Mesh, NearestTree};
///
/// let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Z];
/// let mesh = Mesh { positions, triangles: vec![[0, 2, 1]], ..Default::default() };
/// let tree = NearestTree::new(&mesh);
/// let place = tree.nearest(Vec3::new(0.2, 0.5, 0.2), |_| true).unwrap();
/// assert_eq!((place.triangle, place.distance_squared), (0, 0.25));
/// ```
pub struct NearestTree<'a> {
    mesh: &'a Mesh,
    nodes: Vec<Node>,
    /// Triangle indices, grouped by leaf.
    triangles: Vec<u32>,
}

impl std::fmt::Debug for NearestTree<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("NearestTree").field("triangles", &self.triangles.len()).finish_non_exhaustive()
    }
}

struct Node {
    lo: Vec3,
    hi: Vec3,
    /// Start of the node's range in `NearestTree::triangles`.
    first: u32,
    count: u32,
    /// Index of the second child; the first child follows its parent. 0 marks a leaf.
    second: u32,
}

impl<'a> NearestTree<'a> {
    /// Builds the tree. Nodes are split at the median centroid along their longest axis.
    ///
    /// # Panics
    /// If a triangle names a vertex that does not exist.
    pub fn new(mesh: &'a Mesh) -> Self {
        let centroids: Vec<Vec3> =
            (0..mesh.triangles.len()).map(|t| mesh.corners(t).into_iter().sum::<Vec3>() / 3.0).collect();
        let mut tree =
            Self { mesh, nodes: Vec::new(), triangles: (0..mesh.triangles.len() as u32).collect() };
        if !tree.triangles.is_empty() {
            tree.split(0, tree.triangles.len(), &centroids);
        }
        tree
    }

    fn split(&mut self, first: usize, count: usize, centroids: &[Vec3]) {
        let run = &mut self.triangles[first..first + count];
        let corners = run.iter().flat_map(|t| self.mesh.corners(*t as usize));
        let (lo, hi) =
            corners.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
        let index = self.nodes.len();
        self.nodes.push(Node { lo, hi, first: first as u32, count: count as u32, second: 0 });
        if count <= MAX_TRIANGLES_PER_LEAF {
            return;
        }
        let axis = (hi - lo).max_position();
        let middle = count / 2;
        run.select_nth_unstable_by(middle, |a, b| {
            centroids[*a as usize][axis].total_cmp(&centroids[*b as usize][axis]).then(a.cmp(b))
        });
        self.split(first, middle, centroids);
        self.nodes[index].second = self.nodes.len() as u32;
        self.split(first + middle, count - middle, centroids);
    }

    /// Returns the point nearest to `p` among the triangles that `allowed` accepts; `None` if there is none.
    /// Of several points at the same distance, the one on the triangle with the lowest index is returned.
    pub fn nearest(&self, p: Vec3, allowed: impl Fn(usize) -> bool) -> Option<NearestPlace> {
        let mut best: Option<NearestPlace> = None;
        let mut stack = vec![0usize];
        if self.nodes.is_empty() {
            return None;
        }
        while let Some(n) = stack.pop() {
            let node = &self.nodes[n];
            if best.is_some_and(|b| box_distance_squared(node, p) > b.distance_squared) {
                continue;
            }
            if node.second == 0 {
                for &t in &self.triangles[node.first as usize..][..node.count as usize] {
                    if !allowed(t as usize) {
                        continue;
                    }
                    let corners = self.mesh.corners(t as usize);
                    let barycentric = nearest_on_triangle(p, corners);
                    let distance_squared = at(barycentric, corners).distance_squared(p);
                    let better =
                        best.is_none_or(|b| (distance_squared, t) < (b.distance_squared, b.triangle));
                    if better && distance_squared.is_finite() {
                        best = Some(NearestPlace { triangle: t, barycentric, distance_squared });
                    }
                }
            } else {
                // Visit the nearer child first.
                let (a, b) = (n + 1, node.second as usize);
                let near_first =
                    box_distance_squared(&self.nodes[a], p) <= box_distance_squared(&self.nodes[b], p);
                stack.extend(if near_first { [b, a] } else { [a, b] });
            }
        }
        best
    }
}

/// Returns the point with barycentric coordinates `b` on the triangle `corners`.
pub(crate) fn at(b: Vec3, corners: [Vec3; 3]) -> Vec3 {
    corners[0] * b.x + corners[1] * b.y + corners[2] * b.z
}

fn box_distance_squared(node: &Node, p: Vec3) -> f32 {
    p.distance_squared(p.clamp(node.lo, node.hi))
}

/// Returns the barycentric coordinates of the point on a triangle nearest to `p` (Ericson 2005, *Real-Time
/// Collision Detection*, §5.1.5).
#[inline]
pub(crate) fn nearest_on_triangle(p: Vec3, [a, b, c]: [Vec3; 3]) -> Vec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return Vec3::X;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return Vec3::Y;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return Vec3::new(1.0 - v, v, 0.0);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return Vec3::Z;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return Vec3::new(1.0 - w, 0.0, w);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return Vec3::new(0.0, 1.0 - w, w);
    }
    let sum = va + vb + vc;
    if sum > 0.0 { Vec3::new(va, vb, vc) / sum } else { Vec3::X }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Vec3> {
        (-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0).prop_map(Vec3::from)
    }

    proptest! {
        #[test]
        fn the_tree_finds_what_a_search_of_all_triangles_finds(
            positions in prop::collection::vec(point(), 3..60),
            corners in prop::collection::vec((0usize..60, 0usize..60, 0usize..60), 1..80),
            p in point(),
        ) {
            let n = positions.len();
            let triangles: Vec<[u32; 3]> =
                corners.iter().map(|(a, b, c)| [a % n, b % n, c % n].map(|i| i as u32)).collect();
            let mesh = Mesh { positions, triangles, ..Mesh::default() };
            let odd = |t: usize| t % 2 == 1;
            for (allowed, name) in [(&(|_| true) as &dyn Fn(usize) -> bool, "all"), (&odd, "odd")] {
                let all = (0..mesh.triangles.len()).filter(|t| allowed(*t)).map(|t| {
                    let corners = mesh.corners(t);
                    at(nearest_on_triangle(p, corners), corners).distance_squared(p)
                });
                let want = all.fold(f32::INFINITY, f32::min);
                let got = NearestTree::new(&mesh).nearest(p, allowed).map_or(f32::INFINITY, |g| g.distance_squared);
                prop_assert_eq!(got, want, "{}", name);
            }
        }
    }
}
