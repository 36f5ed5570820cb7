//! The picture by the CPU, on a thread of its own, as fine as there is time for: the window stays quick, and says what it leaves out.

use crate::snapshot::{Sight, Snapshot};
use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions};
use hairspring_view::{Image, Renderer};
use std::{
    sync::{
        Arc,
        mpsc::{Receiver, Sender, TryRecvError, channel},
    },
    time::{Duration, Instant},
};

/// Longest that a picture of moving hair should take [s]: 20 a second, of which the window's own work leaves 15.
const BUDGET: f32 = 0.05;

/// Parts of the full size, and every how-manieth hair, from the finest to the coarsest. Fewer hairs than the last are no picture of a head of hair.
const LEVELS: [(f32, usize); 8] =
    [(1.0, 1), (0.75, 1), (0.75, 2), (0.5, 2), (0.5, 4), (0.4, 4), (0.33, 8), (0.25, 8)];

struct Job {
    snapshot: Arc<Snapshot>,
    stage: usize,
    sight: Sight,
    size: [u32; 2],
    level: usize,
}

struct Done {
    image: Image,
    took: f32,
    level: usize,
}

/// Draws one view.
pub struct CpuPainter {
    jobs: Sender<Job>,
    done: Receiver<Done>,
    busy: bool,
    texture: Option<TextureHandle>,
    /// What the picture shows: not drawn again while it is the same.
    shown: Option<(u64, u64, Sight, [u32; 2])>,
    level: usize,
    /// Level of the picture that is seen.
    seen: usize,
    took: f32,
    moved: Instant,
}

impl CpuPainter {
    /// Starts the thread, which draws on so many others; it wakes the window when a picture is there.
    pub fn new(ctx: &egui::Context, threads: usize) -> Self {
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
                let image = pool.install(|| scenery.draw(&job.sight, |frame| renderer.draw(frame).clone()));
                drop(job.snapshot);
                let took = began.elapsed().as_secs_f32();
                if finished.send(Done { image, took, level: job.level }).is_err() {
                    return;
                }
                ctx.request_repaint();
            }
        });
        Self {
            jobs,
            done,
            busy: false,
            texture: None,
            shown: None,
            // From where a slow machine is quick; a fast one is finer within a second.
            level: 3,
            seen: 3,
            took: 0.0,
            moved: Instant::now(),
        }
    }

    /// Asks for a picture of `size` pixels where none is being drawn, and returns the last one.
    pub fn draw(
        &mut self,
        ctx: &egui::Context,
        snapshot: &Arc<Snapshot>,
        stage: usize,
        sight: &Sight,
        size: [u32; 2],
    ) -> Option<egui::TextureId> {
        match self.done.try_recv() {
            Ok(done) => self.show(ctx, done),
            Err(TryRecvError::Disconnected) => self.busy = true,
            Err(TryRecvError::Empty) => {}
        }
        let wanted = (snapshot.scene, snapshot.number, *sight, size);
        let same = self.shown == Some(wanted);
        if !same {
            self.moved = Instant::now();
        }
        // What has stood still for a moment is drawn in full.
        let rested = self.moved.elapsed() > Duration::from_millis(300);
        let level = if rested { 0 } else { self.level };
        if !self.busy && (!same || (rested && self.seen > 0)) {
            let (scale, every) = LEVELS[level];
            let side = |s: u32| ((s as f32 * scale) as u32).max(16);
            let job = Job {
                snapshot: snapshot.clone(),
                stage,
                sight: Sight { every: every.max(sight.every), ..*sight },
                size: size.map(side),
                level,
            };
            self.busy = self.jobs.send(job).is_ok();
            self.shown = Some(wanted);
        } else if same && !rested {
            ctx.request_repaint_after(Duration::from_millis(310));
        }
        self.texture.as_ref().map(TextureHandle::id)
    }

    fn show(&mut self, ctx: &egui::Context, done: Done) {
        self.busy = false;
        let size = [done.image.width as usize, done.image.height as usize];
        let image = ColorImage::from_rgb(size, &done.image.rgb);
        match &mut self.texture {
            Some(texture) => texture.set(image, TextureOptions::LINEAR),
            None => self.texture = Some(ctx.load_texture("hair", image, TextureOptions::LINEAR)),
        }
        (self.took, self.seen) = (done.took, done.level);
        if done.level == self.level {
            // Finer only where that would surely fit: it must not go to and fro.
            if done.took > BUDGET {
                self.level = (self.level + 1).min(LEVELS.len() - 1);
            } else if done.took < 0.45 * BUDGET {
                self.level = self.level.saturating_sub(1);
            }
        }
    }

    /// What is left out of the picture that is seen, and how long it took.
    pub fn note(&self) -> String {
        let (scale, every) = LEVELS[self.seen];
        let part = match (scale, every) {
            (1.0, 1) => "in full".to_owned(),
            (_, 1) => format!("at {:.0} % of the size", 100.0 * scale),
            _ => format!("at {:.0} % of the size, 1 hair of {every}", 100.0 * scale),
        };
        format!("CPU: {part}, {:.0} ms", 1e3 * self.took)
    }
}
