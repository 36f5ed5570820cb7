//! Settings of contact between strands, one by one.

use super::{When, define_settings};

define_settings! {
    /// Settings of contact between individual strands, for guides and small scenes. It is the reference for the
    /// volume methods, and acts between the simulated strands of all grooms.
    ///
    /// Fields may be added: write `..Default::default()`. For an example, see [`settings`](crate::settings).
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Neighbours {
        /// Whether simulated strands collide with each other one by one. If not, they pass through each other.
        /// Exact and slow: for guides and small scenes.
        on: bool = false, "none", {switch};
        /// Contact radius of a strand, which represents the hairs around it. It is limited everywhere to half the
        /// distance to the nearest other strand at rest, so that nothing touches at rest.
        radius: Option<f32> = None, ["m"], {above 0},
            default "half of the mean distance to the nearest other strand at rest, at most half a segment",
            when When::On("neighbours.on");
        /// Coulomb friction coefficient between strands. The default is a mean value: because of the scales, hair
        /// slides more easily toward the tip than toward the root.
        friction: f32 = 0.3, "coefficient", {0 or more}, when When::On("neighbours.on");
        /// Stiction: normal and tangential force that two segments in contact resist, in addition to friction,
        /// before they separate. A hair of 25 cm weighs 1.6e-5 N.
        stiction: f32 = 0.0, ["N"], {0 or more}, when When::On("neighbours.on");
    }
}
