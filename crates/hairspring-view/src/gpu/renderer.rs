//! Draws one picture from borrowed arrays to a texture.

use super::{
    Gpu, GpuError,
    follow::Followers,
    memory::{Generation, Store},
    meshes::Meshes,
    picture::{Develop, Reader, Targets},
    ribbons::Ribbons,
    strands::Strands,
    surfaces::Surfaces,
    uniforms::{Map, Style, Uniforms},
    volume::{Volume, grid},
};
use crate::{
    camera::View,
    frame::{Frame, HairDraw},
    ground::Floor,
    image::Image,
    shadow,
};
use glam::Vec3;
use std::{
    sync::atomic::Ordering::Relaxed,
    time::{Duration, Instant},
};

/// Draws frames on the GPU. It keeps its memory between frames, and allocates none for a frame that is no
/// larger than the previous ones.
///
/// The picture equals that of the CPU [`Renderer`](crate::Renderer), up to rounding. Radii, colors, offsets
/// and triangles are sent to the GPU only when they change. A change is detected from the address of an
/// array, its length, and 512 of its values. Call [`GpuRenderer::forget`] after changing an array in place.
pub struct GpuRenderer {
    gpu: Gpu,
    generation: Generation,
    uniforms: Store,
    strands: Strands,
    followers: Followers,
    meshes: Meshes,
    volume: Volume,
    surfaces: Surfaces,
    ribbons: Ribbons,
    develop: Develop,
    targets: Targets,
    reader: Reader,
    timings: GpuTimings,
}

/// The input of every step of a frame.
#[derive(Clone, Copy)]
pub(super) struct Job<'a> {
    pub gpu: &'a Gpu,
    pub generation: Generation,
    /// [`Uniforms`] of the frame.
    pub uniforms: &'a Store,
    pub strands: &'a Strands,
    pub meshes: &'a Meshes,
    pub targets: &'a Targets,
}

/// CPU time of the last frame. The GPU continues to work after it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GpuTimings {
    /// Computing the hair's bounds, and copying arrays for upload.
    pub send: Duration,
    /// Recording the GPU's commands.
    pub record: Duration,
    /// Bytes that were sent to the GPU.
    pub bytes: u64,
}

impl GpuRenderer {
    /// Creates a renderer. Compiling the shaders takes a moment.
    pub fn new(gpu: &Gpu) -> Self {
        let mut uniforms = Store::new(gpu, "frame", wgpu::BufferUsages::UNIFORM);
        uniforms.fit(gpu, size_of::<Uniforms>(), &mut Generation::default());
        Self {
            gpu: gpu.clone(),
            generation: Generation::default(),
            uniforms,
            strands: Strands::new(gpu),
            followers: Followers::new(gpu),
            meshes: Meshes::new(gpu),
            volume: Volume::new(gpu),
            surfaces: Surfaces::new(gpu),
            ribbons: Ribbons::new(gpu),
            develop: Develop::new(gpu),
            targets: Targets::new(gpu, [1, 1]),
            reader: Reader::default(),
            timings: GpuTimings::default(),
        }
    }

