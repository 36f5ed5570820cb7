//! `hairspring compare --methods`: every integrator on the same hair.

mod lessons;
mod play;
mod report;
mod swing;

use super::Options;
use crate::{
    console::{Console, print_json, print_line},
    fault::Fault,
    input::Input,
    output,
    report::number,
    totals::{counted, grouped},
};
use hairspring::settings::Integrator;
use hairspring_scene::{
    Guides, Scene,
    builtin::{self, BuiltinOptions, Style},
    stage::Stage,
};
use hairspring_validate::swing::{Sample, TILT};
use play::Played;
use serde_json::{Value, json};
use swing::{LongestStep, Swung};

/// Largest |ℓ/L − 1| of a method that counts as stable [1]. Above it, a segment is more than twice as long as
/// it should be, and the method has diverged.
const BOUND: f64 = 1.0;

/// Strands in the free swing.
const SWINGING: usize = 64;

/// Strands in the search for the longest stable step: one tile. A method that needs steps of a microsecond
/// takes hundreds of thousands of steps here.
const STEPPING: usize = 8;

/// Strands of the built-in head, and how many of them are simulated.
const HEAD: (u32, u32) = (4_000, 300);

/// Default length of the comparison [s].
const SECONDS: f32 = 3.0;

/// Longest comparison [s].
const LONGEST: f32 = 600.0;

/// The results of one integrator.
struct Trial {
    integrator: Integrator,
    played: Played,
    swung: Swung,
    longest: LongestStep,
}

impl Trial {
    /// Whether the method kept the scene stable.
    fn stable(&self) -> bool {
        // A stretch that is NaN is not within the bound.
        self.played.reset_strands == 0 && self.played.stretch_max <= BOUND
    }

    /// Number of points that one thread can simulate in real time at the longest stable step.
    fn points_in_real_time(&self) -> Option<f64> {
        self.longest.seconds().map(|h| h / (self.played.ns * 1e-9))
    }
}

/// The setup of a comparison.
struct Setting {
    name: String,
    simulated_strands: usize,
    simulated_points: usize,
    strands: usize,
    substeps: u32,
    seconds: f64,
    simd: String,
    swinging: Sample,
    stepping: Sample,
}

/// Runs the command.
pub fn run(options: &Options, console: Console) -> Result<(), Fault> {
    let integrators = integrators(&options.integrators)?;
    let seconds = options.seconds.unwrap_or(SECONDS);
    if seconds > LONGEST {
        return Err(Fault::Usage(format!("--seconds is at most {LONGEST}")));
    }
    if let Some(path) = &options.report {
        output::check_report(path)?;
    }
    let scene = scene(options, console)?;
    let still =
        scene.wind.velocity.length() == 0.0 && scene.wind_sources.is_empty() && !scene.turbulence.is_on();
    if scene.clip.is_none() && still && scene.charged.is_empty() {
        console.note("nothing moves the hair of this scene; only the free swing shows a difference between the methods");
    }
    let frames = ((seconds * 60.0).round() as u32).max(play::MOMENTS);
    let seconds = f64::from(frames) / 60.0;
    let swinging = Sample::new(&scene, SWINGING).without_losses();
    let stepping = Sample::new(&scene, STEPPING);

    let draw = options.report.is_some();
    let mut setting = None;
    let mut played = Vec::with_capacity(integrators.len());
    let mut progress = console.progress("playing the scene", frames * integrators.len() as u32);
    for &integrator in &integrators {
        let mut scene = scene.clone();
        scene.solver.integrator = integrator;
        let stage = Stage::new(scene)?;
        setting.get_or_insert_with(|| Setting {
            name: stage.scene().name.clone(),
            simulated_strands: stage.simulated_strands().0,
            simulated_points: stage.simulated_points().0,
            strands: stage.simulated_strands().1,
            substeps: stage.scene().solver.substeps,
            seconds,
            simd: stage.instruction_set(),
            swinging: swinging.clone(),
            stepping: stepping.clone(),
        });
        played.push(play::play(stage, frames, draw, &mut progress)?);
    }
    drop(progress);
    let Some(setting) = setting else { return Err(Fault::Usage("no integrator is named".into())) };

    let mut trials = Vec::with_capacity(integrators.len());
    let mut progress = console.progress_in(
        "swinging, and searching for the longest step",
        integrators.len() as u32,
        "methods",
    );
    for (&integrator, played) in integrators.iter().zip(played) {
        let swung = swing::swing(&swinging, integrator, setting.substeps, seconds);
        let longest = swing::longest_step(&stepping, integrator);
        progress.step(|| format!("{}: longest stable step {}", integrator.name(), longest.label()));
        trials.push(Trial { integrator, played, swung, longest });
    }
    drop(progress);

    if let Some(path) = &options.report {
        output::write_whole(path, report::page(&setting, &trials).as_bytes())?;
    }
    if options.json {
        print_json(&as_json(&setting, &trials, options));
    } else {
        print(&setting, &trials);
        if let Some(path) = &options.report {
            print_line(format_args!("wrote    {}", path.display()));
        }
    }
    Ok(())
}

