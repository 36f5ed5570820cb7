//! The manifest of a sequence of files lists its inputs and options, and the checksum of each finished file.
//!
//! It is a JSON file in the folder of the sequence. A resumed run compares its own inputs and options with the manifest,
//! and verifies the checksum of each finished file.

use crate::inputs::{Checksum, Inputs};
use serde::{Deserialize, Serialize};
use std::{
    collections::{BTreeMap, BTreeSet},
    io::{self, ErrorKind},
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

/// Shortest time between two writes of a manifest during a run. A file that was finished after the last write
/// is made again by the next run.
const EVERY: Duration = Duration::from_secs(1);

/// A run spends at most this share of its time on writing its manifest [1].
const SHARE: u32 = 20;

/// Number of items that a message lists.
const LISTED: usize = 3;

/// Why a manifest cannot be used. Each variant has the whole sentence.
#[derive(Clone, Debug, thiserror::Error)]
pub enum ManifestError {
    /// The run to be resumed had another origin.
    #[error("{0}")]
    Differs(String),
    /// The manifest cannot be read.
    #[error("{0}")]
    Unreadable(String),
    /// The file is not a manifest.
    #[error("{0}")]
    Invalid(String),
    /// The manifest cannot be written, or a finished file cannot be read back.
    #[error("{0}")]
    Unwritable(String),
}

/// Everything that the content of the files depends on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// The command: `bake` or `render`.
    command: String,
    /// Version of the program.
    version: String,
    /// Instruction set of the simulation. Results of different ones differ in the last digits.
    instruction_set: String,
    /// Options of the command line that change the files, without those that have their default.
    options: BTreeMap<String, String>,
    /// The scene or groom, and all files that it names, by their paths from its folder.
    inputs: BTreeMap<String, Checksum>,
}

impl Origin {
    /// Describes a run of `command`, `bake` or `render`, by this version of the program. `options` lists all options;
    /// those without a value have their default.
    #[must_use]
    pub fn new(command: &str, options: &[(&str, Option<String>)], inputs: Inputs) -> Self {
        let instruction_set = hairspring::simulation::Simulation::instruction_sets().into_iter().next();
        Self {
            command: command.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            instruction_set: instruction_set.unwrap_or_default(),
            options: options
                .iter()
                .filter_map(|(name, value)| Some(((*name).into(), value.clone()?)))
                .collect(),
            inputs: inputs.into_checksums(),
        }
    }

    /// Describes what differs between `self`, the origin of an earlier run, and that of this run.
    fn differences(&self, now: &Self) -> Vec<String> {
        let mut found = Vec::new();
        for (what, before, now) in [
            ("hairspring", &self.version, &now.version),
            ("the command", &self.command, &now.command),
            ("the instruction set", &self.instruction_set, &now.instruction_set),
        ] {
            if before != now {
                found.push(format!("{what} was {before} and is {now}"));
            }
        }
        for name in self.options.keys().chain(now.options.keys().filter(|n| !self.options.contains_key(*n))) {
            let [before, now] = [self, now].map(|o| o.options.get(name).map_or("the default", |v| v));
            if before != now {
                found.push(format!("--{name} was {before} and is {now}"));
            }
        }
        for (name, before) in &self.inputs {
            match now.inputs.get(name) {
                Some(now) if now == before => {}
                Some(_) => found.push(format!("{name} has changed")),
                None => found.push(format!("{name} is no longer read")),
            }
        }
        for name in now.inputs.keys().filter(|name| !self.inputs.contains_key(*name)) {
            found.push(format!("{name} was not read before"));
        }
        found
    }
}

/// A manifest file.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Content {
    origin: Origin,
    /// The finished files by their names.
    files: BTreeMap<String, Checksum>,
}

/// The manifest of a run.
pub struct Manifest {
    path: PathBuf,
    content: Content,
    /// Names of the files that this run replaces.
    replaced: BTreeSet<String>,
    /// When it was last written, and how long that took.
    written: Option<(Instant, Duration)>,
}

