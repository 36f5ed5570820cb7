//! Numbers of samples: which step of the simulation, and which frame, each is.

use crate::{fault::Fault, frames::FrameRange};
use hairspring_scene::stage::FrameRate;

/// The samples of a bake: one or more for each frame. Samples have consecutive numbers; with one sample per frame, these are the
/// numbers of the frames.
pub struct Samples {
    /// Number of the frame at time 0.
    start: u32,
    per_frame: u32,
    fps: FrameRate,
    rate: FrameRate,
}

impl Samples {
    /// `per_frame` samples for each frame at `fps`, with frame `start` at time 0.
    pub fn new(start: u32, per_frame: u32, fps: FrameRate) -> Self {
        Self { start, per_frame, fps, rate: fps.times(per_frame) }
    }

    /// Samples per second.
    pub fn rate(&self) -> FrameRate {
        self.rate
    }

    /// Samples per frame.
    pub fn per_frame(&self) -> u32 {
        self.per_frame
    }

    /// Frames per second [Hz].
    pub fn fps(&self) -> f64 {
        self.fps.hertz()
    }

    /// The frames of a whole motion of this duration [s]; five seconds without a motion.
    pub fn whole(&self, motion: Option<f64>) -> FrameRange {
        let range = FrameRange::whole(motion, self.fps);
        FrameRange { first: range.first + self.start - 1, last: range.last + self.start - 1 }
    }

    /// Checks that frames are not before the start.
    pub fn check(&self, range: FrameRange) -> Result<(), Fault> {
        if range.first < self.start {
            let text =
                format!("frame {} is before frame {}, which is at time 0 (--start)", range.first, self.start);
            return Err(Fault::Usage(text));
        }
        Ok(())
    }

    /// The samples of some frames. The last frame has one.
    pub fn of(&self, range: FrameRange) -> std::ops::RangeInclusive<u32> {
        let number = |frame: u32| self.start + (frame - self.start) * self.per_frame;
        number(range.first)..=number(range.last)
    }

    /// How many of these samples are at the time of a frame.
    pub fn frames_in(&self, samples: &[u32]) -> usize {
        samples.iter().filter(|sample| self.step_of(**sample).is_multiple_of(self.per_frame)).count()
    }

    /// The number of steps from time 0 to a sample.
    pub fn step_of(&self, sample: u32) -> u32 {
        sample - self.start
    }

    /// The sample after this number of steps.
    pub fn at_step(&self, step: u32) -> u32 {
        self.start + step
    }

    /// The frame of a sample, which may be between whole frames.
    pub fn frame_of(&self, sample: u32) -> f64 {
        f64::from(self.start) + f64::from(sample - self.start) / f64::from(self.per_frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_divide_frames_that_begin_anywhere() {
        let fps = FrameRate::new(24, 1).unwrap();
        let samples = Samples::new(1001, 2, fps);
        assert_eq!(samples.rate().hertz(), 48.0);
        let all: Vec<u32> = samples.of(FrameRange { first: 1002, last: 1003 }).collect();
        assert_eq!(all.iter().map(|s| samples.frame_of(*s)).collect::<Vec<_>>(), [1002.0, 1002.5, 1003.0]);
        assert_eq!(all.iter().map(|s| samples.step_of(*s)).collect::<Vec<_>>(), [2, 3, 4]);
        assert_eq!((samples.frames_in(&all), samples.frames_in(&all[1..])), (2, 1));
        assert!(samples.check(FrameRange { first: 1000, last: 1003 }).is_err());
        assert_eq!(samples.whole(None), FrameRange { first: 1001, last: 1120 });
    }
}
