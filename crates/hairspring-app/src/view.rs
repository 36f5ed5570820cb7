//! What is seen and by which hand it is touched: the camera, the tools, what is laid over the picture.

use crate::{
    handle::Handle,
    orbit::{Lens, Orbit},
    pulled::Push,
    pushed::Pushed,
    session::{Action, Session},
    snapshot::{Scenery, Sight, Snapshot},
};
use eframe::egui;
use glam::{Vec2, Vec3};
use hairspring::scene::builtin;
use hairspring_view::{Quality, frame_camera};
use std::path::PathBuf;

/// Hairs on a human head.
const HEAD: f32 = 100_000.0;
/// How near the pointer takes a handle [points].
const TOUCH: f32 = 10.0;
/// Widest that a hair is drawn by default, times its own width.
const WIDEST: f32 = 10.0;

/// Half of a hand's width, over the length of its fingers' reach.
pub const FINGERS: f32 = 2.0;

/// What the left button does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hand {
    /// Turns the view.
    #[default]
    Look,
    /// Takes hold of a lock and pulls.
    Grab,
    /// Pushes a ball through the hair.
    Ball,
    /// Drags the head.
    Head,
    /// Picks a strand.
    Pick,
    /// Goes through the hair with spread fingers.
    Comb,
    /// Strokes it with an open hand.
    Palm,
}

impl Hand {
    /// Whether it has a radius.
    pub fn reaches(self) -> bool {
        matches!(self, Self::Ball | Self::Grab | Self::Comb)
    }

    /// All of them, with their names, keys and what they do.
    pub const ALL: [(Self, &'static str, egui::Key, &'static str); 7] = [
        (
            Self::Look,
            "Look",
            egui::Key::Num1,
            "Drag to turn; with Shift or the middle button to move; wheel to come nearer. The right button turns with every tool.",
        ),
        (
            Self::Grab,
            "Grab",
            egui::Key::Num2,
            "Press on hair to take hold of a lock, drag to pull, release to let go.",
        ),
        (
            Self::Ball,
            "Ball",
            egui::Key::Num3,
            "Drag to push a ball through the hair; it is as large as its slider says.",
        ),
        (Self::Head, "Head", egui::Key::Num4, "Drag the head; it comes back when it is let go of."),
        (Self::Pick, "Pick", egui::Key::Num5, "Press on a strand to see its numbers."),
        (
            Self::Comb,
            "Comb",
            egui::Key::Num6,
            "Drag spread fingers through the hair: it goes with them across itself, and slides through along itself.",
        ),
        (
            Self::Palm,
            "Hand",
            egui::Key::Num7,
            "Drag to stroke the hair with an open hand: its palm is turned to the head, its fingers across the stroke.",
        ),
    ];
}

/// What is laid over the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Overlays {
    /// Outlines of colliders.
    pub colliders: bool,
    /// A slice through all colliders' distance.
    pub slice: bool,
    /// Cells of the hair's volume.
    pub volume: bool,
    /// Frames of the head, of roots, and along the strand that is picked.
    pub frames: bool,
    /// Where strands begin.
    pub roots: bool,
    /// Handles of the wind and of what the scene lists.
    pub handles: bool,
    /// Whether hair is drawn.
    pub hair: bool,
    /// Whether the body is drawn.
    pub body: bool,
}

impl Default for Overlays {
    fn default() -> Self {
        Self {
            colliders: false,
            slice: false,
            volume: false,
            frames: false,
            roots: false,
            handles: true,
            hair: true,
            body: true,
        }
    }
}

/// The view's own state.
pub struct View {
    /// Camera; `None` until there is something to look at.
    pub orbit: Option<Orbit>,
    /// Tool.
    pub hand: Hand,
    /// Radius of the ball and of a grab [m].
    pub reach: f32,
    /// Length of the hand [m].
    pub length: f32,
    /// What is laid over.
    pub overlays: Overlays,
    /// How much wider than they are hairs are drawn; `None`: by their number.
    pub width: Option<f32>,
    /// Brightness [stops].
    pub exposure: f32,
    /// Height of the slice, over the hair's box [1].
    pub slice: f32,
    /// Range of colours, and the scene and value that it was found for.
    pub range: [f32; 2],
    /// What is being dragged: how deep it is, where it began and where it is [m].
    drag: Option<Drag>,
    held: Option<Held>,
    /// The handle that the pointer is on.
    over: Option<usize>,
    /// How far the head is from where it should be, and how fast it goes back [m], [m/s].
    head: (Vec3, Vec3),
    /// Number of the scene that the camera was set for, and its file.
    framed: u64,
    file: Option<PathBuf>,
    /// What the scene's text said of its camera last, and of which of two scenes: when it says something else, the window looks from there.
    said: (bool, Option<toml::Value>),
    /// Whether the next scene is another one, to be looked at anew.
    pub forget: bool,
}

