//! The picture by the CPU, on a thread of its own, as fine as there is time for: the window stays quick, and says what it leaves out.

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

/// Longest that a picture of moving hair should take [s]: 20 a second, of which the window's own work leaves 15.
const BUDGET: f32 = 0.05;

/// How long nothing must have changed until it is drawn in full, at least.
const REST: Duration = Duration::from_millis(300);

/// How much of a picture is drawn.
struct Level {
    /// Part of the full size.
    scale: f32,
    /// Most hairs that are placed and lit, about, unless each would stand for more than [`THINNEST`].
    strands: usize,
    /// Voxels and texels of the shadows.
    shadow: [u32; 2],
}

const fn level(scale: f32, strands: usize, shadow: [u32; 2]) -> Level {
    Level { scale, strands, shadow }
}

impl Level {
    /// Every how-manieth of so many hairs is placed.
    fn every(&self, hairs: usize) -> usize {
        hairs.div_ceil(self.strands).clamp(1, THINNEST)
    }
}

/// Most hairs that one stands for: where one is left of more, a head of hair is tufts.
const THINNEST: usize = 16;

/// However many there are.
const ALL: usize = usize::MAX;

/// From the finest to the coarsest, each quicker than the one before. Of the last, on the built-in head, hairs are a third of the
/// work: the rest is the body, its shadow, and pixels, so that fewer hairs would spare little. Shadows are blurred by a hair's neighbours anyway: half as fine, they
/// look alike and take an eighth of the voxels.
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

/// Where a slow machine is quick; a fast one is finer within a second.
const FIRST: usize = 5;

/// Hairs that one is drawn as where it stands for as many or more. One hair eight times as wide is a ribbon; four beside each other are hair, and are drawn in a
/// third of the time that it takes to place and light so many. More of them are finer than the pixels of the levels that want them.
const WISP: usize = 4;

/// How far hairs of wisps may stray from their curves [pixels]: they stray farther from each other.
const SMOOTHNESS: f32 = 0.3;

struct Job {
    snapshot: Arc<Snapshot>,
    stage: usize,
    sight: ViewParameters,
    size: [u32; 2],
    level: usize,
}

struct Done {
    image: Image,
    job: Job,
    took: f32,
}

/// What the thread draws with.
#[derive(Default)]
struct Brush {
    renderer: Option<(Renderer, [u32; 2])>,
    /// Scene, level and lamps of a picture whose hair's shadow was its own, and which no other has been drawn in.
    shadows: Option<(u64, usize, Camera)>,
}

impl Brush {
    /// A picture; `None` where there is nothing to draw. Of moving hair, every second picture is drawn in the shadow of the hair before: nobody sees that it
    /// lags by a twentieth of a second, and it is a fifteenth of the work.
    fn draw(&mut self, job: &Job) -> Option<Image> {
        if self.renderer.as_ref().is_none_or(|(_, size)| *size != job.size) {
            self.renderer = Some((Renderer::new(job.size[0], job.size[1]), job.size));
            self.shadows = None;
        }
        let (renderer, _) = self.renderer.as_mut()?;
        let scenery = job.snapshot.stages.get(job.stage)?;
        let these = (job.snapshot.scene, job.level, job.sight.lit_for);
        let again = job.level > 0 && self.shadows == Some(these);
        self.shadows = (!again).then_some(these);
        let image = scenery.draw(&job.sight, false, |frame| {
            if again { renderer.draw_on(frame).clone() } else { renderer.draw(frame).clone() }
        });
        Some(image)
    }
}

/// How a picture comes into the window.
enum Shows {
    /// By a pipeline of its own.
    Pane(Box<Pane>),
    /// By the window's library: where nobody knows what it draws with, as in tests.
    Texture(Option<TextureHandle>),
}

impl Shows {
    fn new(window: Option<&RenderState>) -> Self {
        window.map_or(Self::Texture(None), |state| Self::Pane(Box::new(Pane::new(state))))
    }
}

/// Draws one view.
pub struct CpuPainter {
    jobs: Sender<Job>,
    done: Receiver<Done>,
    /// Whether a picture is being drawn.
    busy: Arc<AtomicBool>,
    shows: Shows,
    /// What the picture shows: not drawn again while it is the same.
    shown: Option<(u64, u64, ViewParameters, [u32; 2])>,
    /// The moment of the picture that is seen.
    moment: Option<Arc<Snapshot>>,
    level: usize,
    /// Level of the picture that is seen, and every how-manieth hair it shows.
    seen: usize,
    every: usize,
    /// What a picture of this level takes, over some pictures [s].
    took: f32,
    pace: Pace,
    moved: Instant,
}

