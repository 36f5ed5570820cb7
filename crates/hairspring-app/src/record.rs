//! Records the view: stills, pictures, clips and turntables, with both sides of a comparison. Every frame is
//! drawn in full quality. The simulation waits for the recording.

use crate::{
    AppError,
    destination::{check_single, destination},
    orbit::Orbit,
    player,
    session::{Action, Session},
    side_by_side::SideBySide,
    snapshot::{Snapshot, StageSnapshot, ViewParameters},
    text::counted,
};
use hairspring_scene::stage::FrameRate;
use hairspring_view::{
    ClipWriter, Image, Renderer,
    gpu::{Gpu, GpuRenderer},
    sequence_path, write_jpeg, write_png,
};
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        mpsc::{Receiver, Sender, channel},
    },
};

/// Maximum number of frames of a recording.
const MOST_FRAMES: u32 = 100_000;

/// Size and rate of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordFormat {
    /// Width and height [pixels].
    pub size: [u32; 2],
    /// Frames per second.
    pub rate: FrameRate,
}

impl Default for RecordFormat {
    fn default() -> Self {
        Self { size: [1280, 720], rate: FrameRate::new(30, 1).expect("30 Hz is a rate") }
    }
}

impl RecordFormat {
    /// Smallest and largest width and height [pixels].
    pub const SIDES: std::ops::RangeInclusive<u32> = 64..=8192;

    /// Steps of a frame, none longer than those of the window, and the rate of the steps.
    fn steps(self) -> (u32, FrameRate) {
        let steps = (player::RATE.hertz() / self.rate.hertz()).ceil().max(1.0) as u32;
        (steps, self.rate.times(steps))
    }
}

/// Kind of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The current moment, as a picture.
    Still,
    /// One picture per frame.
    Pictures,
    /// A clip of the playing scene.
    Clip,
    /// A clip of one turn around the current moment.
    Turntable,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Still, Self::Clip, Self::Pictures, Self::Turntable];

    /// Title of the dialog.
    pub fn title(self) -> &'static str {
        match self {
            Self::Still => "Still",
            Self::Pictures => "Pictures, one a frame",
            Self::Clip => "Clip of the play",
            Self::Turntable => "Turntable",
        }
    }

    /// Suggested file name.
    pub fn file(self) -> &'static str {
        match self {
            Self::Still => "hair.png",
            Self::Pictures => "hair.####.png",
            Self::Clip => "hair.mp4",
            Self::Turntable => "turntable.mp4",
        }
    }
}

/// A request for a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordRequest {
    /// Kind of the recording.
    pub kind: Kind,
    /// Path of the file: `.png` or `.jpg` for a still, `.png` with `#` for pictures, otherwise `.mp4`.
    pub path: PathBuf,
    /// Duration [s]; not used for a still.
    pub seconds: f32,
    /// Size and rate.
    pub format: RecordFormat,
}

impl RecordRequest {
    /// Number of frames.
    ///
    /// # Errors
    /// Returns an error for a length of less than a frame, or of more than [`MOST_FRAMES`].
    fn frames(&self) -> Result<u32, AppError> {
        if self.kind == Kind::Still {
            return Ok(1);
        }
        let hertz = self.format.rate.hertz();
        let frames = (f64::from(self.seconds) * hertz).round();
        if (1.0..=f64::from(MOST_FRAMES)).contains(&frames) {
            return Ok(frames as u32);
        }
        let rounded = |seconds: f64| (seconds * 1e3).ceil() / 1e3;
        Err(AppError::new(format!(
            "a recording of {} s cannot be made; its length is {} to {} s, which are 1 to {MOST_FRAMES} frames",
            self.seconds,
            rounded(1.0 / hertz),
            rounded(f64::from(MOST_FRAMES) / hertz)
        )))
    }

    /// The files that it writes.
    fn files(&self, frames: u32) -> impl Iterator<Item = PathBuf> {
        let numbered = |number| sequence_path(&self.path, number).filter(|_| self.kind == Kind::Pictures);
        (1..=frames).map_while(numbered).chain([self.path.clone()])
    }
}

/// A frame of a recording.
struct Shot {
    snapshot: Arc<Snapshot>,
    /// View parameters of each stage.
    views: Vec<ViewParameters>,
    /// Captions of two compared pictures.
    captions: [String; 2],
    /// Frame number, from 1.
    number: u32,
}

enum Job {
    Frame(Shot),
    Finish,
}

/// A recording in progress.
pub struct Recorder {
    request: RecordRequest,
    frames: u32,
    /// Frames that were sent to the writer.
    sent: u32,
    /// Frames that were written.
    written: u32,
    /// The step that the recording waits for.
    due: u64,
    /// Whether the scene was playing before.
    played: bool,
    jobs: Option<Sender<Job>>,
    done: Receiver<Result<(), AppError>>,
}

