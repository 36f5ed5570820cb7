//! The timeline: the frames of the scene, those that are cached, and the range that is played in a loop.

use crate::{
    player::{CachedFrames, RATE},
    session::{Action, LAST_FRAME, Session},
    snapshot::Snapshot,
    text::counted,
};
use eframe::egui::{self, Color32, Rect, Sense, Ui, pos2, vec2};

/// Height of the bar [points].
const HEIGHT: f32 = 20.0;
/// Number of frames that the bar shows at least: two seconds.
const FEWEST: u64 = 120;
/// Smallest distance between two labels [points].
const LABEL: f32 = 56.0;
/// Distances between labels [frames].
const DISTANCES: [u64; 9] = [10, 30, 60, 120, 300, 600, 1200, 3000, 6000];

/// Number of a frame as it is shown. As on the command line, frame 1 is at time 0.
pub fn number(frame: u64) -> u64 {
    frame + 1
}

/// The timeline below the playback controls.
pub fn show(ui: &mut Ui, session: &Session, snapshot: &Snapshot, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let frame = snapshot.frame;
        let motion = session.last_frame();
        let mut last = motion.unwrap_or(FEWEST).max(frame);
        last = last.max(snapshot.cached.frames.last().copied().unwrap_or(0));
        let range = session.range();
        let (first, end) = range.unwrap_or((0, motion.unwrap_or(last)));
        let (mut from, mut to) = (number(first), number(end));
        last = last.max(to - 1);
        let mut looped = session.repeats();
        if ui.checkbox(&mut looped, "Loop").on_hover_text(LOOP).changed() {
            actions.push(Action::Repeat(looped));
        }
        let most = from + 1..=number(motion.unwrap_or(LAST_FRAME));
        let first = egui::DragValue::new(&mut from).range(1..=to.saturating_sub(1).max(1)).prefix("from ");
        let mut changed = ui.add(first).on_hover_text("First frame of the loop").changed();
        changed |= ui
            .add(egui::DragValue::new(&mut to).range(most).prefix("to "))
            .on_hover_text("Last frame of the loop")
            .changed();
        if changed {
            actions.push(Action::Range(Some((from - 1, to.max(from + 1) - 1))));
        }
        let whole = ui.add_enabled(range.is_some(), egui::Button::new("All"));
        if whole.on_hover_text("Loop over the whole motion").clicked() {
            actions.push(Action::Range(None));
        }
        ui.monospace(format!("frame {:>4}", number(frame)));
        bar(ui, (frame, last), range.filter(|_| looped), snapshot, actions);
    });
}

/// The tooltip of the loop.
const LOOP: &str = "Go back to the first frame after the last. Without a range, the whole motion repeats.";

fn bar(
    ui: &mut Ui,
    (frame, last): (u64, u64),
    range: Option<(u64, u64)>,
    snapshot: &Snapshot,
    actions: &mut Vec<Action>,
) {
    let size = vec2(ui.available_width().max(80.0), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let per_frame = rect.width() / last.max(1) as f32;
    let x = |frame: u64| rect.left() + per_frame * frame as f32;
    if let Some(at) = response.interact_pointer_pos() {
        let wanted = ((at.x - rect.left()) / per_frame).round().clamp(0.0, last as f32) as u64;
        if wanted != frame {
            actions.push(Action::Seek(wanted));
        }
    }
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 3.0, Color32::from_gray(20));
    if let Some((from, to)) = range {
        let band = Rect::from_min_max(pos2(x(from), rect.top()), pos2(x(to), rect.bottom()));
        painter.rect_filled(band, 0.0, Color32::from_rgb(44, 52, 66));
    }
    // Kept frames: a line at the lower edge, which has gaps where frames are left out.
    let cached = &snapshot.cached;
    let half = 0.5 * per_frame.max(1.0);
    for run in cached.frames.chunk_by(|a, b| b - a == 1) {
        let (Some(first), Some(last)) = (run.first(), run.last()) else { continue };
        let line =
            Rect::from_x_y_ranges(x(*first) - half..=x(*last) + half, rect.bottom() - 4.0..=rect.bottom());
        painter.rect_filled(line, 0.0, Color32::from_rgb(90, 150, 220));
    }
    let apart = DISTANCES.into_iter().find(|d| *d as f32 * per_frame >= LABEL).unwrap_or(last.max(1));
    for tick in (0..=last).step_by(apart as usize) {
        let top = pos2(x(tick), rect.top());
        painter.vline(top.x, rect.top()..=rect.top() + 5.0, (1.0, Color32::from_gray(110)));
        let (align, font) = (egui::Align2::LEFT_TOP, egui::FontId::proportional(11.0));
        painter.text(top + vec2(3.0, 0.0), align, number(tick).to_string(), font, Color32::from_gray(190));
    }
    painter.vline(x(frame), rect.y_range(), (2.0, Color32::from_rgb(250, 200, 90)));
    response.on_hover_ui(|ui| {
        ui.label(format!(
            "Drag to go through the cached frames (blue). A frame is 1/{:.0} s; frame 1 is at time 0.",
            RATE.hertz()
        ));
        if let Some([first, second, ..]) = cached.frames.get(..2)
            && second - first > 1
        {
            ui.label(format!("To fit, one frame of {} is kept.", second - first));
        }
    });
}

/// How many frames are cached, and the memory for it.
pub fn cache_note(cached: &CachedFrames) -> String {
    let [used, limit] = cached.bytes.map(|bytes| bytes.div_ceil(1 << 20));
    format!("{} cached in {used} of {limit} MiB", counted(cached.frames.len() as u64, "frame"))
}
