//! Turbulence: divergence-free curl noise.
//!
//! ```text
//! v = ∇ × ψ,   ψ = Σ over the 8 corners c of a cell:  w_c(x) A_c(t) (x − c)        (Bridson 2007, Curl-Noise for Procedural Fluid Flow, eq. 1)
//!   = Σ ∇w_c × A_c (x − c)  +  w_c ω_c,                ω_c = ∇ × A_c x
//! ```
//!
//! ψ is gradient noise (Perlin 2002). Each node of a lattice has three gradients, the rows of A, and w is
//! Perlin's quintic weight, so v is smooth. The curl is evaluated analytically, so the divergence is 0 up to
//! rounding. The noise moves in two ways. The directional wind, gusts included, carries it as a whole. The
//! gradients also rotate (Perlin & Neyret 2001, *Flow Noise*), by one radian in the turnover time ℓ/u of an
//! eddy of size ℓ and speed u. Each octave halves the size of the eddies; their speed follows Kolmogorov
//! 1941, u ~ ℓ^(1/3).
//!
//! # Limitations
//! Wind sources do not carry the noise along, and bodies do not stop it (Bridson 2007, §2.4: ψ ramped to 0 at
//! a wall).

use crate::settings::{When, define_settings};
use glam::{DVec3, IVec3, Mat3, Vec3};

/// Largest number of octaves, as in the range of [`Turbulence::octaves`].
const MAX_OCTAVES: u32 = 6;

/// Smallest eddy size [m].
const MIN_SIZE: f32 = 1e-6;

/// The condition under which the shape of the eddies has an effect.
const IS_TURBULENT: When = When::Above0("turbulence.strength");

define_settings! {
    /// Parameters of the turbulence.
    ///
    /// ```
    /// use hairspring::air::Turbulence;
    ///
    /// let gusty = Turbulence { strength: 1.5, ..Default::default() };
    /// assert!(gusty.is_on() && !Turbulence::default().is_on());
    /// ```
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Turbulence {
        /// Root mean square of the turbulent velocity. 0: none. Outdoors it is a tenth to a third of the wind
        /// speed.
        strength: f32 = 0.0, ["m/s"], {0 to 1000};
        /// Size of the largest eddies. The default is half a head, so that it moves whole locks rather than single
        /// hairs.
        size: f32 = 0.1, ["m"], {1e-6 to 1000000}, when IS_TURBULENT;
        /// Number of octaves: eddy sizes, each half as large as the one before. With the default, further octaves
        /// would be smaller than a lock.
        octaves: u32 = 2, "sizes", {1 to 6}, when IS_TURBULENT;
    }
}

impl Turbulence {
    /// Returns whether there is any turbulence.
    pub fn is_on(&self) -> bool {
        self.strength > 0.0
    }
}

/// Period of the noise along each axis in lattice nodes, and the number of gradient sets. A power of two.
const PERIOD: usize = 256;

/// Root mean square of the curl of noise whose gradient components have variance 1: the square root of the
/// mean over a cell of Σ 2|∇w|²|d|² + 4w ∇w·d + 6w², d = x − c.
const RMS: f32 = 2.1132;

/// The matrix A of a lattice node, and the curl of A x.
#[derive(Clone, Copy)]
struct Corner {
    a: Mat3,
    curl: Vec3,
}

/// One octave of the noise in a frame.
#[derive(Clone, Copy)]
struct Octave {
    /// Reciprocal of the eddy size [1/m].
    scale: f32,
    /// Factor from noise whose gradient components have variance 1 to velocity [m/s].
    speed: f32,
    /// Displacement by the wind [eddy sizes], modulo the period.
    way: Vec3,
}

/// The turbulence of a frame.
#[derive(Default)]
pub(crate) struct Noise {
    octaves: Vec<Octave>,
    /// Shape `[octaves][PERIOD]`.
    corners: Vec<Corner>,
}

impl Noise {
    /// Sets the noise for `time` [s], after the wind has carried it by `way` [m].
    pub fn set(&mut self, settings: &Turbulence, way: DVec3, time: f64) {
        self.octaves.clear();
        self.corners.clear();
        let octaves = settings.octaves.clamp(1, MAX_OCTAVES);
        // Kolmogorov spectrum: u² is proportional to ℓ^(2/3).
        let share = |k: u32| 2f32.powf(-2.0 / 3.0 * k as f32);
        let all: f32 = (0..octaves).map(share).sum();
        for k in 0..octaves {
            let size = settings.size.max(MIN_SIZE) / (1 << k) as f32;
            let speed = settings.strength * (share(k) / all).sqrt();
            let cells = way / f64::from(size);
            let period = DVec3::splat(PERIOD as f64);
            let way = (cells - period * (cells / period).floor()).as_vec3();
            self.octaves.push(Octave { scale: 1.0 / size, speed: speed / RMS, way });
            let turned = f64::from(speed / size) * time;
            self.corners.extend((0..PERIOD as u32).map(|n| corner(k * PERIOD as u32 + n, turned)));
        }
    }

    /// Returns the turbulent velocity at `place` [m/s].
    pub fn velocity(&self, place: Vec3) -> Vec3 {
        let octaves = self.octaves.iter().zip(self.corners.chunks_exact(PERIOD));
        octaves.map(|(octave, corners)| octave.velocity(place, corners)).sum()
    }
}

