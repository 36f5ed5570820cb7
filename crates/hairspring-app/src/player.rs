//! The simulation on a thread of its own, at a fixed step: the picture never waits for it, and what hair does depends on no frame rate.

use crate::{
    error::AppError,
    memory,
    pulled::{FASTEST, FASTEST_HEAD, Pulled, Push, Pushing},
    snapshot::{Scenery, Snapshot, Still},
};
use glam::Vec3;
use hairspring::{
    around::Tool,
    collide::Rigid,
    scene::Scene,
    simulation::{Energy, Measure, ToolId},
    stage::{FrameReport, Picked, PosedBody, Stage, Value},
};
use hairspring_view::gpu::Gpu;
use std::{
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering::Relaxed},
        mpsc::{Receiver, RecvTimeoutError, Sender, channel},
    },
    thread::JoinHandle,
    time::{Duration, Instant},
};

/// Steps are shown at least so often [s] while nobody asks for them: a window that draws slower than the play finds a moment that is not older.
const SHOWN: Duration = Duration::from_millis(33);

/// Steps from one measurement of all strands to the next while it plays: figures that change faster cannot be read.
const MEASURED: u64 = 15;

/// How long after a scene was opened the one before has left all of the window.
const LEFT: Duration = Duration::from_secs(1);

/// Length of a step [s]: what a frame of most screens takes.
pub const STEP: f32 = 1.0 / 60.0;

/// What the thread is told.
pub enum Order {
    /// Opens a scene and, to compare, a second one beside it, at time 0.
    Open(Box<Scene>, Option<Box<Scene>>),
    /// Takes up settings in the midst of the play.
    Retune(Box<Scene>, Option<Box<Scene>>),
    /// Plays or pauses.
    Play(bool),
    /// Steps once.
    Step,
    /// Back to time 0.
    Reset,
    /// Seconds of the scene in a second, above 0.
    Speed(f32),
    /// Begins anew after so many seconds; `None`: plays on.
    Loop(Option<f32>),
    /// Takes a tool, which moves at once with every `Carry`.
    Take(Tool, Rigid),
    /// Moves it.
    Carry(Rigid),
    /// Lets go.
    LetGo,
    /// What is pushed through hair, and where the pointer has it.
    Push(Option<Push>),
    /// Where the body is carried besides its motion.
    Body(Rigid),
    /// Which number of each point is wanted.
    Show(Option<Value>),
    /// Picks the strand on a ray; `None`: none.
    Pick(Option<(Vec3, Vec3)>),
}

/// What the window and the thread share.
#[derive(Default)]
struct Shared {
    latest: Mutex<Option<Arc<Snapshot>>>,
    /// Whether the last moment has been seen, and another is wanted.
    seen: AtomicBool,
    error: Mutex<Option<AppError>>,
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    // What is behind it is replaced as a whole: a thread that panicked left nothing half done.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The window's hold on the thread. Dropped, it ends it.
pub struct Player {
    orders: Option<Sender<Order>>,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Player {
    /// A thread that calls `wake` whenever there is something new to see, and steps on so many threads: fewer than processors where another pool draws,
    /// for a step would wait at each of its ends for a thread that is not given a processor. Follow hairs are left to who draws
    /// them: a `card` where it can place them, or else the picture by the CPU, which has no use for all of them.
    pub fn new(threads: usize, card: Option<Gpu>, wake: impl Fn() + Send + 'static) -> Self {
        let (orders, inbox) = channel();
        let shared = Arc::new(Shared::default());
        let own = shared.clone();
        let thread = std::thread::Builder::new().name("simulation".into()).spawn(move || {
            let mut work = Work { inbox, shared: own, card, wake: Box::new(wake), ..Work::new() };
            match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
                Ok(pool) => pool.install(|| work.run()),
                // The pool of all is there in any case.
                Err(_) => work.run(),
            }
        });
        Self { orders: Some(orders), shared, thread: thread.ok() }
    }

    /// Tells it something. Nothing where it has ended.
    pub fn tell(&self, order: Order) {
        if let Some(orders) = &self.orders {
            // It ended by a panic, which was reported.
            let _ = orders.send(order);
        }
    }

    /// The last moment.
    pub fn latest(&self) -> Option<Arc<Snapshot>> {
        self.shared.seen.store(true, Relaxed);
        lock(&self.shared.latest).clone()
    }

    /// Why the last order could not be done, once.
    pub fn error(&self) -> Option<AppError> {
        lock(&self.shared.error).take()
    }

    /// Whether the thread ended by itself.
    pub fn is_dead(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }
}

impl Drop for Player {
    fn drop(&mut self) {
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            // Its panic was reported when it happened.
            let _ = thread.join();
        }
    }
}

