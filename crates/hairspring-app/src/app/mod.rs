//! The window: panels around the picture, keys, files that are dropped, and what a script does.

mod scripted;
mod told;

use crate::{
    AppError,
    document::{Document, builtin_text},
    finger::Finger,
    handle, memory,
    overlay::{self, Pen},
    painter::{Drawn, Painter},
    panel::{
        files::{Decision, Files, For},
        help, inspect, parameters,
        presets::Presets,
        transport,
    },
    record::{Kind, Recorder, Wish},
    script::Line,
    session::{Action, Session},
    snapshot::Snapshot,
    view::{Hand, View},
};
use eframe::egui::{self, Color32, Key, Modifiers, RichText, Sense, Ui};
use hairspring::stage::Value;
use std::{
    collections::VecDeque,
    sync::{Arc, mpsc::Receiver},
    time::{Duration, Instant},
};

/// How long a message stays [s].
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
    /// The scene; `None`: the built-in head.
    pub document: Option<Document>,
    /// What is done without a person.
    pub script: VecDeque<Line>,
    /// Who draws the hair.
    pub drawn: Drawn,
}

/// The window's state.
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
    /// Where the picture was drawn last, both sides of it, and the first.
    whole: egui::Rect,
    rect: egui::Rect,
    /// A picture of the window that is being made: what writing it came to.
    shot: Option<Receiver<Result<(), AppError>>>,
    /// Hairs and guides of new scenes: as many as this machine draws.
    hairs: (u32, u32),
    drawn: Option<Instant>,
}

impl App {
    /// The window on a scene: this document's, or the built-in head with as many hairs as the machine draws well.
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
        // The window is cleared in that colour: to fill panels with it once more would take a software driver as long as a picture.
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

    /// What it works on.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// Whether the script is done, and what it began.
    pub fn is_idle(&self) -> bool {
        self.script.is_empty()
            && self.recorder.is_none()
            && self.finger.rests()
            && self.shot.is_none()
            && self.waits == 0
    }

    /// What was last said, and whether it was an error.
    pub fn message(&self) -> Option<(&str, bool)> {
        self.message.as_ref().map(|(text, wrong, _)| (text.as_str(), *wrong))
    }

    fn say(&mut self, text: impl Into<String>, wrong: bool) {
        self.message = Some((text.into(), wrong, Instant::now()));
    }

    fn act(&mut self, action: Action) {
        let another = matches!(action, Action::New(_) | Action::Open(_));
        let saves = matches!(action, Action::Save(_));
        match self.session.act(action) {
            Ok(()) => {
                self.view.forget |= another;
                if let Some(file) = self.session.document().file().filter(|_| saves) {
                    self.say(format!("saved {}", file.display()), false);
                }
            }
            Err(why) => self.say(why.to_string(), true),
        }
    }

    fn record(&mut self, ctx: &egui::Context, wish: Wish) {
        let Some(snapshot) = self.session.latest() else { return };
        let wake = ctx.clone();
        let gpu = self.painters[0].gpu();
        match Recorder::new(wish, &mut self.session, &snapshot, gpu, move || wake.request_repaint()) {
            Ok(recorder) => self.recorder = Some(recorder),
            Err(why) => self.say(why.to_string(), true),
        }
    }

