//! Pictures of hair, without a GPU: the project's picture of record, which any other renderer is compared with.
//!
//! A [`Frame`] borrows strands and bodies and holds the settings; a [`Renderer`] keeps only memory. One frame goes through four rooms:
//!
//! | room | what happens | source |
//! | --- | --- | --- |
//! | `shadow` | hair is splatted into a density grid, swept along each lamp; bodies are drawn into a depth map | Yuksel & Keyser 2008, Reeves et al. 1987 |
//! | `hair` | strands are lit at their points, projected, smoothed, cut into 32-byte pieces, filed by tile | Marschner et al. 2003, Karis 2016 |
//! | `tile` | a tile's pieces are sorted by depth and laid nearest first over one another, over the body, over the backdrop | exact area coverage |
//! | `tonemap` | filmic curve, sRGB, ordered dither | ACES |
//!
//! Coverage is exact area, not samples, so there is no noise and nothing flickers; order is by depth, so nothing is guessed.
//!
//! **The floor.** 100,000 × 32 points at 1280 × 720 are 3.1 million pieces and, on a head that fills the picture, about 40 million pixel columns
//! of two pixels. Bytes: 51 MB of points and radii read twice, 100 MB of pieces and 35 MB of entries written and read once each: about 0.4 GB, 40 ms at
//! 10 GB/s. Operations: 90 a point for light (700 lane instructions for eight), about 100 to read its voxels and project it, 30 a column: together
//! 1.8 billion, 150 ms on two cores at 3 GHz and two a cycle. `cargo bench -p hairspring-view` measures how far this is from it:
//! about 590 ms of wall time (1.2 s of processor time) on two shared cores when this was written, of which shadow 130, strands 250, tiles 210.

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
