//! Renders the picture on the CPU, on its own thread, at a quality that fits the available time. The window
//! stays responsive, and lists the omitted work.

use super::{Pace, image, once, pane::Pane, smooth};
use crate::snapshot::{Snapshot, ViewParameters};
use eframe::{
    egui::{self, ColorImage, TextureHandle, TextureOptions},
    egui_wgpu::RenderState,
};
use hairspring_scene::Camera;
use hairspring_view::{Image, Quality, Renderer};
use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering::Relaxed},
        mpsc::{Receiver, Sender, TryRecvError, channel},
    },
    time::{Duration, Instant},
};

/// Target time for a picture of moving hair [s]: 20 per second, of which the window's own work leaves 15.
const BUDGET: f32 = 0.05;

/// Minimum time without changes before a picture in full quality is drawn.
const REST: Duration = Duration::from_millis(300);

/// A quality level.
struct Level {
    /// Picture size relative to the full size.
    scale: f32,
    /// Approximate maximum number of hairs that are interpolated and lit, unless each would represent more
    /// than [`THINNEST`].
    strands: usize,
    /// Voxels and texels of the shadows.
    shadow: [u32; 2],
}

const fn level(scale: f32, strands: usize, shadow: [u32; 2]) -> Level {
    Level { scale, strands, shadow }
}

impl Level {
    /// Stride between the drawn hairs, out of this number of hairs.
    fn every(&self, hairs: usize) -> usize {
        hairs.div_ceil(self.strands).clamp(1, THINNEST)
    }
}

/// Maximum number of hairs that one hair represents. With more, a head of hair looks like tufts.
const THINNEST: usize = 16;

/// No limit on the number of hairs.
const ALL: usize = usize::MAX;

/// From the finest to the coarsest, each faster than the previous one. At the last level, hairs are a third
/// of the work on the built-in head. The rest is the body, its shadow and pixels, so that fewer hairs would
/// save little. Shadows are blurred by neighboring hairs anyway: at half the resolution they look the same
/// and take an eighth of the voxels.
const LEVELS: [Level; 10] = [
    level(1.0, ALL, [112, 1024]),
    level(0.85, ALL, [80, 768]),
    level(0.75, ALL, [64, 512]),
    level(0.7, 20_000, [56, 512]),
    level(0.65, 8_000, [56, 512]),
    level(0.55, 4_000, [56, 512]),
    level(0.5, 2_500, [48, 384]),
    level(0.45, 2_000, [40, 384]),
    level(0.4, 1_500, [32, 256]),
    level(0.35, 900, [32, 256]),
];

/// Initial level, which is fast on a slow machine. A fast machine reaches a finer one within a second.
const FIRST: usize = 5;

/// Number of hairs that one hair is drawn as, if it represents that many or more. A single hair eight times
/// as wide looks like a ribbon; four hairs next to each other look like hair, and are drawn in a third of the
/// time that interpolating and lighting four would take. More would be finer than the pixels at the levels
/// that need them.
const WISP: usize = 4;

/// Maximum deviation of the hairs of wisps from their curves [pixels]. They deviate more from each other.
const SMOOTHNESS: f32 = 0.3;

struct Job {
    snapshot: Arc<Snapshot>,
    stage: usize,
    view: ViewParameters,
    size: [u32; 2],
    level: usize,
}

struct Done {
    image: Image,
    job: Job,
    took: f32,
}

/// The renderer of the thread.
#[derive(Default)]
struct Brush {
    renderer: Option<(Renderer, [u32; 2])>,
    /// Scene, level and lamps of the last picture that computed the hair's shadow, if no other picture has
    /// reused it yet.
    shadows: Option<(u64, usize, Camera)>,
}

