//! Overlays on the picture: progress, messages, figures, and the legend of the color ramp.

use super::{App, MESSAGE};
use crate::{
    painter::Painter,
    panel::inspect,
    session::Action,
    snapshot::{Snapshot, StageSnapshot},
    text::counted,
    view::View,
};
use eframe::egui::{self, Color32, Ui};
use hairspring_scene::stage::Value;

/// Smallest height of a picture that figures are shown on [points].
const FIGURES: f32 = 240.0;
/// Distance of a message from the picture's upper edge [points].
const MESSAGE_TOP: f32 = 66.0;
/// Largest width of the color legend, with its distance from the edge [points].
const LEGEND: f32 = 190.0;
/// Distance of the color legend from the right edge [points], and its number of pieces.
const LEGEND_EDGE: f32 = 20.0;
const LEGEND_PIECES: u32 = 34;

impl App {
    /// Shows the figures of all hair and of the picked strand, unless the picture is too small for them.
    pub(super) fn show_figures(&self, ctx: &egui::Context, snapshot: &Snapshot, actions: &mut Vec<Action>) {
        if self.whole.height() < FIGURES {
            return;
        }
        let notes: Vec<String> = self.painters.iter().map(Painter::note).collect();
        let figures = corner(ctx, self.whole, egui::Align2::LEFT_BOTTOM, |ui| {
            inspect::figures(ui, &self.session, snapshot, &notes.join("; "));
        });
        if snapshot.picked.is_some() {
            // Below the caption of a side, and above the figures.
            let top = self.rect.top() + self.caption.max(22.0);
            let free = egui::Rect::from_x_y_ranges(self.rect.x_range(), top..=figures.top());
            corner(ctx, free, egui::Align2::LEFT_TOP, |ui| {
                inspect::picked(ui, &self.session, snapshot, actions);
            });
        }
    }

    /// Shows the progress of a recording, and the last message.
    pub(super) fn show_status(&mut self, ctx: &egui::Context) {
        let corner = self.whole.min + egui::vec2(20.0, 40.0);
        if let Some(recorder) = &self.recorder {
            let (done, all) = recorder.progress();
            let mut stopped = false;
            egui::Window::new("Recording").default_pos(corner).collapsible(false).resizable(false).show(
                ctx,
                |ui| {
                    ui.add(
                        egui::ProgressBar::new(done as f32 / all as f32)
                            .text(format!("{done} of {}", counted(all.into(), "frame"))),
                    );
                    stopped = ui.button("Stop").clicked();
                },
            );
            if stopped && let Some(recorder) = self.recorder.take() {
                match recorder.stop(&mut self.session) {
                    Ok(message) => self.set_message(message, false),
                    Err(why) => self.set_message(why.to_string(), true),
                }
            }
        }
        if let Some(baker) = &self.baker {
            let (done, all) = baker.progress();
            egui::Window::new("Baking").default_pos(corner).collapsible(false).resizable(false).show(
                ctx,
                |ui| {
                    let done_so_far = format!("{done} of {}", counted(all.into(), "frame"));
                    ui.add(egui::ProgressBar::new(done as f32 / all as f32).text(done_so_far));
                    if ui
                        .button("Stop")
                        .on_hover_text("Stops after the current frame. Finished files are kept.")
                        .clicked()
                    {
                        baker.cancel();
                    }
                },
            );
        }
        let Some((text, wrong, since)) = &self.message else { return };
        if since.elapsed() > MESSAGE {
            self.message = None;
            return;
        }
        let color = if *wrong { Color32::LIGHT_RED } else { Color32::LIGHT_GREEN };
        let shown = egui::Area::new(egui::Id::unique("message"))
            // At the center of the picture, below the color legend and next to the figures of a picked
            // strand.
            .pivot(egui::Align2::CENTER_TOP)
            .fixed_pos(self.whole.center_top() + egui::vec2(0.0, MESSAGE_TOP))
            .sense(egui::Sense::click())
            .show(ctx, |ui| {
                ui.style_mut().interaction.selectable_labels = false;
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_max_width((self.whole.width() - 2.0 * LEGEND).max(240.0));
                    ui.colored_label(color, text);
                });
            });
        // A click dismisses the message.
        if shown.response.on_hover_text("Click to dismiss.").clicked() {
            self.message = None;
        }
        ctx.request_repaint_after(MESSAGE);
    }
}

/// Color behind text on the picture, so that it can be read on any background.
const BEHIND: Color32 = Color32::from_black_alpha(205);

/// Distance of text in a corner from the edges of the picture [points].
const CORNER: f32 = 10.0;

/// Distance of a caption from the edges of its side [points].
const CAPTION: egui::Vec2 = egui::vec2(10.0, 8.0);

/// Draws text on the picture, readable on any background, in lines of at most `width` [points]. Returns its rectangle.
fn text_on_picture(
    painter: &egui::Painter,
    at: egui::Pos2,
    align: egui::Align2,
    text: String,
    (size, width): (f32, f32),
) -> egui::Rect {
    let white = Color32::from_gray(235);
    let galley = painter.layout(text, egui::FontId::proportional(size), white, width);
    let rect = align.anchor_size(at, galley.size());
    let behind = rect.expand2(egui::vec2(4.0, 1.0));
    painter.rect_filled(behind, 3.0, BEHIND);
    painter.galley(rect.min, galley, white);
    behind
}

