//! The files that a scene or groom was read from, and their checksums.

use crate::observe_files;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use std::{
    cell::RefCell,
    collections::{BTreeMap, HashSet},
    fs::File,
    io::{self, Read},
    path::{Path, PathBuf},
    rc::Rc,
};

/// Length and checksum of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Checksum {
    /// Length [bytes].
    pub bytes: u64,
    /// SHA-256 in hexadecimal, as `sha256sum` prints it.
    pub sha256: String,
}

impl Checksum {
    pub fn of_bytes(bytes: &[u8]) -> Self {
        Self { bytes: bytes.len() as u64, sha256: hexadecimal(Sha256::digest(bytes).as_slice()) }
    }

    pub fn of_file(path: &Path) -> io::Result<Self> {
        let mut file = File::open(path)?;
        let (mut hash, mut bytes, mut part) = (Sha256::new(), 0, vec![0; 1 << 20]);
        loop {
            match file.read(&mut part)? {
                0 => return Ok(Self { bytes, sha256: hexadecimal(hash.finalize().as_slice()) }),
                n => {
                    hash.update(&part[..n]);
                    bytes += n as u64;
                }
            }
        }
    }
}

fn hexadecimal(hash: &[u8]) -> String {
    hash.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The files that were read, and their checksums.
#[derive(Clone, Debug, Default)]
pub struct Inputs(BTreeMap<String, Checksum>);

impl Inputs {
    /// Returns the checksums by the names of the files.
    pub(crate) fn into_checksums(self) -> BTreeMap<String, Checksum> {
        self.0
    }

    /// The names of the files and their SHA-256 in hexadecimal.
    pub fn checksums(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(name, checksum)| (name.as_str(), checksum.sha256.as_str()))
    }

    /// The paths of the files that the scene or groom `main` consists of.
    pub fn paths(&self, main: &Path) -> impl Iterator<Item = PathBuf> {
        let folder = main.parent().unwrap_or(Path::new("")).to_owned();
        self.0.keys().map(move |name| folder.join(name))
    }

    /// Refuses outputs that would replace one of the files `inputs`, such as those of [`Inputs::paths`].
    ///
    /// # Errors
    /// Returns a sentence that names the first such output.
    pub fn keep(
        inputs: impl IntoIterator<Item = PathBuf>,
        outputs: impl IntoIterator<Item = PathBuf>,
    ) -> Result<(), String> {
        let inputs: HashSet<PathBuf> =
            inputs.into_iter().filter_map(|path| path.canonicalize().ok()).collect();
        // A file that does not exist yet replaces nothing.
        let replaced =
            outputs.into_iter().find(|path| path.canonicalize().is_ok_and(|path| inputs.contains(&path)));
        match replaced {
            Some(path) => Err(format!(
                "{} is an input file and would be replaced; choose another name for the output",
                path.display()
            )),
            None => Ok(()),
        }
    }

    /// Names of files that both have read with different content.
    #[must_use]
    pub fn changed(&self, other: &Self) -> Vec<String> {
        let differs =
            |(name, checksum): &(&String, &Checksum)| other.0.get(*name).is_some_and(|c| c != *checksum);
        self.0.iter().filter(differs).map(|(name, _)| name.clone()).collect()
    }

    /// Calls `read`, which reads the scene or groom `main`, and records all files that it reads.
    pub fn record<T>(main: &Path, read: impl FnOnce() -> T) -> (T, Self) {
        let folder = main.parent().unwrap_or(Path::new("")).to_owned();
        let inputs = Rc::new(RefCell::new(Self::default()));
        let sink = inputs.clone();
        let observe = move |path: &Path, content: &[u8]| {
            let name = path.strip_prefix(&folder).unwrap_or(path).display().to_string();
            sink.borrow_mut().0.entry(name).or_insert_with(|| Checksum::of_bytes(content));
        };
        let result = observe_files(observe, read);
        (result, inputs.take())
    }

    /// The same for the scene `main` whose text is `text`, which may not be saved.
    pub fn record_text<T>(main: &Path, text: &str, read: impl FnOnce() -> T) -> (T, Self) {
        let (result, mut inputs) = Self::record(main, read);
        let name = main.file_name().unwrap_or_default().to_string_lossy().into_owned();
        inputs.0.insert(name, Checksum::of_bytes(text.as_bytes()));
        (result, inputs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_output_does_not_replace_an_input() {
        let folder = tempfile::tempdir().unwrap();
        let [groom, other, new] = ["a.hair", "b.hair", "c.hair"].map(|name| folder.path().join(name));
        [&groom, &other].into_iter().for_each(|path| std::fs::write(path, "").unwrap());
        let keep = |outputs: &[&Path]| Inputs::keep([groom.clone()], outputs.iter().map(|p| p.to_path_buf()));
        assert_eq!(keep(&[&other, &new]), Ok(()));
        // By another name too.
        let around = folder.path().join("no/../a.hair");
        std::fs::create_dir(folder.path().join("no")).unwrap();
        for output in [&groom, &around] {
            let why = keep(&[&new, output]).unwrap_err();
            assert!(why.contains("a.hair is an input file"), "{why}");
        }
    }

    #[test]
    fn checksums_are_those_of_sha256sum() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("abc");
        std::fs::write(&path, "abc").unwrap();
        let known = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(Checksum::of_file(&path).unwrap(), Checksum { bytes: 3, sha256: known.into() });
        assert_eq!(Checksum::of_bytes(b"abc").sha256, known);
    }
}
