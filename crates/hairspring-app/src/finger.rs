//! The pointer of a script. It creates the same input events as that of a user.

use eframe::egui::{self, Event, Modifiers, PointerButton, Pos2, RawInput};
use std::{
    collections::VecDeque,
    sync::{Arc, Mutex, PoisonError},
};

/// The pending events of the pointer.
#[derive(Default)]
struct Move {
    /// Events to send, one batch per frame of the window.
    due: VecDeque<Vec<Event>>,
    /// Final position.
    at: Pos2,
}

/// A pointer that a script moves.
#[derive(Clone, Default)]
pub struct Finger(Arc<Mutex<Move>>);

fn button(pos: Pos2, pressed: bool) -> Event {
    Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
}

impl Finger {
    /// Creates the pointer of this window.
    pub fn new(ctx: &egui::Context) -> Self {
        let finger = Self::default();
        ctx.add_plugin(finger.clone());
        finger
    }

    fn moves(&self) -> std::sync::MutexGuard<'_, Move> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Presses at `from` and moves to `to` in `frames` frames.
    pub fn hold(&self, from: Pos2, to: Pos2, frames: u32) {
        let mut moves = self.moves();
        moves.due.push_back(vec![Event::PointerMoved(from)]);
        moves.due.push_back(vec![button(from, true)]);
        for k in 1..=frames {
            let share = k as f32 / frames as f32;
            moves.due.push_back(vec![Event::PointerMoved(from + (to - from) * share)]);
        }
        moves.at = to;
    }

    /// Releases the button.
    pub fn release(&self) {
        let mut moves = self.moves();
        let at = moves.at;
        moves.due.push_back(vec![button(at, false)]);
        moves.due.push_back(vec![Event::PointerGone]);
    }

    /// Whether no event is pending.
    pub fn rests(&self) -> bool {
        self.moves().due.is_empty()
    }
}

impl egui::Plugin for Finger {
    fn debug_name(&self) -> &'static str {
        "finger"
    }

    fn input_hook(&mut self, ctx: &egui::Context, input: &mut RawInput) {
        let events = self.moves().due.pop_front();
        if let Some(events) = events {
            input.events.extend(events);
            ctx.request_repaint();
        }
    }
}
