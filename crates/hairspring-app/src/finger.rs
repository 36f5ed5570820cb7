//! The pointer of a script: what it does comes in where a person's would.

use eframe::egui::{self, Event, Modifiers, PointerButton, Pos2, RawInput};
use std::{
    collections::VecDeque,
    sync::{Arc, Mutex, PoisonError},
};

/// Events that are due, one batch a frame of the window.
#[derive(Clone, Default)]
pub struct Finger(Arc<Mutex<VecDeque<Vec<Event>>>>);

impl Finger {
    /// A finger on this window.
    pub fn new(ctx: &egui::Context) -> Self {
        let finger = Self::default();
        ctx.add_plugin(finger.clone());
        finger
    }

    fn due(&self) -> std::sync::MutexGuard<'_, VecDeque<Vec<Event>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Presses at `from`, goes to `to` in so many frames, and lets go.
    pub fn drag(&self, from: Pos2, to: Pos2, frames: u32) {
        let button = |pos, pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        let mut due = self.due();
        due.push_back(vec![Event::PointerMoved(from)]);
        due.push_back(vec![button(from, true)]);
        for k in 1..=frames {
            let share = k as f32 / frames as f32;
            due.push_back(vec![Event::PointerMoved(from + (to - from) * share)]);
        }
        due.push_back(vec![button(to, false)]);
        due.push_back(vec![Event::PointerGone]);
    }

    /// Whether nothing is due.
    pub fn rests(&self) -> bool {
        self.due().is_empty()
    }
}

impl egui::Plugin for Finger {
    fn debug_name(&self) -> &'static str {
        "finger"
    }

    fn input_hook(&mut self, ctx: &egui::Context, input: &mut RawInput) {
        if let Some(events) = self.due().pop_front() {
            input.events.extend(events);
            ctx.request_repaint();
        }
    }
}
