//! Notes about animations whose first key is not at their begin.

use super::sampling::Sampling;

/// Time of a first key from which on the pause before it is noted [s]: programs begin at frame 1.
const PAUSE: f32 = 0.1;

/// Time before 0 s that is due to rounding [s].
const ROUNDING: f32 = 1e-3;

/// Animations whose first key is late or before 0 s.
#[derive(Default)]
pub(super) struct Late {
    /// A sentence about the first that waits for its first key, and the number of others.
    held: Option<(String, usize)>,
    /// The same of those that begin at their first key.
    cut: Option<(String, usize)>,
    /// The same of those with keys before 0 s.
    early: Option<(String, usize)>,
}

impl Late {
    /// Adds an animation with its first key at `first` [s].
    pub(super) fn add(&mut self, name: &str, first: f32, sampling: &Sampling) {
        if (-ROUNDING..PAUSE).contains(&first) {
            return;
        }
        let has_key = format!("animation {name:?} has its first key at {first:.2} s");
        let (slot, text) = if first < 0.0 {
            (&mut self.early, format!("{has_key} and begins there, at frame 1; move its keys to 0 s"))
        } else if sampling.start < first {
            let frame = (f64::from(first) * sampling.rate).round();
            (
                &mut self.held,
                format!(
                    "{has_key} and stands still until then; to skip this, set `start = {frame}` in [clip]"
                ),
            )
        } else {
            (
                &mut self.cut,
                format!(
                    "{has_key} and begins there, because the time before it is too long to be kept; move its keys to 0 s"
                ),
            )
        };
        match slot {
            Some((_, others)) => *others += 1,
            None => *slot = Some((text, 0)),
        }
    }

    pub(super) fn note(self, notes: &mut Vec<String>) {
        for (text, others) in [self.held, self.cut, self.early].into_iter().flatten() {
            notes.push(match others {
                0 => text,
                n => format!("{text} ({n} other animations are like this)"),
            });
        }
    }
}
