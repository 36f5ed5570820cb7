//! The volume of the simulated strands: hair on hair, and hair that shelters from the wind.

use super::Simulation;
use crate::settings;
use crate::{
    air::WindOcclusion,
    settings::VolumeMethod,
    simd::lanes::{LANES, Row},
    strand::tile::rest,
    volume::{AtRest, Volume, VolumeReport},
};

/// Edge of a cell that is there for occlusion alone, over its reach [1]: 16 mm for half a metre, about a lock of hair.
const SHELTER_CELL: f32 = 1.0 / 32.0;

impl Simulation {
    /// Lets strands meet each other as a volume from now on, or no more. As they are now counts as their rest: how full each place is, and
    /// which part of the volume is whose.
    pub fn set_volume(&mut self, settings: &settings::Volume) {
        let mut mass = vec![Row::default(); self.rest.len()];
        let (mut segments, mut sum, mut longest) = (0_usize, 0.0_f64, 0.0_f32);
        // A strand weighs what the hairs weigh that it stands for; only what it is to the others' counts.
        let most = self.strands().map(|s| self.multiplicity[s as usize]).fold(0.0, f32::max);
        for (place, strand) in self.lanes.iter().enumerate().filter(|(_, s)| **s != u32::MAX) {
            let (tile, lane) = (self.tiles[place / LANES], place % LANES);
            let points = self.groom.range(*strand as usize).len();
            let mut length = 0.0;
            let share = self.multiplicity[*strand as usize] / most;
            for i in (0..points).map(|i| i * tile.model.stride()) {
                let at = tile.first as usize + i;
                mass[at].0[lane] = share * self.rest[at][rest::MASS].0[lane];
                length += self.rest[at][rest::LENGTH].0[lane];
            }
            (segments, sum, longest) = (segments + points - 1, sum + f64::from(length), longest.max(length));
        }
        let points = self.rest.len() as u32;
        let at_rest = AtRest {
            firsts: self.tiles.iter().map(|tile| tile.first).chain([points]).collect(),
            mass,
            strand: &self.strand,
            state: &self.state,
            anchor: self.settings.anchor,
            segment: (sum / segments.max(1) as f64) as f32,
            length: longest,
        };
        let mut settings = *settings;
        if settings.method == VolumeMethod::Off {
            // Only measured, for occlusion: as fine as a lee is seen.
            settings.cell = settings.cell.or(Some(self.wind_occlusion.reach * SHELTER_CELL));
        }
        self.volume = Volume::new(&settings, self.wind_occlusion.is_on(), at_rest).map(Box::new);
    }

    /// Lets bodies and hair occlusion from the wind from now on. Where strands do not meet each other as a volume, as they are now counts as
    /// their rest: how dense they are where.
    pub fn set_wind_occlusion(&mut self, occlusion: &WindOcclusion) {
        self.wind_occlusion = *occlusion;
        if occlusion.is_on() && self.volume.is_none() {
            self.set_volume(&settings::Volume::default());
        }
    }

    /// What is known of the hair's volume; `None` where strands pass through each other.
    pub fn volume(&self) -> Option<VolumeReport> {
        self.volume.as_ref().filter(|volume| volume.acts()).map(|volume| volume.report())
    }
}
