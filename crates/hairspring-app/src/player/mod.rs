//! The simulation on a thread of its own, at a fixed step: the picture never waits for it, and what hair does depends on no frame rate.

mod publish;
mod work;

use crate::{drag_limiter::Push, error::AppError, snapshot::Snapshot};
use glam::Vec3;
use hairspring::{forces::Manipulator, math::RigidTransform};
use hairspring_scene::{
    Scene,
    stage::{FrameRate, Value},
};
use hairspring_view::gpu::Gpu;
use std::{
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering::Relaxed},
        mpsc::{Sender, channel},
    },
    thread::JoinHandle,
};
use work::Work;

/// Rate of steps: that of most screens.
pub const RATE: FrameRate = FrameRate::new(60, 1).expect("60 Hz is a rate");

/// Length of a step [s].
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
    Loop(Option<f64>),
    /// Takes a tool, which moves at once with every `Carry`.
    Take(Manipulator, RigidTransform),
    /// Moves it.
    Carry(RigidTransform),
    /// Lets go.
    LetGo,
    /// What is pushed through hair, and where the pointer has it.
    Push(Option<Push>),
    /// Where the body is carried besides its motion.
    Body(RigidTransform),
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
