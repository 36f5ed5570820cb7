//! The loop of the thread: it executes commands between steps, and advances when a step is due.

use super::{Order, RATE, STEP, Shared, frames::Frames, lock};
use crate::{
    drag_limiter::{FASTEST, FASTEST_HEAD, Pulled, Pushing},
    error::AppError,
    memory,
    snapshot::{Snapshot, Still},
};
use hairspring::simulation::{Energy, ManipulatorId, Measure};
use hairspring_scene::{
    Scene,
    stage::{FrameRate, FrameReport, Picked, PosedBody, Stage, Value},
};
use hairspring_view::gpu::Gpu;
use std::{
    sync::{
        Arc,
        atomic::Ordering::Relaxed,
        mpsc::{Receiver, RecvTimeoutError, channel},
    },
    time::{Duration, Instant},
};

/// Maximum time between published snapshots if nobody requests them [s]. A window that draws more slowly than
/// the simulation then gets a recent state.
const SHOWN: Duration = Duration::from_millis(33);

/// Time after opening a scene until the window has released all of the previous one.
const LEFT: Duration = Duration::from_secs(1);

/// State of the thread.
pub(super) struct Work {
    pub(super) inbox: Receiver<Order>,
    pub(super) shared: Arc<Shared>,
    pub(super) card: Option<Gpu>,
    pub(super) wake: Box<dyn Fn() + Send>,
    pub(super) stages: Vec<(Stage, Arc<Still>)>,
    pub(super) playing: bool,
    pub(super) speed: f32,
    /// First and last frame of the loop.
    pub(super) range: Option<(u64, u64)>,
    pub(super) frames: Frames,
    /// Whether the kept frames are not those that the scene would play by itself: a tool or another setting
    /// changed the motion.
    pub(super) touched: bool,
    pub(super) tool: Option<Vec<ManipulatorId>>,
    /// Poses of the body and of the tool, which follow the pointer.
    pub(super) body: Pulled,
    pub(super) carried: Pulled,
    pub(super) pushing: Option<Pushing>,
    pub(super) show: Option<Value>,
    pub(super) picked: Option<Picked>,
    pub(super) scene: u64,
    pub(super) step: u64,
    pub(super) published: u64,
    pub(super) reset_strands: usize,
    /// The last report of each stage.
    pub(super) reports: Vec<FrameReport>,
    /// The last measurements of each stage, and their scene and step.
    pub(super) measures: Vec<(Measure, Energy)>,
    pub(super) measured: (u64, u64),
    /// Whether steps were played without interpolating the follow hairs.
    pub(super) unshown: bool,
    /// Total time of a step, averaged over some steps.
    pub(super) took: Duration,
    /// Time of the last published snapshot.
    pub(super) shown: Instant,
    /// Time at which the next step is due.
    pub(super) due: Instant,
    /// Snapshots whose memory is reused once the window has released them.
    pub(super) pool: Vec<Arc<Snapshot>>,
    /// Time at which the memory of the last scene is returned to the system.
    pub(super) tidy: Option<Instant>,
}

impl Work {
    pub(super) fn new() -> Self {
        Self {
            inbox: channel().1,
            shared: Arc::default(),
            card: None,
            wake: Box::new(|| ()),
            stages: Vec::new(),
            playing: false,
            speed: 1.0,
            range: None,
            frames: Frames::default(),
            touched: false,
            tool: None,
            body: Pulled::default(),
            carried: Pulled::default(),
            pushing: None,
            show: None,
            picked: None,
            scene: 0,
            step: 0,
            published: 0,
            reset_strands: 0,
            reports: Vec::new(),
            measures: Vec::new(),
            measured: (0, 0),
            unshown: false,
            took: Duration::ZERO,
            shown: Instant::now(),
            due: Instant::now(),
            pool: Vec::new(),
            tidy: None,
        }
    }

