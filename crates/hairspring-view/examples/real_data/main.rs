//! Plays scene files and prints what came of it, as the table of `docs/real-data.md`; on request, draws them.
//!
//! ```sh
//! cargo run --release -p hairspring-view --example real_data -- examples/scenes/*.toml
//! cargo run --release -p hairspring-view --example real_data -- --pictures DIR --size 640x480 SCENE.toml …
//! cargo run --release -p hairspring-view --example real_data -- --contact examples/scenes/*.toml
//! ```
//!
//! With `--contact` it is the table of `docs/contact.md` instead: what is inside of colliders.
//!
//! Beside scene files it takes two kinds of file that the library does not read: a motion of DeepMimic (`.txt`), done by the body that walks in
//! `straight-walk.toml`, and `face.bin`, the woman whose hair is stroked.
//!
//! A scene plays to the end of its motion, but at most 30 s (2 s without one). Pictures are taken at the start, halfway and at
//! the moment when hair is fastest.

mod deepmimic;
mod woman;

use glam::Vec3;
use hairspring::simulation::Measure;
use hairspring_io::read_scene;
use hairspring_scene::{
    Scene,
    stage::{FrameRate, Stage, StageError},
};
use hairspring_view::{
    Background, Frame, Ground, HairDraw, Lighting, MeshDraw, Quality, Renderer, frame_camera, write_png,
};
use std::{
    error::Error,
    path::{Path, PathBuf},
};

/// Frame rate.
const RATE: FrameRate = FrameRate::new(60, 1).expect("60 Hz is a rate");

/// What the command line asks for.
struct Arguments {
    scenes: Vec<PathBuf>,
    pictures: Option<PathBuf>,
    size: [u32; 2],
    /// Whether what is inside of colliders is asked for, and nothing else.
    contact: bool,
}

/// Head of the table of `docs/contact.md`.
const CONTACT: &str = "\
| scene | substeps | frames | simulated points | points inside | deepest point [mm] | segments inside | segments deeper than 1 mm | frames with such a segment | deepest segment [mm] | the same in the mesh [mm] | held segments deeper than 1 mm | deepest held segment [mm] | ms a frame, strands |
| --- | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: |";

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = arguments()?;
    println!(
        "{} threads; a frame is 1/60 s; depth is below where a point was authored.\n",
        rayon::current_num_threads()
    );
    if arguments.contact {
        println!("{CONTACT}");
        for path in &arguments.scenes {
            let scene = read(path)?;
            let name = label(&scene, path);
            let (played, stage) = play(scene)?;
            println!("| {name} | {} |", played.contact(&stage));
        }
        return Ok(());
    }
    println!(
        "| scene | strands | points | simulated strands | time played [s] | ms a frame | of it body, strands, follow hairs | worst stretch [%] | points inside | worst depth [mm] | non-finite | moved in 1 s at rest, mean [mm] |"
    );
    println!("| --- | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: |");
    for path in &arguments.scenes {
        let scene = read(path)?;
        let name = label(&scene, path);
        let (played, mut stage) = play(scene.clone())?;
        println!("| {name} | {} | {:.4} |", played.row(&stage), at_rest(scene)? * 1e3);
        if let Some(folder) = &arguments.pictures {
            let times = [("start", 0.0), ("middle", 0.5 * played.duration), ("fastest", played.fastest)];
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            for (moment, time) in times {
                draw(&mut stage, time, arguments.size, &folder.join(format!("{stem}-{moment}.png")))?;
            }
        }
    }
    Ok(())
}

fn arguments() -> Result<Arguments, String> {
    let mut out = Arguments { scenes: Vec::new(), pictures: None, size: [960, 720], contact: false };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--pictures" => out.pictures = Some(words.next().ok_or("--pictures needs a folder")?.into()),
            "--contact" => out.contact = true,
            "--size" => {
                let size = words.next().unwrap_or_default();
                let sides = size.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
                out.size = sides.ok_or(format!("--size is {size:?}; a size such as 640x480 was expected"))?;
            }
            scene => out.scenes.push(scene.into()),
        }
    }
    if out.scenes.is_empty() { Err("name one scene file or more".into()) } else { Ok(out) }
}

/// The scene that a file describes, or stands for.
fn read(path: &Path) -> Result<Scene, Box<dyn Error>> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("txt") => deepmimic::scene(path),
        Some("bin") => woman::scene(path),
        _ => Ok(read_scene(path)?.value),
    }
}

/// What was seen while a scene played.
#[derive(Default)]
struct Played {
    /// Body, simulated strands, follow hairs: time of each frame [ms].
    frames: Vec<[f64; 3]>,
    duration: f64,
    /// The worst of all frames.
    worst: Measure,
    /// When hair was fastest [s].
    fastest: f64,
    /// Frames in which a segment was deeper than 1 mm.
    deep_frames: usize,
}

impl Played {
    /// Of the frames' times [ms].
    fn median(&self, of: impl Fn(&[f64; 3]) -> f64) -> f64 {
        let mut all: Vec<f64> = self.frames.iter().map(of).collect();
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    }

