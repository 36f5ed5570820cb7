//! Overlays on the picture: outlines of colliders, a slice through the distance field, cells of the hair's
//! volume, roots, and handles. Coordinate frames are in `axes`.

use crate::{
    axes,
    handle::Handle,
    orbit::Lens,
    ramp,
    snapshot::StageSnapshot,
    view::{FINGERS, Tool, View},
};
use eframe::egui::{self, Color32, Pos2, Stroke};
use glam::{Mat3, Vec2, Vec3};
use hairspring::collide::{ColliderPose, ColliderShape};
use std::collections::HashMap;

/// Segments of a circle.
const PIECES: usize = 32;
/// Squares along a side of the slice.
const SQUARES: usize = 48;
/// Maximum number of cells of the volume that are drawn. More would hide everything.
const CELLS: usize = 6000;

/// Maximum number of triangles of a sheet that are drawn, and of dots on a body.
const TRIANGLES: usize = 3000;
/// See [`TRIANGLES`].
const DOTS: usize = 8000;

/// Draws lines in 3D.
pub struct OverlayPainter<'a> {
    /// The painter to draw on.
    pub painter: &'a egui::Painter,
    /// The lens of the picture.
    pub lens: Lens,
    /// Rectangle of the picture.
    pub rect: egui::Rect,
}

impl OverlayPainter<'_> {
    /// Screen position of a point; `None` behind the camera.
    pub fn at(&self, p: Vec3) -> Option<Pos2> {
        let (at, _) = self.lens.project(p)?;
        Some(self.place(at))
    }

    /// Screen position of a point of the picture.
    fn place(&self, at: Vec2) -> Pos2 {
        self.rect.min + egui::vec2(at.x * self.rect.width(), at.y * self.rect.height())
    }

    /// Draws a line in 3D.
    pub fn line(&self, a: Vec3, b: Vec3, stroke: Stroke) {
        if let (Some(a), Some(b)) = (self.at(a), self.at(b)) {
            self.painter.line_segment([a, b], stroke);
        }
    }

    /// Draws a circle in the plane of two axes.
    fn circle(&self, center: Vec3, x: Vec3, y: Vec3, stroke: Stroke) {
        let on = |k: usize| {
            let (sin, cos) = (k as f32 / PIECES as f32 * std::f32::consts::TAU).sin_cos();
            center + x * cos + y * sin
        };
        (0..PIECES).for_each(|k| self.line(on(k), on(k + 1), stroke));
    }

    /// Draws a sphere as three circles.
    fn ball(&self, center: Vec3, radius: f32, stroke: Stroke) {
        let [x, y, z] = [Vec3::X * radius, Vec3::Y * radius, Vec3::Z * radius];
        self.circle(center, x, y, stroke);
        self.circle(center, y, z, stroke);
        self.circle(center, z, x, stroke);
    }
}

/// Draws the enabled overlays over the picture at `rect`.
pub fn draw(
    pen: &OverlayPainter,
    stage: &StageSnapshot,
    view: &View,
    handles: &[Handle],
    picked: &[[usize; 2]],
) {
    let painter = pen.painter;
    let overlays = view.overlays;
    if overlays.slice {
        slice(pen, stage, view.slice);
    }
    if overlays.volume {
        volume(pen, stage);
    }
    if overlays.colliders {
        let stroke = Stroke::new(1.0, Color32::from_rgb(90, 200, 255));
        stage.colliders.iter().for_each(|o| collider(pen, stage, o, stroke));
    }
    if overlays.roots {
        for (groom, still) in stage.still.grooms.iter().enumerate() {
            for strand in (0..still.strand_count()).step_by(1 + still.strand_count() / 4000) {
                if let Some(at) = stage.root(groom, strand).and_then(|p| pen.at(p)) {
                    painter.circle_filled(at, 1.2, Color32::from_rgb(255, 200, 60));
                }
            }
        }
    }
    if overlays.frames {
        axes::draw(pen, stage, picked);
    }
    if let Some((center, radius)) = view.reached().filter(|_| view.tool == Tool::Grab) {
        pen.ball(center, radius, Stroke::new(1.5, Color32::from_white_alpha(170)));
    }
    if let Some((center, radius)) = view.reached().filter(|_| view.tool == Tool::Comb) {
        fingers(pen, center, radius, Stroke::new(2.0, Color32::from_white_alpha(170)));
    }
    if let Some((center, radius)) = view.reached().filter(|_| view.tool == Tool::Ball) {
        // A sphere behind hair or in the head stays visible.
        let [x, y] = [pen.lens.right(), pen.lens.up()].map(|axis| axis * radius);
        pen.circle(center, x, y, Stroke::new(1.0, Color32::from_white_alpha(90)));
    }
    for (k, handle) in handles.iter().enumerate() {
        handle_at(pen, handle, view.touched() == Some(k));
    }
}

/// Draws five fingers with their actual width and reach.
fn fingers(pen: &OverlayPainter, center: Vec3, radius: f32, stroke: Stroke) {
    let (right, down) = (pen.lens.right() * (FINGERS * radius), -pen.lens.up() * radius);
    pen.line(center - right, center + right, stroke);
    for k in -2..=2 {
        let at = center + right * (k as f32 / 2.0);
        pen.line(at, at + down, stroke);
    }
}

