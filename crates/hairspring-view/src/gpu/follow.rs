//! Interpolates follow hairs on the GPU from the transforms of their guides: `wgsl/follow.wgsl`.
//!
//! Sent once: points of the rest pose with their guide coordinates (24 bytes per point), and weights (64
//! bytes per strand). Sent every frame: 48 bytes per guide point, 112 per collider, and the changed parts of
//! distance fields.

use super::{
    Gpu,
    constants::FOLLOW,
    memory::{Bound, Generation, Store, groups},
    renderer::Job,
    strands::fitting,
};
use crate::frame::HairDraw;
use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Vec3, Vec4};
use hairspring::{
    collide::{ColliderShape, MovingCollider},
    follow::{FollowLayout, HairInterpolation},
    settings::Effects,
};
use rayon::prelude::*;
use std::sync::Arc;
use wgpu::BufferUsages;

/// Values of `kind` of the shader's colliders.
pub(super) const CAPSULE: u32 = 0;
pub(super) const CUBOID: u32 = 1;
pub(super) const PLANES: u32 = 2;
pub(super) const FIELD: u32 = 3;

/// Number of shape values that are compared, and sent, together.
const BLOCK: usize = 1 << 14;

/// Bit in a strand's point count that marks a guide.
const GUIDE: u32 = 1 << 31;

/// Maximum displacement of a point by curls and by flyaways, relative to the curl radius and to the flyaway
/// amplitude: the diameter of the circle, and two perpendicular waves.
const SWAY: [f32; 2] = [2.0, std::f32::consts::SQRT_2];

/// `Groom` of the shader.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Settings {
    strands: u32,
    first: u32,
    colliders: u32,
    clump: f32,
    curl_radius: f32,
    curl_rate: f32,
    noise: f32,
    unused: u32,
}

/// `Follower` of the shader.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Follower {
    first: u32,
    count: u32,
    guides: [u32; 3],
    lasts: [u32; 3],
    weights: [f32; 3],
    phases: [f32; 5],
}

/// `Collider` of the shader.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Collider {
    axes: [Vec4; 3],
    a: Vec4,
    b: Vec4,
    size: [u32; 3],
    first: u32,
    kind: u32,
    unused: [u32; 3],
}

/// The follow hairs of one style.
struct Groom {
    layout: Arc<FollowLayout>,
    followers: Store,
    rest: Store,
    rides: Store,
    guides: Store,
    carriers: Store,
    settings: Store,
    bound: Bound,
    /// Bounding box, for every guide point, of the points that it transforms, relative to the guide point in
    /// the rest pose [m].
    boxes: Vec<(Vec3, Vec3)>,
    /// Corners of boxes that contain all points of the style in the current frame [m].
    corners: Vec<Vec3>,
    /// Index of the world with this groom's colliders.
    world: usize,
}

/// The colliders of some of the grooms.
struct World {
    colliders: Store,
    shapes: Store,
    /// The shape values that the GPU has.
    sent: Vec<f32>,
}

/// All follow hairs of a frame.
pub(super) struct Followers {
    pipeline: wgpu::ComputePipeline,
    /// One entry per style; `None` if its points are sent directly.
    grooms: Vec<Option<Groom>>,
    worlds: Vec<World>,
}

impl Gpu {
    /// Whether the GPU can interpolate follow hairs among these colliders. It does not support open sheets,
    /// or distance fields that are too large for it.
    pub fn can_place_among(&self, colliders: &[MovingCollider]) -> bool {
        let numbers: usize = colliders.iter().map(|o| Shape::of(o).map_or(0, |s| s.numbers.len())).sum();
        let of_cpu =
            |o: &MovingCollider| matches!(o.shape, ColliderShape::Sheet(_) | ColliderShape::Custom(_));
        !colliders.iter().any(of_cpu)
            && numbers as u64 * 4 <= self.device.limits().max_storage_buffer_binding_size
    }
}

