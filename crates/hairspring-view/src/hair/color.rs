//! The colour of every point that is seen, worked out when the first tile asks.
//!
//! Most hair lies under other hair: of a full head, a quarter is seen. A point's colour depends on nothing that happens while the picture is drawn,
//! so it does not matter which thread works it out, or whether two do at once.

use super::{
    ribbon::Setup,
    shade::{self, Block, Fibre, LANES},
};
use fearless_simd::{dispatch, f32x8, prelude::*};
use glam::{Vec3, Vec4};
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

/// Greatest light stored, linear; the tone curve has long been white there.
pub(crate) const MAX_LIGHT: f32 = 8.0;
/// Greatest code and lowest bit of red, green and blue: 11, 11 and 10 bits of the colour's square root.
pub(crate) const CHANNELS: [(f32, u32); 3] = [(2047.0, 0), (2047.0, 11), (1023.0, 22)];

/// Packed colours of all slots; 0: not worked out yet.
#[derive(Debug, Default)]
pub(crate) struct Colors {
    slots: Vec<AtomicU32>,
    lit: AtomicU64,
}

impl Colors {
    /// Forgets all colours; `slots` is their number from now on.
    pub fn clear(&mut self, slots: usize) {
        self.slots.clear();
        self.slots.resize_with(slots, AtomicU32::default);
        *self.lit.get_mut() = 0;
    }

    /// Blocks lit since all were forgotten.
    pub fn lit(&self) -> u64 {
        self.lit.load(Ordering::Relaxed)
    }

    /// What is known of a slot, packed.
    #[inline(always)]
    pub fn peek(&self, slot: usize) -> u32 {
        self.slots[slot].load(Ordering::Relaxed)
    }

    /// Linear RGB and −1 (what a covering adds to (red, green, blue, what still shows through)) of a slot and the next, of which `known` was
    /// known a moment ago.
    #[inline(always)]
    pub fn open(&self, setup: &Setup, slot: usize, known: [u32; 2]) -> [Vec4; 2] {
        let bits = |slot: usize, bits: u32| if bits == 0 { self.light(setup, slot) } else { bits };
        [open(bits(slot, known[0])).extend(-1.0), open(bits(slot + 1, known[1])).extend(-1.0)]
    }

    /// The packed colour of a slot that was not known a moment ago.
    #[cold]
    fn light(&self, setup: &Setup, slot: usize) -> u32 {
        match self.peek(slot) {
            0 => self.shade(setup, slot),
            bits => bits,
        }
    }

    /// Lights the block around a slot.
    #[inline(never)]
    fn shade(&self, setup: &Setup, slot: usize) -> u32 {
        let block = slot / LANES;
        self.lit.fetch_add(1, Ordering::Relaxed);
        let colors = dispatch!(setup.level, simd => {
            let (fibre, mut block) = gather(simd, setup, block);
            setup.shader.shade(simd, &fibre, &mut block);
            block.color
        });
        // Black is stored as the darkest red there is.
        let colors = colors.map(|c| c.max(1));
        for (to, from) in self.slots[block * LANES..].iter().zip(colors) {
            to.store(from, Ordering::Relaxed);
        }
        colors[slot % LANES]
    }
}

/// What the shader needs to know of a block's points. Lanes past the strand's last point repeat it.
#[inline(always)]
fn gather<S: Simd>(simd: S, setup: &Setup, block: usize) -> (Fibre, Block) {
    let owner = setup.order.owners[block];
    let hair = &setup.frame.hair[owner.hair as usize];
    let look = hair.look;
    let range = hair.range(owner.strand as usize);
    let points = &hair.points[range.clone()];
    let (n, first) = (points.len(), owner.first as usize);
    // With the point before and the one after.
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
    // Points that lie on one another, or are no numbers, get the direction up.
    let known = length2.simd_gt(1e-30) & length2.simd_lt(1e30);
    let inverse = f32x8::splat(simd, 1.0) / length2.sqrt();
    for ((t, along), up) in block.t.iter_mut().zip(along).zip(Vec3::Y.to_array()) {
        known.select(along * inverse, f32x8::splat(simd, up)).store_slice(t);
    }

    // More or less of the same pigment: lighter strands are also less saturated.
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
    (Fibre::new(look, shade::random(!owner.strand)), block)
}

#[inline(always)]
fn open(bits: u32) -> Vec3 {
    let root = Vec3::new((bits & 2047) as f32, (bits >> 11 & 2047) as f32, (bits >> 22) as f32);
    let scaled = root * Vec3::new(1.0 / 2047.0, 1.0 / 2047.0, 1.0 / 1023.0);
    scaled * scaled * MAX_LIGHT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packing_keeps_what_the_eye_sees() {
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
