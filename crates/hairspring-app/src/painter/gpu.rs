//! Renders the picture on the GPU that also draws the window. Strands are uploaded, drawn and shown without a
//! readback.

use super::Pace;
use crate::snapshot::{Snapshot, ViewParameters};
use eframe::{egui::TextureId, egui_wgpu::RenderState, wgpu::FilterMode};
use hairspring_view::gpu::{Gpu, GpuRenderer};
use std::sync::Arc;

/// Renders one view on the GPU.
pub struct GpuPainter {
    state: RenderState,
    renderer: GpuRenderer,
    texture: Option<(TextureId, [u32; 2])>,
    shown: Option<(u64, u64, ViewParameters, [u32; 2])>,
    took: f32,
    pace: Pace,
    /// Whether the colors of the last picture showed a value.
    valued: bool,
}

impl GpuPainter {
    /// Creates a painter on the window's device.
    pub fn new(state: &RenderState) -> Self {
        // Without a handler, an error on the GPU would close the window.
        state
            .device
            .on_uncaptured_error(Arc::new(|error| eprintln!("hairspring: on the graphics card: {error}")));
        let gpu = Gpu::from_parts(state.device.clone(), state.queue.clone());
        Self {
            state: state.clone(),
            renderer: GpuRenderer::new(&gpu),
            texture: None,
            shown: None,
            took: 0.0,
            pace: Pace::new(),
            valued: false,
        }
    }

    /// The GPU.
    pub fn gpu(&self) -> &Gpu {
        self.renderer.gpu()
    }

    /// Creates another painter on the same device.
    pub fn another(&self) -> Self {
        Self::new(&self.state)
    }

    /// Draws the picture if it has changed.
    pub fn draw(
        &mut self,
        snapshot: &Snapshot,
        stage: usize,
        view: &ViewParameters,
        size: [u32; 2],
    ) -> Option<TextureId> {
        let stage_snapshot = snapshot.stages.get(stage)?;
        let wanted = (snapshot.scene, snapshot.number, *view, size);
        if self.shown != Some(wanted) {
            // Colors of values change in place, and another scene may have its arrays at the same addresses.
            let another = self.shown.is_none_or(|shown| shown.0 != snapshot.scene);
            if another || self.valued || !stage_snapshot.values.is_empty() {
                self.renderer.forget();
            }
            self.valued = !stage_snapshot.values.is_empty();
            let began = std::time::Instant::now();
            stage_snapshot.draw(view, true, |frame| {
                self.renderer.draw(frame, size[0], size[1]);
            });
            self.took = began.elapsed().as_secs_f32();
            self.pace.tick(another);
            self.shown = Some(wanted);
        }
        let view = self.renderer.view();
        let mut painter = self.state.renderer.write();
        match &mut self.texture {
            Some((_, shown)) if *shown == size => {}
            Some((id, shown)) => {
                painter.update_egui_texture_from_wgpu_texture(
                    &self.state.device,
                    view,
                    FilterMode::Linear,
                    *id,
                );
                *shown = size;
            }
            None => {
                let id = painter.register_native_texture(&self.state.device, view, FilterMode::Linear);
                self.texture = Some((id, size));
            }
        }
        self.texture.map(|(id, _)| id)
    }

    /// Describes the renderer, the CPU time of the last picture, and the number of pictures per second.
    pub fn note(&self) -> String {
        let name = self.state.adapter.get_info().name;
        format!("GPU: {name}, {:.1} ms to submit{}", 1e3 * self.took, self.pace.words())
    }
}

impl Drop for GpuPainter {
    fn drop(&mut self) {
        if let Some((id, _)) = self.texture {
            self.state.renderer.write().free_texture(&id);
        }
    }
}
