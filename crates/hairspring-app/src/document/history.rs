//! The undo history of a scene: earlier and later texts, and the identity of list entries in each of them.

use crate::AppError;
use std::collections::BTreeMap;

/// Maximum number of texts in the undo history. At a few kilobytes each, they take less than a megabyte.
const MOST_STEPS: usize = 200;

/// A text of the scene.
#[derive(Clone, Default)]
pub struct Draft {
    /// The text.
    pub text: String,
    /// For each list, the original index of every entry, or `None` for entries that were added since the
    /// scene was opened. A list without a record is unchanged.
    entries: BTreeMap<String, Vec<Option<usize>>>,
}

impl Draft {
    /// Creates the draft of a scene that was just opened.
    pub fn new(text: String) -> Self {
        Self { text, entries: BTreeMap::new() }
    }

    /// Returns a draft with another text and the same entries.
    pub fn with(&self, text: String) -> Self {
        Self { text, entries: self.entries.clone() }
    }

    /// Returns a draft with another text, in which an entry was appended to a list that had `had` entries.
    pub fn added(&self, text: String, list: &str, had: usize) -> Self {
        let mut draft = self.with(text);
        draft.known(list, had).push(None);
        draft
    }

    /// Returns a draft with another text, in which the entry at `place` was removed from a list that had
    /// `had` entries.
    pub fn removed(&self, text: String, list: &str, had: usize, place: usize) -> Self {
        let mut draft = self.with(text);
        draft.known(list, had).remove(place);
        draft
    }

    fn known(&mut self, list: &str, had: usize) -> &mut Vec<Option<usize>> {
        self.entries.entry(list.into()).or_insert_with(|| (0..had).map(Some).collect())
    }

    /// Returns the original index of the entry that is now at `place`, or `None` if it was added since.
    pub fn first(&self, list: &str, place: usize) -> Option<usize> {
        match self.entries.get(list) {
            Some(known) => known.get(place).copied().flatten(),
            None => Some(place),
        }
    }
}

/// Direction of a step in the history.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Undo.
    Back,
    /// Redo.
    Forth,
}

/// The texts before and after the current one.
#[derive(Default)]
pub struct History {
    back: Vec<Draft>,
    forth: Vec<Draft>,
}

impl History {
    /// Records a new text. This clears the redo texts. `old` is added to the undo texts, if the change is a
    /// step of its own.
    pub fn follow(&mut self, old: Option<Draft>) {
        self.back.extend(old);
        let many = self.back.len().saturating_sub(MOST_STEPS);
        self.back.drain(..many);
        self.forth.clear();
    }

    /// The text that a step in this direction leads to.
    pub fn next(&self, way: Way) -> Option<&Draft> {
        match way {
            Way::Back => self.back.last(),
            Way::Forth => self.forth.last(),
        }
    }

    /// Takes the step; `left` is the text before it.
    pub fn step(&mut self, way: Way, left: Draft) {
        let (from, to) = match way {
            Way::Back => (&mut self.back, &mut self.forth),
            Way::Forth => (&mut self.forth, &mut self.back),
        };
        from.pop();
        to.push(left);
    }

    /// Whether undo is possible, and whether redo is.
    pub fn has(&self) -> (bool, bool) {
        (!self.back.is_empty(), !self.forth.is_empty())
    }

    /// Rewrites every text, or none if one of them fails.
    pub fn rename(&mut self, rename: impl Fn(&str) -> Result<String, AppError>) -> Result<(), AppError> {
        let all = |drafts: &[Draft]| {
            drafts
                .iter()
                .map(|draft| Ok(draft.with(rename(&draft.text)?)))
                .collect::<Result<Vec<_>, AppError>>()
        };
        (self.back, self.forth) = (all(&self.back)?, all(&self.forth)?);
        Ok(())
    }
}
