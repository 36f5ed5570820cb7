//! Draws pictures of hair. The CPU renderer needs no driver and gives the reference picture. The GPU renderer
//! ([`gpu`]) is compared with it.
//!
//! A [`Frame`] borrows strands and bodies and holds the settings; a [`Renderer`] keeps only working memory. A
//! frame passes through four stages:
//!
//! | module | what it does | source |
//! | --- | --- | --- |
//! | `shadow` | splats hair into a density grid and sweeps it along each lamp; draws bodies into a depth map | Yuksel & Keyser 2008, Reeves et al. 1987 |
//! | `hair` | projects strands and sorts them into tiles; lights and smooths what a tile shows | Marschner et al. 2003, Karis 2016 |
//! | `tile` | blends a tile's segments nearest first over body, ground and backdrop, until the pixels are opaque | exact area coverage |
//! | `pass` | what a pixel holds: 8 bits of sRGB, linear light with alpha, or depth and motion | |
//! | `tonemap` | filmic curve, sRGB, ordered dither | ACES |
//!
//! Coverage is exact area and not sampled, so there is no noise and no flicker. Blending is in depth order,
//! so the result is not an approximation. Where pixels are at least half covered, some strands represent all
//! of them: each is drawn wider to make up for those that are left out. The same strands are drawn from frame
//! to frame.
//!
//! **Lower bound of the cost.** `cargo bench -p hairspring-view --bench frame` prints the [`Work`] of the
//! built-in head at 1280 × 720: 3.1 million segments, sorted 6.3 million times into tiles, of which 0.84
//! million are drawn over 9.1 million columns of pixels; 1.0 million points lit; 0.92 million pixels.
//!
//! - Estimated operations: a segment takes 125 in eight lanes and 35 more to count it into voxels and sort it
//!   (150 million in total); a drawn segment takes 100 and a column 35 for its two pixels (400 million); a
//!   lit point takes 350 in lanes and 40 more (90 million); a pixel takes 60 (55 million). The sum is 0.7
//!   billion instructions: 60 ms on two cores at 3 GHz and two instructions per cycle.
//! - Estimated memory traffic: 38 MB of points are read twice, 50 MB of dots are written and are read where
//!   they are drawn, 50 MB of entries are written twice and read three times. The sum is about 0.4 GB: 40 ms
//!   at 10 GB/s, in parallel with the operations.
//!
//! The actual time is about six times the lower bound; `docs/performance.md` has the measurements. Half of a
//! frame is spent in tiles: columns wait for pixels that the previous column has just written, and segments
//! wait for points that are far apart in memory.

mod body;
mod camera;
mod frame;
pub mod gpu;
mod ground;
mod hair;
mod image;
mod lighting;
mod linear;
mod output;
mod pass;
mod renderer;
mod shadow;
mod sort;
mod tile;
mod tonemap;
mod work;

pub use camera::frame_camera;
pub use frame::{Before, Frame, HairDraw, MeshDraw, Quality};
pub use ground::Ground;
pub use image::Image;
pub use lighting::{Background, Light, Lighting};
pub use linear::{GeometryImage, LinearImage};
pub use output::{
    ClipWriter, Layers, OutputError, encode_png, read_png, sequence_path, write_exr, write_jpeg, write_png,
};
pub use renderer::{Renderer, Timings};
pub use work::Work;
