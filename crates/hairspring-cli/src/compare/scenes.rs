//! Two scenes side by side: a clip or a contact sheet, and a table of their differences.

mod figures;

use super::Options;
use crate::{
    console::{Console, print_json, print_line},
    fault::Fault,
    frames::FrameRange,
    input::{self, print_notes},
    output,
    picture::{Setup, Studio, View},
    play::set_up,
    render::clip,
    totals::grouped,
};
use figures::{Distances, Figures};
use hairspring_app::{Difference, SideBySide, captions_of, scene_differences, set_in_text};
use hairspring_io::{Format, Inputs, read_scene_text, read_settings, scene_text};
use hairspring_scene::{
    Scene,
    stage::{FrameRate, Stage},
};
use hairspring_view::{ClipWriter, Image, write_jpeg, write_png};
use serde_json::json;
use std::path::{Path, PathBuf};

/// The figures, for the help of the command.
pub const FIGURES: &str = "\
The figures of a comparison of two scenes, as JSON keys:
  a, b                      the figures of each side:
    file, scene             the file and the name of its scene
    strands, points         all hairs; simulated_strands, simulated_points: those that are simulated
    substeps                substeps of the last frame
    reset_strands           strands that became non-finite and were reset, summed over all frames
    stretch_mean            mean of |l/L - 1| over segments and frames; stretch_max: the maximum
    speed_max_m_s           speed of the fastest point
    max_depth_m             depth of the deepest point in a collider; segment_depth_m: of the deepest segment
    energy_start_j          total energy of the simulated strands at the start; energy_end_j: at the end
    kinetic_energy_mean_j   mean kinetic energy over the frames
    ms_per_frame            median time to simulate a frame; null for a single frame
  settings                  settings that differ: key, a, b; null where a side has none
  files                     files of the same name whose content differs
  distance                  distance of points of the same number; null if the strands differ:
                            mean_m, max_m, max_frame, max_strand, end_mean_m, end_max_m
  frames, fps, threads, simd, output";

/// Longest comparison [s].
const LONGEST: f32 = 600.0;

/// Number of moments on a contact sheet, evenly spaced, the last one at the end.
const MOMENTS: u32 = 4;

/// Default size of the two pictures together [pixels].
const SIZE: (u32, u32) = (1280, 720);

/// Default contact sheet.
const SHEET: &str = "compare.png";

/// Number of settings that the table lists.
const LISTED: usize = 40;

/// One side of the comparison.
struct Side {
    path: PathBuf,
    text: String,
    /// The settings, without geometry.
    settings: Scene,
    scene: Scene,
    /// The files that the scene names.
    files: Inputs,
    notes: Vec<String>,
}

