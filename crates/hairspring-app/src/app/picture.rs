//! The picture, or two pictures side by side, with their overlays.

use super::{App, status_overlay};
use crate::{
    handle,
    overlay::{self, OverlayPainter},
    session::Action,
    snapshot::Snapshot,
};
use eframe::egui::{self, Sense, Ui};
use hairspring_scene::stage::Value;
use std::sync::Arc;

impl App {
    /// Shows the picture, or two pictures side by side, with their overlays.
    pub(super) fn picture(
        &mut self,
        ui: &mut Ui,
        snapshot: Option<&Arc<Snapshot>>,
        actions: &mut Vec<Action>,
    ) {
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
        self.view.adopt_camera(&self.session, snapshot, aspect);
        if self.view.orbit.is_none() {
            self.view.frame(&self.session, snapshot, aspect);
        }
        self.view.follow_subject(snapshot);
        let guides = self.session.shown() == Some(Value::Guide);
        self.caption = 0.0;
        for (k, stage) in snapshot.stages.iter().enumerate() {
            let left = whole.left() + width * k as f32;
            let rect =
                egui::Rect::from_min_size(egui::pos2(left, whole.top()), egui::vec2(width, whole.height()));
            let response = ui.interact(rect, ui.scope_id().with(("picture", k)), Sense::click_and_drag());
            if k == 0 {
                self.rect = rect;
                self.view.follow_range(&stage.values, guides, self.session.playing());
            }
            let moment = self.painters[k].moment(snapshot).clone();
            let seen = moment.stages.get(k).unwrap_or(stage);
            // Handles belong to the scene whose parameters are shown.
            let own = (k == 1) == self.session.on_second() && self.view.overlays.handles;
            let handles = match (self.view.lens(rect), self.view.orbit) {
                (Some(lens), Some(orbit)) if own => {
                    handle::all(self.session.edited(), seen, &lens, orbit.distance)
                }
                _ => Vec::new(),
            };
            self.view.touch(ui, &response, snapshot, &handles, actions);
            let (Some(parameters), Some(lens)) =
                (self.view.view_parameters(stage, aspect), self.view.lens(rect))
            else {
                continue;
            };
            let pixels = ui.ctx().pixels_per_point();
            let size = [rect.width(), rect.height()].map(|s| ((s * pixels).round() as u32).clamp(16, 8192));
            let painter = ui.painter_at(rect);
            if let Some(shape) = self.painters[k].draw(ui.ctx(), snapshot, k, &parameters, (rect, size)) {
                painter.add(shape);
            }
            let picked =
                snapshot.picked.as_ref().map(|(p, f)| [p.strand, f.guide as usize].map(|s| [p.groom, s]));
            let picked = picked.as_ref().map_or(&[][..], |picked| &picked[..]);
            overlay::draw(
                &OverlayPainter { painter: &painter, lens, rect },
                seen,
                &self.view,
                &handles,
                picked,
            );
            if count > 1 {
                let side = if k == 0 { "Left" } else { "Right" };
                let text = format!("{side} · {}", self.session.captions()[k.min(1)]);
                let shown = status_overlay::caption(&painter, rect, text, self.session.shown().is_some());
                if k == 0 {
                    self.caption = shown.bottom() - rect.top();
                }
            }
            if let Some(value) = self.session.shown() {
                status_overlay::legend(&painter, rect, value, &self.view, seen);
            }
        }
    }
}
