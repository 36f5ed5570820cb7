//! Hairs that are left to who draws them: how guides carry them at one moment.
//!
//! A graphics card places all; a picture of every eighth hair needs an eighth of them; a picture that nobody draws none.

use glam::{Affine3A, Vec3};
use hairspring::{
    collide::MovingCollider,
    follow::{FollowLayout, HairInterpolation},
    settings::Effects,
};
use std::sync::{Arc, OnceLock};

/// How guides carry the hairs of a groom.
pub struct Followers {
    /// What stays as it is.
    pub layout: Arc<FollowLayout>,
    effects: Effects,
    carriers: Vec<Affine3A>,
    guide_points: Vec<Vec3>,
    /// All of them, once somebody asks: a record, an overlay.
    placed: OnceLock<Vec<Vec3>>,
}

impl Followers {
    /// Memory for it.
    pub fn new(follow: HairInterpolation) -> Self {
        let layout = follow.layout.clone();
        let (carriers, guide_points) = (Vec::new(), Vec::new());
        Self { layout, effects: follow.effects, carriers, guide_points, placed: OnceLock::new() }
    }

    /// Copies a moment, into the memory that is there.
    pub fn fill(&mut self, follow: HairInterpolation) {
        self.layout.clone_from(follow.layout);
        self.effects = follow.effects;
        self.carriers.clear();
        self.carriers.extend_from_slice(follow.carriers);
        self.guide_points.clear();
        self.guide_points.extend_from_slice(follow.guide_points);
        self.placed = OnceLock::new();
    }

    /// For who places them.
    pub fn now<'a>(&'a self, obstacles: &'a [MovingCollider]) -> HairInterpolation<'a> {
        let Self { layout, effects, carriers, guide_points, .. } = self;
        HairInterpolation { layout, effects: *effects, carriers, guide_points, obstacles }
    }

    /// Where they are [m]; placed when it is first asked for.
    pub fn points(&self, obstacles: &[MovingCollider]) -> &[Vec3] {
        self.placed.get_or_init(|| {
            let mut points = vec![Vec3::ZERO; self.layout.groom.points.len()];
            self.now(obstacles).place(&mut points);
            points
        })
    }

    /// Where every `every`-th strand is [m], each from its place in `offsets` on.
    pub fn some_points(&self, every: usize, offsets: &[u32], obstacles: &[MovingCollider]) -> Vec<Vec3> {
        let mut points = vec![Vec3::ZERO; offsets.last().map_or(0, |end| *end as usize)];
        self.now(obstacles).place_every(every, offsets, &mut points);
        points
    }
}
