//! What the left button does: the tools, with their keys and what each does.

use eframe::egui;

/// Half of a hand's width, over the length of its fingers' reach.
pub const FINGERS: f32 = 2.0;

/// What the left button does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hand {
    /// Turns the view.
    #[default]
    Look,
    /// Takes hold of a lock and pulls.
    Grab,
    /// Pushes a ball through the hair.
    Ball,
    /// Drags the head.
    Head,
    /// Picks a strand.
    Pick,
    /// Goes through the hair with spread fingers.
    Comb,
    /// Strokes it with an open hand.
    Palm,
}

impl Hand {
    /// Whether it has a radius.
    pub fn reaches(self) -> bool {
        matches!(self, Self::Ball | Self::Grab | Self::Comb)
    }

    /// All of them, with their names, keys and what they do.
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
