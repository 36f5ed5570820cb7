//! Pictures of hair, without a GPU.
//!
//! This is the project's picture of record: what any other renderer is compared with.

mod body;
mod camera;
mod frame;
mod hair;
mod image;
mod lighting;
mod output;
mod renderer;
mod shadow;
mod sort;
mod tile;
mod tonemap;

pub use camera::frame_camera;
pub use frame::{Frame, HairDraw, MeshDraw, Quality};
pub use image::Image;
pub use lighting::{Background, Light, Lighting};
pub use output::{ClipWriter, OutputError, read_png, sequence_path, write_png};
pub use renderer::{Renderer, Timings};
