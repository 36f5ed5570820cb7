//! The ground: an infinite level plane that catches shadow. Where nothing blocks the light it has the color
//! of the backdrop, or fades into it, so that no horizon is visible.
//!
//! It is lit by the key lamp and the sky only. Rim and fill are excluded, as they are flagged off the floor
//! of a studio, so that a body casts one shadow and not three.

use crate::{
    body::{SAMPLES, skin::HAIR_SHADE},
    camera::View,
    frame::{Frame, Quality},
    shadow::{Shadow, place},
};
use fearless_simd::Level;
use glam::{Vec2, Vec3, Vec3Swizzles};
use hairspring_scene::Scene;

/// The ground under a frame's bodies and hair.
///
/// The ground hides everything below it. If the camera is below the ground, the ground is invisible and hides
/// nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Height along Y [m].
    pub height: f32,
    /// Linear RGB albedo, 0 to 1. With `None`, the backdrop is unchanged where there is no shadow.
    pub color: Option<Vec3>,
}

impl Ground {
    /// The ground of a scene, if it is on.
    pub fn of(scene: &Scene) -> Option<Self> {
        let ground = scene.ground;
        let lowest = || {
            let vertices = scene.body.iter().flat_map(|body| &body.mesh.positions);
            let low = vertices.fold(f32::INFINITY, |low, p| low.min(p.y));
            if low.is_finite() { low } else { 0.0 }
        };
        ground.on.then(|| Self { height: ground.height.unwrap_or_else(lowest), color: ground.color })
    }
}

/// Distances from the center of the objects, relative to their size, between which the shadow fades out. The
/// key lamp is 37° high, so the shadow of a body ends at 1.3 times its height.
pub(crate) const FADE: [f32; 2] = [1.5, 4.0];
/// The corresponding distances for the ground's own color. The fade is slow, so that its end is invisible
/// even from a low camera.
pub(crate) const POOL: [f32; 2] = [0.0, 4.0];

/// Fraction of the key lamp's light that comes back from the surroundings: a shadow on a studio floor is not
/// black.
const ROOM: f32 = 0.25;

/// A frame's ground, as seen from a camera above it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Floor {
    pub height: f32,
    pub color: Option<Vec3>,
    /// Light of the key lamp that a white card on the ground reflects, and light of sky and surroundings,
    /// linear RGB.
    pub key: Vec3,
    pub sky: Vec3,
    /// Center of bodies and hair, X and Z, and the longest edge of their bounding box [m].
    pub middle: Vec2,
    pub extent: f32,
    /// Rectangle on the ground that contains all shadow of the key lamp: minimum and maximum X and Z [m].
    pub shade: [Vec2; 2],
}

impl Floor {
    /// `bounds`: the box of the hair, if there is any. Returns `None` if there is no ground, or if the camera
    /// is not above it.
    pub fn new(frame: &Frame, view: &View, bounds: Option<(Vec3, Vec3)>) -> Option<Self> {
        let Ground { height, color } = frame.ground_seen()?;
        let bodies = place(frame);
        let corners = bounds.into_iter().flat_map(|(low, high)| [low, high]);
        let (low, high) = bodies
            .into_iter()
            .flat_map(|(low, high)| [low, high])
            .chain(corners)
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let there = low.cmple(high).all();
        let lamps = &frame.lighting;
        // Lights that are not finite are turned off.
        let finite = |light: Vec3| if light.is_finite() { light.max(Vec3::ZERO) } else { Vec3::ZERO };
        let toward = lamps.key.direction.normalize_or(Vec3::Y);
        let key = finite(lamps.key.color) * toward.y.max(0.0);
        // Shadows are blurred beyond the boxes, by the padding of the grid and by the filter of the map.
        let Quality { shadow_voxels, shadow_texels, .. } = frame.quality;
        let wider = |(low, high): (Vec3, Vec3), by: f32| {
            let room = (high - low).max_element() * by;
            (low - Vec3::splat(room), high + Vec3::splat(room))
        };
        let boxes = bounds
            .map(|b| wider(b, 10.0 / shadow_voxels.clamp(16, 256) as f32))
            .into_iter()
            .chain(bodies.map(|b| wider(b, 40.0 / shadow_texels.clamp(64, 8192) as f32)));
        let slope = toward.xz() / toward.y.max(1e-3);
        let cast = boxes.flat_map(|(low, high)| {
            let near = slope * (low.y.max(height) - height);
            let far = slope * (high.y.max(height) - height);
            [low.xz() - near, low.xz() - far, high.xz() - near, high.xz() - far]
        });
        let none = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        let shade = cast.fold(none, |(low, high), p| (low.min(p), high.max(p)));
        Some(Self {
            height,
            color: color.map(finite),
            key,
            sky: finite(lamps.sky) + key * ROOM,
            middle: if there { 0.5 * (low + high).xz() } else { view.eye.xz() },
            extent: if there { (high - low).max_element().max(1e-3) } else { 1.0 },
            shade: [shade.0, shade.1],
        })
    }

    /// Color of the background in a pixel with its center at `at`, where `wall` is the backdrop.
    pub fn over(&self, wall: Vec3, view: &View, at: Vec2, shadow: &Shadow, level: Level) -> Vec3 {
        let ray = view.ray(at.x, at.y);
        if ray.y >= 0.0 {
            return wall;
        }
        let p = view.eye + ray * self.reach(view, ray);
        let far = self.middle.distance(p.xz()) / self.extent;
        if far.is_nan() || far >= FADE[1] {
            return wall;
        }
        let key = |p: Vec3| shadow.on_ground(level, p) * (-HAIR_SHADE * shadow.key_around(p)).exp();
        // If a pixel covers more ground than the softness of the shadow, the shadow is sampled several times,
        // as for the outlines of bodies.
        let length = p.distance(view.eye) / view.focal * ray.length() / -ray.y;
        let key = if !self.shaded(p, length) {
            1.0
        } else if length < shadow.softness() {
            key(p)
        } else {
            let [across, down] = SAMPLES;
            let sample = |(x, y): (f32, f32)| {
                let ray = view.ray(at.x + x - 0.5, at.y + y - 0.5);
                key(view.eye + ray * self.reach(view, ray))
            };
            across.into_iter().zip(down).map(sample).sum::<f32>() * 0.125
        };
        let open = shadow.contact().open(p);
        let whole = self.key + self.sky;
        let own = self.color.map_or(wall, |color| wall.lerp(color * whole, fade(far, POOL)));
        let taken = (self.key * (1.0 - key) + self.sky * (1.0 - open)) / whole.max(Vec3::splat(1e-6));
        own * (Vec3::ONE - taken * fade(far, FADE))
    }

    /// Whether the key lamp's shadow may touch a pixel that covers the given length around a point.
    fn shaded(&self, p: Vec3, length: f32) -> bool {
        let [low, high] = self.shade;
        p.xz().cmpge(low - Vec2::splat(length)).all() && p.xz().cmple(high + Vec2::splat(length)).all()
    }

    /// Distance to the ground along a ray.
    fn reach(&self, view: &View, ray: Vec3) -> f32 {
        (self.height - view.eye.y) / ray.y.min(-1e-6)
    }
}

/// 1 up to the first distance, 0 from the second on.
fn fade(far: f32, [from, to]: [f32; 2]) -> f32 {
    let share = ((far - from) / (to - from)).clamp(0.0, 1.0);
    1.0 - share * share * (3.0 - 2.0 * share)
}
