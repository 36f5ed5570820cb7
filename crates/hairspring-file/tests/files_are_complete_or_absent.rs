//! Promise: a file appears under its final name only when it is complete, and nothing else is left.
//!
//! All checks are one test, because the last one ends writing in this process.

use hairspring_file::{PendingFile, remove_pending_files, write_atomically};
use std::{
    io::{self, Write},
    path::Path,
};

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn complete_or_absent() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.txt");

    write_atomically(&path, |out| out.write_all(b"first")).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), b"first");

    // A failed write leaves the former content and no temporary file.
    let failed = write_atomically(&path, |out| {
        out.write_all(b"sec")?;
        Err(io::Error::other("the disk is full"))
    });
    assert_eq!(failed.unwrap_err().to_string(), "the disk is full");
    assert_eq!(
        (names(folder.path()), std::fs::read(&path).unwrap()),
        (vec!["a.txt".into()], b"first".into())
    );

    // A file that is dropped is removed.
    let mut dropped = PendingFile::create(&path).unwrap();
    dropped.write_all(b"third").unwrap();
    assert_eq!(names(folder.path()).len(), 2);
    drop(dropped);
    assert_eq!(names(folder.path()), ["a.txt"]);

    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let plain = folder.path().join("plain.txt");
        std::fs::write(&plain, "").unwrap();
        let mode = |p: &Path| std::fs::metadata(p).unwrap().permissions().mode();
        assert_eq!(mode(&path), mode(&plain));
        std::fs::remove_file(plain).unwrap();
    }

    // After the removal nothing appears, also not from a file that was pending before.
    let mut pending = PendingFile::create(&path).unwrap();
    pending.write_all(b"fourth").unwrap();
    remove_pending_files();
    assert_eq!(names(folder.path()), ["a.txt"]);
    assert!(pending.commit().is_err());
    assert!(PendingFile::create(&path).is_err());
    assert_eq!(
        (names(folder.path()), std::fs::read(&path).unwrap()),
        (vec!["a.txt".into()], b"first".into())
    );
}
