//! Actions of a user, a script or a random test.

use crate::{drag_limiter::Push, key::Key, parameter::Parameter, recovery::FoundScene};
use glam::Vec3;
use hairspring_scene::stage::Value;
use std::path::PathBuf;
use toml_edit::Value as Toml;

/// An action.
#[derive(Clone, Debug)]
pub enum Action {
    /// Plays or pauses.
    Play(bool),
    /// Advances by one step.
    Step,
    /// Returns to time 0.
    Reset,
    /// Sets the playback speed in scene seconds per second.
    Speed(f32),
    /// Sets whether the motion, or its range, repeats.
    Repeat(bool),
    /// Sets the first and the last frame of the loop, counted from 0 at time 0; `None`: the whole motion.
    Range(Option<(u64, u64)>),
    /// Pauses, and goes to the cached frame that is nearest to this one.
    Seek(u64),
    /// Writes a parameter; `None` restores its default.
    Parameter(&'static Parameter, Option<Toml>),
    /// Writes a value by its key.
    Set(Key, Option<Toml>),
    /// Writes several values by their keys as one undo step.
    SetAll(Vec<(Key, Option<Toml>)>),
    /// Ends a drag.
    Rest,
    /// Adds an entry to a list, given as the text of its fields.
    Add(&'static str, String),
    /// Removes an entry from a list.
    Remove(&'static str, usize),
    /// Undoes one step.
    Undo,
    /// Redoes one step.
    Redo,
    /// Selects another groom and group.
    Choose(usize, usize),
    /// Opens an unsaved scene with this text.
    New(String),
    /// Opens a scene, groom or body file.
    Open(PathBuf),
    /// Opens a scene that was kept for a crash.
    Recover(FoundScene),
    /// Saves the scene whose parameters are shown; `None` uses its current path.
    Save(Option<PathBuf>),
    /// Like `Save`, but also replaces a file that another program changed.
    SaveOver(PathBuf),
    /// Opens a second scene for comparison, which starts as a copy, or closes it.
    Compare(bool),
    /// Selects whether parameters are those of the second scene.
    Second(bool),
    /// Selects the value that colors show.
    Show(Option<Value>),
    /// Picks the strand on a ray.
    Pick(Vec3, Vec3),
    /// Clears the picked strand.
    Unpick,
    /// Grabs the hair in a sphere.
    Grab(Vec3, f32),
    /// Inserts a comb: its center, half of its row of tines [m], and its radius [m].
    Comb(Vec3, Vec3, f32),
    /// Moves the grab or the comb.
    Carry(Vec3),
    /// Releases the grab or the comb.
    LetGo,
    /// Pushes a sphere or a hand through hair; `None` removes it.
    Push(Option<Push>),
    /// Displacement of the head relative to its motion.
    Head(Vec3),
}