/// Draws a handle, and its name if the pointer is on it.
fn handle_at(pen: &OverlayPainter, handle: &Handle, touched: bool) {
    let color = if touched { Color32::from_rgb(255, 210, 90) } else { Color32::from_rgb(120, 200, 255) };
    let Some(at) = pen.at(handle.at) else { return };
    if let Some(from) = handle.arrow() {
        if handle.is_wind() {
            rose(pen, from, handle.at, color);
        }
        if let Some(from) = pen.at(from).filter(|from| from.distance(at) > 1.0) {
            let way = (at - from).normalized() * 9.0;
            let side = way.rot90() * 0.5;
            pen.painter.line_segment([from, at], Stroke::new(2.0, color));
            pen.painter.line_segment([at, at - way + side], Stroke::new(2.0, color));
            pen.painter.line_segment([at, at - way - side], Stroke::new(2.0, color));
        }
    }
    if let Some(middle) = handle.rim() {
        let radius = middle.distance(handle.at);
        // Untouched handles are faint, so that they do not distract from the hair.
        pen.ball(middle, radius, Stroke::new(1.0, color.gamma_multiply(if touched { 0.8 } else { 0.2 })));
    }
    let radius = if touched { 6.0 } else { 4.0 };
    pen.painter.circle(
        at,
        radius,
        color.gamma_multiply(0.6),
        Stroke::new(1.0, Color32::from_black_alpha(160)),
    );
    if touched || handle.is_wind() {
        let place = if touched { at } else { pen.at(handle.arrow().unwrap_or(handle.at)).unwrap_or(at) };
        let (font, white) = (egui::FontId::proportional(13.0), Color32::from_white_alpha(220));
        let name = pen.painter.layout_no_wrap(handle.name.clone(), font, white);
        let mut place = egui::Align2::CENTER_TOP.anchor_size(place + egui::vec2(0.0, 14.0), name.size()).min;
        // A name near the edge of the picture stays on it.
        place.x = place.x.min(pen.rect.right() - name.size().x).max(pen.rect.left());
        let shade = Color32::from_black_alpha(170);
        pen.painter.galley_with_override_text_color(place + egui::vec2(1.0, 1.0), name.clone(), shade);
        pen.painter.galley(place, name, white);
    }
}

/// Draws a level ring around the wind arrow's base, and the height of its tip, so that the arrow's direction
/// in 3D can be seen.
fn rose(pen: &OverlayPainter, from: Vec3, tip: Vec3, color: Color32) {
    let thin = Stroke::new(1.0, color.gamma_multiply(0.5));
    let radius = 0.09 / pen.lens.scale(pen.lens.depth(from), 1.0);
    pen.circle(from, Vec3::X * radius, Vec3::Z * radius, thin);
    let level = Vec3::new(tip.x, from.y, tip.z);
    pen.line(from, level, thin);
    pen.line(level, tip, thin);
}

/// Draws the outline of a collider.
fn collider(
    pen: &OverlayPainter,
    stage: &StageSnapshot,
    collider: &hairspring::collide::MovingCollider,
    stroke: Stroke,
) {
    let pose = collider.end;
    let (m, _) = pose.matrix();
    let turned = |axes: Mat3| m * axes;
    match &collider.shape {
        ColliderShape::Sphere { center, radius } => pen.ball(pose.transform_point(*center), *radius, stroke),
        ColliderShape::Capsule { a, b, radius } => {
            let (a, b) = (pose.transform_point(*a), pose.transform_point(*b));
            let axis = (b - a).normalize_or(Vec3::Y);
            let x = axis.any_orthonormal_vector() * *radius;
            let y = axis.cross(x);
            pen.circle(a, x, y, stroke);
            pen.circle(b, x, y, stroke);
            for side in [x, y, -x, -y] {
                pen.line(a + side, b + side, stroke);
            }
        }
        ColliderShape::Cuboid { center, half, axes } => {
            let axes = turned(*axes);
            let corner = |k: usize| {
                let sign = |bit: usize| if k & bit > 0 { 1.0 } else { -1.0 };
                pose.transform_point(*center) + axes * (*half * Vec3::new(sign(1), sign(2), sign(4)))
            };
            for k in 0..8 {
                for bit in [1, 2, 4] {
                    if k & bit == 0 {
                        pen.line(corner(k), corner(k | bit), stroke);
                    }
                }
            }
        }
        ColliderShape::Plane { point, normal } => {
            let normal = m * *normal;
            let x = normal.any_orthonormal_vector();
            let (at, y) = (pose.transform_point(*point), normal.cross(x));
            for k in -5..=5 {
                let step = k as f32 * 0.1;
                pen.line(at + x * step - y * 0.5, at + x * step + y * 0.5, stroke);
                pen.line(at + y * step - x * 0.5, at + y * step + x * 0.5, stroke);
            }
        }
        ColliderShape::Hull(hull) => {
            hull.triangles().for_each(|t| triangle(pen, t.map(|p| pose.transform_point(p)), stroke))
        }
        ColliderShape::Sheet(sheet) => {
            let all = sheet.triangles();
            let some = all.iter().step_by(1 + all.len() / TRIANGLES);
            some.for_each(|t| triangle(pen, t.map(|p| pose.transform_point(p)), stroke));
        }
        ColliderShape::Custom(custom) => {
            let (center, radius) = custom.bounds();
            pen.ball(pose.transform_point(center), radius, stroke);
        }
        ColliderShape::Field(_) => skin(pen, stage, stroke.color),
        // A shape that a later version of the library adds.
        _ => {}
    }
}

