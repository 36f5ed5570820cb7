//! A summary of what was simulated and how fast, as text and as JSON.

use crate::console::print_line;
use hairspring_scene::stage::{FrameReport, Stage};
use hairspring_view::Timings;
use serde_json::{Map, Value, json};
use std::time::{Duration, Instant};

/// Overlap of strands in contact, relative to their radius, above which it is reported [1].
const PRESSED: f32 = 0.5;

/// Sums over a run.
pub struct Totals {
    began: Instant,
    steps: u32,
    drawn: u32,
    /// Bytes sent to the GPU. The first picture is not counted, because it uploads the static data.
    sent: u64,
    substeps: u32,
    reset_strands: usize,
    body: Duration,
    simulate: Duration,
    follow: Duration,
    shadow: Duration,
    draw: Duration,
    written: u32,
    write: Duration,
}

impl Totals {
    /// Starts counting.
    pub fn new() -> Self {
        Self {
            began: Instant::now(),
            steps: 0,
            drawn: 0,
            sent: 0,
            substeps: 0,
            reset_strands: 0,
            body: Duration::ZERO,
            simulate: Duration::ZERO,
            follow: Duration::ZERO,
            shadow: Duration::ZERO,
            draw: Duration::ZERO,
            written: 0,
            write: Duration::ZERO,
        }
    }

    /// Adds the step to a frame. Frame 1 takes no step.
    pub fn stepped(&mut self, frame: u32, report: &FrameReport) {
        if frame > 1 {
            self.steps += 1;
            self.substeps = report.step.substeps;
            self.reset_strands += report.step.reset_strands;
            self.body += report.body;
            self.simulate += report.simulate;
            self.follow += report.follow;
        }
    }

    /// Adds a drawn frame; `sent` is the number of bytes that were sent to the GPU for it.
    pub fn drawn(&mut self, timings: Timings, sent: u64) {
        self.sent += if self.drawn > 0 { sent } else { 0 };
        self.drawn += 1;
        self.shadow += timings.shadow;
        self.draw += timings.strands + timings.tiles;
    }

    /// Adds `frames` frames that were written in `time`.
    pub fn written(&mut self, frames: u32, time: Duration) {
        self.written += frames;
        self.write += time;
    }

    /// Mean time per frame of each stage that ran [ms].
    fn stages(&self) -> Vec<(&'static str, f64)> {
        let mean = |time: Duration, n: u32| time.as_secs_f64() * 1e3 / f64::from(n);
        [
            ("body", self.body, self.steps),
            ("simulate", self.simulate, self.steps),
            ("follow", self.follow, self.steps),
            ("shadow", self.shadow, self.drawn),
            ("draw", self.draw, self.drawn),
            ("write", self.write, self.written),
        ]
        .into_iter()
        .filter(|(_, _, n)| *n > 0)
        .map(|(name, time, n)| (name, mean(time, n)))
        .collect()
    }

    /// Bytes sent to the GPU per frame, without the first frame.
    fn sent_a_frame(&self) -> f64 {
        self.sent as f64 / f64::from(self.drawn.saturating_sub(1).max(1))
    }

    /// Prints the summary on standard output.
    pub fn print(&self, stage: &Stage) {
        let (guides, strands) = stage.simulated_strands();
        let (guide_points, points) = stage.simulated_points();
        let ran = match guides == strands {
            true => format!("{} of {}, all simulated", counted(strands, "hair"), counted(points, "point")),
            false => format!(
                "{} hairs of {} points follow {} simulated guides of {} points",
                grouped(strands),
                grouped(points),
                grouped(guides),
                grouped(guide_points)
            ),
        };
        print_line(format_args!("ran      {ran}"));
        let substeps = match self.substeps {
            0 => "no substeps".into(),
            n => format!("{} per frame", counted(n as usize, "substep")),
        };
        print_line(format_args!(
            "on       {}, {}, {substeps}",
            counted(rayon::current_num_threads(), "thread"),
            stage.instruction_set()
        ));
        let start = stage.start();
        if start.stiffened > 0 {
            print_line(format_args!(
                "start    {} stiffer than their fiber, by the least amount that holds the groom as authored",
                joints(start.stiffened)
            ));
        }
        if start.coils > 0 {
            let coils = start.coils;
            print_line(format_args!(
                "start    {coils} strands turn by more than half a turn; they are simulated as rods, because the curvature model has no twist"
            ));
        }
        if start.held_back > 0 {
            print_line(format_args!(
                "start    {} softer than specified, the most that is stable at {}; use more substeps",
                joints(start.held_back),
                counted(stage.scene().solver.substeps as usize, "substep")
            ));
        }
        let neighbours = stage.neighbours().unwrap_or_default();
        if neighbours.merged_strands > 0 {
            print_line(format_args!(
                "same     {} strands are identical to others and share their contacts",
                grouped(neighbours.merged_strands)
            ));
        }
        if neighbours.crowded_segments > 0 {
            print_line(format_args!(
                "crowded  {} segments had more neighbors at once than are tested; some contacts were missed",
                grouped(neighbours.crowded_segments)
            ));
        }
        if neighbours.depth > PRESSED * neighbours.radius {
            print_line(format_args!(
                "pressed  strands overlap by up to {:.1} mm, at a contact radius of {:.1} mm: they have less space than at rest, \
                 and may vibrate; a smaller neighbours.radius lets them rest",
                1e3 * neighbours.depth,
                1e3 * neighbours.radius
            ));
        }
        let stages: Vec<String> = self.stages().iter().map(|(name, ms)| format!("{name} {ms:.1}")).collect();
        print_line(format_args!("ms/frame {}", stages.join(", ")));
        if self.sent > 0 {
            print_line(format_args!("sent     {:.1} MB per frame to the GPU", self.sent_a_frame() * 1e-6));
        }
        let contact = stage.measure();
        print_line(format_args!(
            "contact  {} inside at the end, at most {:.3} mm deep; {} deeper than 1 mm, at most {:.3} mm deep ({:.3} mm in the meshes)",
            counted(contact.inside_points, "point"),
            contact.depth_inside() * 1e3,
            counted(contact.deep_segments, "segment"),
            contact.segment_depth * 1e3,
            contact.surface_depth * 1e3
        ));
        if contact.started_inside_points > 0 {
            print_line(format_args!(
                "         {} of these points started inside and are no deeper, at most {:.3} mm deep",
                grouped(contact.started_inside_points),
                contact.started_inside_depth * 1e3
            ));
        }
        if contact.held_segments > 0 {
            print_line(format_args!(
                "         {} more segments start inside, held there by the root, at most {:.3} mm deep",
                grouped(contact.held_segments),
                contact.held_depth * 1e3
            ));
        }
        if self.reset_strands > 0 {
            print_line(format_args!(
                "reset    {} of strands that became non-finite",
                counted(self.reset_strands, "reset")
            ));
        }
        print_line(format_args!("took     {:.1} s", self.began.elapsed().as_secs_f64()));
    }

