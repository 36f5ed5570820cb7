//! Settings of the global shape: a pull of the strand to its rest shape.

use super::profile::is_profile;
use crate::settings::{When, define_settings};

/// The condition under which the other parameters of the global shape have an effect.
const HAS_PULL: When =
    When::All(&[When::On("solver.global_shape"), When::Above0("material.global_shape.pull")]);

define_settings! {
    /// Parameters of the global shape.
    ///
    /// Fields may be added: write `..Default::default()`.
    #[derive(Clone, Debug, PartialEq)]
    pub struct GlobalShape {
        /// Frequency of a spring that pulls each point to the groomed shape, which the root carries: the natural
        /// frequency of a free point. 0: no global shape. From about 1 on, hair keeps its style during a walk; from
        /// about 4 on, it looks set.
        pull: f32 = 0.0, ["Hz"], {0 to 60}, when When::On("solver.global_shape");
        /// Multiplier of the frequency along the strand, from root to tip: `[1.0, 0.0]` holds the roots and leaves the
        /// tips free.
        profile: Vec<f32> = vec![1.0], "factors", {
            check |shape| is_profile(&shape.profile) => "1 to 64 numbers, 0 to 10000"
        }, when HAS_PULL;
        /// Damping ratio of the spring, relative to critical.
        damping: f32 = 0.5, "damping ratio", {0 to 10}, when HAS_PULL;
    }
}

impl GlobalShape {
    /// Returns whether the global shape is enabled.
    pub fn is_on(&self) -> bool {
        self.pull > 0.0
    }
}
