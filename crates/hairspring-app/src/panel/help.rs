//! The list of keyboard shortcuts, shown with `?`.

use crate::view::Tool;
use eframe::egui;

/// Keys and their functions.
const KEYS: [(&str, &str); 17] = [
    ("Space", "play or pause"),
    ("Right", "the next frame, while paused"),
    ("Left", "the cached frame before, while paused"),
    ("R", "reset to time 0"),
    ("F", "frame hair and head"),
    ("L", "let the camera move along with the hair, or not"),
    ("C", "compare two settings on the same motion"),
    ("G", "graphs"),
    ("P", "presets"),
    ("Tab", "hide or show the panels"),
    ("Ctrl Z, Ctrl Shift Z", "undo, redo"),
    ("Ctrl O, Ctrl S", "open, save"),
    ("F12", "record a still"),
    ("Home", "return the head to its place"),
    ("?", "this list"),
    ("Esc", "close what is open; forget the picked strand"),
    ("drag a blue dot", "set the wind; move, turn or resize an object"),
];

/// Width of the descriptions [points].
const WIDTH: f32 = 420.0;

/// Shows the list.
pub fn show(ctx: &egui::Context, open: &mut bool) {
    let window = egui::Window::new("Keys").open(open).resizable(false).collapsible(false);
    window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO).show(ctx, |ui| {
        egui::ScrollArea::vertical().show(ui, |ui| {
            egui::Grid::new("keys").num_columns(2).striped(true).show(ui, |ui| {
                for (key, what) in KEYS {
                    ui.monospace(key);
                    ui.label(what);
                    ui.end_row();
                }
                for (_, name, key, tip) in Tool::ALL {
                    ui.monospace(key.name());
                    ui.vertical(|ui| {
                        ui.set_width(WIDTH);
                        ui.label(format!("{name}: {tip}"));
                    });
                    ui.end_row();
                }
            });
        });
    });
}
