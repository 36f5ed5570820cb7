//! Starts the simulation again after its thread ended by an internal error. The document is not affected.

use super::{Session, new_player};
use crate::{AppError, player::Order};

impl Session {
    /// If the simulation thread has ended, starts another one with the same scene, paused at time 0. A scene
    /// whose start ended the thread is not started again before it is changed. Returns the message for the user.
    pub fn restart_if_dead(&mut self) -> Option<AppError> {
        let why = self.player.failure()?;
        let started = self.player.latest().is_some_and(|snapshot| snapshot.scene == self.begun);
        self.player = new_player(self.threads, self.card.clone(), self.begun, &self.wake);
        (self.playing, self.held) = (false, false);
        self.player.send(Order::Speed(self.speed));
        self.player.send(Order::Show(self.show));
        // A scene that is being read at this moment is started when it is read.
        let next = if self.reading.is_some() {
            "the next scene is about to start"
        } else if started {
            self.begin_soon();
            "it starts again, paused at time 0"
        } else {
            self.stopped = true;
            "it starts again after the next change of the scene: undo the last one, or open another scene"
        };
        Some(AppError::new(format!(
            "the simulation ended by an internal error ({why}), and {next}. The scene and its changes are \
             kept; please report the error with the scene"
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{document::Document, session::Action, snapshot::Snapshot};
    use std::sync::Arc;

    const TEXT: &str = "[builtin]\nstrands = 10\nguides = 5\n";

    fn session() -> Session {
        Session::new(Document::new("scene.toml".as_ref(), TEXT.into()).unwrap(), 1, None, || ()).unwrap()
    }

    fn wait<R>(session: &mut Session, mut done: impl FnMut(&mut Session) -> Option<R>) -> R {
        let mut tries = (0..12_000).map(|_| {
            std::thread::sleep(std::time::Duration::from_millis(5));
            assert_eq!(session.error(), None);
            done(session)
        });
        tries.find_map(|result| result).expect("it did not happen within a minute")
    }

    fn shown(session: &mut Session) -> Arc<Snapshot> {
        wait(session, |session| session.latest().filter(|s| s.scene == session.begun()))
    }

    fn gravity(session: &mut Session) {
        let value = [0.0, -1.0, 0.0].into_iter().collect();
        session.act(Action::Set("gravity".parse().unwrap(), Some(value))).unwrap();
    }

    #[test]
    fn after_a_panic_the_simulation_starts_again_and_the_document_is_kept() {
        let mut session = session();
        gravity(&mut session);
        shown(&mut session);
        let (text, before) = (session.document().text().to_owned(), session.begun());
        session.player.send(Order::Panic);
        let why = wait(&mut session, Session::restart_if_dead).to_string();
        assert!(why.contains("a test wants it") && why.contains("starts again, paused"), "{why}");
        let snapshot = shown(&mut session);
        assert_eq!((snapshot.step, snapshot.scene), (0, before + 1));
        assert_eq!((session.document().text(), session.playing()), (&*text, false));
        assert!(session.document().is_changed() && session.steps().0, "changes and undo are lost");
        session.act(Action::Play(true)).unwrap();
        wait(&mut session, |session| session.latest().filter(|s| s.step > 3));
        assert_eq!(session.restart_if_dead(), None);
    }

    #[test]
    fn a_scene_that_ends_the_simulation_at_its_start_restarts_after_a_change() {
        let mut session = session();
        shown(&mut session);
        // The thread ends before it shows the scene that is opened next.
        session.player.send(Order::Panic);
        session.act(Action::New(TEXT.replace("10", "11"))).unwrap();
        let why = wait(&mut session, Session::restart_if_dead).to_string();
        assert!(why.contains("after the next change"), "{why}");
        std::thread::sleep(std::time::Duration::from_millis(50));
        assert!(session.latest().is_none() && !session.is_dead());
        gravity(&mut session);
        shown(&mut session);
    }
}
