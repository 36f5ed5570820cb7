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

        // A file that is replaced keeps its permissions, whatever the umask.
        for rights in [0o600, 0o444, 0o666] {
            std::fs::set_permissions(&path, PermissionsExt::from_mode(rights)).unwrap();
            write_atomically(&path, |out| out.write_all(b"first")).unwrap();
            assert_eq!(mode(&path) & 0o777, rights);
        }

        // A link stays, and the file that it leads to is replaced, or created.
        for target in ["a.txt", "new.txt"] {
            let [link, chain] = ["link", "chain"].map(|name| folder.path().join(name));
            std::os::unix::fs::symlink(target, &link).unwrap();
            std::os::unix::fs::symlink("link", &chain).unwrap();
            write_atomically(&chain, |out| out.write_all(b"first")).unwrap();
            assert!(link.is_symlink() && chain.is_symlink(), "{target}: a link was replaced");
            assert_eq!(std::fs::read(folder.path().join(target)).unwrap(), b"first");
            [link, chain].into_iter().for_each(|link| std::fs::remove_file(link).unwrap());
        }
        std::fs::remove_file(folder.path().join("new.txt")).unwrap();
        // A device is never replaced, not even at the end of a link.
        let device = folder.path().join("device");
        std::os::unix::fs::symlink("/dev/null", &device).unwrap();
        assert!(write_atomically(&device, |_| Ok(())).unwrap_err().to_string().contains("a device"));
        std::fs::remove_file(device).unwrap();
        // Neither is a socket, which stands for a pipe here: the standard library creates no pipe with a name.
        let socket = folder.path().join("socket");
        let listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        assert!(write_atomically(&socket, |_| Ok(())).unwrap_err().to_string().contains("a socket"));
        drop(listener);
        std::fs::remove_file(socket).unwrap();
        let around = folder.path().join("around");
        std::os::unix::fs::symlink("around", &around).unwrap();
        assert!(write_atomically(&around, |_| Ok(())).unwrap_err().to_string().contains("symbolic links"));
        std::fs::remove_file(around).unwrap();
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
