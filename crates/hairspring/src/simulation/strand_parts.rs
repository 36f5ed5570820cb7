//! Intervals of a frame: the hair volume acts in intervals of constant length at any frame rate, and strand
//! contact after every substep.
//!
//! ```text
//! frame at 60 Hz   ├───────────────┤     substeps   ├───┼───┼───┼───┤     volume intervals   ├───┼───┼───┼───┤
//! at 240 Hz        ├───┤                            ├───┤                                    ├───┤
//! ```

use super::{
    Simulation, StepInput,
    step::{LONGER, StepTimes},
};
use crate::{math::RigidTransform, strand::frame_context::FrameContext};
use std::time::Instant;

/// Longest interval for which the volume's accelerations are constant [s]. Tresses that swing into each other
/// approach by a centimeter within it, about a cell.
const LONGEST: f64 = 1.0 / 240.0;

impl Simulation {
    /// Computes the external forces, runs all substeps, and solves strand contacts between them. Returns how
    /// many strands were reset, and the durations of the stages.
    pub(super) fn run_in_parts(
        &mut self,
        drive: &StepInput,
        carried: Option<&RigidTransform>,
        interval: &mut FrameContext,
    ) -> (usize, StepTimes) {
        let substeps = interval.now.len();
        let exchanges = (f64::from(drive.dt) / (LONGEST * LONGER)).ceil() as usize;
        let frozen = if self.is_pressed() { substeps.div_ceil(exchanges) } else { substeps };
        let mut neighbours = self.neighbours.take();
        interval.meets = false;
        let alone = if neighbours.is_some() { 1 } else { frozen };
        interval.now = 0..frozen.min(substeps);
        let mut times = StepTimes::default();
        let began = Instant::now();
        times.volume = self.exchange(drive, carried, interval);
        times.forces = began.elapsed() - times.volume;
        let start = std::mem::replace(&mut self.state.anchor, drive.anchor);
        let mut reset_strands = 0;
        for number in (0..substeps).step_by(alone) {
            if number > 0 && number.is_multiple_of(frozen) {
                interval.now = number..(number + frozen).min(substeps);
                let began = Instant::now();
                self.exchange_again(start.lerp(&drive.anchor, interval.begun().0), interval);
                times.volume += began.elapsed();
            }
            interval.now = number..(number + alone).min(substeps);
            let began = Instant::now();
            if let Some(neighbours) = &mut neighbours {
                self.bear_neighbours(neighbours, interval.h);
                interval.meets = neighbours.touch();
            }
            let borne = Instant::now();
            if neighbours.is_some() {
                times.neighbours += borne - began;
            }
            reset_strands += self.run(interval);
            interval.continues = true;
            times.solve += borne.elapsed();
            if let Some(neighbours) = &mut neighbours {
                let began = Instant::now();
                self.meet_neighbours(neighbours, interval, number);
                times.neighbours += began.elapsed();
            }
        }
        self.neighbours = neighbours;
        (reset_strands, times)
    }
}
