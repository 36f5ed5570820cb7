//! Velocity of the air at a point and a time: the directional wind, wind sources, turbulence and wind
//! occlusion.
//!
//! ```text
//! air(x) = T(x) ( W(t) + Σ sources(x) + turbulence(x, t) )
//! ```
//!
//! | file | |
//! | --- | --- |
//! | [`gust`] | variation of the wind over time |
//! | [`source`] | points, vortices and fans |
//! | [`turbulence`] | curl noise |
//! | [`occlusion`] | T, the fraction of the wind that bodies and hair let through |
//!
//! W is the directional wind. It is the same everywhere and is evaluated for every substep; several
//! directional winds would add up to one. Everything else is sampled once a frame, at the positions of the
//! points at its start and at the time of its middle, and stays constant during the frame.
//!
//! # Limitations
//! The air is prescribed, not simulated: hair and bodies slow it down but do not deflect it. The velocity of
//! a moving source is not added to its wind.
//!
//! # Example
//! ```
//! use glam::Vec3;
//! use hairspring::{air::{Air, Flow, WindSource}, math::RigidTransform, settings::Wind};
//!
//! // A fan that blows along X, in a breeze.
//! let shape = Flow::Fan { center: Vec3::ZERO, axis: Vec3::X, radius: 0.1, speed: 4.0, spread: 11.8 };
//! let fan = WindSource { joint: None, shape, gust: 0.0, gust_rate: 0.0 };
//! let sources = [fan.at_time(0, RigidTransform::default(), 0.0)];
//! let wind = Wind { velocity: Vec3::Z, ..Default::default() };
//! let air = Air { wind, sources: &sources, ..Default::default() };
//! assert!(air.sources[0].velocity(Vec3::X * 0.1).x > 3.0);
//! ```

mod gust;
mod occlusion;
mod source;
mod turbulence;

pub(crate) use occlusion::OcclusionSampler;
pub use occlusion::WindOcclusion;
pub use source::{Flow, Source, WindSource};
pub(crate) use turbulence::Noise;
pub use turbulence::Turbulence;

use crate::settings::Wind;
use glam::Vec3;
use gust::Gust;

/// The air during a frame. The default is still air.
///
/// For an example, see [`air`](crate::air).
#[derive(Clone, Copy, Debug, Default)]
pub struct Air<'a> {
    /// The directional wind, the same everywhere.
    pub wind: Wind,
    /// Time at the start of the frame [s]. Gusts and eddies change with it, so the caller advances it by the
    /// length of each frame.
    pub time: f64,
    /// Wind sources, at their poses in this frame.
    pub sources: &'a [Source],
    /// Turbulence, which the directional wind carries along.
    pub turbulence: Turbulence,
}

impl Air<'_> {
    /// Returns the directional wind at the time `after` [s] from the start of the frame [m/s].
    pub(crate) fn uniform(&self, after: f32) -> Vec3 {
        self.wind.velocity * self.gust().factor(self.time + f64::from(after))
    }

    fn gust(&self) -> Gust {
        Gust { amount: self.wind.gust, rate: self.wind.gust_rate, phase: 0.0 }
    }

    /// Returns whether the velocity varies in space.
    pub(crate) fn varies(&self) -> bool {
        !self.sources.is_empty() || self.turbulence.is_on()
    }

    /// Returns whether there is a directional wind or a wind source. Wind occlusion follows these only.
    pub(crate) fn steady_moves(&self) -> bool {
        !self.sources.is_empty() || self.wind.velocity != Vec3::ZERO
    }

    /// Returns whether the air moves at all.
    pub(crate) fn moves(&self) -> bool {
        self.steady_moves() || self.turbulence.is_on()
    }

    /// Samples the air at the middle of a frame of `dt` [s]. `noise` is reused as storage.
    pub(crate) fn moment<'a>(&'a self, dt: f32, noise: &'a mut Noise) -> AirSample<'a> {
        let middle = self.time + 0.5 * f64::from(dt);
        let way = self.wind.velocity.as_dvec3() * self.gust().integral(middle);
        let noise = self.turbulence.is_on().then(|| {
            noise.set(&self.turbulence, way, middle);
            &*noise
        });
        AirSample { uniform: self.uniform(0.5 * dt), sources: self.sources, noise }
    }
}

/// The air at one point in time.
#[derive(Clone, Copy)]
pub(crate) struct AirSample<'a> {
    /// The directional wind [m/s].
    pub uniform: Vec3,
    sources: &'a [Source],
    noise: Option<&'a Noise>,
}

impl AirSample<'_> {
    /// Returns the velocity at `place` without turbulence and without occlusion [m/s].
    pub fn steady(&self, place: Vec3) -> Vec3 {
        self.sources.iter().fold(self.uniform, |sum, source| sum + source.velocity(place))
    }

    /// Returns the velocity at `place` without occlusion [m/s].
    pub fn velocity(&self, place: Vec3) -> Vec3 {
        self.steady(place) + self.noise.map_or(Vec3::ZERO, |noise| noise.velocity(place))
    }
}
