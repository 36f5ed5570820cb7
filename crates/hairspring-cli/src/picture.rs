//! Draws a stage: camera, lights and renderer.

use crate::{fault::Fault, frames};
use clap::Args;
use glam::{Quat, Vec3};
use hairspring_scene::{Camera, stage::Stage};
use hairspring_view::{
    Background, Frame, Ground, HairDraw, Image, Lighting, MeshDraw, Quality, Renderer, Timings, frame_camera,
    gpu::{Gpu, GpuRenderer},
};
use std::time::Instant;

/// Size, camera and renderer of pictures.
#[derive(Args)]
pub struct View {
    /// Width and height of the picture [pixels]
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = frames::size)]
    pub size: (u32, u32),

    /// Camera position [m] [default: from the scene, otherwise one that shows all hair]
    #[arg(long, value_name = "X,Y,Z", value_parser = frames::point, allow_hyphen_values = true)]
    pub camera: Option<Vec3>,

    /// Point that the camera looks at [m]
    #[arg(long, value_name = "X,Y,Z", value_parser = frames::point, allow_hyphen_values = true)]
    pub target: Option<Vec3>,

    /// Vertical field of view [degrees], 1 to 170
    #[arg(long, value_name = "DEGREES", value_parser = clap::value_parser!(u8).range(1..=170))]
    pub fov: Option<u8>,

    /// Factor for the width of drawn hairs [default: 1 for 100,000 hairs and more, up to 10 for fewer]
    #[arg(long, value_name = "FACTOR", value_parser = frames::positive)]
    pub hair_width: Option<f32>,

    /// Draw on the GPU [default: on the CPU, whose picture is the reference]
    #[arg(long)]
    pub gpu: bool,
}

/// Number of hairs on a human head.
const HEAD: f32 = 100_000.0;

/// Largest default factor for the width of a hair: 0.7 mm, a thin lock.
const WIDEST: f32 = 10.0;

/// The renderer.
enum Painter {
    Cpu(Box<Renderer>),
    Gpu(Box<Card>),
}

/// A GPU renderer, and the last picture that was read back from it.
struct Card {
    renderer: GpuRenderer,
    size: (u32, u32),
    image: Image,
}

/// A camera, its lights and a renderer.
pub struct Studio {
    painter: Painter,
    /// The initial camera and the current camera.
    start: Camera,
    camera: Camera,
    width_scale: f32,
}

impl Studio {
    /// Sets up for the current state of the stage. If the GPU draws and supports it, the GPU also
    /// interpolates the follow hairs.
    pub fn new(view: &View, stage: &mut Stage) -> Result<Self, Fault> {
        let (width, height) = view.size;
        let mut camera =
            stage.scene().camera.unwrap_or_else(|| overview(stage, width as f32 / height as f32));
        camera.position = view.camera.unwrap_or(camera.position);
        camera.target = view.target.unwrap_or(camera.target);
        camera.fov = view.fov.map_or(camera.fov, f32::from);
        if camera.position.distance(camera.target) < 1e-3 {
            let text = "the camera is at its target; move --camera or --target".into();
            return Err(Fault::Usage(text));
        }
        let strands = stage.simulated_strands().1 as f32;
        let width_scale = view.hair_width.unwrap_or((HEAD / strands).clamp(1.0, WIDEST));
        let painter = match view.gpu {
            false => Painter::Cpu(Box::new(Renderer::new(width, height))),
            true => {
                let card = Card::new(view.size)?;
                stage.set_external_interpolation(card.renderer.gpu().can_place_among(stage.obstacles()));
                Painter::Gpu(Box::new(card))
            }
        };
        Ok(Self { painter, start: camera, camera, width_scale })
    }

    /// Name of the GPU that draws, if one does.
    pub fn card(&self) -> Option<&str> {
        match &self.painter {
            Painter::Cpu(_) => None,
            Painter::Gpu(card) => Some(card.renderer.gpu().name()),
        }
    }

    /// Bytes that were sent to the GPU for the last picture.
    pub fn sent(&self) -> u64 {
        match &self.painter {
            Painter::Cpu(_) => 0,
            Painter::Gpu(card) => card.renderer.timings().bytes,
        }
    }

    /// Factor for the width of drawn hairs.
    pub fn width_scale(&self) -> f32 {
        self.width_scale
    }

    /// Takes over the camera and the width of hairs of `other`.
    pub fn look_like(&mut self, other: &Self) {
        (self.start, self.camera, self.width_scale) = (other.start, other.camera, other.width_scale);
    }

    /// Rotates the camera around the vertical axis through its target. `share` is a fraction of a full turn
    /// from the initial position, counterclockwise as seen from above.
    pub fn turn(&mut self, share: f32) {
        let turn = Quat::from_rotation_y(share * std::f32::consts::TAU);
        let back = self.start.position - self.start.target;
        self.camera.position = self.start.target + turn * back;
    }

    /// Draws the current state of the stage.
    pub fn draw(&mut self, stage: &Stage) -> Result<(&Image, Timings), Fault> {
        let hair: Vec<HairDraw> =
            stage.strands().map(|s| HairDraw { width_scale: self.width_scale, ..HairDraw::of(s) }).collect();
        let body = stage.body().map(MeshDraw::of);
        let frame = Frame {
            hair: &hair,
            bodies: body.as_slice(),
            camera: self.camera,
            lighting: Lighting::facing(&self.camera),
            background: Background::default(),
            ground: Ground::of(stage.scene()),
            quality: Quality::default(),
        };
        match &mut self.painter {
            Painter::Cpu(renderer) => {
                renderer.draw(&frame);
                Ok((renderer.image(), renderer.timings()))
            }
            Painter::Gpu(card) => card.draw(&frame),
        }
    }
}

impl Card {
    fn new(size: (u32, u32)) -> Result<Self, Fault> {
        let gpu = Gpu::open()?;
        let most = gpu.most_pixels();
        if size.0.max(size.1) > most {
            let text = format!(
                "a picture of {}x{} is too large for the GPU, which supports {most} pixels per side; draw it without --gpu",
                size.0, size.1
            );
            return Err(Fault::Usage(text));
        }
        Ok(Self { renderer: GpuRenderer::new(&gpu), size, image: Image::default() })
    }

    /// Uploads and command recording count as work on strands; everything that the GPU does afterwards counts
    /// as work on tiles.
    fn draw(&mut self, frame: &Frame) -> Result<(&Image, Timings), Fault> {
        let start = Instant::now();
        self.renderer.draw(frame, self.size.0, self.size.1);
        let recorded = start.elapsed();
        self.image = self.renderer.read()?;
        let timings = Timings { strands: recorded, tiles: start.elapsed() - recorded, ..Timings::default() };
        Ok((&self.image, timings))
    }
}

/// A camera that sees all hair, with a margin for motion.
fn overview(stage: &Stage, aspect: f32) -> Camera {
    let bounds = stage.strands().flat_map(|s| s.points.iter().copied()).fold(None, |b, p| {
        let (low, high): (Vec3, Vec3) = b.unwrap_or((p, p));
        Some((low.min(p), high.max(p)))
    });
    let (low, high) = bounds.unwrap_or((Vec3::NEG_ONE, Vec3::ONE));
    let room = Vec3::splat(0.06 * (high - low).length());
    frame_camera((low - room, high + room), aspect)
}
