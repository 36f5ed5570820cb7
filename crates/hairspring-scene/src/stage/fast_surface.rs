//! Detects surfaces of a skinned body, or a skinned thin shell, that move fast through hair relative to their
//! thickness.
//!
//! ```text
//!   before │  │ now        a point of the skin, its normal n, its displacement s in the frame, and the thickness T along −n,
//!       ◄──┼T─┤►           found by a ray through the body at rest:
//!          │s·n│              the frame is divided into enough time slices to keep |s·n| below a fraction of T/2 in each
//! ```
//!
//! A collider is built for each time slice, from the body's pose at its end. With a single collider at the
//! end of the frame, a fast hand would jump to the other side of the hair without touching it. For rigid
//! bodies, shorter substeps do the same (`simulation/substeps.rs`). Time slices are expensive, since building
//! a field takes longer than a substep. Therefore only motion along the normal counts, and only where hair
//! can be. The half-thickness of a thin shell is the distance that it extends to each side.

use super::thickness::{Place, normal, places, thicknesses};
use glam::Vec3;
use hairspring::{body::Mesh, simulation::MAX_TRAVEL};

/// Edge of the sampling cubes, in cells of the field [1]: two cubes across a finger. In each cube, one
/// triangle is sampled for each direction.
const SPACING: f32 = 3.0;

/// Maximum number of time slices for a closed mesh, each of which needs a distance field. A hand 2 cm thick
/// reaches it at 5 m/s and 30 frames per second.
const MOST: f32 = 32.0;

/// Maximum number of time slices for a thin shell, which is faster to build. At 5 m/s and 60 frames per
/// second, a shell of 2 mm then moves by two thirds of its thickness in each.
const MOST_OF_SHEET: f32 = 64.0;

/// Sample points of a skinned mesh.
pub(super) struct FastSurfaceProbe {
    probes: Vec<Probe>,
    /// Maximum number of time slices.
    most: f32,
}

struct Probe {
    triangle: u32,
    /// Half of the thickness of the body behind it [m], at least one cell of its field, which is about its
    /// resolution. Meshes may have folds, and nails inside of fingers.
    half: f32,
}

impl FastSurfaceProbe {
    /// Creates the samples of a closed `mesh` in the rest pose. `cell` is the cell of its field [m].
    pub fn of_solid(mesh: &Mesh, cell: f32) -> Self {
        let probe =
            |((triangle, ..), thickness): (Place, f32)| Probe { triangle, half: (0.5 * thickness).max(cell) };
        let probes = thicknesses(mesh, SPACING * cell, 1e-3 * cell).into_iter().map(probe).collect();
        Self { probes, most: MOST }
    }

    /// Creates the samples of an open `mesh` in the rest pose that extends by `thickness` [m] to both sides.
    pub fn of_sheet(mesh: &Mesh, thickness: f32) -> Self {
        let probe = |(triangle, ..): Place| Probe { triangle, half: thickness };
        let probes = places(mesh, 2.0 * SPACING * thickness).into_iter().map(probe).collect();
        Self { probes, most: MOST_OF_SHEET }
    }

    /// Returns the number of time slices for a frame. The body moves from the vertices `before` to
    /// those that `place` returns, both in the anchor's space. Surfaces outside the box `within`, where
    /// the hair is, do not count.
    pub fn parts(
        &self,
        mesh: &Mesh,
        before: &[Vec3],
        place: impl Fn(u32) -> Vec3,
        within: Option<(Vec3, Vec3)>,
    ) -> usize {
        let ask = |probe: &Probe| {
            let triangle = mesh.triangles[probe.triangle as usize];
            let old = triangle.map(|v| before[v as usize]);
            let now = triangle.map(&place);
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

    /// A square tube of 2 cm along X, from 0 to 8 cm.
    fn finger() -> Mesh {
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
        Mesh { positions, triangles, ..Mesh::default() }
    }

    /// Its vertices with the far half moved.
    fn bent(mesh: &Mesh, moved: Vec3) -> impl Fn(u32) -> Vec3 {
        move |v| mesh.positions[v as usize] + if v >= 20 { moved } else { Vec3::ZERO }
    }

    #[test]
    fn only_fast_motion_across_a_limb_near_hair_needs_time_slices() {
        let mesh = finger();
        let limbs = FastSurfaceProbe::of_solid(&mesh, 0.002);
        let parts = |moved: Vec3, within: Option<(Vec3, Vec3)>| {
            limbs.parts(&mesh, &mesh.positions, bent(&mesh, moved), within)
        };
        // 2 cm thick: half a centimeter for each slice.
        assert_eq!(parts(Vec3::ZERO, None), 1);
        assert_eq!(parts(Vec3::Y * 0.004, None), 1);
        assert_eq!(parts(Vec3::Y * 0.019, None), 4);
        assert_eq!(parts(Vec3::Z * -0.031, None), 7);
        assert_eq!(parts(Vec3::Y * 9.0, None), MOST as usize);
        // Along its axis it is 8 cm long.
        assert_eq!(parts(Vec3::X * 0.019, None), 1);
        let far = Vec3::splat(0.5);
        assert_eq!(parts(Vec3::Y * 0.019, Some((far, far + 1.0))), 1);
        // It passes through the box.
        assert_eq!(parts(Vec3::Y * 0.019, Some((Vec3::new(-1.0, 0.025, -1.0), Vec3::ONE))), 4);
    }

    #[test]
    fn the_thickness_of_a_sheet_determines_its_time_slices() {
        let mesh = finger();
        let sheet = FastSurfaceProbe::of_sheet(&mesh, 0.002);
        let parts = |moved: Vec3| sheet.parts(&mesh, &mesh.positions, bent(&mesh, moved), None);
        // A millimeter for each slice.
        assert_eq!(parts(Vec3::Y * 0.0009), 1);
        assert_eq!(parts(Vec3::Y * 0.0195), 20);
        assert_eq!(parts(Vec3::Y * 9.0), MOST_OF_SHEET as usize);
    }
}
