//! Settings of the wind that is the same everywhere.

use super::{When, define_settings};
use glam::Vec3;

define_settings! {
    /// Directional wind, the same everywhere, with gusts.
    ///
    /// Fields may be added: write `..Default::default()`. For an example, see [`settings`](crate::settings).
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Wind {
        /// Mean velocity of the air, the same everywhere.
        velocity: Vec3 = Vec3::ZERO, ["m/s"], {vector -1000 to 1000};
        /// Amplitude of the gusts, as a fraction of the mean wind.
        gust: f32 = 0.0, "fraction", {0 to 1}, when When::Not0("wind.velocity");
        /// Number of gusts per second.
        gust_rate: f32 = 0.0, ["Hz"], {0 to 1000},
            when When::All(&[When::Not0("wind.velocity"), When::Above0("wind.gust")]);
    }
}
