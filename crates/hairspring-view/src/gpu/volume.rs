//! The hair's shadow on the GPU: `shadow/density.rs` and the sweeps of `shadow/mod.rs`.

use super::{
    Gpu,
    constants::{DENSITY, DIRECTIONS, SWEEP, WALLS},
    memory::{Bound, Generation, Kernel, Store, groups},
    renderer::Job,
    uniforms::sweeps,
};
use crate::{frame::Frame, shadow::density::Grid};
use glam::Vec3;
use wgpu::{BindingResource, BufferUsages, Extent3d, TextureFormat, TextureUsages, TextureView};

/// Maximum number of voxels. The optical depths of eight directions then fit into WebGPU's default binding of
/// 128 MiB.
const MOST: usize = 1 << 22;
/// Distance between the numbers of the slices in their buffer [bytes], as WebGPU requires for offsets.
const STEP: usize = 256;
/// Maximum number of slices of a grid: 256 voxels, their padding, and some reserve.
const SLICES: usize = 300;

/// The buffers and shaders of the shadow.
pub(super) struct Volume {
    splat: Kernel,
    wall: Kernel,
    blur: Kernel,
    sweep: wgpu::ComputePipeline,
    slices: Vec<Bound>,
    gather: Kernel,
    sums: Store,
    walls: Store,
    density: Store,
    depths: Store,
    sweeps: Store,
    numbers: Store,
    size: [usize; 3],
    /// Optical depth toward key, rim and fill, and the visible fraction of the sky.
    pub light: TextureView,
    /// Visible fraction of each slanted part of the sky.
    pub slants: TextureView,
}

/// The grid around a frame's hair. It is that of the CPU, or a coarser one if that has too many voxels.
pub(super) fn grid(frame: &Frame, bounds: (Vec3, Vec3)) -> Grid {
    let mut voxels = frame.quality.shadow_voxels;
    loop {
        let grid = Grid::around(bounds, voxels);
        if grid.len() <= MOST || voxels <= 16 {
            return grid;
        }
        voxels -= voxels / 8;
    }
}

impl Volume {
    pub fn new(gpu: &Gpu) -> Self {
        let (density, walls, sweep) = (DENSITY.module(gpu), WALLS.module(gpu), SWEEP.module(gpu));
        let store = |label, usage| Store::new(gpu, label, usage);
        let mut numbers = store("slices", BufferUsages::UNIFORM);
        numbers.fit(gpu, SLICES * STEP, &mut Generation::default());
        let slices: Vec<[u32; STEP / 4]> =
            (0..SLICES as u32).map(|k| std::array::from_fn(|i| if i == 0 { k } else { 0 })).collect();
        numbers.write(gpu, 0, &slices);
        let size = [1; 3];
        let [light, slants] = textures(gpu, size);
        Self {
            splat: Kernel::new(gpu, &density, "splat"),
            wall: Kernel::new(gpu, &walls, "wall"),
            blur: Kernel::new(gpu, &sweep, "blur"),
            sweep: Kernel::new(gpu, &sweep, "sweep").pipeline,
            slices: Vec::new(),
            gather: Kernel::new(gpu, &sweep, "gather"),
            sums: store("sums", BufferUsages::STORAGE),
            walls: store("walls", BufferUsages::STORAGE),
            density: store("density", BufferUsages::STORAGE),
            depths: store("depths", BufferUsages::STORAGE),
            sweeps: store("sweeps", BufferUsages::UNIFORM),
            numbers,
            size,
            light,
            slants,
        }
    }

    /// Allocates the buffers of a grid.
    pub fn fit(&mut self, gpu: &Gpu, frame: &Frame, grid: &Grid, generation: &mut Generation) {
        let n = grid.len();
        self.sums.fit(gpu, 4 * n, generation);
        self.walls.fit(gpu, 4 * n, generation);
        self.density.fit(gpu, 8 * n, generation);
        self.depths.fit(gpu, 4 * n * DIRECTIONS, generation);
        self.sweeps.fill(gpu, &sweeps(frame, grid), generation);
        if self.size != grid.size {
            [self.light, self.slants] = textures(gpu, grid.size);
            self.size = grid.size;
            generation.next();
        }
    }

    /// Records the shadow computation.
    pub fn record(&mut self, job: &Job, encoder: &mut wgpu::CommandEncoder) {
        let Job { gpu, generation, uniforms, strands, meshes, .. } = *job;
        for store in [&self.sums, &self.walls, &self.depths] {
            encoder.clear_buffer(store.buffer(), 0, None);
        }
        let mut pass = encoder.begin_compute_pass(&Default::default());
        let frame = (0, uniforms.all());
        if strands.slots > 0 {
            let entries = [&[frame.clone(), (7, self.sums.all())], &strands.bindings()[..]].concat();
            self.splat.run(gpu, generation, &mut pass, &entries, groups(strands.slots, 256));
        }
        if meshes.count > 0 {
            let entries = [
                frame.clone(),
                (1, meshes.positions.all()),
                (2, meshes.triangles.all()),
                (3, self.walls.all()),
            ];
            self.wall.run(gpu, generation, &mut pass, &entries, groups(meshes.count as usize, 64));
        }
        let [nx, ny, nz] = self.size.map(|n| n as u32);
        let entries = [frame.clone(), (1, self.sums.all()), (2, self.walls.all()), (3, self.density.all())];
        self.blur.run(gpu, generation, &mut pass, &entries, [nx.div_ceil(64), ny, nz]);

        let longest = nx.max(ny).max(nz);
        self.slices.resize_with(self.slices.len().max(longest as usize), Bound::default);
        pass.set_pipeline(&self.sweep);
        for k in 1..longest {
            let number = BindingResource::Buffer(wgpu::BufferBinding {
                buffer: self.numbers.buffer(),
                offset: u64::from(k) * STEP as u64,
                size: wgpu::BufferSize::new(4),
            });
            let entries = [
                frame.clone(),
                (3, self.density.all()),
                (4, self.depths.all()),
                (5, self.sweeps.all()),
                (6, number),
            ];
            let layout = self.sweep.get_bind_group_layout(0);
            pass.set_bind_group(0, self.slices[k as usize].group(gpu, generation, layout, &entries), &[]);
            let side = longest.div_ceil(16);
            pass.dispatch_workgroups(side, side, DIRECTIONS as u32);
        }
        let entries = [
            frame,
            (4, self.depths.all()),
            (7, BindingResource::TextureView(&self.light)),
            (8, BindingResource::TextureView(&self.slants)),
        ];
        self.gather.run(gpu, generation, &mut pass, &entries, [nx.div_ceil(64), ny, nz]);
    }
}

fn textures(gpu: &Gpu, [x, y, z]: [usize; 3]) -> [TextureView; 2] {
    ["light", "slants"].map(|label| {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: Extent3d { width: x as u32, height: y as u32, depth_or_array_layers: z as u32 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D3,
            format: TextureFormat::Rgba16Float,
            usage: TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        texture.create_view(&Default::default())
    })
}
