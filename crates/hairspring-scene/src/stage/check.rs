//! What a scene must fulfill to be played, and the errors of one that does not.

use super::body_pose::anchor_joint;
use crate::{Scene, SceneError, SceneGroom};
use glam::{Affine3A, Vec3};
use hairspring::{
    body::{Body, Clip, Trs},
    groom::{Groom, Imprecise, MAX_COORDINATE, first_imprecise, first_imprecise_moved},
    math::RigidTransform,
    settings::{OutOfRange, Validate},
};

/// Errors of a scene that cannot be played.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StageError {
    /// The scene has no strands at all.
    #[error("the scene has no hair: add a groom with at least one strand")]
    NoHair,
    /// A strand cannot be simulated.
    #[error(
        "strand {strand} of groom {groom} has {points} points, and 3 are needed: run `groom::sanitize` first"
    )]
    ShortStrand {
        /// Index of the groom in the scene.
        groom: usize,
        /// Index of the strand.
        strand: usize,
        /// Number of points that it has.
        points: usize,
    },
    /// A radius is not finite and above 0.
    #[error("point {point} of groom {groom} has the radius {radius} m: run `groom::sanitize` first")]
    Radius {
        /// Index of the groom in the scene.
        groom: usize,
        /// Index of the point in the groom.
        point: usize,
        /// The radius [m].
        radius: f32,
    },
    /// A multiplier of a strand is out of range.
    #[error("the multipliers of strand {strand} of groom {groom}: {error}")]
    Multiplier {
        /// Index of the groom in the scene.
        groom: usize,
        /// Index of the strand.
        strand: usize,
        /// The multiplier.
        error: OutOfRange,
    },
    /// The clip does not belong to the body.
    #[error(
        "the clip '{clip}' moves {clip_joints} joints, and the body has {body_joints}: retarget it to the body"
    )]
    JointCount {
        /// Name of the clip.
        clip: String,
        /// Number of joints in the clip.
        clip_joints: usize,
        /// Joints of the body.
        body_joints: usize,
    },
    /// A frame of the vertex cache has another number of vertices than the body.
    #[error(
        "frame {frame} of the vertex cache has {vertices} vertices, and the body has {expected}: export the motion without \
         changes of topology"
    )]
    VertexCount {
        /// Index of the frame.
        frame: usize,
        /// Number of its vertices.
        vertices: usize,
        /// Number of the body's vertices.
        expected: usize,
    },
    /// The vertex cache cannot move the body.
    #[error("the vertex cache cannot be used: {0}")]
    VertexCache(&'static str),
    /// The settings have another number of grooms than the stage.
    #[error(
        "the settings have {settings} grooms, but the stage has {grooms}: create a new stage for other grooms"
    )]
    GroomCount {
        /// Number of grooms in the settings.
        settings: usize,
        /// Number of grooms on the stage.
        grooms: usize,
    },
    /// A setting is out of range.
    #[error(transparent)]
    Settings(#[from] SceneError),
    /// A strand is too far from the origin for single precision.
    #[error("groom {groom}: {why}")]
    TooFar {
        /// Index of the groom in the scene.
        groom: usize,
        /// The strand and its distance.
        why: Imprecise,
    },
    /// The clip moves a strand too far from the origin for single precision.
    #[error("groom {groom}, in frame {frame} of the clip '{clip}': {why}")]
    MovedTooFar {
        /// Index of the groom in the scene.
        groom: usize,
        /// Index of the frame.
        frame: usize,
        /// Name of the clip.
        clip: String,
        /// The strand and its distance.
        why: Imprecise,
    },
    /// A coordinate or length is not finite or too large.
    #[error("{what} is not finite or exceeds {MAX_COORDINATE} m, the largest length that is simulated")]
    OutOfRange {
        /// Description of the item.
        what: String,
    },
    /// The joint that carries the hair has no size along an axis, so that its rotation is unknown.
    #[error("the joint '{joint}' carries the hair and has a scale of 0{when}: give it a scale above 0")]
    FlatJoint {
        /// Name of the joint.
        joint: String,
        /// The frame of the clip, or empty for the rest pose.
        when: String,
    },
    /// An item names a joint that does not exist.
    #[error("{what} follows the joint '{joint}', and the body has none of that name")]
    NoSuchJoint {
        /// Description of the item that names the joint.
        what: &'static str,
        /// Name of the joint.
        joint: String,
    },
}

/// Checks a scene before it is played.
pub(super) fn check(scene: &Scene) -> Result<(), StageError> {
    if scene.grooms.iter().all(|g| g.groom.strand_count() == 0) {
        return Err(StageError::NoHair);
    }
    for (g, groom) in scene.grooms.iter().enumerate() {
        let groom = &groom.groom;
        if let Some(strand) = (0..groom.strand_count()).find(|s| groom.range(*s).len() < 3) {
            let points = groom.range(strand).len();
            return Err(StageError::ShortStrand { groom: g, strand, points });
        }
        if let Some(why) = first_imprecise(groom) {
            return Err(StageError::TooFar { groom: g, why });
        }
        check_fibers(g, groom)?;
        in_range(&format!("a point of groom {g}"), &groom.points)?;
    }
    scene.validate()?;
    if let Some(body) = &scene.body {
        in_range("a vertex of the body", &body.mesh.positions)?;
    }
    if let Some(clip) = &scene.clip {
        let translations = clip.samples.iter().map(|joint| &joint.translation);
        in_range("a translation of the clip", translations)?;
    }
    if let (Some(clip), Some(body)) = (&scene.clip, &scene.body)
        && clip.joint_count != body.joints.len()
    {
        return Err(StageError::JointCount {
            clip: clip.name.clone(),
            clip_joints: clip.joint_count,
            body_joints: body.joints.len(),
        });
    }
    check_vertex_cache(scene)
}

