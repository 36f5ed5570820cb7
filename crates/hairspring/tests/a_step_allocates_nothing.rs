//! Promise: no allocation in `step` after the first.
//!
//! A counting allocator around the system's; one thread, because a thread pool's own queues are not the simulation's.

use hairspring::{
    neighbours::Neighbours,
    scene::{self, Solver, Volume, VolumeMethod, bench::Bench},
};
use std::{
    alloc::{GlobalAlloc, Layout, System},
    sync::atomic::{AtomicUsize, Ordering},
};

struct Counting;

static COUNT: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is passed on to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promises are the system allocator's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn after_the_first_step_none_allocates() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let volumes = VolumeMethod::ALL.map(|method| (method, false));
    for (method, on) in volumes.into_iter().chain([(VolumeMethod::Off, true)]) {
        let counted = pool.install(|| {
            let mut bench = Bench::new(200, 16, Solver::default());
            bench.simulation.set_volume(&Volume { method, ..Volume::default() });
            let meet = scene::Neighbours { on, ..scene::Neighbours::default() };
            bench.neighbours = Neighbours::new(&meet, &[&bench.simulation]);
            bench.step();
            let before = COUNT.load(Ordering::Relaxed);
            for _ in 0..20 {
                bench.step();
            }
            COUNT.load(Ordering::Relaxed) - before
        });
        assert_eq!(
            counted,
            0,
            "{counted} allocations in 20 steps, hair on hair {}, strand by strand {on}",
            method.name()
        );
    }
}
