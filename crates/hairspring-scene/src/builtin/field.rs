//! The distance field in which hair is combed: distance and outward direction of the bust, sampled on a grid.

use super::{
    sdf::{ellipsoid, union},
    shape,
};
use glam::{Vec3, vec3};
use rayon::prelude::*;

/// Lowest corner of the grid [m]. The grid contains the bust and a margin of about 10 cm.
const LOW: Vec3 = vec3(-0.29, -0.33, -0.20);
/// Highest corner of the grid [m].
const HIGH: Vec3 = vec3(0.29, 0.19, 0.20);
/// Edge of a cell [m]. It resolves the gentle shapes that a comb follows; points near the skin are placed
/// exactly afterward.
pub const CELL: f32 = 0.005;

/// Distance to the bust for combing: the face and the ears are covered by a smooth shield that keeps hair out
/// of them.
pub struct Field {
    size: [usize; 3],
    values: Vec<f32>,
}

impl Field {
    /// Samples the bust.
    pub fn new() -> Self {
        let size = ((HIGH - LOW) / CELL).to_array().map(|n| n.ceil() as usize + 1);
        let mut values = vec![0.0; size[0] * size[1] * size[2]];
        values.par_chunks_mut(size[0]).enumerate().for_each(|(row, values)| {
            let (y, z) = (row % size[1], row / size[1]);
            for (x, value) in values.iter_mut().enumerate() {
                *value = shielded(LOW + vec3(x as f32, y as f32, z as f32) * CELL);
            }
        });
        Self { size, values }
    }

    /// Returns the distance [m] and unit outward direction at `p` [m], by trilinear interpolation.
    pub fn at(&self, p: Vec3) -> (f32, Vec3) {
        let limit = vec3(self.size[0] as f32, self.size[1] as f32, self.size[2] as f32) - 1.001;
        let g = ((p - LOW) / CELL).clamp(Vec3::ZERO, limit);
        let [x, y, z] = g.to_array().map(|v| v as usize);
        let f = g.fract();
        let row = |dy: usize, dz: usize| {
            let i = ((z + dz) * self.size[1] + y + dy) * self.size[0] + x;
            (self.values[i], self.values[i + 1])
        };
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let (a, b, c, d) = (row(0, 0), row(1, 0), row(0, 1), row(1, 1));
        let along = |r: (f32, f32)| mix(r.0, r.1, f.x);
        let (near, far) = (mix(along(a), along(b), f.y), mix(along(c), along(d), f.y));
        let gradient = vec3(
            mix(mix(a.1 - a.0, b.1 - b.0, f.y), mix(c.1 - c.0, d.1 - d.0, f.y), f.z),
            mix(along(b) - along(a), along(d) - along(c), f.z),
            far - near,
        );
        (mix(near, far, f.z), gradient.normalize_or(Vec3::Y))
    }
}

/// [`shape::distance`] with the face and the ears covered by shields.
fn shielded(p: Vec3) -> f32 {
    let q = vec3(p.x.abs(), p.y, p.z);
    let face = ellipsoid(q, vec3(0.0, -0.045, 0.050), vec3(0.063, 0.098, 0.066));
    let ear = ellipsoid(q, vec3(0.060, -0.008, -0.014), vec3(0.024, 0.050, 0.040));
    union(union(shape::distance(p), face, 0.03), ear, 0.02)
}
