//! The picture by the CPU, on a thread of its own, as fine as there is time for: the window stays quick, and says what it leaves out.

use super::{Pace, image, once, pane::Pane, smooth};
use crate::snapshot::{Sight, Snapshot};
use eframe::{
    egui::{self, ColorImage, TextureHandle, TextureOptions},
    egui_wgpu::RenderState,
};
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

/// How much of a picture is drawn.
struct Level {
    /// Part of the full size.
    scale: f32,
    /// Every how-manieth hair.
    every: usize,
    /// Voxels and texels of the shadows.
    shadow: [u32; 2],
}

const fn level(scale: f32, every: usize, shadow: [u32; 2]) -> Level {
    Level { scale, every, shadow }
}

/// From the finest to the coarsest. Fewer hairs than the last are no picture of a head of hair. Shadows are blurred by a hair's neighbours anyway: half as fine, they
/// look alike and take an eighth of the voxels.
const LEVELS: [Level; 9] = [
    level(1.0, 1, [112, 1024]),
    level(0.85, 1, [80, 768]),
    level(0.75, 1, [64, 512]),
    level(0.65, 2, [56, 512]),
    level(0.55, 2, [56, 512]),
    level(0.5, 3, [48, 384]),
    level(0.45, 4, [40, 384]),
    level(0.4, 6, [32, 256]),
    level(0.35, 8, [32, 256]),
];

struct Job {
    snapshot: Arc<Snapshot>,
    stage: usize,
    sight: Sight,
    size: [u32; 2],
    level: usize,
}

struct Done {
    image: Image,
    snapshot: Arc<Snapshot>,
    took: f32,
    level: usize,
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
    shown: Option<(u64, u64, Sight, [u32; 2])>,
    /// The moment of the picture that is seen.
    moment: Option<Arc<Snapshot>>,
    level: usize,
    /// Level of the picture that is seen.
    seen: usize,
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
            let mut renderer: Option<(Renderer, [u32; 2])> = None;
            for job in todo {
                let began = Instant::now();
                if renderer.as_ref().is_none_or(|(_, size)| *size != job.size) {
                    renderer = Some((Renderer::new(job.size[0], job.size[1]), job.size));
                }
                let Some((renderer, _)) = &mut renderer else { continue };
                let Some(scenery) = job.snapshot.stages.get(job.stage) else { continue };
                let image =
                    pool.install(|| scenery.draw(&job.sight, false, |frame| renderer.draw(frame).clone()));
                let took = began.elapsed().as_secs_f32();
                if finished.send(Done { image, snapshot: job.snapshot, took, level: job.level }).is_err() {
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
            // From where a slow machine is quick; a fast one is finer within a second.
            level: 4,
            seen: 4,
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
        sight: &Sight,
        size: [u32; 2],
    ) {
        let wanted = (snapshot.scene, snapshot.number, *sight, size);
        let same = self.shown == Some(wanted);
        if !same {
            self.moved = Instant::now();
        }
        // What has stood still for a moment is drawn in full.
        let rested = self.moved.elapsed() > Duration::from_millis(300);
        let level = if rested { 0 } else { self.level };
        if !self.busy.load(Relaxed) && (!same || (rested && self.seen > 0)) {
            let Level { scale, every, shadow: [shadow_voxels, shadow_texels] } = LEVELS[level];
            let side = |s: u32| ((s as f32 * scale) as u32).max(16);
            let job = Job {
                snapshot: snapshot.clone(),
                stage,
                sight: Sight {
                    every: every.max(sight.every),
                    quality: Quality { shadow_voxels, shadow_texels, ..sight.quality },
                    ..*sight
                },
                size: size.map(side),
                level,
            };
            self.busy.store(self.jobs.send(job).is_ok(), Relaxed);
            self.shown = Some(wanted);
        } else if same && !rested {
            ctx.request_repaint_after(Duration::from_millis(310));
        }
    }

    /// The moment of the picture that is seen; `None` before the first.
    pub fn moment(&self) -> Option<&Arc<Snapshot>> {
        self.moment.as_ref()
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
        self.pace.tick(done.level != self.level);
        self.took = if done.level == self.seen { smooth(self.took, done.took) } else { done.took };
        self.seen = done.level;
        self.moment = Some(done.snapshot);
        if done.level == self.level {
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
        let Level { scale, every, .. } = LEVELS[self.seen];
        let part = match (scale, every) {
            (1.0, 1) => "in full".to_owned(),
            (_, 1) => format!("at {:.0} % of the size", 100.0 * scale),
            _ => format!("at {:.0} % of the size, 1 hair of {every}", 100.0 * scale),
        };
        format!("CPU: {part}, {:.0} ms{}", 1e3 * self.took, self.pace.words())
    }
}
