//! The report: the table, the curves, each method with its equations, and the scene at the same moments side
//! by side.

use super::{HEADS, Setting, Trial, lessons, limits, percent, row};
use crate::report::{
    chart::{Series, svg},
    document, escape, number,
};
use base64::{Engine, engine::general_purpose::STANDARD};
use hairspring_validate::Axis;
use std::fmt::Write;

/// Energy above which a curve leaves the plot, relative to the initial energy of the swing [1].
const MOST_ENERGY: f64 = 2.5;

/// Range of the plotted stretch [1]. Values below it are not meaningful, because of the precision of f32.
const STRETCHES: [f64; 2] = [1e-6, 10.0];

/// Maximum number of points of a curve.
const POINTS: usize = 400;

/// Builds the page.
pub fn page(setting: &Setting, trials: &[Trial]) -> String {
    let mut body = format!(
        "<p>Time integrators for the same springs, on the same hair with the same steps: which of them are stable, what do they cost, and \
         how do they change a free swing?</p>\n\
         <p>The scene is <b>{}</b>: {} of its {} strands are simulated, {} points, {} substeps per 1/60 s (h = {}), for {} s. \
         <small>hairspring {}, {} threads, {}.</small></p>\n",
        escape(&setting.name),
        setting.simulated_strands,
        setting.strands,
        setting.simulated_points,
        setting.substeps,
        super::duration(1.0 / (60.0 * f64::from(setting.substeps))),
        number(setting.seconds),
        env!("CARGO_PKG_VERSION"),
        rayon::current_num_threads(),
        escape(&setting.simd),
    );
    body += &table(trials);
    body += &format!("<p><small>{}</small></p>\n", escape(&limits(setting)));
    body += &pictures(trials);
    body += &energy(setting, trials);
    body += &stretch(trials);
    body += lessons::SPRINGS;
    body += lessons::QUESTION;
    trials.iter().for_each(|t| body += &section(t));
    body += lessons::CONTACT;
    document("Time integrators for a strand of hair", &body)
}

fn table(trials: &[Trial]) -> String {
    // Numbers are right-aligned.
    let class = |column: usize| if column < 2 { "" } else { " class=\"number\"" };
    let head = |(k, h): (usize, &&str)| format!("<th{}>{h}</th>", class(k));
    let heads: String = HEADS.iter().enumerate().map(head).collect();
    let rows: String = trials
        .iter()
        .map(|t| {
            let [name, cells @ ..] = row(t);
            let cell = |(k, c): (usize, &String)| format!("<td{}>{}</td>", class(k + 1), escape(c));
            let cells: String = cells.iter().enumerate().map(cell).collect();
            let fails = if t.stable() { "" } else { " class=\"fail\"" };
            format!("<tr{fails}><td><a href=\"#{name}\">{name}</a></td>{cells}</tr>\n")
        })
        .collect();
    format!("<div class=\"wide\"><table><tr>{heads}</tr>\n{rows}</table></div>\n")
}

/// Pictures at the same moments, one row for each method.
fn pictures(trials: &[Trial]) -> String {
    let Some(first) = trials.first() else { return String::new() };
    let heads: String = first
        .played
        .shots
        .iter()
        .map(|s| format!("<th class=\"picture\">{} s</th>", number((s.time * 100.0).round() / 100.0)))
        .collect();
    let mut html = format!(
        "<h2>The scene</h2>\n<p>The same moments of the same motion. Strands that became non-finite were reset to \
         rest, and simulated again in the next frame.</p>\n<div class=\"wide\"><table><tr><th></th>{heads}</tr>\n"
    );
    for trial in trials {
        let name = trial.integrator.name();
        let _ = write!(html, "<tr><td><b>{name}</b></td>");
        for shot in &trial.played.shots {
            let reset = match shot.reset_strands {
                0 => String::new(),
                n => format!("<small>{n} strands reset</small>"),
            };
            let _ = write!(
                html,
                "<td class=\"picture\"><img alt=\"{name} at {} s\" src=\"data:image/png;base64,{}\">{reset}</td>",
                number(shot.time),
                STANDARD.encode(&shot.png)
            );
        }
        html += "</tr>\n";
    }
    html + "</table></div>\n"
}