/// A collider and the values of its shape.
struct Shape<'a> {
    collider: Collider,
    numbers: std::borrow::Cow<'a, [f32]>,
}

impl<'a> Shape<'a> {
    /// `None` if the GPU has no code for the shape.
    fn of(collider: &'a MovingCollider) -> Option<Self> {
        let (turn, at) = collider.end.matrix();
        let placed = |turn: Mat3, at: Vec3, kind: u32| {
            let [x, y, z] = [turn.x_axis.extend(at.x), turn.y_axis.extend(at.y), turn.z_axis.extend(at.z)];
            let (a, b) = (Vec4::ZERO, Vec4::ZERO);
            Collider { axes: [x, y, z], a, b, size: [0; 3], first: 0, kind, unused: [0; 3] }
        };
        let capsule = |a: Vec3, b: Vec3, radius: f32| Collider {
            a: a.extend(radius),
            b: b.extend(0.0),
            ..placed(turn, at, CAPSULE)
        };
        let planes = |planes: Vec<Vec4>| Self {
            collider: Collider { size: [planes.len() as u32, 0, 0], ..placed(turn, at, PLANES) },
            numbers: planes.iter().flat_map(Vec4::to_array).collect(),
        };
        let alone = |collider| Self { collider, numbers: Default::default() };
        Some(match &collider.shape {
            ColliderShape::Sphere { center, radius } => alone(capsule(*center, *center, *radius)),
            ColliderShape::Capsule { a, b, radius } => alone(capsule(*a, *b, *radius)),
            ColliderShape::Cuboid { center, half, axes } => {
                // In its own space the box is aligned to the axes.
                let placed = placed(turn * *axes, turn * *center + at, CUBOID);
                alone(Collider { a: half.extend(0.0), ..placed })
            }
            ColliderShape::Plane { point, normal } => planes(vec![normal.extend(normal.dot(*point))]),
            ColliderShape::Hull(hull) => planes(hull.planes().map(|(n, offset)| n.extend(offset)).collect()),
            ColliderShape::Field(grid) if !grid.distances().is_empty() => Self {
                collider: Collider {
                    a: grid.origin().extend(grid.cell()),
                    size: grid.size().to_array(),
                    ..placed(turn, at, FIELD)
                },
                numbers: grid.distances().into(),
            },
            // Empty fields, thin shells and custom shapes.
            _ => return None,
        })
    }
}

impl World {
    fn new(gpu: &Gpu) -> Self {
        let store = |label| Store::new(gpu, label, BufferUsages::STORAGE);
        Self { colliders: store("colliders"), shapes: store("shapes"), sent: Vec::new() }
    }

    /// Sends the colliders, and the changed parts of their shapes. Returns the number of colliders.
    fn send(&mut self, gpu: &Gpu, colliders: &[MovingCollider], generation: &mut Generation) -> u32 {
        let mut shapes: Vec<Shape> = colliders.iter().filter_map(Shape::of).collect();
        let mut first = 0;
        for shape in &mut shapes {
            shape.collider.first = first as u32;
            first += shape.numbers.len();
        }
        let then = *generation;
        self.shapes.fit(gpu, 4 * first, generation);
        if *generation != then {
            self.sent.clear();
        }
        // NaN is not equal to any number, so these values are sent.
        self.sent.resize(first, f32::NAN);
        for shape in &shapes {
            let first = shape.collider.first as usize;
            let there = self.sent[first..][..shape.numbers.len()].chunks_mut(BLOCK);
            for (k, (there, now)) in there.zip(shape.numbers.chunks(BLOCK)).enumerate() {
                if there != now {
                    self.shapes.write(gpu, 4 * (first + k * BLOCK), now);
                    there.copy_from_slice(now);
                }
            }
        }
        let colliders: Vec<Collider> = shapes.iter().map(|s| s.collider).collect();
        self.colliders.fill(gpu, &colliders, generation);
        colliders.len() as u32
    }
}

