//! `hairspring bench --table`: every elastic model on every instruction set, side by side.
//!
//! Each cell has its own copy of the scene, and all of them step the same frames. They take turns of a few
//! frames, so that other load on the machine affects all of them alike. Only the step is timed, contact
//! included, as in a bench without the table.

use super::{Options, Times, print_scene};
use crate::{
    console::{Console, print_json, print_line},
    fault::Fault,
    totals::counted,
};
use hairspring::{material::Model, settings::Integrator, simulation::Simulation};
use serde_json::{Value, json};
use std::time::Instant;

/// The elastic models of a strand; `auto` selects one of them.
const MODELS: [Model; 3] = [Model::Curvature, Model::Rod, Model::Springs];

/// Number of frames that a cell steps in its turn. The first frame of a turn finds the caches filled by
/// another cell's hair; the median is not affected by it.
const TURN: u32 = 5;

/// Name of the row for the library built without SIMD.
#[cfg(feature = "scalar")]
const SCALAR: &str = "scalar";

/// Instruction sets that the compiler may use in the whole program. A scalar row has no others; the other
/// rows add their instruction set at run time.
const COMPILED_FOR: &[(&str, bool)] = &[
    ("sse2", cfg!(target_feature = "sse2")),
    ("sse4.2", cfg!(target_feature = "sse4.2")),
    ("avx", cfg!(target_feature = "avx")),
    ("avx2", cfg!(target_feature = "avx2")),
    ("fma", cfg!(target_feature = "fma")),
    ("avx512f", cfg!(target_feature = "avx512f")),
    ("neon", cfg!(target_feature = "neon")),
];

/// One cell of the table.
pub(super) struct Cell {
    model: Model,
    simd: String,
}

/// The cells of the table: a row of models for each instruction set, best first. With the feature `scalar`,
/// the last row has none.
pub(super) fn cells() -> Vec<Cell> {
    let row = |simd: String| MODELS.map(|model| Cell { model, simd: simd.clone() });
    let sets = Simulation::instruction_sets().into_iter();
    #[cfg(feature = "scalar")]
    let sets = sets.chain([SCALAR.into()]);
    sets.flat_map(row).collect()
}

/// Measures and prints the table.
pub(super) fn run(options: &Options, console: Console) -> Result<(), Fault> {
    let cells = cells();
    let mut steppers: Vec<_> = cells.iter().map(|cell| stepper(options, cell)).collect();
    let mut times: Vec<Times> =
        cells.iter().map(|_| Times(Vec::with_capacity(options.frames as usize))).collect();
    let mut progress = console.progress_in("simulating", options.frames, "frames of each");
    for first in (1..=options.frames).step_by(TURN as usize) {
        let turn = TURN.min(options.frames + 1 - first);
        for (step, times) in steppers.iter_mut().zip(&mut times) {
            for _ in 0..turn {
                let began = Instant::now();
                step();
                times.0.push(began.elapsed().as_secs_f64());
            }
        }
        for frame in first..first + turn {
            progress.step(|| {
                let took: Vec<String> = cells
                    .iter()
                    .zip(&times)
                    .map(|(cell, times)| {
                        let ms = times.0[frame as usize - 1] * 1e3;
                        format!("{} {} {ms:.2}", cell.simd, cell.model.name())
                    })
                    .collect();
                format!("frame {frame}: {} ms", took.join(", "))
            });
        }
    }
    drop(progress);
    if options.json {
        let last = &times[times.len() - MODELS.len()..];
        let last = last.iter().map(|times| times.per_point(options)).cycle();
        let each = cells.iter().zip(&times).zip(last);
        let over = baseline(&cells);
        print_json(&Value::from_iter(
            each.map(|((cell, times), last)| object(options, cell, times, (over, last))),
        ));
    } else {
        let figures: Vec<f64> = times.iter().map(|times| times.per_point(options)).collect();
        print(options, &cells, &figures);
    }
    Ok(())
}

/// Name of the last row, which the others are compared with.
fn baseline(cells: &[Cell]) -> &str {
    cells.last().map_or("", |cell| &cell.simd)
}

