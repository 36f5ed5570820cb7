//! Draws coordinate frames as three short lines: red x, green y, blue z. There are frames of the head, of
//! roots (as the skin rotates them), and along the picked strand and the strand that it follows.
//!
//! Along a strand, green points to the next point. Red and blue are those of the root, carried from segment
//! to segment without twist (Bishop 1975, "There is more than one way to frame a curve": the
//! rotation-minimizing frame).
//!
//! # Limitations
//! The twist that the rod model solves for is not shown, because the library does not expose its frames.

use crate::{overlay::OverlayPainter, snapshot::StageSnapshot};
use eframe::egui::{Align2, Color32, FontId, Stroke, vec2};
use glam::{Mat3, Quat, Vec3};

/// Maximum number of roots whose frames are drawn. More would hide the hair.
const ROOTS: usize = 160;
/// Length of a root's axes [m].
const SHORT: f32 = 0.009;
/// Length of the head's axes [m].
const LONG: f32 = 0.15;
/// Colors of x, y and z.
const COLORS: [Color32; 3] =
    [Color32::from_rgb(255, 80, 70), Color32::from_rgb(110, 230, 90), Color32::from_rgb(100, 160, 255)];

/// Draws the frames. `picked` lists groom and index of strands whose frames are drawn along their whole
/// length.
pub fn draw(pen: &OverlayPainter, stage: &StageSnapshot, picked: &[[usize; 2]]) {
    let (m, at) = stage.anchor.matrix();
    frame(pen, at, m, LONG, 2.0);
    for (axis, name) in [(m.x_axis, "x"), (m.y_axis, "y"), (m.z_axis, "z")] {
        if let Some(tip) = pen.at(at + axis * LONG) {
            pen.painter.text(tip, Align2::LEFT_BOTTOM, name, FontId::proportional(13.0), Color32::WHITE);
        }
    }
    // All grooms use the same stride, so a groom of few hairs, such as brows, has few frames.
    let every = 1 + stage.still.counts[1] / ROOTS;
    for (g, (still, points)) in stage.still.grooms.iter().zip(stage.points()).enumerate() {
        for strand in (0..still.strand_count()).step_by(every) {
            if let Some(root) = points.get(still.strand(strand).start) {
                frame(pen, *root, stage.root_frame(g, strand), SHORT, 1.5);
            }
        }
    }
    for &[groom, strand] in picked {
        let Some((still, points)) = stage.still.grooms.get(groom).zip(stage.points().nth(groom)) else {
            continue;
        };
        if let Some(points) = points.get(still.strand(strand)) {
            along(pen, points, stage.root_frame(groom, strand));
        }
    }
    let legend = "red x, green y (along hair; out of the skin), blue z";
    let place = pen.rect.center_top() + vec2(0.0, 10.0);
    pen.painter.text(
        place,
        Align2::CENTER_TOP,
        legend,
        FontId::proportional(13.0),
        Color32::from_white_alpha(220),
    );
}

/// Draws three axes at a position.
fn frame(pen: &OverlayPainter, at: Vec3, axes: Mat3, length: f32, width: f32) {
    for (axis, color) in [axes.x_axis, axes.y_axis, axes.z_axis].into_iter().zip(COLORS) {
        pen.line(at, at + axis * length, Stroke::new(width, color));
    }
}

/// Draws the frames at the middles of a strand's segments, and the strand itself in white.
fn along(pen: &OverlayPainter, points: &[Vec3], root: Mat3) {
    for (pair, axes) in points.windows(2).zip(carried(points, root)) {
        pen.line(pair[0], pair[1], Stroke::new(1.0, Color32::WHITE));
        let length = 0.9 * pair[0].distance(pair[1]).clamp(0.004, 0.02);
        frame(pen, 0.5 * (pair[0] + pair[1]), axes, length, 2.0);
    }
}

/// The frame of each segment: y along it, x and z carried from the root by the smallest rotations.
fn carried(points: &[Vec3], root: Mat3) -> impl Iterator<Item = Mat3> {
    points.windows(2).scan(root, |frame, pair| {
        if let Some(way) = (pair[1] - pair[0]).try_normalize() {
            *frame =
                Mat3::from_quat(Quat::from_rotation_arc(frame.y_axis.normalize_or(Vec3::Y), way)) * *frame;
        }
        Some(*frame)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_lie_along_the_strand_and_do_not_twist() {
        // A quarter of a circle in the plane of x and y: z does not change.
        let on = |k: usize| {
            let (sin, cos) = (k as f32 / 16.0 * std::f32::consts::FRAC_PI_2).sin_cos();
            Vec3::new(1.0 - cos, sin, 0.0)
        };
        let points: Vec<Vec3> = (0..=16).map(on).collect();
        let frames: Vec<Mat3> = carried(&points, Mat3::IDENTITY).collect();
        assert_eq!(frames.len(), 16);
        for (pair, frame) in points.windows(2).zip(&frames) {
            assert!((pair[1] - pair[0]).normalize().distance(frame.y_axis) < 1e-5);
            assert!(frame.z_axis.distance(Vec3::Z) < 1e-5);
            assert!((frame.determinant() - 1.0).abs() < 1e-5);
        }
    }
}
