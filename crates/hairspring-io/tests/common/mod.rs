//! Locates the real data files.

use std::path::PathBuf;

/// The path of a real data file, or `None` after printing the reason where the data is missing.
pub fn data(relative: &str) -> Option<PathBuf> {
    let root = std::env::var_os("HAIRSPRING_DATA").map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")),
        PathBuf::from,
    );
    let path = root.join(relative);
    if path.exists() {
        return Some(path);
    }
    println!("skipped: {relative} is not under {} (set HAIRSPRING_DATA)", root.display());
    None
}
