//! The state of the simulation at one moment, as needed for drawing and for figures.

use crate::{
    carried::Carried,
    followers::Followers,
    player::CachedFrames,
    pointer_collider::{Placed, Pushed},
};
use glam::{Mat3, Vec2, Vec3};
use hairspring::{
    body::{Mesh, Part},
    collide::MovingCollider,
    groom::RootBinding,
    math::RigidTransform,
    simulation::{Energy, Measure, VolumeReport},
};
use hairspring_io::Strands;
use hairspring_scene::{
    HairLook, Picture,
    stage::{FrameReport, Picked, Stage, StrandFigures, Subject, Value},
};
use hairspring_view::{Background, Frame, Ground, HairDraw, Lighting, MeshDraw, Quality};
use std::{sync::Arc, time::Duration};

/// Static data, created once per scene.
pub struct Still {
    /// Offsets, radii and colors of each groom's strands.
    pub grooms: Vec<StillGroom>,
    /// Triangles and parts of the body.
    pub body: Option<(Vec<[u32; 3]>, Vec<Part>)>,
    /// Numbers of simulated strands, all strands, simulated points, and all points.
    pub counts: [usize; 4],
    /// Name of the instruction set.
    pub instruction_set: String,
    /// Hair and head over the whole motion; `None` if no point is finite.
    pub subject: Option<Subject>,
}

/// The static data of one groom.
pub struct StillGroom {
    offsets: Vec<u32>,
    radii: Vec<f32>,
    colors: Vec<Vec3>,
    root_uvs: Vec<Vec2>,
    /// Binding of each strand's root to the body; empty if the roots are not bound.
    bindings: Vec<RootBinding>,
}

impl StillGroom {
    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// The strands as a file has them, without points.
    pub fn strands(&self) -> Strands<'_> {
        let Self { offsets, radii, colors, root_uvs, .. } = self;
        Strands { points: &[], offsets, radii, colors, root_uvs }
    }

    /// Points of a strand; empty if the strand does not exist.
    pub fn strand(&self, strand: usize) -> std::ops::Range<usize> {
        match self.offsets.get(strand..strand + 2) {
            Some(&[from, to]) => from as usize..to as usize,
            _ => 0..0,
        }
    }
}

impl Still {
    /// Collects the static data of this stage.
    pub fn new(stage: &Stage) -> Self {
        let grooms = stage.strands().map(|s| StillGroom {
            offsets: s.groom.offsets.clone(),
            radii: s.groom.radii.clone(),
            colors: s.groom.colors.clone(),
            root_uvs: s.groom.root_uvs.clone(),
            bindings: s.groom.roots.clone(),
        });
        let mesh = |m: &Mesh| (m.triangles.clone(), m.parts.clone());
        let ((simulated, strands), (points, all)) = (stage.simulated_strands(), stage.simulated_points());
        Self {
            grooms: grooms.collect(),
            body: stage.body().map(|b| mesh(b.mesh)),
            counts: [simulated, strands, points, all],
            instruction_set: stage.instruction_set(),
            subject: stage.subject(),
        }
    }
}

/// A stage at one moment.
pub struct StageSnapshot {
    /// The static data.
    pub still: Arc<Still>,
    /// Time in the scene [s].
    pub time: f64,
    /// The look of each groom.
    pub looks: Vec<HairLook>,
    /// Points of each groom [m]. They are only valid for grooms whose follow hairs are not left to the
    /// renderer.
    points: Vec<Vec<Vec3>>,
    /// Interpolation data of the follow hairs that are left to the renderer.
    followers: Vec<Option<Followers>>,
    /// One value per point of each groom if a value is shown; otherwise empty.
    pub values: Vec<Vec<f32>>,
    /// Vertex positions and normals of the body.
    pub positions: Vec<Vec3>,
    /// See `positions`.
    pub normals: Vec<Vec3>,
    /// Backdrop, light and shutter.
    picture: Picture,
    /// The ground.
    ground: Option<Ground>,
    /// Colliders.
    pub colliders: Vec<MovingCollider>,
    /// The rigid transform of the roots.
    pub anchor: RigidTransform,
    /// Stretch, depth and speed, of this moment or, while playing, of a few steps ago.
    pub measure: Measure,
    /// Energy of the same moment.
    pub energy: Energy,
    /// Compute times of the last frame.
    pub report: FrameReport,
    /// Report of the volume method, if one is on.
    pub volume: Option<VolumeReport>,
    /// Current transforms of the scene's listed objects.
    pub carried: Carried,
    /// The pushed object and its pose.
    pub pushed: Option<(Pushed, RigidTransform)>,
}

