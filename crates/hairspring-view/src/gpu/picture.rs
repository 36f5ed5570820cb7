//! The textures for a picture of one size, the final composition, and the readback to the CPU.

use super::{
    Gpu, GpuError,
    constants::{DEVELOP, SAMPLES},
    memory::{Bound, Generation, Store, mapped},
    renderer::Job,
    surfaces::Surfaces,
    volume::Volume,
};
use crate::{frame::Frame, image::Image, shadow::contact::Contact};
use wgpu::{BindingResource, BufferUsages, Extent3d, TextureFormat, TextureUsages, TextureView};

/// Linear light, and coverage.
pub(super) const LIGHT: TextureFormat = TextureFormat::Rgba16Float;
/// Relative depth, and coverage.
pub(super) const PLACE: TextureFormat = TextureFormat::Rg32Float;
/// The finished picture, as sRGB codes.
const CODES: TextureFormat = TextureFormat::Rgba8Unorm;
/// Required alignment of buffer rows for texture copies [bytes].
const ROW: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;

/// The render targets.
pub(super) struct Targets {
    pub size: [u32; 2],
    /// Hair in front of the body, and behind it: linear RGB times coverage, coverage.
    pub before: TextureView,
    pub behind: TextureView,
    /// The body's light, multisampled and resolved: light times coverage, coverage.
    pub samples: TextureView,
    pub body: TextureView,
    /// Nearness of the body, multisampled. Greater is nearer.
    pub nearness: TextureView,
    /// Relative depth of the body.
    pub place: TextureView,
    finished: wgpu::Texture,
    pub picture: TextureView,
}

impl Targets {
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let texture = |label, format, samples, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let view = |label, format, samples| {
            texture(label, format, samples, TextureUsages::TEXTURE_BINDING).create_view(&Default::default())
        };
        let shown = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        let finished = texture("picture", CODES, 1, shown);
        Self {
            size,
            before: view("hair before", LIGHT, 1),
            behind: view("hair behind", LIGHT, 1),
            samples: view("body samples", LIGHT, SAMPLES),
            body: view("body", LIGHT, 1),
            nearness: view("nearness", TextureFormat::Depth32Float, SAMPLES),
            place: view("place", PLACE, 1),
            picture: finished.create_view(&Default::default()),
            finished,
        }
    }
}

/// Creates a pipeline: a full-screen pass, or triangles. This is the common part of most pipelines here.
pub(super) fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    [vertex, fragment]: [&str; 2],
    targets: &[Option<wgpu::ColorTargetState>],
    depth: Option<wgpu::DepthStencilState>,
    samples: u32,
) -> wgpu::RenderPipeline {
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(vertex),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: depth,
        multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
        // A depth-only pass has no fragment shader.
        fragment: (!targets.is_empty()).then_some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// A color attachment that is cleared and stored.
pub(super) fn clear(view: &TextureView) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            store: wgpu::StoreOp::Store,
        },
    })
}

/// Composes the parts of a picture.
pub(super) struct Develop {
    pipeline: wgpu::RenderPipeline,
    bound: Bound,
    contact: Contact,
    sky: Store,
}

impl Develop {
    pub fn new(gpu: &Gpu) -> Self {
        let module = DEVELOP.module(gpu);
        let targets = [Some(CODES.into())];
        let pipeline = pipeline(gpu, &module, ["everywhere", "develop"], &targets, None, 1);
        let sky = Store::new(gpu, "contact", BufferUsages::STORAGE);
        Self { pipeline, bound: Bound::default(), contact: Contact::default(), sky }
    }

    /// Sends the fraction of the sky that bodies leave visible from the ground.
    pub fn send(&mut self, gpu: &Gpu, frame: &Frame, generation: &mut Generation) -> &Contact {
        self.contact.fill(frame);
        self.sky.fill(gpu, &self.contact.sky, generation);
        &self.contact
    }

    /// Records the final composition.
    pub fn record(
        &mut self,
        job: &Job,
        encoder: &mut wgpu::CommandEncoder,
        volume: &Volume,
        surfaces: &Surfaces,
    ) {
        let Job { gpu, generation, uniforms, targets, .. } = *job;
        let entries = [
            (0, uniforms.all()),
            (1, BindingResource::TextureView(&targets.before)),
            (2, BindingResource::TextureView(&targets.behind)),
            (3, BindingResource::TextureView(&targets.body)),
            (4, self.sky.all()),
            (10, BindingResource::TextureView(&volume.light)),
            (12, BindingResource::Sampler(&surfaces.sampler)),
            (13, BindingResource::TextureView(&surfaces.heights)),
        ];
        let group = self.bound.group(gpu, generation, self.pipeline.get_bind_group_layout(0), &entries);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("develop"),
            color_attachments: &[clear(&targets.picture)],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Reads pictures back to the CPU.
#[derive(Default)]
pub(super) struct Reader {
    buffer: Option<wgpu::Buffer>,
}

impl Reader {
    /// Waits for the picture and returns it.
    pub fn read(&mut self, gpu: &Gpu, targets: &Targets) -> Result<Image, GpuError> {
        let [width, height] = targets.size;
        let row = (4 * width).next_multiple_of(ROW);
        let size = u64::from(row) * u64::from(height);
        let buffer = match self.buffer.take() {
            Some(buffer) if buffer.size() == size => buffer,
            _ => gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("picture"),
                size,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            }),
        };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            targets.finished.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: None,
                },
            },
            Extent3d { width, height, depth_or_array_layers: 1 },
        );
        gpu.queue.submit([encoder.finish()]);
        let mut image = Image::new(width, height);
        {
            let bytes = mapped(gpu, &buffer)?;
            let rows = bytes.chunks_exact(row as usize).zip(image.rgb.chunks_exact_mut(3 * width as usize));
            for (from, to) in rows {
                for (from, to) in from.chunks_exact(4).zip(to.chunks_exact_mut(3)) {
                    to.copy_from_slice(&from[..3]);
                }
            }
        }
        buffer.unmap();
        self.buffer = Some(buffer);
        Ok(image)
    }
}
