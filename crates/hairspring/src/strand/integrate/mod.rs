//! One tile through one exchange interval, every substep while its points are in the first-level caches; one file an integrator.
//!
//! A substep is: root driven → the integrator's new positions → strain limit and contact, root to tip → velocities.

mod explicit;
mod ftl;
mod implicit;
mod local_global;

use super::{
    assemble::Step,
    interval::Interval,
    lanes::{F, V3, load, store},
    limit::{Finish, LIMIT, limit},
    model::Stretching,
    root::Root,
    scratch::Scratch,
    tile::{Elastic, Tile, hold, rest, state},
};
use crate::scene::Integrator;
use fearless_simd::prelude::*;

/// All substeps of `interval` for one tile.
#[inline(always)]
pub fn run_tile<S: Simd>(simd: S, interval: &Interval, tile: &mut Tile, scratch: &mut Scratch) {
    scratch.reserve(tile.rest.len());
    free_masses(simd, tile, scratch);
    if interval.integrator == Integrator::LocalGlobal {
        local_global::factor(simd, interval.h, tile, scratch);
    }
    let mut root = Root::between(simd, tile.strand, 0.0, &interval.anchor);
    let mut continues = interval.continues;
    for substep in &interval.substeps {
        let next = Root::at(simd, tile.strand, substep);
        let moved = next.position - root.position;
        root = next;
        // Where the solve starts: every point where it was, the driven segment already where it goes.
        for (x, at) in scratch.x.iter_mut().zip(tile.state.iter()) {
            x.copy_from_slice(&at[state::X..state::X + 3]);
        }
        V3::zero(simd).store(&mut scratch.x[0]);
        root.first.store(&mut scratch.x[1]);
        if tile.model == Elastic::Springs {
            Root::third(simd, tile.strand, substep).store(&mut scratch.x[2]);
        }

        let second_order = interval.integrator == Integrator::Bdf2 && continues;
        let mut step = Step {
            h: interval.h,
            gravity: interval.gravity,
            wind: substep.wind,
            root,
            moved,
            second_order,
            obstacles: &substep.obstacles,
            stretching: Stretching::Moderate,
        };
        let mut finish = Finish { h: interval.h, limit: LIMIT, press: 0.0, second_order, kick: None };
        match interval.integrator {
            Integrator::BackwardEuler | Integrator::Bdf2 => {
                implicit::advance(simd, interval, &step, tile, scratch);
                finish.press = step.inertia() / (step.h * step.h);
            }
            Integrator::ExplicitEuler | Integrator::Verlet => {
                step.stretching = Stretching::Fibre;
                finish.limit = f32::INFINITY;
                explicit::advance(simd, interval.integrator, &step, tile, scratch);
                finish.kick = Some(&scratch.kick);
            }
            Integrator::LocalGlobal => {
                finish.limit = f32::INFINITY;
                local_global::advance(simd, interval.iterations, &step, tile, scratch);
            }
            Integrator::Ftl | Integrator::Dftl => {
                finish.limit = f32::INFINITY;
                ftl::advance(simd, interval.integrator, &step, tile, scratch);
                finish.kick = Some(&scratch.kick);
            }
        }
        let solved = (&scratch.x[..], &scratch.inverse_mass[..]);
        match tile.model {
            Elastic::Springs => limit::<S, 2>(simd, &finish, substep, &root, moved, tile, solved),
            Elastic::Curvature | Elastic::Rod => {
                limit::<S, 1>(simd, &finish, substep, &root, moved, tile, solved);
            }
        }
        continues = true;
    }
}

/// Inverse masses of the points that projection may move.
#[inline(always)]
fn free_masses<S: Simd>(simd: S, tile: &Tile, scratch: &mut Scratch) {
    let zero = F::<S>::splat(simd, 0.0);
    for (i, at) in tile.rest.iter().enumerate() {
        let mass = load(simd, &at[rest::MASS]);
        let inverse = if i < tile.model.driven() {
            zero
        } else {
            mass.simd_gt(0.0).select(F::splat(simd, 1.0) / mass, zero)
        };
        store(inverse, &mut scratch.inverse_mass[i]);
    }
    for hold in tile.holds {
        let row = &mut scratch.inverse_mass[hold.point as usize];
        let inverse = load(simd, row);
        store(load(simd, &hold.rows[hold::PINNED]).simd_gt(0.0).select(zero, inverse), row);
    }
}

/// Acceleration of point `i` by gravity and by the air it moves through [m/s²]; `u` is the segment from it.
#[inline(always)]
fn outside<S: Simd>(simd: S, step: &Step<S>, tile: &Tile, i: usize, u: V3<S>) -> V3<S> {
    let drag = Root::<S>::fibre(simd, tile.strand).0;
    let slip = V3::splat(simd, step.wind) - V3::load(simd, &tile.state[i][state::V..]);
    let slip = slip - u * (u.dot(slip) * 0.5);
    slip.mul_add(drag, V3::splat(simd, step.gravity))
}
