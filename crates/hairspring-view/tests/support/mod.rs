//! A generated head of hair for tests and benches: a ball with a scalp, and strands that fall from it.
#![allow(dead_code)] // Each test file uses a part of this module.

use glam::{Vec2, Vec3};
use hairspring::{body::Mesh, groom::Groom};
use hairspring_scene::{Camera, HairLook};
use hairspring_view::{
    Background, Frame, HairDraw, Lighting, MeshDraw, Quality,
    gpu::{Gpu, GpuError, GpuRenderer},
};

/// Radius of the ball [m].
pub const RADIUS: f32 = 0.095;

/// A hair style.
#[derive(Clone, Copy)]
pub struct Style {
    pub strands: usize,
    pub points: usize,
    /// Length [m].
    pub length: f32,
    /// Amplitude of waves [m].
    pub wave: f32,
    /// Approximate spacing of locks [m]; strands with roots in the same cell share a lock.
    pub lock: f32,
}

pub const STRAIGHT: Style = Style { strands: 100_000, points: 32, length: 0.28, wave: 0.0, lock: 0.010 };
pub const WAVY: Style = Style { strands: 100_000, points: 32, length: 0.30, wave: 0.006, lock: 0.014 };

/// Evenly spread numbers in 0..1 (Roberts 2018, the R2 sequence).
fn spread(i: usize) -> Vec2 {
    let i = i as f64;
    Vec2::new((0.5 + i * 0.7548776662466927).fract() as f32, (0.5 + i * 0.5698402909980532).fract() as f32)
}

fn hash(i: u32, j: u32) -> f32 {
    let mut h = i.wrapping_mul(0x9e3779b9) ^ j.wrapping_mul(0x85ebca6b);
    h = (h ^ h >> 15).wrapping_mul(0x2c1b3c6d);
    h = (h ^ h >> 12).wrapping_mul(0x297a2d39);
    ((h ^ h >> 15) >> 8) as f32 / (1 << 24) as f32
}

/// Smooth noise from −1 to 1.
fn noise(p: Vec3, seed: u32) -> f32 {
    let cell = p.floor();
    let f = p - cell;
    let f = f * f * (Vec3::splat(3.0) - 2.0 * f);
    let at = |dx: i32, dy: i32, dz: i32| {
        let [x, y, z] = [cell.x as i32 + dx, cell.y as i32 + dy, cell.z as i32 + dz];
        hash(
            (x as u32).wrapping_mul(73856093)
                ^ (y as u32).wrapping_mul(19349663)
                ^ (z as u32).wrapping_mul(83492791),
            seed,
        ) * 2.0
            - 1.0
    };
    let line = |dy, dz| at(0, dy, dz) + (at(1, dy, dz) - at(0, dy, dz)) * f.x;
    let face = |dz| line(0, dz) + (line(1, dz) - line(0, dz)) * f.y;
    face(0) + (face(1) - face(0)) * f.z
}

/// Hair parted along the middle that falls around a ball at the origin. The face looks along +Z.
pub fn groom(style: Style) -> Groom {
    let strands = (0..).map(spread).enumerate().filter_map(|(i, uv)| {
        let y = 1.0 - 1.35 * uv.y;
        let azimuth = std::f32::consts::TAU * uv.x;
        let r = (1.0 - y * y).max(0.0).sqrt();
        let n = Vec3::new(r * azimuth.sin(), y, r * azimuth.cos());
        // The hairline: higher in front.
        let line = -0.25 + 0.75 * ((n.z + 0.1).max(0.0) / r.max(0.05)).min(1.0).powf(1.5);
        (n.y > line).then(|| strand(style, i as u32, n))
    });
    Groom::from_strands(strands.take(style.strands), 36e-6)
}

fn strand(style: Style, i: u32, n: Vec3) -> Vec<Vec3> {
    let root = n * RADIUS;
    let lock = (root / style.lock).round() * style.lock;
    let side = if n.x >= 0.0 { 1.0 } else { -1.0 };
    let length = style.length * (0.85 + 0.12 * noise(lock * 40.0, 1) + 0.12 * hash(i, 2));
    let step = length / (style.points - 1) as f32;
    // Combed away from the parting, then down.
    let lift = 0.006 + 0.010 * hash(i, 3) + 0.004 * noise(lock * 60.0, 4);
    let mut direction = (n * 0.5 + Vec3::new(side * 0.8, 0.15, -0.35)).normalize();
    let mut p = root;
    let phase = 6.0 * noise(lock * 50.0, 5) + 0.5 * hash(i, 6);
    let mut points = Vec::with_capacity(style.points);
    for k in 0..style.points {
        let s = k as f32 / (style.points - 1) as f32;
        let turn = phase + s * length / 0.055 * std::f32::consts::TAU;
        let swing = style.wave * s.min(0.4) * 2.5;
        let flyaway = 0.004 * s * s * (hash(i, 7) - 0.5);
        let out = Vec3::new(p.x, 0.0, p.z).normalize_or_zero();
        let across = Vec3::Y.cross(out);
        let clump = (lock - root) * s * 0.5;
        points.push(
            p + across * (swing * turn.sin() + flyaway)
                + out * (swing * 0.7 * turn.cos() + flyaway)
                + clump * Vec3::new(1.0, 0.3, 1.0),
        );
        direction = (direction
            + Vec3::new(0.0, -0.22, 0.0)
            + 0.02 * Vec3::new(noise(p * 30.0, 8), 0.0, noise(p * 30.0, 9)))
        .normalize();
        p += direction * step;
        // Strands lie on the ball in layers; below it, they hang as from its rim.
        let clear = RADIUS + lift * (s * 6.0).min(1.0);
        let from = if p.y > 0.0 { p } else { Vec3::new(p.x, 0.0, p.z) };
        let far = from.length();
        if far < clear {
            p += from / far.max(1e-6) * (clear - far);
            direction = (points.last().map_or(direction, |last| p - *last)).normalize_or(direction);
        }
    }
    points
}