impl Octave {
    fn velocity(&self, place: Vec3, corners: &[Corner]) -> Vec3 {
        let at = place * self.scale - self.way;
        let cell = at.floor();
        let f = at - cell;
        let cell = cell.as_ivec3();
        // Perlin's weight of the upper node along each axis, and its derivative.
        let upper = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
        let slope = f * f * (f * (f - 2.0) + 1.0) * 30.0;
        let sides = [(Vec3::ONE - upper, -slope), (upper, slope)];
        let mut v = Vec3::ZERO;
        for corner in 0..8 {
            let [x, y, z] = [corner & 1, corner >> 1 & 1, corner >> 2];
            let (wx, wy, wz) = (sides[x].0.x, sides[y].0.y, sides[z].0.z);
            let gradient = Vec3::new(sides[x].1.x * wy * wz, wx * sides[y].1.y * wz, wx * wy * sides[z].1.z);
            let from = IVec3::new(x as i32, y as i32, z as i32);
            let Corner { a, curl } = corners[hash(cell + from)];
            v += gradient.cross(a * (f - from.as_vec3())) + curl * (wx * wy * wz);
        }
        v * self.speed
    }
}

/// Returns the index of the gradients at lattice node `at`. The lattice repeats every [`PERIOD`] nodes.
fn hash(at: IVec3) -> usize {
    let [x, y, z] = (at & (PERIOD as i32 - 1)).to_array().map(|k| k as u32);
    scatter(x | y << 8 | z << 16) as usize % PERIOD
}

/// A hash with pseudo-random bits (Jarzynski & Olano 2020, *Hash Functions for GPU Rendering*: PCG).
fn scatter(n: u32) -> u32 {
    let state = n.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = (state >> ((state >> 28) + 4) ^ state).wrapping_mul(277_803_737);
    word >> 22 ^ word
}

/// Returns the gradients with index `n`, after the eddies have turned by `turned` [rad].
fn corner(n: u32, turned: f64) -> Corner {
    // Uniform in ±√3, which has variance 1.
    let draw = |k: u32| (scatter(n * 19 + k) as f32 / u32::MAX as f32 - 0.5) * 12f32.sqrt();
    let matrix = |from: u32| Mat3::from_cols_array(&std::array::from_fn(|k| draw(from + k as u32)));
    // The rotation rates differ, so that the noise does not repeat in time.
    let angle = turned * f64::from(1.0 + 0.2 * draw(18));
    let (sin, cos) = (angle.sin() as f32, angle.cos() as f32);
    let a = matrix(0) * cos + matrix(9) * sin;
    let [x, y, z] = [a.x_axis, a.y_axis, a.z_axis];
    Corner { a, curl: Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(settings: &Turbulence, way: Vec3, time: f64) -> Noise {
        let mut noise = Noise::default();
        noise.set(settings, way.as_dvec3(), time);
        noise
    }

    fn places() -> impl Iterator<Item = Vec3> {
        (0..4000).map(|k| {
            let [x, y, z] = [3 * k, 3 * k + 1, 3 * k + 2].map(|n| scatter(n) as f32 / u32::MAX as f32);
            Vec3::new(x, y, z) * 8.0 - 4.0
        })
    }

    #[test]
    fn octaves_are_limited_as_their_range_says() {
        let octaves = Turbulence::PARAMETERS.iter().find(|p| p.name == "octaves").map(|p| p.range.bounds());
        assert_eq!(octaves, Some(Some((1.0, MAX_OCTAVES as f32))));
    }

    #[test]
    fn eddies_neither_gather_nor_part() {
        let noise = noise(&Turbulence { strength: 1.0, size: 1.0, octaves: 1 }, Vec3::splat(0.3), 1.7);
        let step = 4e-3;
        let along = |p: Vec3, axis: Vec3| {
            (noise.velocity(p + axis * step) - noise.velocity(p - axis * step)) / (2.0 * step)
        };
        let (mut most, mut change) = (0.0_f32, 0.0_f32);
        for p in places() {
            let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| along(p, axis));
            most = most.max((x.x + y.y + z.z).abs());
            change = change.max(x.length()).max(y.length()).max(z.length());
        }
        println!("divergence up to {most}, where velocity changes by up to {change} 1/s");
        assert!(most < 2e-3 * change, "divergence {most} of changes of {change} 1/s");
    }

    #[test]
    fn strength_is_the_root_of_the_mean_square() {
        for octaves in [1, 3] {
            let noise = noise(&Turbulence { strength: 2.0, size: 0.4, octaves }, Vec3::ZERO, 0.0);
            let sum: f32 = places().map(|p| noise.velocity(p).length_squared()).sum();
            let rms = (sum / 4000.0).sqrt();
            println!("{octaves} octaves: {rms} m/s");
            assert!((rms - 2.0).abs() < 0.1, "{octaves} octaves: {rms} m/s");
        }
    }

    #[test]
    fn the_wind_carries_eddies_and_time_changes_them() {
        let settings = Turbulence { strength: 1.0, size: 0.1, ..Turbulence::default() };
        let way = Vec3::new(0.37, -0.2, 1.1);
        let (now, carried) = (noise(&settings, Vec3::ZERO, 2.0), noise(&settings, way, 2.0));
        let (soon, later) = (noise(&settings, Vec3::ZERO, 2.001), noise(&settings, Vec3::ZERO, 3.0));
        let (mut same, mut near, mut far) = (0.0_f32, 0.0_f32, 0.0_f32);
        for p in places() {
            same = same.max(now.velocity(p).distance(carried.velocity(p + way)));
            near = near.max(now.velocity(p).distance(soon.velocity(p)));
            far = far.max(now.velocity(p).distance(later.velocity(p)));
        }
        assert!(same < 2e-3, "eddies that were carried along differ by {same} m/s");
        assert!(near < 0.1 && far > 1.0, "{near} m/s in a millisecond, {far} in a second");
    }
}