/// Draws the caption of one scene of a comparison. It wraps at the edge of the scene and does not cover the color legend.
/// Returns its rectangle.
pub(super) fn caption(painter: &egui::Painter, side: egui::Rect, text: String, legend: bool) -> egui::Rect {
    let room = side.width() - 2.0 * CAPTION.x - if legend { LEGEND } else { 0.0 };
    text_on_picture(painter, side.min + CAPTION, egui::Align2::LEFT_TOP, text, (16.0, room.max(80.0)))
}

/// Shows text in a corner of `rect`, on the left. It wraps at the edge of `rect` and covers nothing outside. Returns its
/// rectangle.
fn corner(
    ctx: &egui::Context,
    rect: egui::Rect,
    align: egui::Align2,
    show: impl FnOnce(&mut Ui),
) -> egui::Rect {
    let inside = rect.shrink(CORNER);
    let area = egui::Area::new(egui::Id::unique(("figures", align.y() == egui::Align::TOP)))
        .fixed_pos(align.pos_in_rect(&inside))
        .pivot(align)
        .constrain_to(inside)
        .show(ctx, |ui| {
            ui.set_clip_rect(inside);
            ui.style_mut().interaction.selectable_labels = false;
            let frame = egui::Frame::new().fill(BEHIND).corner_radius(4.0).inner_margin(6.0);
            ui.set_max_width((inside.width() - frame.total_margin().sum().x).max(0.0));
            frame.show(ui, |ui| {
                let visuals = ui.visuals_mut();
                visuals.override_text_color = Some(Color32::from_gray(235));
                visuals.weak_text_color = Some(Color32::from_gray(200));
                show(ui);
            });
        });
    area.response.rect
}

/// Shows the legend of the color ramp.
pub(super) fn legend(
    painter: &egui::Painter,
    rect: egui::Rect,
    value: Value,
    view: &View,
    stage: &StageSnapshot,
) {
    let at = rect.right_top() + egui::vec2(-LEGEND.min(rect.width() - LEGEND_EDGE), 14.0);
    let width = rect.right() - LEGEND_EDGE - at.x;
    let text = |place: egui::Pos2, align, text: String| {
        text_on_picture(painter, place, align, text, (13.0, f32::INFINITY));
    };
    let unit = match value.unit() {
        "1" => "",
        unit => unit,
    };
    text(at, egui::Align2::LEFT_TOP, value.name().to_owned());
    if value == Value::Guide {
        return;
    }
    if value == Value::Density && stage.volume.is_none() {
        let right = at + egui::vec2(width, 18.0);
        text(right, egui::Align2::RIGHT_TOP, "known with a volume method (Volume)".into());
        return;
    }
    let bar = egui::Rect::from_min_size(at + egui::vec2(0.0, 20.0), egui::vec2(width, 10.0));
    let piece = egui::vec2(width / LEGEND_PIECES as f32, bar.height());
    for k in 0..LEGEND_PIECES {
        let share = k as f32 / (LEGEND_PIECES - 1) as f32;
        let c = crate::ramp::color(share, [0.0, 1.0]).to_array().map(|x| (x.powf(1.0 / 2.2) * 255.0) as u8);
        let piece = egui::Rect::from_min_size(bar.min + egui::vec2(k as f32 * piece.x, 0.0), piece);
        painter.rect_filled(piece, 0.0, Color32::from_rgb(c[0], c[1], c[2]));
    }
    text(bar.left_bottom(), egui::Align2::LEFT_TOP, "0".into());
    text(bar.right_bottom(), egui::Align2::RIGHT_TOP, readable(view.range[1], unit));
}

/// Formats a number with three digits and an SI prefix of the unit.
fn readable(value: f32, unit: &str) -> String {
    let (scale, prefix) = match value {
        v if unit.is_empty() && v < 0.1 => (1e2, "%"),
        v if unit.is_empty() || v >= 0.1 => (1.0, ""),
        v if v >= 1e-4 => (1e3, "m"),
        v if v >= 1e-7 => (1e6, "µ"),
        _ => (1e9, "n"),
    };
    let value = value * scale;
    let digits = (2.0 - value.max(1e-9).log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.digits$} {prefix}{unit}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_caption_stays_within_its_side() {
        let long =
            "Right · Integrator: backward-euler, Elastic model: curvature, Hair-hair interaction: density"
                .repeat(2);
        let side = egui::Rect::from_min_size(egui::pos2(300.0, 50.0), egui::vec2(300.0, 500.0));
        let mut shown = Vec::new();
        let ctx = egui::Context::default();
        let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
            shown = [false, true].map(|legend| caption(ui.painter(), side, long.clone(), legend)).into();
        });
        assert!(shown.iter().all(|shown| side.contains_rect(*shown) && shown.height() > 40.0), "{shown:?}");
        assert!(shown[1].right() < side.right() - LEGEND, "it covers the legend: {shown:?}");
    }

    #[test]
    fn numbers_of_the_legend_can_be_read() {
        assert_eq!(readable(5.462e-6, "N"), "5.46 µN");
        assert_eq!(readable(2.0e-3, "m/s"), "2.00 mm/s");
        assert_eq!(readable(1.25, "m/s"), "1.25 m/s");
        assert_eq!(readable(123.4, "rad"), "123 rad");
        assert_eq!(readable(8.62e-5, ""), "0.00862 %");
        assert_eq!(readable(0.82, ""), "0.820");
    }
}
