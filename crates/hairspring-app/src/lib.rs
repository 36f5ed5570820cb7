//! The live window: hair simulated while it is looked at, touched and tuned.
//!
//! | file | what is in it |
//! | --- | --- |
//! | `document`, `effective`, `defaults` | the scene's text, edited in place; undo, save; what counts in it, and what would had nobody changed it |
//! | `destination` | where a file goes that a person names |
//! | `key`, `parameter`, `field` | names of its values; every parameter, and every field of a list's entries, with its unit, range and what it does |
//! | `edit` | what a parameter's new value writes, and where |
//! | `idle` | what does not count as the scene stands, and why |
//! | `differ` | what two scenes that are compared differ in |
//! | `player`, `snapshot` | the simulation on a thread of its own, and what that shows of a moment |
//! | `pushed`, `pulled` | a ball and a hand to push through hair, and how the pointer moves whatever it moves |
//! | `session`, `reading` | document and player together: whatever is done to them is an action; a scene that is read again meanwhile |
//! | `view`, `orbit`, `overlay`, `axes`, `ramp` | camera and tools, and what is laid over the picture |
//! | `handle`, `carried` | what can be taken in the picture, and where joints have carried it |
//! | `painter` | who draws the hair |
//! | `panel` | what stands around the picture |
//! | `record`, `letters`, `script` | files of what is seen, and words on them; a session line by line |
//! | `memory` | what is not needed any more goes back to the system |
//! | `app`, `desktop` | all of it in a window, and what is said where there can be none |
//!
//! Data goes one way: panels read the session and say actions, the session edits the document and tells the player, the player shows snapshots, a painter draws them.
//!
//! # Missing
//! A thumbnail shows no motion.

mod app;
mod axes;
mod carried;
mod defaults;
mod desktop;
mod destination;
mod differ;
mod document;
mod drag_limiter;
mod edit;
mod effective;
mod error;
mod field;
mod finger;
mod followers;
mod handle;
mod inactive_parameters;
mod key;
mod letters;
mod memory;
mod orbit;
mod overlay;
mod painter;
mod panel;
mod parameter;
mod player;
mod pointer_collider;
mod ramp;
mod reading;
mod record;
mod script;
mod session;
mod snapshot;
mod view;

pub use app::{App, Options};
pub use document::Document;
pub use drag_limiter::Push;
pub use error::AppError;
pub use painter::Drawn;
pub use pointer_collider::Pushed;
pub use script::Line;
pub use script::parse as read_script;
pub use session::{Action, Session};

use eframe::egui;

/// Size of the window when it opens [points].
const SIZE: [f32; 2] = [1360.0, 860.0];

/// Opens the window and stays until it is closed.
///
/// # Errors
/// If there is no desktop to open a window on, or a library of it is missing: what, and what to do.
pub fn run(options: Options) -> Result<(), AppError> {
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Hairspring")
            .with_app_id("hairspring")
            .with_inner_size(SIZE)
            .with_drag_and_drop(true),
        // The picture of the hair has its own; the rest is flat. Software drivers take as long for it as for the letters.
        dithering: false,
        ..Default::default()
    };
    let open = || {
        eframe::run_native(
            "Hairspring",
            native,
            Box::new(move |creation| Ok(Box::new(App::new(creation, options)?))),
        )
    };
    match desktop::without_library(open) {
        Ok(opened) => opened.map_err(|why| AppError::new(desktop::sentence(&why.to_string()))),
        Err(library) => Err(AppError::new(desktop::sentence(&library))),
    }
}
