//! A cursor over a file's bytes. It trusts no count before it has checked that the bytes are there.

use crate::{Place, Problem};
use bytemuck::Pod;

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
        Ok(bytemuck::pod_collect_to_vec(bytes))
    }

    fn cut_short(&self, count: usize, what: &str) -> Problem {
        Problem::new(
            Place::Byte(self.at),
            format!("{what} names {count} values, more than the file can hold"),
        )
    }
}