/// A handle that is pulled.
struct Held {
    handle: usize,
    depth: f32,
    /// From the pointer to it: it is not always taken at its middle [m].
    off: Vec3,
}

struct Drag {
    depth: f32,
    from: Vec3,
    at: Vec3,
}

impl Default for View {
    fn default() -> Self {
        Self {
            orbit: None,
            hand: Hand::default(),
            reach: 0.02,
            length: builtin::Hand::LENGTH,
            overlays: Overlays::default(),
            width: None,
            exposure: 0.0,
            slice: 0.5,
            range: [0.0, 1.0],
            drag: None,
            held: None,
            over: None,
            head: (Vec3::ZERO, Vec3::ZERO),
            framed: 0,
            file: None,
            said: (false, None),
            forget: false,
        }
    }
}

impl View {
    /// How the scene is looked at.
    pub fn sight(&self, scenery: &Scenery) -> Option<Sight> {
        let orbit = self.orbit?;
        let camera = orbit.camera();
        let strands = scenery.still.counts[1] as f32;
        Some(Sight {
            camera,
            lit_for: Orbit { turn: 0.3, ..orbit }.camera(),
            exposure: self.exposure,
            width: self.width.unwrap_or((HEAD / strands.max(1.0)).clamp(1.0, WIDEST)),
            every: 1,
            range: self.range,
            hair: self.overlays.hair,
            body: self.overlays.body,
            quality: Quality::default(),
        })
    }

    /// Sets the camera where a scene has just been opened: as its file says, else where all hair is seen; and where the scene's camera is changed.
    pub fn meet(&mut self, session: &Session, snapshot: &Snapshot, aspect: f32) {
        // A moment of the scene before is not what was opened.
        if self.framed != snapshot.scene && snapshot.scene >= session.begun() {
            self.framed = snapshot.scene;
            let file = session.document().file().map(Into::into);
            // An edit that begins the same scene anew leaves the camera where it is.
            if self.orbit.is_none() || self.file != file || self.forget {
                self.frame(session, snapshot, aspect);
                self.said = said_of_camera(session);
            }
            (self.file, self.forget) = (file, false);
        }
        let said = said_of_camera(session);
        if said != self.said {
            if let Some(camera) = session.edited().settings().camera.filter(|_| said.0 == self.said.0) {
                self.orbit = Some(Orbit::new(&camera));
            }
            self.said = said;
        }
    }

    /// Looks at all hair.
    pub fn frame(&mut self, session: &Session, snapshot: &Snapshot, aspect: f32) {
        let own = session.document().settings().camera;
        let bounds = snapshot.stages.first().and_then(Scenery::bounds).unwrap_or((Vec3::NEG_ONE, Vec3::ONE));
        let room = Vec3::splat(0.06 * (bounds.1 - bounds.0).length());
        let camera = own.unwrap_or_else(|| frame_camera((bounds.0 - room, bounds.1 + room), aspect));
        self.orbit = Some(Orbit::new(&camera));
    }