/// Plot of the energy of the swing over time.
fn energy(setting: &Setting, trials: &[Trial]) -> String {
    let h = 1.0 / (60.0 * f64::from(setting.substeps));
    let curves: Vec<(&str, Vec<[f64; 2]>)> = trials
        .iter()
        .map(|t| {
            let over = t.swung.energy.iter().position(|e| e[1] > MOST_ENERGY).unwrap_or(usize::MAX);
            let shown = t.swung.energy.iter().take(over).copied().collect();
            (t.integrator.name(), thinned(shown))
        })
        .collect();
    let axes = [("time [s]", false), ("energy [initial energy]", false)];
    let blown = |t: &Trial| {
        let end = t.swung.energy.last().filter(|_| t.swung.drift.is_none())?;
        Some(format!("{} within {}", t.integrator.name(), super::duration(end[0] + h)))
    };
    let blown: Vec<String> = trials.iter().filter_map(blown).collect();
    let blown = if blown.is_empty() { String::new() } else { format!(" Blew up: {}.", blown.join(", ")) };
    format!(
        "<h2>Energy</h2>\n<p>{} strands swing freely, without drive, contact or damping. An exact method would keep the sum of the energies of motion, \
         height, bending, twist and stretch. 1 is the initial energy; at 0, all energy that falling can release is gone. A method that loses energy makes hair that moves as in \
         honey; one that gains energy makes hair that never comes to rest. Curves end where a swing blew up or left the plot.{blown}</p>\n{}\n",
        setting.swinging.strand_count(),
        plot(axes, &curves, &format!("h = {}", super::duration(h))),
    )
}

/// Plot of the maximum stretch in the scene over time.
fn stretch(trials: &[Trial]) -> String {
    let [least, most] = STRETCHES;
    let curves: Vec<(&str, Vec<[f64; 2]>)> = trials
        .iter()
        .map(|t| {
            let shown = t.played.stretch.iter().map(|[time, s]| [*time, s.clamp(least, most)]).collect();
            (t.integrator.name(), thinned(shown))
        })
        .collect();
    let axes = [("time [s]", false), ("maximum |ℓ/L − 1| of a frame", true)];
    let note = format!("between {} % and {}", number(least * 100.0), percent(most));
    format!(
        "<h2>Stretch</h2>\n<p>Hair does not visibly stretch; the limit of visibility is about 1 %. The curve shows the segment that is farthest from its \
         rest length in each frame of the scene.</p>\n{}\n",
        plot(axes, &curves, &note)
    )
}

fn plot(axes: [(&str, bool); 2], curves: &[(&str, Vec<[f64; 2]>)], note: &str) -> String {
    let [x, y] = axes.map(|(label, log)| Axis { label: label.into(), log });
    let series: Vec<Series> = curves.iter().map(|(name, line)| Series { name, line, points: &[] }).collect();
    svg([&x, &y], &series, note)
}

/// Keeps every n-th point of a curve and the last, so that about [`POINTS`] remain.
fn thinned(curve: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let every = curve.len().div_ceil(POINTS).max(1);
    let last = curve.len().saturating_sub(1);
    curve.into_iter().enumerate().filter(|(k, _)| k % every == 0 || *k == last).map(|(_, p)| p).collect()
}

/// The section of a method: equations, explanation, and results.
fn section(trial: &Trial) -> String {
    let lesson = lessons::lesson(trial.integrator);
    let [name, stable, mean, worst, drift, ns, longest, _] = row(trial).map(|c| escape(&c));
    format!(
        "<section id=\"{name}\"><h3>{}</h3>\n<pre>{}</pre>\n<p>{}</p>\n\
         <p><small>Here: stable: {stable}; stretch {mean} mean, {worst} maximum; energy of the swing {drift}; {ns} ns per point and \
         substep; longest stable step {longest}. Source: {}.</small></p></section>\n",
        lesson.title,
        escape(lesson.equations),
        lesson.text,
        escape(lesson.source),
    )
}
