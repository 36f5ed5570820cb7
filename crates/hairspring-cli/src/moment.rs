//! The state of a frame, from which motion is shown: where hair, body and camera were, and where they are at
//! moments between two frames.

use glam::Vec3;
use hairspring_scene::{Camera, stage::Stage};
use hairspring_view::{Before, Frame, GeometryImage, HairDraw, MeshDraw, Renderer};
use rayon::prelude::*;

/// Where everything is at one moment.
#[derive(Default)]
pub struct Moment {
    /// The camera.
    pub camera: Camera,
    /// Points of each hairstyle [m].
    pub hair: Vec<Vec<Vec3>>,
    /// Positions [m] and normals of the body, if there is one.
    pub body: Option<(Vec<Vec3>, Vec<Vec3>)>,
}

impl Moment {
    /// Copies the current state of a stage, reusing the memory.
    pub fn fill(&mut self, stage: &Stage, camera: Camera) {
        self.camera = camera;
        self.hair.resize_with(stage.strands().len(), Vec::new);
        for (points, strands) in self.hair.iter_mut().zip(stage.strands()) {
            points.clear();
            points.extend_from_slice(strands.points);
        }
        self.body = stage.body().map(|body| (body.positions.to_vec(), body.normals.to_vec()));
    }

    /// The moment between this one and `now`: `share` 0 is this one, 1 is `now`.
    pub fn toward(&self, now: &Frame, share: f32) -> Self {
        let between = |a: &[Vec3], b: &[Vec3]| -> Vec<Vec3> {
            a.par_iter().zip(b).with_min_len(4096).map(|(a, b)| a.lerp(*b, share)).collect()
        };
        let body = self.body.as_ref().zip(now.bodies.first());
        Self {
            camera: Camera {
                position: self.camera.position.lerp(now.camera.position, share),
                target: self.camera.target.lerp(now.camera.target, share),
                ..now.camera
            },
            hair: self.hair.iter().zip(now.hair).map(|(a, b)| between(a, b.points)).collect(),
            body: body.map(|((p, n), now)| (between(p, now.positions), between(n, now.normals))),
        }
    }

    /// Draws the depth of a frame, and its motion since this moment. What this moment lacks did not move.
    pub fn geometry(&self, renderer: &mut Renderer, now: &Frame) -> GeometryImage {
        let hair: Vec<&[Vec3]> = self.hair.iter().map(Vec::as_slice).collect();
        let bodies: Vec<&[Vec3]> = self.body.iter().map(|(positions, _)| positions.as_slice()).collect();
        renderer.draw_geometry(now, &Before { camera: self.camera, hair: &hair, bodies: &bodies })
    }

    /// The hairstyles of a frame at this moment.
    pub fn hair<'a>(&'a self, current: &'a [HairDraw<'a>]) -> impl Iterator<Item = HairDraw<'a>> {
        self.hair.iter().zip(current).map(|(points, hair)| HairDraw { points, ..*hair })
    }

    /// The body of a frame at this moment.
    pub fn body<'a>(&'a self, body: MeshDraw<'a>) -> MeshDraw<'a> {
        match &self.body {
            Some((positions, normals)) => MeshDraw { positions, normals, ..body },
            None => body,
        }
    }
}
