//! The tools of the left mouse button, with their keys and descriptions.

use eframe::egui;

/// Half of a comb's width, relative to the reach of its tines.
pub const FINGERS: f32 = 2.0;

/// A tool of the left mouse button.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Rotates the view.
    #[default]
    Look,
    /// Grabs a lock and pulls it.
    Grab,
    /// Pushes a sphere through the hair.
    Ball,
    /// Drags the head.
    Head,
    /// Picks a strand.
    Pick,
    /// Combs the hair with spread fingers.
    Comb,
    /// Strokes the hair with an open hand.
    Palm,
}

impl Tool {
    /// Whether the tool has a radius.
    pub fn reaches(self) -> bool {
        matches!(self, Self::Ball | Self::Grab | Self::Comb)
    }

    /// All tools, with their names, keys and descriptions.
    pub const ALL: [(Self, &'static str, egui::Key, &'static str); 7] = [
        (
            Self::Look,
            "Look",
            egui::Key::Num1,
            "Drag to turn; with Shift or the middle button to move; wheel to come nearer. The right button turns with every tool.",
        ),
        (
            Self::Grab,
            "Grab",
            egui::Key::Num2,
            "Press on hair to take hold of a lock, drag to pull, release to let go.",
        ),
        (
            Self::Ball,
            "Ball",
            egui::Key::Num3,
            "Drag to push a ball through the hair; it is as large as its slider says.",
        ),
        (Self::Head, "Head", egui::Key::Num4, "Drag the head; it comes back when it is let go of."),
        (Self::Pick, "Pick", egui::Key::Num5, "Press on a strand to see its numbers."),
        (
            Self::Comb,
            "Comb",
            egui::Key::Num6,
            "Drag spread fingers through the hair: it goes with them across itself, and slides through along itself.",
        ),
        (
            Self::Palm,
            "Hand",
            egui::Key::Num7,
            "Drag to stroke the hair with an open hand: its palm is turned to the head, its fingers across the stroke.",
        ),
    ];
}
