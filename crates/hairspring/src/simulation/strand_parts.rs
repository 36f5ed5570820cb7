//! Intervals of a frame: the hair volume acts in intervals of constant length at any frame rate, and strand
//! contact after every substep.
//!
//! ```text
//! frame at 60 Hz   ├───────────────┤     substeps   ├───┼───┼───┼───┤     volume intervals   ├───┼───┼───┼───┤
//! at 240 Hz        ├───┤                            ├───┤                                    ├───┤
//! ```

use super::{
    Simulation, StepInput,
    step::{SUBSTEP_TOLERANCE, StepTimes},
};
use crate::{math::RigidTransform, strand::frame_context::FrameContext};
use std::time::Instant;

/// Longest interval for which the volume's accelerations are constant [s]. Tresses that swing into each other
/// approach by a centimeter within it, about a cell.
const MAX_INTERVAL: f64 = 1.0 / 240.0;

impl Simulation {
    /// Computes the external forces, runs all substeps, and solves strand contacts between them. Returns how
    /// many strands were reset, and the durations of the stages.
    pub(super) fn run_substeps(
        &mut self,
        input: &StepInput,
        carried: Option<&RigidTransform>,
        frame: &mut FrameContext,
    ) -> (usize, StepTimes) {
        let substeps = frame.now.len();
        let exchanges = (f64::from(input.dt) / (MAX_INTERVAL * SUBSTEP_TOLERANCE)).ceil() as usize;
        let frozen = if self.volume_acts() { substeps.div_ceil(exchanges) } else { substeps };
        let mut neighbours = self.neighbours.take();
        frame.hair_contact = false;
        let alone = if neighbours.is_some() { 1 } else { frozen };
        frame.now = 0..frozen.min(substeps);
        let mut times = StepTimes::default();
        let began = Instant::now();
        times.volume = self.compute_external_forces(input, carried, frame);
        times.forces = began.elapsed() - times.volume;
        let start = std::mem::replace(&mut self.state.anchor, input.anchor);
        let mut reset_strands = 0;
        for number in (0..substeps).step_by(alone) {
            if number > 0 && number.is_multiple_of(frozen) {
                frame.now = number..(number + frozen).min(substeps);
                let began = Instant::now();
                self.update_volume_forces(start.lerp(&input.anchor, frame.begun().0), frame);
                times.volume += began.elapsed();
            }
            frame.now = number..(number + alone).min(substeps);
            let began = Instant::now();
            if let Some(neighbours) = &mut neighbours {
                self.apply_contact_loads(neighbours, frame.h);
                frame.hair_contact = neighbours.has_contact();
            }
            let borne = Instant::now();
            if neighbours.is_some() {
                times.neighbours += borne - began;
            }
            reset_strands += self.run(frame);
            frame.continues = true;
            times.solve += borne.elapsed();
            if let Some(neighbours) = &mut neighbours {
                let began = Instant::now();
                self.solve_strand_contacts(neighbours, frame, number);
                times.neighbours += began.elapsed();
            }
        }
        self.neighbours = neighbours;
        (reset_strands, times)
    }
}
