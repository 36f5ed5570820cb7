//! The curvature model for strands that are straight at rest. It has no rest turn and needs no frame, and its
//! blocks are multiples of the identity.

use super::{At, Model, Solved};
use crate::{
    simd::{
        dispatch::{dispatch, dispatch_double},
        lanes::{Simd, load},
    },
    strand::{
        band::Band,
        frame_context::FrameContext,
        integrate::{Implicit, run_tile},
        precomputed::Precomputed,
        profile::Profile,
        root::Root,
        scratch::{Memory, Scratch},
        system::System,
        tile::{Tile, rest},
    },
};
use fearless_simd::Level;

/// Bending by the curvature vector with d = 0, which is `bend` with P the identity.
#[derive(Clone, Copy)]
pub struct Straight;

impl<S: Simd> Model<S, 3, 9> for Straight {
    // Points i and i+2 are coupled by bending only, each axis separately.
    const PROFILE: Profile<3, 9> = Profile::within(6);

    #[inline(always)]
    fn begin(_: S, _: &Tile, _: &Root<S>) -> Self {
        Self
    }

    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn add(&mut self, simd: S, at: &At<S>, _: &Scratch, tile: &mut Tile, band: &mut Band<S, 3, 9>) {
        let stiffness = load(simd, &tile.rest[at.i + 1][rest::BEND]);
        let ([e0, e1], [alpha, beta]) = (at.e, at.inverse_length);
        let implicit = stiffness * at.damped;
        let [d0, d1] = at.drift;
        let moment = (e1 * beta - e0 * alpha) * stiffness + (d1 * beta - d0 * alpha) * implicit;
        let pull = [moment * alpha, moment * beta];
        band.add_force(0, -pull[0]);
        band.add_force(1, pull[0] + pull[1]);
        band.add_force(2, -pull[1]);

        let (a, b) = (implicit * alpha, implicit * beta);
        let [aa, ab, bb] = [a * alpha, a * beta, b * beta];
        band.add_identity(0, aa);
        band.add_identity(1, aa + ab + ab + bb);
        band.add_identity(2, bb);
        band.add_identity_block(0, 1, -(aa + ab));
        band.add_identity_block(0, 2, ab);
        band.add_identity_block(1, 2, -(ab + bb));
    }

    #[inline(always)]
    fn take(_: S, _: &Solved<S, 9>, _: &mut Tile, _: &[Precomputed]) {}
}

/// Advances one tile through a frame with the implicit integrators, and the widest available SIMD
/// instructions.
pub fn run(level: Level, frame: &FrameContext, tile: &mut Tile, memory: &mut Memory) {
    if tile.layout.double {
        dispatch_double!(level, simd => run_tile::<_, Straight, Implicit, 3, 9>(simd, frame, tile, memory));
    } else {
        dispatch!(level, simd => run_tile::<_, Straight, Implicit, 3, 9>(simd, frame, tile, memory));
    }
}
