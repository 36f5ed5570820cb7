//! Wind occlusion: what bodies and hair leave of the wind behind them.
//!
//! ```text
//!  wind ⇉    ⇉ → ( body ) ·   · → ⇉     T = e^(−τ),   τ = ∫₀^reach (1 − s/reach) ( β inside a body + η fill ) ds,   s upwind from the point
//! ```
//!
//! The ray goes upstream, step by step against the wind that it meets, so that it bends around a vortex, and ends where the air is still: behind a
//! fan. Fill is how full a cell of the hair volume's lattice is, 1 as at rest. The exponential is what is measured of wind in a canopy of plants
//! (Cionco 1965, *A mathematical model for air flow in a vegetative canopy*), and of light in a cloud; that a body counts like dense hair, and that
//! lee fades to nothing at `reach`, as a wake fills up, is ours. Wind is found so at the nodes of the lattice, and taken by points between them.
//!
//! # Missing
//! Air that is kept out goes nowhere: there is no wind around an edge. Followers shelter as their guides.

use super::AirSample;
use crate::{collide::FrameColliders, volume::Density};
use glam::Vec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// How bodies and hair shelter from the wind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WindOcclusion {
    /// How fast wind falls off inside a body, β [1/m], 0 or more. Default 0: bodies do not shelter. With 100 it falls to 1/e in a centimetre.
    pub body: f32,
    /// How fast wind falls off in hair that is as dense as at rest, η [1/m], 0 or more. Default 0: hair does not shelter. With 50 it falls to
    /// 1/e in two centimetres. A groom's guides stand for all its hair: a lone strand counts as dense hair too.
    pub hair: f32,
    /// How far behind what shelters it the wind is whole again [m], above 0. Default 0.5: some three heads.
    pub reach: f32,
}

impl Default for WindOcclusion {
    fn default() -> Self {
        Self { body: 0.0, hair: 0.0, reach: 0.5 }
    }
}

impl WindOcclusion {
    /// Whether anything shelters.
    pub fn is_on(&self) -> bool {
        self.body > 0.0 || self.hair > 0.0
    }
}

/// Most steps of a ray.
const MOST_STEPS: usize = 256;

/// Depth at which nothing is left.
const DEEP: f32 = 8.0;

/// Air slower than this, over that where the ray begins, is still [1].
const CALM: f32 = 0.05;

/// What is left of the wind at each node of a lattice that hair is near.
#[derive(Default)]
pub(crate) struct OcclusionSampler {
    /// T, 1 where there is no hair; shape `[nodes]`.
    left: Vec<f32>,
}

impl OcclusionSampler {
    /// Room for so many nodes ever.
    pub fn reserve(&mut self, nodes: usize) {
        self.left.reserve_exact(nodes.saturating_sub(self.left.len()));
    }

    /// Finds T at the start of a frame.
    pub fn cast(
        &mut self,
        occlusion: &WindOcclusion,
        air: &AirSample,
        bodies: &FrameColliders,
        hair: &Density,
    ) {
        let none = FrameColliders::new((&[], None));
        let bodies = if occlusion.body > 0.0 { bodies } else { &none };
        let slab = hair.slab();
        self.left.clear();
        self.left.resize(hair.nodes(), 1.0);
        self.left.par_chunks_mut(slab.max(1)).enumerate().for_each(|(z, left)| {
            for (k, left) in left.iter_mut().enumerate() {
                let node = z * slab + k;
                if hair.is_near(node) {
                    let from = bodies.out(hair.place(node), 0.0);
                    *left = (-depth(occlusion, air, bodies, hair, from)).exp();
                }
            }
        });
    }

    /// What is left of the wind at `place` in the world [1].
    pub fn left(&self, hair: &Density, place: Vec3) -> f32 {
        hair.between_nodes(place, &self.left).unwrap_or(1.0)
    }
}

/// τ at a place.
fn depth(
    occlusion: &WindOcclusion,
    air: &AirSample,
    bodies: &FrameColliders,
    hair: &Density,
    from: Vec3,
) -> f32 {
    let (mut at, mut way, mut depth) = (from, 0.0, 0.0);
    let calm = CALM * air.steady(from).length();
    for _ in 0..MOST_STEPS {
        let wind = air.steady(at);
        let speed = wind.length();
        // Comparisons that a NaN fails.
        let goes_on = speed > calm && way < occlusion.reach && depth < DEEP;
        if !goes_on {
            break;
        }
        // Where there is no hair, as far as no body can be.
        let free = if hair.holds(at) { 0.0 } else { bodies.clearance(at) };
        let step = free.max(hair.cell()).min(occlusion.reach - way);
        let upwind = wind / -speed;
        let middle = at + upwind * (0.5 * step);
        let inside = (0.5 - bodies.clearance(middle) / step).clamp(0.0, 1.0);
        let fades = 1.0 - (way + 0.5 * step) / occlusion.reach;
        depth += step * fades * (occlusion.body * inside + occlusion.hair * hair.fill(middle));
        at += upwind * step;
        way += step;
    }
    depth
}