    /// Draws a frame of `width` × `height` pixels and returns it as RGBA with 8 bits per channel, as plain
    /// sRGB codes that egui can show. Width and height are clamped to 1 and the GPU's maximum texture size,
    /// 8192 by WebGPU's default. The function does not wait for the GPU.
    ///
    /// The same frame gives the same picture. Invalid values in the arrays never cause a failure.
    pub fn draw<'a>(&mut self, frame: &Frame<'a>, width: u32, height: u32) -> &wgpu::TextureView {
        let start = Instant::now();
        let gpu = &self.gpu;
        let most = gpu.most_pixels();
        let size = [width.clamp(1, most), height.clamp(1, most)];
        if self.targets.size != size {
            self.targets = Targets::new(gpu, size);
            self.generation.next();
        }
        let view = View::new(&frame.camera, size[0], size[1]);
        let map = Map::new(frame, most);
        self.strands.send(gpu, frame.hair, &mut self.generation);
        self.followers.send(gpu, frame.hair, &mut self.generation);
        let place = |(style, h): (usize, &HairDraw<'a>)| self.followers.corners(style).unwrap_or(h.points);
        let places: Vec<&[Vec3]> = frame.hair.iter().enumerate().map(place).collect();
        let bounds = shadow::bounds(&places);
        let grid = bounds.map(|bounds| grid(frame, bounds));
        self.meshes.send(gpu, frame.bodies, &mut self.generation);
        let slots = self.strands.slots;
        self.ribbons.fit(gpu, slots, &mut self.generation);
        self.surfaces.fit(gpu, map.side, &mut self.generation);
        let voxel = grid.map_or(1.0, |g| g.voxel);
        let styles: Vec<Style> = frame.hair.iter().map(|h| Style::new(h, view.focal, voxel)).collect();
        self.strands.styles.fill(gpu, &styles, &mut self.generation);
        if let Some(grid) = &grid {
            self.volume.fit(gpu, frame, grid, &mut self.generation);
        }
        // As in `Renderer::draw`.
        let (low, high) = bounds.unwrap_or_default();
        let middle = (0.5 * (low + high) - view.eye).dot(view.forward);
        let reach = 0.5 * (high - low).dot(view.forward.abs()) + 1e-3;
        let depths = [(middle - reach).max(0.0), middle.max(0.0) + reach];
        let (grid_there, counts) = (grid.as_ref(), [slots, self.meshes.count as usize]);
        let floor = Floor::new(frame, &view, bounds);
        let ground = (floor.as_ref(), self.develop.send(gpu, frame, &mut self.generation));
        let uniforms = Uniforms::new(frame, &view, depths, grid_there, &map, ground, counts);
        self.uniforms.write(gpu, 0, &[uniforms]);
        let sent = Instant::now();

        let job = Job {
            gpu,
            generation: self.generation,
            uniforms: &self.uniforms,
            strands: &self.strands,
            meshes: &self.meshes,
            targets: &self.targets,
        };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.followers.record(&job, &mut encoder);
        self.surfaces.record_map(&job, &mut encoder);
        if grid.is_some() {
            self.volume.record(&job, &mut encoder);
        }
        self.surfaces.record(&job, &mut encoder, &self.volume, floor.is_some());
        if slots > 0 {
            self.ribbons.record_sort(&job, &mut encoder, &self.volume, &self.surfaces);
            self.ribbons.record(&job, &mut encoder);
        } else {
            Ribbons::record_none(&job, &mut encoder);
        }
        self.develop.record(&job, &mut encoder, &self.volume, &self.surfaces);
        gpu.queue.submit([encoder.finish()]);
        let bytes = gpu.sent.swap(0, Relaxed);
        self.timings = GpuTimings { send: sent - start, record: sent.elapsed(), bytes };
        &self.targets.picture
    }

    /// Waits for the last picture and reads it back. Before the first frame it is one black pixel.
    ///
    /// # Errors
    /// Returns [`GpuError::Failed`] if the GPU rejected a command or was lost.
    pub fn read(&mut self) -> Result<Image, GpuError> {
        self.reader.read(&self.gpu, &self.targets)
    }

    /// Waits for the points of all styles, one after the other, as the GPU has them. Those of follow hairs
    /// are the ones that it interpolated [m].
    ///
    /// # Errors
    /// See [`GpuRenderer::read`].
    pub fn read_points(&self) -> Result<Vec<Vec3>, GpuError> {
        self.strands.points.read(&self.gpu, self.strands.count)
    }

    /// The last picture, as [`GpuRenderer::draw`] returned it.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.targets.picture
    }

    /// The GPU that is used.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Marks all data as not sent. Call it after changing radii, colors, offsets or triangles in place.
    pub fn forget(&mut self) {
        self.strands.forget();
        self.meshes.forget();
    }

    /// Number of strands of the last frame that did not fit into GPU memory.
    pub fn left_out(&self) -> usize {
        self.strands.left_out
    }

    /// CPU time of the last frame.
    pub fn timings(&self) -> GpuTimings {
        self.timings
    }
}