/// Runs the command.
pub fn run(options: &Options, console: Console) -> Result<(), Fault> {
    let Some(path) = &options.a else { return Err(Fault::Usage("name a scene to compare".into())) };
    if options.b.is_none() && options.set_a.is_empty() && options.set_b.is_empty() {
        let text = "there is nothing to compare with; name a second scene, or settings with --set-a or --set-b \
                    (integrators are compared with --methods)";
        return Err(Fault::Usage(text.into()));
    }
    if options.seconds.is_some_and(|s| s > LONGEST) {
        return Err(Fault::Usage(format!("--seconds is at most {LONGEST}")));
    }
    let fps = match options.fps {
        Some(fps) => fps,
        None => FrameRate::of_output("30").map_err(Fault::Usage)?,
    };
    let mut picture = match options.no_picture {
        true => None,
        false => Some(Picture::new(options, fps, console)?),
    };
    let a = side(path, "--set-a", &options.set_a, options)?;
    let b = side(options.b.as_ref().unwrap_or(path), "--set-b", &options.set_b, options)?;
    if let Some(picture) = &picture {
        for side in [&a, &b] {
            output::check_outputs(&side.files, &side.path, [picture.path.clone()])?;
        }
    }
    print_notes(&a.notes, console);
    if b.notes != a.notes {
        print_notes(&b.notes, console);
    }
    let settings = scene_differences([&a.settings, &b.settings], [&a.text, &b.text])
        .map_err(|why| Fault::Content(why.to_string()))?;
    let files = a.files.changed(&b.files);
    let whole = |scene: &Scene| FrameRange::whole(scene.motion_duration(), fps).last;
    let frames = match options.seconds {
        Some(seconds) => ((f64::from(seconds) * fps.hertz()).round() as u32 + 1).max(2),
        None => whole(&a.scene).max(whole(&b.scene)),
    };
    if picture.is_some() && options.camera.is_none() && a.scene.camera != b.scene.camera {
        console.note("both pictures are drawn with the camera of A");
    }
    let paths = [a.path, b.path];
    let mut stages = [set_up(a.scene, console)?, set_up(b.scene, console)?];
    if let Some(picture) = &mut picture {
        picture.begin(&mut stages, captions_of(&settings), &paths)?;
    }
    let mut distances = Distances::are_defined(&stages[0], &stages[1]).then(Distances::default);
    let mut figures = [Figures::default(), Figures::default()];
    let mut progress = console.progress("comparing", frames);
    for frame in 1..=frames {
        // The sides take turns at being first, so that neither always finds the warmer caches.
        for k in if frame % 2 == 0 { [0, 1] } else { [1, 0] } {
            let report = (frame > 1).then(|| stages[k].step_frame(fps));
            figures[k].add(&stages[k], report.as_ref());
        }
        let [a, b] = &stages;
        if let Some(distances) = &mut distances {
            distances.add(frame, a, b);
        }
        if let Some(picture) = &mut picture {
            picture.frame(frame, frames, &stages)?;
        }
        progress.step(|| match &distances {
            Some(d) => format!("frame {frame}: {} apart", millimeters(d.end[0])),
            None => format!("frame {frame}"),
        });
    }
    drop(progress);
    let written = picture.map(Picture::finish).transpose()?;
    if options.json {
        let listed: Vec<_> =
            settings.iter().map(|d| json!({ "key": d.key, "a": d.values[0], "b": d.values[1] })).collect();
        print_json(&json!({
            "a": figures[0].json(&paths[0], &stages[0]),
            "b": figures[1].json(&paths[1], &stages[1]),
            "settings": listed,
            "files": files,
            "distance": distances.as_ref().map(Distances::json),
            "frames": frames,
            "fps": fps.hertz(),
            "threads": rayon::current_num_threads(),
            "simd": stages[0].instruction_set(),
            "output": written,
        }));
        return Ok(());
    }
    print(&paths, &stages, &settings, &files, &figures);
    print_distances(distances.as_ref(), &stages);
    print_line(format_args!("played   {} at {fps} per second", crate::totals::frames(frames as usize)));
    if let Some(path) = written {
        print_line(format_args!("wrote    {}", path.display()));
    }
    Ok(())
}

/// Reads a scene and changes its settings. `flag` is the option that `sets` come from.
fn side(path: &Path, flag: &str, sets: &[String], options: &Options) -> Result<Side, Fault> {
    let reading = |e| Fault::reading(e, path);
    let mut text = match Format::of(path) {
        Some(Format::Scene) => {
            options.units.refuse_for_scene()?;
            scene_text(path).map_err(reading)?
        }
        Some(format) if Format::GROOMS.contains(&format) => groom_alone(path, options)?,
        _ => return Err(input::unknown_extension(path)),
    };
    let mut settings = read_settings(path, &text).map_err(reading)?;
    let all = options.set.iter().map(|set| ("--set", set)).chain(sets.iter().map(|set| (flag, set)));
    for (flag, set) in all {
        let wrong = |why: String| Fault::Usage(format!("{flag} {set}: {why}"));
        let Some((key, value)) = set.split_once('=') else {
            return Err(wrong("expected KEY=VALUE, such as solver.substeps=8".into()));
        };
        text = set_in_text(&text, key.trim(), value.trim()).map_err(|why| wrong(why.to_string()))?;
        settings = read_settings(path, &text).map_err(|why| wrong(why.to_string()))?;
    }
    let (loaded, files) = Inputs::record(path, || read_scene_text(path, &text));
    let loaded = loaded.map_err(reading)?;
    Ok(Side { path: path.to_owned(), text, settings, scene: loaded.value, files, notes: loaded.notes })
}

