//! The model of the window without the window: the scene, the compared scene and the simulation. All input of
//! a user, a script or a test is an [`Action`].

mod action;
mod files;
mod restart;
mod scene;

pub use action::Action;
pub use files::Side;

use crate::{
    AppError, differ,
    document::{Change, Document, Way, new_scene},
    edit,
    player::{Order, Player, RATE},
    reading::Reading,
    snapshot::Snapshot,
};
use glam::Vec3;
use hairspring::{
    forces::{Manipulator, comb::Comb, grab::Grab},
    math::RigidTransform,
};
use hairspring_scene::stage::{FrameRate, Value};
use hairspring_view::gpu::Gpu;
use std::{
    ops::RangeInclusive,
    path::PathBuf,
    sync::{Arc, Mutex, PoisonError},
};

/// Playback speeds [scene seconds per second].
pub const SPEEDS: RangeInclusive<f32> = 0.05..=4.0;

/// Last frame of a range in a scene without a motion, counted from 0 at time 0.
pub const LAST_FRAME: u64 = 100_000;

/// The scene, the compared scene and the simulation.
pub struct Session {
    document: Document,
    /// Previously open scenes in the undo history, as they were left, and those for redo.
    before: Vec<Document>,
    after: Vec<Document>,
    /// Number of changes to another scene.
    opened: u64,
    /// The scene that it is compared with.
    second: Option<Document>,
    /// Whether parameters are those of the second scene.
    on_second: bool,
    player: Player,
    playing: bool,
    speed: f32,
    repeat: bool,
    /// First and last frame of the loop, if the user chose them.
    range: Option<(u64, u64)>,
    show: Option<Value>,
    chosen: (usize, usize),
    held: bool,
    /// Notes from reading the last scene.
    notes: Vec<String>,
    /// The files that the open scenes name.
    files: Vec<PathBuf>,
    /// Length of the scene's motion [s].
    length: Option<f64>,
    /// Names of the body's joints.
    joints: Vec<String>,
    /// Differences between the two compared scenes.
    captions: [String; 2],
    /// Number of started scenes. Snapshots of earlier ones are outdated.
    begun: u64,
    /// The scene that is being read and will be started next.
    reading: Option<Reading>,
    threads: usize,
    card: Option<Gpu>,
    wake: Wake,
    /// Whether the simulation ended while it started the scene. It starts again after the next change.
    stopped: bool,
}

/// The function that is called when there is something new to show.
type Wake = Arc<Mutex<dyn Fn() + Send>>;

fn rouse(wake: &Wake) {
    wake.lock().unwrap_or_else(PoisonError::into_inner)();
}

fn new_player(threads: usize, card: Option<Gpu>, scene: u64, wake: &Wake) -> Player {
    let wake = wake.clone();
    Player::new(threads, card, scene, move || rouse(&wake))
}

impl Session {
    /// Opens a document. It is simulated with `threads` threads and drawn by this GPU, if there is one.
    /// `wake` is called when there is something new to show.
    pub fn new(
        document: Document,
        threads: usize,
        card: Option<Gpu>,
        wake: impl Fn() + Send + 'static,
    ) -> Result<Self, AppError> {
        let wake: Wake = Arc::new(Mutex::new(wake));
        let player = new_player(threads, card.clone(), 0, &wake);
        let mut session = Self {
            document,
            before: Vec::new(),
            after: Vec::new(),
            opened: 0,
            second: None,
            on_second: false,
            player,
            playing: true,
            speed: 1.0,
            repeat: true,
            range: None,
            show: None,
            chosen: (0, 0),
            held: false,
            notes: Vec::new(),
            files: Vec::new(),
            length: None,
            joints: Vec::new(),
            captions: [String::new(), String::new()],
            begun: 0,
            reading: None,
            threads,
            card,
            wake,
            stopped: false,
        };
        session.begin()?;
        session.player.send(Order::Play(true));
        Ok(session)
    }