impl Manifest {
    /// Path of the manifest of the numbered files `pattern`: `hair.####.hair` → `hair.bake.hair.json`.
    #[must_use]
    pub fn path(pattern: &Path, command: &str) -> PathBuf {
        let name = pattern.file_name().unwrap_or_default().to_string_lossy();
        let end = name.rfind('#').map_or(0, |at| at + 1);
        let start = name[..end].trim_end_matches('#').len();
        pattern.with_file_name(format!("{}{command}{}.json", &name[..start], &name[end..]))
    }

    /// Starts a run. Files of an earlier run with the same origin stay listed. Also returns a note if there is
    /// something that a user should know.
    ///
    /// # Errors
    /// Returns an error if the file of this name is no manifest or cannot be read. With `resume`, also returns an error
    /// that says what differs if the origin of the earlier run differs.
    pub fn begin(
        pattern: &Path,
        origin: Origin,
        resume: bool,
    ) -> Result<(Self, Option<String>), ManifestError> {
        let path = Self::path(pattern, &origin.command);
        let mut content = Content { origin, files: BTreeMap::new() };
        let mut note = None;
        match read(&path) {
            Ok(Some(before)) => {
                let mut differences = before.origin.differences(&content.origin);
                if differences.is_empty() {
                    content.files = before.files;
                } else {
                    let more = differences.len().saturating_sub(LISTED);
                    differences.truncate(LISTED);
                    let more = if more > 0 { format!(", and {more} more") } else { String::new() };
                    let (path, what) = (path.display(), differences.join(", "));
                    if resume {
                        return Err(ManifestError::Differs(format!(
                            "--resume needs the inputs and options of {path}, but {what}{more}; run it without \
                             --resume to start again"
                        )));
                    }
                    note = Some(format!("{path} belongs to a different run and is replaced: {what}{more}"));
                }
            }
            Ok(None) if resume => {
                note = Some(format!("{} does not exist, so no frame counts as finished", path.display()));
            }
            Ok(None) => {}
            // It may be a file of somebody else.
            Err(why) => return Err(why),
        }
        Ok((Self { path, content, replaced: BTreeSet::new(), written: None }, note))
    }

    /// Describes everything that the files depend on, as JSON.
    pub fn origin(&self) -> String {
        serde_json::to_string(&self.content.origin).unwrap_or_default()
    }

    /// Returns those of `frames` that are not finished, and notes on files that are made again although they exist.
    /// `file` returns the path of a frame.
    #[must_use]
    pub fn unfinished(&self, frames: &[u32], file: impl Fn(u32) -> PathBuf) -> (Vec<u32>, Vec<String>) {
        let mut again = Vec::new();
        let wanted = frames.iter().copied().filter(|&number| {
            let path = file(number);
            let why = match self.why_unfinished(&path) {
                Ok(None) => return false,
                Ok(Some(why)) => why,
                Err(why) if why.kind() == ErrorKind::NotFound => return true,
                Err(why) => format!("it could not be read: {why}"),
            };
            again.push(format!("{} is made again: {why}", path.display()));
            true
        });
        let wanted = wanted.collect();
        let more = again.len().saturating_sub(LISTED);
        again.truncate(LISTED);
        if more > 0 {
            again.push(format!("{more} more files are made again"));
        }
        (wanted, again)
    }

    /// Returns why the file `path` does not count as finished; `None` if it does.
    fn why_unfinished(&self, path: &Path) -> io::Result<Option<String>> {
        let there = std::fs::metadata(path)?;
        // Reading a pipe or a device might never end.
        if !there.is_file() {
            return Ok(Some("it is not a regular file".into()));
        }
        let Some(before) = self.content.files.get(&name_of(path)) else {
            return Ok(Some("the manifest does not list it".into()));
        };
        if there.len() != before.bytes {
            return Ok(Some(format!("it has {} bytes instead of {}", there.len(), before.bytes)));
        }
        let same = Checksum::of_file(path)? == *before;
        Ok((!same).then(|| "its content has changed".into()))
    }