impl Recorder {
    /// Starts a recording. The scene is paused and advances with the recording. The frames are drawn by
    /// `gpu`, or by the CPU if it is `None`.
    pub fn new(
        mut request: RecordRequest,
        session: &mut Session,
        snapshot: &Snapshot,
        gpu: Option<Gpu>,
        wake: impl Fn() + Send + 'static,
    ) -> Result<Self, AppError> {
        request.path = destination(&request.path)?;
        let frames = request.frames()?;
        session.keep_files(request.files(frames))?;
        let sink = Sink::new(&request, gpu)?;
        let played = session.playing();
        session.act(Action::Play(false))?;
        let (jobs, todo) = channel();
        let (results, done) = channel();
        std::thread::spawn(move || {
            sink.run(&todo, |outcome| {
                let sent = results.send(outcome).is_ok();
                wake();
                sent
            });
        });
        Ok(Self { frames, sent: 0, written: 0, due: snapshot.step, played, jobs: Some(jobs), done, request })
    }

    /// Advances as far as possible. Returns `Some` with a message when the recording has ended.
    pub fn advance(
        &mut self,
        session: &mut Session,
        snapshot: &Arc<Snapshot>,
        mut views: Vec<ViewParameters>,
    ) -> Option<Result<String, AppError>> {
        while let Ok(outcome) = self.done.try_recv() {
            if let Err(why) = outcome {
                return Some(self.end(session, Err(why)));
            }
            self.written += 1;
        }
        // The writer reports one more frame than was sent when the file is complete.
        if self.written > self.frames {
            let path = self.request.path.display();
            let message = match self.request.kind {
                Kind::Still => format!("wrote {path}"),
                _ => format!("wrote {path}: {}", counted(self.frames.into(), "frame")),
            };
            return Some(self.end(session, Ok(message)));
        }
        let ready = self.sent == self.written && snapshot.step >= self.due && !views.is_empty();
        if self.sent < self.frames && ready {
            if self.request.kind == Kind::Turntable {
                let turn = self.sent as f32 / self.frames as f32 * std::f32::consts::TAU;
                for view in &mut views {
                    let orbit = Orbit::new(&view.camera);
                    view.camera = Orbit { turn: orbit.turn + turn, ..orbit }.camera();
                }
            }
            self.sent += 1;
            let (captions, number) = (session.captions().clone(), self.sent);
            self.send(Job::Frame(Shot { snapshot: snapshot.clone(), views, captions, number }));
            if self.sent == self.frames {
                self.send(Job::Finish);
            } else if matches!(self.request.kind, Kind::Clip | Kind::Pictures) {
                let (steps, rate) = self.request.format.steps();
                self.due = snapshot.step + u64::from(steps);
                (0..steps).for_each(|_| session.step_at(rate));
            }
        }
        None
    }

    fn send(&self, job: Job) {
        if let Some(jobs) = &self.jobs {
            // A writer that has ended has reported its error, which is received above.
            let _ = jobs.send(job);
        }
    }

    fn end(&mut self, session: &mut Session, outcome: Result<String, AppError>) -> Result<String, AppError> {
        self.jobs = None;
        session.act(Action::Play(self.played))?;
        outcome
    }

    /// Stops the recording early and returns the message. No file of an incomplete clip is left, and the
    /// scene continues as before.
    pub fn stop(mut self, session: &mut Session) -> Result<String, AppError> {
        self.end(session, Ok("stopped: a clip that is not complete is not kept".into()))
    }

    /// Number of frames written, and total number of frames.
    pub fn progress(&self) -> (u32, u32) {
        (self.written.min(self.frames), self.frames)
    }
}

/// The renderer of a recording, which is of the same kind as that of the window.
enum Brush {
    Cpu(Box<Renderer>),
    Gpu(Box<GpuRenderer>),
}

impl Brush {
    fn draw(
        &mut self,
        stage: &StageSnapshot,
        view: &ViewParameters,
        [width, height]: [u32; 2],
    ) -> Result<Image, AppError> {
        match self {
            Self::Cpu(renderer) => {
                if (renderer.image().width, renderer.image().height) != (width, height) {
                    **renderer = Renderer::new(width, height);
                }
                Ok(stage.draw(view, false, |frame| renderer.draw(frame).clone()))
            }
            Self::Gpu(renderer) => {
                // Snapshots reuse their memory, so an array at the same address may have new content.
                renderer.forget();
                stage.draw(view, true, |frame| {
                    renderer.draw(frame, width, height);
                });
                renderer.read().map_err(|why| AppError::new(why.to_string()))
            }
        }
    }
}

/// The output of the frames.
struct Sink {
    path: PathBuf,
    size: [u32; 2],
    clip: Option<ClipWriter>,
    brush: Brush,
    side_by_side: SideBySide,
}

