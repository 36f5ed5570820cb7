//! The color of a look, and of every visible point. The color of a point is computed when the first tile
//! needs it.
//!
//! A look specifies its pigment by the color of a lock, or by melanin. Both are related to the absorption in
//! the fiber by the fit of Chiang et al. 2016 ("A Practical and Controllable Hair and Fur Model for
//! Production Path Tracing", equation 9). C is the color of many strands together, and σ is the absorption of
//! one strand:
//!
//! ```text
//! √σ = −ln C / (5.969 − 0.215 β + 2.532 β² − 10.73 β³ + 5.574 β⁴ + 0.245 β⁵)
//! ```
//!
//! Most hair is hidden under other hair: of a full head, a quarter is visible. A point's color does not
//! depend on anything that happens while the picture is drawn. So it does not matter which thread computes
//! it, or whether two threads do so at once.

use super::{
    ribbon::Setup,
    shade::{self, Block, Fiber, LANES},
};
use fearless_simd::{dispatch, f32x8, prelude::*};
use glam::{Vec3, Vec4};
use hairspring_scene::HairLook;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

/// Maximum stored light, linear. The tone curve is white well below it.
pub(crate) const MAX_LIGHT: f32 = 8.0;
/// Maximum code and lowest bit of red, green and blue: 11, 11 and 10 bits of the square root of the color.
pub(crate) const CHANNELS: [(f32, u32); 3] = [(2047.0, 0), (2047.0, 11), (1023.0, 22)];

/// Absorption of red, green and blue by eumelanin and pheomelanin at an amount of 1, relative to the fiber's
/// radius (after d'Eon et al. 2011, "An Energy-Conserving Hair Reflectance Model", with the values that the
/// hair shaders of Blender and Unreal share).
const MELANIN: [Vec3; 2] = [Vec3::new(0.506, 0.841, 1.653), Vec3::new(0.343, 0.733, 1.924)];

/// Azimuthal roughness β for which colors are specified. It is the default of those shaders; the lobes of
/// this renderer have no such parameter.
const AZIMUTHAL: f32 = 0.3;

/// The denominator of the fit.
fn fit(b: f32) -> f32 {
    ((((0.245 * b + 5.574) * b - 10.73) * b + 2.532) * b - 0.215) * b + 5.969
}

/// Absorption of a fiber whose locks have this color.
fn absorption(color: Vec3) -> Vec3 {
    let root = color.max(Vec3::splat(1e-4)).map(f32::ln) / fit(AZIMUTHAL);
    root * root
}

/// Color of locks whose fiber has this absorption.
fn seen(absorption: Vec3) -> Vec3 {
    absorption.map(|s| (-s.max(0.0).sqrt() * fit(AZIMUTHAL)).exp())
}

/// Absorption of a fiber with this amount of pigment, of which the fraction `redness` is pheomelanin; both 0
/// to 1.
fn melanin(amount: f32, redness: f32) -> Vec3 {
    // A logarithmic scale, so that even steps look even; at 1 the hair is practically black.
    let amount = -(1.0 - amount.clamp(0.0, 1.0)).max(1e-4).ln();
    (MELANIN[0].lerp(MELANIN[1], redness.clamp(0.0, 1.0))) * amount
}

/// Colors of a look at root and tip: as they are given, or from its melanin, with its dye applied.
pub(crate) fn ends(look: &HairLook) -> [Vec3; 2] {
    let dyed = look.dye != Vec3::ONE && look.dye.is_finite();
    let under_dye = |bare: Vec3| seen(bare + absorption(look.dye));
    match look.melanin {
        Some(amount) => {
            let bare = melanin(amount, look.melanin_redness);
            [if dyed { under_dye(bare) } else { seen(bare) }; 2]
        }
        // Without dye a color is returned unchanged, bit for bit.
        None => [look.root_color, look.tip_color].map(|c| if dyed { under_dye(absorption(c)) } else { c }),
    }
}

/// Packed colors of all slots; 0 if not computed yet.
#[derive(Debug, Default)]
pub(crate) struct Colors {
    slots: Vec<AtomicU32>,
    lit: AtomicU64,
}

impl Colors {
    /// Clears all colors and sets the number of slots.
    pub fn clear(&mut self, slots: usize) {
        self.slots.clear();
        self.slots.resize_with(slots, AtomicU32::default);
        *self.lit.get_mut() = 0;
    }

    /// Number of blocks lit since the last clear.
    pub fn lit(&self) -> u64 {
        self.lit.load(Ordering::Relaxed)
    }