impl StageSnapshot {
    /// Allocates memory for the snapshots of a stage.
    pub fn new(still: Arc<Still>) -> Self {
        Self {
            still,
            time: 0.0,
            looks: Vec::new(),
            points: Vec::new(),
            followers: Vec::new(),
            values: Vec::new(),
            positions: Vec::new(),
            normals: Vec::new(),
            picture: Picture::default(),
            ground: None,
            colliders: Vec::new(),
            anchor: RigidTransform::default(),
            measure: Measure::default(),
            energy: Energy::default(),
            report: FrameReport::default(),
            volume: None,
            carried: Carried::default(),
            pushed: None,
        }
    }

    /// Copies the current state of a stage, reusing the memory.
    pub fn fill(&mut self, stage: &Stage, still: &Arc<Still>, value: Option<Value>) {
        self.still = still.clone();
        self.time = stage.time();
        let grooms = stage.strands().len();
        self.points.resize_with(grooms, Vec::new);
        self.followers.resize_with(grooms, || None);
        self.looks.clear();
        for ((strands, points), left) in stage.strands().zip(&mut self.points).zip(&mut self.followers) {
            points.clear();
            match strands.follow {
                Some(follow) => left.get_or_insert_with(|| Followers::new(follow)).fill(follow),
                None => {
                    points.extend_from_slice(strands.points);
                    *left = None;
                }
            }
            self.looks.push(strands.look.clone());
        }
        self.values.resize_with(if value.is_some() { grooms } else { 0 }, Vec::new);
        for (groom, values) in self.values.iter_mut().enumerate() {
            let Some(value) = value else { continue };
            stage.values(value, groom, values);
            if value == Value::Guide {
                values.iter_mut().for_each(|v| *v = crate::ramp::scattered(*v as u32));
            }
        }
        self.positions.clear();
        self.normals.clear();
        if let Some(body) = stage.body() {
            self.positions.extend_from_slice(body.positions);
            self.normals.extend_from_slice(body.normals);
        }
        self.picture = stage.scene().picture;
        self.ground = Ground::of(stage.scene());
        self.colliders.clear();
        self.colliders.extend_from_slice(stage.colliders());
        self.anchor = stage.body_anchor();
        self.volume = stage.volume();
        self.carried.fill(stage);
    }

    /// Coordinate frame of a strand's root: that of the skin triangle (x along an edge, y along the normal),
    /// or that of the head if the root is not bound to skin.
    pub fn root_frame(&self, groom: usize, strand: usize) -> Mat3 {
        let skin = self.skin_at(groom, strand);
        skin.map_or(self.anchor.matrix().0, |(binding, corners)| Mat3::from_quat(binding.frame(corners)))
    }

    /// Position of a strand's root [m]. For hairs that are left to the renderer, only the root is computed,
    /// from its binding to the skin.
    pub fn root(&self, groom: usize, strand: usize) -> Option<Vec3> {
        match self.skin_at(groom, strand) {
            Some((binding, corners)) => Some(binding.position(corners)),
            None => self.points_of(groom).get(self.still.grooms[groom].strand(strand).start).copied(),
        }
    }

    /// Binding of a strand to the skin, and the corners of its triangle [m]; `None` if the strand is not
    /// bound.
    fn skin_at(&self, groom: usize, strand: usize) -> Option<(&RootBinding, [Vec3; 3])> {
        let binding = self.still.grooms.get(groom)?.bindings.get(strand)?;
        let corners = self.still.body.as_ref()?.0.get(binding.triangle as usize)?;
        let [a, b, c] = corners.map(|v| self.positions.get(v as usize).copied());
        Some((binding, [a?, b?, c?]))
    }