impl Groom {
    fn new(gpu: &Gpu, layout: &Arc<FollowLayout>, generation: &mut Generation) -> Self {
        let store = |label| Store::new(gpu, label, BufferUsages::STORAGE);
        let mut groom = Self {
            layout: layout.clone(),
            followers: store("followers"),
            rest: store("rest"),
            rides: store("rides"),
            guides: store("guides"),
            carriers: store("carriers"),
            settings: Store::new(gpu, "follow", BufferUsages::UNIFORM),
            bound: Bound::default(),
            boxes: boxes(layout),
            corners: Vec::new(),
            world: 0,
        };
        let strands = 0..layout.groom.strand_count();
        let followers: Vec<Follower> = strands.into_par_iter().map(|s| follower(layout, s)).collect();
        groom.followers.fill(gpu, &followers, generation);
        groom.rest.fill(gpu, &layout.groom.points, generation);
        let word = |(ride, clearance): (&[u16; 3], &f32)| {
            [u32::from(ride[0]) | u32::from(ride[1]) << 16, u32::from(ride[2]), clearance.to_bits()]
        };
        let rides: Vec<[u32; 3]> =
            layout.guide_coordinates.par_iter().zip(&layout.clearance).map(word).collect();
        groom.rides.fill(gpu, &rides, generation);
        let guides: Vec<Vec3> =
            layout.guides.iter().flat_map(|g| layout.groom.strand(*g as usize)).copied().collect();
        groom.guides.fill(gpu, &guides, generation);
        groom
    }

    /// Sends the transforms of the guides, and computes the bounding boxes of the points that they transform.
    fn send(
        &mut self,
        gpu: &Gpu,
        now: &HairInterpolation,
        [first, colliders]: [u32; 2],
        generation: &mut Generation,
    ) {
        let carried = |(carrier, at): (&glam::Affine3A, &Vec3)| {
            let m = Mat3::from(carrier.matrix3);
            [m.x_axis.extend(at.x), m.y_axis.extend(at.y), m.z_axis.extend(at.z)]
        };
        let places = || now.guide_transforms.iter().zip(now.guide_points);
        let carriers: Vec<[Vec4; 3]> = places().map(carried).collect();
        self.carriers.fill(gpu, &carriers, generation);
        let Effects { clump, curl_radius, curl_length, noise } = now.effects;
        let settings = Settings {
            strands: self.layout.groom.strand_count() as u32,
            first,
            colliders,
            clump,
            curl_radius,
            // As in `follow/style.rs`.
            curl_rate: std::f32::consts::TAU / curl_length.max(1e-4),
            noise,
            unused: 0,
        };
        self.settings.fill(gpu, &[settings], generation);
        let sway = SWAY[0] * curl_radius.max(0.0) + SWAY[1] * noise.max(0.0);
        self.corners.clear();
        for ((carrier, at), (low, high)) in places().zip(&self.boxes) {
            let m = Mat3::from(carrier.matrix3);
            let middle = *at + m * low.midpoint(*high);
            let half = 0.5 * (*high - *low);
            let reach = m.x_axis.abs() * half.x + m.y_axis.abs() * half.y + m.z_axis.abs() * half.z + sway;
            self.corners.extend([middle - reach, middle + reach]);
        }
    }
}

/// The data of strand `s` for the GPU.
fn follower(layout: &FollowLayout, s: usize) -> Follower {
    let range = layout.groom.range(s);
    let (guides, weights, bit) = match layout.guide(s) {
        Some(guide) => ([guide as u32; 3], [1.0, 0.0, 0.0], GUIDE),
        None => (layout.weights[s].guides, layout.weights[s].weights, 0),
    };
    let guide = guides.map(|g| layout.guide_range(g as usize));
    Follower {
        first: range.start as u32,
        count: range.len() as u32 | bit,
        lasts: guide.clone().map(|g| g.len() as u32 - 1),
        guides: guide.map(|g| g.start as u32),
        weights,
        phases: FollowLayout::phases(s as u32),
    }
}

