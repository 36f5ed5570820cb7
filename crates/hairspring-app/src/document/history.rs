//! Earlier texts of a scene, to go back to, and later ones; and which entry of a list is which in each of them.

use crate::AppError;
use std::collections::BTreeMap;

/// Most texts that are kept to go back to: at some kilobytes each, well under a megabyte.
const MOST_STEPS: usize = 200;

/// A text of the scene.
#[derive(Clone, Default)]
pub struct Draft {
    /// The text.
    pub text: String,
    /// By the list, which of the entries that the scene was opened with each is; none of these is one that was added. A list that is not there is as it was.
    entries: BTreeMap<String, Vec<Option<usize>>>,
}

impl Draft {
    /// The text that a scene is opened with.
    pub fn new(text: String) -> Self {
        Self { text, entries: BTreeMap::new() }
    }

    /// The same entries in another text.
    pub fn with(&self, text: String) -> Self {
        Self { text, entries: self.entries.clone() }
    }

    /// Another text, in which one more entry ends a list that had so many.
    pub fn added(&self, text: String, list: &str, had: usize) -> Self {
        let mut draft = self.with(text);
        draft.known(list, had).push(None);
        draft
    }

    /// Another text, from which an entry of a list that had so many has gone.
    pub fn removed(&self, text: String, list: &str, had: usize, place: usize) -> Self {
        let mut draft = self.with(text);
        draft.known(list, had).remove(place);
        draft
    }

    fn known(&mut self, list: &str, had: usize) -> &mut Vec<Option<usize>> {
        self.entries.entry(list.into()).or_insert_with(|| (0..had).map(Some).collect())
    }

    /// Which entry of the list the scene was opened with now stands at `place`; `None`: it was added since.
    pub fn first(&self, list: &str, place: usize) -> Option<usize> {
        match self.entries.get(list) {
            Some(known) => known.get(place).copied().flatten(),
            None => Some(place),
        }
    }
}

/// Which way a step leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// To what was before.
    Back,
    /// To what came after.
    Forth,
}

/// Texts before and after the one that counts.
#[derive(Default)]
pub struct History {
    back: Vec<Draft>,
    forth: Vec<Draft>,
}

impl History {
    /// After a new text nothing is to go forth to; `old` is to go back to, if it is a step of its own.
    pub fn follow(&mut self, old: Option<Draft>) {
        self.back.extend(old);
        let many = self.back.len().saturating_sub(MOST_STEPS);
        self.back.drain(..many);
        self.forth.clear();
    }

    /// The text that a step this way leads to.
    pub fn next(&self, way: Way) -> Option<&Draft> {
        match way {
            Way::Back => self.back.last(),
            Way::Forth => self.forth.last(),
        }
    }

    /// Takes the step, away from `left`.
    pub fn step(&mut self, way: Way, left: Draft) {
        let (from, to) = match way {
            Way::Back => (&mut self.back, &mut self.forth),
            Way::Forth => (&mut self.forth, &mut self.back),
        };
        from.pop();
        to.push(left);
    }

    /// Whether there is a text to go back to, and one to go forth to.
    pub fn has(&self) -> (bool, bool) {
        (!self.back.is_empty(), !self.forth.is_empty())
    }

    /// Rewrites every text, or none if one cannot be.
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
