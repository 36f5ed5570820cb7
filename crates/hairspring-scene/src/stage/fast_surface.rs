//! How fast the limbs of a skinned body, or a skinned sheet, go through hair, against how thick they are.
//!
//! ```text
//!   before │  │ now        a place of the skin, its normal n, its way s in the frame, and the thickness T along −n, which a ray
//!       ◄──┼T─┤►           through the body at rest finds:
//!          │s·n│              the frame is cut into as many parts as it takes to keep |s·n| below a part of T/2 in each
//! ```
//!
//! A collider is made for each part, of the body as it is then: at the end of the frame alone, a hand would be on the other side of the hair before it met it. It is what
//! shorter substeps are for a body that moves as one piece (`simulation/substeps.rs`), but dear, since a field takes longer than a substep does. So only
//! what goes across itself counts, where hair can be. A sheet is half as thick as it reaches to both sides.

use super::thickness::{Place, normal, places, thicknesses};
use glam::{Affine3A, Vec3};
use hairspring::{
    body::{Mesh, Skin},
    math::RigidTransform,
    simulation::MAX_TRAVEL,
};

/// Edge of the cubes that one triangle for each way it may face stands for, over the edge of the field's cells [1]: two to a finger.
const SPACING: f32 = 3.0;

/// Most parts of a frame that limbs ask for: each takes a distance field. A hand, 2 cm thick, asks for so many at 5 m/s and 30 frames a second.
const MOST: f32 = 32.0;

/// Most parts of a frame that a sheet asks for, which is made sooner: 2 mm thick, at 5 m/s and 60 frames a second, it then moves by two thirds of that in each.
const MOST_OF_SHEET: f32 = 64.0;

/// Places of a skinned mesh that are looked at.
pub(super) struct FastSurfaceProbe {
    probes: Vec<Probe>,
    /// Most parts that they ask for.
    most: f32,
}

struct Probe {
    triangle: u32,
    /// Half of how thick the body is behind it [m], or a cell of its field, which is about what that knows: meshes have folds, and nails within fingers.
    half: f32,
}

impl FastSurfaceProbe {
    /// Those of a closed `mesh` in the rest pose whose field has cells of `cell` [m].
    pub fn of_solid(mesh: &Mesh, cell: f32) -> Self {
        let probe =
            |((triangle, ..), thickness): (Place, f32)| Probe { triangle, half: (0.5 * thickness).max(cell) };
        let probes = thicknesses(mesh, SPACING * cell, 1e-3 * cell).into_iter().map(probe).collect();
        Self { probes, most: MOST }
    }

    /// Those of an open `mesh` in the rest pose that reaches `thickness` [m] to both sides.
    pub fn of_sheet(mesh: &Mesh, thickness: f32) -> Self {
        let probe = |(triangle, ..): Place| Probe { triangle, half: thickness };
        let probes = places(mesh, 2.0 * SPACING * thickness).into_iter().map(probe).collect();
        Self { probes, most: MOST_OF_SHEET }
    }

    /// Into how many parts a frame is to be cut in which the body goes from vertices `before`, in the anchor's space, to where its joints and the anchor are now; what stays
    /// out of the box `within`, where hair is, does not count.
    pub fn parts(
        &self,
        (mesh, skin): (&Mesh, &Skin),
        before: &[Vec3],
        (world, anchor): (&[Affine3A], RigidTransform),
        within: Option<(Vec3, Vec3)>,
    ) -> usize {
        let matrices = skin.matrices(world);
        let place = |v: u32| skin.place(v as usize, mesh.positions[v as usize], &matrices);
        let ask = |probe: &Probe| {
            let triangle = mesh.triangles[probe.triangle as usize];
            let old = triangle.map(|v| before[v as usize]);
            let now = triangle.map(|v| anchor.inverse_point(place(v)));
            let all = || old.iter().chain(&now);
            let lo = all().fold(Vec3::INFINITY, |lo, p| lo.min(*p));
            let hi = all().fold(Vec3::NEG_INFINITY, |hi, p| hi.max(*p));
            let reached = within.is_none_or(|(a, b)| lo.cmple(b).all() && hi.cmpge(a).all());
            let Some(normal) = normal(now).filter(|_| reached) else { return 0.0 };
            let way = now.iter().zip(&old).map(|(a, b)| normal.dot(*a - *b).abs()).fold(0.0, f32::max);
            way / (MAX_TRAVEL * probe.half)
        };
        self.probes.iter().map(ask).fold(1.0, f32::max).min(self.most).ceil() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tube of 2 cm with square ends along X, from 0 to 8 cm, whose far half a joint moves.
    fn finger() -> (Mesh, Skin) {
        let ring = |k: u32| {
            let x = 0.01 * k as f32;
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(move |(y, z)| Vec3::new(x, 0.01 * y, 0.01 * z))
        };
        let positions: Vec<Vec3> = (0..9).flat_map(ring).collect();
        let mut triangles = vec![[0, 2, 1], [0, 3, 2], [32, 33, 34], [32, 34, 35]];
        for first in (0..8u32).map(|k| 4 * k) {
            for side in 0..4u32 {
                let [a, b] = [first + side, first + (side + 1) % 4];
                triangles.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
            }
        }
        let skin = Skin {
            joints: (0..36).map(|v| [u16::from(v >= 20), 0, 0, 0]).collect(),
            weights: vec![[1.0, 0.0, 0.0, 0.0]; 36],
            inverse_bind: vec![Affine3A::IDENTITY; 2],
        };
        (Mesh { positions, triangles, ..Mesh::default() }, skin)
    }

    #[test]
    fn only_what_goes_across_itself_near_hair_asks_for_parts() {
        let (mesh, skin) = finger();
        let limbs = FastSurfaceProbe::of_solid(&mesh, 0.002);
        let parts = |moved: Vec3, within: Option<(Vec3, Vec3)>| {
            let world = [Affine3A::IDENTITY, Affine3A::from_translation(moved)];
            limbs.parts((&mesh, &skin), &mesh.positions, (&world, RigidTransform::default()), within)
        };
        // 2 cm thick: half a centimetre a part.
        assert_eq!(parts(Vec3::ZERO, None), 1);
        assert_eq!(parts(Vec3::Y * 0.004, None), 1);
        assert_eq!(parts(Vec3::Y * 0.019, None), 4);
        assert_eq!(parts(Vec3::Z * -0.031, None), 7);
        assert_eq!(parts(Vec3::Y * 9.0, None), MOST as usize);
        // Along itself it is 8 cm long.
        assert_eq!(parts(Vec3::X * 0.019, None), 1);
        let far = Vec3::splat(0.5);
        assert_eq!(parts(Vec3::Y * 0.019, Some((far, far + 1.0))), 1);
        // On its way past.
        assert_eq!(parts(Vec3::Y * 0.019, Some((Vec3::new(-1.0, 0.025, -1.0), Vec3::ONE))), 4);
    }

    #[test]
    fn a_sheet_asks_for_parts_by_its_thickness() {
        let (mesh, skin) = finger();
        let sheet = FastSurfaceProbe::of_sheet(&mesh, 0.002);
        let parts = |moved: Vec3| {
            let world = [Affine3A::IDENTITY, Affine3A::from_translation(moved)];
            sheet.parts((&mesh, &skin), &mesh.positions, (&world, RigidTransform::default()), None)
        };
        // A millimetre a part.
        assert_eq!(parts(Vec3::Y * 0.0009), 1);
        assert_eq!(parts(Vec3::Y * 0.0195), 20);
        assert_eq!(parts(Vec3::Y * 9.0), MOST_OF_SHEET as usize);
    }
}
