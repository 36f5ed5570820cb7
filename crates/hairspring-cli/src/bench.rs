//! `hairspring bench`: the speed and the quality of the simulation on the standard bench scene.

mod scene;
mod table;

use crate::{
    console::{Console, print_json, print_line},
    fault::Fault,
    totals::{counted, grouped},
};
use clap::Parser;
use glam::Vec3;
use hairspring::{
    material::{Material, Model},
    settings::{Integrator, Quality, Solver, Volume, VolumeMethod, Wind},
    simulation::Simulation,
};
use hairspring_validate::bench::{Bench, Head};
use serde_json::json;
use std::{path::PathBuf, time::Instant};

/// Measures the simulation on the standard bench scene.
///
/// The scene is a spherical scalp of radius 0.1 m with strands of 0.25 m spread evenly over its upper half.
/// The scalp is shaken by 5 cm at 2 Hz in frames of 1/60 s. Hair collides with the sphere, and every strand
/// is simulated.
///
/// `ns_per_point_substep` is per core: wall time x threads / (strands x points x substeps). Stretch and depth
/// are measured between frames and are not timed. They are given for the last frame and, with the suffix
/// `_ever`, for the worst frame.
///
/// `--scene` runs a scene instead and prints medians over its frames: the time of each stage, the time of the
/// solve per point and substep, the number of points and segments that colliders push out, and the number of
/// points that need a collider distance. At the end it measures the speed of the fastest point. With `--rest`,
/// the scene stays in the pose of its first frame, without wind or hands: after 600 frames, hair should rest
/// below 1 mm/s.
///
/// `--table` steps the scene with every elastic model on every instruction set of this processor. All of them
/// run in turn in one process, so that other load on the machine affects all of them alike. Built with
/// `--features scalar`, the table has a last row for the same code without SIMD.
#[derive(Parser)]
#[command(after_help = "\
Examples:
  hairspring bench
  hairspring bench --strands 100000 --frames 60
  hairspring --threads 1 bench --simd sse2 --json
  hairspring bench --table --frames 60
  hairspring bench --scene shot.toml --frames 120
  hairspring bench --scene shot.toml --rest --frames 600")]
pub struct Options {
    /// Number of strands
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    strands: u32,

    /// Points per strand
    #[arg(long, value_name = "N", default_value_t = 32, value_parser = clap::value_parser!(u32).range(3..=1024))]
    points: u32,

    /// Number of frames of 1/60 s; 300 are 5 seconds
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,

    /// Substeps per frame
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=1024))]
    substeps: u32,

    /// Time integrator: backward-euler, bdf2, explicit-euler, verlet, local-global, ftl, dftl
    #[arg(long, value_name = "NAME", default_value = Integrator::default().name())]
    integrator: String,

    /// Elastic model: auto, springs, curvature, rod (auto selects curvature here, because the strands are
    /// straight)
    #[arg(long, value_name = "NAME", default_value = Model::default().name())]
    model: String,

    /// Iterate each substep to convergence (Newton)
    #[arg(long)]
    high_quality: bool,

    /// Device to run on: cpu
    #[arg(long, value_name = "NAME", default_value = DEVICES[0])]
    device: String,

    /// Hair-hair volume method: off, density, incompressible [default: off; density if no method is given]
    #[arg(long, value_name = "METHOD", num_args = 0..=1, default_value = VolumeMethod::Off.name(), default_missing_value = VolumeMethod::Density.name(), hide_default_value = true)]
    hair_hair: String,

    /// Collider for the head: sphere, sdf (the signed distance field of its mesh, as for the body of a scene)
    #[arg(long, value_name = "NAME", default_value = Head::default().name())]
    head: String,

    /// Wind speed, with a gust of half of it once per second [m/s]
    #[arg(long, value_name = "SPEED", default_value_t = 0.0, value_parser = wind_speed)]
    wind: f32,

    /// Instruction set to use instead of the best one of this processor (avx512, avx2, sse2) [default: the
    /// best]
    #[arg(long, value_name = "NAME")]
    simd: Option<String>,

    /// Compare all models on all instruction sets of this processor and, if built in, without SIMD, over the
    /// same frames
    #[arg(long, conflicts_with_all = ["simd", "model", "integrator", "high_quality", "hair_hair", "head", "wind"])]
    table: bool,

    /// Measure a scene (.toml) or a groom instead of the standard scene: the time of each stage and the
    /// contacts of its hair
    #[arg(long, value_name = "FILE", conflicts_with_all = ["table", "strands", "points", "substeps", "simd", "model", "integrator", "high_quality", "device", "hair_hair", "head", "wind"])]
    scene: Option<PathBuf>,

    /// Hold the scene of --scene in the pose of its first frame, without wind or hands
    #[arg(long)]
    rest: bool,

    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