    /// The box (min, max) of all hair [m]; `None` if no point is finite.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let points = self.points().flatten().filter(|p| p.is_finite());
        points.fold(None, |b, p| {
            let (low, high): (Vec3, Vec3) = b.unwrap_or((*p, *p));
            Some((low.min(*p), high.max(*p)))
        })
    }

    /// Points of each groom [m]. Follow hairs that are left to the renderer are interpolated on the first
    /// request.
    pub fn points(&self) -> impl ExactSizeIterator<Item = &[Vec3]> {
        (0..self.points.len()).map(|g| self.points_of(g))
    }

    fn points_of(&self, groom: usize) -> &[Vec3] {
        match &self.followers[groom] {
            Some(left) => left.points(&self.colliders),
            None => &self.points[groom],
        }
    }

    /// Calls `draw` with the frame for this view. Only every `every`-th hair is included, drawn
    /// correspondingly wider. `card` tells whether the renderer can interpolate follow hairs.
    pub fn draw<R>(&self, view: &ViewParameters, card: bool, draw: impl FnOnce(&Frame) -> R) -> R {
        let left = |g: usize| self.followers[g].as_ref().filter(|_| card);
        let thinned: Vec<Option<Thin>> = (0..self.points.len())
            .map(|g| {
                // Brows have few hairs and are not thinned.
                let every = view.every.min(self.still.grooms[g].strand_count() / FEW).max(1);
                (every > 1).then(|| Thin::new(self, g, every))
            })
            .collect();
        let points: Vec<&[Vec3]> = thinned
            .iter()
            .enumerate()
            .map(|(g, thin)| match (thin, left(g)) {
                (Some(thin), _) => &thin.points[..],
                (None, Some(left)) => &left.layout.groom.points,
                (None, None) => self.points_of(g),
            })
            .collect();
        let colors: Vec<Vec<Vec3>> = self.values.iter().map(|v| crate::ramp::colors(v, view.range)).collect();
        let picked: Vec<Option<Vec<Vec3>>> =
            thinned.iter().enumerate().map(|(g, thin)| Some(thin.as_ref()?.pick(colors.get(g)?))).collect();
        let hair: Vec<HairDraw> = (0..points.len())
            .map(|g| {
                let still = &self.still.grooms[g];
                match &thinned[g] {
                    Some(thin) => HairDraw {
                        points: points[g],
                        offsets: &thin.offsets,
                        radii: &thin.radii,
                        colors: picked[g].as_ref().unwrap_or(&thin.colors),
                        look: &self.looks[g],
                        width_scale: view.width * thin.every as f32,
                        follow: None,
                    },
                    None => HairDraw {
                        points: points[g],
                        offsets: &still.offsets,
                        radii: &still.radii,
                        colors: colors.get(g).unwrap_or(&still.colors),
                        look: &self.looks[g],
                        width_scale: view.width,
                        follow: left(g).map(|left| left.now(&self.colliders)),
                    },
                }
            })
            .collect();
        let body = self.still.body.as_ref().filter(|_| view.body).map(|(triangles, parts)| MeshDraw {
            positions: &self.positions,
            normals: &self.normals,
            triangles,
            parts,
        });
        let pushed = self.pushed.map(|(what, pose)| what.placed(pose));
        let bodies: Vec<MeshDraw> = body.into_iter().chain(pushed.as_ref().map(Placed::mesh)).collect();
        draw(&Frame {
            hair: if view.hair { &hair } else { &[] },
            bodies: &bodies,
            camera: view.camera,
            lighting: Lighting { exposure: view.exposure, ..Lighting::of(&self.picture, &view.lit_for) },
            background: Background::of(&self.picture),
            ground: self.ground,
            quality: view.quality,
        })
    }
}

/// Number of strands below which a groom is not thinned, such as brows.
const FEW: usize = 500;

