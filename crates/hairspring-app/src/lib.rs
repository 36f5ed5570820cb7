//! The live window: hair simulated while it is looked at, touched and tuned.
//!
//! | file | what is in it |
//! | --- | --- |
//! | `document`, `effective` | the scene's text, edited in place; undo, save; what counts in it |
//! | `key`, `parameter`, `field` | names of its values; every parameter, and every field of a list's entries, with its unit, range and what it does |
//! | `differ` | what two scenes that are compared differ in |
//! | `player`, `snapshot` | the simulation on a thread of its own, and what that shows of a moment |
//! | `session` | document and player together: whatever is done to them is an action |
//! | `view`, `orbit`, `overlay`, `axes`, `ramp` | camera and tools, and what is laid over the picture |
//! | `handle`, `carried` | what can be taken in the picture, and where joints have carried it |
//! | `painter` | who draws the hair |
//! | `panel` | what stands around the picture |
//! | `record`, `letters`, `script` | files of what is seen, and words on them; a session line by line |
//! | `app` | all of it in a window |
//!
//! Data goes one way: panels read the session and say actions, the session edits the document and tells the player, the player shows snapshots, a painter draws them.
//!
//! # Missing
//! A thumbnail shows no motion.

mod app;
mod axes;
mod carried;
mod differ;
mod document;
mod effective;
mod error;
mod field;
mod finger;
mod handle;
mod key;
mod letters;
mod orbit;
mod overlay;
mod painter;
mod panel;
mod parameter;
mod player;
mod ramp;
mod record;
mod script;
mod session;
mod snapshot;
mod view;

pub use app::{App, Options};
pub use document::Document;
pub use error::AppError;
pub use painter::Drawn;
pub use script::Line;
pub use script::parse as read_script;
pub use session::{Action, Session};

use eframe::egui;
use std::sync::Arc;

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
        ..Default::default()
    };
    let open = || {
        eframe::run_native(
            "Hairspring",
            native,
            Box::new(move |creation| Ok(Box::new(App::new(creation, options)?))),
        )
    };
    match without_library(open) {
        Ok(opened) => opened.map_err(|why| {
            AppError::new(format!(
                "no window could be opened: {why} (on Linux it takes libvulkan1 and a driver such as mesa-vulkan-drivers, libxcursor1, libxi6, \
                 libx11-xcb1 and libxkbcommon-x11-0)"
            ))
        }),
        Err(library) => Err(AppError::new(format!(
            "no window could be opened: {library} (on Debian: apt install libxkbcommon-x11-0 libxkbcommon0 libx11-xcb1)"
        ))),
    }
}

/// Runs `open`; an error where a library of the desktop is missing, which the window's library says by a panic. Other panics go on.
fn without_library<R>(open: impl FnOnce() -> R) -> Result<R, String> {
    const SIGN: &str = "could not be loaded";
    let usual: Arc<dyn Fn(&std::panic::PanicHookInfo<'_>) + Send + Sync> = Arc::from(std::panic::take_hook());
    let other = usual.clone();
    std::panic::set_hook(Box::new(move |panic| {
        if !panic.payload_as_str().is_some_and(|what| what.contains(SIGN)) {
            other(panic);
        }
    }));
    let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(open));
    std::panic::set_hook(Box::new(move |panic| usual(panic)));
    outcome.map_err(|panic| {
        let what =
            panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
        match what.filter(|what| what.contains(SIGN)) {
            Some(what) => what.trim_end_matches('.').to_owned(),
            None => std::panic::resume_unwind(panic),
        }
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_missing_library_is_a_sentence() {
        let missing = super::without_library(|| panic!("Library libxkbcommon-x11.so could not be loaded."));
        assert_eq!(missing, Err::<(), _>("Library libxkbcommon-x11.so could not be loaded".into()));
        assert_eq!(super::without_library(|| 3), Ok(3));
    }
}
