//! The files of the book.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// The folder of the book.
pub fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

pub fn read(file: &Path) -> String {
    fs::read_to_string(file).unwrap_or_else(|why| panic!("{}: {why}", file.display()))
}

/// All files with this extension in a folder and its subfolders, in order.
pub fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap_or_else(|why| panic!("{}: {why}", folder.display())) {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path, extension));
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The pages of parameters, `docs/parameters/GROUP/NAME.md`.
pub fn parameter_pages() -> Vec<PathBuf> {
    let folder = docs().join("parameters");
    files(&folder, "md").into_iter().filter(|page| page.parent() != Some(&folder)).collect()
}

/// Whether this page of `docs/parameters` is the page of a group.
pub fn is_a_group(page: &Path) -> bool {
    page.parent() == Some(&docs().join("parameters")) && !page.ends_with("index.md")
}

/// The name of a page without its extension.
pub fn name_of(page: &Path) -> &str {
    page.file_name().unwrap().to_str().unwrap().trim_end_matches(".md")
}
