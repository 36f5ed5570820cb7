//! The posed body and what of it hair collides with.

use super::{PosedBody, StageError};
use crate::{
    body::{Body, Trs},
    collide::{Grid, Obstacle, ObstaclePose, Rigid, Voxelizer},
    scene::Scene,
    simulation::MovingObstacle,
};
use glam::{Affine3A, Vec3};
use std::sync::Arc;

/// Cells along the longest side of the body's distance field, which is as much of the body as hair can reach: 4 mm for half a metre.
const CELLS: f32 = 128.0;

/// A skinned surface that moved less than this in its anchor's space is rigid for this frame [m].
const STILL: f32 = 1e-5;

/// Pose and colliders of the scene's body now.
pub(super) struct StagedBody {
    /// Model-space matrix of each joint, at rest and now.
    rest: Vec<Affine3A>,
    world: Vec<Affine3A>,
    /// The joint that most of the head moves with: hair and fields are kept in its space.
    anchor: usize,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    obstacles: Vec<MovingObstacle>,
    /// Joint of each obstacle; `None`: fixed.
    joints: Vec<Option<usize>>,
    surface: Option<Surface>,
    reach: Reach,
}

/// Where hair can be: no farther from a root than the longest strand is long.
struct Reach {
    /// The skin's vertices around the roots.
    vertices: Vec<u32>,
    /// From those to the farthest tip, with room for the strain limit [m].
    length: f32,
}

impl Reach {
    fn new(scene: &Scene) -> Self {
        let mut reach = Self { vertices: Vec::new(), length: 0.0 };
        let Some(mesh) = scene.body.as_ref().map(|b| &b.mesh) else { return reach };
        for groom in scene.grooms.iter().map(|g| &g.groom) {
            for (s, root) in groom.roots.iter().enumerate() {
                reach.vertices.extend(mesh.triangles[root.triangle as usize]);
                reach.length = reach.length.max(1.02 * groom.strand_length(s) + root.offset.length());
            }
            if groom.roots.is_empty() && groom.strand_count() > 0 {
                // Roots that no skin carries may be anywhere.
                return Self { vertices: Vec::new(), length: 0.0 };
            }
        }
        reach.vertices.sort_unstable();
        reach.vertices.dedup();
        reach
    }

    /// The box (min, max) that hair stays in, in the space that `to` takes the skin's `positions` to; `None`: no bound is known.
    fn bounds(&self, positions: &[Vec3], to: impl Fn(Vec3) -> Vec3) -> Option<(Vec3, Vec3)> {
        let mut roots = self.vertices.iter().map(|v| to(positions[*v as usize]));
        let first = roots.next()?;
        let (lo, hi) = roots.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)));
        Some((lo - self.length, hi + self.length))
    }
}

/// A skinned collision surface, voxelised anew whenever it deforms; the first obstacle.
struct Surface {
    voxelizer: Voxelizer,
    /// Vertices in the anchor's space, now and a frame ago.
    now: Vec<Vec3>,
    before: Vec<Vec3>,
    normals: Vec<Vec3>,
    cell: f32,
}

impl StagedBody {
    /// The body at rest.
    pub(super) fn new(scene: &Scene) -> Result<Self, StageError> {
        let rest = scene.body.as_ref().map(|b| b.world(&b.rest_pose())).unwrap_or_default();
        let anchor = scene.body.as_ref().map_or(0, |b| anchor_joint(b, scene));
        let mut staged = Self {
            world: rest.clone(),
            rest,
            anchor,
            positions: Vec::new(),
            normals: Vec::new(),
            obstacles: Vec::new(),
            joints: Vec::new(),
            surface: None,
            reach: Reach::new(scene),
        };
        if let Some(body) = &scene.body {
            body.skinned(&staged.world, &mut staged.positions, &mut staged.normals);
        }
        staged.add_surface(scene);
        for collider in &scene.colliders {
            let joint = match (&collider.joint, &scene.body) {
                (Some(name), Some(body)) => {
                    Some(body.joint(name).ok_or(StageError::NoSuchJoint { joint: name.clone() })?)
                }
                (Some(name), None) => return Err(StageError::NoSuchJoint { joint: name.clone() }),
                (None, _) => (!staged.rest.is_empty()).then_some(staged.anchor),
            };
            staged.add(collider.shape.obstacle(), joint);
        }
        staged.repose(scene, 0.0);
        Ok(staged)
    }

    fn add(&mut self, shape: Obstacle, joint: Option<usize>) {
        self.obstacles.push(MovingObstacle { shape, start: Rigid::default(), end: Rigid::default() });
        self.joints.push(joint);
    }

    fn add_surface(&mut self, scene: &Scene) {
        let Some(body) =
            scene.collision.as_ref().or(scene.body.as_ref().filter(|_| scene.solver.collide_body))
        else {
            return;
        };
        let Some((lo, hi)) = body.mesh.bounds() else { return };
        let within = scene.body.as_ref().and_then(|b| self.reach.bounds(&b.mesh.positions, |p| p));
        let (lo, hi) = within.map_or((lo, hi), |(a, b)| (lo.max(a), hi.min(b)));
        // Hair that cannot reach the body meets a field of one cell.
        let cell = (hi - lo).max_element().max(1e-3) / CELLS;
        if body.skin.is_none() {
            // Rigid: voxelised once, in the space of the rest pose.
            let mut grid = Grid::default();
            let (positions, triangles) = (&body.mesh.positions, &body.mesh.triangles);
            Voxelizer::default().update(&mut grid, positions, None, triangles, within, cell);
            self.add(Obstacle::Field(Arc::new(grid)), (!self.rest.is_empty()).then_some(0));
            return;
        }
        self.surface = Some(Surface {
            voxelizer: Voxelizer::default(),
            now: Vec::new(),
            before: Vec::new(),
            normals: Vec::new(),
            cell,
        });
        self.add(Obstacle::Field(Arc::new(Grid::default())), None);
        self.rebuild_surface(body, true);
    }

