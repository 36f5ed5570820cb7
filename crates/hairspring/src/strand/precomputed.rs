//! Values that stay constant for a frame: inverse masses and lengths, and the stiffness of the springs along
//! the segments.

use super::{
    model::{Stretching, springs},
    scratch::Scratch,
    tile::{self, Elastic, Tile, hold, rest},
};
use crate::simd::lanes::{F, Simd, Work, load, store};

/// Constants of one point of a tile for a frame.
#[derive(Clone, Copy, Default)]
pub struct Precomputed {
    /// Inverse mass [1/kg]; 0 for driven points, held points and the padding.
    pub inverse_mass: Work,
    /// Inverse rest length of the segment from this point to the strand's next [1/m]; 0 for padding.
    pub inverse_length: Work,
    /// Stiffness of the spring along that segment [N/m]; 0 for padding.
    pub along: Work,
    /// Inverse rest lengths of the springs to the second and third particle after this one; springs model
    /// only [1/m].
    pub inverse_spans: [Work; 2],
}

/// Fills `scratch.fixed` for substeps of `h` [s].
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn precompute<S: Simd>(simd: S, h: f32, stretching: Stretching, tile: &Tile, scratch: &mut Scratch) {
    let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
    for (i, at) in tile.rest.iter().enumerate() {
        let mass = load(simd, &at[rest::MASS]);
        let free = i >= tile.layout.model.driven();
        let inverse_mass = if free { mass.simd_gt(0.0).select(one / mass, zero) } else { zero };
        let length = load(simd, &at[rest::LENGTH]);
        let inverse_length = length.simd_gt(0.0).select(one / length.max(1e-12), zero);
        let mut along = stretching.stiffness(simd, h, tile, i);
        if tile.layout.model == Elastic::Springs {
            along += springs::brace(simd, h, tile, i);
            for (row, span) in
                scratch.fixed[i].inverse_spans.iter_mut().zip([tile::springs::L2, tile::springs::L3])
            {
                store(one / load(simd, &at[span]).max(1e-12), row);
            }
        }
        let fixed = &mut scratch.fixed[i];
        store(inverse_mass, &mut fixed.inverse_mass);
        store(inverse_length, &mut fixed.inverse_length);
        store(along, &mut fixed.along);
    }
    for hold in tile.holds {
        let row = &mut scratch.fixed[hold.point as usize].inverse_mass;
        let inverse = load(simd, row);
        store(load(simd, &hold.rows[hold::PINNED]).simd_gt(0.0).select(zero, inverse), row);
    }
}
