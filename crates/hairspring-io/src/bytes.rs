//! A cursor over a file's bytes. It trusts no count before it has checked that the bytes are there.

use crate::{Place, Problem};
use bytemuck::Pod;
use std::{
    fs::{File, Metadata},
    io::{self, Read},
    path::Path,
};

#[cfg(target_endian = "big")]
compile_error!(
    "binary files are little-endian and are read as whole arrays: this machine would need swapped bytes"
);

/// A file's bytes and the current read position.
pub(crate) struct Bytes<'a> {
    data: &'a [u8],
    at: usize,
}

impl<'a> Bytes<'a> {
    pub(crate) fn new(data: &'a [u8]) -> Self {
        Self { data, at: 0 }
    }

    pub(crate) fn at(&self) -> usize {
        self.at
    }

    pub(crate) fn remaining(&self) -> usize {
        self.data.len() - self.at
    }

    /// Moves to offset `at`. `what` names the data there, for error messages.
    pub(crate) fn seek(&mut self, at: usize, what: &str) -> Result<(), Problem> {
        if at > self.data.len() {
            let text = format!(
                "{what} should begin at byte {at}, but the file ends at {}: it is cut short",
                self.data.len()
            );
            return Err(Problem::new(Place::Byte(self.at), text));
        }
        self.at = at;
        Ok(())
    }

    /// Reads the next `count` bytes.
    pub(crate) fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], Problem> {
        if count > self.remaining() {
            let text = format!(
                "{what} needs {count} bytes, but only {} are left: the file is cut short",
                self.remaining()
            );
            return Err(Problem::new(Place::Byte(self.at), text));
        }
        let taken = &self.data[self.at..][..count];
        self.at += count;
        Ok(taken)
    }

    /// Reads the next value.
    pub(crate) fn value<T: Pod>(&mut self, what: &str) -> Result<T, Problem> {
        self.take(size_of::<T>(), what).map(bytemuck::pod_read_unaligned)
    }

    /// Reads the next `count` values. Nothing is allocated unless the bytes are there.
    pub(crate) fn array<T: Pod>(&mut self, count: usize, what: &str) -> Result<Vec<T>, Problem> {
        let size = count.checked_mul(size_of::<T>()).ok_or_else(|| self.cut_short(count, what))?;
        let bytes = self.take(size, &format!("{what} ({count} values)"))?;
        let mut values: Vec<T> = with_room(count)?;
        values.resize(count, T::zeroed());
        bytemuck::cast_slice_mut(&mut values).copy_from_slice(bytes);
        Ok(values)
    }

    fn cut_short(&self, count: usize, what: &str) -> Problem {
        Problem::new(
            Place::Byte(self.at),
            format!("{what} names {count} values, more than the file can hold"),
        )
    }
}

/// Returns an empty vector with room for `count` values, or an error message if there is no memory for them.
pub(crate) fn with_room<T>(count: usize) -> Result<Vec<T>, Problem> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).map_err(|_| {
        let size = count.saturating_mul(size_of::<T>());
        Problem::limit(Place::Whole, format!("out of memory: the file needs {size} bytes; reduce it"))
    })?;
    Ok(values)
}

/// Opens a regular file, and returns its size [bytes].
///
/// # Errors
/// Returns an error if the file cannot be opened, or is no regular file: a pipe would wait for a writer, and a
/// device has no end.
pub(crate) fn open_regular(path: &Path) -> io::Result<(File, u64)> {
    let regular = |found: Metadata| match (found.is_file(), found.is_dir()) {
        (true, _) => Ok(found.len()),
        (_, true) => Err(io::Error::other("it is a folder; name a file in it")),
        _ => Err(io::Error::other("it is a pipe, a socket or a device; copy its content to a file")),
    };
    // Opening a pipe waits already, so the kind is checked before. It is checked again on the open file, which
    // may be another one by then.
    regular(std::fs::metadata(path)?)?;
    let file = File::open(path)?;
    let size = regular(file.metadata()?)?;
    Ok((file, size))
}

/// Reads a regular file of at most `limit` bytes; `None` if it is longer. The limit applies to the bytes that
/// are read, because the size of some files (in `/proc`, or growing ones) is not in their metadata.
///
/// # Errors
/// Returns an error if the file cannot be read; see [`open_regular`].
pub(crate) fn read_regular(path: &Path, limit: u64) -> io::Result<Option<Vec<u8>>> {
    let (file, size) = open_regular(path)?;
    if size > limit {
        return Ok(None);
    }
    let mut data = Vec::new();
    let out_of_memory = |_| io::Error::other(format!("out of memory: it has {size} bytes"));
    data.try_reserve_exact(usize::try_from(size).unwrap_or(usize::MAX)).map_err(out_of_memory)?;
    file.take(limit.saturating_add(1)).read_to_end(&mut data)?;
    Ok((data.len() as u64 <= limit).then_some(data))
}
