//! External forces of a frame: first the hair volume, then each effect.

use super::{Simulation, StepInput};
use crate::{
    collide::FrameColliders,
    forces::{
        Charges, ForceMask, FrameMotion, LineCharge, StrandBatch, StrandView, WindSampler, global_shape,
    },
    math::RigidTransform,
    strand::frame_context::FrameContext,
    volume::Now,
};
use std::time::{Duration, Instant};

impl Simulation {
    /// Computes the external forces on all points for the frame, and moves the roots. The hair volume acts
    /// for the substeps in `frame` that are due now. `carried` is the rigid motion that the hair made
    /// before. Returns the time that the hair volume took.
    pub(super) fn compute_external_forces(
        &mut self,
        input: &StepInput,
        carried: Option<&RigidTransform>,
        frame: &FrameContext,
    ) -> Duration {
        let global_shapes = self.model.solver.global_shape
            && self.model.materials.iter().any(|material| material.global_shape.is_on());
        let charged = self.model.materials.iter().any(|material| material.charge != 0.0);
        let with_volume = self.volume_acts();
        let occluded = self.wind_occlusion.is_on() && input.air.steady_moves();
        let custom = !self.force_fields.is_empty();
        let position_springs =
            global_shapes || charged || custom || !self.state.manipulators.active.is_empty();
        let transverse_drag =
            custom || self.state.manipulators.active.iter().any(|active| !active.tool.binds());
        let moving_air = occluded || input.air.varies();
        let carried_air = !self.model.carried_air.is_empty();
        let kinds = ForceMask {
            external_acceleration: with_volume,
            position_spring: position_springs,
            anisotropic_drag: transverse_drag,
            wind_delta: moving_air || custom || carried_air,
        };
        self.forces.prepare(self.state.points.len(), kinds);
        let anchor = self.state.anchor;
        let bodies = FrameColliders::new((input.colliders, carried));
        let began = Instant::now();
        if let Some(volume) = self.volume.as_mut().filter(|_| with_volume || occluded) {
            volume.begin_frame();
            // Roots are moved below.
            let now = Now { anchor, gone: 1.0 };
            let hair = (&self.state.roots[..], &self.state.points[..]);
            volume.measure(hair, &now);
            if with_volume {
                let first = (&frame.substeps[0].colliders[..], frame.h);
                let dt = frame.now.len() as f32 * frame.h;
                volume.compute_accelerations(dt, hair, &now, first, &mut self.forces.external_acceleration);
            }
        }
        let volume_took = began.elapsed();
        self.move_roots(input);
        if !position_springs && !moving_air && !carried_air {
            return volume_took;
        }
        let motion = FrameMotion { anchor: [anchor, input.anchor], dt: input.dt };
        if carried_air {
            self.air_in_hair.measure(&self.model.carried_air, &self.state.points, motion.spin());
        }
        let mut strands = StrandBatch {
            tiles: &self.model.tiles,
            lanes: self.model.groom_strands.as_chunks().0,
            roots: &self.state.roots,
            strand: &self.model.strand,
            rest: &self.model.rest,
            air_cell: &self.model.carried_air.cell,
            state: &self.state.points,
            external_acceleration: &mut self.forces.external_acceleration,
            position_spring: &mut self.forces.position_spring,
            anisotropic_drag: &mut self.forces.anisotropic_drag,
            wind_delta: &mut self.forces.wind_delta,
        };
        let charge_of = |strand: usize, hairs: f32| {
            let material = self.model.material(strand);
            let per_length = material.charge * self.model.groom.scale(strand).charge * hairs;
            LineCharge { per_length, profile: &material.charge_profile }
        };
        if charged {
            self.state.charged.iter_mut().for_each(|ball| ball.carry(carried));
            // Follow hairs have the charge of their guides.
            let of_all = |strand: usize| charge_of(strand, self.model.multiplicity[strand]);
            self.hair_field.find(&mut strands, &motion, of_all);
        }
        let air = input.air.moment(input.dt, &mut self.noise);
        let occlusion = self.volume.as_ref().filter(|_| occluded).map(|volume| {
            let hair = volume.density(anchor);
            self.occlusion.reserve(volume.most_nodes());
            self.occlusion.cast(&self.wind_occlusion, &air, &bodies, &hair);
            (&self.occlusion, hair)
        });
        let uniform = air.uniform;
        let wind = WindSampler { air, occlusion };
        let charges = Charges { balls: &self.state.charged, hair: &self.hair_field };
        let (model, groom) = (&self.model, &self.model.groom);
        let manipulators = &self.state.manipulators.active;
        let (force_fields, air_in_hair) = (&self.force_fields, &self.air_in_hair);
        let act = |strand: &mut StrandView| {
            let s = strand.strand;
            if global_shapes {
                global_shape::apply(
                    &model.material(s).global_shape,
                    groom.scale(s).global_shape,
                    groom.strand(s),
                    strand,
                );
            }
            if charged {
                charges.add(&charge_of(s, 1.0), strand);
            }
            for active in manipulators {
                active.act(&bodies, strand, groom.range(s).len());
            }
            if moving_air {
                wind.add(strand);
            }
            for (_, force) in force_fields {
                force.apply(strand);
            }
            if carried_air {
                air_in_hair.apply(&model.carried_air, groom.strand(s), uniform, strand);
            }
        };
        strands.each(&motion, &act);
        volume_took
    }
}

impl Simulation {
    /// Applies the hair volume again, with the anchor at `anchor`, for those of the frame's substeps that are
    /// due now.
    pub(super) fn update_volume_forces(&mut self, anchor: RigidTransform, frame: &FrameContext) {
        let Some(volume) = &mut self.volume else { return };
        let now = Now { anchor, gone: frame.begun().0 };
        let hair = (&self.state.roots[..], &self.state.points[..]);
        volume.measure(hair, &now);
        let first = (&frame.substeps[frame.now.start].colliders[..], frame.h);
        volume.compute_accelerations(
            frame.now.len() as f32 * frame.h,
            hair,
            &now,
            first,
            &mut self.forces.external_acceleration,
        );
    }

    /// Returns whether the hair volume exerts forces.
    pub(super) fn volume_acts(&self) -> bool {
        self.volume.as_ref().is_some_and(|volume| volume.acts())
    }
}
