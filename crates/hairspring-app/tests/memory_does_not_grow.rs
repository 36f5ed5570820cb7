//! Promise: memory does not grow. Opening a scene frees the previous one, and the freed memory returns to
//! the system.

#[path = "support/memory.rs"]
mod memory;
mod support;

use support::{SMALL, until, window};

/// The largest allowed growth of memory that is held but not in use [bytes]. Without returning memory to
/// the system, the growth would be twice as large.
const KEPT: usize = 48 << 20;

#[test]
fn reopening_a_scene_does_not_increase_memory() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("again.toml");
    std::fs::write(&file, SMALL).unwrap();
    let open = format!("open {}\nwait 3\n", file.display());
    // Memory in use, and memory held beyond that, after this number of openings, once the window is idle
    // [bytes].
    let memory_after = |openings: usize| {
        let script = format!("wait 3\n{}pause\nwait 1\n", open.repeat(openings));
        let mut window = window(folder.path(), SMALL, &script);
        assert!(until(&mut window, |app| app.is_idle()));
        // An idle window renders the picture at full quality. Discarded memory is returned one second
        // later.
        let kept = || memory::resident().map_or(0, |held| held.saturating_sub(memory::in_use()));
        let began = std::time::Instant::now();
        assert!(until(&mut window, |_| began.elapsed().as_secs() >= 3));
        (memory::in_use(), kept())
    };
    let (one, first) = memory_after(1);
    let (many, last) = memory_after(8);
    // Snapshots are allocated on demand, so their number varies a little.
    assert!(many < one + (24 << 20), "in use: {many} bytes after 8 openings, {one} after one");
    assert!(last < first + KEPT, "held beyond use: {last} bytes after 8 openings, {first} after one");
}