/// Returns the integrators of these names, each once. If there are no names, returns all of them.
fn integrators(names: &[String]) -> Result<Vec<Integrator>, Fault> {
    if names.is_empty() {
        return Ok(Integrator::ALL.to_vec());
    }
    let mut chosen = Vec::new();
    for name in names.iter().map(|n| n.trim()) {
        let found = Integrator::ALL.into_iter().find(|i| i.name() == name).ok_or_else(|| {
            let there = Integrator::ALL.map(Integrator::name).join(", ");
            Fault::Usage(format!("unknown integrator '{name}'; expected one of: {there}"))
        })?;
        if !chosen.contains(&found) {
            chosen.push(found);
        }
    }
    Ok(chosen)
}

fn scene(options: &Options, console: Console) -> Result<Scene, Fault> {
    let Options { units, guides, substeps, .. } = *options;
    if let Some(path) = &options.a {
        return Input { path: path.clone(), units, guides, substeps }.scene(console);
    }
    if units.scale.is_some() || units.up.is_some() || units.reverse {
        return Err(Fault::Usage("--scale, --up and --reverse apply to a groom file; none is given".into()));
    }
    let mut scene = builtin::scene(&BuiltinOptions {
        strands: HEAD.0,
        guides: guides.unwrap_or(Guides::Count(HEAD.1)),
        ..BuiltinOptions::new(Style::Straight)
    });
    // Eyebrows and eyelashes are too short and stiff to be informative, and the shortest segment determines
    // the longest step.
    scene.grooms.truncate(1);
    scene.solver.substeps = substeps.unwrap_or(scene.solver.substeps);
    Ok(scene)
}

fn as_json(setting: &Setting, trials: &[Trial], options: &Options) -> Value {
    let one = |t: &Trial| {
        json!({
            "integrator": t.integrator.name(),
            "stable": t.stable(),
            "reset_strands": t.played.reset_strands,
            "stretch_mean": t.played.stretch_mean,
            "stretch_max": t.played.stretch_max,
            "swing_stretch_max": t.swung.stretch_max,
            "energy_drift": t.swung.drift,
            "ns_per_point_substep": t.played.ns,
            "longest_stable_step_s": t.longest.seconds(),
            "points_in_real_time": t.points_in_real_time(),
        })
    };
    json!({
        "scene": setting.name,
        "simulated_strands": setting.simulated_strands,
        "simulated_points": setting.simulated_points,
        "substeps": setting.substeps,
        "seconds": setting.seconds,
        "threads": rayon::current_num_threads(),
        "simd": setting.simd,
        "stable_stretch_bound": BOUND,
        "swinging_strands": setting.swinging.strand_count(),
        "stepping_strands": setting.stepping.strand_count(),
        "report": options.report,
        "integrators": trials.iter().map(one).collect::<Vec<_>>(),
    })
}

/// Column headers of the table.
const HEADS: [&str; 8] = [
    "integrator",
    "stable",
    "stretch, mean",
    "worst",
    "energy drift",
    "ns/point/substep",
    "longest step",
    "points in real time",
];

/// A row of the table, as text.
fn row(t: &Trial) -> [String; 8] {
    let stable = match (t.stable(), t.played.reset_strands) {
        (true, _) => "yes".into(),
        (false, 0) => "no".into(),
        (false, n) => format!("no, {} resets", grouped(n)),
    };
    [
        t.integrator.name().into(),
        stable,
        percent(t.played.stretch_mean),
        percent(t.played.stretch_max),
        t.swung.drift.map_or("blew up".into(), |d| format!("{:+.0} %", d * 100.0)),
        format!("{:.1}", t.played.ns),
        t.longest.label(),
        t.points_in_real_time().map_or("none".into(), |n| grouped(two_digits(n) as usize)),
    ]
}

