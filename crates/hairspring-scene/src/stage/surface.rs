//! What hair collides with that is made from meshes: a distance field of a closed one, sheets of open ones. One that deforms is made anew
//! in the anchor's space, whenever it moved there.

use super::fast_surface::FastSurfaceProbe;
use glam::{Affine3A, Vec3};
use hairspring::{
    body::Body,
    collide::{ColliderShape, SignedDistanceField, ThinShell, Voxelizer},
    math::RigidTransform,
};
use std::sync::Arc;

/// A surface that moved less than this in its anchor's space is rigid for this frame, as a share of its cells or its thickness.
const STILL: f32 = 0.0025;

/// Colliders that are kept for their memory: as many as viewers look at at once.
const SPARE: usize = 4;

/// What becomes of a mesh.
#[derive(Clone, Copy)]
pub(super) enum SurfaceKind {
    /// A distance field with cells of this edge [m].
    Field(f32),
    /// A sheet of this thickness [m].
    Sheet(f32),
}

/// Makes the collider of one skinned mesh, again and again.
pub(super) struct Surface {
    making: SurfaceKind,
    voxelizer: Voxelizer,
    /// Colliders of frames before that were looked at elsewhere when the next was made, for their memory.
    spare: Vec<ColliderShape>,
    /// Vertices in the anchor's space, now and a frame ago.
    now: Vec<Vec3>,
    before: Vec<Vec3>,
    normals: Vec<Vec3>,
    limbs: FastSurfaceProbe,
}

/// A body's joints, and the anchor that its colliders are in the space of.
pub(super) type Pose = (Vec<Affine3A>, RigidTransform);

impl SurfaceKind {
    /// A collider that is nowhere yet.
    pub fn nothing(self) -> ColliderShape {
        match self {
            Self::Field(_) => ColliderShape::Field(Arc::default()),
            Self::Sheet(_) => ColliderShape::Sheet(Arc::default()),
        }
    }

    /// The collider of a mesh that does not deform.
    pub fn rigid(self, body: &Body, within: Option<(Vec3, Vec3)>) -> ColliderShape {
        let mut shape = self.nothing();
        let (positions, triangles) = (&body.mesh.positions, &body.mesh.triangles);
        self.make(&mut shape, &mut Voxelizer::default(), (positions, None), triangles, within);
        shape
    }

    /// Makes `shape` the collider of a mesh with vertices `now` and, where they moved, `before` [m].
    fn make(
        self,
        shape: &mut ColliderShape,
        voxelizer: &mut Voxelizer,
        (now, before): (&[Vec3], Option<&[Vec3]>),
        triangles: &[[u32; 3]],
        within: Option<(Vec3, Vec3)>,
    ) {
        match (self, shape) {
            (Self::Field(cell), ColliderShape::Field(grid)) => {
                voxelizer.update(Arc::make_mut(grid), now, before, triangles, within, cell);
            }
            (Self::Sheet(thickness), ColliderShape::Sheet(sheet)) => {
                Arc::make_mut(sheet).update(now, before, triangles, within, thickness);
            }
            _ => {}
        }
    }
}

/// Whether nobody else looks at a shape.
fn is_free(shape: &mut ColliderShape) -> bool {
    match shape {
        ColliderShape::Field(grid) => Arc::get_mut(grid).is_some(),
        ColliderShape::Sheet(sheet) => Arc::get_mut(sheet).is_some(),
        _ => true,
    }
}

impl Surface {
    /// Of a body that has a skin.
    pub(super) fn new(making: SurfaceKind, body: &Body) -> Self {
        let limbs = match making {
            SurfaceKind::Field(cell) => FastSurfaceProbe::of_solid(&body.mesh, cell),
            SurfaceKind::Sheet(thickness) => FastSurfaceProbe::of_sheet(&body.mesh, thickness),
        };
        Self {
            limbs,
            making,
            voxelizer: Voxelizer::default(),
            spare: Vec::new(),
            now: Vec::new(),
            before: Vec::new(),
            normals: Vec::new(),
        }
    }

    /// Into how many parts a frame is to be cut that ends with `body` in that pose, and was made a collider where it begins.
    pub(super) fn parts(
        &self,
        body: &Body,
        (world, anchor): (&[Affine3A], RigidTransform),
        within: Option<(Vec3, Vec3)>,
    ) -> usize {
        let Some(skin) = &body.skin else { return 1 };
        self.limbs.parts((&body.mesh, skin), &self.now, (world, anchor), within)
    }

