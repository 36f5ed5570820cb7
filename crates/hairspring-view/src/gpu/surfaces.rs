//! Bodies on the GPU: their shadow map, visibility and lighting.

use super::{
    Gpu,
    constants::{BODY, SAMPLES, SETTLE},
    memory::{Bound, Generation},
    picture::{LIGHT, PLACE, clear, pipeline},
    renderer::Job,
    volume::Volume,
};
use wgpu::{BindingResource, TextureFormat, TextureUsages, TextureView};

/// The shaders of bodies, and the depth map.
pub(super) struct Surfaces {
    from_lamp: wgpu::RenderPipeline,
    surface: wgpu::RenderPipeline,
    settle: wgpu::RenderPipeline,
    bound: [Bound; 3],
    side: u32,
    /// The depth map of the bodies as seen from the key lamp.
    pub heights: TextureView,
    pub sampler: wgpu::Sampler,
}

/// Depth test for reversed depth: greater is nearer.
const NEARER: wgpu::CompareFunction = wgpu::CompareFunction::Greater;

impl Surfaces {
    pub fn new(gpu: &Gpu) -> Self {
        let (body, settle) = (BODY.module(gpu), SETTLE.module(gpu));
        let depth = || {
            Some(wgpu::DepthStencilState {
                format: TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(NEARER),
                stencil: Default::default(),
                bias: Default::default(),
            })
        };
        let (light, place) = ([Some(LIGHT.into())], [Some(PLACE.into())]);
        Self {
            from_lamp: pipeline(gpu, &body, ["from_lamp", ""], &[], depth(), 1),
            surface: pipeline(gpu, &body, ["surface", "light"], &light, depth(), SAMPLES),
            settle: pipeline(gpu, &settle, ["everywhere", "settle"], &place, None, 1),
            bound: Default::default(),
            side: 1,
            heights: map(gpu, 1),
            sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
        }
    }

    /// Allocates a depth map with sides of `side` texels.
    pub fn fit(&mut self, gpu: &Gpu, side: u32, generation: &mut Generation) {
        if side > 0 && self.side != side {
            (self.heights, self.side) = (map(gpu, side), side);
            generation.next();
        }
    }

    /// Records the depth map.
    pub fn record_map(&mut self, job: &Job, encoder: &mut wgpu::CommandEncoder) {
        let Job { gpu, generation, uniforms, meshes, .. } = *job;
        let entries = [(0, uniforms.all()), (1, meshes.positions.all()), (3, meshes.triangles.all())];
        let layout = self.from_lamp.get_bind_group_layout(0);
        let group = self.bound[0].group(gpu, generation, layout, &entries);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("from lamp"),
            depth_stencil_attachment: nothing(&self.heights),
            ..Default::default()
        });
        pass.set_pipeline(&self.from_lamp);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3 * meshes.count, 0..1);
    }

    /// Records the camera's view of the bodies, in the shadow of `volume`. With `cut`, only the part above
    /// the ground is drawn.
    pub fn record(&mut self, job: &Job, encoder: &mut wgpu::CommandEncoder, volume: &Volume, cut: bool) {
        let Job { gpu, generation, uniforms, meshes, targets, .. } = *job;
        let entries = [
            (0, uniforms.all()),
            (1, meshes.positions.all()),
            (2, meshes.normals.all()),
            (3, meshes.triangles.all()),
            (4, meshes.cloths.all()),
            (10, BindingResource::TextureView(&volume.light)),
            (11, BindingResource::TextureView(&volume.slants)),
            (12, BindingResource::Sampler(&self.sampler)),
            (13, BindingResource::TextureView(&self.heights)),
        ];
        let [_, surface, settle] = &mut self.bound;
        let group = surface.group(gpu, generation, self.surface.get_bind_group_layout(0), &entries);
        let mut samples = clear(&targets.samples);
        if let Some(samples) = &mut samples {
            samples.resolve_target = Some(&targets.body);
            samples.ops.store = wgpu::StoreOp::Discard;
        }
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("surface"),
            color_attachments: &[samples],
            depth_stencil_attachment: nothing(&targets.nearness),
            ..Default::default()
        });
        pass.set_pipeline(&self.surface);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..if cut { 6 } else { 3 } * meshes.count, 0..1);
        drop(pass);

        let entries = [(0, uniforms.all()), (1, BindingResource::TextureView(&targets.nearness))];
        let group = settle.group(gpu, generation, self.settle.get_bind_group_layout(0), &entries);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("settle"),
            color_attachments: &[clear(&targets.place)],
            ..Default::default()
        });
        pass.set_pipeline(&self.settle);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// A depth attachment that is cleared to the farthest depth.
fn nothing(view: &TextureView) -> Option<wgpu::RenderPassDepthStencilAttachment<'_>> {
    Some(wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    })
}

fn map(gpu: &Gpu, side: u32) -> TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("heights"),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TextureFormat::Depth32Float,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}
