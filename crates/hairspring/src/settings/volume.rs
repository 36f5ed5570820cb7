//! Settings of contact between hairs as a volume.

use serde::{Deserialize, Serialize};

/// How hair meets hair: the simulated strands of all grooms, each weighing what the hairs weigh that follow it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Volume {
    /// What keeps hair from crowding. Default `off`: strands pass through each other.
    pub method: VolumeMethod,
    /// Edge of a cell [m], above 0; it grows where there would be more than two million. `None`, the default: the smallest in which a cell
    /// with hair holds eight points at rest, so that its density is more than chance.
    pub cell: Option<f32>,
    /// How fast hair takes on the velocity of the hair around it [1/s], 0 or more. Default 3: strands lose a twentieth of what
    /// is between their velocities in 1/60 s; as a PIC/FLIP blend, 0.95 FLIP. What goes across other hair is stopped besides, see `volume/crossing.rs`.
    pub friction: f32,
    /// Speed with which a crowd spreads, for `density` [m/s], 0 or more; it counts as at most half a cell in 1/240 s, beyond which a step
    /// would overshoot. Default 0.5.
    pub pressure: f32,
    /// How fast lost volume is regained, for `incompressible`: the share a second [1/s], 0 or more, and at most all of it in 1/240 s.
    /// Default 30: hair that falls from standing out and is shaken keeps nine tenths of its volume so, three quarters with 10, and a
    /// quarter without a method (`hairspring bench --hair-hair`).
    pub recovery_rate: f32,
}

impl Default for Volume {
    fn default() -> Self {
        Self { method: VolumeMethod::Off, cell: None, friction: 3.0, pressure: 0.5, recovery_rate: 30.0 }
    }
}

/// What keeps hair from crowding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VolumeMethod {
    /// Nothing.
    #[default]
    Off,
    /// Pressure down the gradient of density, where hair is denser than at rest (Petrovic 2005): cheap, and gives way.
    Density,
    /// Velocities that close in on full cells are taken out, and lost volume is regained (McAdams 2009): firm, for a linear solve each 1/240 s.
    Incompressible,
}

impl VolumeMethod {
    /// All of them.
    pub const ALL: [VolumeMethod; 3] = [Self::Off, Self::Density, Self::Incompressible];

    /// Its name in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Density => "density",
            Self::Incompressible => "incompressible",
        }
    }
}