    /// Lists the file `path`, which is complete. Writes the manifest if the last time was long enough ago.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read back or the manifest cannot be written.
    pub fn finished(&mut self, path: &Path) -> Result<(), ManifestError> {
        let checksum = Checksum::of_file(path).map_err(|why| {
            ManifestError::Unwritable(format!("{} could not be read back: {why}", path.display()))
        })?;
        self.content.files.insert(name_of(path), checksum);
        let due = self.written.is_none_or(|(when, took)| when.elapsed() > EVERY.max(took * SHARE));
        if due { self.write() } else { Ok(()) }
    }

    /// Removes `files` from the list, because they are about to be replaced. Takes effect when the manifest is
    /// written, which must be before the first of them.
    pub fn will_replace(&mut self, files: impl IntoIterator<Item = PathBuf>) {
        self.replaced = files.into_iter().map(|path| name_of(&path)).collect();
        self.content.files.retain(|name, _| !self.replaced.contains(name));
    }

    /// Writes the manifest. Files that another run of the same origin has finished meanwhile stay listed.
    ///
    /// # Errors
    /// Returns an error if it cannot be written, or if a run of another origin has replaced it since the last time: both
    /// write to the same files.
    pub fn write(&mut self) -> Result<(), ManifestError> {
        let began = Instant::now();
        if let Ok(Some(there)) = read(&self.path) {
            if there.origin == self.content.origin {
                for (name, checksum) in there.files {
                    if !self.replaced.contains(&name) {
                        self.content.files.insert(name, checksum);
                    }
                }
            } else if self.written.is_some() {
                return Err(ManifestError::Unwritable(format!(
                    "another run with other inputs or options writes to the files of {}; give each run its own output",
                    self.path.display()
                )));
            }
        }
        let failed = |why: &dyn std::fmt::Display| {
            ManifestError::Unwritable(format!("{} could not be written: {why}", self.path.display()))
        };
        let text = serde_json::to_string_pretty(&self.content).map_err(|why| failed(&why))? + "\n";
        hairspring_file::write_atomically(&self.path, |out| out.write_all(text.as_bytes()))
            .map_err(|why| failed(&why))?;
        self.written = Some((Instant::now(), began.elapsed()));
        Ok(())
    }
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Reads a manifest; `None` if there is none.
fn read(path: &Path) -> Result<Option<Content>, ManifestError> {
    // Reading a pipe or a device might never end.
    if std::fs::metadata(path).is_ok_and(|there| !there.is_file()) {
        return Err(ManifestError::Unreadable(format!(
            "{} is not a regular file; move it away, or choose another name for the output",
            path.display()
        )));
    }
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(why) if why.kind() == ErrorKind::NotFound => return Ok(None),
        Err(why) => {
            return Err(ManifestError::Unreadable(format!("{} could not be read: {why}", path.display())));
        }
    };
    serde_json::from_str(&text).map(Some).map_err(|why| {
        ManifestError::Invalid(format!(
            "{} is not the manifest of an earlier run ({why}); move it away, or choose another name for the output",
            path.display()
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_manifest_is_named_after_its_files() {
        let path = |p: &str| Manifest::path(Path::new(p), "bake").to_string_lossy().into_owned();
        assert_eq!(path("out/hair.####.hair"), "out/hair.bake.hair.json");
        assert_eq!(path("a##b#.tfx"), "a##bbake.tfx.json");
    }

    #[test]
    fn a_run_whose_manifest_was_replaced_by_another_run_ends() {
        let folder = tempfile::tempdir().unwrap();
        let pattern = folder.path().join("hair.##.data");
        let begin = |fps: &str| {
            let origin = Origin::new("bake", &[("fps", Some(fps.into()))], Inputs::default());
            Manifest::begin(&pattern, origin, false).unwrap().0
        };
        let [mut first, mut same, mut other] = ["30", "30", "24"].map(begin);
        first.write().unwrap();
        same.write().unwrap();
        first.write().unwrap();
        other.write().unwrap();
        let why = first.write().unwrap_err().to_string();
        assert!(why.contains("another run") && why.contains("hair.bake.data.json"), "{why}");
        other.write().unwrap();
    }
}