impl Brush {
    /// Draws a picture; `None` if there is nothing to draw. Of moving hair, every second picture reuses the
    /// previous hair shadow. The lag of a twentieth of a second is not visible, and the shadow is a fifteenth
    /// of the work.
    fn draw(&mut self, job: &Job) -> Option<Image> {
        if self.renderer.as_ref().is_none_or(|(_, size)| *size != job.size) {
            self.renderer = Some((Renderer::new(job.size[0], job.size[1]), job.size));
            self.shadows = None;
        }
        let (renderer, _) = self.renderer.as_mut()?;
        let stage_snapshot = job.snapshot.stages.get(job.stage)?;
        let these = (job.snapshot.scene, job.level, job.view.lit_for);
        let again = job.level > 0 && self.shadows == Some(these);
        self.shadows = (!again).then_some(these);
        let image = stage_snapshot.draw(&job.view, false, |frame| {
            if again { renderer.draw_on(frame).clone() } else { renderer.draw(frame).clone() }
        });
        Some(image)
    }
}

/// How a picture is shown in the window.
enum Shows {
    /// By a dedicated pipeline.
    Pane(Box<Pane>),
    /// As an egui texture, if the window's renderer is unknown, as in tests.
    Texture(Option<TextureHandle>),
}

impl Shows {
    fn new(window: Option<&RenderState>) -> Self {
        window.map_or(Self::Texture(None), |state| Self::Pane(Box::new(Pane::new(state))))
    }
}

/// What a picture shows: scene and number of the snapshot, the view, and the full size [pixels].
type Picture = (u64, u64, ViewParameters, [u32; 2]);

/// Renders one view on the CPU.
pub struct CpuPainter {
    jobs: Sender<Job>,
    done: Receiver<Done>,
    /// Whether a picture is being drawn.
    busy: Arc<AtomicBool>,
    shows: Shows,
    /// The picture that the window shows now.
    wanted: Option<Picture>,
    /// The last requested picture, which is not drawn again while it is the same.
    requested: Option<Picture>,
    /// The current picture.
    drawn: Option<Picture>,
    /// The moment shown by the current picture.
    moment: Option<Arc<Snapshot>>,
    level: usize,
    /// Level of the current picture, and the stride of its hairs.
    seen: usize,
    every: usize,
    /// Time of a picture at this level, averaged over some pictures [s].
    took: f32,
    pace: Pace,
    moved: Instant,
}

