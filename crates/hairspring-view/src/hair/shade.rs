//! Light from a strand toward the camera, for eight points at once.
//!
//! This is the fiber model of Marschner et al. 2003 ("Light Scattering from Human Hair Fibers") in the cheap
//! form of Karis 2016 ("Physically Based Hair Shading in Unreal"). It has the lobes R, the white highlight of
//! the cuticle; TT, transmitted light; TRT, the colored highlight after one internal reflection; and light
//! scattered from strand to strand. Pigment is stored as the logarithm of the color, so that paths through
//! the fiber, mixtures and shadow are sums and products.

use super::color;
use crate::{body::skin, lighting::Lighting};
use fearless_simd::{f32x8, prelude::*};
use glam::Vec3;
use hairspring_scene::HairLook;

/// Number of points shaded at once.
pub(crate) const LANES: usize = 8;
/// One value per point.
pub(crate) type Row = [f32; LANES];

/// Eight points of a strand.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub(crate) struct Block {
    /// Position [m].
    pub p: [Row; 3],
    /// Unit direction, root to tip.
    pub t: [Row; 3],
    /// Base-2 logarithm of the color.
    pub pigment: [Row; 3],
    /// Optical depth toward key, rim and fill; visible fraction of the sky.
    pub light: [Row; 4],
    /// Fraction of the key lamp's light that bodies let through.
    pub body: Row,
    /// Result, packed as in [`super::color`].
    pub color: [u32; LANES],
}

/// Values that all strands of a frame share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shader {
    eye: Vec3,
    /// Unit directions and colors of key, rim and fill, in the order of the optical depths.
    lamps: [(Vec3, Vec3); 3],
    sky: Vec3,
    ground: Vec3,
    /// The key lamp's light reflected from skin.
    bounce: Vec3,
}

/// Values that the points of one strand share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fiber {
    /// Shift of the highlights [rad], including this strand's own variation.
    pub tilt: f32,
    /// Longitudinal width of R, TT and TRT [rad].
    pub spread: [f32; 3],
    pub specular: f32,
    pub backlight: f32,
    pub scatter: f32,
}

impl Fiber {
    /// `random` is this strand's random number from −1 to 1.
    pub fn new(look: &HairLook, random: f32) -> Self {
        let rough = look.roughness.clamp(0.1, 1.0).powi(2);
        Self {
            tilt: (look.cuticle.clamp(0.0, 10.0) + TILTS * random).to_radians(),
            // Karis 2016, slide 18: β, β/2 and 2β.
            spread: [rough, 0.5 * rough, 2.0 * rough].map(|b| (b + 0.02).hypot(SOFTBOX)),
            specular: look.specular.max(0.0),
            backlight: look.backlight.max(0.0),
            scatter: look.scatter.max(0.0),
        }
    }
}

// Constants of the model. The shaders of the `gpu` module use the same values.

