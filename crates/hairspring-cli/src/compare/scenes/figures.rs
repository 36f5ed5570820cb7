//! Figures of each of the two scenes, and figures that compare them.

use glam::Vec3;
use hairspring_scene::stage::{FrameReport, Stage};
use serde_json::{Value, json};

/// The figures of one side.
#[derive(Default)]
pub struct Figures {
    frames: u32,
    /// Strands that became non-finite and were reset, summed over all frames.
    pub reset_strands: usize,
    /// Substeps of the last frame.
    pub substeps: u32,
    stretch_sum: f64,
    /// Largest |ℓ/L − 1| of all frames [1].
    pub stretch_max: f64,
    /// Speed of the fastest point of all frames [m/s].
    pub speed_max: f64,
    /// Depth of the deepest point inside a collider of all frames [m].
    pub max_depth: f64,
    /// Depth of the deepest segment inside a collider of all frames [m].
    pub segment_depth: f64,
    /// Total energy in the first and in the last frame [J].
    pub energy: [f64; 2],
    kinetic_sum: f64,
    /// Time to simulate each frame but the first [ms].
    times: Vec<f64>,
}

impl Figures {
    /// Adds a frame. The first takes no step.
    pub fn add(&mut self, stage: &Stage, report: Option<&FrameReport>) {
        if let Some(report) = report {
            self.times.push(report.simulate.as_secs_f64() * 1e3);
            self.reset_strands += report.step.reset_strands;
            self.substeps = report.step.substeps;
        }
        let (measure, energy) = (stage.measure(), stage.energy());
        if self.frames == 0 {
            self.energy[0] = energy.total();
        }
        self.frames += 1;
        self.energy[1] = energy.total();
        self.kinetic_sum += energy.kinetic;
        self.stretch_sum += measure.stretch_mean;
        self.stretch_max = self.stretch_max.max(measure.stretch_max);
        self.speed_max = self.speed_max.max(measure.speed_max);
        self.max_depth = self.max_depth.max(measure.max_depth);
        self.segment_depth = self.segment_depth.max(measure.segment_depth);
    }

    /// Mean of |ℓ/L − 1| over segments and frames [1].
    pub fn stretch_mean(&self) -> f64 {
        self.stretch_sum / f64::from(self.frames.max(1))
    }

    /// Mean kinetic energy over the frames [J].
    pub fn kinetic_mean(&self) -> f64 {
        self.kinetic_sum / f64::from(self.frames.max(1))
    }

    /// Median time to simulate a frame [ms]; `None` if there was only one frame.
    pub fn ms_per_frame(&self) -> Option<f64> {
        let mut times = self.times.clone();
        times.sort_by(f64::total_cmp);
        times.get(times.len() / 2).copied()
    }

    /// The figures under their keys, after those of the scene.
    pub fn json(&self, file: &std::path::Path, stage: &Stage) -> Value {
        let ((guides, strands), (guide_points, points)) =
            (stage.simulated_strands(), stage.simulated_points());
        json!({
            "file": file,
            "scene": stage.scene().name,
            "strands": strands,
            "points": points,
            "simulated_strands": guides,
            "simulated_points": guide_points,
            "substeps": self.substeps,
            "reset_strands": self.reset_strands,
            "stretch_mean": self.stretch_mean(),
            "stretch_max": self.stretch_max,
            "speed_max_m_s": self.speed_max,
            "max_depth_m": self.max_depth,
            "segment_depth_m": self.segment_depth,
            "energy_start_j": self.energy[0],
            "energy_end_j": self.energy[1],
            "kinetic_energy_mean_j": self.kinetic_mean(),
            "ms_per_frame": self.ms_per_frame(),
        })
    }
}

/// The distance between points of the same number of the two sides.
#[derive(Default)]
pub struct Distances {
    frames: u32,
    mean_sum: f64,
    /// Largest distance of all frames [m].
    pub max: f64,
    /// Frame and strand of the largest distance.
    pub max_at: (u32, usize),
    /// Mean and largest distance in the last frame [m].
    pub end: [f64; 2],
}

impl Distances {
    /// Whether the two sides have the same numbers of strands and points.
    pub fn are_defined(a: &Stage, b: &Stage) -> bool {
        a.strands().len() == b.strands().len()
            && a.strands().zip(b.strands()).all(|(a, b)| a.groom.offsets == b.groom.offsets)
    }

    /// Adds a frame.
    pub fn add(&mut self, frame: u32, a: &Stage, b: &Stage) {
        let (mut sum, mut count, mut farthest, mut first_strand) = (0.0, 0usize, (0.0, 0), 0);
        for (a, b) in a.strands().zip(b.strands()) {
            let distance = |(p, q): (&Vec3, &Vec3)| f64::from(p.distance(*q));
            for (point, distance) in a.points.iter().zip(b.points).map(distance).enumerate() {
                sum += distance;
                // A distance that is NaN is the largest.
                if !distance.le(&farthest.0) {
                    let strand = a.groom.offsets.partition_point(|first| *first as usize <= point) - 1;
                    farthest = (distance, first_strand + strand);
                }
            }
            count += a.points.len();
            first_strand += a.groom.strand_count();
        }
        let mean = sum / count.max(1) as f64;
        self.frames += 1;
        self.mean_sum += mean;
        self.end = [mean, farthest.0];
        if !farthest.0.le(&self.max) {
            (self.max, self.max_at) = (farthest.0, (frame, farthest.1));
        }
    }

    /// Mean distance over points and frames [m].
    pub fn mean(&self) -> f64 {
        self.mean_sum / f64::from(self.frames.max(1))
    }

    /// The distances under their keys.
    pub fn json(&self) -> Value {
        json!({
            "mean_m": self.mean(),
            "max_m": self.max,
            "max_frame": self.max_at.0,
            "max_strand": self.max_at.1,
            "end_mean_m": self.end[0],
            "end_max_m": self.end[1],
        })
    }
}
