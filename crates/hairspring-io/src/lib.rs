//! Readers and writers of hairstyles, bodies, motion and scenes for Hairspring.
//!
//! Files are told apart by their extension. Everything read is in metres, right-handed, Y up; what a file does not say of
//! its units is guessed, and the guess is among the notes of [`Loaded`]. Each format also has a `parse` function over
//! bytes, without units, which no input makes panic or allocate more than a small multiple of its own size.

mod bytes;
mod error;
mod load;
mod motion;
mod save;
mod skin;
mod strands;
mod text;
mod units;

pub mod bvh;
pub mod gltf;
pub mod hair;
pub mod makehuman;
pub mod obj;
pub mod scene;
pub mod tfx;
pub mod tfxbone;
pub mod tfxmesh;
pub mod usc;

pub use error::{Error, ErrorKind, Place, Problem, Result};
pub use gltf::Character;
pub use load::{Format, Loaded, read_body, read_bones, read_groom, read_motion};
pub use motion::Motion;
pub use save::{atomically, write_groom, write_strands};
pub use scene::{read_scene, read_scene_text, read_settings, same_geometry};
pub use strands::Strands;
pub use units::{Axis, ReadOptions};
