//! Runs a script in the window.

use super::App;
use crate::{
    bake::BakeRequest,
    document::builtin_text,
    key::{Key, written_name},
    record::{RecordRequest, write},
    script::Line,
    session::Action,
    snapshot::Snapshot,
};
use eframe::egui;
use std::{
    sync::{Arc, mpsc::channel},
    time::Duration,
};

impl App {
    /// Executes the next lines of the script, as far as possible now.
    pub(super) fn follow_script(&mut self, ctx: &egui::Context, snapshot: Option<&Arc<Snapshot>>) {
        let Some(snapshot) = snapshot else { return };
        if self.recorder.is_some() || self.baker.is_some() || !self.finger.rests() || self.shot.is_some() {
            return;
        }
        if snapshot.scene < self.session.begun() || snapshot.step < self.waits {
            return;
        }
        self.waits = 0;
        if self.steps > 0 {
            return self.take_steps(snapshot.step);
        }
        let Some(line) = self.script.begin_next() else { return };
        match line {
            Line::Wait(steps) if self.session.playing() => self.waits = snapshot.step + steps,
            Line::Wait(steps) => {
                self.steps = steps;
                self.take_steps(snapshot.step);
            }
            Line::Play(on) => self.act(Action::Play(on)),
            Line::Step => self.act(Action::Step),
            Line::Reset => self.act(Action::Reset),
            Line::Seek(frame) => self.act(Action::Seek(frame)),
            Line::Range(range) => self.act(Action::Range(range)),
            Line::Speed(speed) => self.act(Action::Speed(speed)),
            Line::Set(key, value) => self.set(key, value),
            Line::Undo => self.act(Action::Undo),
            Line::Redo => self.act(Action::Redo),
            Line::New(style) => self.act(Action::New(builtin_text(&style, Some(self.hairs)))),
            Line::Open(path) => self.act(Action::Open(path)),
            Line::Save(path) => self.act(Action::Save(Some(path))),
            Line::Tool(tool) => self.view.tool = tool,
            Line::Drag(from, to, frames) => {
                self.finger.hold(self.place(from), self.place(to), frames);
                self.finger.release();
            }
            Line::Hold(from, to, frames) => self.finger.hold(self.place(from), self.place(to), frames),
            Line::Release => self.finger.release(),
            Line::Find(text) => self.filter = text,
            Line::Show(value) => self.act(Action::Show(value)),
            Line::Switch(name, on) => self.switch(name, on),
            Line::Record(kind, path, seconds) => {
                let format = self.files.format;
                self.record(ctx, RecordRequest { kind, path, seconds, format });
            }
            Line::Size(size) => self.files.format.size = size,
            Line::Rate(rate) => self.files.format.rate = rate,
            Line::Export(path) => self.export(&path),
            Line::Bake(path, frames) => {
                self.bake(ctx, BakeRequest { path, frames, rate: self.files.format.rate });
            }
            // Waits for the full-quality picture of a paused scene, which comes soon.
            Line::Shot(path)
                if !self.session.playing() && !self.painters.iter().all(|p| p.is_whole(snapshot)) =>
            {
                self.script.wait_for(Line::Shot(path));
                return ctx.request_repaint_after(Duration::from_millis(50));
            }
            Line::Shot(path) => {
                if let Err(why) = self.session.keep_files([path.clone()]) {
                    return self.set_message(why.to_string(), true);
                }
                let (send, receive) = channel();
                self.shot = Some(receive);
                let wake = ctx.clone();
                ctx.request_screenshot(move |image| {
                    // The window may have been closed in the meantime.
                    let _ = send.send(write(&path, &picture_of(&image)));
                    wake.request_repaint();
                });
            }
            Line::Pace => {
                println!(
                    "{}; a frame in {:.1} ms",
                    self.painters[0].note(),
                    1e3 * snapshot.took.as_secs_f32()
                );
            }
            Line::Quit => self.close(ctx),
        }
        ctx.request_repaint_after(Duration::from_millis(1));
    }

    /// Takes some of the steps that the script waits for while the scene is paused; `now` is the last step.
    fn take_steps(&mut self, now: u64) {
        let taken = self.steps.min(STEPS);
        (0..taken).for_each(|_| self.act(Action::Step));
        self.steps -= taken;
        self.waits = now + taken;
    }

    /// Writes a value, or removes one that is in the text.
    fn set(&mut self, key: Key, value: Option<toml_edit::Value>) {
        if value.is_none() && key.look_up(self.session.edited().parsed_text()).is_none() {
            let text = format!("the scene file has no {key}, so there is nothing to remove");
            return self.set_message(text, true);
        }
        let before = self.session.edited().text().to_owned();
        self.act(Action::Set(key.clone(), value));
        self.act(Action::Rest);
        let document = self.session.edited();
        let unused = |name: &&str| document.text() != before && document.has_unused_material(name);
        if let Some(name) = key.material().filter(unused) {
            let name = written_name(name);
            self.set_message(format!("no groom uses [material.{name}]; name it in `material`"), false);
        }
    }

    /// Position in the window of a point of the picture.
    fn place(&self, at: glam::Vec2) -> egui::Pos2 {
        self.rect.min + egui::vec2(at.x, at.y) * self.rect.size()
    }

    fn switch(&mut self, name: &str, on: bool) {
        let overlays = &mut self.view.overlays;
        let place = match name {
            "compare" => return self.act(Action::Compare(on)),
            "second" => return self.act(Action::Second(on)),
            "follow" => &mut self.view.follow,
            "graphs" => &mut self.open.graphs,
            "presets" => &mut self.open.presets,
            "help" => &mut self.open.help,
            "panels" => &mut self.open.panels,
            "hair" => &mut overlays.hair,
            "body" => &mut overlays.body,
            "colliders" => &mut overlays.colliders,
            "slice" => &mut overlays.slice,
            "volume" => &mut overlays.volume,
            "frames" => &mut overlays.frames,
            "roots" => &mut overlays.roots,
            "handles" => &mut overlays.handles,
            // The script's parser accepts no other name.
            _ => return,
        };
        *place = on;
    }

    /// Receives the result of writing a picture of the window.
    pub(super) fn poll_shot(&mut self) {
        let Some(outcome) = self.shot.as_ref().and_then(|shot| shot.try_recv().ok()) else { return };
        self.shot = None;
        if let Err(why) = outcome {
            self.set_message(why.to_string(), true);
        }
    }
}

/// Maximum number of steps in one request to the simulation: one second.
const STEPS: u64 = 60;

/// Converts a screenshot of the window to a picture.
fn picture_of(image: &egui::ColorImage) -> hairspring_view::Image {
    let mut out = hairspring_view::Image::new(image.size[0] as u32, image.size[1] as u32);
    for (to, from) in out.rgb.chunks_exact_mut(3).zip(&image.pixels) {
        to.copy_from_slice(&from.to_array()[..3]);
    }
    out
}
