//! Whatever a person, a script or a monkey does.

use crate::{drag_limiter::Push, key::Key, parameter::Parameter};
use glam::Vec3;
use hairspring_scene::stage::Value;
use std::path::PathBuf;
use toml_edit::Value as Toml;

/// What can be done.
#[derive(Clone, Debug)]
pub enum Action {
    /// Plays or pauses.
    Play(bool),
    /// Steps once.
    Step,
    /// Back to time 0.
    Reset,
    /// Seconds of the scene in a second.
    Speed(f32),
    /// Whether the motion begins anew at its end.
    Repeat(bool),
    /// Writes a parameter; `None`: its default counts.
    Parameter(&'static Parameter, Option<Toml>),
    /// Writes a value by its key.
    Set(Key, Option<Toml>),
    /// Writes several values by their keys, which are one step to go back.
    SetAll(Vec<(Key, Option<Toml>)>),
    /// What was dragged is let go of.
    Rest,
    /// Adds an entry to a list, by the text of its fields.
    Add(&'static str, String),
    /// Takes one out.
    Remove(&'static str, usize),
    /// A step back.
    Undo,
    /// A step forth.
    Redo,
    /// Another groom and group of it are shown and changed.
    Choose(usize, usize),
    /// A scene that is not saved yet.
    New(String),
    /// A scene, groom or body file.
    Open(PathBuf),
    /// Saves the scene; `None`: where it was opened.
    Save(Option<PathBuf>),
    /// Opens a second scene beside it, which starts out the same, or closes it.
    Compare(bool),
    /// Whether parameters are those of the second.
    Second(bool),
    /// What colours show.
    Show(Option<Value>),
    /// Picks the strand on a ray.
    Pick(Vec3, Vec3),
    /// Forgets what was picked.
    Unpick,
    /// Takes hold of the hair in a ball.
    Grab(Vec3, f32),
    /// Puts spread fingers in around a place, half of their row [m], and how far they reach [m].
    Comb(Vec3, Vec3, f32),
    /// Moves what took hold.
    Carry(Vec3),
    /// Lets go.
    LetGo,
    /// Pushes a ball or a hand through hair; `None`: it is gone.
    Push(Option<Push>),
    /// How far the head is carried from where its motion takes it.
    Head(Vec3),
}
