//! Separates the rigid parts of a closed mesh from the rest.
//!
//! A prop (a second head, a tray) is part of the body's mesh and skin. A separate collider has advantages:
//! its distance field is built only once, it follows its arc between frames with its own velocity in each
//! substep, and it requests shorter substeps when it moves fast.

use hairspring::body::Body;

/// A rigid part: its joint, and its mesh in the rest pose.
pub(super) struct Piece {
    pub(super) joint: usize,
    pub(super) body: Body,
}

/// Removes from `body` every rigid part that is no longer than `longest` [m] and not connected with the joint
/// `anchor`, and returns them. A rigid part is a joint without parent and children that shares no vertices or
/// triangles with other joints.
pub(super) fn take(body: &mut Body, anchor: usize, longest: f32) -> Vec<Piece> {
    let Some(skin) = &body.skin else { return Vec::new() };
    let mut alone: Vec<bool> = body.joints.iter().map(|joint| joint.parent.is_none()).collect();
    alone[anchor] = false;
    body.joints.iter().filter_map(|joint| joint.parent).for_each(|parent| alone[parent as usize] = false);
    // The only joint that has a weight on a vertex.
    let own: Vec<Option<u16>> = skin
        .joints
        .iter()
        .zip(&skin.weights)
        .map(|(joints, weights)| {
            let mut with = joints.iter().zip(weights).filter(|(_, w)| **w > 0.0).map(|(joint, _)| *joint);
            let first = with.next()?;
            let shared = with.any(|joint| joint != first);
            if shared {
                joints.iter().for_each(|joint| alone[*joint as usize] = false);
            }
            (!shared).then_some(first)
        })
        .collect();
    let of = |triangle: &[u32; 3]| triangle.map(|v| own[v as usize]);
    for triangle in &body.mesh.triangles {
        let [a, b, c] = of(triangle);
        if a != b || b != c {
            [a, b, c].into_iter().flatten().for_each(|joint| alone[joint as usize] = false);
        }
    }
    let joint_of: Vec<Option<usize>> =
        body.mesh.triangles.iter().map(|triangle| of(triangle)[0].map(usize::from)).collect();
    let mut pieces = Vec::new();
    for (joint, alone) in alone.iter_mut().enumerate().filter(|(_, alone)| **alone) {
        let piece = body.with_triangles(|t| joint_of[t] == Some(joint));
        *alone = piece.mesh.bounds().is_some_and(|(lo, hi)| (hi - lo).max_element() <= longest);
        if *alone {
            pieces.push(Piece { joint, body: piece });
        }
    }
    if !pieces.is_empty() {
        *body = body.with_triangles(|t| joint_of[t].is_none_or(|joint| !alone[joint]));
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use hairspring::body::{Joint, Mesh, Skin, Trs};

    /// A body with a separate tetrahedron of 1 m for each joint; parents as given.
    fn body(parents: &[Option<u32>]) -> Body {
        let mut mesh = Mesh::default();
        let mut skin = Skin { joints: Vec::new(), weights: Vec::new(), inverse_bind: Vec::new() };
        let mut joints = Vec::new();
        for (k, parent) in parents.iter().enumerate() {
            let (first, at) = (4 * k as u32, Vec3::X * (2.0 * k as f32));
            mesh.positions.extend([at, at + Vec3::X, at + Vec3::Y, at + Vec3::Z]);
            let corners = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
            mesh.triangles.extend(corners.map(|t| t.map(|v| v + first)));
            skin.joints.extend([[k as u16, 0, 0, 0]; 4]);
            skin.weights.extend([[1.0, 0.0, 0.0, 0.0]; 4]);
            skin.inverse_bind.push(Default::default());
            joints.push(Joint { name: k.to_string(), parent: *parent, rest: Trs::default() });
        }
        mesh.normals = vec![Vec3::Y; mesh.positions.len()];
        Body { mesh, joints, skin: Some(skin) }
    }

    #[test]
    fn independent_joints_become_rigid_parts_and_the_rest_stays_in_one_mesh() {
        // The anchor, a child of it, a prop, a parent and its child.
        let mut apart = body(&[None, Some(0), None, None, Some(3)]);
        let pieces = take(&mut apart, 0, 1.5);
        assert_eq!(pieces.iter().map(|piece| piece.joint).collect::<Vec<_>>(), [2]);
        let piece = &pieces[0].body;
        assert_eq!((piece.mesh.positions.len(), piece.mesh.triangles.len()), (4, 4));
        assert_eq!(piece.mesh.bounds().unwrap().0, Vec3::X * 4.0);
        assert_eq!((apart.mesh.positions.len(), apart.mesh.triangles.len()), (16, 16));
        assert_eq!(apart.skin.as_ref().unwrap().joints.len(), 16);
    }

    #[test]
    fn joints_that_share_a_vertex_or_triangle_or_are_too_long_are_not_separated() {
        let whole = body(&[None, None]);
        let mut long = whole.clone();
        assert!(take(&mut long, 0, 0.5).is_empty() && long == whole);
        let mut shared = whole.clone();
        let skin = shared.skin.as_mut().unwrap();
        (skin.joints[7], skin.weights[7]) = ([1, 0, 0, 0], [0.5, 0.5, 0.0, 0.0]);
        assert!(take(&mut shared.clone(), 0, 1.5).is_empty());
        let mut bridged = whole;
        bridged.mesh.triangles.push([0, 1, 5]);
        assert!(take(&mut bridged, 0, 1.5).is_empty());
    }
}
