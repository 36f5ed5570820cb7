//! The content of one picture: borrowed arrays and settings, without state.

use crate::{
    camera,
    ground::Ground,
    lighting::{Background, Lighting},
};
use glam::Vec3;
use hairspring::{body::Part, follow::HairInterpolation};
use hairspring_scene::{
    Camera, HairLook,
    stage::{PosedBody, Strands},
};

/// Strands to draw. If arrays differ in length, the shorter one counts. Points that are not finite are
/// skipped.
#[derive(Clone, Copy, Debug)]
pub struct HairDraw<'a> {
    /// Points of all strands one after the other, root first [m]; shape `[points]`.
    pub points: &'a [Vec3],
    /// Index of each strand's first point, and the end of the last; shape `[strands + 1]`.
    pub offsets: &'a [u32],
    /// Fiber radius at each point [m]; shape `[points]`.
    pub radii: &'a [f32],
    /// Linear RGB at each point, 0 to 1, used instead of the look's colors; shape `[points]`, or empty.
    pub colors: &'a [Vec3],
    /// Color and gloss.
    pub look: &'a HairLook,
    /// Multiplies `radii`. Values above 1 are used if few strands represent many. 1 draws hair as it is.
    pub width_scale: f32,
    /// Interpolation data with which a GPU can compute the strands' points itself. If it is used, only the
    /// length of `points` matters. The CPU renderer always draws `points`. Requires that
    /// [`Gpu::can_place_among`](crate::gpu::Gpu::can_place_among) accepts the colliders.
    pub follow: Option<HairInterpolation<'a>>,
}

/// A mesh to draw, already posed.
#[derive(Clone, Copy, Debug)]
pub struct MeshDraw<'a> {
    /// Vertex positions [m]; shape `[vertices]`.
    pub positions: &'a [Vec3],
    /// Unit vertex normals; shape `[vertices]`, or empty for flat faces.
    pub normals: &'a [Vec3],
    /// Vertex indices of each triangle. Triangles with an index past the end are skipped.
    pub triangles: &'a [[u32; 3]],
    /// Runs of triangles with their colors. Triangles in no part are skin-colored.
    pub parts: &'a [Part],
}

/// How much work a picture may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Voxels along the longest side of the hair's shadow volume, 16 to 256. Default 112: about 3 mm on a head.
    pub shadow_voxels: u32,
    /// Side of the bodies' shadow map [texels], 64 to 8192. Default 1024.
    pub shadow_texels: u32,
    /// Maximum distance between a drawn strand and the smooth curve through its points [pixels], above 0.
    /// Default 0.12.
    pub smoothness: f32,
    /// Number of hairs that each strand is drawn as, 1 to 4: a wisp of loosely parallel hairs that share the
    /// strand's light and depth. It is meant for pictures of few strands that represent many, where a single
    /// wide strand would look like a ribbon. Such a hair costs a third of a strand. Only the CPU renderer
    /// supports it; a GPU is fast enough to draw all strands. Default 1.
    pub wisp: u32,
}

impl Default for Quality {
    fn default() -> Self {
        Self { shadow_voxels: 112, shadow_texels: 1024, smoothness: 0.12, wisp: 1 }
    }
}

/// One picture.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The hairstyles.
    pub hair: &'a [HairDraw<'a>],
    /// The bodies.
    pub bodies: &'a [MeshDraw<'a>],
    /// The camera.
    pub camera: Camera,
    /// Lamps and sky.
    pub lighting: Lighting,
    /// Backdrop.
    pub background: Background,
    /// The ground; `None` shows only the backdrop.
    pub ground: Option<Ground>,
    /// Quality settings.
    pub quality: Quality,
}

/// Where points were in an earlier frame, for motion vectors.
#[derive(Clone, Copy, Debug)]
pub struct Before<'a> {
    /// The camera.
    pub camera: Camera,
    /// Points of each hairstyle [m]; shape as in [`HairDraw::points`]. What is missing did not move.
    pub hair: &'a [&'a [Vec3]],
    /// Vertices of each body [m]; shape as in [`MeshDraw::positions`]. What is missing did not move.
    pub bodies: &'a [&'a [Vec3]],
}

impl Frame<'_> {
    /// The ground, if the camera is above it.
    pub(crate) fn ground_seen(&self) -> Option<Ground> {
        self.ground.filter(|ground| ground.height.is_finite() && camera::eye(&self.camera).y > ground.height)
    }
}

impl<'a> HairDraw<'a> {
    /// The strands of a stage in their current state, at their own width.
    pub fn of(strands: Strands<'a>) -> Self {
        let Strands { points, groom, look, follow } = strands;
        let (offsets, radii, colors) = (&groom.offsets, &groom.radii, &groom.colors);
        Self { points, offsets, radii, colors, look, width_scale: 1.0, follow }
    }

    /// The interpolation data of the strands, if it has the same number of points.
    pub(crate) fn followed(&self) -> Option<HairInterpolation<'a>> {
        self.follow.filter(|f| {
            f.layout.groom.points.len() == self.points.len()
                && f.guide_transforms.len() == f.guide_points.len()
        })
    }

    /// Number of strands.
    pub(crate) fn strand_count(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Number of segments of all strands.
    pub(crate) fn segment_count(&self) -> u64 {
        (0..self.strand_count()).map(|s| self.range(s).len().saturating_sub(1) as u64).sum()
    }

    /// Points of strand `s`, clamped to the length of the arrays.
    pub(crate) fn range(&self, s: usize) -> std::ops::Range<usize> {
        let end = (self.offsets[s + 1] as usize).min(self.points.len()).min(self.radii.len());
        (self.offsets[s] as usize).min(end)..end
    }
}

impl<'a> MeshDraw<'a> {
    /// The body of a stage in its current state.
    pub fn of(body: PosedBody<'a>) -> Self {
        let PosedBody { mesh, positions, normals } = body;
        Self { positions, normals, triangles: &mesh.triangles, parts: &mesh.parts }
    }

    /// Whether every vertex has a normal.
    pub(crate) fn smooth(&self) -> bool {
        self.normals.len() == self.positions.len()
    }
}
