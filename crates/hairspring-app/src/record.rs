//! Stills, pictures, clips and turntables of what is seen. Every frame is drawn in full, however long that takes: while a record runs, the simulation waits for it.

use crate::{
    AppError,
    orbit::Orbit,
    session::{Action, Session},
    snapshot::{Sight, Snapshot},
};
use hairspring_view::{ClipWriter, Renderer, sequence_path, write_jpeg, write_png};
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        mpsc::{Receiver, Sender, channel},
    },
};

/// Frames a second of clips: every second step.
const RATE: u32 = 30;
/// Steps between them.
const STEPS: u64 = 2;
/// Size of what is recorded [pixels].
const SIZE: [u32; 2] = [1280, 720];

/// What is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The moment, as a picture.
    Still,
    /// Pictures, one a frame.
    Pictures,
    /// A clip of the play.
    Clip,
    /// A clip once around the moment.
    Turntable,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Still, Self::Clip, Self::Pictures, Self::Turntable];

    /// What the dialog is called.
    pub fn title(self) -> &'static str {
        match self {
            Self::Still => "Still",
            Self::Pictures => "Pictures, one a frame",
            Self::Clip => "Clip of the play",
            Self::Turntable => "Turntable",
        }
    }

    /// A file to begin from.
    pub fn file(self) -> &'static str {
        match self {
            Self::Still => "hair.png",
            Self::Pictures => "hair.####.png",
            Self::Clip => "hair.mp4",
            Self::Turntable => "turntable.mp4",
        }
    }
}

/// What is to be recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Wish {
    /// What.
    pub kind: Kind,
    /// Where it is written: `.png` or `.jpg` for a still, `.png` with `#` for pictures, else `.mp4`.
    pub path: PathBuf,
    /// How long [s]; not of a still.
    pub seconds: f32,
}

enum Job {
    Frame(Arc<Snapshot>, Sight, u32),
    Finish,
}

/// A record being made.
pub struct Recorder {
    wish: Wish,
    frames: u32,
    /// Frames handed over.
    sent: u32,
    /// Frames written.
    written: u32,
    /// The step that is waited for.
    due: u64,
    /// Whether the scene played before.
    played: bool,
    jobs: Option<Sender<Job>>,
    done: Receiver<Result<(), AppError>>,
}

impl Recorder {
    /// Begins; the play is paused and goes on by what is recorded.
    pub fn new(
        wish: Wish,
        session: &mut Session,
        snapshot: &Snapshot,
        wake: impl Fn() + Send + 'static,
    ) -> Result<Self, AppError> {
        let sink = Sink::new(&wish)?;
        let frames = match wish.kind {
            Kind::Still => 1,
            _ => ((wish.seconds * RATE as f32).round() as u32).clamp(1, 100_000),
        };
        let played = session.playing();
        session.act(Action::Play(false))?;
        let (jobs, todo) = channel();
        let (said, done) = channel();
        std::thread::spawn(move || {
            sink.run(&todo, |outcome| {
                let heard = said.send(outcome).is_ok();
                wake();
                heard
            });
        });
        Ok(Self { frames, sent: 0, written: 0, due: snapshot.step, played, jobs: Some(jobs), done, wish })
    }

    /// Goes on as far as there is something to do; `Some` when it ended, with what to say.
    pub fn advance(
        &mut self,
        session: &mut Session,
        snapshot: &Arc<Snapshot>,
        sight: &Sight,
    ) -> Option<Result<String, AppError>> {
        while let Ok(outcome) = self.done.try_recv() {
            if let Err(why) = outcome {
                return Some(self.end(session, Err(why)));
            }
            self.written += 1;
        }
        // One frame more than was sent: the file is complete.
        if self.written > self.frames {
            let path = self.wish.path.display();
            let said = match self.wish.kind {
                Kind::Still => format!("wrote {path}"),
                _ => format!("wrote {path}: {} frames", self.frames),
            };
            return Some(self.end(session, Ok(said)));
        }
        if self.sent < self.frames && self.sent == self.written && snapshot.step >= self.due {
            let sight = match self.wish.kind {
                Kind::Turntable => {
                    let turn = self.sent as f32 / self.frames as f32 * std::f32::consts::TAU;
                    let orbit = Orbit::new(&sight.camera);
                    Sight { camera: Orbit { turn: orbit.turn + turn, ..orbit }.camera(), ..*sight }
                }
                _ => *sight,
            };
            self.sent += 1;
            self.tell(Job::Frame(snapshot.clone(), sight, self.sent));
            if self.sent == self.frames {
                self.tell(Job::Finish);
            } else if matches!(self.wish.kind, Kind::Clip | Kind::Pictures) {
                self.due = snapshot.step + STEPS;
                for _ in 0..STEPS {
                    // Orders to a session that lives cannot fail.
                    let _ = session.act(Action::Step);
                }
            }
        }
        None
    }