    /// The packed color of a slot, or 0.
    #[inline(always)]
    pub fn peek(&self, slot: usize) -> u32 {
        self.slots[slot].load(Ordering::Relaxed)
    }

    /// Linear RGB and −1 of a slot and of the next one. This is what a coverage adds to (red, green, blue,
    /// transmittance). `known` are the packed colors that were read before.
    #[inline(always)]
    pub fn open(&self, setup: &Setup, slot: usize, known: [u32; 2]) -> [Vec4; 2] {
        let bits = |slot: usize, bits: u32| if bits == 0 { self.light(setup, slot) } else { bits };
        [open(bits(slot, known[0])).extend(-1.0), open(bits(slot + 1, known[1])).extend(-1.0)]
    }

    /// The packed color of a slot that had no color a moment ago.
    #[cold]
    fn light(&self, setup: &Setup, slot: usize) -> u32 {
        match self.peek(slot) {
            0 => self.shade(setup, slot),
            bits => bits,
        }
    }

    /// Lights the block that contains a slot.
    #[inline(never)]
    fn shade(&self, setup: &Setup, slot: usize) -> u32 {
        let block = slot / LANES;
        self.lit.fetch_add(1, Ordering::Relaxed);
        let colors = dispatch!(setup.level, simd => {
            let (fiber, mut block) = gather(simd, setup, block);
            setup.shader.shade(simd, &fiber, &mut block);
            block.color
        });
        // Black is stored as the darkest red, because 0 means "not computed".
        let colors = colors.map(|c| c.max(1));
        for (to, from) in self.slots[block * LANES..].iter().zip(colors) {
            to.store(from, Ordering::Relaxed);
        }
        colors[slot % LANES]
    }
}

