//! Draws a stage: camera, lights and renderer.

use crate::{fault::Fault, frames, moment::Moment};
use clap::Args;
use glam::{Quat, Vec3};
use hairspring_scene::{
    Background, Camera, Picture,
    stage::{Stage, Subject, SubjectPath},
};
use hairspring_view::{
    Frame, Ground, HairDraw, Image, Layers, Lighting, LinearImage, MeshDraw, Quality, Renderer, Timings,
    frame_camera,
    gpu::{Gpu, GpuRenderer},
};
use std::{borrow::Cow, time::Instant};

/// Size, camera and renderer of pictures.
#[derive(Args, Default)]
pub struct View {
    /// Width and height of the picture [pixels], each 1 to 16384; of a clip, 16x16 to 3840x2160, and even
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = frames::size)]
    pub size: (u32, u32),

    /// Camera position [m] [default: from the scene, otherwise one that shows all hair]
    #[arg(long, value_name = "X,Y,Z", value_parser = frames::point, allow_hyphen_values = true)]
    pub camera: Option<Vec3>,

    /// Point that the camera looks at [m]
    #[arg(long, value_name = "X,Y,Z", value_parser = frames::point, allow_hyphen_values = true)]
    pub target: Option<Vec3>,

    /// Whether the camera moves along with hair that travels: yes or no [default: from the scene; yes for a camera that
    /// is not given, if the hair would be small otherwise]
    #[arg(long, value_name = "YES|NO", value_parser = frames::yes_or_no)]
    pub follow: Option<bool>,

    /// Vertical field of view [degrees], a whole number from 1 to 170 [default: from the scene, otherwise 30]
    #[arg(long, value_name = "DEGREES", value_parser = clap::value_parser!(u8).range(1..=170))]
    pub fov: Option<u8>,

    /// What is behind body and hair: backdrop, transparent (with an alpha channel, for PNG and EXR), or
    /// automatic, which is transparent for EXR [default: from the scene, otherwise automatic]
    #[arg(long, value_name = "WHAT", value_parser = frames::background)]
    pub background: Option<Background>,

    /// Angle by which the lights are turned about the vertical axis [degrees], counterclockwise as seen from
    /// above [default: from the scene, otherwise 0]
    #[arg(long, value_name = "DEGREES", value_parser = frames::light_angle, allow_hyphen_values = true)]
    pub light_angle: Option<f32>,

    /// Motion blur: how long the shutter is open, of the 360 degrees of a frame; 180 is that of a film camera
    /// [default: from the scene, otherwise 0]
    #[arg(long, value_name = "DEGREES", value_parser = frames::shutter)]
    pub shutter: Option<f32>,

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

/// What the files of a run can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Colors: clips and JPEG.
    Opaque,
    /// Colors and alpha: PNG.
    Alpha,
    /// Linear light, alpha, depth and motion: EXR.
    Layers,
}

/// A picture of one frame.
pub enum Drawn<'a> {
    /// 8 bits.
    Image(&'a Image),
    /// For EXR.
    Layers(Box<Layers>),
}

/// A camera, its lights and a renderer.
pub struct Studio {
    painter: Painter,
    /// The camera at the start.
    start: Camera,
    /// Current rotation of the camera about its target, in full turns; see [`Studio::turn`].
    turned: f32,
    /// Path of a camera that follows the hair; empty for other cameras.
    path: SubjectPath,
    width_scale: f32,
    picture: Picture,
    format: Format,
    /// The last frame, if motion is shown.
    last: Option<Moment>,
    /// The last picture that was developed from linear light.
    image: Image,
}

/// Settings of a studio.
#[derive(Clone, Copy)]
pub struct Setup {
    /// Whether [`Studio::turn`] will turn the camera.
    pub turned: bool,
    /// What the files can hold.
    pub format: Format,
}

impl Setup {
    /// A still camera, and files without alpha.
    pub const PLAIN: Self = Self { turned: false, format: Format::Opaque };
}

