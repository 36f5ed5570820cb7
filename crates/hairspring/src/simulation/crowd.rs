//! Hair on hair: the volume of the simulated strands.

use super::Simulation;
use crate::{
    scene,
    strand::{
        lanes::{LANES, Row},
        tile::rest,
    },
    volume::{AtRest, Volume, VolumeReport},
};

impl Simulation {
    /// Lets strands meet each other as a volume from now on, or no more. As they are now counts as their rest: how full each place is, and
    /// which part of the volume is whose.
    pub fn set_volume(&mut self, settings: &scene::Volume) {
        let mut mass = vec![Row::default(); self.rest.len()];
        let (mut segments, mut sum, mut longest) = (0_usize, 0.0_f64, 0.0_f32);
        for (place, strand) in self.lanes.iter().enumerate().filter(|(_, s)| **s != u32::MAX) {
            let (tile, lane) = (self.tiles[place / LANES], place % LANES);
            let points = self.groom.range(*strand as usize).len();
            let mut length = 0.0;
            for i in (0..points).map(|i| i * tile.model.stride()) {
                let at = tile.first as usize + i;
                mass[at].0[lane] = self.rest[at][rest::MASS].0[lane];
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
        self.volume = Volume::new(settings, at_rest).map(Box::new);
    }

    /// What is known of the hair's volume; `None` where strands pass through each other.
    pub fn volume(&self) -> Option<VolumeReport> {
        self.volume.as_ref().map(|volume| volume.report())
    }
}
