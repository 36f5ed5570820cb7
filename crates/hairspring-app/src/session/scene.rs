//! Opening, reading and starting scenes.

use super::{Session, rouse};
use crate::{
    AppError,
    document::{Document, Way},
    player::{Order, STEP},
    reading::{Read, Reading, both},
};

/// Maximum number of scenes in the undo history. Only their texts are kept, not their hair.
const MOST_SCENES: usize = 8;

/// The scenes before or after the open one.
type Scenes = fn(&mut Session) -> &mut Vec<Document>;

impl Session {
    /// Changes to another document as an undo step, if its scene can be read.
    pub(super) fn take(&mut self, mut document: Document) -> Result<(), AppError> {
        self.change_with(&mut document)?;
        self.before.push(document);
        let many = self.before.len().saturating_sub(MOST_SCENES);
        self.before.drain(..many);
        self.after.clear();
        Ok(())
    }

    /// Swaps the open document with another one, if its scene can be read.
    fn change_with(&mut self, other: &mut Document) -> Result<(), AppError> {
        std::mem::swap(&mut self.document, other);
        let (second, range) = (self.second.take(), self.range.take());
        if let Err(why) = self.begin() {
            std::mem::swap(&mut self.document, other);
            (self.second, self.range) = (second, range);
            return Err(why);
        }
        self.on_second = false;
        self.chosen = (0, 0);
        self.opened += 1;
        Ok(())
    }

    /// Takes an undo or redo step in the scene. From the first or last one it goes to the scene that was open
    /// before or after it, in the state in which that was left.
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
            // A scene that cannot be read stays in the history, because its files may come back.
            if changed.is_ok() { to(self) } else { from(self) }.push(document);
            return changed;
        }
        let change = self.edited_mut().step(way)?;
        self.follow(change);
        Ok(())
    }

    /// Reads the scene and the compared one, and starts at time 0.
    pub(super) fn begin(&mut self) -> Result<(), AppError> {
        let second = self.second.as_ref().map(Document::source);
        let read = both(&self.document.source(), second.as_ref())?;
        self.reading = None;
        self.play(read);
        Ok(())
    }

    /// Like [`Session::begin`], but in the background: the current scene plays until the new one is read.
    pub(super) fn begin_soon(&mut self) {
        match &mut self.reading {
            // Only one read at a time. It is restarted when it has finished.
            Some(reading) => reading.stale = true,
            None => {
                let wake = self.wake.clone();
                let second = self.second.as_ref();
                self.reading = Some(Reading::new(&self.document, second, self.threads, move || rouse(&wake)));
            }
        }
    }

    /// Receives the result of a background read.
    pub(super) fn poll_reading(&mut self) -> Option<AppError> {
        let outcome = self.reading.as_ref()?.outcome()?;
        if self.reading.take().is_some_and(|reading| reading.stale) {
            self.begin_soon();
            return None;
        }
        let why = outcome.map(|read| self.play(read)).err();
        // Settings may have changed during the read.
        self.retune();
        why
    }

    /// Starts the scenes that were read, at time 0.
    pub(super) fn play(&mut self, Read { first: loaded, second, files }: Read) {
        self.files = files;
        self.length = loaded.value.motion_duration().filter(|d| *d > f64::from(STEP));
        self.notes = loaded.notes;
        if self.check_range(self.range).is_err() {
            self.range = None;
            self.notes.push("the loop is the whole motion again, which is shorter than its range".into());
        }
        let joints = loaded.value.body.iter().flat_map(|body| &body.joints);
        self.joints = joints.map(|joint| joint.name.clone()).collect();
        (self.held, self.stopped) = (false, false);
        self.begun += 1;
        self.player.send(Order::Open(Box::new(loaded.value), second.map(|s| Box::new(s.value))));
        self.send_range();
        self.compare();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Action;

    #[test]
    fn undo_returns_to_the_previously_open_scene() {
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
        // After undo, the scene's own steps continue further back.
        act(&mut session, Action::Undo);
        assert_eq!((now(&session), session.steps()), (text("wavy"), (false, true)));
        act(&mut session, Action::Redo);
        assert_eq!(now(&session), left);
        // An edit here clears the later scenes.
        act(&mut session, Action::Set("gravity".parse().unwrap(), None));
        assert_eq!(session.steps(), (true, false));
    }
}
