//! Draws one picture from borrowed arrays to pixels.

use crate::{
    body::Bodies,
    camera::View,
    frame::{Before, Frame, HairDraw},
    ground::Floor,
    hair::{
        color::{self, Colors},
        order::Order,
        ribbon::{Chunk, Setup},
        segment::Dot,
        shade::{self, LANES, Shader},
        wisp::Wisp,
    },
    image::Image,
    linear::{GeometryImage, LinearImage},
    pass::{Geometry, Linear, Pass, Screen},
    shadow::{self, Shadow},
    tile::{Brush, PIXELS, SIDE, Strands, Tiles},
    tonemap::Encoder,
    work::Work,
};
use fearless_simd::Level;
use rayon::prelude::*;
use std::{
    ops::Add,
    time::{Duration, Instant},
};

/// Draws frames of one size. Memory is kept between frames.
#[derive(Default)]
pub struct Renderer {
    image: Image,
    tiles: Tiles,
    order: Order,
    shadow: Shadow,
    bodies: Bodies,
    chunks: Vec<Chunk>,
    dots: Vec<Dot>,
    colors: Colors,
    drawn: Vec<[[u8; 3]; PIXELS]>,
    encoder: Encoder,
    timings: Timings,
    work: Work,
}

/// Which shadows a frame needs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shadows {
    /// Those of hair and bodies.
    All,
    /// Those of bodies; that of the hair is kept from the previous frame.
    Bodies,
    /// None are used.
    Kept,
}

/// Time of the last frame, by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Timings {
    /// Density grid, sweeps, depth map.
    pub shadow: Duration,
    /// Projection and sorting of strands, and projection of bodies.
    pub strands: Duration,
    /// Sorting, lighting, blending, bodies and tone mapping of all tiles.
    pub tiles: Duration,
}

impl Renderer {
    /// Creates a renderer for `width` × `height` pixels, each clamped to 1 to 16,384.
    pub fn new(width: u32, height: u32) -> Self {
        let (width, height) = (width.clamp(1, 16_384), height.clamp(1, 16_384));
        let tiles = Tiles::new(width as usize, height as usize);
        Self { image: Image::new(width, height), tiles, ..Self::default() }
    }

    /// Draws a frame. The same frame gives the same bytes on any number of threads.
    pub fn draw(&mut self, frame: &Frame) -> &Image {
        self.draw_screen(frame, Shadows::All)
    }

    /// Like [`Renderer::draw`], but with the hair shadow of the previous frame. It is meant for fast previews
    /// of moving hair; the hair shadow is a fifteenth of the work. The shadow lags by one frame and uses that
    /// frame's lamps, which is not visible, because the shadow is soft. Shadows of bodies are up to date: a
    /// lag would be visible as spots on them.
    pub fn draw_on(&mut self, frame: &Frame) -> &Image {
        self.draw_screen(frame, Shadows::Bodies)
    }

    /// Draws a frame in linear light. If `transparent`, nothing is behind hair and bodies: the backdrop is
    /// left out, and the ground holds only its shadow and color.
    pub fn draw_linear(&mut self, frame: &Frame, transparent: bool) -> LinearImage {
        let Image { width, height, .. } = self.image;
        let rgba = self.draw_pixels(&Linear { transparent }, frame, Shadows::All);
        LinearImage { width, height, rgba }
    }

    /// Draws the depth of a frame, and its motion since an earlier one. Where strands or surfaces share a
    /// pixel, both are averages, weighted by coverage. The ground and the backdrop have none.
    pub fn draw_geometry(&mut self, frame: &Frame, before: &Before) -> GeometryImage {
        let view = View::new(&before.camera, self.image.width, self.image.height);
        GeometryImage::new(&self.draw_pixels(&Geometry { before, view }, frame, Shadows::Kept))
    }

    fn draw_pixels<P: Pass>(&mut self, pass: &P, frame: &Frame, shadows: Shadows) -> Vec<P::Pixel> {
        let mut tiles = Vec::new();
        self.draw_tiles(pass, frame, shadows, &mut tiles);
        let [width, height] = self.tiles.size();
        let mut pixels = vec![P::Pixel::default(); width * height];
        copy_rows(self.tiles, &tiles, &mut pixels);
        pixels
    }