    /// What the pointer does in the picture that lies at `rect`, where these handles can be taken.
    pub fn touch(
        &mut self,
        ui: &egui::Ui,
        response: &egui::Response,
        snapshot: &Snapshot,
        handles: &[Handle],
        actions: &mut Vec<Action>,
    ) {
        if !handles.is_empty() && self.pull(ui, response, handles, actions) {
            return;
        }
        let rect = response.rect;
        let Some(orbit) = &mut self.orbit else { return };
        let part = |v: egui::Vec2| Vec2::new(v.x, v.y) / rect.height().max(1.0);
        let place =
            |p: egui::Pos2| Vec2::new((p.x - rect.left()) / rect.width(), (p.y - rect.top()) / rect.height());
        let (shift, scroll, zoom) =
            ui.input(|i| (i.modifiers.shift, i.smooth_scroll_delta().y, i.zoom_delta()));
        if response.hovered() {
            orbit.zoom((scroll * 0.003).exp() * zoom);
        }
        use egui::PointerButton::{Middle, Primary, Secondary};
        let moved = part(response.drag_delta());
        let look = self.hand == Hand::Look || self.hand == Hand::Pick;
        if response.dragged_by(Middle) || (look && shift && response.dragged_by(Primary)) {
            orbit.pan(moved);
        } else if response.dragged_by(Secondary) || (look && response.dragged_by(Primary)) {
            orbit.drag(moved);
        }
        let lens = Lens::new(&orbit.camera(), rect.width() / rect.height().max(1.0));
        let pointer = response.interact_pointer_pos().map(place);
        if self.hand == Hand::Pick
            && response.clicked()
            && let Some(at) = pointer
        {
            let (from, way) = lens.ray(at);
            actions.push(Action::Pick(from, way));
        }
        if look {
            return;
        }
        let Some(at) = pointer else { return };
        let (from, way) = lens.ray(at);
        if response.drag_started_by(Primary) {
            let depth = depth_of_hair(snapshot, &lens, at).unwrap_or(orbit.distance);
            let place = from + way * depth;
            self.drag = Some(Drag { depth, from: place, at: place });
            match self.hand {
                Hand::Grab => actions.push(Action::Grab(place, self.reach)),
                Hand::Ball | Hand::Palm => actions.push(Action::Push(Some(self.push(&lens, place)))),
                Hand::Comb => {
                    actions.push(Action::Comb(place, lens.right() * (FINGERS * self.reach), self.reach))
                }
                _ => {}
            }
        } else if let Some(drag) = &mut self.drag
            && response.dragged_by(Primary)
        {
            drag.at = from + way * drag.depth;
            match self.hand {
                Hand::Grab | Hand::Comb => actions.push(Action::Carry(drag.at)),
                Hand::Ball | Hand::Palm => {
                    let at = drag.at;
                    actions.push(Action::Push(Some(self.push(&lens, at))));
                }
                Hand::Head => {
                    // Farther than an arm, the head would leave the picture.
                    self.head = ((drag.at - drag.from).clamp_length_max(0.5), Vec3::ZERO);
                    actions.push(Action::Head(self.head.0));
                }
                Hand::Look | Hand::Pick => {}
            }
        }
        if response.drag_stopped() && self.drag.take().is_some() {
            match self.hand {
                Hand::Grab | Hand::Comb => actions.push(Action::LetGo),
                Hand::Ball | Hand::Palm => actions.push(Action::Push(None)),
                _ => {}
            }
        }
    }

    /// Takes, pulls and lets go of a handle; whether the pointer is on one.
    fn pull(
        &mut self,
        ui: &egui::Ui,
        response: &egui::Response,
        handles: &[Handle],
        actions: &mut Vec<Action>,
    ) -> bool {
        use egui::PointerButton::Primary;
        let rect = response.rect;
        let Some(lens) = self.lens(rect) else { return false };
        let place = |p: egui::Pos2| (p - rect.min) / rect.size();
        let ray = |p: egui::Pos2| lens.ray(Vec2::new(place(p).x, place(p).y));
        let near = |pointer: egui::Pos2| {
            let off = |handle: &Handle| {
                let (at, depth) = lens.project(handle.at)?;
                let at = rect.min + egui::vec2(at.x, at.y) * rect.size();
                Some((at.distance(pointer), depth)).filter(|(off, _)| *off < TOUCH)
            };
            let some = handles.iter().enumerate().filter_map(|(k, handle)| Some((k, off(handle)?)));
            some.min_by(|a, b| a.1.0.total_cmp(&b.1.0)).map(|(k, (_, depth))| (k, depth))
        };
        if response.drag_started_by(Primary)
            && let Some(pressed) = ui.input(|i| i.pointer.press_origin())
            && let Some((handle, depth)) = near(pressed)
        {
            let (from, way) = ray(pressed);
            self.held = Some(Held { handle, depth, off: handles[handle].at - (from + way * depth) });
        }
        if let Some(held) = &self.held {
            let (handle, pointer) = (handles.get(held.handle), response.interact_pointer_pos());
            if let (Some(handle), Some(pointer), true) = (handle, pointer, response.dragged_by(Primary)) {
                let (from, way) = ray(pointer);
                ui.set_cursor_icon(egui::CursorIcon::Grabbing);
                if response.drag_delta() != egui::Vec2::ZERO {
                    actions.push(handle.pulled(from + way * held.depth + held.off));
                }
                return true;
            }
            self.held = None;
        }
        self.over = response.hover_pos().and_then(near).map(|(k, _)| k);
        if self.over.is_some() {
            ui.set_cursor_icon(egui::CursorIcon::Grab);
        }
        // Until the drag is one, the press is neither the tool's.
        self.over.is_some() && response.is_pointer_button_down_on()
    }

