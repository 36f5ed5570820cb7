//! The live window: hair can be viewed, touched and tuned while it is simulated.
//!
//! | module | content |
//! | --- | --- |
//! | `document`, `effective`, `defaults` | the scene's text, edited in place; undo, save; its effective values, reference values and defaults |
//! | `destination` | paths of files to be written |
//! | `key`, `parameter`, `field` | keys of values; every parameter and every field of list entries, with unit, range and description |
//! | `edit` | how a new value of a parameter is written |
//! | `inactive_parameters` | parameters without effect in the current scene, and why |
//! | `differ` | differences between two compared scenes |
//! | `player`, `snapshot` | the simulation on its own thread, and its state at one moment |
//! | `pointer_collider`, `drag_limiter` | a sphere and a hand to push through hair, and the limits of what the pointer moves |
//! | `session`, `reading` | document and player together, controlled by actions; reading a scene in the background |
//! | `view`, `orbit`, `overlay`, `axes`, `ramp` | camera, tools and overlays |
//! | `handle`, `carried` | handles in the picture, and the current transforms of objects |
//! | `painter` | the renderers of the hair |
//! | `panel` | the panels around the picture |
//! | `bake` | groom files of a frame or of many |
//! | `record`, `side_by_side`, `letters`, `script` | recordings, compared pictures and text on them; scripted sessions |
//! | `text` | counts with their noun, shortened names |
//! | `recovery` | unsaved changes, kept for a crash |
//! | `memory` | returns unused memory to the system |
//! | `app`, `desktop` | the window, and the message if it cannot open |
//!
//! Data flows in one direction: panels read the session and return actions, the session edits the document
//! and sends orders to the player, the player publishes snapshots, and a painter draws them.
//!
//! # Limitations
//! A thumbnail shows no motion.

mod app;
mod axes;
mod bake;
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
mod recovery;
mod script;
mod session;
mod side_by_side;
mod snapshot;
mod text;
mod view;

pub use app::{App, Options};
pub use differ::{Difference, captions_of, scene_differences};
pub use document::{Document, set_in_text, text_in_folder};
pub use drag_limiter::Push;
pub use error::AppError;
pub use painter::Drawn;
pub use pointer_collider::Pushed;
pub use recovery::recovery_folder;
pub use script::{Script, VERBS, Verb};
pub use session::{Action, Session};
pub use side_by_side::SideBySide;
pub use snapshot::Snapshot;

use eframe::egui;
use std::sync::atomic::Ordering::Relaxed;

/// Initial size of the window [points].
const SIZE: [f32; 2] = [1360.0, 860.0];

/// Minimum size of the window [points].
const MIN_SIZE: [f32; 2] = [640.0, 480.0];

/// How a window was closed.
pub struct Ended {
    /// Number of errors that lines of the script caused. Each was printed to standard error with the number of
    /// its line.
    pub script_errors: usize,
}

/// Why a window did not open.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RunError {
    /// The scene or one of its files cannot be read.
    #[error("{0}")]
    Scene(String),
    /// There is no desktop, or one of its libraries is missing.
    #[error("{0}")]
    Window(String),
}

/// Opens the window and returns when it is closed.
///
/// # Errors
/// Returns an error if the scene cannot be read, if there is no desktop, or if one of its libraries is missing.
/// The error names the missing library and the package to install.
pub fn run(options: Options) -> Result<Ended, RunError> {
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Hairspring")
            .with_app_id("hairspring")
            .with_inner_size(SIZE)
            .with_min_inner_size(MIN_SIZE)
            .with_drag_and_drop(true),
        // The hair's picture has its own dithering, and the rest is flat. Software drivers take as long for
        // dithering as for the text.
        dithering: false,
        ..Default::default()
    };
    let errors = options.script_errors.clone();
    let open = || {
        eframe::run_native(
            "Hairspring",
            native,
            Box::new(move |creation| Ok(Box::new(App::new(creation, options)?))),
        )
    };
    match desktop::without_library(open) {
        Ok(Ok(())) => Ok(Ended { script_errors: errors.load(Relaxed) }),
        Ok(Err(eframe::Error::AppCreation(why))) if why.is::<AppError>() => {
            Err(RunError::Scene(why.to_string()))
        }
        Ok(Err(why)) => Err(RunError::Window(desktop::sentence(&why.to_string()))),
        Err(library) => Err(RunError::Window(desktop::sentence(&library))),
    }
}
