//! Follow hairs that the renderer interpolates: the transforms of their guides at one moment.
//!
//! A GPU interpolates all of them. A picture of every eighth hair needs an eighth of them, and a moment that
//! is not drawn needs none.

use glam::{Affine3A, Vec3};
use hairspring::{
    collide::MovingCollider,
    follow::{FollowLayout, HairInterpolation},
    settings::Effects,
};
use std::sync::{Arc, OnceLock};

/// The data for interpolating the hairs of a groom.
pub struct Followers {
    /// The static data.
    pub layout: Arc<FollowLayout>,
    effects: Effects,
    guide_transforms: Vec<Affine3A>,
    guide_points: Vec<Vec3>,
    /// All points, computed on the first request, for a recording or an overlay.
    placed: OnceLock<Vec<Vec3>>,
}

impl Followers {
    /// Allocates memory for a groom.
    pub fn new(follow: HairInterpolation) -> Self {
        let layout = follow.layout.clone();
        let (guide_transforms, guide_points) = (Vec::new(), Vec::new());
        Self { layout, effects: follow.effects, guide_transforms, guide_points, placed: OnceLock::new() }
    }

    /// Copies a moment, reusing the memory.
    pub fn fill(&mut self, follow: HairInterpolation) {
        self.layout.clone_from(follow.layout);
        self.effects = follow.effects;
        self.guide_transforms.clear();
        self.guide_transforms.extend_from_slice(follow.guide_transforms);
        self.guide_points.clear();
        self.guide_points.extend_from_slice(follow.guide_points);
        self.placed = OnceLock::new();
    }

    /// The data for a renderer that interpolates the hairs.
    pub fn now<'a>(&'a self, colliders: &'a [MovingCollider]) -> HairInterpolation<'a> {
        let Self { layout, effects, guide_transforms, guide_points, .. } = self;
        HairInterpolation { layout, effects: *effects, guide_transforms, guide_points, colliders }
    }

    /// All points [m], computed on the first request.
    pub fn points(&self, colliders: &[MovingCollider]) -> &[Vec3] {
        self.placed.get_or_init(|| {
            let mut points = vec![Vec3::ZERO; self.layout.groom.points.len()];
            self.now(colliders).place(&mut points);
            points
        })
    }

    /// Points of every `every`-th strand [m], each starting at its index in `offsets`.
    pub fn some_points(&self, every: usize, offsets: &[u32], colliders: &[MovingCollider]) -> Vec<Vec3> {
        let mut points = vec![Vec3::ZERO; offsets.last().map_or(0, |end| *end as usize)];
        self.now(colliders).place_every(every, offsets, &mut points);
        points
    }
}
