//! Where results go: names checked and folders tried before the work, not after it.

use crate::fault::Fault;
use hairspring_view::sequence_path;
use std::{
    io::Write,
    path::{Path, PathBuf},
};

/// The path of frame `number`: `#` signs become the number; a name without any is the one file.
pub fn frame_path(pattern: &Path, number: u32) -> PathBuf {
    sequence_path(pattern, number).unwrap_or_else(|| pattern.to_owned())
}

/// Whether a name stands for numbered files.
pub fn is_sequence(path: &Path) -> bool {
    sequence_path(path, 1).is_some()
}

/// The extension in lower case; empty without one.
pub fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

/// Makes sure that the folder of `path` takes files and that `path` is not a folder itself.
pub fn try_folder(path: &Path) -> Result<(), Fault> {
    let folder = path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        let text = format!("the folder {} does not exist; make it first", folder.display());
        return Err(Fault::Unwritable(text));
    }
    if path.is_dir() {
        let text = format!("{} is a folder; name a file in it", path.display());
        return Err(Fault::Unwritable(text));
    }
    // A file without a name, where the system has such, else one that is removed at once.
    tempfile::tempfile_in(folder).map(drop).map_err(|e| {
        Fault::Unwritable(format!("the folder {} does not take files: {e}; choose another", folder.display()))
    })
}

/// Writes a whole file: beside its place first, then moved there, so that nothing half-written is ever left.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Fault> {
    let folder = path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let write = || {
        let mut builder = tempfile::Builder::new();
        // Readable as the user's mask says, not private as temporary files are.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut file = builder.prefix(".hairspring-").tempfile_in(folder)?;
        file.write_all(bytes)?;
        file.persist(path).map_err(|e| e.error)
    };
    write().map(drop).map_err(|e| Fault::Unwritable(format!("{} could not be written: {e}", path.display())))
}
