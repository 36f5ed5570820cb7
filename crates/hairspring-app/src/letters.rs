//! Draws text on pictures that are written to files, in the window's font, but without a window.

use eframe::egui::{
    Color32, FontId,
    epaint::text::{FontDefinitions, Fonts, LayoutJob, TextOptions, TextWrapping},
};
use hairspring_view::Image;

/// Height of the text [pixels].
const HEIGHT: f32 = 15.0;
/// Color of the text.
const LIGHT: f32 = 225.0;

/// Draws text.
pub struct Letters(Fonts);

impl Default for Letters {
    fn default() -> Self {
        Self(Fonts::new(TextOptions::default(), FontDefinitions::default()))
    }
}

impl Letters {
    /// Draws a line of text with its upper left corner at `[x, y]`. Text wider than `width` [pixels] is cut
    /// off with an ellipsis.
    pub fn write(&mut self, image: &mut Image, [x, y]: [u32; 2], width: u32, text: &str) {
        let mut job = LayoutJob::simple_singleline(text.into(), FontId::proportional(HEIGHT), Color32::WHITE);
        job.wrap = TextWrapping::truncate_at_width(width as f32);
        let mut view = self.0.with_pixels_per_point(1.0);
        let line = view.layout_job(job);
        let atlas = view.image();
        let ink = |u: f32, v: f32| {
            let [columns, rows] = atlas.size;
            let at = (v as usize).min(rows - 1) * columns + (u as usize).min(columns - 1);
            f32::from(atlas.pixels[at].a()) / 255.0
        };
        for row in &line.rows {
            let visuals = &row.row.visuals;
            // A glyph has four corners; the first is the upper left, the last the lower right.
            for corners in visuals.mesh.vertices[visuals.glyph_vertex_range.clone()].chunks_exact(4) {
                let (from, to) = (corners[0], corners[3]);
                let size = to.pos - from.pos;
                for (i, j) in pixels(size.x, size.y) {
                    let part = |k: u32, all: f32| (k as f32 + 0.5) / all;
                    let uv =
                        from.uv + (to.uv - from.uv) * eframe::egui::vec2(part(i, size.x), part(j, size.y));
                    let place = from.pos + row.pos.to_vec2();
                    let (px, py) =
                        ((x as f32 + place.x).round() as u32 + i, (y as f32 + place.y).round() as u32 + j);
                    if px < image.width && py < image.height {
                        let at = (py as usize * image.width as usize + px as usize) * 3;
                        let share = ink(uv.x, uv.y);
                        for byte in &mut image.rgb[at..at + 3] {
                            *byte = (f32::from(*byte) + share * (LIGHT - f32::from(*byte))).round() as u8;
                        }
                    }
                }
            }
        }
    }
}

/// All columns and rows of an area of this size.
fn pixels(width: f32, height: f32) -> impl Iterator<Item = (u32, u32)> {
    let (columns, rows) = (width.round() as u32, height.round() as u32);
    (0..rows).flat_map(move |j| (0..columns).map(move |i| (i, j)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_light_on_dark_and_clipped_to_its_width() {
        let mut image = Image::new(200, 30);
        Letters::default().write(
            &mut image,
            [20, 5],
            100,
            "Integrator: backward-euler, and much more than fits",
        );
        let light = |x: u32| (0..30).any(|y| image.pixel(x, y)[0] > 150);
        assert!((20..50).any(light), "something is written");
        assert!((0..20).chain(121..200).all(|x| !light(x)), "and nothing beside it");
        let ink = image.rgb.iter().filter(|b| **b > 150).count() / 3;
        assert!((60..2000).contains(&ink), "{ink} pixels of letters");
    }
}
