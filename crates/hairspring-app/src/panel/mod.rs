//! The panels around the picture. Each shows the state of the session and returns the user's input as
//! actions.

pub mod control;
pub mod files;
pub mod folder;
pub mod graphs;
pub mod help;
pub mod inspect;
pub mod keys;
pub mod list;
pub mod number;
pub mod parameters;
pub mod presets;
pub mod recovered;
pub mod timeline;
pub mod transport;
pub mod wind;

use eframe::egui::{self, Rect, RectAlign, Tooltip, Ui, accesskit::Role};

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

/// Tooltips of the rows of a panel.
pub trait TipBeside {
    /// Shows a tooltip to the left or right of the panel, so that it covers no other row.
    fn tip_beside(self, ui: &Ui, text: &str) -> Self;
}

impl TipBeside for egui::Response {
    fn tip_beside(self, ui: &Ui, text: &str) -> Self {
        // Screen readers read it too, as the description of a widget, and as the name of one that has none.
        if self.ctx.has_accesskit_node(self.id) {
            self.ctx.accesskit_node_builder(self.id, |node| {
                node.set_description(text);
                let named = node.label().is_some_and(|label| !label.is_empty());
                if node.role() != Role::Label && node.labelled_by().is_empty() && !named {
                    node.set_label(text);
                }
            });
        }
        // Under the question of a modal window, no tooltip may cover it.
        if !self.ctx.memory(|memory| memory.is_above_modal_layer(self.layer_id)) {
            return self;
        }
        let row = Rect::from_x_y_ranges(ui.clip_rect().x_range(), self.rect.y_range());
        for mut tooltip in [Tooltip::for_enabled(&self), Tooltip::for_disabled(&self)] {
            let alignments = [RectAlign::LEFT_END, RectAlign::RIGHT_START, RectAlign::RIGHT_END];
            let popup = tooltip.popup.anchor(row).align(RectAlign::LEFT_START);
            tooltip.popup = popup.align_alternatives(&alignments);
            tooltip.show(|ui| {
                // Otherwise the automatic size shrinks a tooltip whose text changes.
                ui.set_max_width(ui.spacing().tooltip_width);
                ui.label(text);
            });
        }
        self
    }
}
