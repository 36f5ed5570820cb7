//! The window: panels around the picture, keys, dropped files, and scripts.

mod keys;
mod leave;
mod picture;
mod scripted;
mod status_overlay;

use crate::{
    AppError,
    bake::{self, BakeRequest, Baker},
    document::{Document, builtin_text, new_scene, replaces_scene},
    finger::Finger,
    memory,
    painter::{self, Drawn, Painter},
    panel::{
        files::{Decision, Files},
        graphs, help, parameters,
        presets::Presets,
        recovered, transport,
    },
    record::{RecordRequest, Recorder},
    recovery::{self, FoundScene, Recovery},
    script::Script,
    session::{Action, Session, Side},
    view::View,
};
use eframe::egui::{self, Color32, Ui};
use leave::Leaving;
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering::Relaxed},
        mpsc::Receiver,
    },
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
    pub script: Script,
    /// Counts the errors of the script.
    pub script_errors: Arc<AtomicUsize>,
    /// The renderer for the hair.
    pub drawn: Drawn,
    /// The folder where unsaved changes are kept for a crash; `None`: they are not kept.
    pub recovery: Option<PathBuf>,
}

/// The state of the window.
pub struct App {
    session: Session,
    view: View,
    painters: Vec<Painter>,
    history: graphs::History,
    files: Files,
    presets: Presets,
    filter: String,
    open: Open,
    recorder: Option<Recorder>,
    baker: Option<Baker>,
    message: Option<(String, bool, Instant)>,
    script: Script,
    script_errors: Arc<AtomicUsize>,
    /// The step that the script waits for.
    waits: u64,
    /// Number of steps that the script still takes after it.
    steps: u64,
    finger: Finger,
    /// Rectangle of the last drawn picture: both sides of a comparison, and the first side.
    whole: egui::Rect,
    rect: egui::Rect,
    /// Height of the caption over the first side [points]; 0 without a comparison.
    caption: f32,
    /// A picture of the window that is being written; receives the result.
    shot: Option<Receiver<Result<(), AppError>>>,
    /// Number of hairs and guides of new scenes, matched to the speed of this machine.
    hairs: (u32, u32),
    drawn: Option<Instant>,
    /// A question about unsaved changes.
    leaving: Option<Leaving>,
    /// Whether the window closes without a question.
    closes: bool,
    /// Keeps unsaved changes for a crash: those of the left and of the right scene. Empty if they are not kept.
    recovery: Vec<Recovery>,
    /// Scenes of windows that crashed, until the user decides on them.
    found: Vec<FoundScene>,
}

