//! Every promise of `PROMISES.md` names a test that exists, and every test file that begins with a promise is named
//! there.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

/// Checks the table against the files of the repository.
pub fn check() -> Result<(), String> {
    let table = fs::read_to_string("PROMISES.md").map_err(|e| format!("PROMISES.md: {e}"))?;
    let named = named(&table, Path::new("."))?;
    let (mut promised, mut missing) = (0, Vec::new());
    for file in rust_files(Path::new("crates"))? {
        let is_test = file.components().any(|part| part.as_os_str() == "tests");
        if is_test && read(&file)?.starts_with("//! Promise: ") {
            promised += 1;
            if !named.contains(&file) {
                missing.push(file.display().to_string());
            }
        }
    }
    if !missing.is_empty() {
        return Err(format!("PROMISES.md does not name {}", missing.join(", ")));
    }
    println!("PROMISES.md: {} tests are named, {promised} test files begin with a promise", named.len());
    Ok(())
}

/// Returns the files and folders that the table names. Each must exist and have a test.
fn named(table: &str, root: &Path) -> Result<BTreeSet<PathBuf>, String> {
    let mut named = BTreeSet::new();
    for row in table.lines().filter(|line| line.starts_with("| **")) {
        let (promise, holder) = row.trim_end_matches(" |").rsplit_once(" | ").ok_or("a row has one cell")?;
        let promise = promise.split("**").nth(1).unwrap_or_default();
        let mut names = holder.split('`').skip(1).step_by(2).peekable();
        if names.peek().is_none() {
            return Err(format!("'{promise}' names no test"));
        }
        for name in names.filter(|name| !name.starts_with("cargo xtask ")) {
            if !name.contains('/') {
                return Err(format!("'{promise}': {name} has no folder"));
            }
            let of_root = root.join(name).exists();
            let path = if of_root { PathBuf::from(name) } else { Path::new("crates").join(name) };
            if !has_test(&root.join(&path)).map_err(|why| format!("'{promise}': {why}"))? {
                return Err(format!("'{promise}': {} has no test", path.display()));
            }
            named.insert(path);
        }
    }
    if named.is_empty() { Err("PROMISES.md has no promise".into()) } else { Ok(named) }
}

/// Returns whether a file, or any file in a folder, has a test or a fuzz target.
fn has_test(path: &Path) -> Result<bool, String> {
    let files = if path.is_dir() { rust_files(path)? } else { vec![path.to_owned()] };
    for file in files {
        let text = read(&file)?;
        if ["#[test]", "proptest! {", "fuzz_target!", "\ndef test_"].iter().any(|mark| text.contains(mark)) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Returns all Rust files in a folder and its subfolders.
fn rust_files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let (mut files, mut folders) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))? {
            let path = entry.map_err(|e| e.to_string())?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    Ok(files)
}

fn read(file: &Path) -> Result<String, String> {
    fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

    #[test]
    fn names_are_paths_of_tests() {
        let row =
            "| **A promise**: it holds. | `hairspring/tests/api/examples_run.rs`, `fuzz/fuzz_targets` |";
        let found = named(row, Path::new(ROOT)).unwrap();
        let expected =
            ["crates/hairspring/tests/api/examples_run.rs", "fuzz/fuzz_targets"].map(PathBuf::from);
        assert!(found.iter().eq(&expected), "{found:?}");
    }

    #[test]
    fn missing_tests_are_refused() {
        for (holder, part) in [
            ("`hairspring/tests/api/none.rs`", "none.rs"),
            ("`hairspring/src/lib.rs`", "has no test"),
            ("`examples_run.rs`", "has no folder"),
            ("the same", "names no test"),
            ("unit tests", "names no test"),
        ] {
            let error = named(&format!("| **A promise** | {holder} |"), Path::new(ROOT)).unwrap_err();
            assert!(error.contains(part), "{holder}: {error}");
        }
    }
}
