//! Lines that show what a simulation sees: strands, contacts, root frames, colliders, wind and the grid of the
//! hair volume.

use super::{Simulation, StepInput};
use crate::{
    air::Noise,
    collide::{ColliderShape, MovingCollider},
    math::RigidTransform,
};
use glam::Vec3;
use std::{
    f32::consts::TAU,
    ops::{BitOr, BitOrAssign},
};

/// Segments of a circle.
const CIRCLE: usize = 24;

/// Half of the length of the lines that mark a contact [m].
const CONTACT_HALF_LENGTH: f32 = 0.0005;

/// Length of a contact's normal [m].
const NORMAL: f32 = 0.005;

/// Half of the side of the square that shows a plane [m].
const PLANE: f32 = 0.5;

/// Squares along a side of the square that shows a plane.
const SQUARES: i32 = 10;

/// Duration for which a wind line follows the air [s].
const WIND: f32 = 0.01;

/// Wind is drawn at every fourth point of a strand.
const WIND_STRIDE: usize = 4;

/// A line in world space.
///
/// For an example, see [`Simulation::debug_lines`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DebugLine {
    /// Start [m].
    pub a: Vec3,
    /// End [m].
    pub b: Vec3,
    /// What the line shows.
    pub kind: DebugLineKind,
}

/// What a [`DebugLine`] shows.
///
/// For an example, see [`Simulation::debug_lines`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DebugLineKind {
    /// A segment of a strand.
    Segment,
    /// A contact with a collider: three lines that cross at its position.
    ContactPoint,
    /// The normal of a contact, 5 mm long.
    ContactNormal,
    /// The x axis of a root's frame, as long as the first segment of its strand.
    RootX,
    /// The y axis of a root's frame.
    RootY,
    /// The z axis of a root's frame.
    RootZ,
    /// The outline of a collider.
    Collider,
    /// The wind: the path of the air in 10 ms.
    Wind,
    /// The bounds of the hair volume's grid.
    Volume,
}

impl DebugLineKind {
    /// Returns a color for the kind: linear RGB, 0 to 1.
    pub fn color(self) -> [f32; 3] {
        match self {
            Self::Segment => [0.9, 0.7, 0.3],
            Self::ContactPoint => [1.0, 0.1, 0.1],
            Self::ContactNormal => [1.0, 0.4, 0.8],
            Self::RootX => [1.0, 0.0, 0.0],
            Self::RootY => [0.0, 1.0, 0.0],
            Self::RootZ => [0.0, 0.0, 1.0],
            Self::Collider => [0.5, 0.5, 0.5],
            Self::Wind => [0.2, 0.7, 1.0],
            Self::Volume => [0.2, 0.9, 0.4],
        }
    }
}

/// Selects the kinds of [`DebugLine`]s. Modes are combined with `|`.
///
/// ```
/// use hairspring::simulation::DebugRenderMode;
///
/// let mode = DebugRenderMode::SEGMENTS | DebugRenderMode::COLLIDERS;
/// assert!(mode.contains(DebugRenderMode::COLLIDERS) && !mode.contains(DebugRenderMode::WIND));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct DebugRenderMode(u32);

impl DebugRenderMode {
    /// The segments of all strands.
    pub const SEGMENTS: Self = Self(1);
    /// The positions of contacts with colliders.
    pub const CONTACT_POINTS: Self = Self(1 << 1);
    /// The normals of contacts with colliders.
    pub const CONTACT_NORMALS: Self = Self(1 << 2);
    /// The frames of all roots.
    pub const ROOTS: Self = Self(1 << 3);
    /// The outlines of colliders. Of a field, the bounds of its grid; of a custom shape, its bounding sphere.
    pub const COLLIDERS: Self = Self(1 << 4);
    /// The air velocity at every fourth point of each strand, without wind occlusion.
    pub const WIND: Self = Self(1 << 5);
    /// The bounds of the hair volume's grid when it was last measured.
    pub const VOLUME: Self = Self(1 << 6);
    /// Everything.
    pub const ALL: Self = Self((1 << 7) - 1);

