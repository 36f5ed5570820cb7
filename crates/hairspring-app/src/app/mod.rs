//! The window: panels around the picture, keys, dropped files, and scripts.

mod keys;
mod picture;
mod scripted;
mod status_overlay;

use crate::{
    AppError,
    document::{Document, builtin_text},
    finger::Finger,
    memory,
    painter::{Drawn, Painter},
    panel::{
        files::{Decision, Files},
        help, inspect, parameters,
        presets::Presets,
        transport,
    },
    record::{RecordRequest, Recorder},
    script::Line,
    session::{Action, Session},
    view::View,
};
use eframe::egui::{self, Color32, Ui};
use std::{
    collections::VecDeque,
    sync::mpsc::Receiver,
    time::{Duration, Instant},
};

/// How long a message is shown [s].
const MESSAGE: Duration = Duration::from_secs(8);

/// Which panels are open.
struct Open {
    panels: bool,
    graphs: bool,
    presets: bool,
    help: bool,
}

/// How the window opens.
#[derive(Default)]
pub struct Options {
    /// The scene; `None` opens the built-in head.
    pub document: Option<Document>,
    /// The script to run.
    pub script: VecDeque<Line>,
    /// The renderer for the hair.
    pub drawn: Drawn,
}

/// The state of the window.
pub struct App {
    session: Session,
    view: View,
    painters: Vec<Painter>,
    history: inspect::History,
    files: Files,
    presets: Presets,
    filter: String,
    open: Open,
    recorder: Option<Recorder>,
    message: Option<(String, bool, Instant)>,
    script: VecDeque<Line>,
    /// The step that the script waits for.
    waits: u64,
    finger: Finger,
    /// Rectangle of the last drawn picture: both sides of a comparison, and the first side.
    whole: egui::Rect,
    rect: egui::Rect,
    /// A picture of the window that is being written; receives the result.
    shot: Option<Receiver<Result<(), AppError>>>,
    /// Number of hairs and guides of new scenes, matched to the speed of this machine.
    hairs: (u32, u32),
    drawn: Option<Instant>,
}

impl App {
    /// Opens the window on a scene: the given document, or the built-in head with as many hairs as the
    /// machine draws well.
    pub fn new(creation: &eframe::CreationContext<'_>, options: Options) -> Result<Self, AppError> {
        memory::keep_little();
        let Options { document, script, drawn } = options;
        let ctx = creation.egui_ctx.clone();
        let painters = vec![Painter::new(creation, drawn)];
        let hairs = if painters[0].gpu().is_some() { (100_000, 2_000) } else { (8_000, 500) };
        let document = match document {
            Some(document) => document,
            None => Document::new("scene.toml".as_ref(), builtin_text("wavy", hairs.0, hairs.1))?,
        };
        let session =
            Session::new(document, painters[0].spared(), painters[0].gpu(), painters[0].wake(&ctx))?;
        ctx.set_theme(egui::Theme::Dark);
        // The window is already cleared with that color. Filling the panels again would take a software
        // driver as long as a picture.
        ctx.all_styles_mut(|style| style.visuals.panel_fill = Color32::TRANSPARENT);
        Ok(Self {
            session,
            view: View::default(),
            painters,
            history: inspect::History::default(),
            files: Files::default(),
            presets: Presets::default(),
            filter: String::new(),
            open: Open { panels: true, graphs: false, presets: false, help: false },
            recorder: None,
            message: None,
            script,
            waits: 0,
            finger: Finger::new(&ctx),
            whole: egui::Rect::NOTHING,
            rect: egui::Rect::NOTHING,
            shot: None,
            hairs,
            drawn: None,
        })
    }

    /// The session.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// Whether the script and everything that it started is finished.
    pub fn is_idle(&self) -> bool {
        self.script.is_empty()
            && self.recorder.is_none()
            && self.finger.rests()
            && self.shot.is_none()
            && self.waits == 0
    }

    /// The last message, and whether it was an error.
    pub fn message(&self) -> Option<(&str, bool)> {
        self.message.as_ref().map(|(text, wrong, _)| (text.as_str(), *wrong))
    }

    fn say(&mut self, text: impl Into<String>, wrong: bool) {
        self.message = Some((text.into(), wrong, Instant::now()));
    }

    fn act(&mut self, action: Action) {
        let before = self.session.opened();
        let saves = matches!(action, Action::Save(_));
        match self.session.act(action) {
            Ok(()) => {
                self.view.forget |= self.session.opened() != before;
                if let Some(file) = self.session.document().file().filter(|_| saves) {
                    self.say(format!("saved {}", file.display()), false);
                }
            }
            Err(why) => self.say(why.to_string(), true),
        }
    }