/// Size of the lamps [rad]: the standard deviation of the directions of their light, as of a softbox of 1 m at
/// 2 m. It widens every lobe. With lamps that are points, fanned-out hair would be overexposed, because no
/// other strand blocks the light.
const SOFTBOX: f32 = 0.14;
/// Variation of the cuticle tilt between strands [degrees].
pub(crate) const TILTS: f32 = 1.2;
/// Variation of the pigment from strand to strand, at a look's variation of 1.
pub(crate) const VARIES: f32 = 0.6;
/// Attenuation of direct light per optical depth. It is below 1, because much of the light that hits a strand
/// continues forward.
pub(crate) const BEAM: f32 = 0.62;
/// Attenuation of forward-scattered light per optical depth and channel: a constant, and a part that grows
/// with pigment (the forward attenuation of dual scattering, Zinke et al. 2008).
pub(crate) const SCATTERED: (f32, f32) = (0.07, 0.075);
/// Optical depth of a body that blocks the key lamp, for light scattered from strand to strand.
pub(crate) const BEHIND_BODY: f32 = 12.0;
/// Reflectance at normal incidence of keratin, whose refractive index is 1.55.
pub(crate) const REFLECTANCE: f32 = 0.0465;
/// Strengths of R and TRT relative to TT, and the minimum width of R [rad].
pub(crate) const R: (f32, f32) = (0.45, 0.03);
/// For TT: slope and offset of the exponent over the cosine of the azimuth (Karis 2016, slide 24).
pub(crate) const TT: (f32, f32) = (-3.65, -3.98);
/// Refraction of the TT path: coefficients of the reciprocal and of the cosine of the half angle (slide 24),
/// and slope and offset of the entry position.
pub(crate) const BENT: ([f32; 2], [f32; 2]) = ([1.19, 0.36], [-0.8, 0.6]);
/// For TRT: slope and offset of the exponent (slide 29), strength, and path length through pigment.
pub(crate) const TRT: ([f32; 2], f32, f32) = ([17.0, -16.78], 1.5, 0.8);
/// Light from strand to strand: weight of the part that depends on facing the lamp, and of the part from all
/// directions.
pub(crate) const MULTIPLE: (f32, f32) = (0.7, 0.35);
/// Light that is blocked from hair is not lost. It is reflected by the blocker, in its color (similar to
/// ambient occlusion with multiple bounces: Jiménez et al. 2016, "Practical Real-Time Strategies for Accurate
/// Indirect Occlusion"). The ambient part is the same as for skin ([`skin::BOUNCE`]). This constant is the
/// key lamp's part: light from lit skin in a tenth of all directions [1].
pub(crate) const KEY_BOUNCE: f32 = 0.1;
/// Reflectance of the cuticle for ambient light: Schlick's Fresnel term, averaged over the width of a
/// cylinder. It makes the shape of black hair visible.
pub(crate) const SHEEN: f32 = 0.07;

impl Shader {
    pub fn new(lighting: &Lighting, eye: Vec3) -> Self {
        let lamp = |l: &crate::lighting::Light| (l.direction.normalize_or(Vec3::Y), l.color);
        Self {
            eye,
            lamps: [lamp(&lighting.key), lamp(&lighting.rim), lamp(&lighting.fill)],
            sky: lighting.sky,
            ground: lighting.ground,
            bounce: lighting.key.color * skin::SKIN.0 * KEY_BOUNCE,
        }
    }

    /// Computes the block's `color`. Must be called inside a `dispatch!`.
    // Loops are unrolled by hand and helpers are always inlined, so that everything is compiled for the
    // selected instruction set.
    #[inline(always)]
    pub fn shade<S: Simd>(&self, simd: S, fiber: &Fiber, block: &mut Block) {
        shade(simd, self, fiber, block);
    }
}

/// One vector for each of eight points.
#[derive(Clone, Copy)]
struct V<S: Simd>([f32x8<S>; 3]);

impl<S: Simd> V<S> {
    #[inline(always)]
    fn load(simd: S, [x, y, z]: &[Row; 3]) -> Self {
        Self([f32x8::simd_from(simd, *x), f32x8::simd_from(simd, *y), f32x8::simd_from(simd, *z)])
    }
    #[inline(always)]
    fn dot(self, o: Self) -> f32x8<S> {
        self.0[0].mul_add(o.0[0], self.0[1].mul_add(o.0[1], self.0[2] * o.0[2]))
    }
    #[inline(always)]
    fn dot3(self, o: Vec3) -> f32x8<S> {
        self.0[0] * o.x + self.0[1] * o.y + self.0[2] * o.z
    }
    #[inline(always)]
    fn scale(self, k: f32x8<S>) -> Self {
        Self([self.0[0] * k, self.0[1] * k, self.0[2] * k])
    }
}

/// 2^x, with a relative error of 3e-5; x is clamped to ±100.
#[inline(always)]
fn exp2<S: Simd>(x: f32x8<S>) -> f32x8<S> {
    let x = x.max(-100.0).min(100.0);
    let whole = x.floor();
    let f = x - whole;
    // Minimax polynomial on [0, 1].
    let p = (((f * 0.013_676_6 + 0.051_690_4) * f + 0.241_638_4) * f + 0.692_983_6) * f + 1.000_002_6;
    let power: f32x8<S> = ((whole.to_int::<fearless_simd::i32x8<S>>() + 127) << 23u32).bitcast();
    p * power
}

