//! Promise: random input breaks nothing. After random presses, drags, keys and scrolls anywhere in the
//! window, nothing panics, no value is non-finite, the simulation still runs, and memory does not grow.
//! Memory is compared in the first scene, which is reopened after a third of the time and at the end.
//! `HAIRSPRING_MONKEY=SECONDS` runs the test for longer than the short default (`cargo xtask monkey` for
//! ten minutes).

#[path = "support/memory.rs"]
mod memory;
mod support;

use egui_kittest::{Harness, kittest::Queryable};
use hairspring_app::App;
use hairspring_view as _;
use std::{
    path::Path,
    sync::Arc,
    time::{Duration, Instant},
};
use support::{Dropped, SMALL, sound, until, window};

/// A small random generator (SplitMix64) with a fixed seed, so that every run is the same.
struct Monkey(u64);

impl Monkey {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    fn place(&mut self) -> egui::Pos2 {
        egui::pos2(self.below(960) as f32, self.below(640) as f32)
    }

    /// Performs one random action.
    fn act(&mut self, window: &mut Harness<'static, App>) {
        use egui::{Event, Key, Modifiers, PointerButton};
        let at = self.place();
        let button =
            [PointerButton::Primary, PointerButton::Secondary, PointerButton::Middle][self.below(3) as usize];
        let press = |pos, pressed| Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE };
        match self.below(10) {
            0..=3 => {
                window.event(Event::PointerMoved(at));
                window.event(press(at, true));
                window.event(press(at, false));
            }
            4..=6 => {
                let to = self.place();
                window.event(Event::PointerMoved(at));
                window.event(press(at, true));
                for k in 1..=4 {
                    window.event(Event::PointerMoved(at + (to - at) * (k as f32 / 4.0)));
                }
                window.event(press(to, false));
            }
            7 => {
                let delta = egui::vec2(0.0, self.below(200) as f32 - 100.0);
                window.event(Event::PointerMoved(at));
                window.event(Event::MouseWheel {
                    unit: egui::MouseWheelUnit::Point,
                    delta,
                    phase: egui::TouchPhase::Move,
                    source: egui::MouseWheelSource::Unknown,
                    modifiers: Modifiers::NONE,
                });
            }
            8 => {
                let keys = [
                    Key::Space,
                    Key::R,
                    Key::F,
                    Key::C,
                    Key::G,
                    Key::P,
                    Key::Tab,
                    Key::Num1,
                    Key::Num2,
                    Key::Num3,
                    Key::Num4,
                    Key::Num5,
                    Key::Num6,
                    Key::Num7,
                    Key::Escape,
                    Key::ArrowRight,
                    Key::Home,
                ];
                window.key_press(keys[self.below(keys.len() as u64) as usize]);
            }
            _ => {
                let key = [Key::Z, Key::Y][self.below(2) as usize];
                window.key_press_modifiers(Modifiers::COMMAND, key);
            }
        }
    }
}

/// The largest allowed growth of memory in use [bytes]. Snapshots of a scene are allocated on demand, so
/// their number varies a little.
const MORE_IN_USE: usize = 32 << 20;
/// The largest allowed growth of memory held by the process [bytes], which includes fragmentation.
const MORE_HELD: usize = 96 << 20;

/// Reopens the first scene; returns the memory in use and the memory held by the process [bytes].
fn home(window: &mut Harness<'static, App>, folder: &Path) -> [usize; 2] {
    let file = folder.join("home.toml");
    // The random input may have overwritten this file.
    std::fs::write(&file, SMALL).unwrap();
    window.input_mut().dropped_files.push(Arc::new(Dropped(file)));
    window.step();
    window.step();
    // The random input has changed the scene, and perhaps the one that it is compared with.
    while let Some(button) = window.query_by_label("Don't save") {
        button.click();
        (0..3).for_each(|_| window.step());
    }
    let there = |app: &App| {
        let session = app.session();
        session.document().text() == SMALL && session.latest().is_some_and(|s| s.scene == session.begun())
    };
    assert!(until(window, there), "the scene was not reopened");
    // Memory of the previous scene is freed one second later, and a picture in progress uses some
    // meanwhile. So the minimum over several seconds is taken.
    let (began, mut least) = (Instant::now(), [usize::MAX; 2]);
    while began.elapsed() < Duration::from_secs(10) {
        window.step();
        let now = [memory::in_use(), memory::resident().unwrap_or(0)];
        least = [0, 1].map(|k| least[k].min(now[k]));
        std::thread::sleep(Duration::from_millis(5));
    }
    least
}

#[test]
fn random_actions_keep_the_session_valid() {
    let seconds = std::env::var("HAIRSPRING_MONKEY").ok().and_then(|s| s.parse().ok()).unwrap_or(10);
    // Random input may write files, so it runs in a folder of its own.
    let folder = tempfile::tempdir().unwrap();
    std::env::set_current_dir(folder.path()).unwrap();
    let mut window = window(folder.path(), SMALL, "wait 3");
    assert!(until(&mut window, |app| app.is_idle()));
    let mut monkey = Monkey(1);
    let (began, mut first) = (Instant::now(), None);
    let limit = Duration::from_secs(seconds);
    let (mut acts, mut most) = (0, 0);
    while began.elapsed() < limit {
        monkey.act(&mut window);
        window.step();
        assert!(sound(window.state()), "after {acts} actions");
        assert!(!window.state().session().is_dead(), "the simulation ended after {acts} actions");
        acts += 1;
        most = most.max(memory::resident().unwrap_or(0));
        // Memory that is allocated once and kept is not a leak. So the comparison starts after a third of
        // the time.
        if first.is_none() && began.elapsed() > limit / 3 {
            first = Some(home(&mut window, folder.path()));
        }
    }
    let last = home(&mut window, folder.path());
    let [first, last, [most, _]] =
        [first.unwrap_or(last), last, [most, 0]].map(|bytes| bytes.map(|b| b >> 20));
    println!(
        "{acts} actions in {seconds} s; in the first scene {} MiB are in use and {} held after a third, {} and {} at the end; \
         the maximum held in any scene is {most}",
        first[0], first[1], last[0], last[1]
    );
    assert!(
        last[0] <= first[0] + (MORE_IN_USE >> 20),
        "memory in use grew from {} MiB to {}",
        first[0],
        last[0]
    );
    assert!(last[1] <= first[1] + (MORE_HELD >> 20), "memory held grew from {} MiB to {}", first[1], last[1]);
}
