//! The files of the open scenes: which must not be replaced, and which have unsaved changes.

use super::{Action, Session};
use crate::{
    AppError,
    document::{Document, Way, is_same_file, replaces_scene},
};
use hairspring_io::Inputs;
use std::path::{Path, PathBuf};

/// A side of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The scene on the left, or the only one.
    Left,
    /// The scene that it is compared with.
    Right,
}

impl Session {
    /// Refuses outputs that would replace a file of an open scene.
    pub fn keep_files(&self, outputs: impl IntoIterator<Item = PathBuf>) -> Result<(), AppError> {
        let scenes = self.documents().filter_map(Document::file).map(Path::to_owned);
        Inputs::keep(self.files.iter().cloned().chain(scenes), outputs).map_err(AppError::new)
    }

    /// Refuses to save the edited scene to a file that an open scene reads, except its own.
    pub(super) fn check_save(&self, path: &Path) -> Result<(), AppError> {
        let own = self.edited().file().is_some_and(|own| is_same_file(own, path));
        if own { Ok(()) } else { self.keep_files([path.to_owned()]) }
    }

    fn documents(&self) -> impl Iterator<Item = &Document> {
        std::iter::once(&self.document).chain(&self.second)
    }

    /// The document on this side.
    pub fn on(&self, side: Side) -> Option<&Document> {
        match side {
            Side::Left => Some(&self.document),
            Side::Right => self.second.as_ref(),
        }
    }

    /// The sides whose changes are not saved.
    pub fn unsaved(&self) -> Vec<Side> {
        let changed = |side: &Side| self.on(*side).is_some_and(Document::is_changed);
        [Side::Left, Side::Right].into_iter().filter(changed).collect()
    }

    /// The sides whose unsaved changes this action would lose.
    pub fn loses(&self, action: &Action) -> Vec<Side> {
        let right_only = match action {
            Action::New(_) | Action::Recover(_) => false,
            Action::Open(path) => !replaces_scene(path),
            Action::Compare(_) => true,
            Action::Undo if self.changes_scene(Way::Back) => true,
            Action::Redo if self.changes_scene(Way::Forth) => true,
            _ => return Vec::new(),
        };
        self.unsaved().into_iter().filter(|side| !right_only || *side == Side::Right).collect()
    }

    /// Whether an undo or redo step goes to the scene that was open before or after.
    fn changes_scene(&self, way: Way) -> bool {
        let (back, forth) = self.document.history();
        let (within, others) = match way {
            Way::Back => (back, &self.before),
            Way::Forth => (forth, &self.after),
        };
        !within && !self.on_second && !others.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "[builtin]\nstrands = 10\nguides = 5\n";

    fn session(text: String, folder: &Path) -> Session {
        let document = Document::new(&folder.join("scene.toml"), text).unwrap();
        Session::new(document, 1, None, || ()).unwrap()
    }

    fn gravity(session: &mut Session) {
        let value = [0.0, -1.0, 0.0].into_iter().collect();
        session.act(Action::Set("gravity".parse().unwrap(), Some(value))).unwrap();
    }

    #[test]
    fn files_of_the_open_scenes_are_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        let stone = "v 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
        std::fs::write(file("stone.obj"), stone).unwrap();
        let hull = "[[collider]]\nshape.hull = { file = \"stone.obj\", scale = 1.0 }\n";
        let mut session = session(format!("{HEAD}{hull}"), folder.path());
        let why = session.keep_files([file("new.obj"), file("stone.obj")]).unwrap_err().to_string();
        assert!(why.contains("stone.obj is an input file"), "{why}");
        // Only the left scene has the file now, and only the right one its own.
        session.act(Action::Compare(true)).unwrap();
        session.act(Action::Remove("collider", 0)).unwrap();
        assert!(
            session.keep_files([file("stone.obj")]).is_err() && session.keep_files([file("new.obj")]).is_ok()
        );
        session.act(Action::Save(Some(file("right.toml")))).unwrap();
        session.act(Action::Second(false)).unwrap();
        let why = session.act(Action::Save(Some(file("right.toml")))).unwrap_err().to_string();
        assert!(why.contains("right.toml is an input file"), "{why}");
        session.act(Action::Save(Some(file("left.toml")))).unwrap();
        session.act(Action::Save(Some(file("left.toml")))).unwrap();
    }

    #[test]
    fn the_selected_scene_is_saved_and_the_right_one_is_not_lost() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        let mut session = session(HEAD.into(), folder.path());
        session.act(Action::Save(Some(file("left.toml")))).unwrap();
        session.act(Action::Compare(true)).unwrap();
        assert_eq!(session.loses(&Action::Compare(false)), []);
        gravity(&mut session);
        assert_eq!(session.unsaved(), [Side::Right]);
        for action in [Action::Compare(false), Action::New(HEAD.into()), Action::Open("b.glb".into())] {
            assert_eq!(session.loses(&action), [Side::Right], "{action:?}");
        }
        let why = session.act(Action::Save(None)).unwrap_err().to_string();
        assert!(why.contains("no file yet"), "the right scene is written to the file of the left one: {why}");
        session.act(Action::Save(Some(file("right.toml")))).unwrap();
        assert_eq!(session.unsaved(), []);
        let text = |name: &str| std::fs::read_to_string(file(name)).unwrap();
        assert_eq!((text("left.toml").as_str(), text("right.toml").contains("gravity")), (HEAD, true));
        session.act(Action::Second(false)).unwrap();
        gravity(&mut session);
        session.act(Action::Save(None)).unwrap();
        assert!(text("left.toml").contains("gravity"));
        // Undo into the scene that was open before closes the comparison.
        session.act(Action::New(HEAD.into())).unwrap();
        session.act(Action::Compare(true)).unwrap();
        gravity(&mut session);
        assert_eq!(session.loses(&Action::Undo), []);
        session.act(Action::Second(false)).unwrap();
        assert_eq!(session.loses(&Action::Undo), [Side::Right]);
    }
}
