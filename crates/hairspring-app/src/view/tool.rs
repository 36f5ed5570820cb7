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
            "Drag to turn the view; with Shift or the middle button, to move it. The wheel zooms. The right button turns the view with every tool.",
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
            "Drag to push a ball through the hair. The slider sets its radius.",
        ),
        (Self::Head, "Head", egui::Key::Num4, "Drag the head. It returns when you release it."),
        (Self::Pick, "Pick", egui::Key::Num5, "Press on a strand to show its values."),
        (
            Self::Comb,
            "Comb",
            egui::Key::Num6,
            "Drag spread fingers through the hair. They carry strands sideways, and slide along them.",
        ),
        (
            Self::Palm,
            "Hand",
            egui::Key::Num7,
            "Drag to stroke the hair with an open hand. The palm faces the head, and the fingers point across the stroke.",
        ),
    ];
}
