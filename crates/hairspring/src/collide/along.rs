//! Where on a segment a collider is deepest: its ends may be outside while it cuts a corner, or holds a ball smaller than itself.

use super::{Obstacle, ObstaclePose};
use glam::Vec3;

/// Places of a segment that are looked at, its end among them. Not its beginning, which is the end of the one before or goes with the root.
const PLACES: usize = 8;

impl Obstacle {
    /// The least distance on the way from `a` to `b` [m] in the collider's own space, of the eight places at each eighth of it; negative
    /// inside. Where that is far from negative, of its middle alone.
    pub fn least_distance(&self, a: Vec3, b: Vec3) -> f32 {
        let middle = self.distance(a.midpoint(b));
        // A field's gradient is not quite of length 1: twice what could be nearer than the middle.
        if middle > a.distance(b) {
            return middle;
        }
        let places = (1..=PLACES).map(|k| a.lerp(b, k as f32 / PLACES as f32));
        places.map(|p| self.distance(p)).fold(middle, f32::min)
    }
}

impl ObstaclePose {
    /// The same in the world at the end of the substep.
    pub fn least_distance(&self, a: Vec3, b: Vec3) -> f32 {
        let own = |p: Vec3| self.end.0.transpose() * (p - self.end.1);
        self.shape.least_distance(own(a), own(b))
    }
}
