//! Pictures of hair by a graphics card: the same [`Frame`](crate::Frame) as the CPU [`Renderer`](crate::Renderer) draws, in the same
//! light, by the same numbers, through [`wgpu`].
//!
//! What is drawn is what `hair`, `body` and `shadow` say; each shader in `wgsl/` names the function that it is the counterpart of, and
//! takes its constants from there (`constants.rs`).
//!
//! | step | shaders |
//! | --- | --- |
//! | follow hairs are placed, where that is left to the card | `follow` |
//! | hair is counted into voxels, bodies are marked in them, and light is swept through | `density`, `walls`, `sweep` |
//! | bodies as the key lamp sees them, then as the camera does, four samples a pixel | `body`, `settle` |
//! | every point of every strand is projected and lit | `points`, `fibre`, `light` |
//! | segments are smoothed, cut into pieces, and sorted by depth | `curve`, `sort` |
//! | pieces are laid over one another, farthest first | `ribbon` |
//! | hair before the body, body, hair behind it, ground and backdrop; tone curve | `ground`, `develop` |
//!
//! **Why pieces are sorted.** The CPU lays pieces over one another by depth, each by the exact share of a pixel that it covers. Samples
//! (coverage as a mask of four) know four shares only, and hair is a tenth of a pixel wide: noise, or hair that comes and goes. Blending
//! without order needs no sort and is steady, but guesses what lies before what. A card sorts four million pieces by 65,536 depths in a few passes
//! over them, with no comparison, and its blending keeps order for nothing: then the picture is the CPU's, up to rounding.
//!
//! **The floor.** 100,000 hairs of 32 points at 1280 × 720, a frame: 38 MB of points go to the card, or 5 MB where it places follow hairs by itself (how 3,060
//! guides carry them, and what changed of the body's field), which there reads 77 MB of what stays and writes the points. There, points and radii are read twice
//! (103 MB), 51 MB of dots and 13 MB of light are written; the sort reads the dots again and writes and reads keys and pieces (51 MB and
//! 64 MB); pieces find their points anywhere in memory, two lines of 64 bytes each (400 MB). About 3.5 million pieces are 14 million vertices and
//! some 20 million fragments, which read and write 8 bytes in each of two targets (640 MB). The shadow sweeps 1.5 million voxels eight times
//! (150 MB). Together 1.5 GB: 15 ms at the 100 GB/s of a laptop's card, 3 ms at 500 GB/s.
//!
//! Not done: strands that no pixel sees are drawn all the same. Drawing nearest first, in phases, and leaving out what is closed between them
//! took a quarter less in software, where the picture lost half a code of light to rounding.
//!
//! Limits: 2²⁴ points, or as many as fit a binding of the device at 16 bytes (8.4 million where it has WebGPU's default); strands past
//! that are left out, and [`GpuRenderer::left_out`] counts them. The hair's shadow has at most 4 million voxels.

mod constants;
mod device;
mod follow;
mod memory;
mod meshes;
mod picture;
mod renderer;
mod ribbons;
mod strands;
mod surfaces;
mod uniforms;
mod volume;

pub use device::{Gpu, GpuError};
pub use renderer::{GpuRenderer, GpuTimings};
pub use wgpu;