    /// The lens through which the picture at `rect` is seen.
    pub fn lens(&self, rect: egui::Rect) -> Option<Lens> {
        Some(Lens::new(&self.orbit?.camera(), rect.width() / rect.height().max(1.0)))
    }

    /// The handle that the pointer is on or holds.
    pub fn touched(&self) -> Option<usize> {
        self.held.as_ref().map(|held| held.handle).or(self.over)
    }

    /// The head goes back where it was dragged from, as on a spring that does not swing; called once a frame of `dt` [s].
    pub fn settle(&mut self, dt: f32, actions: &mut Vec<Action>) -> bool {
        let (place, speed) = self.head;
        if self.drag.is_some() || (place == Vec3::ZERO && speed == Vec3::ZERO) {
            return false;
        }
        // Critically damped, 3 times a second: exact for any dt.
        let w = 18.0;
        let decay = (-w * dt).exp();
        let slope = speed + place * w;
        self.head = ((place + slope * dt) * decay, (speed - slope * w * dt) * decay);
        if self.head.0.length() < 1e-5 {
            self.head = (Vec3::ZERO, Vec3::ZERO);
        }
        actions.push(Action::Head(self.head.0));
        true
    }

    /// Finds the range of the colours that are shown: from 0 to what a fiftieth of points that have any exceeds, followed smoothly.
    pub fn follow_range(&mut self, scenery: &Scenery, guides: bool) {
        if guides || scenery.values.is_empty() {
            self.range = [0.0, 1.0];
            return;
        }
        // What most points have none of, contact, is of those that have.
        let mut some: Vec<f32> = scattered(&scenery.values).filter(|v| v.is_finite() && *v > 0.0).collect();
        if some.is_empty() {
            return;
        }
        let place = some.len() * 49 / 50;
        let (_, high, _) = some.select_nth_unstable_by(place, f32::total_cmp);
        let high = high.max(1e-12);
        // A range of another value's size is left at once.
        let far = self.range[1] > 20.0 * high || self.range[1] < 0.05 * high;
        self.range = [0.0, if far { high } else { self.range[1] + 0.1 * (high - self.range[1]) }];
    }

    /// What a grab or a comb reaches, while it is dragged: its middle and radius [m].
    pub fn reached(&self) -> Option<(Vec3, f32)> {
        let drag = self.drag.as_ref()?;
        Some((drag.at, self.reach))
    }

    /// What is pushed where the pointer has it at `at`.
    fn push(&self, lens: &Lens, at: Vec3) -> Push {
        let what = if self.hand == Hand::Palm { Pushed::Hand(self.length) } else { Pushed::Ball(self.reach) };
        Push { what, at, axes: [lens.right(), lens.up()] }
    }
}

/// Which of two scenes is changed, and what its text says of its camera.
fn said_of_camera(session: &Session) -> (bool, Option<toml::Value>) {
    (session.on_second(), session.edited().said().get("camera").cloned())
}

/// Some thousand of the values of each groom, however many points its strands have: every so-manieth would be the root of each.
fn scattered(values: &[Vec<f32>]) -> impl Iterator<Item = f32> {
    // Multiples of the golden ratio are spread evenly over 0 to 1 (Weyl 1916).
    let place = |k: u32| (f64::from(k) * 0.618_033_988_749_894_9).fract();
    values.iter().filter(|v| !v.is_empty()).flat_map(move |v| {
        (0..v.len().min(4096) as u32).map(move |k| v[(place(k) * v.len() as f64) as usize])
    })
}

