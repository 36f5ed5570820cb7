//! Writes the hair of the scene to groom files: that of the current frame, or a range of frames on a thread of
//! its own, as `hairspring bake` does. Its manifest is the same, so that `hairspring bake --resume` continues a bake
//! of the window if the scene is saved as it was baked.

use crate::{
    AppError,
    destination::{check_single, destination},
    document::Source,
    snapshot::StageSnapshot,
    text::counted,
};
use hairspring_io::{Format, FrameError, FrameWriter, Manifest, Origin};
use hairspring_scene::stage::{FrameRate, Stage};
use hairspring_view::sequence_path;
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicU32, Ordering::Relaxed},
    },
    thread::JoinHandle,
};

/// A request for a bake.
#[derive(Clone, Debug, PartialEq)]
pub struct BakeRequest {
    /// Path of the files; `#` signs represent the digits of the frame's number.
    pub path: PathBuf,
    /// First and last frame, from 1, which is at time 0.
    pub frames: [u32; 2],
    /// Frames per second.
    pub rate: FrameRate,
}

impl BakeRequest {
    /// The files that it writes.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        let [first, last] = self.frames;
        (first..=last).map(|frame| self.file(frame))
    }

    /// The file of a frame.
    fn file(&self, frame: u32) -> PathBuf {
        sequence_path(&self.path, frame).unwrap_or_else(|| self.path.clone())
    }
}

/// What the window and the thread of a bake share.
#[derive(Default)]
struct Shared {
    /// Number of frames that were simulated.
    done: AtomicU32,
    cancelled: AtomicBool,
}

/// A bake in progress. Dropping it stops it after the current frame.
pub struct Baker {
    last: u32,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<Result<String, AppError>>>,
}

impl Baker {
    /// Starts a bake of a scene with `threads` threads; `wake` is called after each frame and at the end.
    ///
    /// # Errors
    /// Returns an error if the path is not one of numbered groom files in an existing folder.
    pub fn new(
        mut request: BakeRequest,
        source: Source,
        threads: usize,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self, AppError> {
        request.path = groom_path(&request.path)?;
        let [first, last] = request.frames;
        if sequence_path(&request.path, 1).is_none() && first < last {
            return Err(AppError::new(format!(
                "{} is one file for many frames; put # signs where the frame's number goes, such as hair.####.hair",
                request.path.display()
            )));
        }
        let shared = Arc::new(Shared::default());
        let own = shared.clone();
        let thread = std::thread::spawn(move || {
            let outcome = match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
                Ok(pool) => pool.install(|| run(&request, &source, &own, &wake)),
                Err(_) => run(&request, &source, &own, &wake),
            };
            wake();
            outcome
        });
        Ok(Self { last, shared, thread: Some(thread) })
    }

    /// Number of frames simulated, and that of all.
    pub fn progress(&self) -> (u32, u32) {
        (self.shared.done.load(Relaxed), self.last)
    }

    /// Stops after the current frame.
    pub fn cancel(&self) {
        self.shared.cancelled.store(true, Relaxed);
    }

    /// The message of a bake that has ended.
    pub fn outcome(&mut self) -> Option<Result<String, AppError>> {
        let thread = self.thread.take_if(|thread| thread.is_finished())?;
        let stopped =
            || AppError::new("the bake ended by an internal error; the frames that it wrote are complete");
        Some(thread.join().unwrap_or_else(|_| Err(stopped())))
    }
}

impl Drop for Baker {
    fn drop(&mut self) {
        self.cancel();
    }
}

/// Plays the scene from time 0 and writes the frames.
fn run(
    request: &BakeRequest,
    source: &Source,
    shared: &Shared,
    wake: &(impl Fn() + Sync),
) -> Result<String, AppError> {
    let BakeRequest { path, frames: [first, last], rate } = request;
    let (loaded, inputs) = source.load_and_record()?;
    let mut stage = Stage::new(loaded.value)?;
    let (mut writer, mut notes) =
        FrameWriter::new(path, stage.strands().map(|s| s.groom.into())).map_err(failed)?;
    let file = |frame| request.file(frame);
    let mut manifest = None;
    if sequence_path(path, 1).is_some() {
        let origin = Origin::new("bake", &[("fps", Some(rate.to_string()))], inputs);
        let (mut begun, note) = Manifest::begin(path, origin, false)?;
        notes.extend(note);
        begun.will_replace((*first..=*last).map(file));
        begun.write()?;
        manifest = Some(begun);
    }
    let mut written = 0;
    for frame in 1..=*last {
        if shared.cancelled.load(Relaxed) {
            manifest.as_mut().map_or(Ok(()), Manifest::write)?;
            return Ok(format!(
                "the bake stopped after {} of {}; complete: {}",
                frame - 1,
                counted((*last).into(), "frame"),
                counted(written, "file")
            ));
        }
        if frame > 1 {
            stage.step_frame(*rate);
        }
        if frame >= *first {
            let file = file(frame);
            writer.write(&file, stage.time(), stage.strands().map(|s| s.points)).map_err(failed)?;
            manifest.as_mut().map_or(Ok(()), |manifest| manifest.finished(&file))?;
            written += 1;
        }
        shared.done.store(frame, Relaxed);
        wake();
    }
    manifest.as_mut().map_or(Ok(()), Manifest::write)?;
    notes.insert(0, format!("baked {}: {}", path.display(), counted(written, "frame")));
    Ok(notes.join("; "))
}

/// Writes the hair of one moment to a groom file; returns the message.
///
/// # Errors
/// Returns an error if the extension is that of no groom, or if the file cannot be written.
pub fn export(path: &Path, stage: &StageSnapshot) -> Result<String, AppError> {
    let path = groom_path(path)?;
    check_single(&path)?;
    let (mut writer, mut notes) =
        FrameWriter::new(&path, stage.still.grooms.iter().map(|groom| groom.strands())).map_err(failed)?;
    writer.write(&path, stage.time, stage.points()).map_err(failed)?;
    notes.insert(0, format!("wrote {}", path.display()));
    Ok(notes.join("; "))
}

fn failed(why: FrameError) -> AppError {
    AppError::new(why.to_string())
}

/// Resolves the path of a groom file to be written.
fn groom_path(path: &Path) -> Result<PathBuf, AppError> {
    if !Format::of(path).is_some_and(|format| Format::GROOMS.contains(&format)) {
        let path = path.display();
        return Err(AppError::new(format!(
            "{path}: hair is written as .hair, .tfx or .data; choose a name that ends so"
        )));
    }
    destination(path)
}