fn print(setting: &Setting, trials: &[Trial]) {
    print_line(format_args!(
        "scene    {}: {} of {} strands simulated, {} points",
        setting.name,
        grouped(setting.simulated_strands),
        grouped(setting.strands),
        grouped(setting.simulated_points)
    ));
    print_line(format_args!(
        "each     {} s of the scene, {} per 1/60 s, {}, {}",
        number(setting.seconds),
        counted(setting.substeps as usize, "substep"),
        counted(rayon::current_num_threads(), "thread"),
        setting.simd
    ));
    let rows: Vec<[String; 8]> =
        std::iter::once(HEADS.map(String::from)).chain(trials.iter().map(row)).collect();
    let widths: [usize; 8] =
        std::array::from_fn(|c| rows.iter().map(|r| r[c].chars().count()).max().unwrap_or(0));
    for row in &rows {
        let cells = row.iter().zip(widths).enumerate().map(|(c, (cell, width))| match c {
            // Numbers are right-aligned.
            2.. => format!("{cell:>width$}"),
            _ => format!("{cell:<width$}"),
        });
        print_line(cells.collect::<Vec<_>>().join("  "));
    }
    print_line(format_args!("{}", limits(setting)));
}

/// Describes the figures, for the help of the command.
pub fn figures() -> String {
    let names = Integrator::ALL.map(Integrator::name).join(", ");
    let (shortest, longest) = (duration(swing::SHORTEST), duration(swing::LONGEST));
    format!(
        "\
Integrators: {names}

The figures of each integrator, as JSON keys of `--methods`:
  stable                    in the scene, no strand became non-finite and no segment reached twice its length
  reset_strands             strands that became non-finite and were reset, summed over all frames
  stretch_mean              mean of |l/L - 1| over segments and frames
  stretch_max               maximum over segments and frames; null if it was not finite
  swing_stretch_max         maximum in the free swing, which has no contact; null if it blew up
  energy_drift              energy gained or lost in the free swing, over the energy that falling can release;
                            null if it blew up
  ns_per_point_substep      wall time x threads / (points x substeps), the median frame of the scene
  longest_stable_step_s     {longest} is the longest tried; null if not even {shortest} is stable
  points_in_real_time       points that one thread simulates in real time at that step; null if there is none"
    )
}

/// Explains the terms of the table.
fn limits(setting: &Setting) -> String {
    format!(
        "Stable: no strand became non-finite and no segment reached twice its length. Energy drift: of a free swing of {} strands in \
         {} s, gravity turned by {TILT}°, over the energy that falling can release. Longest step: the longest at which {} strands, \
         with a shortest segment of {} mm that sound crosses in {}, stay within that bound for {} s and {} steps; between {} and {}.",
        setting.swinging.strand_count(),
        number(setting.seconds),
        setting.stepping.strand_count(),
        number(two_digits(f64::from(setting.stepping.shortest_segment()) * 1e3)),
        duration(setting.stepping.sound_time()),
        number(swing::WATCHED),
        swing::STEPS,
        duration(swing::SHORTEST),
        duration(swing::LONGEST),
    )
}

/// Formats a fraction in percent; ∞ if it is not finite.
fn percent(share: f64) -> String {
    match share {
        s if !s.is_finite() => "∞".into(),
        s if s >= 1e6 => format!("{:.0e} %", s * 100.0),
        s if s >= 10.0 => format!("{} %", grouped((s * 100.0) as usize)),
        s if s >= 0.1 => format!("{:.0} %", s * 100.0),
        s => format!("{:.3} %", s * 100.0),
    }
}

/// Formats a time in a suitable unit.
fn duration(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s < 1e-3 => (s * 1e6, "µs"),
        s => (s * 1e3, "ms"),
    };
    format!("{} {unit}", number(two_digits(value)))
}

/// Rounds to two significant digits, which is the precision that is known.
fn two_digits(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor() - 1.0);
    if x > 0.0 { (x / power).round() * power } else { x }
}
