//! The lattice of a frame, read at any place.

use super::{field::Field, grid_bounds::GridBounds};
use crate::math::RigidTransform;
use glam::Vec3;

/// How full of hair every place is.
pub(crate) struct Density<'a> {
    field: &'a Field,
    cell: f32,
    anchor: RigidTransform,
}

impl<'a> Density<'a> {
    /// What `field` holds on a lattice with cells of `cell` [m], where the anchor is at `anchor`.
    pub(super) fn new(field: &'a Field, cell: f32, anchor: RigidTransform) -> Self {
        Self { field, cell, anchor }
    }

    /// Edge of a cell [m].
    pub fn cell(&self) -> f32 {
        self.cell
    }

    /// How many nodes there are.
    pub fn nodes(&self) -> usize {
        self.field.window.nodes()
    }

    /// Nodes in a slab of one z.
    pub fn slab(&self) -> usize {
        self.field.window.slab()
    }

    /// Whether there is hair in a cell around a node.
    pub fn is_near(&self, node: usize) -> bool {
        self.field.nodes[node][3] > 0.0
    }

    /// Where a node is in the world [m].
    pub fn place(&self, node: usize) -> Vec3 {
        self.anchor.point(self.field.window.place(node).as_vec3() * self.cell)
    }

    /// Whether `place` in the world is where the lattice is.
    pub fn holds(&self, place: Vec3) -> bool {
        self.corner(self.on_lattice(place)).is_some()
    }

    /// How full of hair `place` in the world is, 1 where as full as at rest [1]; between the middles of cells.
    pub fn fill(&self, place: Vec3) -> f32 {
        self.between(self.on_lattice(place) - 0.5, &self.field.fill).unwrap_or(0.0)
    }

    /// What `values`, one a node, are at `place` in the world; `None` beyond the lattice.
    pub fn between_nodes(&self, place: Vec3, values: &[f32]) -> Option<f32> {
        self.between(self.on_lattice(place), values)
    }

    /// `place` in the world, from the window's lowest node [cells].
    fn on_lattice(&self, place: Vec3) -> Vec3 {
        self.anchor.inverse_point(place) / self.cell - self.field.window.lo.as_vec3()
    }

    /// Index of the node below `at` whose seven neighbours above are of the window too, and how far above it `at` is.
    fn corner(&self, at: Vec3) -> Option<(usize, Vec3)> {
        let GridBounds { dims, .. } = self.field.window;
        let floor = at.floor();
        let [x, y, z] = floor.to_array();
        let inside = (0..3).all(|k| floor[k] >= 0.0 && floor[k] + 1.0 < dims[k] as f32);
        inside.then(|| ((z as usize * dims[1] + y as usize) * dims[0] + x as usize, at - floor))
    }

    /// Trilinear between `values` that lie on whole numbers.
    fn between(&self, at: Vec3, values: &[f32]) -> Option<f32> {
        let (first, f) = self.corner(at)?;
        let v = self.field.window.corners().map(|corner| values[first + corner]);
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let x: [f32; 4] = std::array::from_fn(|k| mix(v[2 * k], v[2 * k + 1], f.x));
        Some(mix(mix(x[0], x[1], f.y), mix(x[2], x[3], f.y), f.z))
    }
}