    fn tell(&self, job: Job) {
        if let Some(jobs) = &self.jobs {
            // A writer that ended has said why, which is heard above.
            let _ = jobs.send(job);
        }
    }

    fn end(&mut self, session: &mut Session, outcome: Result<String, AppError>) -> Result<String, AppError> {
        self.jobs = None;
        session.act(Action::Play(self.played))?;
        outcome
    }

    /// Ends before its end; what to say. A clip that is not complete leaves nothing behind, and the scene plays on as before.
    pub fn stop(mut self, session: &mut Session) -> Result<String, AppError> {
        self.end(session, Ok("stopped: a clip that is not complete is not kept".into()))
    }

    /// Frames written, of how many.
    pub fn progress(&self) -> (u32, u32) {
        (self.written.min(self.frames), self.frames)
    }
}

/// Where frames go.
struct Sink {
    path: PathBuf,
    clip: Option<ClipWriter>,
    renderer: Renderer,
}

impl Sink {
    fn new(wish: &Wish) -> Result<Self, AppError> {
        let path = wish.path.clone();
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let wrong = |expected: &str| {
            Err(AppError::new(format!("{}: {expected} was expected; name such a file", path.display())))
        };
        let clip = match (wish.kind, extension.as_str()) {
            (Kind::Still, "png" | "jpg") => None,
            (Kind::Still, _) => return wrong("a .png or .jpg"),
            (Kind::Pictures, "png") if sequence_path(&path, 1).is_some() => None,
            (Kind::Pictures, _) => {
                return wrong("a .png with # for the frame's number, such as hair.####.png");
            }
            (_, "mp4") => Some(ClipWriter::create(&path, SIZE[0], SIZE[1], f64::from(RATE))?),
            _ => return wrong("a .mp4"),
        };
        Ok(Self { path, clip, renderer: Renderer::new(SIZE[0], SIZE[1]) })
    }

    /// Draws and writes until it is told to finish, and tells `said` of each frame and of the end; nothing is left of a clip that is not finished.
    fn run(mut self, todo: &Receiver<Job>, said: impl Fn(Result<(), AppError>) -> bool) {
        for job in todo {
            let outcome = match job {
                Job::Frame(snapshot, sight, number) => self.frame(&snapshot, &sight, number),
                Job::Finish => {
                    let outcome = self.clip.take().map_or(Ok(()), ClipWriter::finish);
                    said(outcome.map_err(AppError::from));
                    return;
                }
            };
            let failed = outcome.is_err();
            if !said(outcome) || failed {
                return;
            }
        }
    }

    fn frame(&mut self, snapshot: &Snapshot, sight: &Sight, number: u32) -> Result<(), AppError> {
        let Some(scenery) = snapshot.stages.first() else { return Ok(()) };
        let image = scenery.draw(sight, false, |frame| self.renderer.draw(frame));
        match &mut self.clip {
            Some(clip) => clip.push(image)?,
            None => {
                let path = sequence_path(&self.path, number).unwrap_or_else(|| self.path.clone());
                write(&path, image)?;
            }
        }
        Ok(())
    }
}

/// Writes a picture by its file's extension.
pub fn write(path: &Path, image: &hairspring_view::Image) -> Result<(), AppError> {
    let jpeg = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("jpg"));
    let written = if jpeg { write_jpeg(path, image) } else { write_png(path, image) };
    Ok(written?)
}