    /// Keys that are not a widget's.
    fn keys(&mut self, ctx: &egui::Context, actions: &mut Vec<Action>) {
        if ctx.egui_wants_keyboard_input() {
            return;
        }
        let pressed = |m: Modifiers, k: Key| ctx.input_mut(|i| i.consume_key(m, k));
        if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
            actions.push(Action::Redo);
        } else if pressed(Modifiers::COMMAND, Key::Z) {
            actions.push(Action::Undo);
        }
        if pressed(Modifiers::COMMAND, Key::O) {
            self.files.ask(For::Open, None);
        }
        if pressed(Modifiers::COMMAND, Key::S) {
            self.save(actions);
        }
        if pressed(Modifiers::NONE, Key::Space) {
            actions.push(Action::Play(!self.session.playing()));
        }
        if pressed(Modifiers::NONE, Key::ArrowRight) && !self.session.playing() {
            actions.push(Action::Step);
        }
        if pressed(Modifiers::NONE, Key::R) {
            actions.push(Action::Reset);
        }
        if pressed(Modifiers::NONE, Key::C) {
            actions.push(Action::Compare(self.session.second().is_none()));
        }
        if pressed(Modifiers::NONE, Key::Home) {
            actions.push(Action::Head(glam::Vec3::ZERO));
        }
        if pressed(Modifiers::NONE, Key::F12) {
            self.files.ask(For::Record(Kind::Still), None);
        }
        if pressed(Modifiers::NONE, Key::F) {
            self.view.orbit = None;
        }
        for (key, open) in [
            (Key::G, &mut self.open.graphs),
            (Key::P, &mut self.open.presets),
            (Key::Tab, &mut self.open.panels),
            (Key::Questionmark, &mut self.open.help),
        ] {
            *open ^= pressed(Modifiers::NONE, key);
        }
        // On many keyboards the question mark is on a shifted key.
        self.open.help ^=
            pressed(Modifiers::SHIFT, Key::Questionmark) || pressed(Modifiers::SHIFT, Key::Slash);
        for (hand, _, key, _) in Hand::ALL {
            if pressed(Modifiers::NONE, key) {
                self.view.hand = hand;
            }
        }
        if pressed(Modifiers::NONE, Key::Escape) {
            (self.open.help, self.open.presets) = (false, false);
            self.files.close();
            actions.push(Action::Unpick);
        }
    }

    fn save(&mut self, actions: &mut Vec<Action>) {
        match self.session.document().file() {
            Some(_) => actions.push(Action::Save(None)),
            None => self.files.ask(For::Save, None),
        }
    }

    /// The bar at the top.
    fn menu(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        egui::MenuBar::new().ui(ui, |ui| {
            ui.menu_button("File", |ui| {
                if ui.button("Presets…").clicked() {
                    self.open.presets = true;
                }
                if ui.button("Open…").clicked() {
                    self.files.ask(For::Open, None);
                }
                if ui.button("Save").clicked() {
                    self.save(actions);
                }
                if ui.button("Save as…").clicked() {
                    self.files.ask(For::Save, self.session.document().file());
                }
                ui.separator();
                if ui.button("Quit").clicked() {
                    ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
                }
            });
            ui.menu_button("Record", |ui| {
                for kind in Kind::ALL {
                    if ui.button(format!("{}…", kind.title())).clicked() {
                        self.files.ask(For::Record(kind), None);
                    }
                }
            });
            let (back, forth) = self.session.edited().history();
            if ui.add_enabled(back, egui::Button::new("Undo")).clicked() {
                actions.push(Action::Undo);
            }
            if ui.add_enabled(forth, egui::Button::new("Redo")).clicked() {
                actions.push(Action::Redo);
            }
            ui.toggle_value(&mut self.open.graphs, "Graphs");
            ui.toggle_value(&mut self.open.help, "?");
            let document = self.session.document();
            let star = if document.is_changed() { " *" } else { "" };
            let file = document.file();
            let name = file.and_then(|p| p.file_name()).map(|n| n.to_string_lossy());
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.label(RichText::new(format!("{}{star}", document.settings().name)).strong());
                let shown = ui.weak(name.unwrap_or("not saved".into()));
                if let Some(file) = file {
                    shown.on_hover_text(file.display().to_string());
                }
            });
        });
    }

    /// The picture, or two side by side, with what is laid over them.
    fn picture(&mut self, ui: &mut Ui, snapshot: Option<&Arc<Snapshot>>, actions: &mut Vec<Action>) {
        let whole = ui.available_rect_before_wrap();
        self.whole = whole;
        let Some(snapshot) = snapshot else {
            ui.centered_and_justified(|ui| ui.spinner());
            return;
        };
        let count = snapshot.stages.len().max(1);
        while self.painters.len() < count {
            let another = self.painters[0].another(ui.ctx());
            self.painters.push(another);
        }
        self.painters.truncate(count);
        let width = whole.width() / count as f32;
        let aspect = width / whole.height().max(1.0);
        self.view.meet(&self.session, snapshot, aspect);
        if self.view.orbit.is_none() {
            self.view.frame(&self.session, snapshot, aspect);
        }
        let guides = self.session.shown() == Some(Value::Guide);
        for (k, scenery) in snapshot.stages.iter().enumerate() {
            let left = whole.left() + width * k as f32;
            let rect =
                egui::Rect::from_min_size(egui::pos2(left, whole.top()), egui::vec2(width, whole.height()));
            let response = ui.interact(rect, ui.scope_id().with(("picture", k)), Sense::click_and_drag());
            if k == 0 {
                self.rect = rect;
                self.view.follow_range(scenery, guides);
            }
            let moment = self.painters[k].moment(ui.ctx(), snapshot);
            let seen = moment.stages.get(k).unwrap_or(scenery);
            // Handles are the scene's whose parameters are shown.
            let own = (k == 1) == self.session.on_second() && self.view.overlays.handles;
            let handles = match (self.view.lens(rect), self.view.orbit) {
                (Some(lens), Some(orbit)) if own => {
                    handle::all(self.session.edited(), seen, &lens, orbit.distance)
                }
                _ => Vec::new(),
            };
            self.view.touch(ui, &response, snapshot, &handles, actions);
            let (Some(sight), Some(lens)) = (self.view.sight(scenery), self.view.lens(rect)) else {
                continue;
            };
            let pixels = ui.ctx().pixels_per_point();
            let size = [rect.width(), rect.height()].map(|s| ((s * pixels).round() as u32).clamp(16, 8192));
            let painter = ui.painter_at(rect);
            if let Some(shape) = self.painters[k].draw(ui.ctx(), snapshot, k, &sight, (rect, size)) {
                painter.add(shape);
            }
            let picked =
                snapshot.picked.as_ref().map(|(p, f)| [p.strand, f.guide as usize].map(|s| [p.groom, s]));
            let picked = picked.as_ref().map_or(&[][..], |picked| &picked[..]);
            overlay::draw(&Pen { painter: &painter, lens, rect }, seen, &self.view, &handles, picked);
            if count > 1 {
                painter.text(
                    rect.left_top() + egui::vec2(10.0, 8.0),
                    egui::Align2::LEFT_TOP,
                    format!(
                        "{} · {}",
                        if k == 0 { "Left" } else { "Right" },
                        self.session.captions()[k.min(1)]
                    ),
                    egui::FontId::proportional(16.0),
                    Color32::from_white_alpha(200),
                );
            }
            if let Some(value) = self.session.shown() {
                told::legend(&painter, rect, value, &self.view, seen);
            }
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
            self.say("the simulation ended by an error of its own; save, and open the scene anew", true);
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
            told::corner(ctx, self.rect, egui::Align2::LEFT_BOTTOM, |ui| {
                inspect::figures(ui, &self.session, snapshot, &notes.join("; "));
            });
            if snapshot.picked.is_some() {
                // Under the name of a side.
                let below = egui::Rect::from_min_max(self.rect.min + egui::vec2(0.0, 22.0), self.rect.max);
                told::corner(ctx, below, egui::Align2::LEFT_TOP, |ui| {
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
            let sights = snapshot.stages.iter().map_while(|s| self.view.sight(s)).collect();
            let ended = recorder.advance(&mut self.session, snapshot, sights);
            match ended {
                Some(Ok(said)) => self.say(said, false),
                Some(Err(why)) => self.say(why.to_string(), true),
                None => self.recorder = Some(recorder),
            }
        }
        if !self.is_idle() {
            // What waits for steps alone is woken by them, but for a scene that could not be opened.
            let soon = self.recorder.is_some() || !self.finger.rests() || self.shot.is_some();
            ctx.request_repaint_after(Duration::from_millis(if soon { 15 } else { 200 }));
        }
    }
}