/// Gathers the shader's input for the points of a block. Lanes past the strand's last point repeat that
/// point.
#[inline(always)]
fn gather<S: Simd>(simd: S, setup: &Setup, block: usize) -> (Fiber, Block) {
    let owner = setup.order.owners[block];
    let hair = &setup.frame.hair[owner.hair as usize];
    let look = hair.look;
    let range = hair.range(owner.strand as usize);
    let points = &hair.points[range.clone()];
    let (n, first) = (points.len(), owner.first as usize);
    // Includes the previous and the next point.
    let mut rows = [[0.0; LANES + 2]; 3];
    for lane in 0..LANES + 2 {
        let [x, y, z] = points[(first + lane).saturating_sub(1).min(n - 1)].to_array();
        (rows[0][lane], rows[1][lane], rows[2][lane]) = (x, y, z);
    }
    let mut block = Block::default();
    let zero = f32x8::splat(simd, 0.0);
    let (mut along, mut length2) = ([zero; 3], zero);
    for ((row, p), along) in rows.iter().zip(&mut block.p).zip(&mut along) {
        p.copy_from_slice(&row[1..=LANES]);
        *along = f32x8::from_slice(simd, &row[2..]) - f32x8::from_slice(simd, &row[..LANES]);
        length2 += *along * *along;
    }
    // Points that coincide or are not finite get the direction up.
    let known = length2.simd_gt(1e-30) & length2.simd_lt(1e30);
    let inverse = f32x8::splat(simd, 1.0) / length2.sqrt();
    for ((t, along), up) in block.t.iter_mut().zip(along).zip(Vec3::Y.to_array()) {
        known.select(along * inverse, f32x8::splat(simd, up)).store_slice(t);
    }

    // More or less of the same pigment, so that lighter strands are also less saturated.
    let amount = 1.0 + look.variation.clamp(0.0, 1.0) * shade::random(owner.strand) * shade::VARIES;
    if hair.colors.len() < range.end {
        let [root, tip] = setup.pigments[owner.hair as usize].map(|p| p.to_array());
        let lane = f32x8::simd_from(simd, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let share = (lane + first as f32) * (1.0 / (n.max(2) - 1) as f32);
        for axis in 0..3 {
            let pigment = (share * (tip[axis] - root[axis]) + root[axis]) * amount;
            pigment.store_slice(&mut block.pigment[axis]);
        }
    } else {
        for lane in 0..LANES {
            let color = hair.colors[range.start + (first + lane).min(n - 1)];
            let pigment = (shade::pigment(color) * amount).to_array();
            for (row, value) in block.pigment.iter_mut().zip(pigment) {
                row[lane] = value;
            }
        }
    }
    setup.shadow.on_hair(simd, &block.p, &mut block.light, &mut block.body);
    (Fiber::new(look, shade::random(!owner.strand)), block)
}

/// Linear RGB of a packed color.
#[inline(always)]
pub(super) fn open(bits: u32) -> Vec3 {
    let root = Vec3::new((bits & 2047) as f32, (bits >> 11 & 2047) as f32, (bits >> 22) as f32);
    let scaled = root * Vec3::new(1.0 / 2047.0, 1.0 / 2047.0, 1.0 / 1023.0);
    scaled * scaled * MAX_LIGHT
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Colors of the published absorption, computed independently: (melanin, redness, color).
    #[test]
    fn melanin_has_the_published_absorption() {
        // Half of the scale is an amount of ln 2, so the absorption is that multiple of the published
        // coefficients.
        let close = |a: Vec3, b: Vec3| (a - b).abs().max_element() < 1e-5;
        assert!(close(melanin(0.5, 0.0), Vec3::new(0.506, 0.841, 1.653) * std::f32::consts::LN_2));
        assert!(close(melanin(0.5, 1.0), Vec3::new(0.343, 0.733, 1.924) * std::f32::consts::LN_2));
        assert!(close(melanin(1.0 - (-1.0f32).exp(), 0.5), Vec3::new(0.4245, 0.787, 1.7885)));
        // The fit at 0.3: 5.969 − 0.0645 + 0.22788 − 0.28971 + 0.045149 + 0.000595.
        assert!((fit(0.3) - 5.888_414).abs() < 1e-5, "{}", fit(0.3));
        // exp(−5.888414 √(0.506 ln 2)), and so on.
        let look = HairLook { melanin: Some(0.5), melanin_redness: 0.0, ..HairLook::default() };
        let [root, tip] = ends(&look);
        assert!(close(root, Vec3::new(0.030_584, 0.011_156, 0.001_831)), "{root}");
        assert_eq!(root, tip);
    }

    #[test]
    fn absorption_of_a_color_gives_that_color() {
        for color in [Vec3::new(0.42, 0.27, 0.13), Vec3::new(0.011, 0.009, 0.008), Vec3::ONE] {
            assert!((seen(absorption(color)) - color).abs().max_element() < 1e-5);
        }
        let look = HairLook::default();
        assert_eq!(ends(&look), [look.root_color, look.tip_color]);
    }

    /// More pigment is darker in every channel, and redder pigment is redder. White hair takes on its dye,
    /// and dye makes nothing lighter.
    #[test]
    fn pigment_and_dye_darken() {
        let of = |melanin: f32, redness: f32, dye: Vec3| {
            ends(&HairLook { melanin: Some(melanin), melanin_redness: redness, dye, ..HairLook::default() })
                [0]
        };
        for k in 0..20 {
            let (a, b) = (k as f32 / 20.0, (k + 1) as f32 / 20.0);
            assert!(of(b, 0.3, Vec3::ONE).cmplt(of(a, 0.3, Vec3::ONE)).all());
            assert!(
                of(b, 1.0, Vec3::ONE).x / of(b, 1.0, Vec3::ONE).z
                    > of(b, 0.0, Vec3::ONE).x / of(b, 0.0, Vec3::ONE).z
            );
        }
        let blue = Vec3::new(0.05, 0.1, 0.6);
        assert!((of(0.0, 0.3, blue) - blue).abs().max_element() < 1e-5);
        assert!(of(0.3, 0.3, blue).cmplt(of(0.3, 0.3, Vec3::ONE)).all());
        let dyed = ends(&HairLook { dye: blue, ..HairLook::default() });
        assert!(dyed[1].cmplt(HairLook::default().tip_color).all());
        // Values out of range are clamped.
        assert_eq!(of(-1.0, 7.0, blue), of(0.0, 1.0, blue));
        assert_eq!(of(f32::INFINITY, 0.0, blue), of(1.0, 0.0, blue));
    }

    #[test]
    fn packing_is_accurate_to_an_srgb_code() {
        for k in 0..800 {
            let light = Vec3::new(1.0, 0.5, 0.1) * (k as f32 / 100.0);
            let codes = light.to_array().map(|c| (c / MAX_LIGHT).sqrt());
            let bits =
                (0..3).fold(0, |bits, i| bits | ((codes[i] * CHANNELS[i].0 + 0.5) as u32) << CHANNELS[i].1);
            let error = (open(bits) - light).abs().max_element();
            // A step of the finest sRGB code near black is 3e-4, near white 9e-3.
            assert!(error < 6e-4 + 0.01 * light.max_element(), "{error} at {light}");
        }
    }
}