fn triangle(pen: &OverlayPainter, [a, b, c]: [Vec3; 3], stroke: Stroke) {
    [(a, b), (b, c), (c, a)].into_iter().for_each(|(a, b)| pen.line(a, b, stroke));
}

/// Draws the visible side of the body as dots. The resolution of its field is similar to that of its mesh.
fn skin(pen: &OverlayPainter, stage: &StageSnapshot, color: Color32) {
    let vertices = stage.positions.iter().zip(&stage.normals);
    for (p, n) in vertices.step_by(1 + stage.positions.len() / DOTS) {
        if let Some(at) = pen.at(*p).filter(|_| n.dot(pen.lens.eye() - *p) > 0.0) {
            pen.painter.circle_filled(at, 1.0, color.gamma_multiply(0.7));
        }
    }
}

/// Draws a horizontal slice through the distance to all colliders: blue inside, white at the surface, red up
/// to 5 cm outside.
fn slice(pen: &OverlayPainter, stage: &StageSnapshot, height: f32) {
    let Some((low, high)) = stage.bounds() else { return };
    let poses: Vec<ColliderPose> = stage
        .colliders
        .iter()
        .map(|o| ColliderPose::new(o.shape.clone(), o.end.matrix(), o.end.matrix(), 1.0))
        .collect();
    if poses.is_empty() {
        return;
    }
    let y = low.y + (high.y - low.y) * height;
    let on = |i: usize, k: usize| {
        let part = |i: usize| i as f32 / SQUARES as f32;
        Vec3::new(low.x + (high.x - low.x) * part(i), y, low.z + (high.z - low.z) * part(k))
    };
    let mut mesh = egui::Mesh::default();
    for i in 0..=SQUARES {
        for k in 0..=SQUARES {
            let p = on(i, k);
            let distance = poses.iter().map(|o| o.distance(p)).fold(f32::MAX, f32::min);
            let color = if distance.abs() < 1e-3 {
                Color32::from_white_alpha(220)
            } else if distance < 0.0 {
                Color32::from_rgba_unmultiplied(40, 90, 255, 150)
            } else {
                let share = (1.0 - distance / 0.05).clamp(0.0, 1.0);
                Color32::from_rgba_unmultiplied(255, 70, 40, (130.0 * share) as u8)
            };
            mesh.colored_vertex(pen.at(p).unwrap_or(pen.rect.min), color);
        }
    }
    let index = |i: usize, k: usize| (i * (SQUARES + 1) + k) as u32;
    for i in 0..SQUARES {
        for k in 0..SQUARES {
            mesh.add_triangle(index(i, k), index(i + 1, k), index(i, k + 1));
            mesh.add_triangle(index(i + 1, k), index(i + 1, k + 1), index(i, k + 1));
        }
    }
    pen.painter.add(mesh);
}

/// Draws the grid cells of the volume that contain hair, in warmer colors the fuller they are.
fn volume(pen: &OverlayPainter, stage: &StageSnapshot) {
    let cell = stage.volume.map_or(0.015, |v| v.cell);
    let anchor = stage.anchor;
    let mut cells: HashMap<[i32; 3], u32> = HashMap::new();
    for p in stage.points().flatten().filter(|p| p.is_finite()) {
        let own = (anchor.inverse_transform_point(*p) / cell).floor();
        *cells.entry([own.x as i32, own.y as i32, own.z as i32]).or_default() += 1;
    }
    let most = cells.values().copied().max().unwrap_or(1) as f32;
    let mut places: Vec<_> = cells.into_iter().collect();
    places.sort_unstable();
    for (place, count) in places.iter().step_by(1 + places.len() / CELLS) {
        let middle = (Vec3::from(place.map(|c| c as f32)) + 0.5) * cell;
        let Some((at, depth)) = pen.lens.project(anchor.transform_point(middle)) else { continue };
        let side = (0.4 * cell * pen.lens.scale(depth, pen.rect.height())).max(1.0);
        let c = ramp::color((*count as f32 / most).sqrt(), [0.0, 1.0]);
        let byte = |x: f32| (x.powf(1.0 / 2.2) * 255.0) as u8;
        let color = Color32::from_rgba_unmultiplied(byte(c.x), byte(c.y), byte(c.z), 60);
        let square = egui::Rect::from_center_size(pen.place(at), egui::Vec2::splat(2.0 * side));
        pen.painter.rect_filled(square, 0.0, color);
    }
}