/// Names of the instruction sets that the whole program is compiled for.
fn compiled_for() -> Vec<&'static str> {
    COMPILED_FOR.iter().filter(|(_, there)| *there).map(|(name, _)| *name).collect()
}

/// The bench scene, for either build of the library.
macro_rules! bench {
    ($library:ident, $scene:ident, $options:ident, $cell:ident) => {{
        use $library::{
            material::{Material, Model},
            settings::Solver,
        };
        use $scene::bench::Bench;
        let model =
            Model::ALL.into_iter().find(|model| model.name() == $cell.model.name()).unwrap_or_default();
        let material = Material { model, ..Material::default() };
        let solver = Solver { substeps: $options.substeps, ..Solver::default() };
        Bench::with_material($options.strands, $options.points, material, solver)
    }};
}

/// Returns a function that steps the hair of a cell by one frame.
fn stepper(options: &Options, cell: &Cell) -> Box<dyn FnMut()> {
    #[cfg(feature = "scalar")]
    if cell.simd == SCALAR {
        let mut bench = bench!(hairspring_scalar, hairspring_scalar, options, cell);
        return Box::new(move || _ = bench.step());
    }
    let mut bench = bench!(hairspring, hairspring_validate, options, cell);
    bench.simulation.use_instruction_set(&cell.simd);
    Box::new(move || _ = bench.step())
}

/// A cell as JSON, with the keys of a bench without `--table` and those that only a table has. `over` is the
/// row that speedups refer to, and `last` is the figure of the same model there.
fn object(options: &Options, cell: &Cell, times: &Times, (over, last): (&str, f64)) -> Value {
    json!({
        "model": cell.model.name(),
        "simd": cell.simd,
        "device": options.device,
        "threads": rayon::current_num_threads(),
        "strands": options.strands,
        "points": options.points,
        "substeps": options.substeps,
        "frames": options.frames,
        "integrator": Integrator::default().name(),
        "ms_per_frame_median": times.rank(0.5),
        "ms_per_frame_p95": times.rank(0.95),
        "ns_per_point_substep": times.per_point(options),
        "speedup": last / times.per_point(options),
        "speedup_over": over,
        "frames_in_turn": TURN,
        "compiled_for": compiled_for(),
    })
}

/// Prints the table: each figure, and its speedup over the last row of its column.
fn print(options: &Options, cells: &[Cell], figures: &[f64]) {
    print_scene(options);
    print_line(format_args!(
        "on       {}, {}, {}, {}, {} of 1/60 s of each, {TURN} in turn",
        options.device,
        counted(rayon::current_num_threads(), "thread"),
        Integrator::default().name(),
        counted(options.substeps as usize, "substep"),
        counted(options.frames as usize, "frame")
    ));
    print_line(format_args!(
        "figures  ns per point and substep, per core (wall time x threads), medians of the {} frames; in brackets the speedup over {}",
        options.frames,
        baseline(cells)
    ));
    print_line(
        "         a step includes everything, contact too; reading positions and measuring are not included",
    );
    if cfg!(feature = "scalar") {
        print_line(format_args!(
            "scalar   the same code without SIMD, compiled like the whole program for: {}",
            compiled_for().join(", ")
        ));
    } else {
        print_line("scalar   left out; build with --features scalar to measure the code without SIMD too");
    }
    let line = |name: &str, cells: [String; MODELS.len()]| {
        let cells: String = cells.iter().map(|cell| format!("{cell:>18}")).collect();
        print_line(format_args!("{name:<9}{cells}"));
    };
    line("", MODELS.map(|model| model.name().to_owned()));
    let last = &figures[figures.len() - MODELS.len()..];
    for (row, cell) in figures.chunks(MODELS.len()).zip(cells.iter().step_by(MODELS.len())) {
        let text = |k: usize| format!("{:.2} ({:.1} x)", row[k], last[k] / row[k]);
        line(&cell.simd, std::array::from_fn(text));
    }
}