    fn draw_screen(&mut self, frame: &Frame, shadows: Shadows) -> &Image {
        let encoder = std::mem::take(&mut self.encoder);
        let mut tiles = std::mem::take(&mut self.drawn);
        let screen = Screen { encoder: &encoder, plain: frame.background.plain() };
        self.draw_tiles(&screen, frame, shadows, &mut tiles);
        copy_rows(self.tiles, &tiles, self.image.rgb.as_chunks_mut().0);
        (self.encoder, self.drawn) = (encoder, tiles);
        &self.image
    }

    fn draw_tiles<P: Pass>(
        &mut self,
        pass: &P,
        frame: &Frame,
        shadows: Shadows,
        drawn: &mut Vec<[P::Pixel; PIXELS]>,
    ) {
        let start = Instant::now();
        let [width, height] = self.tiles.size();
        let view = View::new(&frame.camera, width as u32, height as u32);
        let bounds = shadow::bounds(&frame.hair.iter().map(|h| h.points).collect::<Vec<_>>());
        self.order.fill(frame, bounds.unwrap_or_default());
        match shadows {
            Shadows::Kept => {}
            Shadows::Bodies if !self.shadow.is_empty() => self.shadow.fill_bodies(frame),
            Shadows::Bodies | Shadows::All => self.shadow.fill(frame, bounds, &self.order),
        }
        let shaded = Instant::now();

        // The view depths of the hair's box are the range of the sort keys.
        let (low, high) = bounds.unwrap_or_default();
        let middle = (0.5 * (low + high) - view.eye).dot(view.forward);
        let reach = 0.5 * (high - low).dot(view.forward.abs()) + 1e-3;
        let floor = Floor::new(frame, &view, bounds);
        let setup = Setup {
            frame,
            view,
            tiles: self.tiles,
            order: &self.order,
            shadow: &self.shadow,
            level: Level::new(),
            shader: Shader::new(&frame.lighting, view.eye),
            wisp: Wisp::new(frame.quality.wisp),
            pigments: frame.hair.iter().map(|h| color::ends(h.look).map(shade::pigment)).collect(),
            depths: [(middle - reach).max(0.0), middle.max(0.0) + reach],
            floor,
        };
        let low = setup.low();
        let runs = &self.order.runs;
        self.chunks.resize_with(runs.len(), Chunk::default);
        self.dots.resize(self.order.slots(), Dot::END);
        self.colors.clear(self.order.slots());
        let dots = self.order.split(&mut self.dots);
        let (chunks, bodies) = (&mut self.chunks, &mut self.bodies);
        rayon::join(
            || {
                chunks
                    .par_iter_mut()
                    .zip(runs)
                    .zip(dots)
                    .with_max_len(1)
                    .for_each(|((chunk, run), dots)| chunk.fill(&setup, run, dots))
            },
            || bodies.project(frame, &view, [width, height], low),
        );
        let cut = Instant::now();

        drawn.resize(self.tiles.count(), [P::Pixel::default(); PIXELS]);
        let strands = Strands {
            chunks,
            dots: &self.dots,
            colors: &self.colors,
            reach: chunks.iter().fold(0.0, |far, chunk| chunk.reach.max(far)),
            widest: chunks.iter().fold(0.0, |most, chunk| chunk.widest.max(most)),
        };
        let bodies = &*bodies;
        let work = drawn.par_iter_mut().enumerate().map_init(Brush::default, |brush, (tile, out)| {
            brush.draw(pass, &setup, bodies, &strands, tile, out)
        });
        self.work = Work {
            segments: frame.hair.iter().map(HairDraw::segment_count).sum(),
            pixels: (width * height) as u64,
            ..work.reduce(Work::default, Work::add)
        };
        self.work.lit = self.colors.lit() * LANES as u64;
        self.timings = Timings { shadow: shaded - start, strands: cut - shaded, tiles: cut.elapsed() };
    }

    /// The last picture; black before the first.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// Time of the last frame, by stage.
    pub fn timings(&self) -> Timings {
        self.timings
    }

    /// Work of the last frame.
    pub fn work(&self) -> Work {
        self.work
    }
}

/// Copies the pixels of tiles to a picture, row by row.
fn copy_rows<T: Copy + Send + Sync>(tiles: Tiles, drawn: &[[T; PIXELS]], picture: &mut [T]) {
    let ([width, _], [nx, _]) = (tiles.size(), tiles.grid());
    picture.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (x, out) in row.chunks_mut(SIDE).enumerate() {
            out.copy_from_slice(&drawn[y / SIDE * nx + x][y % SIDE * SIDE..][..out.len()]);
        }
    });
}
