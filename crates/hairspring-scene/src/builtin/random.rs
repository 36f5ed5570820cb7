//! Random numbers that are a pure function of their purpose: identical on every machine, in any order, on any
//! thread.

use glam::Vec3;

/// A stream of random numbers (PCG-RXS-M-XS 32, O'Neill 2014).
#[derive(Clone, Copy)]
pub struct Random(u32);

impl Random {
    /// Creates the stream of item `index` under `seed`; `purpose` separates different uses of the same item.
    pub fn new(seed: u32, purpose: u32, index: u32) -> Self {
        Self(mix(mix(mix(seed) ^ purpose) ^ index))
    }

    /// Returns a number from 0 (included) to 1 (excluded).
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        (mix(self.0) >> 8) as f32 / (1 << 24) as f32
    }

    /// Returns a number from −1 to 1.
    pub fn signed(&mut self) -> f32 {
        self.unit() * 2.0 - 1.0
    }

    /// Returns a number from `lo` to `hi`.
    pub fn within(&mut self, lo: f32, hi: f32) -> f32 {
        lo + (hi - lo) * self.unit()
    }

    /// Returns a nearly Gaussian number with mean 0 and deviation 1, never beyond ±3.5 (sum of four
    /// uniforms).
    pub fn normal(&mut self) -> f32 {
        (self.signed() + self.signed() + self.signed() + self.signed()) * 0.75f32.sqrt()
    }

    /// Returns a vector whose components are nearly Gaussian.
    pub fn normal3(&mut self) -> Vec3 {
        Vec3::new(self.normal(), self.normal(), self.normal())
    }
}

/// A bijective hash of 32 bits (the output step of PCG).
fn mix(x: u32) -> u32 {
    let x = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let y = ((x >> ((x >> 28) + 4)) ^ x).wrapping_mul(277_803_737);
    (y >> 22) ^ y
}
