//! Shows a picture from memory in the window without conversion.
//!
//! egui could do so with the shader that draws its text. That shader checks for every pixel whether textures
//! must be filtered manually, and a software driver computes both variants: 65 ns per pixel, for a million
//! pixels. The shader here samples one texture once.

use eframe::{
    egui::{self, PaintCallbackInfo},
    egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState},
    wgpu,
};
use hairspring_view::Image;

/// One triangle that covers the viewport, and the picture's coordinates in it.
const SHADER: &str = "
struct Corner { @builtin(position) at: vec4f, @location(0) place: vec2f }

@vertex fn corner(@builtin(vertex_index) i: u32) -> Corner {
    let p = vec2f(f32(i & 1u), f32(i >> 1u)) * 2.0;
    return Corner(vec4f(p.x * 2.0 - 1.0, 1.0 - p.y * 2.0, 0.0, 1.0), p);
}

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var smooth_: sampler;

@fragment fn pixel(in: Corner) -> @location(0) vec4f {
    return textureSampleLevel(picture, smooth_, in.place, 0.0);
}
";

/// Shows one picture after another.
pub struct Pane {
    state: RenderState,
    pipeline: wgpu::RenderPipeline,
    smooth: wgpu::Sampler,
    shown: Option<(wgpu::Texture, wgpu::BindGroup)>,
    rgba: Vec<u8>,
}

impl Pane {
    /// Creates the pane on the window's device.
    pub fn new(state: &RenderState) -> Self {
        let device = &state.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("pane"),
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("pane"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("pixel"),
                compilation_options: Default::default(),
                targets: &[Some(state.target_format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let smooth = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self { state: state.clone(), pipeline, smooth, shown: None, rgba: Vec::new() }
    }

    /// The renderer state of the window.
    pub fn state(&self) -> &RenderState {
        &self.state
    }

    /// Uploads a picture.
    pub fn take(&mut self, image: &Image) {
        let size = wgpu::Extent3d { width: image.width, height: image.height, depth_or_array_layers: 1 };
        if self.shown.as_ref().is_none_or(|(texture, _)| texture.size() != size) {
            self.shown = Some(self.room(size));
        }
        let Some((texture, _)) = &self.shown else { return };
        self.rgba.clear();
        self.rgba.extend(image.rgb.chunks_exact(3).flat_map(|c| [c[0], c[1], c[2], u8::MAX]));
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * size.width),
            rows_per_image: None,
        };
        self.state.queue.write_texture(texture.as_image_copy(), &self.rgba, layout, size);
    }

    /// Creates a texture of this size and its bind group.
    fn room(&self, size: wgpu::Extent3d) -> (wgpu::Texture, wgpu::BindGroup) {
        let device = &self.state.device;
        // The texture format matches the window's, so that the picture's sRGB codes pass through unchanged.
        let light = self.state.target_format.is_srgb();
        let format =
            if light { wgpu::TextureFormat::Rgba8UnormSrgb } else { wgpu::TextureFormat::Rgba8Unorm };
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("pane"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let view = texture.create_view(&Default::default());
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("pane"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[
                entry(0, wgpu::BindingResource::TextureView(&view)),
                entry(1, wgpu::BindingResource::Sampler(&self.smooth)),
            ],
        });
        (texture, group)
    }

    /// The shape that shows the last picture at `rect`; `None` before the first.
    pub fn shape(&self, rect: egui::Rect) -> Option<egui::Shape> {
        let (_, group) = self.shown.as_ref()?;
        let sheet = Sheet { pipeline: self.pipeline.clone(), group: group.clone() };
        Some(Callback::new_paint_callback(rect, sheet).into())
    }
}

/// The draw call in a render pass of the window.
struct Sheet {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

impl CallbackTrait for Sheet {
    fn paint(&self, _: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, _: &CallbackResources) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}