impl Studio {
    /// Sets up for the current state of the stage. If the GPU draws and supports it, the GPU also
    /// interpolates the follow hairs.
    pub fn new(view: &View, stage: &mut Stage, setup: Setup) -> Result<Self, Fault> {
        let (width, height) = view.size;
        let own = stage.scene().camera;
        let follows = view.follow.or(own.map(|camera| camera.follow));
        let needed = own.is_none() || follows == Some(true);
        let subject = needed.then(|| stage.subject()).flatten();
        let travels = subject.as_ref().is_some_and(Subject::travels);
        let placed = view.camera.is_some() || view.target.is_some();
        let follow = follows.unwrap_or(travels && !placed);
        let aspect = width as f32 / height as f32;
        let mut camera = own.unwrap_or_else(|| overview(subject.as_ref(), aspect, (setup.turned, follow)));
        camera.position = view.camera.unwrap_or(camera.position);
        camera.target = view.target.unwrap_or(camera.target);
        camera.fov = view.fov.map_or(camera.fov, f32::from);
        if camera.position.distance(camera.target) < 1e-3 {
            let text = "the camera is at its target; move --camera or --target".into();
            return Err(Fault::Usage(text));
        }
        let mut picture = stage.scene().picture;
        picture.background = view.background.unwrap_or(picture.background);
        picture.light_angle = view.light_angle.unwrap_or(picture.light_angle);
        picture.shutter = view.shutter.unwrap_or(picture.shutter);
        let strands = stage.simulated_strands().1 as f32;
        let width_scale = view.hair_width.unwrap_or((HEAD / strands).clamp(1.0, WIDEST));
        let mut studio = Self {
            painter: Painter::Cpu(Box::new(Renderer::new(width, height))),
            start: camera,
            turned: 0.0,
            path: subject.filter(|_| follow).map(|subject| subject.path).unwrap_or_default(),
            width_scale,
            picture,
            format: setup.format,
            last: None,
            image: Image::default(),
        };
        if view.gpu {
            if studio.is_linear() {
                let text = "--gpu cannot draw motion blur, a transparent background or EXR files; draw this without --gpu";
                return Err(Fault::Usage(text.into()));
            }
            let card = Card::new(view.size)?;
            stage.set_external_interpolation(card.renderer.gpu().can_place_among(stage.colliders()));
            studio.painter = Painter::Gpu(Box::new(card));
        }
        Ok(studio)
    }

    /// Whether nothing is behind body and hair.
    fn transparent(&self) -> bool {
        match self.picture.background {
            Background::Backdrop => false,
            Background::Automatic => self.format == Format::Layers,
            Background::Transparent => self.format != Format::Opaque,
        }
    }

    /// Whether pictures are drawn in linear light first.
    fn is_linear(&self) -> bool {
        self.transparent() || self.format == Format::Layers || self.picture.shutter > 0.0
    }

    /// Whether the scene asks for a transparent background, and the files cannot hold one.
    pub fn lacks_alpha(&self) -> bool {
        self.picture.background == Background::Transparent && self.format == Format::Opaque
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
        (self.start, self.turned, self.width_scale) = (other.start, other.turned, other.width_scale);
        self.path.clone_from(&other.path);
    }

    /// Rotates the camera around the vertical axis through its target. `share` is a fraction of a full turn
    /// from the initial position, counterclockwise as seen from above.
    pub fn turn(&mut self, share: f32) {
        self.turned = share;
    }

    /// The camera for the current state of the stage.
    fn camera(&self, stage: &Stage) -> Camera {
        let turn = Quat::from_rotation_y(self.turned * std::f32::consts::TAU);
        let back = turn * (self.start.position - self.start.target);
        let target = self.start.target + self.path.offset(stage.time());
        Camera { position: target + back, target, ..self.start }
    }

