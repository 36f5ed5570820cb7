//! A draggable wind rose, which shows the air from above.

use eframe::egui::{self, Color32, Pos2, Sense, Stroke, Ui, Vec2, vec2};

/// Radius of the rose [points].
const RADIUS: f32 = 34.0;

/// Shows the wind direction, with x to the right and z toward the viewer, and changes it by dragging. Returns
/// true if it changed. The length is the square root of the speed, so that both a breeze and a storm can be
/// set.
pub fn pad(ui: &mut Ui, wind: &mut [f32; 3], reach: f32) -> bool {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(2.0 * RADIUS), Sense::click_and_drag());
    let middle = rect.center();
    let mut changed = false;
    if let Some(at) = response.interact_pointer_pos()
        && (response.dragged() || response.clicked())
    {
        let way = (at - middle) / RADIUS;
        let length = way.length().min(1.0);
        // The center means calm. Otherwise it would be hard to set 0 by hand.
        let speed = if length < 0.12 { 0.0 } else { length * length * reach };
        let unit = if length > 0.0 { way.normalized() } else { Vec2::ZERO };
        (wind[0], wind[2]) = (unit.x * speed, unit.y * speed);
        changed = true;
    }
    let painter = ui.painter();
    let faint = ui.visuals().widgets.noninteractive.bg_stroke;
    painter.circle(middle, RADIUS, ui.visuals().extreme_bg_color, faint);
    painter.circle_stroke(middle, 0.5 * RADIUS, faint);
    let way = vec2(wind[0], wind[2]);
    let speed = way.length();
    if speed > 0.0 {
        let tip = middle + way / speed * (speed / reach).sqrt().min(1.0) * RADIUS;
        arrow(painter, middle, tip);
    }
    response
        .on_hover_text("Top view. Drag the arrow to set the wind's direction and speed. The head faces down. The center is still air.");
    changed
}

fn arrow(painter: &egui::Painter, from: Pos2, to: Pos2) {
    let stroke = Stroke::new(2.0, Color32::from_rgb(120, 200, 255));
    painter.line_segment([from, to], stroke);
    let way = (to - from).normalized() * 6.0;
    for turn in [2.5_f32, -2.5] {
        let (sin, cos) = turn.sin_cos();
        let side = vec2(way.x * cos - way.y * sin, way.x * sin + way.y * cos);
        painter.line_segment([to, to + side], stroke);
    }
}
