//! Where a file goes that a person names: into which folder really, and what is said where there is none.

use crate::AppError;
use std::{
    io::ErrorKind,
    path::{Path, PathBuf},
};

/// The path of a file that will be written, from the top and without `..`: what is said of it can be found.
///
/// # Errors
/// If its folder is not there, or it names no file.
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

/// The same path without `..`, where its folder is there: a link in place of the file stays one.
pub fn settled(path: &Path) -> PathBuf {
    destination(path).unwrap_or_else(|_| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_named_as_it_is_and_missing_ones_are_said() {
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
