//! Draws hair on the GPU through [`wgpu`]: the same [`Frame`](crate::Frame) as the CPU
//! [`Renderer`](crate::Renderer), with the same lighting and the same constants.
//!
//! The algorithms are those of `hair`, `body` and `shadow`. Each shader in `wgsl/` names the function that it
//! corresponds to, and takes its constants from there (`constants.rs`).
//!
//! | step | shaders |
//! | --- | --- |
//! | interpolate follow hairs, if the GPU does it | `follow` |
//! | splat hair into voxels, mark bodies in them, and sweep light through | `density`, `walls`, `sweep` |
//! | draw bodies from the key lamp, then from the camera with four samples per pixel | `body`, `settle` |
//! | project and light every point of every strand | `points`, `fiber`, `light` |
//! | smooth segments, cut them into pieces, and sort these by depth | `curve`, `sort` |
//! | blend the pieces, farthest first | `ribbon` |
//! | compose hair in front of the body, body, hair behind it, ground and backdrop; apply the tone curve | `ground`, `develop` |
//!
//! **Why pieces are sorted.** The CPU blends pieces by depth, each with the exact fraction of a pixel that it
//! covers. Multisampling (coverage as a mask of four) has only four levels, and hair is a tenth of a pixel
//! wide: the result is noise, or hair that appears and disappears. Order-independent blending needs no sort
//! and is stable, but only approximates the order. A GPU sorts four million pieces by 65,536 depths in a few
//! passes without comparisons, and its blending preserves order at no cost. The picture then equals that of
//! the CPU, up to rounding.
//!
//! **Lower bound of the cost.** This estimate is for one frame of 100,000 hairs with 32 points at 1280 × 720.
//!
//! - Upload: 38 MB of points. If the GPU interpolates follow hairs, it is 5 MB (the transforms of 3,060
//!   guides, and the changed part of the body's field); the GPU then also reads 77 MB of static data and
//!   writes the points.
//! - Points: points and radii are read twice (103 MB); 51 MB of dots and 13 MB of light are written.
//! - Sort: it reads the dots again, and writes and reads keys and pieces (51 MB and 64 MB). Pieces read their
//!   points at random, two cache lines of 64 bytes each (400 MB).
//! - Blending: about 3.5 million pieces are 14 million vertices and about 20 million fragments, which read
//!   and write 8 bytes in each of two targets (640 MB).
//! - Shadow: the sweeps read and write 1.5 million voxels eight times (150 MB).
//!
//! The sum is 1.5 GB: 15 ms at 100 GB/s of a laptop's GPU, 3 ms at 500 GB/s.
//!
//! Not implemented: culling of strands that no pixel shows. Drawing nearest first in phases, and skipping
//! what is fully covered between them, took a quarter less time in a software driver, but the picture lost
//! half an 8-bit step of light to rounding.
//!
//! Limits: 2²⁴ points, or as many as fit into a binding of the device at 16 bytes (8.4 million with WebGPU's
//! default). Strands past the limit are not drawn, and [`GpuRenderer::left_out`] counts them. The hair's
//! shadow has at most 4 million voxels.

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
