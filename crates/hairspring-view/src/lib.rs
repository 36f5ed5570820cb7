//! Pictures of hair: by the CPU, without a driver, which is the project's picture of record, and by a graphics card ([`gpu`]), whose picture is
//! compared with it.
//!
//! A [`Frame`] borrows strands and bodies and holds the settings; a [`Renderer`] keeps only memory. One frame goes through four rooms:
//!
//! | room | what happens | source |
//! | --- | --- | --- |
//! | `shadow` | hair is splatted into a density grid, swept along each lamp; bodies are drawn into a depth map | Yuksel & Keyser 2008, Reeves et al. 1987 |
//! | `hair` | strands are projected and filed by tile; what a tile sees of them is lit at its points and smoothed | Marschner et al. 2003, Karis 2016 |
//! | `tile` | a tile's segments are laid nearest first over one another, over the body, over ground and backdrop, until nothing shows through | exact area coverage |
//! | `tonemap` | filmic curve, sRGB, ordered dither | ACES |
//!
//! Coverage is exact area, not samples, so there is no noise and nothing flickers; order is by depth, so nothing is guessed. Where half of
//! what lies behind is covered already, some strands stand for all: each is drawn wider by as much as others are left out, and is the same
//! strand from frame to frame.
//!
//! **The floor.** `cargo bench -p hairspring-view --bench frame` prints the [`Work`] of the built-in head at 1280 × 720: 3.1 million segments,
//! filed 6.3 million times under tiles, of which 0.84 million are drawn over 9.1 million columns of pixels; 1.0 million points lit; 0.92 million
//! pixels. Operations, estimated: a segment 125 in eight lanes and 35 more to count it into voxels and file it (150 million); a drawn
//! segment 100 and a column 35 for its two pixels (400 million); a lit point 350 in lanes and 40 more (90 million); a pixel 60 (55 million).
//! Together 0.7 billion instructions: 60 ms on two cores at 3 GHz and two a cycle. Bytes: 38 MB of points read twice, 50 MB of dots written
//! and read where drawn, 50 MB of entries written twice and read three times: about 0.4 GB, 40 ms at 10 GB/s, beside the operations.
//!
//! The distance is about six times that: `docs/performance.md` has the times. Half of a frame is tiles: columns wait for pixels that the column
//! before has just written, and segments for points that lie far apart in memory.

mod body;
mod camera;
mod frame;
pub mod gpu;
mod ground;
mod hair;
mod image;
mod lighting;
mod output;
mod renderer;
mod shadow;
mod sort;
mod tile;
mod tonemap;
mod work;

pub use camera::frame_camera;
pub use frame::{Frame, HairDraw, MeshDraw, Quality};
pub use ground::Ground;
pub use image::Image;
pub use lighting::{Background, Light, Lighting};
pub use output::{ClipWriter, OutputError, encode_png, read_png, sequence_path, write_jpeg, write_png};
pub use renderer::{Renderer, Timings};
pub use work::Work;
