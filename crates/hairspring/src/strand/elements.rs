//! The downward sweep that fills the band: the entries of the elastic model and of stretch at each point, and
//! the starting point of the solve.

use super::{
    assemble::{Linearization, SubstepContext},
    band::Band,
    model::{
        At, Model,
        stretch::{SIDEWAYS_BDF2, Sideways, stretch},
    },
    profile::Profile,
    root::Root,
    scratch::Scratch,
    system::System,
    tile::{Tile, multipliers, rest, state},
};
use crate::simd::lanes::{F, Simd, V3, Work, load};

/// The downward sweep that fills the band with elastic elements.
pub struct Elements<S: Simd, M, const B: usize, const N: usize> {
    /// The window, which begins at the current point.
    pub band: Band<S, B, N>,
    model: M,
    /// The state of the sweep.
    pub cursor: AssemblyCursor<S>,
}

/// The position of a downward sweep, and values that hold for all of it.
#[derive(Clone, Copy)]
pub struct AssemblyCursor<S: Simd> {
    at: At<S>,
    /// Position of the next particle, relative to the root [m].
    pub x: V3<S>,
    /// Displacement of that particle since the start of the substep [m]; only used by Newton iterations.
    pub displacement: V3<S>,
    /// Velocity of the root in the last substep [m/s].
    pub root_velocity: V3<S>,
    /// Forces that are the same at all points.
    pub ambient: UniformForces<S>,
    /// Half of `strand::DRAG` [Pa s].
    half_drag: F<S>,
    /// See [`stretch`].
    sideways: Sideways<S>,
}

impl<S: Simd, M: Model<S, B, N>, const B: usize, const N: usize> Elements<S, M, B, N> {
    /// Starts at the root.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub fn begin(
        simd: S,
        sweep: Linearization,
        step: &SubstepContext<S>,
        tile: &Tile,
        scratch: &mut Scratch,
    ) -> Self {
        let (drag, damping) = Root::<S>::fiber(simd, tile.strand);
        let zero = V3::zero(simd);
        let mut first = V3::load(simd, &scratch.edges[1]);
        if M::STRIDE == 2 {
            first += V3::load(simd, &scratch.edges[2]);
        }
        let at = At {
            i: 0,
            phase: 0,
            e: [first; 2],
            u: [first.length_and_unit().1; 2],
            inverse_length: [F::splat(simd, 0.0); 2],
            damped: damping * (1.0 / step.h) + 1.0,
            length_error_share: sweep.length_error_share(),
            drift: [zero; 2],
            prediction_time: F::splat(simd, sweep.prediction_time(step.h)),
            h: step.h,
        };
        let begin = 2 * Profile::<B, N>::REACH * M::PROFILE.rows();
        scratch.factors[..begin].fill(Work::default());
        scratch.altitude_springs.clear();
        let (band, model, half_drag) = (Band::new(simd), M::begin(simd, tile, &step.root), drag * 0.5);
        let share = if step.second_order { SIDEWAYS_BDF2 } else { M::SIDEWAYS };
        let sideways = Sideways::new(simd, share, step.h, step.touches);
        let root_velocity = V3::load(simd, &tile.state[0][state::V..]);
        let now = step.moved * F::splat(simd, 1.0 / step.h);
        let ambient = UniformForces {
            pull: (root_velocity - now).mul_add(F::splat(simd, 1.0 / step.h), V3::splat(simd, step.gravity)),
            wind: V3::splat(simd, step.wind) + (root_velocity - now),
        };
        let cursor =
            AssemblyCursor { at, x: zero, displacement: zero, root_velocity, ambient, half_drag, sideways };
        Self { band, model, cursor }
    }

    /// Returns the state of the sweep between two points. The window is not part of it, because each point begins a new
    /// one.
    #[inline(always)]
    pub fn suspend(self) -> (M, AssemblyCursor<S>) {
        (self.model, self.cursor)
    }

    /// Continues a sweep that was suspended.
    #[inline(always)]
    pub fn resume(simd: S, (model, cursor): (M, AssemblyCursor<S>)) -> Self {
        Self { band: Band::new(simd), model, cursor }
    }

    /// Adds the elements that begin at the next point `i`: those of the model, and the stretch of the
    /// strand's segment from point i+1. `phase` is i modulo the model's stride. The cursor knows both; they
    /// are parameters so that the compiler sees them as constants.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub fn add(&mut self, simd: S, i: usize, phase: usize, tile: &mut Tile, scratch: &Scratch) -> Segment<S> {
        let Scratch { edges, fixed, .. } = scratch;
        let Self { band, model, cursor } = self;
        (cursor.at.i, cursor.at.phase) = (i, phase);
        *band = Band::new(simd);
        let next = i + 1;
        cursor.x += V3::load(simd, &edges[next]);
        let row = &tile.rest[next];
        let mass = load(simd, &row[rest::MASS]);
        if let Some(rows) = tile.multipliers.get(next) {
            let damping = Root::<S>::fiber(simd, tile.strand).1 * load(simd, &rows[multipliers::DAMPING]);
            cursor.at.damped = damping * (1.0 / cursor.at.h) + 1.0;
        }
        if phase + 1 < M::STRIDE {
            model.add(simd, &cursor.at, scratch, tile, band);
            // Extra particles are not part of the fiber and have no drag.
            return Segment { u: cursor.at.u[1], mass, air: F::splat(simd, 0.0) };
        }
        // Loaded again instead of kept from the previous point, because those values would be spilled to
        // memory anyway.
        let (before, far) = (next - M::STRIDE, next + M::STRIDE);
        let [v1, v2] =
            [next, far.min(tile.rest.len() - 1)].map(|i| V3::load(simd, &tile.state[i][state::V..]));
        let segment = |to: usize| {
            let last = V3::load(simd, &edges[to]);
            if M::STRIDE == 1 { last } else { V3::load(simd, &edges[to - 1]) + last }
        };
        let e = segment(far);
        let (l, u) = e.length_and_unit();
        let at = &mut cursor.at;
        at.e = [segment(next), e];
        at.drift = [at.drift[1], (v2 - v1) * at.prediction_time];
        at.u = [at.u[1], u];
        at.inverse_length = [before, next].map(|i| load(simd, &fixed[i].inverse_length));
        model.add(simd, at, scratch, tile, band);

        let length = load(simd, &row[rest::LENGTH]);
        let k = load(simd, &fixed[next].along);
        let tension = load(simd, &tile.state[next][state::TENSION]);
        let (force, block) = stretch(
            (l, u),
            (l - length) * at.length_error_share,
            (k, tension, mass),
            at.drift[1],
            &cursor.sideways,
        );
        band.add_diagonal(1, block);
        band.add_diagonal(1 + M::STRIDE, block);
        band.add_block(1, 1 + M::STRIDE, &-block.full());
        band.add_force(1, force);
        band.add_force(1 + M::STRIDE, -force);
        let air = tile.at_particle(cursor.half_drag, next, multipliers::DRAG)
            * (load(simd, &tile.rest[before][rest::LENGTH]) + length);
        Segment { u, mass, air }
    }

    /// Adds the same elements, and the force of the spring across four points, which a solve eliminates
    /// separately.
    #[inline(always)]
    pub fn add_forces(&mut self, simd: S, i: usize, tile: &mut Tile, scratch: &Scratch) {
        self.add(simd, i, i % M::STRIDE, tile, scratch);
        if M::has_altitude_spring(simd, i, tile, scratch) {
            let spring = M::altitude_spring(simd, (self.cursor.at.h, 0.0), i, tile, scratch);
            for (p, force) in spring.forces().into_iter().enumerate() {
                self.band.add_force(p, force);
            }
        }
    }
}

