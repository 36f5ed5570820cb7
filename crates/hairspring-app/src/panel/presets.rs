//! Preset scenes with thumbnails.

use crate::{document::builtin_text, session::Action};
use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions, Ui, vec2};
use hairspring_scene::stage::Stage;
use hairspring_view::{Background, Frame, Ground, HairDraw, Lighting, MeshDraw, Quality, Renderer};
use std::sync::mpsc::{Receiver, channel};

/// Size of a thumbnail [pixels].
const SIZE: [u32; 2] = [132, 132];
/// Number of hairs in a thumbnail.
const HAIRS: u32 = 3000;

/// The presets: label, style, and additional text; `{}` is replaced by the numbers of hairs.
pub(super) const PRESETS: [(&str, &str, &str); 8] = [
    ("Straight", "straight", ""),
    ("Wavy", "wavy", ""),
    ("Curly", "curly", ""),
    ("Coily", "coily", ""),
    ("Short fur", "short-fur", ""),
    (
        "In the wind",
        "straight",
        "\n[wind]\nvelocity = [3.0, 0.0, -1.0]\ngust = 0.6\ngust_rate = 0.7\n\n[turbulence]\nstrength = 0.8\n",
    ),
    ("Full and firm", "wavy", "\n[volume]\nmethod = \"incompressible\"\n"),
    (
        "On end",
        "straight",
        "material = \"charged\"\nmotion = false\n\n[material.charged]\npreset = \"straight\"\ncharge = 3e-10\n\n[[charged]]\ncenter = [0.0, 0.03, -0.01]\nradius = 0.09\ncharge = 1e-6\nsolid = false\n",
    ),
];

/// The text of a preset.
pub(super) fn text(k: usize, hairs: u32, guides: u32) -> String {
    let (name, style, more) = PRESETS[k];
    let text = builtin_text(style, Some((hairs, guides))).replace("Built-in head", name);
    format!("{text}{more}")
}

/// Shows the presets. Their thumbnails are drawn on a thread when the panel is first shown.
#[derive(Default)]
pub struct Presets {
    pictures: Vec<Option<TextureHandle>>,
    drawn: Option<Receiver<(usize, hairspring_view::Image)>>,
}

impl Presets {
    /// Shows the presets. `hairs` is the number of hairs that this machine draws well, and the number of
    /// guides.
    pub fn show(
        &mut self,
        ctx: &egui::Context,
        open: &mut bool,
        hairs: (u32, u32),
        actions: &mut Vec<Action>,
    ) {
        if !*open {
            return;
        }
        if self.pictures.is_empty() {
            self.pictures.resize(PRESETS.len(), None);
            self.drawn = Some(draw(ctx));
        }
        while let Some((k, image)) = self.drawn.as_ref().and_then(|d| d.try_recv().ok()) {
            let image = ColorImage::from_rgb([image.width as usize, image.height as usize], &image.rgb);
            self.pictures[k] = Some(ctx.load_texture(PRESETS[k].0, image, TextureOptions::LINEAR));
        }
        let mut chosen = None;
        egui::Window::new("Presets").open(open).collapsible(false).resizable(false).show(ctx, |ui| {
            egui::Grid::new("presets").num_columns(4).show(ui, |ui| {
                for (k, (name, ..)) in PRESETS.iter().enumerate() {
                    ui.vertical_centered(|ui| {
                        if picture(ui, self.pictures[k].as_ref(), name) {
                            chosen = Some(k);
                        }
                    });
                    if k % 4 == 3 {
                        ui.end_row();
                    }
                }
            });
            ui.weak("Each takes the place of the scene, which Undo brings back.");
        });
        if let Some(k) = chosen {
            actions.push(Action::New(text(k, hairs.0, hairs.1)));
            *open = false;
        }
    }
}

fn picture(ui: &mut Ui, texture: Option<&TextureHandle>, name: &str) -> bool {
    let size = vec2(SIZE[0] as f32, SIZE[1] as f32) * 0.8;
    let pressed = match texture {
        Some(texture) => ui.add(egui::Button::image((texture.id(), size))).clicked(),
        None => ui.add_sized(size, egui::Spinner::new()).clicked(),
    };
    ui.button(name).clicked() || pressed
}

/// Draws all thumbnails one after the other on a thread.
fn draw(ctx: &egui::Context) -> Receiver<(usize, hairspring_view::Image)> {
    let (send, receive) = channel();
    let ctx = ctx.clone();
    std::thread::spawn(move || {
        let mut renderer = Renderer::new(SIZE[0], SIZE[1]);
        for (k, (_, _, more)) in PRESETS.iter().enumerate() {
            let scene = hairspring_io::read_scene_text("scene.toml".as_ref(), &text(k, HAIRS, 300));
            let Some(mut stage) = scene.ok().and_then(|s| Stage::new(s.value).ok()) else { continue };
            // Presets with motion are simulated for a moment.
            if more.contains("wind") || more.contains("charge") {
                for _ in 0..45 {
                    stage.step(crate::player::STEP);
                }
            }
            if send.send((k, still(&stage, &mut renderer))).is_err() {
                return;
            }
            ctx.request_repaint();
        }
    });
    receive
}

fn still(stage: &Stage, renderer: &mut Renderer) -> hairspring_view::Image {
    let hair: Vec<HairDraw> =
        stage.strands().map(|s| HairDraw { width_scale: 8.0, ..HairDraw::of(s) }).collect();
    let body = stage.body().map(MeshDraw::of);
    let camera = stage.scene().camera.unwrap_or_default();
    let frame = Frame {
        hair: &hair,
        bodies: body.as_slice(),
        camera,
        lighting: Lighting::of(&stage.scene().picture, &camera),
        background: Background::of(&stage.scene().picture),
        ground: Ground::of(stage.scene()),
        quality: Quality { shadow_voxels: 48, ..Quality::default() },
    };
    renderer.draw(&frame).clone()
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_preset_can_be_read() {
        for k in 0..super::PRESETS.len() {
            let text = super::text(k, 50, 20);
            let scene = hairspring_io::read_scene_text("scene.toml".as_ref(), &text);
            assert!(scene.is_ok(), "{}: {:?}", super::PRESETS[k].0, scene.err());
        }
    }
}
