//! Runs the simulation on its own thread with a fixed time step. The picture never waits for it, and the
//! hair's motion does not depend on the frame rate.

mod frames;
mod publish;
mod work;

pub use frames::CachedFrames;

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

/// Rate of the steps, which is that of most screens.
pub const RATE: FrameRate = FrameRate::new(60, 1).expect("60 Hz is a rate");

/// Length of a step [s].
pub const STEP: f32 = 1.0 / 60.0;

/// Commands to the thread.
pub enum Order {
    /// Opens a scene and optionally a second one for comparison, at time 0.
    Open(Box<Scene>, Option<Box<Scene>>),
    /// Applies new settings while playing.
    Retune(Box<Scene>, Option<Box<Scene>>),
    /// Plays or pauses.
    Play(bool),
    /// Advances by one step at this rate.
    Step(FrameRate),
    /// Returns to time 0.
    Reset,
    /// Playback speed in scene seconds per second, above 0.
    Speed(f32),
    /// Goes back to the first of these frames after the last; `None` plays on.
    Loop(Option<(u64, u64)>),
    /// Goes to the kept frame that is nearest to this one.
    Seek(u64),
    /// Adds a tool, which follows every `Carry`.
    Take(Manipulator, RigidTransform),
    /// Moves the tool.
    Carry(RigidTransform),
    /// Removes the tool.
    LetGo,
    /// The object that is pushed through hair, and its target pose.
    Push(Option<Push>),
    /// Displacement of the body in addition to its motion.
    Body(RigidTransform),
    /// The value of each point that is shown as a color.
    Show(Option<Value>),
    /// Picks the strand on a ray; `None` clears the selection.
    Pick(Option<(Vec3, Vec3)>),
    /// Ends the thread by a panic, as an internal error would.
    #[cfg(test)]
    Panic,
}

/// State shared by the window and the thread.
#[derive(Default)]
struct Shared {
    latest: Mutex<Option<Arc<Snapshot>>>,
    /// Whether the last snapshot has been taken, so that another one is needed.
    seen: AtomicBool,
    error: Mutex<Option<AppError>>,
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    // The value is always replaced as a whole, so a thread that panicked left nothing inconsistent.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The window's handle to the thread. Dropping it ends the thread.
pub struct Player {
    orders: Option<Sender<Order>>,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Player {
    /// Starts a thread that calls `wake` when there is something new to show. `threads` is the number of
    /// threads of a step. It should be less than the number of processors if another pool draws, because each
    /// parallel section of a step would otherwise wait for a thread that has no processor. Follow hairs are
    /// interpolated by the renderer: on the GPU `card` if it supports them, or for the picture of the CPU,
    /// which does not need all of them. `scene` is the number of scenes that were opened before.
    pub fn new(threads: usize, card: Option<Gpu>, scene: u64, wake: impl Fn() + Send + 'static) -> Self {
        let (orders, inbox) = channel();
        let shared = Arc::new(Shared::default());
        let own = shared.clone();
        let thread = std::thread::Builder::new().name("simulation".into()).spawn(move || {
            let mut work = Work { inbox, shared: own, card, wake: Box::new(wake), scene, ..Work::new() };
            match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
                Ok(pool) => pool.install(|| work.run()),
                // Falls back to the global thread pool.
                Err(_) => work.run(),
            }
        });
        Self { orders: Some(orders), shared, thread: thread.ok() }
    }

    /// Sends a command. Has no effect if the thread has ended.
    pub fn send(&self, order: Order) {
        if let Some(orders) = &self.orders {
            // The thread ended by a panic that was reported.
            let _ = orders.send(order);
        }
    }

    /// The last snapshot.
    pub fn latest(&self) -> Option<Arc<Snapshot>> {
        self.shared.seen.store(true, Relaxed);
        lock(&self.shared.latest).clone()
    }

    /// The error of the last command, returned once.
    pub fn error(&self) -> Option<AppError> {
        lock(&self.shared.error).take()
    }

    /// Whether the thread has ended by itself.
    pub fn is_dead(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// If the thread has ended by itself, the reason in words.
    pub fn failure(&mut self) -> Option<String> {
        if !self.is_dead() {
            return None;
        }
        let panic = self.thread.take().and_then(|thread| thread.join().err());
        let what = panic.as_ref().and_then(|panic| {
            panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied())
        });
        Some(what.unwrap_or("no reason given").replace('\n', " "))
    }
}

impl Drop for Player {
    fn drop(&mut self) {
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            // The panic was reported when it happened.
            let _ = thread.join();
        }
    }
}
