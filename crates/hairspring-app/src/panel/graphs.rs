//! Graphs of the last seconds: compute time, stretch, speed, energy and depth, of each scene of a comparison.

use super::number;
use crate::{
    player::STEP,
    snapshot::{Snapshot, StageSnapshot},
};
use eframe::egui::{self, Color32, RichText, Ui};
use egui_plot::{GridMark, Line, LineStyle, Plot, PlotPoints};
use std::{collections::VecDeque, time::Duration};

/// Length of the graphs, in time of the scene [s].
const SECONDS: f64 = 10.0;
/// Marks of the time axis [s]. A mark at its end would touch the labels of the other axis.
const TIMES: [f64; 3] = [-8.0, -4.0, 0.0];
/// Number of moments in the graphs.
const MOMENTS: usize = 600;
/// Height of a graph, and its smallest width [points].
const HEIGHT: f32 = 100.0;
const NARROWEST: f32 = 145.0;
/// Width of the labels of the vertical axis [points].
const LABELS: f32 = 34.0;
/// Colors of the lines of a graph.
const COLORS: [Color32; 4] = [
    Color32::from_rgb(240, 130, 110),
    Color32::from_rgb(110, 170, 240),
    Color32::from_rgb(150, 200, 100),
    Color32::from_rgb(210, 130, 230),
];

/// A figure of a scene, and its name.
type Figure = (&'static str, fn(&Figures) -> f64);

/// A graph of figures with the same unit.
struct Graph {
    title: &'static str,
    unit: &'static str,
    figures: &'static [Figure],
}

const GRAPHS: [Graph; 5] = [
    Graph {
        title: "Frame time",
        unit: "ms",
        figures: &[
            ("body", |f| f.body),
            ("simulation", |f| f.simulation),
            ("follow hairs", |f| f.follow),
            ("total", |f| f.total),
        ],
    },
    Graph {
        title: "Stretch",
        unit: "%",
        figures: &[("mean", |f| f.stretch[0]), ("worst", |f| f.stretch[1])],
    },
    Graph { title: "Fastest point", unit: "m/s", figures: &[("speed", |f| f.speed)] },
    Graph {
        title: "Energy",
        unit: "µJ",
        figures: &[("kinetic", |f| f.energy[0]), ("elastic", |f| f.energy[1])],
    },
    Graph {
        title: "Depth in colliders",
        unit: "mm",
        figures: &[("point", |f| f.depth[0]), ("segment", |f| f.depth[1])],
    },
];

/// The figures of one scene at one moment, in the units of the graphs.
#[derive(Clone, Copy)]
struct Figures {
    /// Compute times of the scene, and of all scenes together.
    body: f64,
    simulation: f64,
    follow: f64,
    total: f64,
    /// Mean and maximum.
    stretch: [f64; 2],
    speed: f64,
    /// Kinetic energy, and elastic energy of bending, twist and stretch.
    energy: [f64; 2],
    /// Of points and of segments.
    depth: [f64; 2],
}

impl Figures {
    fn new(stage: &StageSnapshot, took: Duration) -> Self {
        let ms = |d: Duration| 1e3 * d.as_secs_f64();
        let (r, m, e) = (stage.report, stage.measure, stage.energy);
        Self {
            body: ms(r.body),
            simulation: ms(r.simulate),
            follow: ms(r.follow),
            total: ms(took),
            stretch: [100.0 * m.stretch_mean, 100.0 * m.stretch_max],
            speed: m.speed_max,
            energy: [1e6 * e.kinetic, 1e6 * (e.bending + e.twisting + e.stretching)],
            depth: [1e3 * m.depth_inside(), 1e3 * m.segment_depth],
        }
    }
}

/// The figures of all scenes at one moment.
struct Moment {
    /// Time since the scene was opened [s].
    time: f64,
    scenes: Vec<Figures>,
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
        let now = (snapshot.scene, snapshot.step);
        if self.last == now {
            return;
        }
        if self.last.0 != snapshot.scene {
            self.moments.clear();
        }
        self.last = now;
        self.moments.push_back(Moment {
            time: snapshot.step as f64 * f64::from(STEP),
            scenes: snapshot.stages.iter().map(|stage| Figures::new(stage, snapshot.took)).collect(),
        });
        if self.moments.len() > MOMENTS {
            self.moments.pop_front();
        }
    }

    /// Shows the graphs side by side.
    pub fn show(&self, ui: &mut Ui) {
        let scenes = self.moments.back().map_or(0, |moment| moment.scenes.len());
        let lines = if scenes > 1 { "; solid: left scene, dashed: right scene" } else { "" };
        ui.weak(format!("The last {SECONDS} s of the scene{lines}"));
        egui::ScrollArea::horizontal().show(ui, |ui| {
            let gap = ui.spacing().item_spacing.x;
            let width = (ui.available_width() / GRAPHS.len() as f32 - gap).max(NARROWEST);
            ui.horizontal(|ui| {
                for graph in &GRAPHS {
                    ui.vertical(|ui| self.graph(ui, graph, width));
                }
            });
        });
    }

    fn graph(&self, ui: &mut Ui, graph: &Graph, width: f32) {
        ui.set_width(width);
        ui.label(format!("{} [{}]", graph.title, graph.unit));
        ui.horizontal(|ui| {
            for ((name, _), color) in graph.figures.iter().zip(COLORS) {
                ui.label(RichText::new(*name).color(color).small());
            }
        });
        let top = self.top(graph);
        // All marks have the same large step, so that none is left out or faded.
        let marks = |values: [f64; 3]| {
            move |_| values.map(|value| GridMark { value, step_size: values[2] - values[0] }).into()
        };
        let plot = Plot::new(graph.title)
            .height(HEIGHT)
            .width(width)
            .allow_drag(false)
            .allow_zoom(false)
            .allow_scroll(false)
            .show_y(false)
            .label_formatter(|_| None)
            .x_grid_spacer(marks(TIMES))
            .y_grid_spacer(marks([0.0, 0.5 * top, top]))
            .x_axis_formatter(|mark, _| format!("{} s", number::shown(mark.value)))
            .y_axis_formatter(|mark, _| number::shown(mark.value))
            .y_axis_min_width(LABELS)
            .show(ui, |plot| {
                plot.set_plot_bounds_x(-SECONDS..=0.0);
                plot.set_plot_bounds_y(0.0..=top);
                self.lines(graph).into_iter().for_each(|line| plot.line(line));
            });
        let at = plot.response.hover_pos().map(|pos| plot.transform.value_from_position(pos).x);
        if let Some(text) = at.and_then(|at| self.values(graph, at)) {
            plot.response.on_hover_text_at_pointer(text);
        }
    }

    fn now(&self) -> f64 {
        self.moments.back().map_or(0.0, |moment| moment.time)
    }

    /// The lines of a graph, over the time since now.
    fn lines<'a>(&self, graph: &Graph) -> Vec<Line<'a>> {
        let now = self.now();
        let scenes = self.moments.back().map_or(0, |moment| moment.scenes.len());
        let mut lines = Vec::new();
        for scene in 0..scenes {
            let style = if scene == 0 { LineStyle::Solid } else { LineStyle::dashed_dense() };
            for ((name, figure), color) in graph.figures.iter().zip(COLORS) {
                let points: PlotPoints<'a> =
                    self.moments.iter().map(|m| [m.time - now, figure(&m.scenes[scene])]).collect();
                lines.push(Line::new(*name, points).color(color).style(style).allow_hover(false));
            }
        }
        lines
    }

    /// Upper end of the vertical axis: a round number that all values are below.
    fn top(&self, graph: &Graph) -> f64 {
        let values = self.moments.iter().flat_map(|m| &m.scenes);
        let values = values.flat_map(|scene| graph.figures.iter().map(|(_, figure)| figure(scene)));
        round_up(values.filter(|v| v.is_finite()).fold(0.0, f64::max))
    }

    /// The values at a time in seconds since now, as text: a line for each figure, with the values of all scenes.
    fn values(&self, graph: &Graph, at: f64) -> Option<String> {
        let now = self.now();
        let off = |m: &&Moment| (m.time - now - at).abs();
        let moment = self.moments.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
        let mut text = format!("{:.2} s ago", now - moment.time);
        for (name, figure) in graph.figures {
            let scenes: Vec<String> =
                moment.scenes.iter().map(|scene| number::shown(figure(scene))).collect();
            text += &format!("\n{name} {} {}", scenes.join(" | "), graph.unit);
        }
        if moment.scenes.len() > 1 {
            text += "\nleft | right";
        }
        Some(text)
    }
}

