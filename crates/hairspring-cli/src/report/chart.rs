//! A plot as SVG: lines and points, two axes and a legend.

use super::{escape, number};
use hairspring_validate::Axis;
use std::fmt::Write;

/// Size of the picture and of the frame in it.
const WIDTH: f64 = 660.0;
const HEIGHT: f64 = 380.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = 46.0;

/// One color per quantity; the palette is safe for color-blind readers (Okabe & Ito 2008).
const COLORS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#222222"];

/// One quantity of a plot.
pub struct Series<'a> {
    /// Its name in the legend.
    pub name: &'a str,
    /// Drawn as a line, from left to right.
    pub line: &'a [[f64; 2]],
    /// Drawn as points.
    pub points: &'a [[f64; 2]],
}

/// An axis with its range and ticks.
struct Scale {
    low: f64,
    high: f64,
    log: bool,
    ticks: Vec<f64>,
}

impl Scale {
    /// Creates an axis for the shown values. There may be none.
    fn new(axis: &Axis, values: impl Iterator<Item = f64>, from_zero: bool) -> Self {
        let shown = values.filter(|v| v.is_finite() && (!axis.log || *v > 0.0));
        let (mut low, mut high) =
            shown.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            (low, high) = (1.0, 2.0);
        }
        if axis.log {
            let ticks = decades(low, high);
            return Self { low, high: high.max(low * 1.001), log: true, ticks };
        }
        if from_zero && low > 0.0 && low < 0.5 * high {
            low = 0.0;
        }
        if high - low < 1e-12 * high.abs().max(1e-12) {
            (low, high) = (low - 0.5, high + 0.5);
        }
        let margin = if from_zero { 0.04 * (high - low) } else { 0.0 };
        let (low, high) = (if low == 0.0 { 0.0 } else { low - margin }, high + margin);
        // Tick distance: 1, 2 or 5 times a power of ten, about six ticks in total.
        let rough = (high - low) / 6.0;
        let power = 10f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= rough).unwrap_or(rough);
        let first = (low / step).ceil() as i64;
        let last = (high / step + 1e-9).floor() as i64;
        let ticks = (first..=last).map(|k| k as f64 * step).collect();
        Self { low, high, log: false, ticks }
    }

    /// Relative position of a value on the axis, 0 to 1.
    fn at(&self, value: f64) -> f64 {
        let t = if self.log {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        t.clamp(-0.02, 1.02)
    }
}

/// Ticks of a logarithmic axis: powers of ten, and 2 and 5 times them if there are few.
fn decades(low: f64, high: f64) -> Vec<f64> {
    let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let few = high / low < 1e3;
    let marks: &[f64] = if few { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let all = powers.flat_map(|p| marks.iter().map(move |m| m * 10f64.powi(p)));
    all.filter(|t| (low * 0.999..=high * 1.001).contains(t)).collect()
}

/// Returns the plot as an SVG element with its legend, which ends with `note`.
pub fn svg([x_axis, y_axis]: [&Axis; 2], series: &[Series], note: &str) -> String {
    let all = || series.iter().flat_map(|s| s.line.iter().chain(s.points));
    let x = Scale::new(x_axis, all().map(|p| p[0]), false);
    let y = Scale::new(y_axis, all().map(|p| p[1]), true);
    let across = |v: f64| LEFT + (WIDTH - LEFT - RIGHT) * x.at(v);
    let up = |v: f64| HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * y.at(v);
    let (bottom, right) = (HEIGHT - BOTTOM, WIDTH - RIGHT);

    let mut s = format!(r#"<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img">"#);
    // Writing to a String does not fail.
    let mut put = |text: std::fmt::Arguments| {
        let _ = s.write_fmt(text);
    };
    for &tick in &x.ticks {
        let at = across(tick);
        put(format_args!(
            r#"<path class="grid" d="M{at:.1} {TOP}V{bottom}"/><text x="{at:.1}" y="{:.1}" text-anchor="middle">{}</text>"#,
            bottom + 16.0,
            number(tick)
        ));
    }
    for &tick in &y.ticks {
        let at = up(tick);
        put(format_args!(
            r#"<path class="grid" d="M{LEFT} {at:.1}H{right}"/><text x="{:.1}" y="{:.1}" text-anchor="end">{}</text>"#,
            LEFT - 7.0,
            at + 4.0,
            number(tick)
        ));
    }
    put(format_args!(r#"<path class="axis" d="M{LEFT} {TOP}V{bottom}H{right}"/>"#));
    put(format_args!(
        r#"<text x="{:.1}" y="{:.1}" text-anchor="middle">{}</text>"#,
        0.5 * (LEFT + right),
        HEIGHT - 8.0,
        escape(&x_axis.label)
    ));
    let middle = 0.5 * (TOP + bottom);
    put(format_args!(
        r#"<text transform="translate(14 {middle:.1}) rotate(-90)" text-anchor="middle">{}</text>"#,
        escape(&y_axis.label)
    ));
    for (k, curve) in series.iter().enumerate() {
        let color = COLORS[k % COLORS.len()];
        let line: Vec<String> =
            curve.line.iter().map(|p| format!("{:.1},{:.1}", across(p[0]), up(p[1]))).collect();
        put(format_args!(r#"<polyline class="curve" stroke="{color}" points="{}"/>"#, line.join(" ")));
        for p in curve.points {
            put(format_args!(
                r#"<circle cx="{:.1}" cy="{:.1}" r="4" fill="{color}"><title>{}: {} at {}</title></circle>"#,
                across(p[0]),
                up(p[1]),
                escape(curve.name),
                number(p[1]),
                number(p[0])
            ));
        }
    }
    s.push_str("</svg>");
    s + &legend(series, note)
}

/// Legend: what the line and points of each color are.
fn legend(series: &[Series], note: &str) -> String {
    let entry = |(k, series): (usize, &Series)| {
        let color = COLORS[k % COLORS.len()];
        let point = match series.points {
            [] => String::new(),
            _ => format!(r#"<circle cx="14" cy="5" r="4" fill="{color}"/>"#),
        };
        format!(
            r#"<span><svg class="key" viewBox="0 0 28 10"><path class="curve" stroke="{color}" d="M0 5H28"/>{point}</svg>{}</span>"#,
            escape(series.name)
        )
    };
    let entries: String = series.iter().enumerate().map(entry).collect();
    format!(r#"<p class="legend">{entries} <small>{}</small></p>"#, escape(note))
}