    /// Draws the current state of the stage.
    pub fn draw(&mut self, stage: &Stage) -> Result<(Drawn<'_>, Timings), Fault> {
        let camera = self.camera(stage);
        let current: Vec<HairDraw> =
            stage.strands().map(|s| HairDraw { width_scale: self.width_scale, ..HairDraw::of(s) }).collect();
        let body = stage.body().map(MeshDraw::of);
        let (picture, format, transparent) = (self.picture, self.format, self.transparent());
        let linear = self.is_linear();
        let now = Frame {
            hair: &current,
            bodies: body.as_slice(),
            camera,
            lighting: Lighting::of(&picture, &camera),
            background: hairspring_view::Background::of(&picture),
            ground: Ground::of(stage.scene()),
            quality: Quality::default(),
        };
        let (mut timings, mut layers) = (Timings::default(), None);
        match &mut self.painter {
            Painter::Gpu(card) => timings = card.draw(&now)?,
            Painter::Cpu(renderer) if !linear => {
                renderer.draw(&now);
                timings = renderer.timings();
            }
            Painter::Cpu(renderer) => {
                let last = self.last.as_ref().filter(|_| !stage.cut());
                // A plain backdrop is put behind the developed picture.
                let plain = now.background.plain().filter(|_| !transparent && format != Format::Layers);
                let transparent = transparent || plain.is_some();
                let color = match last.filter(|_| picture.shutter > 0.0) {
                    Some(last) => blurred(renderer, &now, last, &picture, transparent, &mut timings),
                    None => renderer.draw_linear(&now, transparent),
                };
                timings = sum(timings, renderer.timings());
                if format == Format::Layers {
                    let none = Moment { camera, ..Moment::default() };
                    let geometry = last.unwrap_or(&none).geometry(renderer, &now);
                    timings = sum(timings, renderer.timings());
                    layers = Some(Box::new(Layers { color, geometry }));
                } else {
                    self.image = match plain {
                        Some(plain) => color.develop_on(plain),
                        None => color.develop(),
                    };
                }
            }
        }
        self.pass(stage);
        let drawn = match (layers, &self.painter) {
            (Some(layers), _) => Drawn::Layers(layers),
            (None, Painter::Gpu(card)) => Drawn::Image(&card.image),
            (None, Painter::Cpu(renderer)) if !linear => Drawn::Image(renderer.image()),
            (None, Painter::Cpu(_)) => Drawn::Image(&self.image),
        };
        Ok((drawn, timings))
    }

    /// Passes over a frame that is not drawn: the motion of the next one begins here.
    pub fn pass(&mut self, stage: &Stage) {
        if self.format == Format::Layers || self.picture.shutter > 0.0 {
            let camera = self.camera(stage);
            self.last.get_or_insert_default().fill(stage, camera);
        }
    }
}

impl Drawn<'_> {
    /// The picture as it is shown.
    pub fn image(&self) -> Cow<'_, Image> {
        match self {
            Self::Image(image) => Cow::Borrowed(image),
            Self::Layers(layers) => Cow::Owned(layers.color.develop()),
        }
    }
}

/// Draws the mean of several moments from `last` to `now`. Adds the time of all but the last of them.
fn blurred(
    renderer: &mut Renderer,
    now: &Frame,
    last: &Moment,
    picture: &Picture,
    transparent: bool,
    timings: &mut Timings,
) -> LinearImage {
    let mut color = LinearImage::default();
    for k in 0..picture.shutter_samples {
        if k > 0 {
            *timings = sum(*timings, renderer.timings());
        }
        let weight = 1.0 / picture.shutter_samples as f32;
        let before = picture.shutter / 360.0 * (k as f32 + 0.5) * weight;
        let moment = last.toward(now, 1.0 - before);
        let hair: Vec<HairDraw> = moment.hair(now.hair).collect();
        let body = now.bodies.first().map(|body| moment.body(*body));
        let (camera, bodies) = (moment.camera, body.as_slice());
        let lighting = Lighting::of(picture, &camera);
        let frame = Frame { hair: &hair, bodies, camera, lighting, ..*now };
        color.add(&renderer.draw_linear(&frame, transparent), weight);
    }
    color
}

fn sum(a: Timings, b: Timings) -> Timings {
    Timings { shadow: a.shadow + b.shadow, strands: a.strands + b.strands, tiles: a.tiles + b.tiles }
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
    fn draw(&mut self, frame: &Frame) -> Result<Timings, Fault> {
        let start = Instant::now();
        self.renderer.draw(frame, self.size.0, self.size.1);
        let recorded = start.elapsed();
        self.image = self.renderer.read()?;
        let timings = Timings { strands: recorded, tiles: start.elapsed() - recorded, ..Timings::default() };
        Ok(timings)
    }
}

/// A camera that shows the subject over its whole motion: from all sides if it will be turned, and along its path if it
/// follows.
fn overview(subject: Option<&Subject>, aspect: f32, (turned, follow): (bool, bool)) -> Camera {
    let bounds = subject.map(|subject| if follow { subject.moving_bounds } else { subject.bounds });
    let (mut low, mut high) = bounds.unwrap_or((Vec3::NEG_ONE, Vec3::ONE));
    if turned {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let reach = half.x.hypot(half.z);
        let half = Vec3::new(reach, half.y, reach);
        (low, high) = (middle - half, middle + half);
    }
    frame_camera((low, high), aspect)
}
