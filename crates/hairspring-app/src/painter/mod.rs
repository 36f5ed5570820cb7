//! Who draws the hair: a GPU where there is one, else the CPU rasteriser.

mod cpu;
mod gpu;
mod pane;

use crate::snapshot::{Snapshot, ViewParameters};
use cpu::CpuPainter;
use eframe::{egui, wgpu::DeviceType};
use gpu::GpuPainter;
use hairspring_view::gpu::Gpu;
use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering::Relaxed},
    },
    time::{Duration, Instant},
};

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
            None => {
                let window = creation.wgpu_render_state.as_ref();
                Self::Cpu(Box::new(CpuPainter::new(&creation.egui_ctx, window, half())))
            }
        }
    }

    /// Another of the same kind, for a second view.
    pub fn another(&self, ctx: &egui::Context) -> Self {
        match self {
            Self::Gpu(painter) => Self::Gpu(Box::new(painter.another())),
            Self::Cpu(painter) => Self::Cpu(Box::new(painter.another(ctx, half()))),
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
            Self::Gpu(painter) => Some(painter.gpu().clone()),
            Self::Cpu(_) => None,
        }
    }

    /// What is to be called when there is something new to see. A window that waits for a picture by the CPU is woken by that alone: all that it could
    /// do before is to draw the last one once more, which takes a software driver as long as the picture.
    pub fn wake(&self, ctx: &egui::Context) -> impl Fn() + Send + 'static {
        let ctx = ctx.clone();
        let busy = match self {
            Self::Gpu(_) => Arc::<AtomicBool>::default(),
            Self::Cpu(painter) => painter.busy(),
        };
        move || {
            if !busy.load(Relaxed) {
                once(&ctx);
            }
        }
    }

    /// The picture of a stage of a snapshot, `size` pixels large and laid in at `rect`, or the last one where that is not ready yet.
    pub fn draw(
        &mut self,
        ctx: &egui::Context,
        snapshot: &Arc<Snapshot>,
        stage: usize,
        sight: &ViewParameters,
        (rect, size): (egui::Rect, [u32; 2]),
    ) -> Option<egui::Shape> {
        match self {
            Self::Gpu(painter) => painter.draw(snapshot, stage, sight, size).map(|id| image(id, rect)),
            Self::Cpu(painter) => {
                painter.ask(ctx, snapshot, stage, sight, size);
                painter.shape(rect)
            }
        }
    }

    /// Takes the picture that is done; the moment of the one that is seen, so that what is laid over it fits: one by the CPU is of a step that has passed.
    pub fn moment(&mut self, ctx: &egui::Context, now: &Arc<Snapshot>) -> Arc<Snapshot> {
        match self {
            Self::Gpu(_) => now.clone(),
            Self::Cpu(painter) => {
                painter.look(ctx);
                painter.moment().filter(|m| m.scene == now.scene).unwrap_or(now).clone()
            }
        }
    }

    /// Whether the picture that is seen is of this moment and leaves nothing out.
    pub fn is_whole(&self, now: &Snapshot) -> bool {
        match self {
            Self::Gpu(_) => true,
            Self::Cpu(painter) => painter.is_whole(now),
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

/// How fast pictures of moving hair come.
struct Pace {
    /// From one to the next, over some pictures [s]; 0 before the second.
    mean: f32,
    came: Instant,
}

impl Pace {
    fn new() -> Self {
        Self { mean: 0.0, came: Instant::now() }
    }

    /// A picture is there; `anew`: it is not one of a row.
    fn tick(&mut self, anew: bool) {
        let since = self.came.elapsed().as_secs_f32();
        self.came = Instant::now();
        // What stood still begins anew.
        self.mean = if anew || since > 1.0 { 0.0 } else { smooth(self.mean, since) };
    }

    /// In words, behind others.
    fn words(&self) -> String {
        match self.mean {
            0.0 => String::new(),
            mean => format!("; {:.0} pictures a second", 1.0 / mean),
        }
    }
}

/// A mean over some values, of which the last is one; 0: it is the first.
fn smooth(mean: f32, last: f32) -> f32 {
    if mean == 0.0 { last } else { mean + SMOOTH * (last - mean) }
}

/// How much of the last value counts in a mean.
const SMOOTH: f32 = 0.3;

/// Lets the window draw itself. Asked without a delay, egui does so twice.
fn once(ctx: &egui::Context) {
    ctx.request_repaint_after(Duration::from_millis(1));
}

/// All of a texture at `rect`.
fn image(texture: egui::TextureId, rect: egui::Rect) -> egui::Shape {
    let all = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
    egui::Shape::image(texture, rect, all, egui::Color32::WHITE)
}

fn processors() -> usize {
    rayon::current_num_threads()
}

/// Simulation and painter have half of the processors each.
fn half() -> usize {
    (processors() / 2).max(1)
}