    /// Makes `shape` the collider of `body` in the last of those poses, and others in those before it, at equal parts of the frame; `fresh`: without motion
    /// since the last time.
    pub(super) fn update<'a>(
        &mut self,
        shape: &mut ColliderShape,
        body: &Body,
        poses: impl Iterator<Item = &'a Pose>,
        within: Option<(Vec3, Vec3)>,
        fresh: bool,
    ) {
        shape.set_previous_slices(Vec::new());
        let mut earlier = Vec::new();
        for (number, pose) in poses.enumerate() {
            if number > 0 {
                earlier.push(shape.clone());
            }
            self.make(shape, body, pose, within, fresh);
        }
        shape.set_previous_slices(earlier);
    }

    /// Makes `shape` the collider of `body` in a pose.
    fn make(
        &mut self,
        shape: &mut ColliderShape,
        body: &Body,
        (world, anchor): &Pose,
        within: Option<(Vec3, Vec3)>,
        fresh: bool,
    ) {
        std::mem::swap(&mut self.now, &mut self.before);
        body.skinned(world, &mut self.now, &mut self.normals);
        self.now.iter_mut().for_each(|p| *p = anchor.inverse_point(*p));
        let moved =
            self.now.iter().zip(&self.before).map(|(a, b)| a.distance_squared(*b)).fold(0.0, f32::max);
        let (SurfaceKind::Field(fine) | SurfaceKind::Sheet(fine)) = self.making;
        if !fresh && moved < (STILL * fine).powi(2) {
            match shape {
                ColliderShape::Field(grid) if grid.deforms() => {
                    SignedDistanceField::hold_still(Arc::make_mut(grid))
                }
                ColliderShape::Sheet(sheet) if sheet.deforms() => ThinShell::hold_still(Arc::make_mut(sheet)),
                _ => {}
            }
            // What little it moved is not lost: it adds up against the surface that was made.
            std::mem::swap(&mut self.now, &mut self.before);
            return;
        }
        let before = (!fresh).then_some(self.before.as_slice());
        // Someone may still look at the last one: another is made, in place of a copy that would be written over.
        if !is_free(shape) {
            let free = self.spare.iter_mut().position(is_free).map(|k| self.spare.swap_remove(k));
            let last = std::mem::replace(shape, free.unwrap_or_else(|| self.making.nothing()));
            self.spare.truncate(SPARE - 1);
            self.spare.push(last);
        }
        self.making.make(shape, &mut self.voxelizer, (&self.now, before), &body.mesh.triangles, within);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairspring::body::{Joint, Mesh, Skin, Trs};

    #[test]
    fn a_skinned_sheet_is_where_its_joints_are_and_knows_how_it_moved() {
        let positions: Vec<Vec3> =
            [(0.0, 0.0), (0.0, 0.1), (0.3, 0.0), (0.3, 0.1)].map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec();
        let mesh = Mesh { positions, triangles: vec![[0, 1, 2], [2, 1, 3]], ..Mesh::default() };
        let joint = |name: &str| Joint { name: name.into(), parent: None, rest: Trs::default() };
        let skin = Skin {
            joints: vec![[0; 4], [0; 4], [1; 4], [1; 4]],
            weights: vec![[1.0, 0.0, 0.0, 0.0]; 4],
            inverse_bind: vec![Affine3A::IDENTITY; 2],
        };
        let body = Body { mesh, joints: vec![joint("near"), joint("far")], skin: Some(skin) };
        let world = |up: f32| [Affine3A::IDENTITY, Affine3A::from_translation(Vec3::Y * up)];
        let making = SurfaceKind::Sheet(0.002);
        let (mut surface, mut shape) = (Surface::new(making, &body), making.nothing());
        let mut play = |up: f32, fresh: bool| {
            let pose = (world(up).to_vec(), RigidTransform::default());
            surface.update(&mut shape, &body, std::iter::once(&pose), None, fresh);
            let ColliderShape::Sheet(sheet) = &shape else { unreachable!("a sheet is made") };
            let at = |x: f32| {
                let p = Vec3::new(x, up * x / 0.3, 0.05);
                (sheet.distance_and_normal(p).0, sheet.displacement(p).y)
            };
            ([at(0.01), at(0.29)], sheet.deforms())
        };
        let (rest, deforms) = play(0.0, true);
        assert!(
            !deforms && rest.iter().all(|(d, moved)| (d + 0.002).abs() < 1e-7 && *moved == 0.0),
            "{rest:?}"
        );
        let ([near, far], deforms) = play(0.03, false);
        assert!(deforms && (near.0 + 0.002).abs() < 1e-6 && (far.0 + 0.002).abs() < 1e-6, "{near:?} {far:?}");
        assert!((near.1 - 0.001).abs() < 1e-6 && (far.1 - 0.029).abs() < 1e-6, "{near:?} {far:?}");
        let (still, deforms) = play(0.03, false);
        assert!(!deforms && still.iter().all(|(_, moved)| *moved == 0.0), "{still:?}");
    }
}