/// What the thread works with.
struct Work {
    inbox: Receiver<Order>,
    shared: Arc<Shared>,
    card: Option<Gpu>,
    wake: Box<dyn Fn() + Send>,
    stages: Vec<(Stage, Arc<Still>)>,
    playing: bool,
    speed: f32,
    end: Option<f32>,
    tool: Option<Vec<Option<ToolId>>>,
    /// Where the body is carried, and a tool, and what is pushed, and where the pointer has them.
    body: Pulled,
    carried: Pulled,
    pushing: Option<Pushing>,
    show: Option<Value>,
    picked: Option<Picked>,
    scene: u64,
    step: u64,
    published: u64,
    reset_strands: usize,
    report: FrameReport,
    /// Of each stage, at the last measurement, and the scene and step of that.
    measures: Vec<(Measure, Energy)>,
    measured: (u64, u64),
    /// Steps are played whose follow hairs have not been placed.
    unshown: bool,
    /// What a step takes, all that belongs to it included, over some steps.
    took: Duration,
    /// When something was shown last.
    shown: Instant,
    /// When the next step is due.
    due: Instant,
    /// Snapshots whose memory is used again once the window has left them.
    pool: Vec<Arc<Snapshot>>,
    /// When what the last scene left behind is given back to the system.
    tidy: Option<Instant>,
}

