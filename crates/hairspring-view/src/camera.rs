//! Perspective projection from meters to pixels, and automatic framing of a scene.

use glam::Vec3;
use hairspring_scene::Camera;

/// Near plane [m]: closer than a camera could focus.
pub(crate) const NEAR: f32 = 0.01;

/// A camera prepared for one picture size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    pub eye: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
    /// Pixels per unit of slope.
    pub focal: f32,
    /// Pixel coordinates of the optical axis.
    pub center: [f32; 2],
}

/// Position of the camera. If it is not finite, the position of the default camera.
pub(crate) fn eye(camera: &Camera) -> Vec3 {
    if camera.position.is_finite() { camera.position } else { Camera::default().position }
}

impl View {
    /// Invalid settings (zero distance, not finite) give the direction of the default camera.
    pub fn new(camera: &Camera, width: u32, height: u32) -> Self {
        let eye = eye(camera);
        let forward = (camera.target - eye).try_normalize().unwrap_or(Vec3::NEG_Z);
        let side = if forward.y.abs() > 0.9999 { Vec3::Z } else { Vec3::Y };
        let right = forward.cross(side).normalize();
        let fov = if camera.fov.is_finite() { camera.fov.clamp(1.0, 170.0) } else { Camera::default().fov };
        Self {
            eye,
            right,
            up: right.cross(forward),
            forward,
            focal: 0.5 * height as f32 / (0.5 * fov.to_radians()).tan(),
            center: [0.5 * width as f32, 0.5 * height as f32],
        }
    }

    /// `(x, y, depth)`: pixels from the top left corner, and meters along the optical axis.
    pub fn project(&self, p: Vec3) -> Vec3 {
        let d = p - self.eye;
        let depth = d.dot(self.forward);
        let scale = self.focal / depth;
        Vec3::new(self.center[0] + scale * d.dot(self.right), self.center[1] - scale * d.dot(self.up), depth)
    }

    /// Direction through a pixel position. Its component along the optical axis is 1.
    pub fn ray(&self, x: f32, y: f32) -> Vec3 {
        self.forward + self.right * ((x - self.center[0]) / self.focal)
            - self.up * ((y - self.center[1]) / self.focal)
    }
}

/// Returns a camera that shows the whole box `bounds` (min, max) [m] in a picture with aspect ratio `aspect`
/// (width over height): a 30° portrait lens, slightly to the side of the +Z axis and slightly above, as in
/// [`Camera::default`].
pub fn frame_camera(bounds: (Vec3, Vec3), aspect: f32) -> Camera {
    let default = Camera::default();
    let (low, high) = bounds;
    let target = 0.5 * (low + high);
    let back = (default.position - default.target).normalize();
    if !(low.is_finite() && high.is_finite() && aspect > 0.0) {
        return default;
    }
    let view = View::new(
        &Camera { position: target + back, target, fov: default.fov, ..Camera::default() },
        1000,
        1000,
    );
    // The distance from which every corner is inside the picture, with a margin of 8 %.
    let half = (0.5 * default.fov.to_radians()).tan() / 1.08;
    let mut distance = 0.0f32;
    for i in 0..8 {
        let corner = Vec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), low, high) - target;
        let toward = corner.dot(back);
        let across = corner.dot(view.right).abs() / aspect.min(1e3);
        distance = distance.max(toward + across.max(corner.dot(view.up).abs()) / half);
    }
    Camera {
        position: target + back * distance.max(4.0 * NEAR),
        target,
        fov: default.fov,
        ..Camera::default()
    }
}