const DEVICES: [&str; 1] = ["cpu"];

/// Maximum number of points of a bench. Their state takes about 100 bytes per point.
const MOST_POINTS: u64 = 200_000_000;

/// Parses a wind speed [m/s]. Above the speed of sound a strand would only be torn.
fn wind_speed(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(speed) if (0.0..=300.0).contains(&speed) => Ok(speed),
        _ => Err("expected a speed of 0 to 300 m/s".into()),
    }
}

/// The time of each frame [s].
struct Times(Vec<f64>);

impl Times {
    /// The time that the given share of the frames stay under [ms]. It is the time of an actual frame
    /// (nearest rank).
    fn rank(&self, share: f64) -> f64 {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        sorted[((share * sorted.len() as f64).ceil() as usize).clamp(1, sorted.len()) - 1] * 1e3
    }

    /// Time of the median frame per core, over all threads [ns per point and substep].
    fn per_point(&self, options: &Options) -> f64 {
        let Options { strands, points, substeps, .. } = *options;
        let work = f64::from(strands) * f64::from(points) * f64::from(substeps);
        self.rank(0.5) * 1e6 * rayon::current_num_threads() as f64 / work
    }
}

/// Runs the command.
pub fn run(options: &Options, console: Console) -> Result<(), Fault> {
    let Options { strands, points, frames, substeps, .. } = *options;
    // Clap does not require an argument that another one excludes.
    if options.rest && options.scene.is_none() {
        return Err(Fault::Usage("--rest needs a scene to hold; add --scene FILE".into()));
    }
    known("integrator", &options.integrator, &Integrator::ALL.map(Integrator::name))?;
    known("model", &options.model, &Model::ALL.map(Model::name))?;
    let integrator = Integrator::ALL.into_iter().find(|i| i.name() == options.integrator).unwrap_or_default();
    let model = Model::ALL.into_iter().find(|m| m.name() == options.model).unwrap_or_default();
    let quality = if options.high_quality { Quality::High } else { Quality::Normal };
    known("head", &options.head, &Head::ALL.map(Head::name))?;
    let head = Head::ALL.into_iter().find(|h| h.name() == options.head).unwrap_or_default();
    known("hair-hair method", &options.hair_hair, &VolumeMethod::ALL.map(VolumeMethod::name))?;
    let method = VolumeMethod::ALL.into_iter().find(|m| m.name() == options.hair_hair).unwrap_or_default();
    known("device", &options.device, &DEVICES)?;
    let benches = if options.table { table::cells().len() } else { 1 };
    if benches as u64 * u64::from(strands) * u64::from(points) > MOST_POINTS {
        let times = if options.table { format!(", {benches} times,") } else { String::new() };
        let text = format!(
            "{strands} strands of {points} points{times} are more than {MOST_POINTS} points; choose fewer"
        );
        return Err(Fault::Usage(text));
    }
    if let Some(path) = &options.scene {
        return scene::run(path, (frames, options.rest), options.json, console);
    }
    if options.table {
        return table::run(options, console);
    }
    let mut bench = Bench::with_head(
        head,
        strands,
        points,
        Material { model, ..Material::default() },
        Solver { substeps, integrator, quality, ..Solver::default() },
    );
    bench.wind = Wind { velocity: Vec3::Z * options.wind, gust: 0.5, gust_rate: 1.0 };
    bench.simulation.set_volume(&Volume { method, ..Volume::default() }).unwrap();
    if let Some(name) = &options.simd
        && !bench.simulation.use_instruction_set(name)
    {
        let there = Simulation::instruction_sets();
        known("instruction set", name, &there.iter().map(String::as_str).collect::<Vec<_>>())?;
    }
    let mut times = Times(Vec::with_capacity(frames as usize));
    let (mut stretch_ever, mut depth_ever, mut reset) = (0f64, 0f64, 0);
    let mut segment_ever = 0f64;
    let mut measure = bench.measure();
    let mut progress = console.progress("simulating", frames);
    for frame in 1..=frames {
        let began = Instant::now();
        let report = bench.step();
        let time = began.elapsed().as_secs_f64();
        times.0.push(time);
        reset += report.reset_strands;
        measure = bench.measure();
        stretch_ever = stretch_ever.max(measure.stretch_max);
        depth_ever = depth_ever.max(measure.max_depth);
        segment_ever = segment_ever.max(measure.segment_depth);
        progress.step(|| {
            format!(
                "frame {frame}: {:.2} ms, stretch {:.4} % mean, {:.3} % worst, {} points inside",
                time * 1e3,
                measure.stretch_mean * 1e2,
                measure.stretch_max * 1e2,
                measure.inside_points
            )
        });
    }
    drop(progress);
    let (fastest, median, p95) = (times.rank(0.0), times.rank(0.5), times.rank(0.95));
    let ns = times.per_point(options);
    let threads = rayon::current_num_threads();
    let simulation = &bench.simulation;
    let bytes = simulation.bytes() as f64 / simulation.point_count() as f64;
    let simd = simulation.instruction_set();
    if options.json {
        print_json(&json!({
            "device": options.device,
            "threads": threads,
            "strands": strands,
            "points": points,
            "substeps": substeps,
            "frames": frames,
            "integrator": options.integrator,
            "hair_hair": method != VolumeMethod::Off,
            "ms_per_frame_median": median,
            "ms_per_frame_p95": p95,
            "ns_per_point_substep": ns,
            "stretch_mean": measure.stretch_mean,
            "stretch_max": measure.stretch_max,
            "inside_points": measure.inside_points,
            "max_depth_m": measure.max_depth,
            "non_finite": measure.non_finite,
            "bytes_per_point": bytes,
            "stages": { "simulate": median },
            "simd": simd,
            "model": options.model,
            "stretch_max_ever": stretch_ever,
            "max_depth_m_ever": depth_ever,
            "reset_strands": reset,
            "ms_per_frame_fastest": fastest,
            "head": options.head,
            "wind_m_s": options.wind,
            "started_inside_points": measure.started_inside_points,
            "started_inside_depth_m": measure.started_inside_depth,
            "inside_segments": measure.inside_segments,
            "deep_segments": measure.deep_segments,
            "segment_depth_m": measure.segment_depth,
            "segment_depth_m_ever": segment_ever,
            "surface_depth_m": measure.surface_depth,
            "held_segments": measure.held_segments,
            "held_depth_m": measure.held_depth,
            "volume": simulation.volume().map(|v| json!({
                "method": method.name(),
                "cell_m": v.cell,
                "nodes": v.nodes,
                "share": v.volume_ratio,
            })),
        }));
        return Ok(());
    }
    print_scene(options);
    print_line(format_args!(
        "on       {}, {}, {simd}, {}, {}, {} of 1/60 s",
        options.device,
        counted(threads, "thread"),
        options.integrator,
        counted(substeps as usize, "substep"),
        counted(frames as usize, "frame")
    ));
    print_line(format_args!(
        "time     {median:.2} ms per frame (median), {fastest:.2} ms (fastest), {p95:.2} ms (95 %)"
    ));
    print_line(format_args!("         {ns:.2} ns per point and substep, per core (wall time x threads)"));
    print_line(format_args!(
        "stretch  {:.4} % mean, {:.3} % maximum at the end; {:.3} % maximum over all frames",
        measure.stretch_mean * 1e2,
        measure.stretch_max * 1e2,
        stretch_ever * 1e2
    ));
    print_line(format_args!(
        "contact  {} points inside at the end, at most {:.4} mm deep; {:.4} mm over all frames; {} of them started inside",
        measure.inside_points,
        measure.depth_inside() * 1e3,
        depth_ever * 1e3,
        measure.started_inside_points
    ));
    print_line(format_args!(
        "         {} segments deeper than they started at the end, {} of them by more than 1 mm, at most {:.4} mm deep; {:.4} mm over all frames",
        measure.inside_segments,
        measure.deep_segments,
        measure.segment_depth * 1e3,
        segment_ever * 1e3
    ));
    if let Some(volume) = simulation.volume() {
        print_line(format_args!(
            "volume   {}, cells of {:.1} mm, {} nodes, {:.1} % of the rest volume filled",
            method.name(),
            volume.cell * 1e3,
            grouped(volume.nodes),
            volume.volume_ratio * 1e2
        ));
    }
    print_line(format_args!("memory   {bytes:.1} bytes per point"));
    print_line(format_args!("broken   {} values not finite, {reset} strands reset", measure.non_finite));
    Ok(())
}

/// Prints the size of the simulated hair.
fn print_scene(options: &Options) {
    let (strands, points) = (options.strands as usize, options.points as usize);
    let all = grouped(strands * points);
    print_line(format_args!("scene    {} strands x {points} points = {all} points", grouped(strands)));
}

/// Returns an error if `name` is not one of the valid names in `there`.
fn known(what: &str, name: &str, there: &[&str]) -> Result<(), Fault> {
    match there.contains(&name) {
        true => Ok(()),
        false => Err(Fault::Usage(format!("unknown {what} '{name}'; expected one of: {}", there.join(", ")))),
    }
}
