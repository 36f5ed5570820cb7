//! System requirements of the window. A missing one is reported in one sentence and never causes a panic.

use std::sync::Arc;

/// Shared libraries that the window's own dependencies load at startup, and their Debian packages. Not every
/// system needs all of them; they are only checked after a failure.
const LIBRARIES: &[(&str, &str)] = if cfg!(target_os = "linux") {
    &[
        ("libX11.so.6", "libx11-6"),
        ("libX11-xcb.so.1", "libx11-xcb1"),
        ("libxcb.so.1", "libxcb1"),
        ("libXcursor.so.1", "libxcursor1"),
        ("libXi.so.6", "libxi6"),
        ("libxkbcommon.so.0", "libxkbcommon0"),
        ("libxkbcommon-x11.so.0", "libxkbcommon-x11-0"),
        ("libwayland-client.so.0", "libwayland-client0"),
        ("libvulkan.so.1", "libvulkan1 mesa-vulkan-drivers"),
        ("libEGL.so.1", "libegl1"),
    ]
} else {
    &[]
};

/// Returns the message for a window that could not be opened for this reason.
pub fn sentence(why: &str) -> String {
    message_of(why, &missing(LIBRARIES))
}

fn message_of(why: &str, missing: &[&(&str, &str)]) -> String {
    let why = plain(why);
    let (names, packages): (Vec<&str>, Vec<&str>) = missing.iter().copied().copied().unzip();
    match names[..] {
        [] => format!("no window could be opened: {why}"),
        _ => format!(
            "no window could be opened: {why}; not found: {} (on Debian: apt install {})",
            names.join(", "),
            packages.join(" ")
        ),
    }
}

/// Returns the entries of `libraries` that the system does not have.
fn missing<'a>(libraries: &'a [(&'a str, &'a str)]) -> Vec<&'a (&'a str, &'a str)> {
    // SAFETY: the window has just tried to load the same libraries by the same names, so loading them runs only
    // the initializers that run in every window.
    let found = |name: &str| unsafe { libloading::Library::new(name) }.is_ok();
    libraries.iter().filter(|(name, _)| !found(name)).collect()
}

/// Removes the source location from a reason, as in `os error at mod.rs:788: no such thing`.
fn plain(why: &str) -> &str {
    if why.contains("for any enabled backend") {
        return "no graphics driver draws on this desktop";
    }
    let after = why.rsplit_once(".rs:").map_or(why, |(_, after)| {
        after.trim_start_matches(|c: char| c.is_ascii_digit() || c == ':').trim_start()
    });
    after.trim_end_matches('.')
}

/// Runs `open`. If a library of the desktop is missing, which the window's dependency reports by a panic,
/// this returns an error. Other panics continue.
pub fn without_library<R>(open: impl FnOnce() -> R) -> Result<R, String> {
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
            Some(what) => what.to_owned(),
            None => std::panic::resume_unwind(panic),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_library_is_reported_as_an_error() {
        let missing = without_library(|| panic!("Library libxkbcommon-x11.so could not be loaded."));
        assert_eq!(missing, Err::<(), _>("Library libxkbcommon-x11.so could not be loaded.".into()));
        assert_eq!(without_library(|| 3), Ok(3));
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn missing_libraries_are_reported_with_their_package_and_without_a_source_location() {
        let libraries = [("libc.so.6", "libc6"), ("libnosuch.so.9", "libnosuch9")];
        let missing = missing(&libraries);
        assert_eq!(missing, [&("libnosuch.so.9", "libnosuch9")]);
        let why = "winit EventLoopError: os error at /home/a/winit/linux/mod.rs:788: Failed to load one of xlib's shared libraries";
        assert_eq!(
            message_of(why, &missing),
            "no window could be opened: Failed to load one of xlib's shared libraries; not found: libnosuch.so.9 (on Debian: apt install libnosuch9)"
        );
        assert_eq!(message_of("no seat.", &[]), "no window could be opened: no seat");
    }
}
