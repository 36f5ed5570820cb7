//! GPU memory: growing buffers, and their bindings to shaders.

use super::{Gpu, GpuError};
use bytemuck::Pod;
use std::sync::atomic::Ordering::Relaxed;
use wgpu::{BindGroup, BindGroupLayout, BindingResource, Buffer, BufferUsages};

/// Counts allocations. After an allocation, bind groups must be created again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Generation(u64);

impl Generation {
    pub fn next(&mut self) {
        self.0 += 1;
    }
}

/// A buffer that grows as needed and never shrinks.
pub(super) struct Store {
    label: &'static str,
    usage: BufferUsages,
    buffer: Buffer,
}

impl Store {
    /// Creates a small buffer.
    pub fn new(gpu: &Gpu, label: &'static str, usage: BufferUsages) -> Self {
        let usage = usage | BufferUsages::COPY_DST;
        Self { label, usage, buffer: buffer(gpu, label, 256, usage) }
    }

    /// Makes room for a number of bytes. If the buffer grows, its content is lost.
    pub fn fit(&mut self, gpu: &Gpu, bytes: usize, generation: &mut Generation) {
        if bytes as u64 > self.buffer.size() {
            // Allocates a quarter more, so that hair that is cut and grows again does not allocate every
            // time, but never more than can be bound.
            let most = gpu.device.limits().max_storage_buffer_binding_size;
            let size = (bytes as u64 + bytes as u64 / 4).min(most).max(bytes as u64).next_multiple_of(256);
            self.buffer = buffer(gpu, self.label, size, self.usage);
            generation.next();
        }
    }

    /// Writes values at an offset [bytes]. The buffer must be large enough.
    pub fn write<T: Pod>(&self, gpu: &Gpu, offset: usize, values: &[T]) {
        if !values.is_empty() {
            gpu.sent.fetch_add(size_of_val(values) as u64, Relaxed);
            gpu.queue.write_buffer(&self.buffer, offset as u64, bytemuck::cast_slice(values));
        }
    }

    /// Makes room for the values and writes them.
    pub fn fill<T: Pod>(&mut self, gpu: &Gpu, values: &[T], generation: &mut Generation) {
        self.fit(gpu, size_of_val(values), generation);
        self.write(gpu, 0, values);
    }

    /// Waits for the first `count` values and reads them. The buffer must have been created as a copy source.
    pub fn read<T: Pod>(&self, gpu: &Gpu, count: usize) -> Result<Vec<T>, GpuError> {
        let size = (count * size_of::<T>()) as u64;
        let copy = buffer(gpu, self.label, size.max(4), BufferUsages::COPY_DST | BufferUsages::MAP_READ);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&self.buffer, 0, &copy, 0, size);
        gpu.queue.submit([encoder.finish()]);
        let bytes = mapped(gpu, &copy)?;
        Ok(bytemuck::pod_collect_to_vec(&bytes[..size as usize]))
    }

    pub fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    pub fn all(&self) -> BindingResource<'_> {
        self.buffer.as_entire_binding()
    }
}

fn buffer(gpu: &Gpu, label: &str, size: u64, usage: BufferUsages) -> Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage,
        mapped_at_creation: false,
    })
}

/// Waits for the data that is being copied to a buffer.
pub(super) fn mapped(gpu: &Gpu, buffer: &Buffer) -> Result<wgpu::BufferView, GpuError> {
    let failed = |e: String| GpuError::Failed(e);
    let (tell, told) = std::sync::mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        // The receiver is only gone if waiting has failed already.
        let _ = tell.send(result);
    });
    gpu.wait()?;
    told.recv().map_err(|e| failed(e.to_string()))?.map_err(|e| failed(e.to_string()))?;
    buffer.get_mapped_range(..).map_err(|e| failed(e.to_string()))
}

/// The resources of a pipeline. The bind group is created again after memory was allocated.
#[derive(Default)]
pub(super) struct Bound {
    group: Option<(Generation, BindGroup)>,
}

impl Bound {
    pub fn group(
        &mut self,
        gpu: &Gpu,
        generation: Generation,
        layout: BindGroupLayout,
        entries: &[(u32, BindingResource)],
    ) -> &BindGroup {
        if self.group.as_ref().is_none_or(|(then, _)| *then != generation) {
            self.group = Some((generation, bind(gpu, &layout, entries)));
        }
        &self.group.as_ref().expect("it was just made").1
    }
}

/// Creates a bind group from resources and their binding numbers.
pub(super) fn bind(gpu: &Gpu, layout: &BindGroupLayout, entries: &[(u32, BindingResource)]) -> BindGroup {
    let entries: Vec<_> = entries
        .iter()
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding: *binding, resource: resource.clone() })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

/// Creates a compute pipeline from the function `entry` of `module`.
pub(super) fn compute(gpu: &Gpu, module: &wgpu::ShaderModule, entry: &str) -> wgpu::ComputePipeline {
    gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: None,
        module,
        entry_point: Some(entry),
        compilation_options: Default::default(),
        cache: None,
    })
}

/// A compute pipeline and its resources.
pub(super) struct Kernel {
    pub pipeline: wgpu::ComputePipeline,
    bound: Bound,
}

impl Kernel {
    /// Creates a kernel from the function `entry` of `module`.
    pub fn new(gpu: &Gpu, module: &wgpu::ShaderModule, entry: &str) -> Self {
        Self { pipeline: compute(gpu, module, entry), bound: Bound::default() }
    }

    /// Dispatches the kernel over workgroups.
    pub fn run(
        &mut self,
        gpu: &Gpu,
        generation: Generation,
        pass: &mut wgpu::ComputePass,
        entries: &[(u32, BindingResource)],
        [x, y, z]: [u32; 3],
    ) {
        let group = self.bound.group(gpu, generation, self.pipeline.get_bind_group_layout(0), entries);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups(x, y, z);
    }
}

/// Workgroups of `size` invocations for `n` items. They are split into rows if one row would exceed WebGPU's
/// limit.
pub(super) fn groups(n: usize, size: usize) -> [u32; 3] {
    const ROW: usize = 65_535;
    let groups = n.div_ceil(size).max(1);
    let rows = groups.div_ceil(ROW);
    [groups.div_ceil(rows) as u32, rows as u32, 1]
}