    /// Voxelises the skinned surface in the anchor's space.
    fn rebuild_surface(&mut self, body: &Body, fresh: bool) {
        let (Some(surface), Some(obstacle)) = (&mut self.surface, self.obstacles.first_mut()) else { return };
        let anchor = Rigid::from_affine(&self.world[self.anchor]);
        std::mem::swap(&mut surface.now, &mut surface.before);
        body.skinned(&self.world, &mut surface.now, &mut surface.normals);
        surface.now.iter_mut().for_each(|p| *p = anchor.inverse_point(*p));
        let Obstacle::Field(grid) = &mut obstacle.shape else { return };
        let moved =
            surface.now.iter().zip(&surface.before).map(|(a, b)| a.distance_squared(*b)).fold(0.0, f32::max);
        if !fresh && moved < STILL * STILL {
            if grid.deforms() {
                Arc::make_mut(grid).displacements.clear();
            }
            // What little it moved is not lost: it adds up against the surface that was voxelised.
            std::mem::swap(&mut surface.now, &mut surface.before);
            return;
        }
        let before = (!fresh).then_some(surface.before.as_slice());
        let triangles = &body.mesh.triangles;
        let within = self.reach.bounds(&self.positions, |p| anchor.inverse_point(p));
        surface.voxelizer.update(Arc::make_mut(grid), &surface.now, before, triangles, within, surface.cell);
    }

    /// Poses the body for time `time` [s]; motion since the last pose is what colliders do in this frame.
    pub(super) fn advance(&mut self, scene: &Scene, time: f32) {
        for obstacle in &mut self.obstacles {
            obstacle.start = obstacle.end;
        }
        self.pose(scene, time);
        if let Some(body) = scene.collision.as_ref().or(scene.body.as_ref()) {
            self.rebuild_surface(body, false);
        }
        self.repose(scene, time);
    }

    /// Poses the body for time `time` [s] without motion.
    pub(super) fn place(&mut self, scene: &Scene, time: f32) {
        self.pose(scene, time);
        if let Some(body) = scene.collision.as_ref().or(scene.body.as_ref()) {
            self.rebuild_surface(body, true);
        }
        self.repose(scene, time);
        for obstacle in &mut self.obstacles {
            obstacle.start = obstacle.end;
        }
    }

    fn pose(&mut self, scene: &Scene, time: f32) {
        if let (Some(body), Some(clip)) = (&scene.body, &scene.clip) {
            let pose: Vec<Trs> = clip.sample(time);
            self.world = body.world(&pose);
        }
        if let Some(body) = &scene.body {
            body.skinned(&self.world, &mut self.positions, &mut self.normals);
        }
    }

    /// Where obstacles are in the current pose, at time `time` [s].
    fn repose(&mut self, scene: &Scene, time: f32) {
        let field_anchor = self.surface.is_some().then(|| self.anchor());
        for (k, (obstacle, joint)) in self.obstacles.iter_mut().zip(&self.joints).enumerate() {
            obstacle.end = match (joint, field_anchor) {
                (_, Some(anchor)) if k == 0 => anchor,
                (Some(j), _) => Rigid::from_affine(&(self.world[*j] * self.rest[*j].inverse())),
                (None, _) => Rigid::default(),
            };
        }
        // The scene's colliders are the last.
        for (obstacle, collider) in self.obstacles.iter_mut().rev().zip(scene.colliders.iter().rev()) {
            obstacle.end.translation = obstacle.end.point(collider.offset(time));
        }
    }

    /// The frame that roots move with.
    pub(super) fn anchor(&self) -> Rigid {
        self.world.get(self.anchor).map_or(Rigid::default(), Rigid::from_affine)
    }

    /// The colliders and how they moved in the last frame.
    pub(super) fn obstacles(&self) -> &[MovingObstacle] {
        &self.obstacles
    }

    /// The colliders as they are now.
    pub(super) fn poses(&self) -> Vec<ObstaclePose> {
        self.obstacles
            .iter()
            .map(|o| ObstaclePose::new(o.shape.clone(), o.start.matrix(), o.end.matrix(), 1.0))
            .collect()
    }

    /// Vertex positions now [m]; empty without a body.
    pub(super) fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    pub(super) fn posed<'a>(&'a self, scene: &'a Scene) -> Option<PosedBody<'a>> {
        let mesh = &scene.body.as_ref()?.mesh;
        Some(PosedBody { mesh, positions: &self.positions, normals: &self.normals })
    }
}

/// The joint that carries most of the vertices near the roots; joint 0 of a rigid body.
fn anchor_joint(body: &Body, scene: &Scene) -> usize {
    let Some(skin) = &body.skin else { return 0 };
    let mut weight = vec![0.0; body.joints.len()];
    for groom in &scene.grooms {
        for root in &groom.groom.roots {
            for v in body.mesh.triangles[root.triangle as usize] {
                for (j, w) in skin.joints[v as usize].iter().zip(skin.weights[v as usize]) {
                    weight[*j as usize] += w;
                }
            }
        }
    }
    (0..weight.len()).max_by(|a, b| weight[*a].total_cmp(&weight[*b]).then(b.cmp(a))).unwrap_or(0)
}