/// Properties of the point after the current one.
pub struct Segment<S: Simd> {
    /// Unit vector of the strand's segment that begins at the point; zero at the tip.
    pub u: V3<S>,
    /// Mass of the point [kg].
    pub mass: F<S>,
    /// Drag on the two half segments adjacent to the point, over velocity and the coefficients of `Drag` [N
    /// s/m].
    pub air: F<S>,
}

/// Forces that are the same at all points of a strand, under the assumption that the points move as the root
/// did.
#[derive(Clone, Copy)]
pub struct UniformForces<S: Simd> {
    /// Gravity minus the change of the root's velocity over the substep length [m/s²].
    pub pull: V3<S>,
    /// Wind minus the change of the root's velocity in the substep [m/s]. Minus the velocity of a point, it
    /// is the relative wind at the starting point of the solve.
    pub wind: V3<S>,
}

/// The starting point of the solve at one point of the strand, evaluated lazily. It is a struct with methods,
/// not closures: the compiler may leave closures outside of the code that it generates for the instruction
/// set, and each operation in them then becomes a call.
pub struct PredictedState<S: Simd> {
    pub sweep: Linearization,
    /// Velocity of the point relative to the root [m/s].
    pub faster: V3<S>,
    /// See [`Linearization::prediction_time`] [s].
    pub share: f32,
    /// Displacement since the start of the substep [m]; only used by Newton iterations.
    pub displacement: V3<S>,
}

impl<S: Simd> PredictedState<S> {
    /// Predicted displacement relative to the root's motion [m].
    #[inline(always)]
    pub fn drift(&self, simd: S) -> V3<S> {
        self.faster * F::splat(simd, self.share)
    }

    /// Displacement since the start of the substep [m].
    #[inline(always)]
    pub fn displacement(&self, simd: S) -> V3<S> {
        if self.sweep == Linearization::Initial { self.drift(simd) } else { self.displacement }
    }
}