    pub(super) fn run(&mut self) {
        loop {
            if self.tidy.is_some_and(|tidy| tidy <= Instant::now()) {
                self.tidy = None;
                memory::give_back();
            }
            let idle = !self.playing || self.stages.is_empty();
            let until = if idle { self.tidy } else { Some(self.due) };
            let wait = until
                .map_or(Duration::from_secs(3600), |until| until.saturating_duration_since(Instant::now()));
            match self.inbox.recv_timeout(wait) {
                Ok(order) => {
                    // Commands that have arrived in the meantime belong to the same moment.
                    let orders: Vec<Order> = std::iter::once(order).chain(self.inbox.try_iter()).collect();
                    let last = orders.iter().rposition(|o| matches!(o, Order::Open(..))).unwrap_or(0);
                    let mut changed = false;
                    for (k, order) in orders.into_iter().enumerate() {
                        match order {
                            // A scene that is replaced by a later command is not built.
                            Order::Open(..) if k < last => self.scene += 1,
                            order => changed |= self.execute(order),
                        }
                    }
                    if changed {
                        self.publish();
                    }
                }
                Err(RecvTimeoutError::Timeout) if !idle => {
                    let began = Instant::now();
                    self.advance(RATE);
                    if self.shared.seen.load(Relaxed) || self.shown.elapsed() > SHOWN {
                        self.publish();
                    }
                    // Averaged, because steps that are shown take longer than others.
                    let took = began.elapsed();
                    self.took = if self.step < 2 { took } else { self.took.mul_f32(0.9) + took.mul_f32(0.1) };
                    let frame = Duration::from_secs_f32(STEP / self.speed);
                    // A step that took too long is not caught up: the scene plays more slowly.
                    self.due = (self.due + frame).max(Instant::now());
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    /// Executes a command. Returns whether there is something new to show.
    fn execute(&mut self, order: Order) -> bool {
        match order {
            Order::Open(scene, other) => {
                let stages: Result<Vec<_>, _> = [Some(scene), other]
                    .into_iter()
                    .flatten()
                    .map(|s| open(*s, self.card.as_ref()))
                    .collect();
                match stages {
                    Ok(stages) => {
                        self.stages = stages;
                        self.reports = vec![FrameReport::default(); self.stages.len()];
                        self.pool.clear();
                        self.tidy = Some(Instant::now() + LEFT);
                        (self.step, self.reset_strands) = (0, 0);
                        (self.tool, self.picked, self.unshown) = (None, None, false);
                        (self.body, self.pushing) = (Pulled::default(), None);
                        self.due = Instant::now();
                        self.touched = false;
                        self.frames.clear();
                        self.keep();
                    }
                    Err(why) => *lock(&self.shared.error) = Some(why),
                }
                self.scene += 1;
            }
            Order::Retune(scene, other) => {
                for ((stage, _), scene) in
                    self.stages.iter_mut().zip([Some(scene), other].into_iter().flatten())
                {
                    if let Err(why) = stage.update_settings(*scene) {
                        *lock(&self.shared.error) = Some(why.into());
                    }
                }
                self.touched = true;
                self.frames.clear();
                self.keep();
            }
            Order::Play(playing) => {
                self.playing = playing;
                self.due = Instant::now();
                // The last frames may not have been published.
                return !playing && self.unshown;
            }
            Order::Step(rate) => {
                let began = Instant::now();
                self.advance(rate);
                self.took = began.elapsed();
            }
            Order::Reset => self.reset(),
            Order::Speed(speed) => {
                self.speed = speed.clamp(0.01, 10.0);
                return false;
            }
            Order::Loop(range) => {
                self.range = range;
                return false;
            }
            Order::Seek(frame) => return self.seek(frame),
            Order::Take(tool, pose) => {
                self.let_go();
                let mut taken = Vec::with_capacity(self.stages.len());
                for (stage, _) in &mut self.stages {
                    taken.push(stage.add_manipulator(tool, pose));
                }
                self.tool = Some(taken);
                self.carried = Pulled::at(pose);
                return false;
            }
            Order::Carry(pose) => {
                self.carried.wanted = pose;
                return false;
            }
            Order::LetGo => {
                self.let_go();
                return false;
            }
            Order::Push(push) => {
                match (push, &mut self.pushing) {
                    (Some(push), Some(pushing)) => {
                        pushing.want(push);
                        return false;
                    }
                    (Some(push), none) => *none = Some(Pushing::new(push, body(&self.stages))),
                    (None, pushing) => *pushing = None,
                }
                self.place_pushed();
            }
            Order::Body(by) => {
                self.body.wanted = by;
                return false;
            }
            Order::Show(value) => self.show = value,
            #[cfg(test)]
            Order::Panic => panic!("a test wants it"),
            Order::Pick(ray) => {
                self.show();
                self.picked = ray.and_then(|(from, way)| self.stages.first()?.0.nearest_strand(from, way));
            }
        }
        true
    }

    fn let_go(&mut self) {
        for ((stage, _), id) in self.stages.iter_mut().zip(self.tool.take().into_iter().flatten()) {
            stage.remove_manipulator(id);
        }
    }

    fn reset(&mut self) {
        self.stages.iter_mut().for_each(|(stage, _)| stage.reset());
        (self.tool, self.unshown) = (None, false);
        self.due = Instant::now();
    }

    /// Moves what follows the pointer, for one step.
    fn pull(&mut self) {
        if self.body.go(FASTEST_HEAD) {
            self.stages.iter_mut().for_each(|(stage, _)| stage.move_body(self.body.now));
        }
        if self.tool.is_some() && self.carried.go(FASTEST) {
            for ((stage, _), id) in self.stages.iter_mut().zip(self.tool.iter().flatten()) {
                stage.set_manipulator_pose(*id, self.carried.now);
            }
        }
        if self.pushing.as_mut().is_some_and(|pushing| pushing.go(body(&self.stages))) {
            self.place_pushed();
        }
    }

    /// Updates the user colliders of all stages.
    fn place_pushed(&mut self) {
        let (shapes, pose) = self.pushing.as_ref().map(Pushing::placed).unwrap_or_default();
        self.stages.iter_mut().for_each(|(stage, _)| stage.set_user_colliders(shapes, pose));
    }

    /// The frame that is shown, counted from 0 at time 0.
    pub(super) fn frame(&self) -> u64 {
        self.stages.first().map_or(0, |(stage, _)| (stage.time() / f64::from(STEP)).round() as u64)
    }

    /// Keeps the current frame for the timeline. A moment between two frames, as recordings at other rates have
    /// them, is not kept.
    fn keep(&mut self) {
        let frame = self.frame();
        let between = |(stage, _): &(Stage, _)| (stage.time() - RATE.time_of(frame)).abs() > 1e-4;
        if !self.stages.iter().any(between) {
            let held = (self.tool.as_deref(), self.body.now);
            self.frames.keep(frame, self.stages.iter().map(|(stage, _)| stage), held);
        }
    }

    /// Goes to the nearest kept frame. What the pointer holds is released.
    fn seek(&mut self, frame: u64) -> bool {
        let Some(kept) = self.frames.nearest(frame).and_then(|frame| self.frames.get(frame)) else {
            return false;
        };
        self.tool = None;
        for (k, ((stage, _), state)) in self.stages.iter_mut().zip(&kept.stages).enumerate() {
            if stage.restore(state).is_err() {
                return false;
            }
            if let Some(id) = kept.tool.as_ref().and_then(|tool| tool.get(k)) {
                stage.remove_manipulator(*id);
            }
        }
        self.body.now = kept.body;
        self.unshown = false;
        self.due = Instant::now();
        true
    }

    /// Goes back to the first frame of the loop, or to the start if that is not kept.
    fn go_back(&mut self, first: u64) {
        let kept = self.frames.nearest(first) == Some(first) && !self.touched;
        if first == 0 || !kept || !self.seek(first) {
            self.reset();
        }
        // It counts as a step. Otherwise a script that waits for steps would wait forever.
        self.step += 1;
    }

    fn advance(&mut self, rate: FrameRate) {
        self.pull();
        let frame = self.frame();
        if let Some((first, last)) = self.range
            && frame >= last
        {
            self.go_back(first);
            return;
        }
        let touches = self.tool.is_some() || self.pushing.is_some() || self.body.acts();
        if self.touched || touches {
            self.frames.forget_after(frame);
            // From time 0 on, the scene plays by itself again.
            self.touched = touches || frame > 0;
        }
        for ((stage, _), last) in self.stages.iter_mut().zip(&mut self.reports) {
            let report = stage.advance_frame(rate);
            self.reset_strands += report.step.reset_strands;
            *last = FrameReport { follow: last.follow, ..report };
        }
        self.unshown = true;
        self.step += 1;
        self.keep();
    }
}

/// The body of the first stage, over which a hand moves.
fn body(stages: &[(Stage, Arc<Still>)]) -> Option<PosedBody<'_>> {
    stages.first()?.0.body()
}

fn open(scene: Scene, card: Option<&Gpu>) -> Result<(Stage, Arc<Still>), AppError> {
    let mut stage = Stage::new(scene)?;
    stage.set_external_interpolation(card.is_none_or(|card| card.can_place_among(stage.colliders())));
    let still = Arc::new(Still::new(&stage));
    Ok((stage, still))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairspring_scene::{
        Guides,
        builtin::{self, BuiltinOptions},
    };

    #[test]
    fn a_pause_shows_the_last_frame() {
        let options = BuiltinOptions { strands: 10, guides: Guides::Count(5), ..BuiltinOptions::default() };
        let mut work = Work::new();
        work.execute(Order::Open(Box::new(builtin::scene(&options)), None));
        work.publish();
        work.advance(RATE);
        assert!(work.execute(Order::Play(false)), "the last frame was not published");
        work.publish();
        assert!(!work.execute(Order::Play(false)), "there is nothing new to show");
    }
}
