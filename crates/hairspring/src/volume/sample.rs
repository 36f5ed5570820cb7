//! Samples the hair density of a frame at any point.

use super::{field::Field, grid_bounds::GridBounds};
use crate::math::RigidTransform;
use glam::Vec3;

/// The hair density field.
pub(crate) struct Density<'a> {
    field: &'a Field,
    cell: f32,
    anchor: RigidTransform,
}

impl<'a> Density<'a> {
    /// Creates the density from `field`, with grid cells of `cell` [m] and the anchor at `anchor`.
    pub(super) fn new(field: &'a Field, cell: f32, anchor: RigidTransform) -> Self {
        Self { field, cell, anchor }
    }

    /// Returns the edge of a cell [m].
    pub fn cell(&self) -> f32 {
        self.cell
    }

    /// Returns the number of nodes.
    pub fn nodes(&self) -> usize {
        self.field.bounds.nodes()
    }

    /// Returns the lowest and the highest node in the anchor's space [m]; `None` if there are none.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        let bounds = &self.field.bounds;
        let corners = [bounds.lo, bounds.end() - 1].map(|node| node.as_vec3() * self.cell);
        (bounds.nodes() > 0).then_some(corners)
    }

    /// Returns the number of nodes in a slab of constant z.
    pub fn slab(&self) -> usize {
        self.field.bounds.slab()
    }

    /// Returns whether there is hair in a cell around a node.
    pub fn is_near(&self, node: usize) -> bool {
        self.field.nodes[node][3] > 0.0
    }

    /// Returns the position of a node in world space [m].
    pub fn place(&self, node: usize) -> Vec3 {
        self.anchor.transform_point(self.field.bounds.place(node).as_vec3() * self.cell)
    }

    /// Returns whether `place` in world space is inside the grid.
    pub fn holds(&self, place: Vec3) -> bool {
        self.corner(self.on_lattice(place)).is_some()
    }

    /// Returns the fill at `place` in world space, 1 where it is as full as at rest [1], interpolated between
    /// cell centers.
    pub fn fill(&self, place: Vec3) -> f32 {
        self.between(self.on_lattice(place) - 0.5, &self.field.fill).unwrap_or(0.0)
    }

    /// Interpolates `values`, one for each node, at `place` in world space; `None` outside the grid.
    pub fn between_nodes(&self, place: Vec3, values: &[f32]) -> Option<f32> {
        self.between(self.on_lattice(place), values)
    }

    /// Transforms `place` from world space to cells from the lowest node of the bounds.
    fn on_lattice(&self, place: Vec3) -> Vec3 {
        self.anchor.inverse_transform_point(place) / self.cell - self.field.bounds.lo.as_vec3()
    }

    /// Returns the index of the lowest node of the cell that contains `at`, and the offset of `at` from it;
    /// `None` outside the bounds.
    fn corner(&self, at: Vec3) -> Option<(usize, Vec3)> {
        let GridBounds { dims, .. } = self.field.bounds;
        let floor = at.floor();
        let [x, y, z] = floor.to_array();
        let inside = (0..3).all(|k| floor[k] >= 0.0 && floor[k] + 1.0 < dims[k] as f32);
        inside.then(|| ((z as usize * dims[1] + y as usize) * dims[0] + x as usize, at - floor))
    }

    /// Interpolates `values` at integer positions trilinearly.
    fn between(&self, at: Vec3, values: &[f32]) -> Option<f32> {
        let (first, f) = self.corner(at)?;
        let v = self.field.bounds.corners().map(|corner| values[first + corner]);
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let x: [f32; 4] = std::array::from_fn(|k| mix(v[2 * k], v[2 * k + 1], f.x));
        Some(mix(mix(x[0], x[1], f.y), mix(x[2], x[3], f.y), f.z))
    }
}
