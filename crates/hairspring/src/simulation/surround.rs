//! What acts on points from outside in a frame: the hair volume first, then each effect.

use super::{Bodies, Drive, Simulation};
use crate::{
    around::{Blow, Charges, Frame, Kinds, Strands, Surrounded},
    collide::Rigid,
};

impl Simulation {
    /// Finds what acts on all points in the frame, and moves the roots; hair was `carried` along before it.
    pub(super) fn exchange(&mut self, drive: &Drive, carried: Option<&Rigid>) {
        let ghosts = self.settings.solver.ghost && self.ghosts.iter().any(|ghost| ghost.is_on());
        let charged = self.charges.iter().any(|charge| *charge != 0.0);
        let pressed = self.volume.as_ref().is_some_and(|volume| volume.acts());
        let sheltered = self.shelter.is_on() && drive.air.moves();
        let gripped = ghosts || charged || !self.tools.used.is_empty();
        let tines = self.tools.used.iter().any(|used| !used.tool.binds());
        let blown = sheltered || drive.air.varies();
        let kinds = Kinds { push: pressed, grip: gripped, tines, air: blown };
        self.around.prepare(self.state.len(), kinds, pressed);
        let anchor = self.settings.anchor;
        let obstacles = (drive.obstacles, carried);
        let bodies = Bodies::new(obstacles);
        if let Some(volume) = self.volume.as_mut().filter(|_| pressed || sheltered) {
            let hair = (&self.strand[..], &self.state[..]);
            volume.measure(hair, &anchor);
            if pressed {
                volume.exchange(drive.dt, hair, &anchor, obstacles, &mut self.around.push);
            }
        }
        self.move_roots(drive);
        if !gripped && !blown {
            return;
        }
        let frame = Frame { anchor: [anchor, drive.anchor], dt: drive.dt };
        let mut strands = Strands {
            tiles: &self.tiles,
            lanes: &self.lanes,
            strand: &self.strand,
            rest: &self.rest,
            state: &self.state,
            push: &mut self.around.push,
            grip: &mut self.around.grip,
            tines: &mut self.around.tines,
            air: &mut self.around.air,
        };
        let charge_of = |strand: usize| {
            of_group(&self.charges, self.groom.group(strand) as usize).copied().unwrap_or(0.0)
        };
        if charged {
            self.charged.iter_mut().for_each(|ball| ball.carry(carried));
            // Those that follow are charged as their guides.
            let of_all = |strand: usize| charge_of(strand) * self.hairs[strand];
            self.hair_field.find(&mut strands, &frame, of_all);
        }
        let air = drive.air.moment(drive.dt, &mut self.noise);
        let shade = self.volume.as_ref().filter(|_| sheltered).map(|volume| {
            let hair = volume.density(anchor);
            self.shade.reserve(volume.most_nodes());
            self.shade.cast(&self.shelter, &air, &bodies, &hair);
            (&self.shade, hair)
        });
        let blow = Blow { air, shade };
        let charges = Charges { balls: &self.charged, hair: &self.hair_field };
        let (groom, ghost_of) = (&self.groom, &self.ghosts);
        let tools = &self.tools.used;
        let act = |strand: &mut Surrounded| {
            let s = strand.strand;
            let group = groom.group(s) as usize;
            if let Some(ghost) = of_group(ghost_of, group).filter(|_| ghosts) {
                ghost.add(groom.scale(s).ghost, groom.strand(s), strand);
            }
            if charged {
                charges.add(charge_of(s), strand);
            }
            for used in tools {
                used.act(&bodies, strand, groom.range(s).len());
            }
            if blown {
                blow.add(strand);
            }
        };
        strands.each(&frame, &act);
    }
}

/// What is said of a group; one past the end has the last's.
fn of_group<T>(all: &[T], group: usize) -> Option<&T> {
    all.get(group).or(all.last())
}
