//! `[[prop]]`: objects with a motion of their own. Each adds a joint after the body's joints, which moves by its
//! own keys, in the world or relative to a joint that carries it. Its mesh becomes part of the body's mesh.

use super::{
    Reader,
    air::lines,
    body::join,
    check::{body_ranges, first_failure, way, without_sheet_fields},
    file::{KeyFile, PropFile, SceneFile},
    sentence::unknown,
};
use crate::{Problem, Result};
use glam::{Affine3A, Vec3};
use hairspring::{
    body::{Body, Clip, Joint, KEYED_RATE, Key, Trs, combine_clips, keyframe_clip},
    settings::check,
};

/// Header of a prop's table.
const HEADER: &str = "[[prop]]";

/// A prop as read from the file.
pub(super) struct Prop {
    name: String,
    mesh: Option<Body>,
    /// The keys of its motion from rest, in the space of the body at rest, and the point that it turns about.
    keys: Vec<Key>,
    pivot: Vec3,
    /// The joint that carries it.
    joint: Option<String>,
}

/// Checks all `[[prop]]` tables.
pub(super) fn ranges(text: &str, scene: &SceneFile) -> std::result::Result<(), Problem> {
    for (k, (prop, line)) in scene.prop.iter().zip(lines(text, HEADER)).enumerate() {
        let alone = scene.prop[..k].iter().all(|other| !other.name.eq_ignore_ascii_case(&prop.name));
        let [ordered, of_numbers] = way(&prop.keys);
        let checks = [
            check(alone && !prop.name.is_empty(), "name", "non-empty and unique"),
            ordered,
            of_numbers,
            PropFile::check("pivot", &prop.pivot),
        ];
        first_failure(text, line, &checks)?;
        if let Some(mesh) = &prop.mesh {
            body_ranges(text, mesh)?;
            first_failure(text, line, &without_sheet_fields(mesh))?;
            let bare = check(mesh.joint.is_none(), "joint", "omitted: the mesh follows its prop");
            first_failure(text, line, &[bare])?;
        }
    }
    Ok(())
}

impl Reader<'_> {
    /// Reads the props of the scene, which are added to `body`.
    pub(super) fn props(&mut self, named: &[PropFile], body: Option<&Body>) -> Result<Vec<Prop>> {
        let near = self.text.find(HEADER).unwrap_or(0);
        let mut props = Vec::with_capacity(named.len());
        for prop in named {
            let Some(body) = body else {
                let text = "[[prop]] needs a body, but there is no [body]".into();
                return Err(self.wrong(near, "name", text));
            };
            if body.joint(&prop.name).is_some() {
                let text =
                    format!("the body has a joint {:?} already; choose another name for the prop", prop.name);
                return Err(self.wrong(near, "name", text));
            }
            let mesh = prop.mesh.as_ref().map(|mesh| self.body(mesh, "prop")).transpose()?.map(|c| c.body);
            let keys = prop.keys.iter().map(KeyFile::key).collect();
            let (name, joint) = (prop.name.clone(), prop.joint.clone());
            props.push(Prop { name, mesh, keys, pivot: prop.pivot, joint });
        }
        Ok(props)
    }

    /// Checks that the joints which carry `props` exist among those of `body` and of the props before them.
    pub(super) fn prop_joints(&self, body: Option<&Body>, props: &[Prop]) -> Result<()> {
        let mut known: Vec<&str> = body.iter().flat_map(|b| &b.joints).map(|j| j.name.as_str()).collect();
        for prop in props {
            if let Some(joint) = &prop.joint
                && !known.iter().any(|name| name.eq_ignore_ascii_case(joint))
            {
                let text = format!("the joint {}", unknown(joint, known.into_iter()));
                return Err(self.wrong(self.text.find(HEADER).unwrap_or(0), "joint", text));
            }
            known.push(&prop.name);
        }
        Ok(())
    }
}

/// Returns the transform of `prop` relative to the joint of `body` that carries it, if there is one, while the body is
/// at rest.
fn carrier(body: &Body, prop: &Prop) -> (Option<u32>, Affine3A) {
    match prop.joint.as_ref().and_then(|name| body.joint(name)) {
        Some(joint) => (Some(joint as u32), body.world(&body.rest_pose())[joint].inverse()),
        None => (None, Affine3A::IDENTITY),
    }
}

/// Returns a transform as translation, rotation and scale.
fn trs(transform: Affine3A) -> Trs {
    let (scale, rotation, translation) = transform.to_scale_rotation_translation();
    Trs { translation, rotation, scale }
}

/// Returns the body with the meshes and joints of `props` appended.
pub(super) fn with_props(mut body: Body, props: &[Prop]) -> Body {
    for prop in props {
        let joint = body.joints.len() as u16;
        let (parent, rest) = carrier(&body, prop);
        body.joints.push(Joint { name: prop.name.clone(), parent, rest: trs(rest) });
        if let Some(skin) = &mut body.skin {
            skin.inverse_bind.push(Default::default());
        }
        if let Some(mesh) = &prop.mesh {
            join(&mut body, mesh.clone(), Some(joint));
        }
    }
    body
}

/// Returns the motion of the joints of `body` without `props`, combined with the motions of `props`. `whole` is the
/// body with the props. `teleport_distance` [m] decides which keys are cuts.
pub(super) fn beside_props(
    clip: Option<Clip>,
    (body, whole): (&Body, &Body),
    props: &[Prop],
    teleport_distance: f32,
) -> Option<Clip> {
    if props.is_empty() {
        return clip;
    }
    // At the rate of the body's motion, so that a cut is not interpolated between frames.
    let rate = clip.as_ref().map_or(KEYED_RATE, |clip| clip.rate);
    let motion = |prop: &Prop| {
        let (_, relative) = carrier(whole, prop);
        let mut clip = keyframe_clip(&prop.keys, prop.pivot, rate, teleport_distance);
        clip.samples.iter_mut().for_each(|sample| *sample = trs(relative * sample.to_affine()));
        clip
    };
    let motions: Vec<Clip> = props.iter().map(motion).collect();
    Some(combine_clips(clip, &body.rest_pose(), &motions))
}
