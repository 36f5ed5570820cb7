//! Colliders made from meshes: the distance field of a closed mesh and the thin shells of open ones. A
//! deforming collider is rebuilt in the anchor's space whenever it has moved there.

use super::{body_pose::Pose, fast_surface::FastSurfaceProbe};
use glam::Vec3;
use hairspring::{
    body::Body,
    collide::{ColliderShape, SignedDistanceField, ThinShell, Voxelizer, VoxelizerInput},
};
use std::sync::Arc;

/// Largest displacement in the anchor's space at which a surface counts as rigid in a frame, relative to its
/// cell or its thickness.
const STILL: f32 = 0.0025;

/// Maximum number of colliders kept for reuse: as many as viewers hold at once.
const SPARE: usize = 4;

/// The kind of collider that a mesh becomes.
#[derive(Clone, Copy)]
pub(super) enum SurfaceKind {
    /// A distance field with this cell [m].
    Field(f32),
    /// A thin shell of this thickness [m].
    Sheet(f32),
}

/// Builds and rebuilds the collider of one mesh that deforms.
pub(super) struct Surface {
    making: SurfaceKind,
    voxelizer: Voxelizer,
    /// Colliders of earlier frames that were still shared when the next was built; their memory is reused.
    spare: Vec<ColliderShape>,
    /// Vertices in the anchor's space, at the current and the previous update.
    now: Vec<Vec3>,
    before: Vec<Vec3>,
    limbs: FastSurfaceProbe,
}

impl SurfaceKind {
    /// Returns an empty collider of this kind.
    pub fn nothing(self) -> ColliderShape {
        match self {
            Self::Field(_) => ColliderShape::Field(Arc::default()),
            Self::Sheet(_) => ColliderShape::Sheet(Arc::default()),
        }
    }

    /// Builds the collider of a rigid mesh.
    pub fn rigid(self, body: &Body, within: Option<(Vec3, Vec3)>) -> ColliderShape {
        let mut shape = self.nothing();
        let (positions, triangles) = (&body.mesh.positions, &body.mesh.triangles);
        self.make(&mut shape, &mut Voxelizer::default(), (positions, None), triangles, within);
        shape
    }

    /// Rebuilds `shape` from a mesh with vertices `now` and, if they moved, `before` [m].
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
                let input = VoxelizerInput {
                    previous_positions: before,
                    within,
                    ..VoxelizerInput::new(now, triangles, cell)
                };
                voxelizer.update(Arc::make_mut(grid), &input);
            }
            (Self::Sheet(thickness), ColliderShape::Sheet(sheet)) => {
                Arc::make_mut(sheet).update(now, before, triangles, within, thickness);
            }
            _ => {}
        }
    }
}

/// Returns whether a shape is not shared.
fn is_free(shape: &mut ColliderShape) -> bool {
    match shape {
        ColliderShape::Field(grid) => Arc::get_mut(grid).is_some(),
        ColliderShape::Sheet(sheet) => Arc::get_mut(sheet).is_some(),
        _ => true,
    }
}

impl Surface {
    /// Creates the surface of a body that deforms.
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
        }
    }

    /// Returns the number of time slices for a frame that ends with `body` in this pose and starts at the
    /// last update.
    pub(super) fn parts(&self, body: &Body, pose: &Pose, within: Option<(Vec3, Vec3)>) -> usize {
        if !pose.deforms(body) {
            return 1;
        }
        let place = pose.vertices(body);
        self.limbs.parts(
            &body.mesh,
            &self.now,
            |v| pose.anchor.inverse_transform_point(place(v as usize)),
            within,
        )
    }

    /// Rebuilds `shape` from `body` in the last of the poses, and its previous slices from the poses before
    /// it, at equal time slices of the frame. With `fresh`, the surface has no motion since the last update.
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

    /// Rebuilds `shape` from `body` in one pose.
    fn make(
        &mut self,
        shape: &mut ColliderShape,
        body: &Body,
        pose: &Pose,
        within: Option<(Vec3, Vec3)>,
        fresh: bool,
    ) {
        std::mem::swap(&mut self.now, &mut self.before);
        let place = pose.vertices(body);
        self.now.clear();
        self.now
            .extend((0..body.mesh.positions.len()).map(|v| pose.anchor.inverse_transform_point(place(v))));
        let moved =
            self.now.iter().zip(&self.before).map(|(a, b)| a.distance_squared(*b)).fold(0.0, f32::max);
        let (SurfaceKind::Field(fine) | SurfaceKind::Sheet(fine)) = self.making;
        if !fresh && moved < (STILL * fine).powi(2) {
            match shape {
                ColliderShape::Field(grid) if grid.deforms() => {
                    SignedDistanceField::clear_motion(Arc::make_mut(grid))
                }
                ColliderShape::Sheet(sheet) if sheet.deforms() => {
                    ThinShell::clear_motion(Arc::make_mut(sheet))
                }
                _ => {}
            }
            // Small motion is not lost: it accumulates relative to the last built surface.
            std::mem::swap(&mut self.now, &mut self.before);
            return;
        }
        let before = (!fresh).then_some(self.before.as_slice());
        // If the last shape is still shared, use another one. `make_mut` would make a copy only to overwrite
        // it.
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
    use glam::Affine3A;
    use hairspring::body::{Joint, Mesh, Skin, Trs};

    #[test]
    fn a_skinned_sheet_follows_its_joints_and_reports_its_displacement() {
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
            let pose = Pose { world: world(up).to_vec(), ..Pose::default() };
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
