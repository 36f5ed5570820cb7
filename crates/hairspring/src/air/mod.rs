//! What velocity the air has at a place and a time: the wind of all points, sources of wind, turbulence, and who stands in their lee.
//!
//! ```text
//! air(x) = T(x) ( W(t) + Σ sources(x) + turbulence(x, t) )
//! ```
//!
//! | file | |
//! | --- | --- |
//! | [`gust`] | how wind comes and goes |
//! | [`source`] | points, vortices and fans |
//! | [`turbulence`] | curl noise |
//! | [`occlusion`] | T, what a body and hair leave of the wind behind them |
//!
//! W is the directional wind, the same everywhere and known to every substep: several of them would be one. All else is found once a
//! frame, at the places that points have at its start and the time of its middle, and frozen for the frame.
//!
//! # Missing
//! Air is given, not simulated: hair and bodies shelter, but do not turn it aside. A source's own motion is not added to its wind.

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

/// The air of a frame. Default: still.
#[derive(Clone, Copy, Default)]
pub struct Air<'a> {
    /// The wind of all points.
    pub wind: Wind,
    /// Time at the start of the frame [s].
    pub time: f64,
    /// What blows besides, each where it is in the frame.
    pub sources: &'a [Source],
    /// Eddies, which the wind of all points carries along.
    pub turbulence: Turbulence,
}

impl Air<'_> {
    /// The wind of all points `after` the start of the frame [m/s].
    pub(crate) fn uniform(&self, after: f32) -> Vec3 {
        self.wind.velocity * self.gust().factor(self.time + f64::from(after))
    }

    fn gust(&self) -> Gust {
        Gust { amount: self.wind.gust, rate: self.wind.gust_rate, phase: 0.0 }
    }

    /// Whether it moves otherwise in one place than in another.
    pub(crate) fn varies(&self) -> bool {
        !self.sources.is_empty() || self.turbulence.is_on()
    }

    /// Whether it moves at all.
    pub(crate) fn moves(&self) -> bool {
        self.varies() || self.wind.velocity != Vec3::ZERO
    }

    /// The air in the middle of a frame of `dt` [s]; `noise` is memory.
    pub(crate) fn moment<'a>(&'a self, dt: f32, noise: &'a mut Noise) -> AirSample<'a> {
        let middle = self.time + 0.5 * f64::from(dt);
        let way = self.wind.velocity.as_dvec3() * self.gust().travelled(middle);
        let noise = self.turbulence.is_on().then(|| {
            noise.set(&self.turbulence, way, middle);
            &*noise
        });
        AirSample { uniform: self.uniform(0.5 * dt), sources: self.sources, noise }
    }
}

/// The air at one time.
#[derive(Clone, Copy)]
pub(crate) struct AirSample<'a> {
    /// The wind of all points [m/s].
    pub uniform: Vec3,
    sources: &'a [Source],
    noise: Option<&'a Noise>,
}

impl AirSample<'_> {
    /// Its velocity at `place` without eddies: what comes from somewhere [m/s].
    pub fn steady(&self, place: Vec3) -> Vec3 {
        self.sources.iter().fold(self.uniform, |sum, source| sum + source.velocity(place))
    }

    /// Its velocity at `place`, where nothing shelters it [m/s].
    pub fn velocity(&self, place: Vec3) -> Vec3 {
        self.steady(place) + self.noise.map_or(Vec3::ZERO, |noise| noise.velocity(place))
    }
}
