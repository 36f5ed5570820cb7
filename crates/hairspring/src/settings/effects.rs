//! Settings of the styling of follow hairs.

use super::{When, define_settings};

define_settings! {
    /// Styling of follow hairs, applied after interpolation from the guides. All off by default.
    ///
    /// Fields may be added: write `..Default::default()`. For an example, see [`settings`](crate::settings).
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Effects {
        /// How far the tips of follow hairs are drawn to their first guide, 0 (not at all) to 1 (fully). It
        /// grows from root to tip.
        clump: f32 = 0.0, "fraction", {0 to 1};
        /// Radius of the curls that are added to follow hairs.
        curl_radius: f32 = 0.0, ["m"], {0 to 1000000};
        /// Length of hair in one turn of an added curl.
        curl_length: f32 = 0.03, ["m"], {above 0 at most 1000000}, when When::Above0("groom.effects.curl_radius");
        /// Amplitude of the flyaway noise at the tips of follow hairs.
        noise: f32 = 0.0, ["m"], {0 to 1000000};
    }
}