    /// Returns whether all of `other` is selected.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

impl BitOr for DebugRenderMode {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for DebugRenderMode {
    fn bitor_assign(&mut self, other: Self) {
        *self = *self | other;
    }
}

impl Simulation {
    /// Returns lines in world space that show the state after a step [m]. `last` is the input of that step:
    /// colliders are drawn at their end poses, and the air is that of the middle of the frame.
    ///
    /// It reads the state only. A step costs the same with and without it.
    ///
    /// ```
    /// use hairspring::{prelude::*, simulation::DebugRenderMode};
    ///
    /// let strand: Vec<Vec3> = (0..16).map(|i| Vec3::NEG_Y * (0.01 * i as f32)).collect();
    /// let mut simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).build()?;
    /// let roots = simulation.rigid_roots(RigidTransform::IDENTITY);
    /// let input = StepInput::new(1.0 / 60.0, RigidTransform::IDENTITY, &roots);
    /// simulation.step(&input);
    /// let lines = simulation.debug_lines(&input, DebugRenderMode::SEGMENTS);
    /// assert_eq!(lines.len(), 15);
    /// # Ok::<(), hairspring::simulation::BuildError>(())
    /// ```
    pub fn debug_lines(&self, last: &StepInput, mode: DebugRenderMode) -> Vec<DebugLine> {
        let mut lines = Lines(Vec::new());
        if mode.contains(DebugRenderMode::SEGMENTS) {
            self.add_segments(&mut lines);
        }
        for contact in self.contact_points(last.colliders) {
            if mode.contains(DebugRenderMode::CONTACT_POINTS) {
                for axis in Vec3::AXES {
                    let half = axis * CONTACT_HALF_LENGTH;
                    lines.add(DebugLineKind::ContactPoint, contact.position - half, contact.position + half);
                }
            }
            if mode.contains(DebugRenderMode::CONTACT_NORMALS) {
                let end = contact.position + contact.normal * NORMAL;
                lines.add(DebugLineKind::ContactNormal, contact.position, end);
            }
        }
        if mode.contains(DebugRenderMode::ROOTS) {
            self.add_roots(&mut lines);
        }
        if mode.contains(DebugRenderMode::COLLIDERS) {
            last.colliders.iter().for_each(|collider| lines.add_collider(collider));
        }
        if mode.contains(DebugRenderMode::WIND) && last.air.moves() {
            self.add_wind(last, &mut lines);
        }
        if mode.contains(DebugRenderMode::VOLUME) {
            let anchor = self.state.anchor;
            let bounds = self.volume.as_ref().and_then(|volume| volume.density(anchor).bounds());
            if let Some([lo, hi]) = bounds {
                lines.add_box(DebugLineKind::Volume, |t| anchor.transform_point(lo + (hi - lo) * t));
            }
        }
        lines.0
    }

    fn add_segments(&self, lines: &mut Lines) {
        for strand in self.each_strand() {
            let mut before = None;
            for point in strand.points() {
                if let Some(before) = before.replace(point) {
                    lines.add(DebugLineKind::Segment, before, point);
                }
            }
        }
    }

    fn add_roots(&self, lines: &mut Lines) {
        let kinds = [DebugLineKind::RootX, DebugLineKind::RootY, DebugLineKind::RootZ];
        for strand in self.each_strand() {
            let turn = strand.root_rotation().normalize();
            let mut points = strand.points().take(2);
            let (Some(root), Some(next)) = (points.next(), points.next()) else { continue };
            for (kind, axis) in kinds.into_iter().zip(Vec3::AXES) {
                lines.add(kind, root, root + turn * axis * root.distance(next));
            }
        }
    }

    fn add_wind(&self, last: &StepInput, lines: &mut Lines) {
        let mut noise = Noise::default();
        let air = last.air.moment(last.dt, &mut noise);
        for strand in self.each_strand() {
            for point in strand.points().step_by(WIND_STRIDE) {
                lines.add(DebugLineKind::Wind, point, point + air.velocity(point) * WIND);
            }
        }
    }
}

/// The lines so far.
struct Lines(Vec<DebugLine>);

impl Lines {
    /// Adds a line, unless a number is not finite.
    fn add(&mut self, kind: DebugLineKind, a: Vec3, b: Vec3) {
        if a.is_finite() && b.is_finite() {
            self.0.push(DebugLine { a, b, kind });
        }
    }