impl Work {
    fn new() -> Self {
        Self {
            inbox: channel().1,
            shared: Arc::default(),
            card: None,
            wake: Box::new(|| ()),
            stages: Vec::new(),
            playing: false,
            speed: 1.0,
            end: None,
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
            report: FrameReport::default(),
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

    fn run(&mut self) {
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
                    // What has come in meanwhile belongs to the same moment.
                    let orders: Vec<Order> = std::iter::once(order).chain(self.inbox.try_iter()).collect();
                    let last = orders.iter().rposition(|o| matches!(o, Order::Open(..))).unwrap_or(0);
                    let mut news = false;
                    for (k, order) in orders.into_iter().enumerate() {
                        match order {
                            // A scene that another one has already taken the place of is none to build.
                            Order::Open(..) if k < last => self.scene += 1,
                            order => news |= self.obey(order),
                        }
                    }
                    if news {
                        self.publish();
                    }
                }
                Err(RecvTimeoutError::Timeout) if !idle => {
                    let began = Instant::now();
                    self.advance();
                    if self.shared.seen.load(Relaxed) || self.shown.elapsed() > SHOWN {
                        self.publish();
                    }
                    // Smooth: steps that are shown take longer than others.
                    let took = began.elapsed();
                    self.took = if self.step < 2 { took } else { self.took.mul_f32(0.9) + took.mul_f32(0.1) };
                    let frame = Duration::from_secs_f32(STEP / self.speed);
                    // A step that took too long is not made up for: time runs slower.
                    self.due = (self.due + frame).max(Instant::now());
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    /// Does what it is told; whether there is something new to see.
    fn obey(&mut self, order: Order) -> bool {
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
                        self.pool.clear();
                        self.tidy = Some(Instant::now() + LEFT);
                        (self.step, self.reset_strands) = (0, 0);
                        (self.tool, self.picked, self.unshown) = (None, None, false);
                        (self.body, self.pushing) = (Pulled::default(), None);
                        self.due = Instant::now();
                    }
                    Err(why) => *lock(&self.shared.error) = Some(why),
                }
                self.scene += 1;
            }
            Order::Retune(scene, other) => {
                for ((stage, _), scene) in
                    self.stages.iter_mut().zip([Some(scene), other].into_iter().flatten())
                {
                    if let Err(why) = stage.retune(*scene) {
                        *lock(&self.shared.error) = Some(why.into());
                    }
                }
            }
            Order::Play(playing) => {
                self.playing = playing;
                self.due = Instant::now();
                return false;
            }
            Order::Step => {
                let began = Instant::now();
                self.advance();
                self.took = began.elapsed();
            }
            Order::Reset => self.reset(),
            Order::Speed(speed) => {
                self.speed = speed.clamp(0.01, 10.0);
                return false;
            }
            Order::Loop(end) => {
                self.end = end;
                return false;
            }
            Order::Take(tool, pose) => {
                self.let_go();
                let mut taken = Vec::with_capacity(self.stages.len());
                for (stage, _) in &mut self.stages {
                    taken.push(stage.take(tool, pose));
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
            Order::Pick(ray) => {
                self.show();
                self.picked = ray.and_then(|(from, way)| self.stages.first()?.0.nearest_strand(from, way));
            }
        }
        true
    }

    fn let_go(&mut self) {
        for ((stage, _), id) in self.stages.iter_mut().zip(self.tool.take().into_iter().flatten()) {
            id.inspect(|id| stage.let_go(*id));
        }
    }

    fn reset(&mut self) {
        self.stages.iter_mut().for_each(|(stage, _)| stage.reset());
        (self.tool, self.unshown) = (None, false);
        self.due = Instant::now();
    }

    /// Takes what the pointer pulls along, for a step.
    fn pull(&mut self) {
        if self.body.go(FASTEST_HEAD) {
            self.stages.iter_mut().for_each(|(stage, _)| stage.move_body(self.body.now));
        }
        if self.tool.is_some() && self.carried.go(FASTEST) {
            for ((stage, _), id) in self.stages.iter_mut().zip(self.tool.iter().flatten()) {
                id.inspect(|id| stage.carry(*id, self.carried.now));
            }
        }
        if self.pushing.as_mut().is_some_and(|pushing| pushing.go(body(&self.stages))) {
            self.place_pushed();
        }
    }

    /// Shows all stages where what is pushed is.
    fn place_pushed(&mut self) {
        let (shapes, pose) = self.pushing.as_ref().map(Pushing::placed).unwrap_or_default();
        self.stages.iter_mut().for_each(|(stage, _)| stage.push_with(shapes, pose));
    }

    fn advance(&mut self) {
        self.pull();
        if self.end.is_some_and(|end| self.stages.first().is_some_and(|(s, _)| s.time() + 0.5 * STEP > end)) {
            self.reset();
            // It counts as a step: who waits for so many would else wait for ever.
            self.step += 1;
            return;
        }
        for (k, (stage, _)) in self.stages.iter_mut().enumerate() {
            let report = stage.advance(STEP);
            self.reset_strands += report.step.reset_strands;
            if k == 0 {
                self.report = FrameReport { follow: self.report.follow, ..report };
            }
        }
        self.unshown = true;
        self.step += 1;
    }

    /// Brings all strands of the stages up to date.
    fn show(&mut self) {
        if std::mem::take(&mut self.unshown) {
            for (k, (stage, _)) in self.stages.iter_mut().enumerate() {
                let took = stage.show();
                if k == 0 {
                    self.report.follow = took;
                }
            }
        }
    }

    /// Shows the stages as they are.
    fn publish(&mut self) {
        if self.stages.is_empty() {
            return;
        }
        self.show();
        let measured = self.measured.0 == self.scene && self.measures.len() == self.stages.len();
        if !(self.playing && measured && self.step < self.measured.1 + MEASURED) {
            self.measured = (self.scene, self.step);
            self.measures.clear();
            self.measures.extend(self.stages.iter().map(|(stage, _)| (stage.measure(), stage.energy())));
        }
        let mut next = self.spare();
        // Nobody else has it: `spare` saw to that.
        let (Some(snapshot), Some((first, _))) = (Arc::get_mut(&mut next), self.stages.first()) else {
            return;
        };
        let fresh = |(_, still): &(Stage, Arc<Still>)| Scenery::new(still.clone());
        if snapshot.scene != self.scene || snapshot.stages.len() != self.stages.len() {
            snapshot.stages = self.stages.iter().map(fresh).collect();
        }
        for ((scenery, (stage, still)), measure) in
            snapshot.stages.iter_mut().zip(&self.stages).zip(&self.measures)
        {
            scenery.fill(stage, still, self.show);
            (scenery.measure, scenery.energy) = *measure;
            scenery.pushed = self.pushing.as_ref().map(Pushing::shown);
        }
        let picked = self.picked;
        snapshot.picked = picked.map(|p| (p, first.strand_figures(p.groom, p.strand)));
        (snapshot.step, snapshot.scene, snapshot.time) = (self.step, self.scene, first.time());
        self.published += 1;
        snapshot.number = self.published;
        (snapshot.report, snapshot.took, snapshot.reset_strands) =
            (self.report, self.took, self.reset_strands);
        self.shown = Instant::now();
        self.shared.seen.store(false, Relaxed);
        if let Some(old) = lock(&self.shared.latest).replace(next) {
            self.pool.push(old);
        }
        (self.wake)();
    }

    /// A snapshot that nobody looks at.
    fn spare(&mut self) -> Arc<Snapshot> {
        // The window holds one or two: more would be a leak.
        self.pool.truncate(8);
        let free = self.pool.iter_mut().position(|s| Arc::get_mut(s).is_some());
        free.map(|k| self.pool.swap_remove(k)).unwrap_or_else(|| {
            Arc::new(Snapshot {
                number: 0,
                step: 0,
                scene: 0,
                time: 0.0,
                stages: Vec::new(),
                report: FrameReport::default(),
                took: Duration::ZERO,
                reset_strands: 0,
                picked: None,
            })
        })
    }
}

/// The body of the first stage, over which a hand goes.
fn body(stages: &[(Stage, Arc<Still>)]) -> Option<PosedBody<'_>> {
    stages.first()?.0.body()
}

fn open(scene: Scene, card: Option<&Gpu>) -> Result<(Stage, Arc<Still>), AppError> {
    let mut stage = Stage::new(scene)?;
    stage.leave_follow_hairs(card.is_none_or(|card| card.can_place_among(stage.obstacles())));
    let still = Arc::new(Still::new(&stage));
    Ok((stage, still))
}
