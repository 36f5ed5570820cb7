//! The ball that is pushed through hair, as it is drawn.

use glam::Vec3;
use hairspring::body::Part;
use hairspring_view::MeshDraw;
use std::{f32::consts::PI, sync::LazyLock};

/// Corners from pole to pole, and around.
const ROWS: u32 = 24;
const COLUMNS: u32 = 48;

/// A ball at a place.
pub struct Ball {
    positions: Vec<Vec3>,
}

/// A ball of radius 1 around the origin.
struct Unit {
    corners: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// Pale and matt, so that hair is seen on it.
    cloth: [Part; 1],
}

static UNIT: LazyLock<Unit> = LazyLock::new(|| {
    let corner = |k: u32| {
        let (row, column) = (k / COLUMNS, k % COLUMNS);
        let (down, around) = (PI * row as f32 / ROWS as f32, 2.0 * PI * column as f32 / COLUMNS as f32);
        Vec3::new(down.sin() * around.sin(), down.cos(), down.sin() * around.cos())
    };
    let square = |k: u32| {
        let (row, column) = (k / COLUMNS, k % COLUMNS);
        let at = |down: u32, right: u32| (row + down) * COLUMNS + (column + right) % COLUMNS;
        [[at(0, 0), at(1, 0), at(1, 1)], [at(0, 0), at(1, 1), at(0, 1)]]
    };
    let triangles: Vec<_> = (0..ROWS * COLUMNS).flat_map(square).collect();
    let all = 0..triangles.len() as u32;
    let cloth =
        Part { name: "ball".into(), triangles: all, color: Vec3::new(0.5, 0.52, 0.55), roughness: 0.6 };
    Unit { corners: (0..(ROWS + 1) * COLUMNS).map(corner).collect(), triangles, cloth: [cloth] }
});

impl Ball {
    /// Around `center`, of this radius [m].
    pub fn new((center, radius): (Vec3, f32)) -> Self {
        Self { positions: UNIT.corners.iter().map(|p| center + *p * radius).collect() }
    }

    /// To draw.
    pub fn mesh(&self) -> MeshDraw<'_> {
        MeshDraw {
            positions: &self.positions,
            normals: &UNIT.corners,
            triangles: &UNIT.triangles,
            parts: &UNIT.cloth,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_triangles_look_outward_and_close_it() {
        let ball = Ball::new((Vec3::X, 0.5));
        let mut volume = 0.0;
        for t in &UNIT.triangles {
            let [a, b, c] = t.map(|i| ball.positions[i as usize] - Vec3::X);
            volume += a.dot(b.cross(c)) / 6.0;
        }
        let round = 4.0 / 3.0 * PI * 0.125;
        assert!(volume > 0.98 * round && volume < round, "{volume} of {round}");
    }
}