/// Every n-th strand of a groom.
struct Thin {
    every: usize,
    strands: Vec<std::ops::Range<usize>>,
    points: Vec<Vec3>,
    offsets: Vec<u32>,
    radii: Vec<f32>,
    colors: Vec<Vec3>,
}

impl Thin {
    fn new(stage_snapshot: &StageSnapshot, groom: usize, every: usize) -> Self {
        let still = &stage_snapshot.still.grooms[groom];
        let strands: Vec<_> =
            still.offsets.windows(2).step_by(every).map(|w| w[0] as usize..w[1] as usize).collect();
        let mut thin = Self {
            every,
            strands,
            points: Vec::new(),
            offsets: vec![0],
            radii: Vec::new(),
            colors: Vec::new(),
        };
        for strand in &thin.strands {
            thin.radii.extend_from_slice(&still.radii[strand.clone()]);
            thin.colors.extend_from_slice(still.colors.get(strand.clone()).unwrap_or(&[]));
            thin.offsets.push(thin.radii.len() as u32);
        }
        thin.points = match &stage_snapshot.followers[groom] {
            Some(left) => left.some_points(every, &thin.offsets, &stage_snapshot.colliders),
            None => thin.pick(&stage_snapshot.points[groom]),
        };
        thin
    }

    fn pick(&self, of_all: &[Vec3]) -> Vec<Vec3> {
        self.strands.iter().flat_map(|s| of_all[s.clone()].iter().copied()).collect()
    }
}

/// The parameters of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewParameters {
    /// The camera.
    pub camera: hairspring_scene::Camera,
    /// The camera that the lamps are placed for. It does not rotate with the view, so that the light stays
    /// fixed to the head during orbiting.
    pub lit_for: hairspring_scene::Camera,
    /// Brightness [stops].
    pub exposure: f32,
    /// Factor for the width of drawn hairs.
    pub width: f32,
    /// Stride between the drawn hairs, 1 or more.
    pub every: usize,
    /// Values at the two ends of the color ramp.
    pub range: [f32; 2],
    /// Whether hair is drawn.
    pub hair: bool,
    /// Whether the body is drawn.
    pub body: bool,
    /// Rendering quality.
    pub quality: Quality,
}

/// The state of the simulation that the window shows.
pub struct Snapshot {
    /// Number of the snapshot. A different number means that something changed: the time, or only a color.
    pub number: u64,
    /// Number of steps since the scene was opened.
    pub step: u64,
    /// Number of the scene. A different number means another scene.
    pub scene: u64,
    /// Time in the scene [s].
    pub time: f64,
    /// Number of the frame of 1/60 s, from 0 at time 0.
    pub frame: u64,
    /// The frames that the timeline can return to.
    pub cached: CachedFrames,
    /// The scene, and the one that it is compared with.
    pub stages: Vec<StageSnapshot>,
    /// Total compute time of a frame, for all stages, averaged over some frames.
    pub took: Duration,
    /// Number of strands that were reset since the scene was opened.
    pub reset_strands: usize,
    /// The picked strand and its current figures.
    pub picked: Option<(Picked, StrandFigures)>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairspring_scene::{
        Guides,
        builtin::{self, BuiltinOptions},
    };

    #[test]
    fn roots_placed_separately_match_the_first_points_of_their_hairs() {
        let options = BuiltinOptions { strands: 300, guides: Guides::Count(40), ..BuiltinOptions::default() };
        let mut stage = Stage::new(builtin::scene(&options)).unwrap();
        stage.set_external_interpolation(true);
        (0..5).for_each(|_| _ = stage.step(1.0 / 60.0));
        let still = Arc::new(Still::new(&stage));
        let mut stage_snapshot = StageSnapshot::new(still.clone());
        stage_snapshot.fill(&stage, &still, None);
        for (groom, points) in stage_snapshot.points().enumerate() {
            for strand in 0..still.grooms[groom].strand_count() {
                let root = stage_snapshot.root(groom, strand).unwrap();
                let first = points[still.grooms[groom].strand(strand).start];
                assert!(root.distance(first) < 2e-6, "groom {groom}, strand {strand}: {root}, {first}");
            }
        }
    }
}
