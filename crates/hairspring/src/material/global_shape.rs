//! Settings of the global shape: a pull of the strand to its rest shape.

/// Parameters of the global shape.
///
/// Fields may be added: write `..Default::default()`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct GlobalShape {
    /// Natural frequency of a free point, f [Hz], 0 to 60. Default 0: no global shape. From about 1 on, hair
    /// keeps its style during a walk; from about 4 on, it looks set.
    pub pull: f32,
    /// Frequency at the tip relative to that at the root, 0 or more. Default 1.
    pub tip: f32,
    /// Damping ratio, relative to critical, ζ, 0 to 10. Default 0.5.
    pub damping: f32,
}

impl Default for GlobalShape {
    fn default() -> Self {
        Self { pull: 0.0, tip: 1.0, damping: 0.5 }
    }
}

impl GlobalShape {
    /// Returns whether the global shape is enabled.
    pub fn is_on(&self) -> bool {
        self.pull > 0.0
    }
}
