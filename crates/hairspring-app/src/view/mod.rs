//! The view: camera, overlays and the current tool. The tools are in `tool`, pointer input is in `touch`.

mod range;
mod tool;
mod touch;

pub use tool::{FINGERS, Tool};

use crate::{
    orbit::{Lens, NARROW, Orbit},
    session::Session,
    snapshot::{Snapshot, StageSnapshot, ViewParameters},
};
use eframe::egui;
use glam::Vec3;
use hairspring_scene::{Camera, builtin, stage::Subject};
use hairspring_view::{Quality, frame_camera};
use std::path::PathBuf;
use touch::{Drag, Held};

/// Number of hairs on a human head.
const HEAD: f32 = 100_000.0;
/// Largest default factor for the width of a hair.
const WIDEST: f32 = 10.0;

/// The overlays of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Overlays {
    /// Outlines of colliders.
    pub colliders: bool,
    /// A slice through the distance to all colliders.
    pub slice: bool,
    /// Grid cells of the hair's volume.
    pub volume: bool,
    /// Coordinate frames of the head, of roots, and along the picked strand.
    pub frames: bool,
    /// Roots of strands.
    pub roots: bool,
    /// Handles of the wind and of the scene's listed objects.
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

/// State of the view.
pub struct View {
    /// Camera; `None` until there is something to look at.
    pub orbit: Option<Orbit>,
    /// Whether the camera moves along with the hair.
    pub follow: bool,
    /// Displacement of the subject from its start in the last picture [m].
    followed: Vec3,
    /// The current tool.
    pub tool: Tool,
    /// Radius of the pushed sphere and of a grab [m].
    pub reach: f32,
    /// Length of the hand [m].
    pub length: f32,
    /// The overlays.
    pub overlays: Overlays,
    /// Factor for the width of drawn hairs; `None` derives it from their number.
    pub width: Option<f32>,
    /// Brightness [stops].
    pub exposure: f32,
    /// Height of the slice, relative to the box of the hair [1].
    pub slice: f32,
    /// Range of the color ramp.
    pub range: [f32; 2],
    /// The current drag.
    drag: Option<Drag>,
    held: Option<Held>,
    /// The handle under the pointer.
    over: Option<usize>,
    /// Displacement of the head from its position [m], and its velocity on the way back [m/s].
    head: (Vec3, Vec3),
    /// Number and file of the scene that the camera was set for.
    framed: u64,
    file: Option<PathBuf>,
    /// The last camera in the text, and of which of two scenes. If it changes, the view adopts it.
    scene_camera: (bool, Option<toml::Value>),
    /// Whether the next scene is a different one, so that the camera must be set again.
    pub forget: bool,
}

impl Default for View {
    fn default() -> Self {
        Self {
            orbit: None,
            follow: false,
            followed: Vec3::ZERO,
            tool: Tool::default(),
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
            scene_camera: (false, None),
            forget: false,
        }
    }
}