/// The ball, slightly narrower than the scalp on which hair grows.
pub fn ball() -> Mesh {
    let (rows, columns) = (48, 96);
    let mut mesh = Mesh::default();
    for j in 0..=rows {
        for i in 0..=columns {
            let (a, b) = (
                j as f32 / rows as f32 * std::f32::consts::PI,
                i as f32 / columns as f32 * std::f32::consts::TAU,
            );
            let n = Vec3::new(a.sin() * b.sin(), a.cos(), a.sin() * b.cos());
            mesh.positions.push(n * RADIUS * Vec3::new(0.93, 1.0, 0.98));
            mesh.normals.push(n);
            if j < rows && i < columns {
                let at = (j * (columns + 1) + i) as u32;
                let below = at + columns as u32 + 1;
                mesh.triangles.push([at, below, at + 1]);
                mesh.triangles.push([at + 1, below, below + 1]);
            }
        }
    }
    mesh
}

/// The groom as a draw call.
pub fn hair<'a>(groom: &'a Groom, look: &'a HairLook) -> HairDraw<'a> {
    HairDraw {
        points: &groom.points,
        offsets: &groom.offsets,
        radii: &groom.radii,
        colors: &groom.colors,
        look,
        width_scale: 1.0,
        follow: None,
    }
}

/// A draw call without strands.
pub fn no_hair(look: &HairLook) -> HairDraw<'_> {
    HairDraw { points: &[], offsets: &[], radii: &[], colors: &[], look, width_scale: 1.0, follow: None }
}

/// A look with values that are not numbers.
pub fn broken_look() -> HairLook {
    HairLook { root_color: Vec3::NAN, roughness: f32::NAN, ..HairLook::default() }
}

/// Draw calls whose arrays have different lengths and whose offsets are invalid.
pub fn broken_hair(look: &HairLook) -> [HairDraw<'_>; 2] {
    const POINTS: [Vec3; 3] = [Vec3::ZERO, Vec3::new(0.0, 0.1, 0.0), Vec3::new(0.0, 0.2, 0.0)];
    let short = HairDraw {
        points: &POINTS,
        offsets: &[0, 3, 900, 2, u32::MAX],
        radii: &[1e-3; 2],
        colors: &[Vec3::NAN],
        ..no_hair(look)
    };
    let wide = HairDraw {
        points: &POINTS,
        offsets: &[0, 3],
        radii: &[1e-3; 3],
        width_scale: f32::INFINITY,
        ..no_hair(look)
    };
    [short, wide]
}

/// A mesh with a non-finite vertex, too few normals and invalid triangles.
pub const BROKEN_BODY: MeshDraw<'static> = MeshDraw {
    positions: &[Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NAN],
    normals: &[Vec3::Z],
    triangles: &[[0, 1, 2], [0, 1, 3], [0, 1, 77], [1, 1, 1]],
    parts: &[],
};

/// A mesh without triangles.
pub const NO_BODY: MeshDraw<'static> = MeshDraw { positions: &[], normals: &[], triangles: &[], parts: &[] };

/// A valid camera and invalid ones.
pub fn broken_cameras() -> [Camera; 4] {
    [
        Camera::default(),
        Camera { position: Vec3::ZERO, target: Vec3::ZERO, fov: f32::NAN, ..Camera::default() },
        Camera { position: Vec3::NAN, target: Vec3::INFINITY, fov: -3.0, ..Camera::default() },
        Camera { position: Vec3::Y * 0.1001, target: Vec3::ZERO, fov: 170.0, ..Camera::default() },
    ]
}

/// Qualities out of range.
pub const BROKEN_QUALITY: Quality =
    Quality { shadow_voxels: 0, shadow_texels: 0, smoothness: f32::NAN, wisp: u32::MAX };

/// Makes some points of a groom of 12 points a strand non-finite or very large, and some radii invalid.
pub fn break_points(groom: &mut Groom) {
    for (i, value) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30].into_iter().enumerate() {
        groom.points[12 * 100 * (i + 1) + i] = Vec3::new(value, 0.1, value);
    }
    groom.radii[7] = f32::NAN;
    groom.radii[80] = -1.0;
}

/// The mesh as a draw call.
pub fn body(mesh: &Mesh) -> MeshDraw<'_> {
    MeshDraw {
        positions: &mesh.positions,
        normals: &mesh.normals,
        triangles: &mesh.triangles,
        parts: &mesh.parts,
    }
}

/// A portrait of the ball.
pub fn camera() -> Camera {
    Camera {
        position: Vec3::new(0.38, 0.02, 0.95),
        target: Vec3::new(0.0, -0.06, 0.0),
        fov: 26.0,
        ..Camera::default()
    }
}

/// A frame with default settings.
pub fn frame<'a>(hair: &'a [HairDraw<'a>], bodies: &'a [MeshDraw<'a>]) -> Frame<'a> {
    Frame {
        hair,
        bodies,
        camera: camera(),
        lighting: Lighting::default(),
        background: Background::default(),
        ground: None,
        quality: Quality::default(),
    }
}

/// A renderer on the graphics card, or `None` where there is none.
pub fn card() -> Option<GpuRenderer> {
    match Gpu::open() {
        Ok(gpu) => Some(GpuRenderer::new(&gpu)),
        Err(error @ GpuError::Missing(_)) => {
            eprintln!("skipped: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}