/// Checks that the joint that carries the hair has a rotation, at rest and in each frame of the clip. The roots must be bound
/// to the body, and the scene checked otherwise.
pub(super) fn check_anchor(scene: &Scene) -> Result<(), StageError> {
    let Some(body) = &scene.body else { return Ok(()) };
    let anchor = anchor_joint(body, &scene.grooms);
    let is_flat = |pose: &[Trs]| {
        let world = body.world(pose);
        world.get(anchor).is_some_and(|joint| !RigidTransform::from_affine(joint).rotation.is_finite())
    };
    let flat = |when: String| StageError::FlatJoint { joint: body.joints[anchor].name.clone(), when };
    if is_flat(&body.rest_pose()) {
        return Err(flat(String::new()));
    }
    let Some(clip) = &scene.clip else { return Ok(()) };
    let mut frames = clip.samples.chunks_exact(clip.joint_count.max(1));
    match frames.position(is_flat) {
        Some(frame) => Err(flat(format!(" in frame {frame} of the clip '{}'", clip.name))),
        None => Ok(()),
    }
}

/// Checks that the clip does not move a groom so far from the origin that the groom would be refused there. The
/// roots must be bound to the body, and the scene checked otherwise.
pub(super) fn check_motion(scene: &Scene) -> Result<(), StageError> {
    let (Some(body), Some(clip)) = (&scene.body, &scene.clip) else { return Ok(()) };
    for (groom, scene_groom) in scene.grooms.iter().enumerate() {
        let Some((frame, by)) = farthest_pose(body, clip, scene_groom) else { continue };
        if let Some(why) = first_imprecise_moved(&scene_groom.groom, &by) {
            return Err(StageError::MovedTooFar { groom, frame, clip: clip.name.clone(), why });
        }
    }
    Ok(())
}

/// Returns the frame of `clip` in which a groom is farthest from the origin, and the motion of the groom since rest.
/// `None` for a groom without points and a clip without frames.
fn farthest_pose(body: &Body, clip: &Clip, groom: &SceneGroom) -> Option<(usize, Affine3A)> {
    let joint = anchor_joint(body, std::slice::from_ref(groom));
    let rest = body.world(&body.rest_pose()).get(joint)?.inverse();
    let root = groom.groom.points.first()?;
    let pose = |(frame, pose)| (frame, body.world(pose)[joint] * rest);
    let distance = |by: &Affine3A| by.transform_point3(*root).abs().max_element();
    let frames = clip.samples.chunks_exact(clip.joint_count.max(1)).enumerate().map(pose);
    frames.max_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)))
}

/// Checks radii and multipliers, which a scene made by code may have of any value.
fn check_fibers(g: usize, groom: &Groom) -> Result<(), StageError> {
    if let Some(point) = groom.radii.iter().position(|radius| !(radius.is_finite() && *radius > 0.0)) {
        return Err(StageError::Radius { groom: g, point, radius: groom.radii[point] });
    }
    let wrong = (0..groom.scales.len()).find_map(|s| Some((s, groom.scale(s).validate().err()?)));
    wrong.map_or(Ok(()), |(strand, error)| Err(StageError::Multiplier { groom: g, strand, error }))
}

fn check_vertex_cache(scene: &Scene) -> Result<(), StageError> {
    let Some(cache) = &scene.vertex_cache else { return Ok(()) };
    let Some(body) = &scene.body else {
        return Err(StageError::VertexCache("the scene has no body"));
    };
    if body.skin.is_some() || scene.clip.is_some() {
        return Err(StageError::VertexCache(
            "the body already moves by a skeleton; remove one of the two motions",
        ));
    }
    if !(cache.rate.is_finite() && cache.rate > 0.0) {
        return Err(StageError::VertexCache("its frame rate is not above 0"));
    }
    if cache.frames.is_empty() {
        return Err(StageError::VertexCache("it has no frames"));
    }
    let expected = body.mesh.positions.len();
    if let Some(frame) = cache.frames.iter().position(|frame| frame.len() != expected) {
        return Err(StageError::VertexCount { frame, vertices: cache.frames[frame].len(), expected });
    }
    in_range("a vertex of the vertex cache", cache.frames.iter().flatten())
}

/// Rejects coordinates that are not finite or beyond [`MAX_COORDINATE`].
fn in_range<'a>(what: &str, coordinates: impl IntoIterator<Item = &'a Vec3>) -> Result<(), StageError> {
    let inside = |p: &Vec3| p.abs().cmple(Vec3::splat(MAX_COORDINATE)).all();
    match coordinates.into_iter().all(inside) {
        true => Ok(()),
        false => Err(StageError::OutOfRange { what: what.into() }),
    }
}