impl CpuPainter {
    /// Starts the thread, which draws on so many others; it wakes the window when a picture is there.
    pub fn new(ctx: &egui::Context, window: Option<&RenderState>, threads: usize) -> Self {
        let (jobs, todo) = channel::<Job>();
        let (finished, done) = channel();
        let ctx = ctx.clone();
        std::thread::spawn(move || {
            // Threads of its own: in one pool, a step of the simulation would wait behind a whole picture.
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
            shown: None,
            moment: None,
            level: FIRST,
            seen: FIRST,
            every: 1,
            took: 0.0,
            pace: Pace::new(),
            moved: Instant::now(),
        }
    }

    /// Another for the same window.
    pub fn another(&self, ctx: &egui::Context, threads: usize) -> Self {
        let window = match &self.shows {
            Shows::Pane(pane) => Some(pane.state()),
            Shows::Texture(_) => None,
        };
        Self::new(ctx, window, threads)
    }

    /// Whether a picture is being drawn, now and later.
    pub fn busy(&self) -> Arc<AtomicBool> {
        self.busy.clone()
    }

    /// Takes a picture that is done.
    pub fn look(&mut self, ctx: &egui::Context) {
        match self.done.try_recv() {
            Ok(done) => self.show(ctx, done),
            Err(TryRecvError::Disconnected) => self.busy.store(true, Relaxed),
            Err(TryRecvError::Empty) => {}
        }
    }

    /// Asks for a picture of `size` pixels where none is being drawn.
    pub fn ask(
        &mut self,
        ctx: &egui::Context,
        snapshot: &Arc<Snapshot>,
        stage: usize,
        sight: &ViewParameters,
        size: [u32; 2],
    ) {
        let wanted = (snapshot.scene, snapshot.number, *sight, size);
        let same = self.shown == Some(wanted);
        if !same {
            self.moved = Instant::now();
        }
        // What has stood still for a moment is drawn in full; a play whose steps are long moves.
        let rest = REST.max(3 * snapshot.took);
        let rested = self.moved.elapsed() > rest;
        let level = if rested { 0 } else { self.level };
        if !self.busy.load(Relaxed) && (!same || (rested && self.seen > 0)) {
            let Level { scale, shadow: [shadow_voxels, shadow_texels], .. } = LEVELS[level];
            let side = |s: u32| ((s as f32 * scale) as u32).max(16);
            let hairs = snapshot.stages.get(stage).map_or(0, |scenery| scenery.still.counts[1]);
            let every = LEVELS[level].every(hairs).max(sight.every);
            let smoothness = if every > 1 { SMOOTHNESS } else { sight.quality.smoothness };
            let wisp = every.min(WISP) as u32;
            let job = Job {
                snapshot: snapshot.clone(),
                stage,
                sight: ViewParameters {
                    every,
                    quality: Quality { shadow_voxels, shadow_texels, smoothness, wisp },
                    ..*sight
                },
                size: size.map(side),
                level,
            };
            self.busy.store(self.jobs.send(job).is_ok(), Relaxed);
            self.shown = Some(wanted);
        } else if same && !rested {
            ctx.request_repaint_after(rest + Duration::from_millis(10));
        }
    }

    /// The moment of the picture that is seen; `None` before the first.
    pub fn moment(&self) -> Option<&Arc<Snapshot>> {
        self.moment.as_ref()
    }

    /// Whether the picture that is seen is of this moment and leaves nothing out.
    pub fn is_whole(&self, now: &Snapshot) -> bool {
        self.seen == 0 && self.moment.as_ref().is_some_and(|m| (m.scene, m.number) == (now.scene, now.number))
    }

    /// The last picture, laid in at `rect`.
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
        let Job { level, snapshot, sight, .. } = done.job;
        self.pace.tick(level != self.level);
        self.took = if level == self.seen { smooth(self.took, done.took) } else { done.took };
        (self.seen, self.every) = (level, sight.every);
        self.moment = Some(snapshot);
        if level == self.level {
            // Finer only where that would surely fit: it must not go to and fro.
            if self.took > BUDGET {
                self.level = (self.level + 1).min(LEVELS.len() - 1);
            } else if self.took < 0.45 * BUDGET {
                self.level = self.level.saturating_sub(1);
            }
        }
    }

    /// What is left out of the picture that is seen, how long it took, and how many come in a second.
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
