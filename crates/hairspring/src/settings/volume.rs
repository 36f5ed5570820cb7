//! Settings of contact between hairs as a volume.

use super::check::{Check, Validate, above_0, check, from_0};

/// Settings of the hair volume, which acts between the simulated strands of all grooms. Each strand has the
/// mass of the hairs that follow it.
///
/// Fields may be added: write `..Default::default()`. For an example, see [`settings`](crate::settings).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Volume {
    /// Volume method. Default `off`: strands pass through each other.
    pub method: VolumeMethod,
    /// Edge of a cell [m], above 0; it is enlarged if there would be more than two million cells. `None`, the
    /// default: the smallest cell in which cells with hair contain eight points at rest, so that the density
    /// is statistically meaningful.
    pub cell: Option<f32>,
    /// Rate at which hair takes on the velocity of the surrounding hair [1/s], 0 or more. Default 3: strands
    /// lose a twentieth of their relative velocity in 1/60 s, which corresponds to a PIC/FLIP blend of 0.95
    /// FLIP. Motion across other hair is stopped separately, see `volume/crossing.rs`.
    pub friction: f32,
    /// Speed at which compressed hair spreads, for `density` [m/s], 0 or more. It is limited to half a cell
    /// in 1/240 s, to prevent overshoot. Default 0.5.
    pub pressure: f32,
    /// Rate at which lost volume is recovered, for `incompressible`, as a fraction per second [1/s], 0 or
    /// more; at most all of it in 1/240 s. Default 30. For hair that falls from standing out and is shaken,
    /// this keeps nine tenths of the volume; 10 keeps three quarters, and no method a quarter (`hairspring
    /// bench --hair-hair`).
    pub recovery_rate: f32,
}

impl Default for Volume {
    fn default() -> Self {
        Self { method: VolumeMethod::Off, cell: None, friction: 3.0, pressure: 0.5, recovery_rate: 30.0 }
    }
}

/// Method that keeps hair from being compressed.
///
/// For an example, see [`settings`](crate::settings).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum VolumeMethod {
    /// None.
    #[default]
    Off,
    /// A force along the negative density gradient where hair is denser than at rest (Petrovic 2005). Cheap,
    /// but soft.
    Density,
    /// Velocities that converge on full cells are projected out, and lost volume is recovered (McAdams 2009).
    /// Firm, at the cost of a linear solve every 1/240 s.
    Incompressible,
}

impl VolumeMethod {
    /// All methods.
    pub const ALL: [VolumeMethod; 3] = [Self::Off, Self::Density, Self::Incompressible];

    /// Returns the name used in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Density => "density",
            Self::Incompressible => "incompressible",
        }
    }
}

impl Validate for Volume {
    fn checks(&self) -> Vec<Check> {
        vec![
            check(above_0(self.cell), "cell", "above 0 [m]"),
            check(from_0(self.friction), "friction", "0 or more [1/s]"),
            check(from_0(self.pressure), "pressure", "0 or more [m/s]"),
            check(from_0(self.recovery_rate), "recovery_rate", "0 or more [1/s]"),
        ]
    }
}
