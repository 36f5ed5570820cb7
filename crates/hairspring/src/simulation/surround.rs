//! What acts on points from outside in a frame: the hair volume first, then each effect.

use super::{Bodies, Drive, Simulation};
use crate::{
    around::{Blow, Charges, Frame, Kinds, Strands, Surrounded},
    collide::Rigid,
    strand::interval::Interval,
    volume::Now,
};
use std::time::{Duration, Instant};

impl Simulation {
    /// Finds what acts on all points in the frame, of the hair volume for an interval of it alone, and moves the roots; hair was `carried` along before it. What the
    /// hair volume took.
    pub(super) fn exchange(
        &mut self,
        drive: &Drive,
        carried: Option<&Rigid>,
        interval: &Interval,
    ) -> Duration {
        let ghosts = self.settings.solver.ghost && self.ghosts.iter().any(|ghost| ghost.is_on());
        let charged = self.charges.iter().any(|charge| *charge != 0.0);
        let pressed = self.is_pressed();
        let sheltered = self.shelter.is_on() && drive.air.moves();
        let gripped = ghosts || charged || !self.tools.used.is_empty();
        let tines = self.tools.used.iter().any(|used| !used.tool.binds());
        let blown = sheltered || drive.air.varies();
        let kinds = Kinds { push: pressed, grip: gripped, tines, air: blown };
        self.around.prepare(self.state.len(), kinds);
        let anchor = self.settings.anchor;
        let bodies = Bodies::new((drive.obstacles, carried));
        let began = Instant::now();
        if let Some(volume) = self.volume.as_mut().filter(|_| pressed || sheltered) {
            volume.begin_frame();
            // Roots are moved below.
            let now = Now { anchor, gone: 1.0 };
            let hair = (&self.strand[..], &self.state[..]);
            volume.measure(hair, &now);
            if pressed {
                let first = (&interval.substeps[0].obstacles[..], interval.h);
                let dt = interval.now.len() as f32 * interval.h;
                volume.exchange(dt, hair, &now, first, &mut self.around.push);
            }
        }
        let volume_took = began.elapsed();
        self.move_roots(drive);
        if !gripped && !blown {
            return volume_took;
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
        volume_took
    }
}

impl Simulation {
    /// Lets strands meet as a volume again, with the anchor at `anchor`, for those of the interval's substeps that are to be run now.
    pub(super) fn exchange_again(&mut self, anchor: Rigid, interval: &Interval) {
        let Some(volume) = &mut self.volume else { return };
        let now = Now { anchor, gone: interval.begun().0 };
        let hair = (&self.strand[..], &self.state[..]);
        volume.measure(hair, &now);
        let first = (&interval.substeps[interval.now.start].obstacles[..], interval.h);
        volume.exchange(interval.now.len() as f32 * interval.h, hair, &now, first, &mut self.around.push);
    }

    /// Whether strands meet as a volume.
    pub(super) fn is_pressed(&self) -> bool {
        self.volume.as_ref().is_some_and(|volume| volume.acts())
    }
}

/// What is said of a group; one past the end has the last's.
fn of_group<T>(all: &[T], group: usize) -> Option<&T> {
    all.get(group).or(all.last())
}
