//! Where the real files lie.

use std::path::PathBuf;

/// The path of a real file, or `None` with the reason printed where the data is not there.
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