    /// Executes an action.
    pub fn act(&mut self, action: Action) -> Result<(), AppError> {
        match action {
            Action::Play(playing) => {
                self.playing = playing;
                self.player.send(Order::Play(playing));
            }
            Action::Step => self.step_at(RATE),
            Action::Reset => {
                self.held = false;
                self.player.send(Order::Reset);
            }
            Action::Speed(speed) => {
                if !SPEEDS.contains(&speed) {
                    let (least, most) = (SPEEDS.start(), SPEEDS.end());
                    return Err(AppError::new(format!("a speed of {speed} is not from {least} to {most}")));
                }
                self.speed = speed;
                self.player.send(Order::Speed(self.speed));
            }
            Action::Repeat(repeat) => {
                self.repeat = repeat;
                self.send_range();
            }
            Action::Range(range) => {
                self.check_range(range)?;
                self.range = range;
                self.send_range();
            }
            Action::Seek(frame) => {
                (self.held, self.playing) = (false, false);
                self.player.send(Order::Play(false));
                self.player.send(Order::Seek(frame));
            }
            Action::Parameter(parameter, value) => {
                let chosen = self.chosen;
                let document = self.edited_mut();
                let edits = edit::of(document, parameter, value, chosen)?;
                let change = document.set_all(edits)?;
                self.edited_by(change);
            }
            Action::Set(key, value) => {
                let change = self.edited_mut().set(&key, value)?;
                self.edited_by(change);
            }
            Action::SetAll(values) => {
                let change = self.edited_mut().set_all(values)?;
                self.edited_by(change);
            }
            Action::Rest => self.edited_mut().rest(),
            Action::Add(list, fields) => {
                let change = self.edited_mut().add(list, &fields)?;
                self.edited_by(change);
            }
            Action::Remove(list, place) => {
                let change = self.edited_mut().remove(list, place)?;
                self.edited_by(change);
            }
            Action::Undo => self.step(Way::Back)?,
            Action::Redo => self.step(Way::Forth)?,
            Action::Choose(groom, group) => self.chosen = (groom, group),
            Action::New(text) => self.take(Document::new(&new_scene(), text)?)?,
            Action::Open(path) => self.take(Document::open_any(&path, Some(&self.document))?)?,
            Action::Recover(found) => {
                self.take(Document::recovered(&found.scene)?)?;
                found.discard();
            }
            Action::Save(path) => {
                let known = self.edited().file().map(PathBuf::from);
                let path = path.or(known).ok_or_else(|| {
                    AppError::new("the scene has no file yet: choose one, such as scene.toml")
                })?;
                self.check_save(&path)?;
                self.edited_mut().save(&path)?;
            }
            Action::SaveOver(path) => {
                self.check_save(&path)?;
                self.edited_mut().save_over(&path)?;
            }
            Action::Compare(on) => {
                self.second = on
                    .then(|| Document::new(&self.document.base(), self.document.text().to_owned()))
                    .transpose()?;
                self.on_second = on;
                self.begin()?;
            }
            Action::Second(on) => self.on_second = on && self.second.is_some(),
            Action::Show(value) => {
                self.show = value;
                self.player.send(Order::Show(value));
            }
            Action::Pick(from, way) => self.player.send(Order::Pick(Some((from, way)))),
            Action::Unpick => self.player.send(Order::Pick(None)),
            Action::Grab(center, radius) => {
                // The sphere is at the origin of the tool's own space, which moves with the grab.
                let grab = Grab { center: Vec3::ZERO, radius, pull: 60.0, damping: 1.0 };
                self.player.send(Order::Take(Manipulator::Grab(grab), at(center)));
                self.held = true;
            }
            Action::Comb(center, half, radius) => {
                // Stiff tines with low friction, as in a scene file.
                let comb = Comb { a: -half, b: half, radius, grip: 1000.0, friction: 3.0 };
                self.player.send(Order::Take(Manipulator::Comb(comb), at(center)));
                self.held = true;
            }
            Action::Carry(center) => self.player.send(Order::Carry(at(center))),
            Action::LetGo => {
                self.held = false;
                self.player.send(Order::LetGo);
            }
            Action::Push(push) => self.player.send(Order::Push(push)),
            Action::Head(by) => self.player.send(Order::Body(at(by))),
        }
        Ok(())
    }

    /// Finds the differences between the two compared scenes.
    fn compare(&mut self) {
        self.captions = match &self.second {
            Some(second) => {
                let both = [&self.document, second];
                differ::captions(both.map(Document::effective), both.map(Document::parsed_text))
            }
            None => [String::new(), String::new()],
        };
    }

    /// Refuses a range that is empty or beyond the timeline.
    fn check_range(&self, range: Option<(u64, u64)>) -> Result<(), AppError> {
        let end = self.last_frame().unwrap_or(LAST_FRAME);
        match range {
            // As shown, frame 1 is at time 0.
            Some((first, last)) if first >= last || last > end => Err(AppError::new(format!(
                "the range from frame {} to {} is not one of at least two frames from 1 to {}",
                first + 1,
                last + 1,
                end + 1
            ))),
            _ => Ok(()),
        }
    }