impl CpuPainter {
    /// Starts the thread, which draws with a pool of `threads` threads. It wakes the window when a picture is
    /// finished.
    pub fn new(ctx: &egui::Context, window: Option<&RenderState>, threads: usize) -> Self {
        let (jobs, todo) = channel::<Job>();
        let (finished, done) = channel();
        let ctx = ctx.clone();
        std::thread::spawn(move || {
            // A separate thread pool. In a shared one, a step of the simulation would wait for a whole
            // picture.
            let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads).build() else { return };
            let mut brush = Brush::default();
            for job in todo {
                let began = Instant::now();
                let Some(image) = pool.install(|| brush.draw(&job)) else { continue };
                let took = began.elapsed().as_secs_f32();
                if finished.send(Done { image, job, took }).is_err() {
                    return;
                }
                once(&ctx);
            }
        });
        Self {
            jobs,
            done,
            busy: Arc::default(),
            shows: Shows::new(window),
            wanted: None,
            requested: None,
            drawn: None,
            moment: None,
            level: FIRST,
            seen: FIRST,
            every: 1,
            took: 0.0,
            pace: Pace::new(),
            moved: Instant::now(),
        }
    }

    /// Creates another painter for the same window.
    pub fn another(&self, ctx: &egui::Context, threads: usize) -> Self {
        let window = match &self.shows {
            Shows::Pane(pane) => Some(pane.state()),
            Shows::Texture(_) => None,
        };
        Self::new(ctx, window, threads)
    }

    /// A flag that tells whether a picture is being drawn.
    pub fn busy(&self) -> Arc<AtomicBool> {
        self.busy.clone()
    }

    /// Receives a finished picture.
    pub fn receive(&mut self, ctx: &egui::Context) {
        match self.done.try_recv() {
            Ok(done) => self.show(ctx, done),
            Err(TryRecvError::Disconnected) => self.busy.store(true, Relaxed),
            Err(TryRecvError::Empty) => {}
        }
    }

    /// Requests a picture of `size` pixels, unless one is being drawn.
    pub fn request(
        &mut self,
        ctx: &egui::Context,
        snapshot: &Arc<Snapshot>,
        stage: usize,
        view: &ViewParameters,
        size: [u32; 2],
    ) {
        let wanted = (snapshot.scene, snapshot.number, *view, size);
        self.wanted = Some(wanted);
        let same = self.requested == self.wanted;
        if !same {
            self.moved = Instant::now();
        }
        // A view that did not change for a moment is drawn in full quality. Steps that take long count as
        // motion.
        let rest = REST.max(3 * snapshot.took);
        let rested = self.moved.elapsed() > rest;
        let level = if rested { 0 } else { self.level };
        if !self.busy.load(Relaxed) && (!same || (rested && self.seen > 0)) {
            let Level { scale, shadow: [shadow_voxels, shadow_texels], .. } = LEVELS[level];
            let side = |s: u32| ((s as f32 * scale) as u32).max(16);
            let hairs = snapshot.stages.get(stage).map_or(0, |stage_snapshot| stage_snapshot.still.counts[1]);
            let every = LEVELS[level].every(hairs).max(view.every);
            let smoothness = if every > 1 { SMOOTHNESS } else { view.quality.smoothness };
            let wisp = every.min(WISP) as u32;
            let job = Job {
                snapshot: snapshot.clone(),
                stage,
                view: ViewParameters {
                    every,
                    quality: Quality { shadow_voxels, shadow_texels, smoothness, wisp },
                    ..*view
                },
                size: size.map(side),
                level,
            };
            self.busy.store(self.jobs.send(job).is_ok(), Relaxed);
            self.requested = self.wanted;
        } else if same && !rested {
            ctx.request_repaint_after(rest + Duration::from_millis(10));
        }
    }

    /// The moment shown by the current picture; `None` before the first.
    pub fn moment(&self) -> Option<&Arc<Snapshot>> {
        self.moment.as_ref()
    }

    /// Whether the current picture shows this moment in full quality, with the view and the size that the window asks for.
    pub fn is_whole(&self, now: &Snapshot) -> bool {
        let shows = |(scene, number, ..): &Picture| (*scene, *number) == (now.scene, now.number);
        self.seen == 0 && self.drawn == self.wanted && self.drawn.as_ref().is_some_and(shows)
    }

    /// The shape that shows the last picture at `rect`.
    pub fn shape(&self, rect: egui::Rect) -> Option<egui::Shape> {
        match &self.shows {
            Shows::Pane(pane) => pane.shape(rect),
            Shows::Texture(texture) => texture.as_ref().map(|texture| image(texture.id(), rect)),
        }
    }

    fn show(&mut self, ctx: &egui::Context, done: Done) {
        self.busy.store(false, Relaxed);
        match &mut self.shows {
            Shows::Pane(pane) => pane.take(&done.image),
            Shows::Texture(texture) => {
                let size = [done.image.width as usize, done.image.height as usize];
                let image = ColorImage::from_rgb(size, &done.image.rgb);
                *texture = Some(ctx.load_texture("hair", image, TextureOptions::LINEAR));
            }
        }
        let Job { level, snapshot, view, .. } = done.job;
        self.pace.tick(level != self.level);
        self.took = if level == self.seen { smooth(self.took, done.took) } else { done.took };
        (self.seen, self.every) = (level, view.every);
        // No other picture is requested before this one is finished.
        (self.moment, self.drawn) = (Some(snapshot), self.requested);
        if level == self.level {
            // The level is refined only if the picture surely stays within the budget, so that it does not
            // oscillate.
            if self.took > BUDGET {
                self.level = (self.level + 1).min(LEVELS.len() - 1);
            } else if self.took < 0.45 * BUDGET {
                self.level = self.level.saturating_sub(1);
            }
        }
    }

    /// Describes which work the current picture omits, its time, and the number of pictures per second.
    pub fn note(&self) -> String {
        let scale = LEVELS[self.seen].scale;
        let part = match (scale, self.every) {
            (1.0, 1) => "in full".to_owned(),
            (_, 1) => format!("at {:.0} % of the size", 100.0 * scale),
            (_, every) => format!("at {:.0} % of the size, 1 hair of {every}", 100.0 * scale),
        };
        format!("CPU: {part}, {:.0} ms{}", 1e3 * self.took, self.pace.words())
    }
}
