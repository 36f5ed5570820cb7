//! Projects strands to the screen, eight points at a time.

use super::{segment::Dot, shade::LANES};
use crate::camera::{NEAR, View};
use fearless_simd::{f32x8, prelude::*};
use glam::{Vec2, Vec3};

/// Maximum width of a strand on the screen [pixels].
pub(crate) const MAX_WIDTH: f32 = 512.0;
/// Offset of hair toward the camera relative to bodies [m], so that roots on the skin do not flicker.
pub(crate) const ROOT_BIAS: f32 = 1e-3;
/// Maximum distance of a drawn point from the picture's corner [pixels].
pub(crate) const MAX_PLACE: f32 = 1e6;

/// The points of one strand on the screen, as one array for each component. Point `i` has index `i + 1`. The
/// entry before the strand's first point and some entries after its last one are marked as missing, so that
/// rows can be read from any point and its neighbors.
#[derive(Debug, Default)]
pub(crate) struct Track {
    x: Vec<f32>,
    y: Vec<f32>,
    /// Fraction of the frame's depth range, 0 to 1.
    depth: Vec<f32>,
    /// Width [pixels]; below 0 if the point is missing.
    width: Vec<f32>,
}

/// Eight points in lanes.
#[derive(Clone, Copy)]
pub(crate) struct Points<S: Simd> {
    pub x: f32x8<S>,
    pub y: f32x8<S>,
    pub depth: f32x8<S>,
    /// Below 0 if the point is missing.
    pub width: f32x8<S>,
}

/// Parameters of the projection.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection {
    pub view: View,
    /// Nearest and farthest depth of hair [m].
    pub depths: [f32; 2],
    /// Size [pixels] of a radius of 1 m at a distance of 1 m.
    pub scale: f32,
    /// Height below which a strand has no width, so that it ends at the ground [m].
    pub low: f32,
}

impl Track {
    /// Projects a strand. Points that are not finite, behind the camera or far outside the picture are marked
    /// as missing.
    #[inline(always)]
    pub fn project<S: Simd>(&mut self, simd: S, by: &Projection, points: &[Vec3], radii: &[f32]) {
        let n = points.len();
        // Up to three entries after the last whole row are read.
        let places = n.next_multiple_of(LANES) + LANES + 3;
        if self.width.len() < places {
            for row in [&mut self.x, &mut self.y, &mut self.depth, &mut self.width] {
                row.resize(places, 0.0);
            }
        }
        self.width[0] = -1.0;
        self.width[places - LANES - 2..places].fill(-1.0);
        let View { eye, right, up, forward, focal, center } = by.view;
        let [near, far] = by.depths;
        let per_depth = 1.0 / (far - near);
        for first in (0..n).step_by(LANES) {
            let mut p = [[0.0; LANES]; 3];
            let mut radius = [-1.0; LANES];
            for (lane, i) in (first..n).take(LANES).enumerate() {
                let [x, y, z] = points[i].to_array();
                (p[0][lane], p[1][lane], p[2][lane]) = (x, y, z);
                radius[lane] = radii[i];
            }
            let from = [
                f32x8::simd_from(simd, p[0]) - eye.x,
                f32x8::simd_from(simd, p[1]) - eye.y,
                f32x8::simd_from(simd, p[2]) - eye.z,
            ];
            let above = f32x8::simd_from(simd, p[1]).simd_ge(by.low);
            let z = dot(from, forward);
            let closeness = f32x8::splat(simd, 1.0) / z;
            let at_x = dot(from, right) * closeness * focal + center[0];
            let at_y = dot(from, up) * closeness * -focal + center[1];
            let width = f32x8::simd_from(simd, radius) * closeness * by.scale;
            // Comparisons with NaN are false.
            let there = z.simd_gt(NEAR)
                & at_x.abs().simd_lt(MAX_PLACE)
                & at_y.abs().simd_lt(MAX_PLACE)
                & width.simd_ge(0.0);
            let depth = ((z - (ROOT_BIAS + near)) * per_depth).max(0.0).min(1.0);
            let width = above.select(width.min(MAX_WIDTH), f32x8::splat(simd, 0.0));
            let width = there.select(width, f32x8::splat(simd, -1.0));
            at_x.store_slice(&mut self.x[first + 1..][..LANES]);
            at_y.store_slice(&mut self.y[first + 1..][..LANES]);
            depth.store_slice(&mut self.depth[first + 1..][..LANES]);
            width.store_slice(&mut self.width[first + 1..][..LANES]);
        }
    }

    /// The eight points from index `first` − 1 on.
    #[inline(always)]
    pub fn before<S: Simd>(&self, simd: S, first: usize) -> Points<S> {
        let range = first..first + LANES;
        Points {
            x: f32x8::from_slice(simd, &self.x[range.clone()]),
            y: f32x8::from_slice(simd, &self.y[range.clone()]),
            depth: f32x8::from_slice(simd, &self.depth[range.clone()]),
            width: f32x8::from_slice(simd, &self.width[range]),
        }
    }

    /// Position of a point [pixels].
    #[inline(always)]
    pub fn at(&self, i: usize) -> Vec2 {
        Vec2::new(self.x[i + 1], self.y[i + 1])
    }

    /// Writes the strand's points. Slots without a point are marked as ends.
    #[inline(always)]
    pub fn store(&self, dots: &mut [Dot]) {
        for (i, dot) in dots.iter_mut().enumerate() {
            let (here, next) = (self.width[i + 1], self.width[i + 2]);
            let linked = here >= 0.0 && next >= 0.0;
            *dot = Dot::new(self.at(i), self.depth[i + 1], here.max(0.0), linked);
        }
    }
}

// Helpers are functions with `inline(always)` and not closures, so that they are compiled for the selected
// instruction set.
#[inline(always)]
fn dot<S: Simd>([x, y, z]: [f32x8<S>; 3], d: Vec3) -> f32x8<S> {
    x * d.x + y * d.y + z * d.z
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::{Level, dispatch};
    use hairspring_scene::Camera;

    #[test]
    fn points_are_projected_as_the_camera_defines() {
        let view = View::new(&Camera::default(), 640, 480);
        let by = Projection { view, depths: [0.5, 3.0], scale: 2.0 * view.focal, low: f32::NEG_INFINITY };
        let mut points: Vec<Vec3> =
            (0..21).map(|i| Vec3::new(0.01 * i as f32, 0.1 - 0.003 * (i * i) as f32, 0.02)).collect();
        points[4].y = f32::NAN;
        points[9] = view.eye - view.forward;
        let radii = [1e-3; 21];
        let (mut track, mut dots) = (Track::default(), [Dot::END; 24]);
        let level = Level::new();
        dispatch!(level, simd => track.project(simd, &by, &points, &radii));
        track.store(&mut dots);
        for (i, (p, dot)) in points.iter().zip(&dots).enumerate() {
            assert_eq!(dot.linked(), ![3, 4, 8, 9, 20].contains(&i), "point {i}");
            if ![4, 9].contains(&i) {
                let q = view.project(*p);
                assert!(dot.at.distance(q.truncate()) < 1e-3, "point {i}: {} in place of {q}", dot.at);
                assert!((dot.width() - 2e-3 * view.focal / q.z).abs() < 1e-4);
                assert!((dot.depth - (q.z - ROOT_BIAS - 0.5) / 2.5).abs() < 1e-5);
            }
        }
        assert!(dots[21..].iter().all(|dot| !dot.linked()));
    }
}
