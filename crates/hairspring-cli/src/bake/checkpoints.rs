//! Checkpoints of a bake: the state of the simulation at some steps, from which a run continues with the same bits.
//!
//! A file holds a magic number, the SHA-256 of everything that follows and of the bake's origin, and the state.

use crate::{console::Console, fault::Fault, output};
use hairspring_scene::stage::{Stage, StageState};
use sha2::{Digest as _, Sha256};
use std::{
    fs,
    path::{Path, PathBuf},
};

const MAGIC: &[u8; 8] = b"HSCHECK1";

/// The checkpoints of a bake.
pub struct Checkpoints {
    folder: PathBuf,
    /// Steps from one to the next.
    every: u32,
    /// Everything that the frames depend on.
    origin: String,
}

impl Checkpoints {
    /// The checkpoints beside the numbered files `pattern`, one in `every` steps. `origin` describes everything that the frames
    /// depend on.
    pub fn new(pattern: &Path, every: u32, origin: String) -> Result<Self, Fault> {
        let name = pattern.file_name().unwrap_or_default().to_string_lossy();
        let prefix = &name[..name.find('#').unwrap_or(name.len())];
        let folder = pattern.with_file_name(format!("{prefix}checkpoints"));
        fs::create_dir_all(&folder).map_err(|e| {
            Fault::Unwritable(format!("the folder {} could not be created: {e}", folder.display()))
        })?;
        Ok(Self { folder, every, origin })
    }

    /// Whether there is to be a checkpoint after this number of steps.
    pub fn is_due(&self, step: u32) -> bool {
        step > 0 && step.is_multiple_of(self.every)
    }

    /// Writes a checkpoint of `stage` after `step` steps, and continues from it as a later run would.
    pub fn write(&self, step: u32, stage: &mut Stage) -> Result<(), Fault> {
        let state = stage.state();
        let path = self.path(step);
        let failed = |why: &dyn std::fmt::Display| Fault::Unwritable(format!("{}: {why}", path.display()));
        let bytes = postcard::to_stdvec(&state).map_err(|why| failed(&why))?;
        output::write_whole(&path, &[MAGIC, &self.checksum(&bytes)[..], &bytes].concat())?;
        // Colliders keep what they were made from in earlier frames, which a later run does not have.
        stage.restore(&state).map_err(|why| failed(&why))
    }

    /// Returns the last valid checkpoint after at most `most` steps, and its number of steps. Damaged ones, and those of another
    /// bake, are skipped with a note.
    pub fn latest(&self, most: u32, console: Console) -> Option<(u32, StageState)> {
        let names = fs::read_dir(&self.folder).ok()?.flatten().map(|entry| entry.file_name());
        let step_of = |name: std::ffi::OsString| name.to_str()?.strip_prefix("step.")?.parse::<u32>().ok();
        let mut steps: Vec<u32> = names.filter_map(step_of).filter(|step| *step <= most).collect();
        steps.sort_unstable();
        steps.into_iter().rev().find_map(|step| {
            let found = self.read(step);
            if found.is_none() {
                let path = self.path(step);
                console
                    .note(format_args!("{} is damaged or of another bake, and is not used", path.display()));
            }
            Some((step, found?))
        })
    }

    fn read(&self, step: u32) -> Option<StageState> {
        let path = self.path(step);
        // Reading a pipe or a device might never end.
        fs::metadata(&path).ok().filter(|there| there.is_file())?;
        let file = fs::read(path).ok()?;
        let (checksum, bytes) = file.strip_prefix(MAGIC)?.split_at_checked(32)?;
        if self.checksum(bytes) != checksum {
            return None;
        }
        postcard::from_bytes(bytes).ok()
    }

    fn path(&self, step: u32) -> PathBuf {
        self.folder.join(format!("step.{step:06}"))
    }

    fn checksum(&self, bytes: &[u8]) -> [u8; 32] {
        Sha256::new().chain_update(&self.origin).chain_update(bytes).finalize().into()
    }
}
