//! Cuts a mesh along a line on its surface, so that colored parts meet in a clean border.

use glam::Vec3;
use hairspring::body::Mesh;
use std::collections::HashMap;

/// Cuts `mesh` along the line where `side` changes sign. Afterward no triangle lies on both sides of it.
///
/// Vertices near the line are moved onto it, so that no slivers remain; edges that still cross are split. A
/// closed mesh stays closed, because both triangles of an edge share its new vertex. The normal of a new
/// vertex is interpolated along its edge.
pub fn cut_along(mesh: &mut Mesh, side: impl Fn(Vec3) -> f32) {
    /// If a crossing is nearer to one end of its edge than this fraction of the edge, that end is moved.
    const SNAP: f32 = 0.3;
    let mut values: Vec<f32> = mesh.positions.iter().map(|p| side(*p)).collect();
    let mut snapped = vec![(SNAP, Vec3::ZERO); values.len()];
    for t in &mesh.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            let (a, b) = (a as usize, b as usize);
            if values[a] * values[b] < 0.0 {
                let at = values[a] / (values[a] - values[b]);
                let crossing = mesh.positions[a].lerp(mesh.positions[b], at);
                for (end, near) in [(a, at), (b, 1.0 - at)] {
                    if near < snapped[end].0 {
                        snapped[end] = (near, crossing);
                    }
                }
            }
        }
    }
    for (i, (near, to)) in snapped.into_iter().enumerate() {
        if near < SNAP {
            mesh.positions[i] = to;
            values[i] = 0.0;
        }
    }

    let mut split: HashMap<[u32; 2], u32> = HashMap::new();
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    for t in std::mem::take(&mut mesh.triangles) {
        let crosses = |i: usize| values[t[i] as usize] * values[t[(i + 1) % 3] as usize] < 0.0;
        // Rotate the triangle so that a lone corner, if any, comes first: then only edges 0 and 2 may cross.
        let Some(first) = (0..3).find(|i| crosses(*i)) else {
            triangles.push(t);
            continue;
        };
        let lone = if crosses((first + 2) % 3) { first } else { (first + 1) % 3 };
        let [a, b, c] = [t[lone], t[(lone + 1) % 3], t[(lone + 2) % 3]];
        let mut middle = |a: u32, b: u32| {
            *split.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                let (i, j) = (a.min(b) as usize, a.max(b) as usize);
                let at = values[i] / (values[i] - values[j]);
                mesh.positions.push(mesh.positions[i].lerp(mesh.positions[j], at));
                mesh.normals.push(mesh.normals[i].lerp(mesh.normals[j], at).normalize_or(Vec3::Y));
                (mesh.positions.len() - 1) as u32
            })
        };
        let (va, vb, vc) = (values[a as usize], values[b as usize], values[c as usize]);
        match (va * vb < 0.0, va * vc < 0.0) {
            (true, true) => {
                let (ab, ac) = (middle(a, b), middle(a, c));
                triangles.extend([[a, ab, ac], [ab, b, c], [ab, c, ac]]);
            }
            (true, false) => {
                let ab = middle(a, b);
                triangles.extend([[a, ab, c], [ab, b, c]]);
            }
            _ => {
                let ac = middle(a, c);
                triangles.extend([[a, b, ac], [ac, b, c]]);
            }
        }
    }
    mesh.triangles = triangles;
}