/// e^(−x² / 2b²) / (b √2π): longitudinal distribution of light by the fiber.
#[inline(always)]
fn gauss<S: Simd>(x: f32x8<S>, b: f32x8<S>) -> f32x8<S> {
    let u = x / b;
    exp2(u * u * -0.721_347_5) * 0.398_942_3 / b
}

/// Schlick's Fresnel term.
#[inline(always)]
fn fresnel<S: Simd>(cos: f32x8<S>) -> f32x8<S> {
    let m = (-cos + 1.0).max(0.0);
    let m2 = m * m;
    m2 * m2 * m * (1.0 - REFLECTANCE) + REFLECTANCE
}

#[inline(always)]
fn saturate<S: Simd>(x: f32x8<S>) -> f32x8<S> {
    x.max(0.0).min(1.0)
}

#[inline(always)]
fn shade<S: Simd>(simd: S, shader: &Shader, fiber: &Fiber, block: &mut Block) {
    let zero = f32x8::splat(simd, 0.0);
    let t = V::load(simd, &block.t);
    let p = V::load(simd, &block.p);
    let pigment = V::load(simd, &block.pigment);
    let eye = shader.eye.to_array();
    let to_eye = V([-p.0[0] + eye[0], -p.0[1] + eye[1], -p.0[2] + eye[2]]);
    let scale = f32x8::splat(simd, 1.0) / to_eye.dot(to_eye).max(1e-12).sqrt();
    let v = to_eye.scale(scale);

    // Sines of the angles to the plane perpendicular to the fiber.
    let sin_v = t.dot(v).max(-1.0).min(1.0);
    let cos2_v = (-(sin_v * sin_v) + 1.0).max(1e-4);
    let cos_v = cos2_v.sqrt();
    // The direction perpendicular to the fiber that faces the camera.
    let inverse = f32x8::splat(simd, 1.0) / cos_v;
    let [vx, vy, vz] = v.0;
    let [tx, ty, tz] = t.0;
    let across = V([vx - tx * sin_v, vy - ty * sin_v, vz - tz * sin_v]).scale(inverse);
    // Factor of scattering between strands: √color (Karis 2016, slide 33).
    let [c0, c1, c2] = pigment.0;
    let soft = [exp2(c0 * 0.5), exp2(c1 * 0.5), exp2(c2 * 0.5)];
    let mut sum = [zero; 3];

    for k in 0..3 {
        let (l, lamp) = shader.lamps[k];
        let depth = f32x8::simd_from(simd, block.light[k]);
        let body = if k == 0 { f32x8::simd_from(simd, block.body) } else { zero + 1.0 };
        let beam = exp2(depth * (-BEAM * std::f32::consts::LOG2_E)) * body;

        let sin_l = t.dot3(l).max(-1.0).min(1.0);
        let cos2_l = (-(sin_l * sin_l) + 1.0).max(1e-4);
        let cos_l = cos2_l.sqrt();
        let vl = v.dot3(l);
        let cos_phi = ((vl - sin_l * sin_v) / (cos_l * cos_v)).max(-1.0).min(1.0);
        let cos_half = (cos_phi * 0.5 + 0.5).sqrt();
        let cos_d = ((cos_l * cos_v + sin_l * sin_v) * 0.5 + 0.5).max(1e-3).sqrt();
        let sines = sin_l + sin_v;

        // R: white, toward the root. The lobes are at −α, α/2 and 3α/2 (Marschner et al. 2003, table 1). The
        // sum of the sines accounts for both angles.
        let m = gauss(
            sines + cos_half * cos_v * (2.0 * fiber.tilt),
            cos_half * (std::f32::consts::SQRT_2 * fiber.spread[0]) + R.1,
        );
        let r = m * cos_half * fresnel((vl * 0.5 + 0.5).max(0.0).sqrt()) * (R.0 * fiber.specular);

        // TT: once through the fiber.
        let m = gauss(sines - fiber.tilt, zero + fiber.spread[1]);
        let a = f32x8::splat(simd, 1.0) / (f32x8::splat(simd, BENT.0[0]) / cos_d + cos_d * BENT.0[1]);
        let h = saturate(cos_half * (a * (cos_phi * BENT.1[0] + BENT.1[1]) + 1.0));
        let pass = -fresnel(cos_d * (-(h * h) + 1.0).max(0.0).sqrt()) + 1.0;
        let n = exp2((cos_phi * TT.0 + TT.1) * std::f32::consts::LOG2_E);
        let tt = m * n * pass * pass * fiber.backlight;
        let ha = h * a;
        let tt_path = (-(ha * ha) + 1.0).max(0.0).sqrt() * 0.5 / cos_d;

        // TRT: colored, toward the tip.
        let m = gauss(sines - 3.0 * fiber.tilt, zero + fiber.spread[2]);
        let f = fresnel(cos_d * 0.5);
        let pass = -f + 1.0;
        let n = exp2((cos_phi * TRT.0[0] + TRT.0[1]) * std::f32::consts::LOG2_E);
        let trt = m * n * pass * pass * f * (TRT.1 * fiber.specular);
        let trt_path = f32x8::splat(simd, TRT.2) / cos_d;

        // Strand to strand: as from a matte surface perpendicular to the fiber, fully wrapped. Its color
        // deepens with the distance through the hair.
        let facing = ((across.dot3(l) + 1.0) * 0.25).max(0.0) * fiber.scatter;
        let flat = cos_l * MULTIPLE.1 * fiber.scatter;
        let color = lamp.to_array();
        for i in 0..3 {
            let c = pigment.0[i];
            let single =
                (r + tt * exp2(c * tt_path) + trt * exp2(c * trt_path)) * beam * std::f32::consts::PI;
            let lost = (c * SCATTERED.1 - SCATTERED.0)
                * (depth + (-body + 1.0) * BEHIND_BODY)
                * std::f32::consts::LOG2_E;
            let multiple = soft[i] * exp2(c * 0.5 + lost) * (facing * MULTIPLE.0 + flat);
            sum[i] += (single * cos_l + multiple) * color[i];
        }
    }
    let open = f32x8::simd_from(simd, block.light[3]);
    let up = across.0[1] * 0.5 + 0.5;
    for (i, sum) in sum.iter_mut().enumerate() {
        let (sky, ground) = (shader.sky.to_array()[i], shader.ground.to_array()[i]);
        let around = up * (sky - ground) + ground;
        let near = (around * skin::BOUNCE + shader.bounce.to_array()[i]) * (-open + 1.0);
        let c = pigment.0[i];
        let far = around * open;
        // Light through hair is colored along its path; light between hair and body is colored once, like a
        // lock.
        let scattered = far * exp2(c * (-open * 0.5 + 1.5)) + near * exp2(c);
        *sum += scattered * fiber.scatter + (far + near) * (SHEEN * fiber.specular);
    }
    // Colors are packed here, once per point and in lanes. An invalid point darkens its strand, but does not
    // spread over the picture.
    let mut bits = fearless_simd::u32x8::splat(simd, 0);
    for (sum, (top, shift)) in sum.into_iter().zip(color::CHANNELS) {
        let finite = sum.simd_ge(0.0);
        let light = finite.select(sum, zero).min(color::MAX_LIGHT) * (1.0 / color::MAX_LIGHT);
        let root = (light.sqrt() * top + 0.5).to_int::<fearless_simd::u32x8<S>>();
        bits |= root << shift;
    }
    bits.store_slice(&mut block.color);
}