/// For each guide point, the bounding box of the points that it transforms, relative to it in the rest pose
/// [m].
fn boxes(layout: &FollowLayout) -> Vec<(Vec3, Vec3)> {
    let rest: Vec<Vec3> =
        layout.guides.iter().flat_map(|g| layout.groom.strand(*g as usize)).copied().collect();
    let mut boxes = vec![(Vec3::ZERO, Vec3::ZERO); rest.len()];
    for (s, weights) in layout.weights.iter().enumerate() {
        for (g, _) in weights.weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
            let range = layout.guide_range(weights.guides[g] as usize);
            let last = range.len() - 1;
            for i in layout.groom.range(s) {
                let at = f32::from(layout.guide_coordinates[i][g]) * (last as f32 / f32::from(u16::MAX));
                let k = range.start + (at as usize).min(last - 1);
                for k in [k, k + 1] {
                    let d = layout.groom.points[i] - rest[k];
                    boxes[k] = (boxes[k].0.min(d), boxes[k].1.max(d));
                }
            }
        }
    }
    boxes
}

impl Followers {
    pub fn new(gpu: &Gpu) -> Self {
        let pipeline = super::memory::compute(gpu, &FOLLOW.module(gpu), "follow");
        Self { pipeline, grooms: Vec::new(), worlds: Vec::new() }
    }

    /// Sends the changed data of a frame's follow hairs.
    pub fn send(&mut self, gpu: &Gpu, hair: &[HairDraw], generation: &mut Generation) {
        let mut worlds: Vec<(&[MovingCollider], u32)> = Vec::new();
        self.grooms.resize_with(hair.len(), || None);
        let mut fitting = fitting(gpu, hair);
        for groom in &mut self.grooms {
            let followed = fitting.next().and_then(|(first, h)| Some((first, h.followed()?)));
            let Some((first, now)) = followed else {
                *groom = None;
                continue;
            };
            let world = worlds.iter().position(|(colliders, _)| std::ptr::eq(*colliders, now.colliders));
            let world = world.unwrap_or_else(|| {
                let k = worlds.len();
                if self.worlds.len() == k {
                    self.worlds.push(World::new(gpu));
                    generation.next();
                }
                worlds.push((now.colliders, self.worlds[k].send(gpu, now.colliders, generation)));
                k
            });
            if groom.as_ref().is_none_or(|g| !Arc::ptr_eq(&g.layout, now.layout)) {
                *groom = Some(Groom::new(gpu, now.layout, generation));
                generation.next();
            }
            if let Some(groom) = groom {
                groom.world = world;
                groom.send(gpu, &now, [first as u32, worlds[world].1], generation);
            }
        }
    }

    /// Corners of boxes that contain all points of a style [m]; `None` if its points are sent directly.
    pub fn corners(&self, style: usize) -> Option<&[Vec3]> {
        Some(&self.grooms.get(style)?.as_ref()?.corners)
    }

    /// Records the interpolation.
    pub fn record(&mut self, job: &Job, encoder: &mut wgpu::CommandEncoder) {
        if self.grooms.iter().all(Option::is_none) {
            return;
        }
        let Job { gpu, generation, strands, .. } = *job;
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        for groom in self.grooms.iter_mut().flatten() {
            let world = &self.worlds[groom.world];
            let entries = [
                (0, groom.settings.all()),
                (1, groom.followers.all()),
                (2, groom.rest.all()),
                (3, groom.rides.all()),
                (4, groom.guides.all()),
                (5, groom.carriers.all()),
                (6, world.colliders.all()),
                (7, world.shapes.all()),
                (8, strands.points.all()),
            ];
            let layout = self.pipeline.get_bind_group_layout(0);
            pass.set_bind_group(0, groom.bound.group(gpu, generation, layout, &entries), &[]);
            let [x, y, z] = groups(groom.layout.groom.strand_count(), 64);
            pass.dispatch_workgroups(x, y, z);
        }
    }
}
