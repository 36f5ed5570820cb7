//! Who draws the hair: a GPU where there is one, else the CPU rasteriser.

mod cpu;
mod gpu;

use crate::snapshot::{Sight, Snapshot};
use cpu::CpuPainter;
use eframe::{egui, wgpu::DeviceType};
use gpu::GpuPainter;
use hairspring_view::gpu::Gpu;
use std::sync::Arc;

/// Who draws the hair.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Drawn {
    /// By the GPU, where the window has a real one.
    #[default]
    Auto,
    /// By the window's device, even where that is software.
    Gpu,
    /// By the CPU rasteriser.
    Cpu,
}

/// Draws one view of the window.
pub enum Painter {
    /// On the window's device.
    Gpu(Box<GpuPainter>),
    /// On threads of the processor.
    Cpu(Box<CpuPainter>),
}

impl Painter {
    /// For the window that is being made.
    pub fn new(creation: &eframe::CreationContext<'_>, drawn: Drawn) -> Self {
        let software = |kind: DeviceType| kind == DeviceType::Cpu;
        let state = creation.wgpu_render_state.as_ref().filter(|state| match drawn {
            // A rasteriser made for hair is ten times as fast as a driver that plays at being a GPU.
            Drawn::Auto => !software(state.adapter.get_info().device_type),
            Drawn::Gpu => true,
            Drawn::Cpu => false,
        });
        match state {
            Some(state) => Self::Gpu(Box::new(GpuPainter::new(state))),
            None => Self::Cpu(Box::new(CpuPainter::new(&creation.egui_ctx, half()))),
        }
    }

    /// Another of the same kind, for a second view.
    pub fn another(&self, ctx: &egui::Context) -> Self {
        match self {
            Self::Gpu(painter) => Self::Gpu(Box::new(painter.another())),
            Self::Cpu(_) => Self::Cpu(Box::new(CpuPainter::new(ctx, half()))),
        }
    }

    /// Threads that are left for the simulation.
    pub fn spared(&self) -> usize {
        match self {
            Self::Gpu(_) => processors(),
            Self::Cpu(_) => half(),
        }
    }

    /// The GPU that draws, if one does.
    pub fn gpu(&self) -> Option<Gpu> {
        match self {
            Self::Gpu(painter) => Some(painter.gpu()),
            Self::Cpu(_) => None,
        }
    }

    /// The picture of a stage of a snapshot, `size` pixels large, or the last one where that is not ready yet.
    pub fn draw(
        &mut self,
        ctx: &egui::Context,
        snapshot: &Arc<Snapshot>,
        stage: usize,
        sight: &Sight,
        size: [u32; 2],
    ) -> Option<egui::TextureId> {
        match self {
            Self::Gpu(painter) => painter.draw(snapshot, stage, sight, size),
            Self::Cpu(painter) => painter.draw(ctx, snapshot, stage, sight, size),
        }
    }

    /// How it draws, in words.
    pub fn note(&self) -> String {
        match self {
            Self::Gpu(painter) => painter.note(),
            Self::Cpu(painter) => painter.note(),
        }
    }
}

fn processors() -> usize {
    rayon::current_num_threads()
}

/// Simulation and painter have half of the processors each.
fn half() -> usize {
    (processors() / 2).max(1)
}
