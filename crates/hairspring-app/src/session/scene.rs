//! Scenes that come and go: a file is opened, read, and begun at time 0.

use super::{Session, rouse};
use crate::{
    AppError,
    destination::settled,
    document::{Document, Way},
    player::{Order, STEP},
    reading::{Read, Reading, both},
};
use std::path::PathBuf;

/// Most scenes that are kept to go back to: texts, not hair.
const MOST_SCENES: usize = 8;

/// Scenes on one side of the open one.
type Scenes = fn(&mut Session) -> &mut Vec<Document>;

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

    /// Goes over to another document, if its scene can be read: a step as any other.
    pub(super) fn take(&mut self, mut document: Document) -> Result<(), AppError> {
        self.change_with(&mut document)?;
        self.before.push(document);
        let many = self.before.len().saturating_sub(MOST_SCENES);
        self.before.drain(..many);
        self.after.clear();
        Ok(())
    }

    /// Goes over to another document, if its scene can be read, and leaves this one in its place.
    fn change_with(&mut self, other: &mut Document) -> Result<(), AppError> {
        std::mem::swap(&mut self.document, other);
        let second = self.second.take();
        if let Err(why) = self.begin() {
            std::mem::swap(&mut self.document, other);
            self.second = second;
            return Err(why);
        }
        self.on_second = false;
        self.chosen = (0, 0);
        self.opened += 1;
        Ok(())
    }

    /// A step within the scene, and from its first or last to the scene that was open before or after it, as that was left.
    pub(super) fn step(&mut self, way: Way) -> Result<(), AppError> {
        let (back, forth) = self.edited().history();
        let (within, from, to): (_, Scenes, Scenes) = match way {
            Way::Back => (back, |session| &mut session.before, |session| &mut session.after),
            Way::Forth => (forth, |session| &mut session.after, |session| &mut session.before),
        };
        if !within
            && !self.on_second
            && let Some(mut document) = from(self).pop()
        {
            let changed = self.change_with(&mut document);
            // What cannot be read stays where it was: its files may come back.
            if changed.is_ok() { to(self) } else { from(self) }.push(document);
            return changed;
        }
        let change = self.edited_mut().step(way)?;
        self.follow(change);
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
        self.length = loaded.value.clip.as_ref().map(|clip| clip.duration()).filter(|d| *d > f64::from(STEP));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Action;

    #[test]
    fn undo_leads_back_to_the_scene_that_was_open_before() {
        let text = |style: &str| format!("[builtin]\nstyle = \"{style}\"\nstrands = 10\nguides = 5\n");
        let document = Document::new("scene.toml".as_ref(), text("wavy")).unwrap();
        let mut session = Session::new(document, 1, None, || ()).unwrap();
        let now = |session: &Session| session.document().text().to_owned();
        let act = |session: &mut Session, action| session.act(action).unwrap();
        act(
            &mut session,
            Action::Set("gravity".parse().unwrap(), Some([0.0, -1.0, 0.0].into_iter().collect())),
        );
        let left = now(&session);
        act(&mut session, Action::New(text("curly")));
        assert_eq!((now(&session), session.steps(), session.opened()), (text("curly"), (true, false), 1));
        act(&mut session, Action::Undo);
        assert_eq!((now(&session), session.steps(), session.opened()), (left.clone(), (true, true), 2));
        act(&mut session, Action::Redo);
        assert_eq!(now(&session), text("curly"));
        act(&mut session, Action::Undo);
        // Back in it, its own steps lead further back.
        act(&mut session, Action::Undo);
        assert_eq!((now(&session), session.steps()), (text("wavy"), (false, true)));
        act(&mut session, Action::Redo);
        assert_eq!(now(&session), left);
        // What is changed here leads to no other scene any more.
        act(&mut session, Action::Set("gravity".parse().unwrap(), None));
        assert_eq!(session.steps(), (true, false));
    }
}