    /// Adds the edges of a box, whose corners `at` gives for the corners of the unit cube.
    fn add_box(&mut self, kind: DebugLineKind, at: impl Fn(Vec3) -> Vec3) {
        let corner = |k: usize| at(Vec3::from([1, 2, 4].map(|bit| if k & bit > 0 { 1.0 } else { 0.0 })));
        for (k, bit) in (0..8).flat_map(|k| [1, 2, 4].map(|bit| (k, bit))).filter(|(k, bit)| k & bit == 0) {
            self.add(kind, corner(k), corner(k | bit));
        }
    }

    /// Adds the part of a circle from `x` over `y`, as a fraction of the circle.
    fn add_arc(&mut self, pose: &RigidTransform, center: Vec3, [x, y]: [Vec3; 2], part: f32) {
        let count = (CIRCLE as f32 * part).round() as usize;
        let at = |k: usize| {
            let (sin, cos) = (TAU * part * k as f32 / count as f32).sin_cos();
            pose.transform_point(center + x * cos + y * sin)
        };
        (0..count).for_each(|k| self.add(DebugLineKind::Collider, at(k), at(k + 1)));
    }

    /// Adds three great circles of a ball.
    fn add_ball(&mut self, pose: &RigidTransform, center: Vec3, radius: f32) {
        let [x, y, z] = Vec3::AXES.map(|axis| axis * radius);
        [[x, y], [y, z], [z, x]].into_iter().for_each(|axes| self.add_arc(pose, center, axes, 1.0));
    }

    fn add_triangle(&mut self, pose: &RigidTransform, triangle: &[Vec3; 3]) {
        let [a, b, c] = triangle.map(|p| pose.transform_point(p));
        [(a, b), (b, c), (c, a)].into_iter().for_each(|(a, b)| self.add(DebugLineKind::Collider, a, b));
    }

    fn add_collider(&mut self, collider: &MovingCollider) {
        let pose = &collider.end;
        match &collider.shape {
            ColliderShape::Sphere { center, radius } => self.add_ball(pose, *center, *radius),
            ColliderShape::Capsule { a, b, radius } => {
                let axis = (*b - *a).normalize_or(Vec3::Y);
                let x = axis.any_orthonormal_vector() * *radius;
                let (y, cap) = (axis.cross(x), axis * *radius);
                for (end, cap) in [(*a, -cap), (*b, cap)] {
                    self.add_arc(pose, end, [x, y], 1.0);
                    self.add_arc(pose, end, [x, cap], 0.5);
                    self.add_arc(pose, end, [y, cap], 0.5);
                }
                for side in [x, y, -x, -y] {
                    self.add(
                        DebugLineKind::Collider,
                        pose.transform_point(*a + side),
                        pose.transform_point(*b + side),
                    );
                }
            }
            ColliderShape::Cuboid { center, half, axes } => self.add_box(DebugLineKind::Collider, |t| {
                pose.transform_point(*center + *axes * (*half * (t * 2.0 - 1.0)))
            }),
            ColliderShape::Plane { point, normal } => {
                let x = normal.any_orthonormal_vector() * PLANE;
                let y = normal.cross(x);
                for k in 0..=SQUARES {
                    let t = 2.0 * k as f32 / SQUARES as f32 - 1.0;
                    for (along, across) in [(x, y), (y, x)] {
                        let [a, b] =
                            [-1.0, 1.0].map(|end| pose.transform_point(*point + across * t + along * end));
                        self.add(DebugLineKind::Collider, a, b);
                    }
                }
            }
            ColliderShape::Field(field) => {
                let size = (field.size().as_vec3() - 1.0) * field.cell();
                self.add_box(DebugLineKind::Collider, |t| pose.transform_point(field.origin() + size * t));
            }
            ColliderShape::Hull(hull) => hull.triangles().for_each(|t| self.add_triangle(pose, &t)),
            ColliderShape::Sheet(sheet) => sheet.triangles().iter().for_each(|t| self.add_triangle(pose, t)),
            ColliderShape::Custom(custom) => {
                let (center, radius) = custom.bounds();
                self.add_ball(pose, center, radius);
            }
        }
    }
}
