//! External forces of a frame: first the hair volume, then each effect.

use super::{Simulation, StepInput};
use crate::{
    collide::FrameColliders,
    forces::{Charges, ForceMask, FrameMotion, StrandBatch, StrandView, WindSampler, global_shape},
    math::RigidTransform,
    strand::frame_context::FrameContext,
    volume::Now,
};
use std::time::{Duration, Instant};

impl Simulation {
    /// Computes the external forces on all points for the frame, and moves the roots. The hair volume acts
    /// for the substeps in `interval` that are due now. `carried` is the rigid motion that the hair made
    /// before. Returns the time that the hair volume took.
    pub(super) fn exchange(
        &mut self,
        drive: &StepInput,
        carried: Option<&RigidTransform>,
        interval: &FrameContext,
    ) -> Duration {
        let global_shapes = self.model.solver.global_shape
            && self.model.global_shapes.iter().any(|global_shape| global_shape.is_on());
        let charged = self.model.charges.iter().any(|charge| *charge != 0.0);
        let pressed = self.is_pressed();
        let occluded = self.wind_occlusion.is_on() && drive.air.moves();
        let custom = !self.force_fields.is_empty();
        let gripped = global_shapes || charged || custom || !self.state.tools.used.is_empty();
        let tines = custom || self.state.tools.used.iter().any(|used| !used.tool.binds());
        let blown = occluded || drive.air.varies();
        let kinds = ForceMask {
            external_acceleration: pressed,
            position_spring: gripped,
            anisotropic_drag: tines,
            wind_delta: blown || custom,
        };
        self.forces.prepare(self.state.points.len(), kinds);
        let anchor = self.state.anchor;
        let bodies = FrameColliders::new((drive.obstacles, carried));
        let began = Instant::now();
        if let Some(volume) = self.volume.as_mut().filter(|_| pressed || occluded) {
            volume.begin_frame();
            // Roots are moved below.
            let now = Now { anchor, gone: 1.0 };
            let hair = (&self.state.strand[..], &self.state.points[..]);
            volume.measure(hair, &now);
            if pressed {
                let first = (&interval.substeps[0].obstacles[..], interval.h);
                let dt = interval.now.len() as f32 * interval.h;
                volume.exchange(dt, hair, &now, first, &mut self.forces.external_acceleration);
            }
        }
        let volume_took = began.elapsed();
        self.move_roots(drive);
        if !gripped && !blown {
            return volume_took;
        }
        let frame = FrameMotion { anchor: [anchor, drive.anchor], dt: drive.dt };
        let mut strands = StrandBatch {
            tiles: &self.model.tiles,
            lanes: self.model.lanes.as_chunks().0,
            strand: &self.state.strand,
            rest: &self.model.rest,
            state: &self.state.points,
            external_acceleration: &mut self.forces.external_acceleration,
            position_spring: &mut self.forces.position_spring,
            anisotropic_drag: &mut self.forces.anisotropic_drag,
            wind_delta: &mut self.forces.wind_delta,
        };
        let charge_of = |strand: usize| {
            of_group(&self.model.charges, self.model.groom.group(strand) as usize).copied().unwrap_or(0.0)
        };
        if charged {
            self.state.charged.iter_mut().for_each(|ball| ball.carry(carried));
            // Follow hairs have the charge of their guides.
            let of_all = |strand: usize| charge_of(strand) * self.model.multiplicity[strand];
            self.hair_field.find(&mut strands, &frame, of_all);
        }
        let air = drive.air.moment(drive.dt, &mut self.noise);
        let shade = self.volume.as_ref().filter(|_| occluded).map(|volume| {
            let hair = volume.density(anchor);
            self.shade.reserve(volume.most_nodes());
            self.shade.cast(&self.wind_occlusion, &air, &bodies, &hair);
            (&self.shade, hair)
        });
        let blow = WindSampler { air, shade };
        let charges = Charges { balls: &self.state.charged, hair: &self.hair_field };
        let (groom, shape_of) = (&self.model.groom, &self.model.global_shapes);
        let tools = &self.state.tools.used;
        let force_fields = &self.force_fields;
        let act = |strand: &mut StrandView| {
            let s = strand.strand;
            let group = groom.group(s) as usize;
            if let Some(global_shape) = of_group(shape_of, group).filter(|_| global_shapes) {
                global_shape::apply(global_shape, groom.scale(s).global_shape, groom.strand(s), strand);
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
            for (_, force) in force_fields {
                force.apply(strand);
            }
        };
        strands.each(&frame, &act);
        volume_took
    }
}

impl Simulation {
    /// Applies the hair volume again, with the anchor at `anchor`, for those of the frame's substeps that are
    /// due now.
    pub(super) fn exchange_again(&mut self, anchor: RigidTransform, interval: &FrameContext) {
        let Some(volume) = &mut self.volume else { return };
        let now = Now { anchor, gone: interval.begun().0 };
        let hair = (&self.state.strand[..], &self.state.points[..]);
        volume.measure(hair, &now);
        let first = (&interval.substeps[interval.now.start].obstacles[..], interval.h);
        volume.exchange(
            interval.now.len() as f32 * interval.h,
            hair,
            &now,
            first,
            &mut self.forces.external_acceleration,
        );
    }

    /// Returns whether the hair volume exerts forces.
    pub(super) fn is_pressed(&self) -> bool {
        self.volume.as_ref().is_some_and(|volume| volume.acts())
    }
}

/// Returns the value for a group. A group past the end uses the last value.
fn of_group<T>(all: &[T], group: usize) -> Option<&T> {
    all.get(group).or(all.last())
}
