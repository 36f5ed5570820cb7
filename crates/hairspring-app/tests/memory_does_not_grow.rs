//! Memory does not grow: a scene that is opened leaves nothing of the one before, and what that took goes back to the system.

#[path = "support/memory.rs"]
mod memory;
mod support;

use support::{SMALL, until, window};

/// How much more may be kept that nobody uses [bytes]. Were nothing given back, it would be twice as much.
const KEPT: usize = 48 << 20;

#[test]
fn scenes_that_are_opened_one_after_the_other_take_no_more_than_one() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("again.toml");
    std::fs::write(&file, SMALL).unwrap();
    let open = format!("open {}\nwait 3\n", file.display());
    // In use, and what is held besides, once the window stands still after so many openings [bytes].
    let after = |openings: usize| {
        let script = format!("wait 3\n{}pause\nwait 1\n", open.repeat(openings));
        let mut window = window(folder.path(), SMALL, &script);
        assert!(until(&mut window, |app| app.is_idle()));
        // The picture of a moment that stands still is drawn in full; what was left behind goes a second after.
        let kept = || memory::resident().map_or(0, |held| held.saturating_sub(memory::in_use()));
        let began = std::time::Instant::now();
        assert!(until(&mut window, |_| began.elapsed().as_secs() >= 3));
        (memory::in_use(), kept())
    };
    let (one, first) = after(1);
    let (many, last) = after(8);
    // Snapshots are made as they are needed, some more or fewer.
    assert!(many < one + (24 << 20), "{many} bytes are in use after 8 openings, and {one} after one");
    assert!(last < first + KEPT, "{last} bytes are kept after 8 openings, and {first} after one");
}
