//! The window without a desktop: frames run one after another, and the picture is rendered on the CPU.
#![allow(dead_code)] // Each test uses a part of this module.

use egui_kittest::{Harness, TestRenderer};
use hairspring_app::{App, Document, Drawn, Options, Script};
use std::{
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

/// A head that is quick to simulate and to draw.
pub const SMALL: &str = "name = \"Small\"\n\n[builtin]\nstrands = 400\nguides = 60\n";

/// A renderer that discards all textures. Without it, a window that is never drawn would keep every picture
/// of hair.
struct Blind;

impl TestRenderer for Blind {
    fn handle_delta(&mut self, delta: &mut egui::TexturesDelta) {
        delta.clear();
    }
}

/// Opens the window on this scene, in a folder, with a script.
pub fn window(folder: &Path, scene: &str, script: &str) -> Harness<'static, App> {
    window_with(folder, scene, script, None)
}

/// Like [`window`], and keeps unsaved changes in the folder `recovery`.
pub fn window_with(
    folder: &Path,
    scene: &str,
    script: &str,
    recovery: Option<PathBuf>,
) -> Harness<'static, App> {
    let document = Document::new(&folder.join("scene.toml"), scene.into()).expect("the scene can be read");
    let options = Options {
        document: Some(document),
        script: Script::parse("script", script).expect("the script can be read"),
        drawn: Drawn::Cpu,
        recovery,
        ..Options::default()
    };
    Harness::builder()
        .with_size([960.0, 640.0])
        .renderer(Blind)
        .build_eframe(|creation| App::new(creation, options).expect("the window opens"))
}

/// Runs frames until `done` or until 120 seconds have passed; returns whether it was done.
pub fn until(window: &mut Harness<'static, App>, done: impl Fn(&App) -> bool) -> bool {
    let began = Instant::now();
    while began.elapsed() < Duration::from_secs(120) {
        window.step();
        if done(window.state()) {
            return true;
        }
        // Other threads simulate and render.
        std::thread::sleep(Duration::from_millis(2));
    }
    false
}

/// Whether all simulated points are finite.
pub fn sound(app: &App) -> bool {
    app.session()
        .latest()
        .is_none_or(|snapshot| snapshot.stages.iter().all(|s| s.points().flatten().all(|p| p.is_finite())))
}

/// A file that is dropped on the window.
#[derive(Debug)]
pub struct Dropped(pub PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|why| why.to_string())
    }
}
