//! What acts on points from outside in a frame: the hair volume first, then each effect.

use super::{Drive, Simulation};
use crate::{
    around::{Frame, Kinds, Strands, Surrounded},
    collide::Rigid,
};

impl Simulation {
    /// Finds what acts on all points in the frame; roots have not moved yet. With room for what strands do to each other where they `meet`.
    pub(super) fn exchange(&mut self, drive: &Drive, meet: bool) {
        let ghosts = self.settings.solver.ghost && self.ghosts.iter().any(|ghost| ghost.is_on());
        let kinds = Kinds { push: self.volume.is_some(), grip: ghosts, damp: meet, air: false };
        self.around.prepare(self.state.len(), kinds, self.volume.is_some());
        if let Some(volume) = &mut self.volume {
            let anchor = self.settings.anchor;
            let hair = (&self.strand[..], &self.state[..]);
            volume.exchange(drive.dt, hair, &anchor, drive.obstacles, &mut self.around.push);
        }
        self.move_roots(drive);
        if !ghosts {
            return;
        }
        let (groom, materials) = (self.groom.clone(), std::mem::take(&mut self.ghosts));
        let act = |strand: &mut Surrounded| {
            let s = strand.strand;
            if let Some(ghost) = materials.get(groom.group(s) as usize).or(materials.last()) {
                ghost.add(groom.scale(s).ghost, groom.strand(s), strand);
            }
        };
        self.surround((drive.anchor, drive.dt), &act);
        self.ghosts = materials;
    }

    /// Lets `act` add to what acts on every strand in a frame of `dt` [s] that takes the anchor to `anchor`.
    pub(super) fn surround(&mut self, (anchor, dt): (Rigid, f32), act: &(impl Fn(&mut Surrounded) + Sync)) {
        let frame = Frame { anchor: [self.settings.anchor, anchor], dt };
        let strands = Strands {
            tiles: &self.tiles,
            lanes: &self.lanes,
            strand: &self.strand,
            state: &self.state,
            push: &mut self.around.push,
            grip: &mut self.around.grip,
            damp: &mut self.around.damp,
            air: &mut self.around.air,
        };
        strands.each(&frame, act);
    }
}
