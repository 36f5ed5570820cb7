//! The renderers of the hair: a GPU if there is one, otherwise the CPU rasterizer.

mod cpu;
mod gpu;
mod pane;
#[cfg(test)]
mod tests;

use crate::{
    snapshot::{Snapshot, ViewParameters},
    text::counted,
};
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

/// The renderer for the hair.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Drawn {
    /// The GPU, if the window has a hardware one, otherwise the CPU.
    #[default]
    Auto,
    /// The window's device, even if it is a software driver.
    Gpu,
    /// The CPU rasterizer.
    Cpu,
}

/// Renders one view of the window.
pub enum Painter {
    /// On the window's device.
    Gpu(Box<GpuPainter>),
    /// On CPU threads.
    Cpu(Box<CpuPainter>),
}

impl Painter {
    /// Creates the painter of a new window.
    pub fn new(creation: &eframe::CreationContext<'_>, drawn: Drawn) -> Self {
        let software = |kind: DeviceType| kind == DeviceType::Cpu;
        let state = creation.wgpu_render_state.as_ref().filter(|state| match drawn {
            // A rasterizer made for hair is ten times as fast as a software GPU driver.
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

    /// Creates another painter of the same kind, for a second view.
    pub fn another(&self, ctx: &egui::Context) -> Self {
        match self {
            Self::Gpu(painter) => Self::Gpu(Box::new(painter.another())),
            Self::Cpu(painter) => Self::Cpu(Box::new(painter.another(ctx, half()))),
        }
    }

    /// Number of threads that are left for the simulation.
    pub fn spared(&self) -> usize {
        match self {
            Self::Gpu(_) => processors(),
            Self::Cpu(_) => half(),
        }
    }

    /// The GPU, if one draws.
    pub fn gpu(&self) -> Option<Gpu> {
        match self {
            Self::Gpu(painter) => Some(painter.gpu().clone()),
            Self::Cpu(_) => None,
        }
    }

    /// Returns a function that is called when there is something new to show. A window that waits for a
    /// picture of the CPU is woken only by that picture. Before it, the window could only draw the last
    /// picture again, which takes a software driver as long as a new one.
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

    /// Draws a stage of a snapshot with `size` pixels and shows it at `rect`. While the picture is not
    /// finished, the last one is shown.
    pub fn draw(
        &mut self,
        ctx: &egui::Context,
        snapshot: &Arc<Snapshot>,
        stage: usize,
        view: &ViewParameters,
        (rect, size): (egui::Rect, [u32; 2]),
    ) -> Option<egui::Shape> {
        match self {
            Self::Gpu(painter) => painter.draw(snapshot, stage, view, size).map(|id| image(id, rect)),
            Self::Cpu(painter) => {
                painter.request(ctx, snapshot, stage, view, size);
                painter.shape(rect)
            }
        }
    }

    /// The moment of the current picture, so that overlays match it: a picture of the CPU shows a past frame.
    pub fn moment<'a>(&'a self, now: &'a Arc<Snapshot>) -> &'a Arc<Snapshot> {
        match self {
            Self::Gpu(_) => now,
            Self::Cpu(painter) => painter.moment().filter(|m| m.scene == now.scene).unwrap_or(now),
        }
    }

    /// Whether the current picture shows this moment in full quality.
    pub fn is_whole(&self, now: &Snapshot) -> bool {
        match self {
            Self::Gpu(_) => true,
            Self::Cpu(painter) => painter.is_whole(now),
        }
    }

    /// Describes how the picture is drawn.
    pub fn note(&self) -> String {
        match self {
            Self::Gpu(painter) => painter.note(),
            Self::Cpu(painter) => painter.note(),
        }
    }
}

/// Receives the finished pictures, then gets the latest snapshot by `latest`. In the other order, a snapshot that is
/// published between the two would never be shown: its painter still counts as busy, so it does not wake the window, and
/// the picture that the window receives was already awaited.
pub fn receive<T>(painters: &mut [Painter], ctx: &egui::Context, latest: impl FnOnce() -> T) -> T {
    for painter in painters {
        if let Painter::Cpu(painter) = painter {
            painter.receive(ctx);
        }
    }
    latest()
}

/// Measures the rate of pictures of moving hair.
struct Pace {
    /// Time between two pictures, averaged over some pictures [s]; 0 before the second.
    mean: f32,
    came: Instant,
}

impl Pace {
    fn new() -> Self {
        Self { mean: 0.0, came: Instant::now() }
    }

    /// Counts a picture. `restart` restarts the measurement: use it when the picture does not continue a series.
    fn tick(&mut self, restart: bool) {
        let since = self.came.elapsed().as_secs_f32();
        self.came = Instant::now();
        // The measurement restarts after a pause.
        self.mean = if restart || since > 1.0 { 0.0 } else { smooth(self.mean, since) };
    }

    /// The rate as text that is appended to other text.
    fn words(&self) -> String {
        match self.mean {
            0.0 => String::new(),
            mean => format!("; {} a second", counted((1.0 / mean).round() as u64, "picture")),
        }
    }
}

/// Updates a running mean with the value `last`; a mean of 0 means that it is the first.
fn smooth(mean: f32, last: f32) -> f32 {
    if mean == 0.0 { last } else { mean + SMOOTH * (last - mean) }
}

/// Weight of the last value in a mean.
const SMOOTH: f32 = 0.3;

/// Requests one repaint of the window. Without a delay, egui would repaint twice.
fn once(ctx: &egui::Context) {
    ctx.request_repaint_after(Duration::from_millis(1));
}

/// Shows a whole texture at `rect`.
fn image(texture: egui::TextureId, rect: egui::Rect) -> egui::Shape {
    let all = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
    egui::Shape::image(texture, rect, all, egui::Color32::WHITE)
}

fn processors() -> usize {
    rayon::current_num_threads()
}

/// Half of the processors: simulation and painter share them equally.
fn half() -> usize {
    (processors() / 2).max(1)
}
