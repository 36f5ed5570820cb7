//! Figures: amount of hair, stretch, depth, volume; the picked strand.

use crate::{
    session::{Action, Session},
    snapshot::Snapshot,
    text::counted,
};
use eframe::egui::{self, Ui};

/// Shows the amount of hair and its figures.
pub fn figures(ui: &mut Ui, session: &Session, snapshot: &Snapshot, note: &str) {
    let many = |number: usize, noun: &str| counted(number as u64, noun);
    let sides = if snapshot.stages.len() > 1 { ["left: ", "right: "] } else { [""; 2] };
    let stages = || snapshot.stages.iter().zip(sides);
    let same = snapshot.stages.windows(2).all(|pair| pair[0].still.counts == pair[1].still.counts);
    for (stage, side) in stages().take(if same { 1 } else { 2 }) {
        let [guides, strands, points, all] = stage.still.counts;
        ui.label(format!(
            "{}{} of {}; {guides} simulated with {}; {}",
            if same { "" } else { side },
            many(strands, "hair"),
            many(all, "point"),
            many(points, "point"),
            stage.still.instruction_set
        ));
    }
    for (stage, side) in stages() {
        let m = &stage.measure;
        let volume = stage.volume.map(|v| format!(", volume {:.0} %", 100.0 * v.volume_ratio));
        let started =
            (m.started_inside_points > 0).then(|| format!(" ({} from the start)", m.started_inside_points));
        ui.label(format!(
            "{side}stretch {:.2} % mean, {:.2} % worst; {}{} and {} inside{}",
            100.0 * m.stretch_mean,
            100.0 * m.stretch_max,
            many(m.inside_points, "point"),
            started.unwrap_or_default(),
            many(m.deep_segments + m.held_segments, "segment"),
            volume.unwrap_or_default()
        ));
    }
    if snapshot.reset_strands > 0 {
        let strands = many(snapshot.reset_strands, "strand");
        let text = format!("{strands} put back to rest after values that were not finite");
        ui.colored_label(ui.visuals().warn_fg_color, text);
    }
    ui.weak(note);
    match session.notes() {
        [] => {}
        notes => {
            let text = format!("{} on its files: rest the pointer here", many(notes.len(), "note"));
            ui.weak(text).on_hover_text(notes.join("\n"));
        }
    }
}

/// Shows the figures of the picked strand.
pub fn picked(ui: &mut Ui, session: &Session, snapshot: &Snapshot, actions: &mut Vec<Action>) {
    let Some((picked, figures)) = &snapshot.picked else { return };
    // Keeps a figure on the line of its name.
    ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
    ui.horizontal(|ui| {
        let groom = session.document().groom_name(picked.groom);
        let side = if snapshot.stages.len() > 1 { ", left scene" } else { "" };
        ui.strong(format!("Strand {} of {groom}{side}", picked.strand));
        if ui.small_button("Forget").clicked() {
            actions.push(Action::Unpick);
        }
    });
    egui::Grid::new("picked").num_columns(2).show(ui, |ui| {
        let mut row = |name: &str, value: String| {
            ui.label(name);
            ui.monospace(value);
            ui.end_row();
        };
        row(
            "simulated",
            if figures.simulated { "yes".into() } else { format!("follows strand {}", figures.guide) },
        );
        row("points", figures.points.to_string());
        row("length", format!("{:.1} mm", 1e3 * figures.length));
        row("worst stretch", format!("{:.3} %", 100.0 * figures.stretch_max));
        row("largest tension", format!("{:.2e} N", figures.tension_max));
        row("largest turn", format!("{:.1}°", figures.turn_max.to_degrees()));
        row("fastest point", format!("{:.3} m/s", figures.speed_max));
        row("largest contact", format!("{:.2e} N", figures.contact_max));
        row("deepest inside", format!("{:.2} mm", 1e3 * figures.depth));
    });
}
