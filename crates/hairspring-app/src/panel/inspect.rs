//! Figures: time of each stage, stretch, speed, energy, depth, volume; graphs of the last seconds; the picked
//! strand.

use crate::{
    session::{Action, Session},
    snapshot::Snapshot,
    text::counted,
};
use eframe::egui::{self, Ui};
use egui_plot::{Legend, Line, Plot, PlotPoints};
use std::collections::VecDeque;

/// Number of moments in the graphs: ten seconds.
const MOMENTS: usize = 600;

/// The figures of one moment.
#[derive(Clone, Copy, Default)]
struct Moment {
    time: f64,
    /// Time of body, simulation, follow hairs, and the whole step [ms].
    took: [f64; 4],
    /// Mean and maximum stretch [%].
    stretch: [f64; 2],
    /// Speed of the fastest point [m/s].
    speed: f64,
    /// Kinetic energy, and elastic energy of bending, twist and stretch [µJ].
    energy: [f64; 2],
    /// Maximum depth of points and of segments inside a collider [mm].
    depth: [f64; 2],
}

/// The figures of the last seconds.
#[derive(Default)]
pub struct History {
    moments: VecDeque<Moment>,
    last: (u64, u64),
}

impl History {
    /// Adds a moment, if it is new.
    pub fn keep(&mut self, snapshot: &Snapshot) {
        if self.last.0 != snapshot.scene {
            self.moments.clear();
        }
        let now = (snapshot.scene, snapshot.step);
        let Some(stage) = snapshot.stages.first().filter(|_| self.last != now) else { return };
        self.last = now;
        let ms = |d: std::time::Duration| 1e3 * d.as_secs_f64();
        let (r, m, e) = (snapshot.report, stage.measure, stage.energy);
        self.moments.push_back(Moment {
            time: snapshot.step as f64 * f64::from(crate::player::STEP),
            took: [ms(r.body), ms(r.simulate), ms(r.follow), ms(snapshot.took)],
            stretch: [100.0 * m.stretch_mean, 100.0 * m.stretch_max],
            speed: m.speed_max,
            energy: [1e6 * e.kinetic, 1e6 * (e.bending + e.twisting + e.stretching)],
            depth: [1e3 * m.depth_inside(), 1e3 * m.segment_depth],
        });
        if self.moments.len() > MOMENTS {
            self.moments.pop_front();
        }
    }

    fn line<'a>(&'a self, name: &'a str, of: impl Fn(&Moment) -> f64) -> Line<'a> {
        let points: PlotPoints = self.moments.iter().map(|m| [m.time, of(m)]).collect();
        Line::new(name, points)
    }

    /// Shows the graphs side by side.
    pub fn show(&self, ui: &mut Ui) {
        let width = (ui.available_width() / 5.0 - 8.0).max(120.0);
        ui.horizontal(|ui| {
            let plot = |ui: &mut Ui, name: &str, lines: Vec<Line<'_>>| {
                ui.vertical(|ui| {
                    ui.set_width(width);
                    ui.label(name);
                    Plot::new(name)
                        .height(110.0)
                        .width(width)
                        .include_y(0.0)
                        .allow_drag(false)
                        .allow_zoom(false)
                        .allow_scroll(false)
                        .legend(Legend::default())
                        .show(ui, |plot| lines.into_iter().for_each(|line| plot.line(line)));
                });
            };
            let took = ["body", "simulation", "follow", "step"];
            plot(ui, "Time of a step [ms]", (0..4).map(|k| self.line(took[k], move |m| m.took[k])).collect());
            plot(
                ui,
                "Stretch [%]",
                vec![self.line("mean", |m| m.stretch[0]), self.line("worst", |m| m.stretch[1])],
            );
            plot(ui, "Fastest point [m/s]", vec![self.line("speed", |m| m.speed)]);
            plot(
                ui,
                "Energy [µJ]",
                vec![self.line("motion", |m| m.energy[0]), self.line("shape", |m| m.energy[1])],
            );
            plot(
                ui,
                "Deepest inside [mm]",
                vec![self.line("point", |m| m.depth[0]), self.line("segment", |m| m.depth[1])],
            );
        });
    }
}

/// Shows the amount of hair and its figures.
pub fn figures(ui: &mut Ui, session: &Session, snapshot: &Snapshot, note: &str) {
    let Some(stage) = snapshot.stages.first() else { return };
    let [guides, strands, points, all] = stage.still.counts;
    let many = |number: usize, noun: &str| counted(number as u64, noun);
    ui.label(format!(
        "{} of {}; {guides} simulated with {}; {}",
        many(strands, "hair"),
        many(all, "point"),
        many(points, "point"),
        stage.still.instruction_set
    ));
    for (k, stage) in snapshot.stages.iter().enumerate() {
        let m = &stage.measure;
        let side = match snapshot.stages.len() {
            1 => "",
            _ if k == 0 => "left: ",
            _ => "right: ",
        };
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
    ui.horizontal(|ui| {
        let groom = session.document().groom_name(picked.groom);
        ui.strong(format!("Strand {} of {groom}", picked.strand));
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
