//! Runs a script in the window.

use super::App;
use crate::{
    bake::BakeRequest,
    document::builtin_text,
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
        let Some(line) = self.script.begin_next() else { return };
        match line {
            Line::Wait(steps) => {
                self.waits = snapshot.step + steps;
                if !self.session.playing() {
                    (0..steps).for_each(|_| self.act(Action::Step));
                }
            }
            Line::Play(on) => self.act(Action::Play(on)),
            Line::Step => self.act(Action::Step),
            Line::Reset => self.act(Action::Reset),
            Line::Seek(frame) => self.act(Action::Seek(frame)),
            Line::Range(range) => self.act(Action::Range(range)),
            Line::Speed(speed) => self.act(Action::Speed(speed)),
            Line::Set(key, value) => {
                self.act(Action::Set(key, value));
                self.act(Action::Rest);
            }
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
                    "{}; a step in {:.1} ms",
                    self.painters[0].note(),
                    1e3 * snapshot.took.as_secs_f32()
                );
            }
            Line::Quit => self.close(ctx),
        }
        ctx.request_repaint_after(Duration::from_millis(1));
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

/// Converts a screenshot of the window to a picture.
fn picture_of(image: &egui::ColorImage) -> hairspring_view::Image {
    let mut out = hairspring_view::Image::new(image.size[0] as u32, image.size[1] as u32);
    for (to, from) in out.rgb.chunks_exact_mut(3).zip(&image.pixels) {
        to.copy_from_slice(&from.to_array()[..3]);
    }
    out
}
