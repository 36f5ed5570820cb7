//! Random presses, drags, keys and scrolls, anywhere in the window: nothing panics, nothing turns non-finite, the simulation lives, and memory does not grow. `HAIRSPRING_MONKEY=SECONDS` lets it play longer
//! than the short time of the test (`cargo xtask monkey` for ten minutes).

mod support;

use egui_kittest::Harness;
use hairspring_app::App;
use hairspring_view as _;
use std::time::{Duration, Instant};
use support::{SMALL, sound, until, window};

/// A small generator (SplitMix64): the same monkey every time.
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

    /// One thing.
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

/// Memory of the process [bytes]; `None` where the system does not say.
fn memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|l| l.starts_with("VmRSS:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? * 1024)
}

#[test]
fn a_monkey_breaks_nothing() {
    let seconds = std::env::var("HAIRSPRING_MONKEY").ok().and_then(|s| s.parse().ok()).unwrap_or(10);
    // What the monkey presses may write files: into a folder of its own.
    let folder = tempfile::tempdir().unwrap();
    std::env::set_current_dir(folder.path()).unwrap();
    let mut window = window(folder.path(), SMALL, "wait 3");
    assert!(until(&mut window, |app| app.is_idle()));
    let mut monkey = Monkey(1);
    let (began, mut at_a_minute, mut at_first) = (Instant::now(), None, None);
    let limit = Duration::from_secs(seconds);
    let mut acts = 0;
    while began.elapsed() < limit {
        monkey.act(&mut window);
        window.step();
        assert!(sound(window.state()), "after {acts} acts");
        assert!(!window.state().session().is_dead(), "the simulation ended after {acts} acts");
        acts += 1;
        if at_a_minute.is_none() && began.elapsed() > Duration::from_secs(60) {
            at_a_minute = memory();
        }
        // What there is room for once is not a leak: from a third of the time on, it counts.
        if at_first.is_none() && began.elapsed() > limit / 3 {
            at_first = memory();
        }
    }
    let mib = |bytes: Option<u64>| bytes.map_or("-".into(), |b| (b >> 20).to_string());
    println!(
        "{acts} acts in {seconds} s; memory {} MiB after a minute, {} after a third, {} at the end",
        mib(at_a_minute),
        mib(at_first),
        mib(memory())
    );
    if let (Some(first), Some(last)) = (at_first, memory()) {
        assert!(last < first + (300 << 20), "memory grew from {first} to {last} bytes");
    }
}