/// Depth of the hair that is nearest to a place of the picture [m]; `None` where there is none close by.
fn depth_of_hair(snapshot: &Snapshot, lens: &Lens, at: Vec2) -> Option<f32> {
    let scenery = snapshot.stages.first()?;
    let mut best: Option<(f32, f32)> = None;
    for p in scenery.points().flat_map(|p| p.iter().step_by(1 + p.len() / 200_000)) {
        let Some((place, depth)) = lens.project(*p) else { continue };
        let off = place.distance(at);
        // Of hair within a hundredth of the picture, that in front.
        if off < 0.01 && best.is_none_or(|(_, d)| depth < d) {
            best = Some((off, depth));
        }
    }
    best.map(|(_, depth)| depth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{document::Document, parameter};

    #[test]
    fn values_are_taken_from_all_along_strands_of_any_number_of_points() {
        for points in 2..200usize {
            // From root to tip 0 to 1, as many strands as make any stride a multiple of their points.
            let along = |i: usize| (i % points) as f32 / (points - 1) as f32;
            let values = [(0..points * 2048).map(along).collect::<Vec<f32>>(), vec![0.5; 3]];
            let some: Vec<f32> = scattered(&values).collect();
            let mean = some.iter().sum::<f32>() / some.len() as f32;
            assert!((mean - 0.5).abs() < 0.02, "{points} points: {mean}");
            assert!(some.len() <= 2 * 4096);
        }
    }

    #[test]
    fn the_view_goes_where_the_scenes_camera_is_put_and_stays_where_a_hand_turned_it() {
        let text = "[builtin]\nstrands = 10\nguides = 5\n";
        let document = Document::new("scene.toml".as_ref(), text.into()).unwrap();
        let mut session = Session::new(document, 1, None, || ()).unwrap();
        let snapshot = (0..12_000).find_map(|_| {
            std::thread::sleep(std::time::Duration::from_millis(5));
            session.latest()
        });
        let (snapshot, mut view) = (snapshot.unwrap(), View::default());
        view.meet(&session, &snapshot, 1.5);
        let turned = Orbit { turn: 1.0, ..view.orbit.unwrap() };
        view.orbit = Some(turned);
        let put = |session: &mut Session, name: &str, value: toml_edit::Value| {
            let parameter = parameter::ALL.iter().find(|p| p.name == name).unwrap();
            session.act(Action::Parameter(parameter, Some(value))).unwrap();
        };
        put(&mut session, "gravity", [0.0, -1.0, 0.0].into_iter().collect());
        view.meet(&session, &snapshot, 1.5);
        assert_eq!(view.orbit, Some(turned), "nothing was said of the camera");
        put(&mut session, "camera.fov", 40.0.into());
        view.meet(&session, &snapshot, 1.5);
        let own = session.document().settings().camera.unwrap();
        assert_eq!((view.orbit.unwrap().fov, view.orbit), (40.0, Some(Orbit::new(&own))));
        view.orbit = Some(turned);
        session.act(Action::Undo).unwrap();
        view.meet(&session, &snapshot, 1.5);
        assert_eq!(view.orbit.unwrap().fov, session.document().settings().camera.unwrap().fov);
    }

    #[test]
    fn what_is_opened_at_once_is_looked_at_all_the_same() {
        let head = |y: f64| {
            format!(
                "[builtin]\nstrands = 10\nguides = 5\n[camera]\nposition = [0.0, {y}, 2.0]\ntarget = [0.0, {y}, 0.0]\nfov = 30.0\n"
            )
        };
        let document = Document::new("scene.toml".as_ref(), head(1.0)).unwrap();
        let mut session = Session::new(document, 1, None, || ()).unwrap();
        let seen = |session: &Session, scene: u64| {
            let mut moments = (0..12_000).map(|_| {
                std::thread::sleep(std::time::Duration::from_millis(5));
                session.latest().filter(|s| s.scene == scene)
            });
            moments.find_map(|moment| moment).unwrap()
        };
        let (first, mut view) = (seen(&session, 1), View::default());
        // Before the window has drawn the first.
        session.act(Action::New(head(5.0))).unwrap();
        view.forget = true;
        view.meet(&session, &first, 1.5);
        assert!(view.forget, "what was opened is still to come");
        view.meet(&session, &seen(&session, 2), 1.5);
        assert_eq!(view.orbit.unwrap().target.y, 5.0);
    }
}