/// The text of a scene that holds only a groom.
fn groom_alone(path: &Path, options: &Options) -> Result<String, Fault> {
    if !path.exists() {
        return Err(Fault::Unreadable(format!("{} was not found", path.display())));
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let set = |text: &str, key: &str, value: &str| {
        set_in_text(text, key, value).map_err(|why| Fault::Usage(why.to_string()))
    };
    // Quoted as TOML, so that the name cannot be read as another value.
    let mut text = set("[[groom]]\n", "groom[0].file", &json!(name).to_string())?;
    if let Some(scale) = options.units.scale {
        text = set(&text, "groom[0].scale", &format!("{scale:?}"))?;
    }
    if let Some(up) = options.units.up {
        text = set(&text, "groom[0].up", if up == input::Up::Y { "y" } else { "z" })?;
    }
    if options.units.reverse {
        text = set(&text, "groom[0].reverse", "true")?;
    }
    Ok(text)
}

/// A clip or a contact sheet of both sides.
struct Picture {
    path: PathBuf,
    size: [u32; 2],
    view: View,
    /// `None` for a contact sheet.
    clip: Option<Box<ClipWriter>>,
    /// The current pair, or the contact sheet.
    image: Image,
    /// Pairs on the contact sheet.
    rows: u32,
    studios: Vec<Studio>,
    captions: [String; 2],
    side_by_side: SideBySide,
}

impl Picture {
    fn new(options: &Options, fps: FrameRate, console: Console) -> Result<Self, Fault> {
        let path = options.output.clone().unwrap_or(SHEET.into());
        let (width, height) = options.size.unwrap_or(SIZE);
        let [least_width, least_height] = SideBySide::SMALLEST;
        if width < least_width || height < least_height {
            return Err(Fault::Usage(format!("--size is at least {least_width}x{least_height}")));
        }
        let is_clip = match output::extension(&path).as_str() {
            "mp4" => true,
            "png" | "jpg" => false,
            _ => {
                let text = "unknown output; a clip is written as clip.mp4, a contact sheet as sheet.png or sheet.jpg";
                return Err(Fault::Usage(format!("{}: {text}", path.display())));
            }
        };
        output::check_single(&path)?;
        output::try_folder(&path)?;
        let rows = if is_clip { 1 } else { MOMENTS };
        let [half_width, half_height] = SideBySide::half([width, height]);
        Ok(Self {
            clip: if is_clip { Some(clip(&path, (width, height), fps.hertz(), console)?) } else { None },
            path,
            size: [width, height],
            view: View {
                size: (half_width, half_height),
                camera: options.camera,
                target: options.target,
                gpu: options.gpu,
                ..View::default()
            },
            image: Image::new(width, height * rows),
            rows: 0,
            studios: Vec::new(),
            captions: [String::new(), String::new()],
            side_by_side: SideBySide::default(),
        })
    }

    /// Places the camera. It is that of the first stage for both, so that only the hair differs.
    fn begin(
        &mut self,
        stages: &mut [Stage; 2],
        captions: [String; 2],
        paths: &[PathBuf; 2],
    ) -> Result<(), Fault> {
        for stage in stages {
            let mut studio = Studio::new(&self.view, stage, Setup::PLAIN)?;
            if let Some(first) = self.studios.first() {
                studio.look_like(first);
            }
            self.studios.push(studio);
        }
        let name = |k: usize| paths[k].file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.captions = std::array::from_fn(|k| {
            let file = if paths[0] == paths[1] { String::new() } else { format!("{}  ", name(k)) };
            format!("{}  {file}{}", ["A", "B"][k], captions[k])
        });
        Ok(())
    }

    /// Draws frame `frame` of `frames`, if it is shown.
    fn frame(&mut self, frame: u32, frames: u32, stages: &[Stage; 2]) -> Result<(), Fault> {
        let moment = |f: u32| u64::from(f) * u64::from(MOMENTS) / u64::from(frames);
        if self.clip.is_none() && moment(frame) == moment(frame - 1) {
            self.studios.iter_mut().zip(stages).for_each(|(studio, stage)| studio.pass(stage));
            return Ok(());
        }
        let mut halves = Vec::with_capacity(2);
        for (studio, stage) in self.studios.iter_mut().zip(stages) {
            halves.push(studio.draw(stage)?.0.image().into_owned());
        }
        let [a, b] = &halves[..] else { return Ok(()) };
        let captions = self.captions.each_ref().map(|caption| match self.clip {
            Some(_) => caption.clone(),
            None => format!("{:.2} s  {caption}", stages[0].time()),
        });
        // Several moments of a very short comparison can be the same frame.
        let top = self.rows.min(MOMENTS - 1) * self.size[1];
        self.side_by_side.draw(&mut self.image, top, self.size, [a, b], &captions);
        match &mut self.clip {
            Some(clip) => clip.push(&self.image)?,
            None => self.rows += 1,
        }
        Ok(())
    }

    /// Completes the file; returns its path.
    fn finish(mut self) -> Result<PathBuf, Fault> {
        match self.clip {
            Some(clip) => clip.finish()?,
            None => {
                self.image.height = self.rows * self.size[1];
                self.image.rgb.truncate(3 * (self.image.width * self.image.height) as usize);
                match output::extension(&self.path).as_str() {
                    "jpg" => write_jpeg(&self.path, &self.image)?,
                    _ => write_png(&self.path, &self.image)?,
                }
            }
        }
        Ok(self.path)
    }
}

fn print(
    paths: &[PathBuf; 2],
    stages: &[Stage; 2],
    settings: &[Difference],
    files: &[String],
    figures: &[Figures; 2],
) {
    for (k, stage) in stages.iter().enumerate() {
        let (guides, strands) = stage.simulated_strands();
        print_line(format_args!(
            "{}        {}: {} of {} hairs simulated",
            ["A", "B"][k],
            paths[k].display(),
            grouped(guides),
            grouped(strands)
        ));
    }
    let mut rows = vec![["setting".to_owned(), "A".into(), "B".into()]];
    rows.extend(settings.iter().take(LISTED).map(|d| {
        let [a, b] = d.written();
        [d.key.clone(), a, b]
    }));
    match settings.len() {
        0 => print_line("settings the same"),
        n => {
            table(&rows);
            if n > LISTED {
                print_line(format_args!("and {} more settings; --json lists all", n - LISTED));
            }
        }
    }
    if !files.is_empty() {
        print_line(format_args!("files    with another content: {}", files.join(", ")));
    }
    let mut rows = vec![["figure".to_owned(), "A".into(), "B".into()]];
    let mut row = |name: &str, figure: &dyn Fn(&Figures) -> String| {
        rows.push([name.into(), figure(&figures[0]), figure(&figures[1])]);
    };
    row("speed, fastest point", &|f| format!("{:.3} m/s", f.speed_max));
    row("stretch, mean", &|f| format!("{:.4} %", f.stretch_mean() * 100.0));
    row("stretch, maximum", &|f| format!("{:.4} %", f.stretch_max * 100.0));
    row("depth of points, maximum", &|f| millimeters(f.max_depth));
    row("depth of segments, maximum", &|f| millimeters(f.segment_depth));
    row("energy at the start", &|f| microjoules(f.energy[0]));
    row("energy at the end", &|f| microjoules(f.energy[1]));
    row("kinetic energy, mean", &|f| microjoules(f.kinetic_mean()));
    row("substeps per frame", &|f| f.substeps.to_string());
    row("strands reset", &|f| grouped(f.reset_strands));
    row("simulation per frame, median", &|f| {
        f.ms_per_frame().map_or("none".into(), |t| format!("{t:.2} ms"))
    });
    table(&rows);
}

fn print_distances(distances: Option<&Distances>, stages: &[Stage; 2]) {
    let Some(d) = distances else {
        let [a, b] = stages.each_ref().map(|s| (s.simulated_strands().1, s.simulated_points().1));
        print_line(format_args!(
            "distance not measured: the strands differ ({} hairs of {} points, and {} of {})",
            grouped(a.0),
            grouped(a.1),
            grouped(b.0),
            grouped(b.1)
        ));
        return;
    };
    print_line(format_args!(
        "distance {} mean, {} maximum (strand {} in frame {}); at the end {} mean, {} maximum",
        millimeters(d.mean()),
        millimeters(d.max),
        d.max_at.1,
        d.max_at.0,
        millimeters(d.end[0]),
        millimeters(d.end[1])
    ));
}

/// Prints aligned columns; values are right-aligned.
fn table(rows: &[[String; 3]]) {
    let width = |c: usize| rows.iter().map(|r| r[c].chars().count()).max().unwrap_or(0);
    let widths = [width(0), width(1), width(2)];
    for [name, a, b] in rows {
        print_line(format_args!(
            "{name:<w0$}  {a:>w1$}  {b:>w2$}",
            w0 = widths[0],
            w1 = widths[1],
            w2 = widths[2]
        ));
    }
}

fn millimeters(meters: f64) -> String {
    format!("{:.3} mm", meters * 1e3)
}

fn microjoules(joules: f64) -> String {
    format!("{:.3} µJ", joules * 1e6)
}
