//! Moving air that is not the same everywhere: sources of wind, eddies, and what is left of all wind in the lee of bodies and hair.
//!
//! ```text
//! Δu = T(x) (W + Σ sources(x) + turbulence(x)) − W          W: the wind of all points, which the kernel has of every substep
//! ```
//!
//! Drag (`strand/drag.rs`) acts on the velocity of that air relative to each point.

use super::StrandView;
use crate::{
    air::{AirSample, OcclusionSampler},
    volume::Density,
};

/// The air of a frame.
pub(crate) struct WindSampler<'a> {
    /// In the open.
    pub air: AirSample<'a>,
    /// What shelters from it.
    pub shade: Option<(&'a OcclusionSampler, Density<'a>)>,
}

impl WindSampler<'_> {
    /// Moves the air around a strand.
    pub fn add(&self, strand: &mut StrandView) {
        let [root, _] = strand.roots();
        for (i, (x, _)) in strand.points().enumerate().skip(2) {
            let place = root.translation + x;
            let left = self.shade.as_ref().map_or(1.0, |(shade, hair)| shade.left(hair, place));
            strand.add_wind(i, self.air.velocity(place) * left - self.air.uniform);
        }
    }
}
