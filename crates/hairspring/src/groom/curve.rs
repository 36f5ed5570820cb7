//! Space-filling curve that orders strands by position.

use glam::Vec3;

/// A space-filling curve through a cube: places that are close on the curve are close in space (the Z-order
/// curve, Morton 1966, *A Computer Oriented Geodetic Data Base and a New Technique in File Sequencing*).
///
/// Files store strands in any order. Processing them along the curve keeps the data that they read and write
/// in cache.
///
/// ```
/// use glam::Vec3;
/// use hairspring::groom::MortonCurve;
///
/// let curve = MortonCurve::covering(Vec3::ZERO, Vec3::ONE);
/// assert!(curve.index(Vec3::splat(0.1)) < curve.index(Vec3::splat(0.9)));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct MortonCurve {
    lo: Vec3,
    /// Steps of the curve per meter [1/m].
    scale: f32,
}

/// Smallest side of the covered box that is divided by [m].
const MIN_EXTENT: f32 = 1e-9;

/// Steps of the curve along each axis: three coordinates of ten bits are interleaved into 30 bits.
const STEPS_PER_AXIS: f32 = 1024.0;

impl MortonCurve {
    /// Creates the curve through the cube that starts at `lo` and covers the box from `lo` to `hi` [m].
    pub fn covering(lo: Vec3, hi: Vec3) -> Self {
        Self { lo, scale: (STEPS_PER_AXIS - 1.0) / (hi - lo).max_element().max(MIN_EXTENT) }
    }

    /// Creates the curve through the cube around `places` [m].
    pub fn covering_points(places: impl Iterator<Item = Vec3>) -> Self {
        let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (lo, hi) = places.fold(none, |(lo, hi), place| (lo.min(place), hi.max(place)));
        Self::covering(lo, hi)
    }

    /// Returns the position of a place [m] along the curve, 0 to 2³⁰ - 1. Places outside the cube are clamped
    /// to its surface.
    pub fn index(&self, place: Vec3) -> u32 {
        let [x, y, z] = ((place - self.lo) * self.scale).to_array().map(spread);
        x | y << 1 | z << 2
    }
}

/// Inserts two zeros after each of ten bits.
fn spread(x: f32) -> u32 {
    let mut x = x.clamp(0.0, STEPS_PER_AXIS - 1.0) as u32;
    x = (x | x << 16) & 0x0300_00ff;
    x = (x | x << 8) & 0x0300_f00f;
    x = (x | x << 4) & 0x030c_30c3;
    (x | x << 2) & 0x0924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_eighth_of_the_cube_is_one_piece_of_the_curve() {
        let curve = MortonCurve::covering(Vec3::splat(-1.0), Vec3::splat(1.0));
        let mut seen: Vec<(u32, [bool; 3])> = (0..4096)
            .map(|k| {
                let place = Vec3::new((k % 16) as f32, (k / 16 % 16) as f32, (k / 256) as f32) / 7.5 - 1.0;
                (curve.index(place), place.to_array().map(|x| x > 0.0))
            })
            .collect();
        seen.sort_unstable();
        assert!(seen.windows(2).all(|w| w[0].0 < w[1].0), "two places 13 cm apart are one");
        let turns = seen.windows(2).filter(|w| w[0].1 != w[1].1).count();
        assert_eq!(turns, 7, "the curve leaves an eighth and comes back");
    }

    #[test]
    fn places_anywhere_are_on_it() {
        let curve = MortonCurve::covering_points([Vec3::ZERO, Vec3::ONE].into_iter());
        assert_eq!(curve.index(Vec3::splat(-5.0)), 0);
        assert_eq!(curve.index(Vec3::splat(5.0)), (1 << 30) - 1);
        assert_eq!(curve.index(Vec3::NAN), 0);
        assert_eq!(MortonCurve::covering_points(std::iter::empty()).index(Vec3::ONE), 0);
        assert_eq!(MortonCurve::covering_points(std::iter::once(Vec3::ONE)).index(Vec3::ONE), 0);
    }
}