impl Sink {
    fn new(request: &RecordRequest, gpu: Option<Gpu>) -> Result<Self, AppError> {
        let path = request.path.clone();
        let RecordFormat { size, rate } = request.format;
        if size.iter().any(|side| !RecordFormat::SIDES.contains(side)) {
            let [width, height] = size;
            return Err(AppError::new(format!(
                "a picture of {width} × {height} pixels cannot be recorded; each side is {} to {} pixels",
                RecordFormat::SIDES.start(),
                RecordFormat::SIDES.end()
            )));
        }
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let wrong = |expected: &str| {
            Err(AppError::new(format!("{}: {expected} was expected; choose another name", path.display())))
        };
        if request.kind != Kind::Pictures {
            check_single(&path)?;
        }
        let clip = match (request.kind, extension.as_str()) {
            (Kind::Still, "png" | "jpg") => None,
            (Kind::Still, _) => return wrong("a .png or .jpg"),
            (Kind::Pictures, "png") if sequence_path(&path, 1).is_some() => None,
            (Kind::Pictures, _) => {
                return wrong("a .png with # for the frame's number, such as hair.####.png");
            }
            (_, "mp4") => Some(ClipWriter::create(&path, size[0], size[1], rate.hertz())?),
            _ => return wrong("a .mp4"),
        };
        let brush = match gpu {
            Some(gpu) => Brush::Gpu(Box::new(GpuRenderer::new(&gpu))),
            None => Brush::Cpu(Box::new(Renderer::new(size[0], size[1]))),
        };
        Ok(Self { path, size, clip, brush, side_by_side: SideBySide::default() })
    }

    /// Draws and writes until it receives the end. `report` is called with the result of each frame and at the
    /// end. No file of an unfinished clip is left.
    fn run(mut self, todo: &Receiver<Job>, report: impl Fn(Result<(), AppError>) -> bool) {
        for job in todo {
            let outcome = match job {
                Job::Frame(shot) => self.frame(&shot),
                Job::Finish => {
                    let outcome = self.clip.take().map_or(Ok(()), ClipWriter::finish);
                    report(outcome.map_err(AppError::from));
                    return;
                }
            };
            let failed = outcome.is_err();
            if !report(outcome) || failed {
                return;
            }
        }
    }

    fn frame(&mut self, shot: &Shot) -> Result<(), AppError> {
        let image = match (&*shot.snapshot.stages, &*shot.views) {
            ([], _) | (_, []) => return Ok(()),
            ([one], [view, ..]) | ([one, ..], [view]) => self.brush.draw(one, view, self.size)?,
            ([left, right, ..], [first, second, ..]) => {
                self.pair([(left, first), (right, second)], &shot.captions)?
            }
        };
        match &mut self.clip {
            Some(clip) => clip.push(&image)?,
            None => {
                let path = sequence_path(&self.path, shot.number).unwrap_or_else(|| self.path.clone());
                write(&path, &image)?;
            }
        }
        Ok(())
    }

    /// Draws two compared pictures side by side, with their differences as captions.
    fn pair(
        &mut self,
        sides: [(&StageSnapshot, &ViewParameters); 2],
        captions: &[String; 2],
    ) -> Result<Image, AppError> {
        let [(left, first), (right, second)] = sides;
        let size = SideBySide::half(self.size);
        let halves = [self.brush.draw(left, first, size)?, self.brush.draw(right, second, size)?];
        let mut all = Image::new(self.size[0], self.size[1]);
        self.side_by_side.draw(&mut all, 0, self.size, halves.each_ref(), captions);
        Ok(all)
    }
}

/// Writes a picture in the format of the file's extension.
pub fn write(path: &Path, image: &hairspring_view::Image) -> Result<(), AppError> {
    let jpeg = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("jpg"));
    let written = if jpeg { write_jpeg(path, image) } else { write_png(path, image) };
    Ok(written?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_length_without_frames_or_with_too_many_is_refused() {
        let frames = |seconds: f32| {
            let (path, format) = (PathBuf::from("a.mp4"), RecordFormat::default());
            RecordRequest { kind: Kind::Clip, path, seconds, format }.frames()
        };
        assert_eq!((frames(0.02), frames(2.0), frames(3000.0)), (Ok(1), Ok(60), Ok(90_000)));
        for seconds in [0.0, 0.01, -1.0, f32::NAN, f32::INFINITY, 4000.0] {
            let why = frames(seconds).unwrap_err().to_string();
            assert!(why.contains("0.034 to 3333.334 s"), "{why}");
        }
    }

    #[test]
    fn the_steps_of_a_frame_add_up_to_its_length_and_are_at_most_those_of_the_window() {
        for rate in ["1", "12", "23.976", "24", "25", "29.97", "30", "50", "59.94", "60", "120"] {
            let rate: FrameRate = rate.parse().unwrap();
            let (steps, of_step) = RecordFormat { rate, ..RecordFormat::default() }.steps();
            assert!((f64::from(steps) * of_step.frame_length() - rate.frame_length()).abs() < 1e-12);
            assert!(of_step.frame_length() <= player::RATE.frame_length() + 1e-12, "{rate:?}: {steps} steps");
        }
    }
}
