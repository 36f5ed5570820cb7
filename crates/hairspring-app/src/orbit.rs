//! The camera of the window: it orbits around a target, pans and zooms.

use glam::{Vec2, Vec3};
use hairspring_scene::Camera;

/// Minimum distance to the target [m].
const NEAREST: f32 = 0.02;
/// Maximum distance [m].
const FARTHEST: f32 = 100.0;
/// Maximum elevation [rad]. Looking straight down has no up direction.
const STEEPEST: f32 = 1.5;

/// Aspect ratio below which the horizontal field of view is kept constant, so that narrow pictures in a
/// comparison show the hair of both heads.
pub const NARROW: f32 = 0.85;

/// A camera that orbits around a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Target [m].
    pub target: Vec3,
    /// Azimuth around the vertical, from +Z to +X [rad].
    pub turn: f32,
    /// Elevation above the horizon [rad].
    pub rise: f32,
    /// Distance [m].
    pub distance: f32,
    /// Vertical field of view [degrees].
    pub fov: f32,
}

impl Orbit {
    /// Creates the orbit of this camera.
    pub fn new(camera: &Camera) -> Self {
        let back = camera.position - camera.target;
        let distance = back.length().clamp(NEAREST, FARTHEST);
        let rise = (back.y / distance).clamp(-1.0, 1.0).asin().clamp(-STEEPEST, STEEPEST);
        Self { target: camera.target, turn: back.x.atan2(back.z), rise, distance, fov: camera.fov }
    }

    /// The camera.
    pub fn camera(&self) -> Camera {
        let (sin, cos) = self.rise.sin_cos();
        let back = Vec3::new(self.turn.sin() * cos, sin, self.turn.cos() * cos);
        Camera {
            position: self.target + back * self.distance,
            target: self.target,
            fov: self.fov,
            ..Camera::default()
        }
    }

    /// The camera for a picture with this aspect ratio.
    pub fn seen(&self, aspect: f32) -> Camera {
        let slope = (0.5 * self.fov.to_radians()).tan() * (NARROW / aspect).max(1.0);
        let fov = if aspect < NARROW { 2.0 * slope.atan().to_degrees() } else { self.fov };
        Camera { fov, ..self.camera() }
    }

    /// Rotates by a drag, given in fractions of the picture's height.
    pub fn drag(&mut self, by: Vec2) {
        self.turn -= by.x * 3.0;
        self.rise = (self.rise + by.y * 3.0).clamp(-STEEPEST, STEEPEST);
    }

    /// Pans so that the target stays under the pointer, for a picture with this aspect ratio. `by` is in
    /// fractions of its height.
    pub fn pan(&mut self, by: Vec2, aspect: f32) {
        let lens = Lens::new(&self.seen(aspect), aspect);
        let size = 2.0 * self.distance * lens.slope;
        self.target += (lens.up * by.y - lens.right * by.x) * size;
    }

    /// Zooms in (above 1) or out.
    pub fn zoom(&mut self, factor: f32) {
        if factor.is_finite() && factor > 0.0 {
            self.distance = (self.distance / factor).clamp(NEAREST, FARTHEST);
        }
    }
}

/// Maps points to the picture and back. Picture coordinates: (0, 0) is the top left corner, (1, 1) the bottom
/// right.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    eye: Vec3,
    right: Vec3,
    up: Vec3,
    forward: Vec3,
    /// Slope of the ray through the picture's upper edge.
    slope: f32,
    aspect: f32,
}

impl Lens {
    /// Creates the lens of a camera, for a picture with this aspect ratio.
    pub fn new(camera: &Camera, aspect: f32) -> Self {
        let forward = (camera.target - camera.position).try_normalize().unwrap_or(Vec3::NEG_Z);
        let side = if forward.y.abs() > 0.9999 { Vec3::Z } else { Vec3::Y };
        let right = forward.cross(side).normalize_or(Vec3::X);
        let slope = (0.5 * camera.fov.to_radians()).tan();
        Self { eye: camera.position, right, up: right.cross(forward), forward, slope, aspect }
    }

    /// The up direction in the picture.
    pub fn up(&self) -> Vec3 {
        self.up
    }

    /// Position of the camera [m].
    pub fn eye(&self) -> Vec3 {
        self.eye
    }

    /// Picture coordinates and depth [m] of a point; `None` behind the camera.
    pub fn project(&self, p: Vec3) -> Option<(Vec2, f32)> {
        let d = p - self.eye;
        let depth = d.dot(self.forward);
        // NaN is rejected too.
        if depth.is_nan() || depth <= 1e-3 {
            return None;
        }
        let scale = 0.5 / (depth * self.slope);
        let at = Vec2::new(0.5 + d.dot(self.right) * scale / self.aspect, 0.5 - d.dot(self.up) * scale);
        Some((at, depth))
    }

    /// The ray through a point of the picture: its origin, and its direction with length 1 along the optical
    /// axis.
    pub fn ray(&self, at: Vec2) -> (Vec3, Vec3) {
        let [x, y] = [(at.x - 0.5) * 2.0 * self.slope * self.aspect, (0.5 - at.y) * 2.0 * self.slope];
        (self.eye, self.forward + self.right * x + self.up * y)
    }

    /// Depth of a point [m].
    pub fn depth(&self, p: Vec3) -> f32 {
        (p - self.eye).dot(self.forward)
    }

    /// The right direction in the picture.
    pub fn right(&self) -> Vec3 {
        self.right
    }

    /// Pixels per meter at `depth` [m], for a picture of this height [pixels].
    pub fn scale(&self, depth: f32, height: f32) -> f32 {
        0.5 * height / (depth * self.slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_orbit_gives_back_its_camera() {
        let camera = Camera::default();
        let back = Orbit::new(&camera).camera();
        assert!(back.position.distance(camera.position) < 1e-5 && back.target == camera.target);
    }

    #[test]
    fn a_ray_passes_through_the_projected_point() {
        let lens = Lens::new(&Camera::default(), 1.6);
        let p = Camera::default().target + Vec3::new(0.07, -0.04, 0.05);
        let (at, depth) = lens.project(p).unwrap();
        let (from, way) = lens.ray(at);
        assert!((from + way * depth).distance(p) < 1e-5);
    }

    #[test]
    fn the_target_stays_under_the_pointer_while_panning() {
        for aspect in [1.0, 0.5] {
            let mut orbit = Orbit::new(&Camera::default());
            let p = orbit.target;
            orbit.pan(Vec2::new(0.2 * aspect, 0.1), aspect);
            let (at, _) = Lens::new(&orbit.seen(aspect), aspect).project(p).unwrap();
            assert!(at.distance(Vec2::new(0.7, 0.6)) < 1e-3, "{at}");
        }
    }

    #[test]
    fn a_narrow_picture_keeps_the_horizontal_field_of_view() {
        let orbit = Orbit::new(&Camera::default());
        let across = |aspect: f32| {
            let (_, way) = Lens::new(&orbit.seen(aspect), aspect).ray(Vec2::new(1.0, 0.5));
            way.distance(Lens::new(&orbit.camera(), 1.0).ray(Vec2::new(0.5, 0.5)).1)
        };
        assert!((across(0.4) - across(NARROW)).abs() < 1e-5);
        assert!(across(1.6) > 1.8 * across(NARROW) && orbit.seen(1.6).fov == orbit.fov);
    }
}
