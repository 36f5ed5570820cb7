//! The panels around the picture. Each shows the state of the session and returns the user's input as
//! actions.

pub mod control;
pub mod files;
pub mod help;
pub mod inspect;
pub mod keys;
pub mod list;
pub mod parameters;
pub mod presets;
pub mod transport;
pub mod wind;

use eframe::egui::{self, Ui};

/// Labels a widget for screen readers and scripts.
pub trait Labelled {
    /// Sets the label.
    fn labelled(self, ui: &Ui, name: &str) -> Self;
}

impl Labelled for egui::Response {
    fn labelled(self, ui: &Ui, name: &str) -> Self {
        ui.ctx().accesskit_node_builder(self.id, |node| node.set_label(name));
        self
    }
}
