//! Scenes that come and go: a file is opened, read, and begun at time 0.

use super::{Session, rouse};
use crate::{
    AppError,
    destination::settled,
    document::Document,
    player::{Order, STEP},
    reading::{Read, Reading, both},
};
use std::path::PathBuf;

impl Session {
    /// Opens a file: a scene; or a groom or a body, which are put in a scene of their own, or in place of the open one's.
    pub(super) fn open(&mut self, path: &std::path::Path) -> Result<(), AppError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let whole = settled(path);
        let name = toml::Value::String(whole.to_string_lossy().into_owned());
        let document = match extension.as_str() {
            "toml" => Document::open(&whole)?,
            "hair" | "tfx" | "data" => {
                let text = format!("[[groom]]\nfile = {name}\nmaterial = \"wavy\"\n");
                Document::new(&folder().join("scene.toml"), text)?
            }
            "obj" | "glb" | "gltf" | "tfxmesh" => {
                let text = self.document.with_body(&name.to_string())?;
                Document::new(&self.base(), text)?
            }
            "bvh" => {
                let text = self.document.with_motion(&name.to_string())?;
                Document::new(&self.base(), text)?
            }
            _ => {
                return Err(AppError::new(format!(
                    "{} is no scene (.toml), groom (.hair, .tfx, .data), body (.glb, .gltf, .obj, .tfxmesh) or motion (.bvh)",
                    path.display()
                )));
            }
        };
        self.take(document)
    }

    /// Goes over to another document, if its scene can be read.
    pub(super) fn take(&mut self, document: Document) -> Result<(), AppError> {
        let old = std::mem::replace(&mut self.document, document);
        let second = self.second.take();
        if let Err(why) = self.begin() {
            (self.document, self.second) = (old, second);
            return Err(why);
        }
        self.on_second = false;
        self.chosen = (0, 0);
        Ok(())
    }

    /// Where files are named from.
    pub(super) fn base(&self) -> PathBuf {
        self.document.file().map_or_else(|| folder().join("scene.toml"), PathBuf::from)
    }

    /// Reads the scene, and the second, and begins at time 0.
    pub(super) fn begin(&mut self) -> Result<(), AppError> {
        let read = both(&self.document, self.second.as_ref())?;
        self.reading = None;
        self.play(read);
        Ok(())
    }

    /// As [`Session::begin`], but for who waits: what plays goes on until it is read.
    pub(super) fn begin_soon(&mut self) {
        match &mut self.reading {
            // One reader at a time: it is begun again when it comes to its end.
            Some(reading) => reading.stale = true,
            None => {
                let wake = self.wake.clone();
                let second = self.second.as_ref();
                self.reading = Some(Reading::new(&self.document, second, self.threads, move || rouse(&wake)));
            }
        }
    }

    /// Takes up what has been read meanwhile.
    pub(super) fn hear(&mut self) -> Option<AppError> {
        let outcome = self.reading.as_ref()?.outcome()?;
        if self.reading.take().is_some_and(|reading| reading.stale) {
            self.begin_soon();
            return None;
        }
        let why = outcome.map(|read| self.play(read)).err();
        // Settings may have changed while it was read.
        self.retune();
        why
    }

    /// Begins what was read at time 0.
    pub(super) fn play(&mut self, (loaded, second): Read) {
        self.length = loaded.value.clip.as_ref().map(|clip| clip.duration()).filter(|d| *d > STEP);
        self.notes = loaded.notes;
        let joints = loaded.value.body.iter().flat_map(|body| &body.joints);
        self.joints = joints.map(|joint| joint.name.clone()).collect();
        self.held = false;
        self.begun += 1;
        self.player.tell(Order::Open(Box::new(loaded.value), second.map(|s| Box::new(s.value))));
        self.tell_length();
        self.compare();
    }
}

/// The folder that scenes without a file are in.
pub(super) fn folder() -> PathBuf {
    std::env::current_dir().unwrap_or_default()
}
