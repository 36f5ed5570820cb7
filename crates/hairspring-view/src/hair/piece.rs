//! One straight piece of a strand on the screen, packed so that two fit in a cache line.

use glam::{Vec2, Vec3, Vec4};

/// Greatest width of a strand on the screen [pixels].
pub(crate) const MAX_WIDTH: f32 = 512.0;
/// Greatest light stored, linear; the tone curve has long been white there.
pub(crate) const MAX_LIGHT: f32 = 8.0;
/// Greatest code and lowest bit of red, green and blue.
pub(crate) const CHANNELS: [(f32, u32); 3] = [(2047.0, 0), (2047.0, 11), (1023.0, 22)];

/// A straight piece of a strand.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub(crate) struct Piece {
    /// Ends [pixels].
    pub a: Vec2,
    pub b: Vec2,
    /// Depth at both ends, as a 16-bit share of the frame's depth range.
    depths: [u16; 2],
    /// Square root of the width at both ends; the lowest bit says that the strand begins or ends there.
    widths: [u16; 2],
    /// Square root of the colour at both ends: 11 bits of red, 11 of green, 10 of blue.
    colors: [u32; 2],
}

/// A [`Piece`] unpacked.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Open {
    pub a: Vec2,
    pub b: Vec2,
    /// Share of the frame's depth range, 0 to 1, at both ends.
    pub depth: [f32; 2],
    /// Width at both ends [pixels].
    pub width: [f32; 2],
    /// Linear RGB and −1 at both ends: what a covering adds to (red, green, blue, what still shows through).
    pub color: [Vec4; 2],
    /// Whether the strand begins at `a`, ends at `b`.
    pub cap: [bool; 2],
}

impl Piece {
    #[cfg(test)]
    pub fn pack(open: &Open) -> Self {
        Self::new(
            [open.a, open.b],
            open.depth.map(pack_depth),
            [0, 1].map(|i| pack_width(open.width[i]) | open.cap[i] as u16),
            open.color.map(|c| pack_color(c.truncate())),
        )
    }

    #[inline(always)]
    pub fn new([a, b]: [Vec2; 2], depths: [u16; 2], widths: [u16; 2], colors: [u32; 2]) -> Self {
        Self { a, b, depths, widths, colors }
    }

    #[inline(always)]
    pub fn open(&self) -> Open {
        let width = |w: u16| {
            let root = (w >> 1) as f32 * (1.0 / 32767.0);
            root * root * MAX_WIDTH
        };
        Open {
            a: self.a,
            b: self.b,
            depth: self.depths.map(|d| d as f32 * (1.0 / 65535.0)),
            width: self.widths.map(width),
            color: self.colors.map(|c| open_color(c).extend(-1.0)),
            cap: self.widths.map(|w| w & 1 != 0),
        }
    }
}

/// A share of the depth range in 16 bits.
#[inline(always)]
pub(crate) fn pack_depth(depth: f32) -> u16 {
    (depth.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16
}

/// The square root of a width [pixels] in the upper 15 of 16 bits.
#[inline(always)]
pub(crate) fn pack_width(width: f32) -> u16 {
    (((width / MAX_WIDTH).clamp(0.0, 1.0).sqrt() * 32767.0 + 0.5) as u16) << 1
}

/// The square root of a colour: 11 bits of red, 11 of green, 10 of blue.
#[inline(always)]
pub(crate) fn pack_color(c: Vec3) -> u32 {
    let root = |c: f32, top: f32| ((c * (1.0 / MAX_LIGHT)).clamp(0.0, 1.0).sqrt() * top + 0.5) as u32;
    root(c.x, 2047.0) | root(c.y, 2047.0) << 11 | root(c.z, 1023.0) << 22
}

#[inline(always)]
pub(crate) fn open_color(bits: u32) -> Vec3 {
    let root = Vec3::new((bits & 2047) as f32, (bits >> 11 & 2047) as f32, (bits >> 22) as f32);
    let scaled = root * Vec3::new(1.0 / 2047.0, 1.0 / 2047.0, 1.0 / 1023.0);
    scaled * scaled * MAX_LIGHT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packing_keeps_what_the_eye_sees() {
        for k in 0..200 {
            let t = k as f32 / 200.0;
            let open = Open {
                a: Vec2::new(12.34, 5.0),
                b: Vec2::new(-3.0, 700.5),
                depth: [t, 1.0 - t],
                width: [0.02 + t * t, 3.0 * t],
                color: [Vec4::new(t, 2.0 * t, 0.1 * t, -1.0), Vec4::new(0.01, 0.01, 0.01, -1.0)],
                cap: [k % 2 == 0, k % 3 == 0],
            };
            let back = Piece::pack(&open).open();
            assert_eq!((back.a, back.b, back.cap), (open.a, open.b, open.cap));
            for i in 0..2 {
                assert!((back.depth[i] - open.depth[i]).abs() < 1e-5);
                assert!(
                    (back.width[i] - open.width[i]).abs() < 2e-3 + 0.003 * open.width[i],
                    "{} {}",
                    back.width[i],
                    open.width[i]
                );
                let error = (back.color[i] - open.color[i]).abs();
                // A step of the finest sRGB code near black is 3e-4, near white 9e-3.
                assert!(error.max_element() < 6e-4 + 0.01 * open.color[i].abs().max_element(), "{error}");
            }
        }
    }

    #[test]
    fn two_fit_in_a_cache_line() {
        assert_eq!(size_of::<Piece>(), 32);
    }
}