/// A pseudorandom number from −1 to 1 for strand `s`, evenly distributed and different for neighboring
/// strands (the finalizer of MurmurHash3).
pub(crate) fn random(s: u32) -> f32 {
    let mut h = s.wrapping_mul(0x9e37_79b9) ^ 0x5bd1_e995;
    h = (h ^ h >> 16).wrapping_mul(0x85eb_ca6b);
    h = (h ^ h >> 13).wrapping_mul(0xc2b2_ae35);
    h ^= h >> 16;
    (h >> 8) as f32 / (1 << 23) as f32 - 1.0
}

/// Base-2 logarithm of a color. Black keeps a trace of light, and white a trace of pigment.
pub(crate) fn pigment(color: Vec3) -> Vec3 {
    let c = if color.is_finite() { color } else { Vec3::splat(0.2) };
    let c = c.clamp(Vec3::splat(0.002), Vec3::splat(0.98));
    Vec3::new(c.x.log2(), c.y.log2(), c.z.log2())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tonemap::filmic;
    use fearless_simd::{Level, dispatch};

    #[test]
    fn powers_of_two_are_close() {
        let level = Level::new();
        for i in -800..800 {
            let x = i as f32 * 0.0371;
            let mut got = [0.0; LANES];
            dispatch!(level, simd => exp2(f32x8::splat(simd, x)).store_slice(&mut got));
            assert!((got[0] / x.exp2() - 1.0).abs() < 2e-4, "{x}: {} {}", got[0], x.exp2());
        }
    }

    /// Hair that fans out has no other hair between it and the lamps. Brown hair keeps its color there, in all but
    /// a few directions.
    #[test]
    fn hair_that_fans_out_is_not_overexposed() {
        let shader = Shader::new(&Lighting::default(), Vec3::new(0.0, 0.0, 1.5));
        let look = HairLook::from(hairspring_scene::HairColor::Brown);
        let fiber = Fiber::new(&look, 0.0);
        let (mut white, mut all) = (0, 0);
        for k in 0..2000 {
            // Directions on a Fibonacci sphere.
            let y = 1.0 - (k as f32 + 0.5) / 1000.0;
            let (sin, cos) = (k as f32 * 2.399_963).sin_cos();
            let across = (1.0 - y * y).sqrt();
            let mut block =
                Block { t: [[across * cos; LANES], [y; LANES], [across * sin; LANES]], ..Block::default() };
            block.pigment = pigment(look.tip_color).to_array().map(|c| [c; LANES]);
            block.light = [[0.0; LANES], [0.0; LANES], [0.0; LANES], [1.0; LANES]];
            block.body = [1.0; LANES];
            dispatch!(Level::new(), simd => shader.shade(simd, &fiber, &mut block));
            white += usize::from(filmic(color::open(block.color[0])).min_element() > 0.8);
            all += 1;
        }
        assert!(white * 50 < all, "{white} of {all} directions are white");
    }

    /// Where neither lamps nor sky reach, hair is dark, and at least as saturated as in the open. It is not a
    /// black hole in the picture, unless the hair itself is black.
    #[test]
    fn hair_in_deep_shade_is_dark_and_not_black() {
        let shader = Shader::new(&Lighting::default(), Vec3::Z);
        let fiber = Fiber::new(&HairLook::default(), 0.0);
        let lit = |color: Vec3, depth: f32, open: f32| {
            let mut block = Block { t: [[0.0; LANES], [1.0; LANES], [0.0; LANES]], ..Block::default() };
            block.pigment = pigment(color).to_array().map(|c| [c; LANES]);
            block.light = [depth, depth, depth, open].map(|l| [l; LANES]);
            dispatch!(Level::new(), simd => shader.shade(simd, &fiber, &mut block));
            color::open(block.color[0])
        };
        for color in [Vec3::new(0.55, 0.36, 0.16), Vec3::new(0.12, 0.05, 0.02), Vec3::splat(0.004)] {
            let (shade, shine) = (lit(color, 60.0, 0.0), lit(color, 0.0, 1.0));
            assert!(filmic(shade).min_element() > 0.5 / 255.0 / 12.92, "{color}: {shade}");
            assert!(shade.max_element() < 0.35 * shine.max_element(), "{color}: {shade} of {shine}");
            assert!(shade.x / shade.z > 0.9 * shine.x / shine.z, "{color}: {shade} of {shine}");
        }
    }

    #[test]
    fn random_numbers_fill_their_range_evenly() {
        let n = 100_000;
        let mean = (0..n).map(random).sum::<f32>() / n as f32;
        let square = (0..n).map(|s| random(s).powi(2)).sum::<f32>() / n as f32;
        assert!(mean.abs() < 0.01 && (square - 1.0 / 3.0).abs() < 0.01);
    }
}
