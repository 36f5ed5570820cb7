//! What one picture shows: borrowed arrays and settings, no state.

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

/// Strands to draw. Arrays that disagree in length are cut to the shorter; points that are not finite are left out.
#[derive(Clone, Copy, Debug)]
pub struct HairDraw<'a> {
    /// Points of all strands one after the other, root first [m]; shape `[points]`.
    pub points: &'a [Vec3],
    /// Index of each strand's first point, and the end of the last; shape `[strands + 1]`.
    pub offsets: &'a [u32],
    /// Fibre radius at each point [m]; shape `[points]`.
    pub radii: &'a [f32],
    /// Linear RGB at each point, 0 to 1, in place of the look's colours; shape `[points]`, or empty.
    pub colors: &'a [Vec3],
    /// Colour and gloss.
    pub look: &'a HairLook,
    /// Multiplies `radii`: above 1 where few strands stand for many. 1 draws hair as it is.
    pub width_scale: f32,
    /// What places the strands now, where a graphics card shall do it: then of `points` their number is looked at and nothing else. The CPU renderer draws
    /// `points`, whatever stands here. Only where [`Gpu::can_place_among`](crate::gpu::Gpu::can_place_among) its colliders.
    pub follow: Option<HairInterpolation<'a>>,
}

/// A mesh to draw, already posed.
#[derive(Clone, Copy, Debug)]
pub struct MeshDraw<'a> {
    /// Vertex positions [m]; shape `[vertices]`.
    pub positions: &'a [Vec3],
    /// Unit vertex normals; shape `[vertices]`, or empty: flat faces.
    pub normals: &'a [Vec3],
    /// Vertex indices of each triangle; a triangle with an index past the end is left out.
    pub triangles: &'a [[u32; 3]],
    /// Runs of triangles with their colours; triangles in none are skin-coloured.
    pub parts: &'a [Part],
}

/// How much work a picture may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Voxels along the longest side of the hair's shadow volume, 16 to 256. Default 112: about 3 mm on a head.
    pub shadow_voxels: u32,
    /// Side of the bodies' shadow map [texels], 64 to 8192. Default 1024.
    pub shadow_texels: u32,
    /// How far a drawn strand may stray from the smooth curve through its points [pixels], above 0. Default 0.12.
    pub smoothness: f32,
    /// Hairs that each strand is drawn as, 1 to 4: a wisp, in which they lie loosely beside each other and share the strand's light and depth. For pictures of few
    /// strands that stand for many, where one as wide as all of them is a ribbon; such a hair costs a third of a strand. The processor's renderer alone: a
    /// graphics card has time for all strands. Default 1.
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
    /// Where it is seen from.
    pub camera: Camera,
    /// Lamps and sky.
    pub lighting: Lighting,
    /// Backdrop.
    pub background: Background,
    /// What everything stands on; `None`: the backdrop is all there is.
    pub ground: Option<Ground>,
    /// Work to spend.
    pub quality: Quality,
}

impl Frame<'_> {
    /// The ground, if the camera stands above it.
    pub(crate) fn ground_seen(&self) -> Option<Ground> {
        self.ground.filter(|ground| ground.height.is_finite() && camera::eye(&self.camera).y > ground.height)
    }
}

impl<'a> HairDraw<'a> {
    /// A groom as a stage has it now, as wide as it is.
    pub fn of(strands: Strands<'a>) -> Self {
        let Strands { points, groom, look, follow } = strands;
        let (offsets, radii, colors) = (&groom.offsets, &groom.radii, &groom.colors);
        Self { points, offsets, radii, colors, look, width_scale: 1.0, follow }
    }

    /// What places its strands, if that belongs to as many points.
    pub(crate) fn followed(&self) -> Option<HairInterpolation<'a>> {
        self.follow.filter(|f| {
            f.layout.groom.points.len() == self.points.len() && f.carriers.len() == f.guide_points.len()
        })
    }

    /// Number of strands whose points are all there.
    pub(crate) fn strand_count(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Number of segments of all strands.
    pub(crate) fn segment_count(&self) -> u64 {
        (0..self.strand_count()).map(|s| self.range(s).len().saturating_sub(1) as u64).sum()
    }

    /// Points of strand `s`, cut to what the arrays hold.
    pub(crate) fn range(&self, s: usize) -> std::ops::Range<usize> {
        let end = (self.offsets[s + 1] as usize).min(self.points.len()).min(self.radii.len());
        (self.offsets[s] as usize).min(end)..end
    }
}

impl<'a> MeshDraw<'a> {
    /// The body as a stage has it now.
    pub fn of(body: PosedBody<'a>) -> Self {
        let PosedBody { mesh, positions, normals } = body;
        Self { positions, normals, triangles: &mesh.triangles, parts: &mesh.parts }
    }

    /// Whether there is a normal for every vertex.
    pub(crate) fn smooth(&self) -> bool {
        self.normals.len() == self.positions.len()
    }
}
