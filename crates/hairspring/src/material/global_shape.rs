//! Settings of the global shape: a pull of the strand to its rest shape.

use serde::{Deserialize, Serialize};

/// A pull to the rest shape.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GlobalShape {
    /// How fast a lone point would swing about its place, f [Hz], 0 to 60. Default 0: there is no global shape. Hair keeps its style in a walk from
    /// about 1, and looks set from about 4.
    pub pull: f32,
    /// The same at the tip, over that at the root, 0 or more. Default 1.
    pub tip: f32,
    /// Damping over the critical, ζ, 0 to 10. Default 0.5.
    pub damping: f32,
}

impl Default for GlobalShape {
    fn default() -> Self {
        Self { pull: 0.0, tip: 1.0, damping: 0.5 }
    }
}

impl GlobalShape {
    /// Whether it pulls at all.
    pub fn is_on(&self) -> bool {
        self.pull > 0.0
    }
}
