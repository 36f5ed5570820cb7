//! The choice of one of the motions of a file.

use crate::{Character, load::list};
use hairspring::body::Clip;

/// Names of motions that a note lists.
const LISTED: usize = 12;

/// Returns the index of the clip called `name`, ignoring case, or of the first if `name` is `None`. The error lists
/// the available names.
pub(crate) fn pick_clip(clips: &[Clip], name: Option<&str>) -> Result<usize, String> {
    let found = match name {
        Some(name) => clips.iter().position(|c| c.name.eq_ignore_ascii_case(name)),
        None => (!clips.is_empty()).then_some(0),
    };
    found.ok_or_else(|| {
        let known = clip_names(clips);
        match name {
            Some(name) => format!("there is no motion called {name:?}; available: {}", list(&known)),
            None => "the file holds no motion; export it with its animations, or name another file".into(),
        }
    })
}

/// A note if the first of several clips is used because no name was given.
pub(crate) fn first_note(clips: &[Clip], name: Option<&str>) -> Option<String> {
    let [first, others @ ..] = clips else { return None };
    (name.is_none() && !others.is_empty()).then(|| {
        format!(
            "the file has {} motions, and the first, {:?}, is used; set `name` to use another: {}",
            clips.len(),
            first.name,
            names(&clip_names(others))
        )
    })
}

/// Returns a note that the motions of a file are not played; `None` for a file without motions. `motions` holds their names.
/// `end` completes the sentence, such as with the remedy.
pub(crate) fn unplayed_note(motions: &[&str], end: &str) -> Option<String> {
    (!motions.is_empty()).then(|| {
        let (word, are) = if motions.len() == 1 { ("motion", "is") } else { ("motions", "are") };
        let (count, names) = (motions.len(), names(motions));
        format!("the file has {count} {word} ({names}), which {are} not played{end}")
    })
}

impl Character {
    /// Returns a note that its motions are not played; `None` if it has none. `end` completes the sentence, such as with the
    /// remedy.
    pub fn unplayed_note(&self, end: &str) -> Option<String> {
        let mut motions = clip_names(&self.clips);
        motions.extend(self.vertex_cache.as_ref().map(|_| OF_VERTICES));
        unplayed_note(&motions, end)
    }
}

/// What notes call the motion of vertices, which has no name.
pub(crate) const OF_VERTICES: &str = "that of its vertices";

/// The names of clips.
pub(crate) fn clip_names(clips: &[Clip]) -> Vec<&str> {
    clips.iter().map(|clip| clip.name.as_str()).collect()
}

/// A list of names, up to a number.
fn names(all: &[&str]) -> String {
    let listed = &all[..all.len().min(LISTED)];
    match all.len() - listed.len() {
        0 => list(listed),
        more => format!("{} and {more} more", list(listed)),
    }
}