impl App {
    /// Opens the window on a scene: the given document, or the built-in head with as many hairs as the
    /// machine draws well.
    pub fn new(creation: &eframe::CreationContext<'_>, options: Options) -> Result<Self, AppError> {
        memory::keep_little();
        let Options { document, script, script_errors, drawn, recovery } = options;
        let ctx = creation.egui_ctx.clone();
        let painters = vec![Painter::new(creation, drawn)];
        let hairs = if painters[0].gpu().is_some() { (100_000, 2_000) } else { (8_000, 500) };
        let document = match document {
            Some(document) => document,
            None => Document::new(&new_scene(), builtin_text("wavy", Some(hairs)))?,
        };
        let session =
            Session::new(document, painters[0].spared(), painters[0].gpu(), painters[0].wake(&ctx))?;
        let found = recovery.as_deref().map(recovery::find).unwrap_or_default();
        let reserve = |folder: &Path| Ok::<_, AppError>(vec![Recovery::new(folder)?, Recovery::new(folder)?]);
        let (recovery, unkept) = match recovery.as_deref().map(reserve).transpose() {
            Ok(recovery) => (recovery.unwrap_or_default(), None),
            Err(why) => (Vec::new(), Some((why.to_string(), true, Instant::now()))),
        };
        ctx.set_theme(egui::Theme::Dark);
        // The window is already cleared with that color. Filling the panels again would take a software
        // driver as long as a picture.
        ctx.all_styles_mut(|style| style.visuals.panel_fill = Color32::TRANSPARENT);
        Ok(Self {
            session,
            view: View::default(),
            painters,
            history: graphs::History::default(),
            files: Files::default(),
            presets: Presets::default(),
            filter: String::new(),
            open: Open { panels: true, graphs: false, presets: false, help: false },
            recorder: None,
            baker: None,
            message: unkept,
            script,
            script_errors,
            waits: 0,
            steps: 0,
            finger: Finger::new(&ctx),
            whole: egui::Rect::NOTHING,
            rect: egui::Rect::NOTHING,
            caption: 0.0,
            shot: None,
            hairs,
            drawn: None,
            leaving: None,
            closes: false,
            recovery,
            found,
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
            && self.baker.is_none()
            && self.finger.rests()
            && self.shot.is_none()
            && (self.waits, self.steps) == (0, 0)
    }

    /// Number of errors that lines of the script caused.
    pub fn script_errors(&self) -> usize {
        self.script_errors.load(Relaxed)
    }

    /// The last message, and whether it was an error.
    pub fn message(&self) -> Option<(&str, bool)> {
        self.message.as_ref().map(|(text, wrong, _)| (text.as_str(), *wrong))
    }

    /// Shows a message. An error that a line of the script causes is also printed with its place.
    fn set_message(&mut self, text: impl Into<String>, wrong: bool) {
        let text = text.into();
        if let Some(place) = self.script.place().filter(|_| wrong) {
            eprintln!("error: {}", hairspring_io::printable(&format!("{place}: {text}")));
            self.script_errors.fetch_add(1, Relaxed);
        }
        self.message = Some((text, wrong, Instant::now()));
    }

    fn act(&mut self, action: Action) {
        let before = self.session.opened();
        let saves = matches!(action, Action::Save(_) | Action::SaveOver(_));
        // A body or a motion takes the place of a part of the scene.
        let part = match &action {
            Action::Open(path) if !replaces_scene(path) => {
                Some((path.clone(), self.session.document().parsed_text().clone()))
            }
            _ => None,
        };
        match self.session.act(action) {
            Ok(()) => {
                self.view.forget |= self.session.opened() != before;
                if let Some(file) = self.session.edited().file().filter(|_| saves) {
                    self.set_message(format!("saved {}", file.display()), false);
                }
                if let Some((path, earlier)) = part {
                    let removed = match &self.session.document().removed_since(&earlier)[..] {
                        [] => String::new(),
                        removed => format!("; removed from the scene: {}", removed.join(", ")),
                    };
                    self.set_message(format!("opened {}{removed}", path.display()), false);
                }
            }
            Err(why) => self.set_message(why.to_string(), true),
        }
    }

    /// Keeps unsaved changes for a crash.
    fn keep_changes(&mut self, ctx: &egui::Context) {
        let mut failed = None;
        for (recovery, side) in self.recovery.iter_mut().zip([Side::Left, Side::Right]) {
            match recovery.keep(self.session.on(side)) {
                Ok(Some(wait)) => ctx.request_repaint_after(wait),
                Ok(None) => {}
                Err(why) => failed = Some(why),
            }
        }
        if let Some(why) = failed {
            self.set_message(why.to_string(), true);
        }
    }

    fn record(&mut self, ctx: &egui::Context, request: RecordRequest) {
        let Some(snapshot) = self.session.latest() else { return };
        let wake = ctx.clone();
        let gpu = self.painters[0].gpu();
        match Recorder::new(request, &mut self.session, &snapshot, gpu, move || wake.request_repaint()) {
            Ok(recorder) => self.recorder = Some(recorder),
            Err(why) => self.set_message(why.to_string(), true),
        }
    }

    /// Writes the hair of the current frame, of the scene whose parameters are shown.
    fn export(&mut self, path: &Path) {
        let side = usize::from(self.session.on_second());
        let snapshot = self.session.latest();
        let Some(stage) = snapshot.as_ref().and_then(|snapshot| snapshot.stages.get(side)) else { return };
        match self.session.keep_files([path.to_owned()]).and_then(|()| bake::export(path, stage)) {
            Ok(message) => self.set_message(message, false),
            Err(why) => self.set_message(why.to_string(), true),
        }
    }

    /// Starts a bake of the scene whose parameters are shown. The window's own simulation pauses.
    fn bake(&mut self, ctx: &egui::Context, request: BakeRequest) {
        if self.baker.is_some() {
            return self.set_message("a bake is running already: stop it, or wait for its end", true);
        }
        let wake = ctx.clone();
        let (source, threads) = (self.session.edited().source(), self.painters[0].spared());
        let kept = self.session.keep_files(request.files());
        match kept.and_then(|()| Baker::new(request, source, threads, move || wake.request_repaint())) {
            Ok(baker) => {
                self.act(Action::Play(false));
                self.baker = Some(baker);
            }
            Err(why) => self.set_message(why.to_string(), true),
        }
    }

    /// Receives the end of a bake.
    fn poll_bake(&mut self) {
        let Some(outcome) = self.baker.as_mut().and_then(Baker::outcome) else { return };
        self.baker = None;
        match outcome {
            Ok(message) => self.set_message(message, false),
            Err(why) => self.set_message(why.to_string(), true),
        }
    }

    fn windows(&mut self, ctx: &egui::Context, actions: &mut Vec<Action>) {
        match self.files.show(ctx) {
            Some(Decision::Do(action)) => self.request(action),
            Some(Decision::Record(request)) => self.record(ctx, request),
            Some(Decision::Export(path)) => self.export(&path),
            Some(Decision::Bake(request)) => self.bake(ctx, request),
            None => {}
        }
        help::show(ctx, &mut self.open.help);
        let mut open = self.open.presets;
        self.presets.show(ctx, &mut open, self.hairs, actions);
        self.open.presets = open;
        recovered::show(ctx, &mut self.found, actions);
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
        let snapshot = painter::receive(&mut self.painters, ctx, || self.session.latest());
        let mut actions = Vec::new();
        self.hold_back_close(ctx);
        if self.leaving.is_none() {
            self.keys(ctx, &mut actions);
        }
        self.poll_shot();
        self.poll_bake();
        self.follow_script(ctx, snapshot.as_ref());
        if let Some(why) = self.session.error() {
            self.set_message(why.to_string(), true);
        }
        if let Some(why) = self.session.restart_if_dead() {
            self.set_message(why.to_string(), true);
            // The new thread counts steps from 0, so what waits for a step would wait for long.
            (self.waits, self.steps) = (0, 0);
            if let Some(recorder) = self.recorder.take() {
                // The message above is about the same.
                let _ = recorder.stop(&mut self.session);
            }
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
                parameters::show(ui, &self.session, &mut self.filter, self.view.camera(), &mut actions);
            });
        }
        egui::CentralPanel::no_frame().show(ui, |ui| {
            self.picture(ui, snapshot.as_ref(), &mut actions);
        });
        if let Some(snapshot) = snapshot.as_deref().filter(|_| self.open.panels) {
            self.show_figures(ctx, snapshot, &mut actions);
        }
        self.windows(ctx, &mut actions);
        self.show_status(ctx);
        if ctx.input(|i| i.pointer.any_released()) {
            actions.push(Action::Rest);
        }
        let now = Instant::now();
        let dt = self.drawn.replace(now).map_or(0.0, |before| (now - before).as_secs_f32().min(0.1));
        if self.view.settle(dt, &mut actions) {
            ctx.request_repaint();
        }
        for action in actions {
            self.request(action);
        }
        self.ask_before_leaving(ctx);
        self.keep_changes(ctx);
        if let (Some(mut recorder), Some(snapshot)) = (self.recorder.take(), &snapshot) {
            let views = snapshot.stages.iter().map_while(|s| self.view.view_parameters(s, 1.0)).collect();
            let ended = recorder.advance(&mut self.session, snapshot, views);
            match ended {
                Some(Ok(message)) => self.set_message(message, false),
                Some(Err(why)) => self.set_message(why.to_string(), true),
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
