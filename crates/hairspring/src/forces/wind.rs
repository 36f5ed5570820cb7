//! Wind that varies in space: wind sources, turbulence, and occlusion by bodies and hair.
//!
//! ```text
//!  Δu = T(x) (W + Σ sources(x) + turbulence(x)) − W          W: the directional wind, which the solver applies in every substep
//! ```
//!
//! The drag (`strand/drag.rs`) uses the velocity of this air relative to each point.

use super::StrandView;
use crate::{
    air::{AirSample, OcclusionSampler},
    volume::Density,
};

/// The air of a frame.
pub(crate) struct WindSampler<'a> {
    /// The air without occlusion.
    pub air: AirSample<'a>,
    /// Wind occlusion.
    pub occlusion: Option<(&'a OcclusionSampler, Density<'a>)>,
}

impl WindSampler<'_> {
    /// Adds the air velocity at the points of a strand.
    pub fn add(&self, strand: &mut StrandView) {
        let [root, _] = strand.roots();
        for (i, (x, _)) in strand.points().enumerate().skip(2) {
            let place = root.translation + x;
            let left = self.occlusion.as_ref().map_or(1.0, |(occlusion, hair)| occlusion.left(hair, place));
            strand.add_wind(i, self.air.velocity(place) * left - self.air.uniform);
        }
    }
}
