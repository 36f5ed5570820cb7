//! The curvature model: stretch, and bending by the curvature vector in a frame carried from the root.

use super::{
    At, Model, Solved,
    bend::{bend, transport},
};
use crate::{
    simd::{
        dispatch::{dispatch, dispatch_double},
        lanes::{Simd, V3, load},
    },
    strand::{
        band::Band,
        frame_context::FrameContext,
        integrate::{Implicit, run_tile},
        precomputed::Precomputed,
        root::Root,
        scratch::{Memory, Scratch},
        tile::{Tile, rest},
    },
};
use fearless_simd::Level;

/// Bending in a frame that is parallel-transported along the strand and has no twist. It is exact and
/// cheapest for strands that are straight at rest, where the frame does not matter (see `straight`). Swinging
/// curls gain energy in it, because the force neglects its effect on the frames farther along the strand. Strands that turn
/// by more than half a turn therefore use the rod (see `simulation/build.rs`).
#[derive(Clone, Copy)]
pub struct Curvature<S: Simd> {
    /// The frame's normal on segment i.
    normal: V3<S>,
}

impl<S: Simd> Model<S, 3, 9> for Curvature<S> {
    #[inline(always)]
    fn begin(_: S, _: &Tile, root: &Root<S>) -> Self {
        Self { normal: root.normal }
    }

    #[inline(always)]
    fn add(&mut self, simd: S, at: &At<S>, _: &Scratch, tile: &mut Tile, band: &mut Band<S, 3, 9>) {
        let joint = &tile.rest[at.i + 1];
        let stiffness = load(simd, &joint[rest::BEND]);
        let turn = V3::load(simd, &joint[rest::TURN..]);
        let d = turn_in_frame(turn, self.normal, at.u[0]);
        let last = at.u[1].dot(at.u[1]).simd_eq(0.0);
        self.normal = V3::select(last, self.normal, transport(self.normal, at.u[0], at.u[1]));
        bend([at.e, at.drift], at.u[0], at.inverse_length, d, stiffness, stiffness * at.damped)
            .joint
            .add_to(band);
    }

    #[inline(always)]
    fn take(_: S, _: &Solved<S, 9>, _: &mut Tile, _: &[Precomputed]) {}
}

/// Advances one tile through a frame with the implicit integrators, and the widest available SIMD
/// instructions.
pub fn run(level: Level, frame: &FrameContext, tile: &mut Tile, memory: &mut Memory) {
    if tile.layout.double {
        dispatch_double!(level, simd => run_tile::<_, Curvature<_>, Implicit, 3, 9>(simd, frame, tile, memory));
    } else {
        dispatch!(level, simd => run_tile::<_, Curvature<_>, Implicit, 3, 9>(simd, frame, tile, memory));
    }
}

/// Converts a rest turn to world axes. The frame is (normal, binormal, tangent).
#[inline(always)]
pub fn turn_in_frame<S: Simd>(turn: V3<S>, normal: V3<S>, tangent: V3<S>) -> V3<S> {
    normal.mul_add(turn.x, tangent.cross(normal).mul_add(turn.y, tangent * turn.z))
}