impl View {
    /// The view parameters for a picture with this aspect ratio.
    pub fn view_parameters(&self, stage: &StageSnapshot, aspect: f32) -> Option<ViewParameters> {
        let orbit = self.orbit?;
        let camera = orbit.seen(aspect);
        let strands = stage.still.counts[1] as f32;
        Some(ViewParameters {
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

    /// Sets the camera for a newly opened scene, from its file or so that hair and head stay visible, and when
    /// the scene's camera is changed.
    pub fn adopt_camera(&mut self, session: &Session, snapshot: &Snapshot, aspect: f32) {
        // A snapshot of the previous scene does not belong to the opened one.
        if self.framed != snapshot.scene && snapshot.scene >= session.begun() {
            self.framed = snapshot.scene;
            let file = session.document().file().map(Into::into);
            // If an edit restarts the same scene, the camera stays.
            if self.orbit.is_none() || self.file != file || self.forget {
                let own = session.document().settings().camera;
                let travels = || subject(snapshot).is_some_and(Subject::travels);
                self.follow = own.map_or_else(travels, |camera| camera.follow);
                self.frame(session, snapshot, aspect);
                self.scene_camera = scene_camera(session);
            }
            (self.file, self.forget) = (file, false);
        }
        let current = scene_camera(session);
        if current != self.scene_camera {
            if let Some(camera) =
                session.edited().settings().camera.filter(|_| current.0 == self.scene_camera.0)
            {
                self.set(&camera);
                self.follow = camera.follow;
            }
            self.scene_camera = current;
        }
    }

    /// Frames hair and head over the whole motion: along the path of the hair if the camera follows it.
    pub fn frame(&mut self, session: &Session, snapshot: &Snapshot, aspect: f32) {
        let own = session.document().settings().camera;
        let bounds = subject(snapshot).map(|s| if self.follow { s.moving_bounds } else { s.bounds });
        let bounds = bounds.unwrap_or((Vec3::NEG_ONE, Vec3::ONE));
        self.set(&own.unwrap_or_else(|| frame_camera(bounds, aspect.max(NARROW))));
    }

    /// Sets the view to a camera of the scene, as it is at the start of the scene.
    fn set(&mut self, camera: &Camera) {
        (self.orbit, self.followed) = (Some(Orbit::new(camera)), Vec3::ZERO);
    }

    /// Moves the camera along with the hair, if it follows.
    pub fn follow_subject(&mut self, snapshot: &Snapshot) {
        let time = snapshot.stages.first().map_or(0.0, |stage| stage.time);
        let offset = subject(snapshot).map_or(Vec3::ZERO, |subject| subject.path.offset(time));
        if let (true, Some(orbit)) = (self.follow, &mut self.orbit) {
            orbit.target += offset - self.followed;
        }
        self.followed = offset;
    }

    /// The view as a camera of the scene.
    pub fn camera(&self) -> Option<Camera> {
        let camera = self.orbit?.camera();
        let back = if self.follow { self.followed } else { Vec3::ZERO };
        let [position, target] = [camera.position, camera.target].map(|p| p - back);
        Some(Camera { position, target, follow: self.follow, ..camera })
    }

    /// The lens of the picture at `rect`.
    pub fn lens(&self, rect: egui::Rect) -> Option<Lens> {
        let aspect = rect.width() / rect.height().max(1.0);
        Some(Lens::new(&self.orbit?.seen(aspect), aspect))
    }
}

/// The subject of the left scene.
fn subject(snapshot: &Snapshot) -> Option<&Subject> {
    snapshot.stages.first()?.still.subject.as_ref()
}

/// Which of two scenes is edited, and the camera in its text.
fn scene_camera(session: &Session) -> (bool, Option<toml::Value>) {
    (session.on_second(), session.edited().parsed_text().get("camera").cloned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{document::Document, parameter, session::Action};

    #[test]
    fn the_view_follows_the_scene_camera_and_keeps_manual_turns() {
        let text = "[builtin]\nstrands = 10\nguides = 5\n";
        let document = Document::new("scene.toml".as_ref(), text.into()).unwrap();
        let mut session = Session::new(document, 1, None, || ()).unwrap();
        let snapshot = (0..12_000).find_map(|_| {
            std::thread::sleep(std::time::Duration::from_millis(5));
            session.latest()
        });
        let (snapshot, mut view) = (snapshot.unwrap(), View::default());
        view.adopt_camera(&session, &snapshot, 1.5);
        let turned = Orbit { turn: 1.0, ..view.orbit.unwrap() };
        view.orbit = Some(turned);
        let put = |session: &mut Session, name: &str, value: toml_edit::Value| {
            let parameter = parameter::ALL.iter().find(|p| p.name == name).unwrap();
            session.act(Action::Parameter(parameter, Some(value))).unwrap();
        };
        put(&mut session, "gravity", [0.0, -1.0, 0.0].into_iter().collect());
        view.adopt_camera(&session, &snapshot, 1.5);
        assert_eq!(view.orbit, Some(turned), "the camera did not change");
        put(&mut session, "camera.fov", 40.0.into());
        view.adopt_camera(&session, &snapshot, 1.5);
        let own = session.document().settings().camera.unwrap();
        assert_eq!((view.orbit.unwrap().fov, view.orbit), (40.0, Some(Orbit::new(&own))));
        view.orbit = Some(turned);
        session.act(Action::Undo).unwrap();
        view.adopt_camera(&session, &snapshot, 1.5);
        assert_eq!(view.orbit.unwrap().fov, session.document().settings().camera.unwrap().fov);
    }

    #[test]
    fn a_scene_opened_before_the_first_is_drawn_sets_the_camera() {
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
        // Before the window has drawn the first scene.
        session.act(Action::New(head(5.0))).unwrap();
        view.forget = true;
        view.adopt_camera(&session, &first, 1.5);
        assert!(view.forget, "what was opened is still to come");
        view.adopt_camera(&session, &seen(&session, 2), 1.5);
        assert_eq!(view.orbit.unwrap().target.y, 5.0);
    }
}
