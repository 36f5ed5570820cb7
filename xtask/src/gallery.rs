//! The pictures of `docs/gallery.md`, from scenes that need no file from elsewhere.

use crate::run;

/// Each scene of `examples/scenes` and the frame that shows it, at 30 frames a second.
const SCENES: [(&str, u32); 7] = [
    ("head-turns", 66),
    ("ponytail-jumps", 60),
    ("fan", 90),
    ("balloon", 90),
    ("on-end", 90),
    ("hull", 60),
    ("sheet", 60),
];

/// Draws them all.
pub fn draw() -> Result<(), String> {
    let folder = "docs/pictures/gallery";
    std::fs::create_dir_all(folder).map_err(|why| format!("{folder}: {why}"))?;
    for (scene, frame) in SCENES {
        let (from, to) = (format!("examples/scenes/{scene}.toml"), format!("{folder}/{scene}.jpg"));
        let frame = frame.to_string();
        let render = ["run", "--release", "--quiet", "--", "render", &from, "-o", &to, "--frames", &frame];
        run::cargo(&[&render[..], &["--size", "640x480"]].concat(), &[])?;
    }
    Ok(())
}