    /// Cells of the table of `docs/contact.md`, but the first.
    fn contact(&self, stage: &Stage) -> String {
        let Measure {
            inside_points,
            max_depth,
            inside_segments,
            deep_segments,
            segment_depth,
            surface_depth,
            held_segments,
            held_depth,
            ..
        } = self.worst;
        format!(
            "{} | {} | {} | {inside_points} | {:.3} | {inside_segments} | {deep_segments} | {} | {:.3} | {:.3} | {held_segments} | {:.3} | {:.1}",
            stage.scene().solver.substeps,
            self.frames.len(),
            stage.simulated_points().0,
            max_depth * 1e3,
            self.deep_frames,
            segment_depth * 1e3,
            surface_depth * 1e3,
            held_depth * 1e3,
            self.median(|f| f[1]),
        )
    }

    /// Cells of the table, from the strands to the depth.
    fn row(&self, stage: &Stage) -> String {
        let ((simulated, strands), (_, points)) = (stage.simulated_strands(), stage.simulated_points());
        let parts = [0, 1, 2].map(|k| format!("{:.1}", self.median(|f| f[k])));
        format!(
            "{strands} | {points} | {simulated} | {:.1} | {:.1} | {} | {:.2} | {} | {:.3} | {}",
            self.duration,
            self.median(|f| f.iter().sum()),
            parts.join(", "),
            self.worst.stretch_max * 100.0,
            self.worst.inside_points,
            self.worst.max_depth * 1e3,
            self.worst.non_finite,
        )
    }
}

fn play(scene: Scene) -> Result<(Played, Stage), StageError> {
    let duration = scene.clip.as_ref().map_or(2.0, |c| c.duration().clamp(1.0, 30.0));
    let mut stage = Stage::new(scene)?;
    let mut played = Played { duration, ..Played::default() };
    while stage.time() < duration {
        let report = stage.step_frame(RATE);
        let measure = stage.measure();
        if measure.speed_max > played.worst.speed_max {
            played.fastest = stage.time();
        }
        played.deep_frames += usize::from(measure.deep_segments > 0);
        let worst = &mut played.worst;
        worst.stretch_mean = worst.stretch_mean.max(measure.stretch_mean);
        worst.stretch_max = worst.stretch_max.max(measure.stretch_max);
        let came_inside = measure.inside_points - measure.started_inside_points;
        worst.inside_points = worst.inside_points.max(came_inside);
        worst.max_depth = worst.max_depth.max(measure.max_depth);
        worst.inside_segments = worst.inside_segments.max(measure.inside_segments);
        worst.deep_segments = worst.deep_segments.max(measure.deep_segments);
        worst.surface_depth = worst.surface_depth.max(measure.surface_depth);
        worst.segment_depth = worst.segment_depth.max(measure.segment_depth);
        worst.held_segments = worst.held_segments.max(measure.held_segments);
        worst.held_depth = worst.held_depth.max(measure.held_depth);
        worst.non_finite += measure.non_finite + report.step.reset_strands;
        worst.speed_max = worst.speed_max.max(measure.speed_max);
        let times = [report.body, report.simulate, report.follow];
        played.frames.push(times.map(|t| t.as_secs_f64() * 1e3));
    }
    Ok((played, stage))
}

/// The first cell of a row: the name of the scene and that of its file.
fn label(scene: &Scene, path: &Path) -> String {
    format!("{} (`{}`)", scene.name, path.file_stem().unwrap_or_default().to_string_lossy())
}

/// How far the mean point moves from where it was authored in a second in which nothing moves [m].
fn at_rest(scene: Scene) -> Result<f64, StageError> {
    let still = Scene { clip: None, wind: Default::default(), ..scene };
    let mut stage = Stage::new(still)?;
    for _ in 0..60 {
        stage.step_frame(RATE);
    }
    let (mut sum, mut count) = (0.0, 0);
    for strands in stage.strands() {
        let moved = strands.points.iter().zip(&strands.groom.points);
        sum += moved.map(|(a, b)| a.distance(*b) as f64).sum::<f64>();
        count += strands.points.len();
    }
    Ok(sum / count as f64)
}

/// Plays up to `time` [s] and draws.
fn draw(stage: &mut Stage, time: f64, size: [u32; 2], path: &Path) -> Result<(), Box<dyn Error>> {
    if time < stage.time() {
        stage.reset();
    }
    while stage.time() + 0.5 * RATE.frame_length() < time {
        stage.step_frame(RATE);
    }
    let hair: Vec<HairDraw> = stage.strands().map(HairDraw::of).collect();
    let bodies: Vec<MeshDraw> = stage.body().map(MeshDraw::of).into_iter().collect();
    let all = hair.iter().flat_map(|h| h.points).chain(bodies.iter().flat_map(|b| b.positions));
    let bounds = all.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
    let aspect = size[0] as f32 / size[1] as f32;
    let camera = stage.scene().camera.unwrap_or_else(|| frame_camera(bounds, aspect));
    let frame = Frame {
        hair: &hair,
        bodies: &bodies,
        camera,
        lighting: Lighting::facing(&camera),
        background: Background::default(),
        ground: Ground::of(stage.scene()),
        quality: Quality::default(),
    };
    let image = Renderer::new(size[0], size[1]).draw(&frame).clone();
    write_png(path, &image)?;
    Ok(())
}
