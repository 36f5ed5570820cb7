//! Settings of contact between hairs as a volume.

use super::{When, define_settings};

define_settings! {
    /// Settings of the hair volume, which acts between the simulated strands of all grooms. Each strand has the
    /// mass of the hairs that follow it.
    ///
    /// Fields may be added: write `..Default::default()`. For an example, see [`settings`](crate::settings).
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Volume {
        /// Method that keeps hair from being compressed. `off`: strands pass through each other. `density`:
        /// pressure where hair is denser than at rest. `incompressible`: a projection that keeps the density of
        /// the rest pose.
        method: VolumeMethod = VolumeMethod::Off, "none", {words};
        /// Edge of a grid cell; it is enlarged if there would be more than two million cells. By default, cells
        /// with hair contain eight points at rest, so that the density is statistically meaningful.
        cell: Option<f32> = None, ["m"], {above 0 at most 1},
            default "the smallest size that holds eight points at rest",
            when When::Any(&[When::IsNot("volume.method", &["off"]), When::Above0("wind_occlusion.hair")]);
        /// Rate at which hair takes on the velocity of the surrounding hair.
        ///
        /// With the default, strands lose a twentieth of their relative velocity in 1/60 s, which corresponds to a
        /// PIC/FLIP blend of 0.95 FLIP. Motion across other hair is stopped separately, see `volume/crossing.rs`.
        friction: f32 = 3.0, ["1/s"], {0 or more}, when When::IsNot("volume.method", &["off"]);
        /// Speed at which compressed hair spreads.
        ///
        /// It is limited to half a cell in 1/240 s, to prevent overshoot.
        pressure: f32 = 0.5, ["m/s"], {0 or more}, when When::Is("volume.method", &["density"]);
        /// Rate at which lost volume is recovered, as a fraction per second.
        ///
        /// At most all of it is recovered in 1/240 s. For hair that falls from standing out and is shaken, the
        /// default keeps nine tenths of the volume; 10 keeps three quarters, and no method a quarter (`hairspring
        /// bench --hair-hair`).
        recovery_rate: f32 = 30.0, ["1/s"], {0 or more}, when When::Is("volume.method", &["incompressible"]);
    }
}

define_settings! {
    /// Method that keeps hair from being compressed.
    ///
    /// For an example, see [`settings`](crate::settings).
    #[non_exhaustive]
    choice VolumeMethod {
        /// None.
        #[default]
        Off = "off",
        /// A force along the negative density gradient where hair is denser than at rest (Petrovic 2005). Cheap,
        /// but soft.
        Density = "density",
        /// Velocities that converge on full cells are projected out, and lost volume is recovered (McAdams 2009).
        /// Firm, at the cost of a linear solve every 1/240 s.
        Incompressible = "incompressible",
    }
}
