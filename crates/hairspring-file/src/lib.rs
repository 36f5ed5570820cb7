//! Files that are either complete or absent.
//!
//! A [`PendingFile`] is written under a temporary name in the folder of its target. It gets its final name
//! when it is complete and on the disk. If it is dropped before that, it is removed. A program that is about
//! to exit removes all pending files with [`remove_pending_files`].
//!
//! A file that is replaced keeps its permissions. If the target is a symbolic link, the file that it leads to is
//! replaced, and the link stays.

use std::{
    collections::BTreeSet,
    fs::{File, Permissions},
    io::{self, BufWriter, Write},
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};
use tempfile::NamedTempFile;

/// Size of the write buffer [bytes].
const BUFFER: usize = 1 << 20;

/// Maximum number of symbolic links in a row, as on Linux.
const MOST_LINKS: usize = 40;

/// The pending files of this process; `None` after [`remove_pending_files`].
static PENDING: Mutex<Option<BTreeSet<PathBuf>>> = Mutex::new(Some(BTreeSet::new()));

fn pending() -> MutexGuard<'static, Option<BTreeSet<PathBuf>>> {
    PENDING.lock().unwrap_or_else(PoisonError::into_inner)
}

fn ending() -> io::Error {
    io::Error::other("the program is ending")
}

/// Returns the folder of `path`; the current one for a bare name.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Returns the file that `path` leads to: `path` itself, unless it is a symbolic link.
fn follow_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match path.read_link() {
            Ok(next) => path = folder_of(&path).join(next),
            // It is no link, or it does not exist yet.
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("too many symbolic links lead on from it"))
}

/// Returns whether `target` is a pipe, a socket or a device, such as `/dev/null`. None of these must be replaced: a
/// program that reads from a pipe would wait forever.
fn is_special(target: &Path) -> bool {
    std::fs::metadata(target).is_ok_and(|there| !there.is_file() && !there.is_dir())
}

/// Returns the permissions of an existing file; `None` for a new one. Only Unix can pass them on to another file.
fn permissions_of(target: &Path) -> Option<Permissions> {
    let there = std::fs::metadata(target).ok().filter(|there| cfg!(unix) && there.is_file());
    there.map(|there| there.permissions())
}

/// A file that is being written under a temporary name.
#[derive(Debug)]
pub struct PendingFile {
    target: PathBuf,
    /// Permissions of the file that is replaced; `None` if there is none.
    permissions: Option<Permissions>,
    /// `None` only after the file was renamed.
    temporary: Option<NamedTempFile>,
}

impl PendingFile {
    /// Creates a temporary file in the folder of `target`. The finished file has the permissions of the file that it
    /// replaces, or those of a new file.
    ///
    /// # Errors
    /// Returns the error of the system, or an error for a pipe, a socket, a device, or after [`remove_pending_files`].
    pub fn create(target: &Path) -> io::Result<Self> {
        let target = follow_links(target)?;
        if is_special(&target) {
            return Err(io::Error::other("it is a pipe, a socket or a device; name a file"));
        }
        let permissions = permissions_of(&target);
        let mut builder = tempfile::Builder::new();
        builder.prefix(".hairspring-");
        // Temporary files are private by default, and stay so if the finished file gets other permissions. A new
        // file gets the usual ones, limited by the umask.
        #[cfg(unix)]
        if permissions.is_none() {
            builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        }
        // The lock is held while the file is created, so that no file appears after the others were removed.
        let mut pending = pending();
        let names = pending.as_mut().ok_or_else(ending)?;
        let temporary = builder.tempfile_in(folder_of(&target))?;
        names.insert(temporary.path().to_owned());
        Ok(Self { target, permissions, temporary: Some(temporary) })
    }

    /// Returns another handle to the file.
    ///
    /// # Errors
    /// Returns the error of the system.
    pub fn reopen(&self) -> io::Result<File> {
        self.temporary.as_ref().ok_or_else(ending)?.reopen()
    }

    /// Writes the file to the disk and renames it to its final name, which replaces an existing file.
    ///
    /// # Errors
    /// Returns the error of the system. The target is unchanged in that case.
    pub fn commit(mut self) -> io::Result<()> {
        let temporary = self.temporary.take().ok_or_else(ending)?;
        let name = temporary.path().to_owned();
        // Without this, a crash of the system after the rename may leave an empty file under the final name.
        let file = temporary.as_file();
        let permitted =
            self.permissions.take().map_or(Ok(()), |permissions| file.set_permissions(permissions));
        let outcome = permitted.and_then(|()| file.sync_all()).and_then(|()| {
            // The lock is held during the rename, so that no file appears after the program has reported its
            // end.
            let pending = pending();
            pending.as_ref().ok_or_else(ending)?;
            temporary.persist(&self.target).map(drop).map_err(|e| e.error)
        });
        forget(&name);
        outcome?;
        sync_folder(folder_of(&self.target));
        Ok(())
    }
}

impl Write for PendingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.temporary.as_mut().ok_or_else(ending)?.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.temporary.as_mut().ok_or_else(ending)?.flush()
    }
}

impl Drop for PendingFile {
    fn drop(&mut self) {
        if let Some(temporary) = self.temporary.take() {
            let name = temporary.path().to_owned();
            drop(temporary);
            forget(&name);
        }
    }
}

fn forget(name: &Path) {
    if let Some(names) = pending().as_mut() {
        names.remove(name);
    }
}

/// Makes a rename permanent. Not every system and file system can do that for a folder.
fn sync_folder(folder: &Path) {
    if cfg!(unix) {
        let _ = File::open(folder).and_then(|f| f.sync_all());
    }
}

/// Writes a file atomically. `write` fills the pending file through a buffer.
///
/// # Errors
/// Returns the error of `write` or of the system. Nothing is left behind in that case.
pub fn write_atomically(
    target: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(BUFFER, PendingFile::create(target)?);
    write(&mut out)?;
    out.into_inner().map_err(|e| e.into_error())?.commit()
}

/// Removes all pending files of this process, for a program that is about to exit. From here on, no file can
/// be created or get its final name.
pub fn remove_pending_files() {
    if let Some(names) = pending().take() {
        for name in names {
            // A file that is gone already needs no removal; other errors cannot be reported at this point.
            let _ = std::fs::remove_file(name);
        }
    }
}
