//! Output files. Names and folders are checked before the work starts.

use crate::fault::Fault;
use hairspring_io::Inputs;
use hairspring_view::sequence_path;
use std::path::{Path, PathBuf};

/// Returns the path of frame `number`. Replaces `#` signs by the number; a name without them is unchanged.
pub fn frame_path(pattern: &Path, number: u32) -> PathBuf {
    sequence_path(pattern, number).unwrap_or_else(|| pattern.to_owned())
}

/// Whether a name has `#` signs, which represent the number of a frame.
pub fn is_sequence(path: &Path) -> bool {
    sequence_path(path, 1).is_some()
}

/// The extension in lower case; empty without one.
pub fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

/// Checks that files can be written to the folder of `path`, and that `path` is a regular file if it exists.
pub fn try_folder(path: &Path) -> Result<(), Fault> {
    let folder = path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        let text = match folder.exists() {
            true => format!("{} is a file and not a folder; choose another name", folder.display()),
            false => format!("the folder {} does not exist; create it first", folder.display()),
        };
        return Err(Fault::Unwritable(text));
    }
    check_target(path)?;
    // Creates an unnamed file if the system supports it, otherwise one that is removed immediately.
    tempfile::tempfile_in(folder).map(drop).map_err(|e| {
        Fault::Unwritable(format!("cannot write to the folder {}: {e}; choose another", folder.display()))
    })
}

/// Refuses to write to `path` if it exists and is no regular file. A pipe would be replaced by a file, and whoever reads
/// from it would wait for ever.
fn check_target(path: &Path) -> Result<(), Fault> {
    let text = match std::fs::metadata(path) {
        Ok(there) if there.is_dir() => format!("{} is a folder; name a file in it", path.display()),
        Ok(there) if !there.is_file() => {
            format!("{} is a pipe, a socket or a device; name a file", path.display())
        }
        _ => return Ok(()),
    };
    Err(Fault::Unwritable(text))
}

/// Refuses `#` signs in the name of a command's only file: they represent the number of a frame elsewhere.
pub fn check_single(path: &Path) -> Result<(), Fault> {
    match is_sequence(path) {
        true => Err(Fault::Usage(format!(
            "{}: this command writes one file, not one for each frame; leave out the # signs",
            path.display()
        ))),
        false => Ok(()),
    }
}

/// Checks the name and the folder of a report. A name of another kind is likely to be that of a scene.
pub fn check_report(path: &Path) -> Result<(), Fault> {
    if !matches!(extension(path).as_str(), "html" | "htm") {
        return Err(Fault::Usage(format!(
            "{}: a report is a page; choose a name that ends in .html",
            path.display()
        )));
    }
    try_folder(path)
}

/// Refuses a name that frame numbers cannot be put into.
pub fn check_name(path: &Path) -> Result<(), Fault> {
    match path.file_name() {
        Some(name) if name.to_str().is_none() => {
            Err(Fault::Usage(format!("{}: the name is not valid UTF-8; choose another", path.display())))
        }
        _ => Ok(()),
    }
}

/// Checks all files that a run will write: none may be one of those that the scene or groom `main` consists of, and
/// those that exist must be regular files.
pub fn check_outputs(
    inputs: &Inputs,
    main: &Path,
    outputs: impl IntoIterator<Item = PathBuf>,
) -> Result<(), Fault> {
    let outputs: Vec<PathBuf> = outputs.into_iter().collect();
    outputs.iter().try_for_each(|path| check_target(path))?;
    Inputs::keep(inputs.paths(main), outputs).map_err(Fault::Usage)
}

/// Writes a whole file: it is complete and on the disk before it appears under its name.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Fault> {
    hairspring_file::write_atomically(path, |out| out.write_all(bytes))
        .map_err(|e| Fault::Unwritable(format!("{} could not be written: {e}", path.display())))
}
