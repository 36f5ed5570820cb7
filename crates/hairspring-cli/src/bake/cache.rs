//! One file of moving strands, put together from numbered samples.

use super::samples::Samples;
use crate::{console::Console, fault::Fault, interrupt, output};
use glam::Vec3;
use hairspring_io::{CacheDescription, Format, usc, write_cache};
use std::{
    io,
    path::{Path, PathBuf},
};

/// Name of the folder of checkpoints among the samples.
const CHECKPOINTS: &str = "sample.checkpoints";

/// A file of moving strands.
pub struct Cache {
    path: PathBuf,
    /// USD file that it is a layer over.
    over: Option<PathBuf>,
}

impl Cache {
    /// Returns the cache with this path; `None` for other files.
    pub fn new(path: &Path, over: Option<PathBuf>) -> Option<Self> {
        let format = Format::of(path)?;
        let known = format == Format::Pc2 || Format::EXTERNAL.contains(&format);
        known.then(|| Self { path: path.to_owned(), over })
    }

    /// The folder of its samples.
    fn folder(&self) -> PathBuf {
        let mut name = self.path.file_name().unwrap_or_default().to_owned();
        name.push(".frames");
        self.path.with_file_name(name)
    }

    /// Returns the numbered files of the samples: positions without attributes. There is an error if the format has no
    /// writer.
    pub fn samples(&self) -> Result<PathBuf, Fault> {
        hairspring_io::check_cache_format(&self.path).map_err(Fault::writing)?;
        Ok(self.folder().join("sample.######.data"))
    }

    /// Creates the folder of the samples.
    pub fn create_folder(&self) -> Result<(), Fault> {
        let folder = self.folder();
        std::fs::create_dir_all(&folder).map_err(|e| {
            Fault::Unwritable(format!("the folder {} could not be created: {e}", folder.display()))
        })
    }

    /// Completes a description with the samples `numbers`, and checks that a file can be written from it: that a layer fits
    /// the stage below it, for example. A long simulation is not lost to an error that is known before it.
    pub fn checked(
        &self,
        (numbers, samples): (&[u32], &Samples),
        description: CacheDescription,
    ) -> Result<CacheDescription, Fault> {
        let description = CacheDescription {
            fps: samples.fps(),
            first_frame: numbers.first().map_or(0.0, |n| samples.frame_of(*n)),
            frames: numbers.len() as u32,
            per_frame: samples.per_frame(),
            over: self.over.clone(),
            ..description
        };
        // A writer that is dropped leaves no file.
        drop(write_cache(&self.path, &description).map_err(Fault::writing)?);
        Ok(description)
    }

    /// Writes the file from its samples. Velocities are central differences; at the ends, one-sided ones.
    pub fn put_together(
        &self,
        (numbers, samples): (&[u32], &Samples),
        pattern: &Path,
        description: &CacheDescription,
        console: Console,
    ) -> Result<(), Fault> {
        let mut writer = write_cache(&self.path, description).map_err(Fault::writing)?;
        let failed =
            |why: String| Fault::Unwritable(format!("{} could not be written: {why}", self.path.display()));
        let read = |k: usize| numbers.get(k).map(|n| points_of(&output::frame_path(pattern, *n))).transpose();
        let mut progress = console.progress("writing", numbers.len() as u32);
        let step = samples.rate().frame_length() as f32;
        let (mut before, mut now) = (None, read(0)?);
        for (k, number) in numbers.iter().enumerate() {
            let Some(points) = now else { break };
            let after = read(k + 1)?;
            let velocities = velocities(before.as_deref(), &points, after.as_deref(), step);
            let frame = samples.frame_of(*number);
            writer.frame(frame, &points, &velocities).map_err(failed)?;
            (before, now) = (Some(points), after);
            progress.step(|| format!("frame {frame}"));
            if interrupt::stop_requested() {
                let text =
                    "stopped before the file was complete; run the same command with --resume to continue";
                return Err(Fault::Interrupted(text.into()));
            }
        }
        drop(progress);
        writer.finish().map_err(failed)
    }

    /// Removes what bakes wrote to the folder of the samples, and the folder if nothing else is in it.
    pub fn remove_samples(&self, console: Console) {
        let folder = self.folder();
        let removed = remove_own_files(&folder).and_then(|kept| match kept {
            0 => std::fs::remove_dir(&folder),
            _ => {
                console.note(format_args!(
                    "the folder {} is kept, because it holds files that no bake has written",
                    folder.display()
                ));
                Ok(())
            }
        });
        if let Err(why) = removed {
            console.note(format_args!("the folder {} could not be removed: {why}", folder.display()));
        }
    }
}

/// Removes samples, their manifest and their checkpoints from a folder. Returns the number of other entries.
fn remove_own_files(folder: &Path) -> io::Result<usize> {
    let mut others = 0;
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let number = |prefix: &str, end: &str| {
            let digits = name.strip_prefix(prefix).and_then(|rest| rest.strip_suffix(end));
            digits.is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()))
        };
        let (path, is_folder) = (entry.path(), entry.file_type()?.is_dir());
        if is_folder && name == CHECKPOINTS {
            let kept = remove_own_files(&path)?;
            others += usize::from(kept > 0);
            if kept == 0 {
                std::fs::remove_dir(&path)?;
            }
        } else if !is_folder
            && (number("sample.", ".data") || number("step.", "") || name == "sample.bake.data.json")
        {
            std::fs::remove_file(&path)?;
        } else {
            others += 1;
        }
    }
    Ok(others)
}

/// Reads the points of a sample.
fn points_of(path: &Path) -> Result<Vec<Vec3>, Fault> {
    let data = std::fs::read(path)
        .map_err(|e| Fault::Unreadable(format!("{} could not be read: {e}", path.display())))?;
    usc::parse(&data).map(|groom| groom.points).map_err(|p| Fault::Content(p.in_file(path).to_string()))
}

/// Velocities [m/s] at `now` from the positions one `step` [s] before and after [m].
fn velocities(before: Option<&[Vec3]>, now: &[Vec3], after: Option<&[Vec3]>, step: f32) -> Vec<Vec3> {
    let (from, to) = (before.unwrap_or(now), after.unwrap_or(now));
    let steps = u8::from(before.is_some()) + u8::from(after.is_some());
    let rate = if steps == 0 { 0.0 } else { 1.0 / (f32::from(steps) * step) };
    from.iter().zip(to).map(|(a, b)| (*b - *a) * rate).collect()
}