    /// Returns the summary as JSON; the keys of `extra` come first.
    pub fn json(&self, stage: &Stage, extra: Value) -> Value {
        let (guides, strands) = stage.simulated_strands();
        let (guide_points, points) = stage.simulated_points();
        let stages: Map<String, Value> =
            self.stages().into_iter().map(|(name, ms)| (name.into(), json!(ms))).collect();
        let contact = stage.measure();
        let Value::Object(mut all) = extra else { return extra };
        let Value::Object(rest) = json!({
            "scene": stage.scene().name,
            "strands": strands,
            "points": points,
            "simulated_strands": guides,
            "simulated_points": guide_points,
            "stiffened_joints": stage.start().stiffened,
            "held_back_joints": stage.start().held_back,
            "coils_as_rods": stage.start().coils,
            "same_strands": stage.neighbours().unwrap_or_default().merged_strands,
            "crowded_segments": stage.neighbours().unwrap_or_default().crowded_segments,
            "overlap_m": stage.neighbours().unwrap_or_default().depth,
            "substeps": self.substeps,
            "threads": rayon::current_num_threads(),
            "simd": stage.instruction_set(),
            "reset_strands": self.reset_strands,
            "inside_points": contact.inside_points,
            "max_depth_m": contact.max_depth,
            "started_inside_points": contact.started_inside_points,
            "started_inside_depth_m": contact.started_inside_depth,
            "inside_segments": contact.inside_segments,
            "deep_segments": contact.deep_segments,
            "segment_depth_m": contact.segment_depth,
            "surface_depth_m": contact.surface_depth,
            "held_segments": contact.held_segments,
            "held_depth_m": contact.held_depth,
            "ms_per_frame": stages,
            "bytes_sent_per_frame": self.sent_a_frame(),
            "seconds": self.began.elapsed().as_secs_f64(),
        }) else {
            return Value::Object(all);
        };
        all.extend(rest);
        Value::Object(all)
    }
}

/// `1 joint is`, `2 joints are`.
fn joints(n: usize) -> String {
    format!("{} joint{}", grouped(n), if n == 1 { " is" } else { "s are" })
}

/// `1 frame`, `2 frames`.
pub fn frames(n: usize) -> String {
    counted(n, "frame")
}

/// A number of things, in the plural unless it is one.
pub fn counted(n: usize, noun: &str) -> String {
    format!("{} {noun}{}", grouped(n), if n == 1 { "" } else { "s" })
}

/// A number with commas between thousands.
pub fn grouped(n: usize) -> String {
    let digits = n.to_string();
    let first = (digits.len() - 1) % 3 + 1;
    let mut out = digits[..first].to_owned();
    for three in digits.as_bytes()[first..].chunks(3) {
        out.push(',');
        out.extend(three.iter().map(|d| char::from(*d)));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{frames, grouped};

    #[test]
    fn thousands_are_separated_by_commas() {
        let cases = [(0, "0"), (999, "999"), (1000, "1,000"), (123_456, "123,456"), (3_200_000, "3,200,000")];
        for (n, text) in cases {
            assert_eq!(grouped(n), text);
        }
        assert_eq!((frames(1), frames(1500)), ("1 frame".into(), "1,500 frames".into()));
    }
}
