//! What a picture holds in each pixel. Hair and bodies are blended in the same way for each: nearest first,
//! by the area that they cover.

use crate::{
    body::{Bodies, Lit, Samples, skin},
    camera::View,
    frame::Before,
    hair::{color::Colors, ribbon::Setup, shade::LANES},
    tonemap::{Encoder, filmic, filmic_on},
};
use glam::{Vec2, Vec3, Vec4};

/// A kind of picture.
pub(crate) trait Pass: Sync {
    /// What a pixel holds.
    type Pixel: Copy + Default + Send + Sync;

    /// The values at both ends of the segment in `slot`, and −1: what a coverage adds to (values,
    /// transmittance). `known` are the packed colors that were read before.
    fn hair(&self, setup: &Setup, colors: &Colors, slot: usize, known: [u32; 2]) -> [Vec4; 2];

    /// The values of the bodies in a pixel of the last drawn tile, whose corner is at `corner`.
    fn body(&self, lit: &Lit, bodies: &Bodies, corner: [usize; 2], samples: &Samples, pixel: usize) -> Vec3;

    /// The pixel at column and row `at`. `blended` holds the blended values and the transmittance; `wall` is
    /// the backdrop there.
    fn pixel(&self, setup: &Setup, at: [usize; 2], blended: Vec4, wall: Vec3) -> Self::Pixel;
}

/// Light, tone mapped to 8 bits of sRGB.
pub(crate) struct Screen<'a> {
    pub encoder: &'a Encoder,
    /// [`Background::plain`](crate::lighting::Background::plain).
    pub plain: Option<Vec3>,
}

/// Linear light times coverage, and coverage.
pub(crate) struct Linear {
    /// Whether nothing is behind hair and bodies, instead of the backdrop.
    pub transparent: bool,
}

/// Depth [m] and motion since an earlier frame [pixels, y downward], times coverage, and coverage.
pub(crate) struct Geometry<'a> {
    pub before: &'a Before<'a>,
    /// The camera of the earlier frame.
    pub view: View,
}

impl Pass for Screen<'_> {
    type Pixel = [u8; 3];

    #[inline(always)]
    fn hair(&self, setup: &Setup, colors: &Colors, slot: usize, known: [u32; 2]) -> [Vec4; 2] {
        colors.open(setup, slot, known)
    }

    fn body(&self, lit: &Lit, bodies: &Bodies, corner: [usize; 2], samples: &Samples, pixel: usize) -> Vec3 {
        bodies.average(lit, corner, samples, pixel, |_, body, t, at| skin::light(lit, body, t, at))
    }

    #[inline(always)]
    fn pixel(&self, setup: &Setup, at: [usize; 2], blended: Vec4, wall: Vec3) -> [u8; 3] {
        let wall = if self.plain.is_some() { Vec3::ZERO } else { wall };
        let light = blended.truncate() + setup.behind(wall, at, blended.w) * blended.w;
        let light = light * setup.frame.lighting.exposure.exp2();
        let shown = match self.plain {
            Some(plain) => {
                filmic_on(plain, light, Vec3::ONE - setup.share_of_wall(at, blended.w) * blended.w)
            }
            None => filmic(light),
        };
        self.encoder.encode(shown, at[0], at[1])
    }
}

impl Pass for Linear {
    type Pixel = Vec4;

    #[inline(always)]
    fn hair(&self, setup: &Setup, colors: &Colors, slot: usize, known: [u32; 2]) -> [Vec4; 2] {
        colors.open(setup, slot, known)
    }

    fn body(&self, lit: &Lit, bodies: &Bodies, corner: [usize; 2], samples: &Samples, pixel: usize) -> Vec3 {
        bodies.average(lit, corner, samples, pixel, |_, body, t, at| skin::light(lit, body, t, at))
    }

    #[inline(always)]
    fn pixel(&self, setup: &Setup, at: [usize; 2], blended: Vec4, wall: Vec3) -> Vec4 {
        let (behind, cover) = match self.transparent {
            false => (setup.behind(wall, at, blended.w), 1.0),
            // The ground's own light, and the fraction that it lets through.
            true => {
                let through = setup.share_of_wall(at, blended.w);
                (setup.behind(Vec3::ZERO, at, blended.w), 1.0 - through.element_sum() / 3.0)
            }
        };
        let light = blended.truncate() + behind * blended.w;
        let cover = 1.0 - blended.w * (1.0 - cover);
        (light * setup.frame.lighting.exposure.exp2()).extend(cover.clamp(0.0, 1.0))
    }
}

impl Geometry<'_> {
    /// Depth and motion of a point that was at `before`.
    fn at(&self, view: &View, now: Vec3, before: Vec3) -> Vec3 {
        let (now, before) = (view.project(now), self.view.project(before));
        let motion = (now - before).truncate();
        // A point that was behind the camera has no place in the earlier picture.
        let motion = if motion.is_finite() && before.z > 0.0 { motion } else { Vec2::ZERO };
        Vec3::new(now.z, motion.x, motion.y)
    }
}

impl Pass for Geometry<'_> {
    type Pixel = Vec4;

    #[inline(always)]
    fn hair(&self, setup: &Setup, _: &Colors, slot: usize, _: [u32; 2]) -> [Vec4; 2] {
        let owner = &setup.order.owners[slot / LANES];
        let hair = &setup.frame.hair[owner.hair as usize];
        let range = hair.range(owner.strand as usize);
        let before = self.before.hair.get(owner.hair as usize).copied().unwrap_or_default();
        let first = range.start + owner.first as usize + slot % LANES;
        [first, first + 1].map(|i| {
            let i = i.min(range.end - 1);
            let now = hair.points[i];
            self.at(&setup.view, now, before.get(i).copied().unwrap_or(now)).extend(-1.0)
        })
    }

    fn body(&self, lit: &Lit, bodies: &Bodies, corner: [usize; 2], samples: &Samples, pixel: usize) -> Vec3 {
        bodies.average(lit, corner, samples, pixel, |b, body, t, at| {
            let before = self.before.bodies.get(b).copied().filter(|p| p.len() == body.positions.len());
            let corners = |positions: &[Vec3]| body.triangles[t].map(|i| positions[i as usize]);
            let (p, weight) = skin::meet(lit.view, corners(body.positions), at);
            let earlier = before.map_or(p, |positions| {
                let [a, b, c] = corners(positions);
                a * weight.x + b * weight.y + c * weight.z
            });
            self.at(lit.view, p, earlier)
        })
    }

    #[inline(always)]
    fn pixel(&self, _: &Setup, _: [usize; 2], blended: Vec4, _: Vec3) -> Vec4 {
        blended.truncate().extend(1.0 - blended.w)
    }
}