/// The smallest of 1, 2 and 5 times a power of ten that is not below `value`; 1 for 0.
fn round_up(value: f64) -> f64 {
    if value <= 0.0 {
        return 1.0;
    }
    let power = 10f64.powf(value.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power).into_iter().find(|top| *top >= value).unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ZERO: Figures = Figures {
        body: 0.0,
        simulation: 0.0,
        follow: 0.0,
        total: 0.0,
        stretch: [0.0; 2],
        speed: 0.0,
        energy: [0.0; 2],
        depth: [0.0; 2],
    };

    #[test]
    fn graphs_show_both_scenes_of_a_comparison() {
        let moment = |time, left, right| Moment {
            time,
            scenes: [left, right].map(|worst| Figures { stretch: [0.1, worst], ..ZERO }).into(),
        };
        let moments = VecDeque::from([moment(1.0, 0.2, 0.3), moment(1.5, 0.4, 3.2)]);
        let history = History { moments, last: (1, 90) };
        let stretch = &GRAPHS[1];
        assert_eq!(history.lines(stretch).len(), 4, "two figures of two scenes");
        assert_eq!(history.top(stretch), 5.0, "the scale holds the right scene");
        let text = history.values(stretch, -0.4).unwrap();
        assert_eq!(text, "0.50 s ago\nmean 0.1 | 0.1 %\nworst 0.2 | 0.3 %\nleft | right");
    }

    #[test]
    fn the_scale_ends_at_a_round_number() {
        let tops = [0.0, 1.0, 1.1, 3.0, 7.0, 0.03, 12000.0].map(round_up);
        assert_eq!(tops, [1.0, 1.0, 2.0, 5.0, 10.0, 0.05, 20000.0]);
    }
}
