//! `hairspring bench --scene`: the time of each stage of a scene's frames, and the contacts of its hair.

use super::Times;
use crate::{
    console::{Console, print_json, print_line},
    fault::Fault,
    input::{Input, Units},
    totals::{counted, grouped},
};
use hairspring_scene::{
    Scene,
    stage::{FrameRate, FrameReport, Stage},
};
use serde_json::{Map, Value, json};
use std::{path::Path, time::Duration};

/// A stage of a frame: its name, a description, and its time in a frame.
type StageOfFrame = (&'static str, &'static str, fn(&FrameReport) -> Duration);

const STAGES: [StageOfFrame; 6] = [
    ("body", "pose, skin, distance field", |r| r.body),
    ("volume", "density of the hair, once a frame", |r| r.step.times.volume),
    ("forces", "roots, wind, global shapes, charge, hands, once a frame", |r| r.step.times.forces),
    ("solve", "assembly, solve, projection, contact, strain limit, all substeps", |r| r.step.times.solve),
    ("neighbours", "contacts between strands, all substeps", |r| r.step.times.neighbours),
    ("follow", "hairs that are not simulated", |r| r.follow),
];

const RATE: FrameRate = FrameRate::new(60, 1).expect("a rate");

/// Index of the stage that the time per point and substep refers to.
const SOLVE: usize = 3;

/// A count for every frame.
#[derive(Default)]
struct Counts(Vec<usize>);

impl Counts {
    fn median(&self) -> usize {
        let mut sorted = self.0.clone();
        sorted.sort_unstable();
        sorted[sorted.len() / 2]
    }
}

/// Removes all that moves from a scene: motion, wind and hands.
fn hold(scene: &mut Scene) {
    if let Some(clip) = &mut scene.clip {
        clip.samples.truncate(clip.joint_count);
    }
    (scene.wind, scene.turbulence) = Default::default();
    scene.wind_sources.clear();
    scene.hands.clear();
    scene.charged.iter_mut().for_each(|ball| ball.path.clear());
}

/// Frames at the end in which the fastest point is searched for: one second. Hair may lie still at one time and jump at
/// another.
const LAST_FRAMES: u32 = 60;

/// Runs the scene in `path` for `frames` of 1/60 s, held in its first pose if `rest`, and prints medians over
/// its frames.
pub(super) fn run(
    path: &Path,
    (frames, rest): (u32, bool),
    as_json: bool,
    console: Console,
) -> Result<(), Fault> {
    let units = Units::default();
    let input = Input { path: path.into(), units, guides: None, substeps: None };
    let mut scene = input.scene(console)?;
    if rest {
        hold(&mut scene);
    }
    let mut stage = Stage::new(scene)?;
    let mut stages: [Times; STAGES.len()] = std::array::from_fn(|_| Times(Vec::new()));
    let (mut whole, mut per_point) = (Times(Vec::new()), Times(Vec::new()));
    let (mut points, mut segments, mut looked_up) = Default::default();
    let count = |counts: &mut Counts, n| counts.0.push(n);
    let threads = rayon::current_num_threads();
    let (simulated, all) = (stage.simulated_points(), stage.simulated_strands());
    let (mut substeps, mut reset, mut fastest) = (0, 0, 0.0_f64);
    let mut progress = console.progress("simulating", frames);
    for frame in 1..=frames {
        let report = stage.step_frame(RATE);
        let took = STAGES.map(|(_, _, of)| of(&report));
        stages.iter_mut().zip(took).for_each(|(times, took)| times.0.push(took.as_secs_f64()));
        whole.0.push((report.body + report.simulate + report.follow).as_secs_f64());
        let work = simulated.0 as f64 * f64::from(report.step.substeps);
        per_point.0.push(took[SOLVE].as_secs_f64() * threads as f64 / work);
        let contacts = stage.contacts();
        count(&mut points, contacts.points);
        count(&mut segments, contacts.segments);
        count(&mut looked_up, contacts.distance_queries);
        substeps = report.step.substeps.max(substeps);
        reset += report.step.reset_strands;
        if frames - frame < LAST_FRAMES {
            fastest = fastest.max(stage.measure().speed_max);
        }
        progress.step(|| format!("frame {frame}: {:.2} ms", whole.0[frame as usize - 1] * 1e3));
    }
    drop(progress);
    let measure = stage.measure();
    let ns = per_point.rank(0.5) * 1e6;
    let [points, segments, looked_up] = [points, segments, looked_up].map(|counts: Counts| counts.median());
    let solver = stage.scene().solver;
    if as_json {
        let each =
            STAGES.iter().zip(&stages).map(|((name, ..), times)| ((*name).into(), json!(times.rank(0.5))));
        print_json(&json!({
            "scene": path.display().to_string(),
            "threads": threads,
            "simd": stage.instruction_set(),
            "integrator": solver.integrator.name(),
            "strands": all.1,
            "simulated_strands": all.0,
            "simulated_points": simulated.0,
            "substeps": solver.substeps,
            "most_substeps": substeps,
            "rest": rest,
            "frames": frames,
            "ms_per_frame_median": whole.rank(0.5),
            "ms_per_frame_p95": whole.rank(0.95),
            "stages": Value::Object(each.collect::<Map<_, _>>()),
            "ns_per_point_substep": ns,
            "points_in_contact": points,
            "segments_in_contact": segments,
            "points_looked_up": looked_up,
            "speed_max_m_s": fastest,
            "non_finite": measure.non_finite,
            "reset_strands": reset,
        }));
        return Ok(());
    }
    print_line(format_args!(
        "scene    {}: {} of {} strands simulated, {} points",
        path.display(),
        grouped(all.0),
        grouped(all.1),
        grouped(simulated.0)
    ));
    print_line(format_args!(
        "on       cpu, {}, {}, {}, {} (at most {substeps}), {} of 1/60 s",
        counted(threads, "thread"),
        stage.instruction_set(),
        solver.integrator.name(),
        counted(solver.substeps as usize, "substep"),
        counted(frames as usize, "frame")
    ));
    print_line(format_args!(
        "time     {:.2} ms per frame (median), {:.2} ms (95 %); medians of the stages:",
        whole.rank(0.5),
        whole.rank(0.95)
    ));
    for ((name, what, _), times) in STAGES.iter().zip(&stages) {
        print_line(format_args!("         {:8.2} ms  {name:<11} {what}", times.rank(0.5)));
    }
    print_line(format_args!(
        "         {ns:.2} ns per point and substep, per core, for the solve alone (wall time x threads)"
    ));
    print_line(format_args!(
        "contact  {} points and {} segments pushed out by a collider at the end of the median frame",
        grouped(points),
        grouped(segments)
    ));
    print_line(format_args!("         {} points that need a collider distance", grouped(looked_up)));
    print_line(format_args!(
        "speed    {:.2} mm/s: the fastest simulated point in the last second",
        fastest * 1e3
    ));
    print_line(format_args!("broken   {} values not finite, {reset} strands reset", measure.non_finite));
    Ok(())
}
