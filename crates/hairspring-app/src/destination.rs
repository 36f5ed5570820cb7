//! Paths of files to be written: resolves the folder, and reports a missing one.

use crate::AppError;
use hairspring_view::sequence_path;
use std::{
    io::ErrorKind,
    path::{Path, PathBuf},
};

/// Returns the path of a file to be written as an absolute path without `..`, so that messages show where it
/// is.
///
/// # Errors
/// Returns an error if the folder does not exist, or if the path names no file.
pub fn destination(path: &Path) -> Result<PathBuf, AppError> {
    let whole = std::path::absolute(path)
        .map_err(|why| AppError::new(format!("{} names no file: {why}", path.display())))?;
    let (Some(folder), Some(name)) = (whole.parent(), whole.file_name()) else {
        return Err(AppError::new(format!("{} names no file", path.display())));
    };
    match folder.canonicalize() {
        Ok(folder) => Ok(folder.join(name)),
        Err(why) if why.kind() == ErrorKind::NotFound => Err(AppError::new(format!(
            "{} was not written: there is no folder {}",
            name.display(),
            folder.display()
        ))),
        Err(why) => Err(AppError::new(format!(
            "{} was not written: the folder {} cannot be opened: {why}",
            name.display(),
            folder.display()
        ))),
    }
}

/// Refuses `#` signs in the name of an only file: they represent the number of a frame elsewhere.
///
/// # Errors
/// Returns an error that names the file.
pub fn check_single(path: &Path) -> Result<(), AppError> {
    match sequence_path(path, 1) {
        Some(_) => Err(AppError::new(format!(
            "{}: this writes one file, not one for each frame; leave out the # signs",
            path.display()
        ))),
        None => Ok(()),
    }
}

/// Returns the path without `..` if its folder exists. A symbolic link as the last component is kept.
pub fn settled(path: &Path) -> PathBuf {
    destination(path).unwrap_or_else(|_| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_resolved_and_missing_folders_are_reported() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("a");
        std::fs::create_dir(&inner).unwrap();
        let real = folder.path().canonicalize().unwrap();
        assert_eq!(destination(&inner.join("../b.toml")).unwrap(), real.join("b.toml"));
        let why = destination(&folder.path().join("none/b.toml")).unwrap_err().to_string();
        assert!(
            why.starts_with("b.toml was not written: there is no folder ") && why.ends_with("none"),
            "{why}"
        );
        assert!(destination(Path::new("/")).unwrap_err().to_string().contains("names no file"));
    }
}
