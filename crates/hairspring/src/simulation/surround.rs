//! What acts on points from outside in a frame: the hair volume first, then each effect.

use super::{Drive, Simulation};
use crate::{
    around::{Frame, Kinds, Strands, Surrounded},
    collide::Rigid,
};

impl Simulation {
    /// Finds what acts on all points in the frame, and moves the roots; hair was `carried` along before it.
    pub(super) fn exchange(&mut self, drive: &Drive, carried: Option<&Rigid>) {
        let ghosts = self.settings.solver.ghost && self.ghosts.iter().any(|ghost| ghost.is_on());
        let gripped = ghosts || !self.tools.used.is_empty();
        let tines = self.tools.used.iter().any(|used| !used.tool.binds());
        let kinds = Kinds { push: self.volume.is_some(), grip: gripped, tines, air: false };
        self.around.prepare(self.state.len(), kinds, self.volume.is_some());
        if let Some(volume) = &mut self.volume {
            let anchor = self.settings.anchor;
            let hair = (&self.strand[..], &self.state[..]);
            let obstacles = (drive.obstacles, carried);
            volume.exchange(drive.dt, hair, &anchor, obstacles, &mut self.around.push);
        }
        self.move_roots(drive);
        if !gripped {
            return;
        }
        let (groom, materials, tools) = (&self.groom, &self.ghosts, &self.tools.used);
        let act = |strand: &mut Surrounded| {
            let s = strand.strand;
            let ghost = materials.get(groom.group(s) as usize).or(materials.last()).filter(|_| ghosts);
            if let Some(ghost) = ghost {
                ghost.add(groom.scale(s).ghost, groom.strand(s), strand);
            }
            for used in tools {
                used.act(strand, groom.range(s).len());
            }
        };
        let frame = Frame { anchor: [self.settings.anchor, drive.anchor], dt: drive.dt };
        let strands = Strands {
            tiles: &self.tiles,
            lanes: &self.lanes,
            strand: &self.strand,
            state: &self.state,
            push: &mut self.around.push,
            grip: &mut self.around.grip,
            tines: &mut self.around.tines,
            air: &mut self.around.air,
        };
        strands.each(&frame, &act);
    }
}
