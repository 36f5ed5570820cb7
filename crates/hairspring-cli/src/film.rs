//! Writes pictures and clips on a separate thread while the next frame is simulated and drawn.

use crate::{
    fault::Fault,
    output,
    picture::{Drawn, Format},
};
use hairspring_io::Manifest;
use hairspring_view::{ClipWriter, Image, Layers, write_exr, write_jpeg, write_png};
use std::{
    path::{Path, PathBuf},
    sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel},
    thread::JoinHandle,
    time::{Duration, Instant},
};

/// Where drawn frames go.
pub enum Sink {
    /// All frames in one clip.
    Clip(Box<ClipWriter>),
    /// Each frame as a separate picture; `#` signs in the name represent its number.
    Pictures(PathBuf, Box<Manifest>),
    /// One frame as a picture.
    Still(PathBuf, u32),
}

enum Job {
    Frame(u32, Image),
    Layers(u32, Box<Layers>),
    Finish,
}

/// Writes frames on its own thread. If it is dropped before [`Film::finish`], no clip and no partial picture
/// is left.
pub struct Film {
    jobs: Option<SyncSender<Job>>,
    /// Images whose memory can be reused.
    spare: Receiver<Image>,
    thread: Option<JoinHandle<Result<Duration, Fault>>>,
}

impl Film {
    /// Starts writing to `sinks`. There is an error if the system has no more threads.
    pub fn new(mut sinks: Vec<Sink>) -> Result<Self, Fault> {
        // One frame waits while another is written. Memory use stays small, and a slow disk slows the run
        // down instead of filling memory.
        let (jobs, todo) = sync_channel(1);
        let (done, spare) = channel();
        let thread = std::thread::Builder::new().spawn(move || {
            let outcome = work(&mut sinks, todo, &done);
            // Also after an error or an interrupt, so that finished pictures count.
            let listed = sinks.iter_mut().try_for_each(Sink::list);
            outcome.and_then(|busy| listed.map(|()| busy))
        });
        let thread = thread.map_err(|e| {
            Fault::Lacking(format!(
                "the thread that writes frames could not be started: {e}; free memory or threads"
            ))
        })?;
        Ok(Self { jobs: Some(jobs), spare, thread: Some(thread) })
    }

    /// Queues a frame for writing.
    pub fn show(&mut self, number: u32, drawn: Drawn) -> Result<(), Fault> {
        match drawn {
            Drawn::Image(image) => {
                let mut copy = self.spare.try_recv().unwrap_or_default();
                copy.clone_from(image);
                self.send(Job::Frame(number, copy))
            }
            Drawn::Layers(layers) => self.send(Job::Layers(number, layers)),
        }
    }

    /// Completes all files; returns the time spent on writing.
    pub fn finish(mut self) -> Result<Duration, Fault> {
        self.send(Job::Finish)?;
        self.join()
    }

    fn send(&mut self, job: Job) -> Result<(), Fault> {
        let sent = self.jobs.as_ref().is_some_and(|jobs| jobs.send(job).is_ok());
        if sent { Ok(()) } else { self.join().map(drop) }
    }

    /// Waits for the thread.
    fn join(&mut self) -> Result<Duration, Fault> {
        self.jobs = None;
        match self.thread.take().map(JoinHandle::join) {
            Some(Ok(outcome)) => outcome,
            Some(Err(panic)) => std::panic::resume_unwind(panic),
            None => Ok(Duration::ZERO),
        }
    }
}

/// Writes all frames; returns the time that it took.
fn work(sinks: &mut Vec<Sink>, todo: Receiver<Job>, done: &Sender<Image>) -> Result<Duration, Fault> {
    let mut busy = Duration::ZERO;
    sinks.iter_mut().try_for_each(Sink::list)?;
    for job in todo {
        let began = Instant::now();
        match job {
            Job::Frame(number, image) => {
                let drawn = Drawn::Image(&image);
                sinks.iter_mut().try_for_each(|sink| sink.write(number, &drawn))?;
                // After the last frame nobody receives the image.
                let _ = done.send(image);
            }
            Job::Layers(number, layers) => {
                let drawn = Drawn::Layers(layers);
                sinks.iter_mut().try_for_each(|sink| sink.write(number, &drawn))?;
            }
            Job::Finish => {
                for sink in sinks.drain(..) {
                    sink.finish()?;
                }
            }
        }
        busy += began.elapsed();
    }
    Ok(busy)
}

impl Drop for Film {
    fn drop(&mut self) {
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            // The result no longer matters, because the run has failed already.
            let _ = thread.join();
        }
    }
}

/// Writes a picture in the format that the file's name selects.
fn write(path: &Path, drawn: &Drawn) -> Result<(), Fault> {
    match (output::extension(path).as_str(), drawn) {
        ("exr", Drawn::Layers(layers)) => write_exr(path, layers)?,
        ("jpg", drawn) => write_jpeg(path, &drawn.image())?,
        (_, drawn) => write_png(path, &drawn.image())?,
    }
    Ok(())
}

impl Sink {
    /// What the files of all `sinks` can hold.
    pub fn format(sinks: &[Self]) -> Format {
        let of = |sink: &Self| match sink {
            Self::Clip(_) => Format::Opaque,
            Self::Pictures(path, _) | Self::Still(path, _) => match output::extension(path).as_str() {
                "exr" => Format::Layers,
                "png" => Format::Alpha,
                _ => Format::Opaque,
            },
        };
        match sinks {
            [sink] => of(sink),
            _ => Format::Opaque,
        }
    }

    fn write(&mut self, number: u32, drawn: &Drawn) -> Result<(), Fault> {
        match self {
            Self::Clip(clip) => clip.push(&drawn.image())?,
            Self::Pictures(pattern, manifest) => {
                let path = output::frame_path(pattern, number);
                write(&path, drawn)?;
                manifest.finished(&path)?;
            }
            Self::Still(path, frame) if *frame == number => write(path, drawn)?,
            Self::Still(..) => {}
        }
        Ok(())
    }

    fn finish(mut self) -> Result<(), Fault> {
        self.list()?;
        match self {
            Self::Clip(clip) => Ok(clip.finish()?),
            Self::Pictures(..) | Self::Still(..) => Ok(()),
        }
    }

    /// Writes the manifest of pictures.
    fn list(&mut self) -> Result<(), Fault> {
        match self {
            Self::Pictures(_, manifest) => Ok(manifest.write()?),
            Self::Clip(_) | Self::Still(..) => Ok(()),
        }
    }
}