    fn send_range(&self) {
        let motion = self.last_frame().map(|last| (0, last));
        self.player.send(Order::Loop(self.range.or(motion).filter(|_| self.repeat)));
    }

    /// Advances by one step at this rate.
    pub(crate) fn step_at(&self, rate: FrameRate) {
        self.player.send(Order::Step(rate));
    }

    /// A new edit clears the scenes for redo.
    fn edited_by(&mut self, change: Change) {
        if change != Change::None {
            self.after.clear();
        }
        self.follow(change);
    }

    /// Updates the simulation after an edit.
    fn follow(&mut self, change: Change) {
        self.compare();
        match change {
            Change::None => {}
            Change::Geometry => self.begin_soon(),
            Change::Settings if self.stopped => self.begin_soon(),
            Change::Settings => self.retune(),
        }
    }

    fn retune(&self) {
        let settings = |document: &Document| Box::new(document.settings().clone());
        self.player.send(Order::Retune(settings(&self.document), self.second.as_ref().map(settings)));
    }

    /// The document whose parameters are shown.
    pub fn edited(&self) -> &Document {
        self.second.as_ref().filter(|_| self.on_second).unwrap_or(&self.document)
    }

    fn edited_mut(&mut self) -> &mut Document {
        self.second.as_mut().filter(|_| self.on_second).unwrap_or(&mut self.document)
    }

    /// The document on the left, or the only one.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Whether undo is possible, and whether redo is.
    pub fn steps(&self) -> (bool, bool) {
        let (back, forth) = self.edited().history();
        let others = |scenes: &[Document]| !self.on_second && !scenes.is_empty();
        (back || others(&self.before), forth || others(&self.after))
    }

    /// Number of changes to another scene.
    pub fn opened(&self) -> u64 {
        self.opened
    }

    /// The document that it is compared with.
    pub fn second(&self) -> Option<&Document> {
        self.second.as_ref()
    }

    /// Whether parameters are those of the second scene.
    pub fn on_second(&self) -> bool {
        self.on_second
    }

    /// The last snapshot.
    pub fn latest(&self) -> Option<Arc<Snapshot>> {
        self.player.latest()
    }

    /// Processes results of other threads: a scene that was read is started. Returns their error, once.
    pub fn error(&mut self) -> Option<AppError> {
        self.poll_reading().or_else(|| self.player.error())
    }

    /// Whether a scene is being read while the previous one plays on.
    pub fn is_reading(&self) -> bool {
        self.reading.is_some()
    }

    /// Whether the simulation thread has ended by itself.
    pub fn is_dead(&self) -> bool {
        self.player.is_dead()
    }

    /// Number of started scenes. It is the scene number of the newest snapshot, once that exists.
    pub fn begun(&self) -> u64 {
        self.begun + u64::from(self.reading.is_some())
    }

    /// Whether the scene is playing.
    pub fn playing(&self) -> bool {
        self.playing
    }

    /// Playback speed in scene seconds per second.
    pub fn speed(&self) -> f32 {
        self.speed
    }

    /// Whether the motion repeats.
    pub fn repeats(&self) -> bool {
        self.repeat
    }

    /// First and last frame of the loop, if a range was chosen.
    pub fn range(&self) -> Option<(u64, u64)> {
        self.range
    }

    /// Length of the scene's motion [s], if it has one.
    pub fn length(&self) -> Option<f64> {
        self.length
    }

    /// The last frame of the scene's motion, counted from 0 at time 0, if it has one.
    pub fn last_frame(&self) -> Option<u64> {
        self.length.map(|length| (length * RATE.hertz() - 0.5).ceil() as u64)
    }

    /// The value that colors show.
    pub fn shown(&self) -> Option<Value> {
        self.show
    }

    /// The groom and the group whose parameters are shown.
    pub fn chosen(&self) -> (usize, usize) {
        self.chosen
    }

    /// Names of the body's joints.
    pub fn joints(&self) -> &[String] {
        &self.joints
    }

    /// Differences between the two compared scenes, left and right; empty without a comparison.
    pub fn captions(&self) -> &[String; 2] {
        &self.captions
    }

    /// Notes from reading the scene's files.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }
}

fn at(place: Vec3) -> RigidTransform {
    RigidTransform { translation: place, ..RigidTransform::default() }
}