    fn record(&mut self, ctx: &egui::Context, wish: RecordRequest) {
        let Some(snapshot) = self.session.latest() else { return };
        let wake = ctx.clone();
        let gpu = self.painters[0].gpu();
        match Recorder::new(wish, &mut self.session, &snapshot, gpu, move || wake.request_repaint()) {
            Ok(recorder) => self.recorder = Some(recorder),
            Err(why) => self.say(why.to_string(), true),
        }
    }

    fn windows(&mut self, ctx: &egui::Context, actions: &mut Vec<Action>) {
        match self.files.show(ctx) {
            Some(Decision::Do(action)) => self.act(action),
            Some(Decision::Record(wish)) => self.record(ctx, wish),
            None => {}
        }
        help::show(ctx, &mut self.open.help);
        let mut open = self.open.presets;
        self.presets.show(ctx, &mut open, self.hairs, actions);
        self.open.presets = open;
        let dropped = ctx.input(|i| i.raw.dropped_files.clone());
        actions.extend(dropped.into_iter().map(|f| Action::Open(f.path().into())));
    }
}

impl eframe::App for App {
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.window_fill.to_normalized_gamma_f32()
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        let ctx = &ui.ctx().clone();
        let _ = frame;
        let snapshot = self.session.latest();
        let mut actions = Vec::new();
        self.keys(ctx, &mut actions);
        self.hear_of_shot();
        self.follow_script(ctx, snapshot.as_ref());
        if let Some(why) = self.session.error() {
            self.say(why.to_string(), true);
        }
        if self.session.is_dead() && self.message.is_none() {
            self.say(
                "the simulation stopped because of an internal error; save, and open the scene again",
                true,
            );
        }
        if let Some(snapshot) = &snapshot {
            self.history.keep(snapshot);
        }
        egui::Panel::top("menu").show(ui, |ui| self.menu(ui, &mut actions));
        if self.open.panels {
            egui::Panel::bottom("transport").show(ui, |ui| {
                ui.add_space(2.0);
                transport::tools(ui, &self.session, &mut self.view, &mut actions);
                transport::show(ui, &self.session, snapshot.as_deref(), &mut actions);
                ui.add_space(2.0);
            });
            if self.open.graphs {
                egui::Panel::bottom("graphs").show(ui, |ui| self.history.show(ui));
            }
            egui::Panel::right("parameters").default_size(360.0).show(ui, |ui| {
                let camera = self.view.orbit.map(|orbit| orbit.camera());
                parameters::show(ui, &self.session, &mut self.filter, camera, &mut actions);
            });
        }
        let notes: Vec<String> = self.painters.iter().map(Painter::note).collect();
        egui::CentralPanel::no_frame().show(ui, |ui| {
            self.picture(ui, snapshot.as_ref(), &mut actions);
        });
        if let Some(snapshot) = snapshot.as_deref().filter(|_| self.open.panels) {
            status_overlay::corner(ctx, self.rect, egui::Align2::LEFT_BOTTOM, |ui| {
                inspect::figures(ui, &self.session, snapshot, &notes.join("; "));
            });
            if snapshot.picked.is_some() {
                // Below the label of a side.
                let below = egui::Rect::from_min_max(self.rect.min + egui::vec2(0.0, 22.0), self.rect.max);
                status_overlay::corner(ctx, below, egui::Align2::LEFT_TOP, |ui| {
                    inspect::picked(ui, snapshot, &mut actions)
                });
            }
        }
        self.windows(ctx, &mut actions);
        self.tell(ctx);
        if ctx.input(|i| i.pointer.any_released()) {
            actions.push(Action::Rest);
        }
        let now = Instant::now();
        let dt = self.drawn.replace(now).map_or(0.0, |before| (now - before).as_secs_f32().min(0.1));
        if self.view.settle(dt, &mut actions) {
            ctx.request_repaint();
        }
        for action in actions {
            self.act(action);
        }
        if let (Some(mut recorder), Some(snapshot)) = (self.recorder.take(), &snapshot) {
            let sights = snapshot.stages.iter().map_while(|s| self.view.sight(s, 1.0)).collect();
            let ended = recorder.advance(&mut self.session, snapshot, sights);
            match ended {
                Some(Ok(said)) => self.say(said, false),
                Some(Err(why)) => self.say(why.to_string(), true),
                None => self.recorder = Some(recorder),
            }
        }
        if !self.is_idle() {
            // New steps wake the tasks that wait for them, except if a scene could not be opened.
            let soon = self.recorder.is_some() || !self.finger.rests() || self.shot.is_some();
            ctx.request_repaint_after(Duration::from_millis(if soon { 15 } else { 200 }));
        }
    }
}
