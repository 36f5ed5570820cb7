//! The hair volume in the simulation: forces between hair, and wind occlusion by hair.

use super::Simulation;
use crate::settings;
use crate::{
    air::WindOcclusion,
    settings::{OutOfRange, Validate, VolumeMethod},
    simd::lanes::{LANES, Row},
    strand::tile::rest,
    volume::{AtRest, Volume, VolumeReport},
};

/// Cell size of a volume that only serves wind occlusion, over the occlusion's reach [1]: 16 mm for half a
/// meter, about a lock of hair.
const SHELTER_CELL: f32 = 1.0 / 32.0;

impl Simulation {
    /// Enables or disables the hair volume. The current pose counts as the rest pose: it defines the rest
    /// density and each point's share of the volume.
    ///
    /// # Errors
    /// If a setting is out of range; then nothing changes.
    pub fn set_volume(&mut self, settings: &settings::Volume) -> Result<(), OutOfRange> {
        settings.validate()?;
        self.replace_volume(settings);
        Ok(())
    }

    /// Creates or removes the hair volume, with settings that are in range.
    fn replace_volume(&mut self, settings: &settings::Volume) {
        let mut mass = vec![Row::default(); self.model.rest.len()];
        let (mut segments, mut sum, mut longest) = (0_usize, 0.0_f64, 0.0_f32);
        // A strand has the mass of the hairs that it represents. Only ratios between strands matter.
        let most = self.strands().map(|s| self.model.multiplicity[s as usize]).fold(0.0, f32::max);
        for (place, strand) in self.model.groom_strands.iter().enumerate().filter(|(_, s)| **s != u32::MAX) {
            let (tile, lane) = (self.model.tiles[place / LANES], place % LANES);
            let points = self.model.groom.range(*strand as usize).len();
            let mut length = 0.0;
            let share = self.model.multiplicity[*strand as usize] / most;
            for i in (0..points).map(|i| i * tile.model.stride()) {
                let at = tile.first as usize + i;
                mass[at].0[lane] = share * self.model.rest[at][rest::MASS].0[lane];
                length += self.model.rest[at][rest::LENGTH].0[lane];
            }
            (segments, sum, longest) = (segments + points - 1, sum + f64::from(length), longest.max(length));
        }
        let points = self.model.rest.len() as u32;
        let at_rest = AtRest {
            firsts: self.model.tiles.iter().map(|tile| tile.first).chain([points]).collect(),
            mass,
            roots: &self.state.roots,
            state: &self.state.points,
            anchor: self.state.anchor,
            segment: (sum / segments.max(1) as f64) as f32,
            length: longest,
        };
        let mut settings = *settings;
        if settings.method == VolumeMethod::Off {
            // Only measured, for wind occlusion, so the resolution of occlusion is enough.
            settings.cell = settings.cell.or(Some(self.wind_occlusion.reach * SHELTER_CELL));
        }
        self.volume = Volume::new(&settings, self.wind_occlusion.is_on(), at_rest).map(Box::new);
    }

    /// Enables or disables wind occlusion by bodies and hair. If there is no hair volume, one is created for
    /// it, with the current pose as the rest pose that defines the density.
    ///
    /// # Errors
    /// If a setting is out of range; then nothing changes.
    pub fn set_wind_occlusion(&mut self, occlusion: &WindOcclusion) -> Result<(), OutOfRange> {
        occlusion.validate()?;
        self.wind_occlusion = *occlusion;
        if occlusion.is_on() && self.volume.is_none() {
            self.replace_volume(&settings::Volume::default());
        }
        Ok(())
    }

    /// Statistics of the hair volume; `None` if it exerts no forces.
    pub fn volume(&self) -> Option<VolumeReport> {
        self.volume.as_ref().filter(|volume| volume.acts()).map(|volume| volume.report())
    }
}
