//! Readers and writers of grooms, bodies, motion and scenes for Hairspring.
//!
//! The extension of a file selects its format. All content is returned in meters, right-handed, Y up. If a
//! file does not specify its units, they are guessed, and the guess is in the notes of [`Loaded`].
//!
//! Each format also has a `parse` function over bytes, which keeps the file's own units. It never panics, and
//! it never allocates more than a small multiple of the size of its input.

mod bytes;
mod chains;
mod clip_choice;
mod color;
mod contents;
mod error;
mod external;
mod frame_writer;
mod inputs;
mod left_out;
mod load;
mod manifest;
mod motion;
mod observe;
mod polygon;
mod polylines;
mod repair_notes;
mod save;
mod skin;
mod skin_distance;
mod strand_attributes;
mod strands;
mod strays;
mod text;
mod tfx_text;
mod units;
mod unused_vertices;

pub mod bvh;
pub mod csv;
pub mod gltf;
pub mod hair;
pub mod makehuman;
pub mod obj;
pub mod pc2;
mod picture;
pub mod ply;
pub mod scene;
pub mod tfx;
pub mod tfxbone;
pub mod tfxmesh;
pub mod usc;

pub use error::{Error, ErrorKind, Place, Problem, Result};
pub use external::{
    CacheDescription, CacheWriter, ExternalError, ExternalFile, ExternalFormats, check_cache_format,
    set_external_formats, write_cache,
};
pub use frame_writer::{FrameError, FrameWriter};
pub use gltf::Character;
pub use inputs::Inputs;
pub use load::{
    Format, Loaded, bytes_of, check_file, holds_only_curves, read_body, read_bones, read_groom, read_motion,
    text_of,
};
pub use manifest::{Manifest, ManifestError, Origin};
pub use motion::Motion;
pub use observe::observe_files;
pub use save::{atomically, write_groom, write_strands};
pub use scene::{read_scene, read_scene_text, read_settings, same_geometry, scene_text};
pub use skin_distance::SkinDistance;
pub use strands::Strands;
pub use text::{is_hidden, printable};
pub use units::{Axis, ReadOptions};
