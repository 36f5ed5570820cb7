//! Wind occlusion: how much of the wind reaches a point behind bodies and hair.
//!
//! ```text
//!  wind ⇉    ⇉ → ( body ) ·   · → ⇉     T = e^(−τ),   τ = ∫₀^reach (1 − s/reach) ( β inside a body + η fill ) ds,
//!                                       s: distance upwind from the point
//! ```
//!
//! The ray is marched upstream. Each step follows the local wind, so the ray bends around a vortex, and it
//! ends where the air is still, such as behind a fan. The fill is the fill ratio of a cell of the hair
//! volume's grid, 1 at rest. Exponential attenuation has been measured for wind in plant canopies (Cionco
//! 1965, *A mathematical model for air flow in a vegetative canopy*), and also describes light in a cloud.
//! Two parts of the model are our own: a body attenuates like dense hair, and the occlusion fades to nothing
//! at `reach`, as a wake fills up. T is computed at the nodes of the grid and interpolated at points.
//!
//! # Limitations
//! Blocked air does not flow around a collider: there is no faster wind at its edges. Follow hairs are
//! occluded as their guides are.

use super::AirSample;
use crate::parallel::prelude::*;
use crate::settings::{When, define_settings};
use crate::{collide::FrameColliders, volume::Density};
use glam::Vec3;

/// The condition under which occlusion has an effect. It follows the steady wind: turbulence alone has no
/// direction from which a body could shelter hair.
const WIND_BLOWS: When = When::Any(&[When::Not0("wind.velocity"), When::Has("wind_source")]);

define_settings! {
    /// Occlusion of the wind by bodies and hair.
    ///
    /// ```
    /// use hairspring::{air::WindOcclusion, prelude::*};
    ///
    /// let strand: Vec<Vec3> = (0..8).map(|i| Vec3::NEG_Y * (0.01 * i as f32)).collect();
    /// let mut simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).build()?;
    /// let occlusion = WindOcclusion { body: 1.0, ..Default::default() };
    /// assert!(occlusion.is_on());
    /// simulation.set_wind_occlusion(&occlusion)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct WindOcclusion {
        /// Attenuation of the wind inside a body, β. 0: bodies do not block the wind. With 100, the wind falls to
        /// 1/e within one centimeter.
        body: f32 = 0.0, ["1/m"], {0 or more}, when WIND_BLOWS;
        /// Attenuation of the wind in hair that is as dense as at rest, η. Hair also shelters itself by its
        /// density, which is not affected. With 50, the wind falls to 1/e within two centimeters.
        ///
        /// Density is relative to the groom at rest, so a single strand occludes like dense hair.
        hair: f32 = 0.0, ["1/m"], {0 or more}, when WIND_BLOWS;
        /// Distance behind an occluder at which the wind has recovered. The default is about three head lengths.
        reach: f32 = 0.5, ["m"], {above 0}, when When::All(&[
            WIND_BLOWS,
            When::Any(&[When::Above0("wind_occlusion.body"), When::Above0("wind_occlusion.hair")]),
        ]);
    }
}

impl WindOcclusion {
    /// Returns whether bodies or hair block the wind.
    pub fn is_on(&self) -> bool {
        self.body > 0.0 || self.hair > 0.0
    }
}

/// Maximum number of steps of a ray.
const MAX_STEPS: usize = 256;

/// Optical depth at which the ray stops because no wind is left.
const MAX_OPTICAL_DEPTH: f32 = 8.0;

/// Speed below which the air counts as still, relative to the speed at the start of the ray [1].
const MIN_RELATIVE_SPEED: f32 = 0.05;

/// T at the grid nodes that are near hair.
#[derive(Default)]
pub(crate) struct OcclusionSampler {
    /// T, 1 where there is no hair; shape `[nodes]`.
    left: Vec<f32>,
}

impl OcclusionSampler {
    /// Reserves memory for at most `nodes` grid nodes.
    pub fn reserve(&mut self, nodes: usize) {
        self.left.reserve_exact(nodes.saturating_sub(self.left.len()));
    }

    /// Computes T at the start of a frame.
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

    /// Returns T at `place` in world space [1].
    pub fn left(&self, hair: &Density, place: Vec3) -> f32 {
        hair.between_nodes(place, &self.left).unwrap_or(1.0)
    }
}

/// Returns the optical depth τ at the point `from`.
fn depth(
    occlusion: &WindOcclusion,
    air: &AirSample,
    bodies: &FrameColliders,
    hair: &Density,
    from: Vec3,
) -> f32 {
    let (mut at, mut way, mut depth) = (from, 0.0, 0.0);
    let calm = MIN_RELATIVE_SPEED * air.steady(from).length();
    for _ in 0..MAX_STEPS {
        let wind = air.steady(at);
        let speed = wind.length();
        // Written so that a NaN ends the loop.
        let goes_on = speed > calm && way < occlusion.reach && depth < MAX_OPTICAL_DEPTH;
        if !goes_on {
            break;
        }
        // Outside the hair grid, step over the distance that is certain to be free of bodies.
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
