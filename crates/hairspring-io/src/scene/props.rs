//! `[[prop]]`: objects that move independently of the body. Each adds a joint after the body's joints, which
//! moves by its own keys. Its mesh becomes part of the body's mesh.

use super::{
    Reader,
    air::lines,
    body::join,
    check::{body_ranges, first_failure, way},
    file::{KeyFile, PropFile, SceneFile},
};
use crate::{Problem, Result};
use hairspring::{
    body::{Body, Clip, Joint, Trs, combine_clips, keyframe_clip},
    settings::check,
};

/// Header of a prop's table.
const HEADER: &str = "[[prop]]";

/// A prop as read from the file.
pub(super) struct Prop {
    name: String,
    mesh: Option<Body>,
    clip: Clip,
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
            let bare = [
                check(mesh.thickness.is_none(), "thickness", "omitted except in [[sheet]]"),
                check(mesh.joint.is_none(), "joint", "omitted: the mesh follows its prop"),
            ];
            first_failure(text, line, &bare)?;
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
            let keys: Vec<_> = prop.keys.iter().map(KeyFile::key).collect();
            props.push(Prop { name: prop.name.clone(), mesh, clip: keyframe_clip(&keys, prop.pivot) });
        }
        Ok(props)
    }
}

/// Returns the body with the meshes and joints of `props` appended.
pub(super) fn with_props(mut body: Body, props: &[Prop]) -> Body {
    for prop in props {
        let joint = body.joints.len() as u16;
        body.joints.push(Joint { name: prop.name.clone(), parent: None, rest: Trs::default() });
        if let Some(skin) = &mut body.skin {
            skin.inverse_bind.push(Default::default());
        }
        if let Some(mesh) = &prop.mesh {
            join(&mut body, mesh.clone(), Some(joint));
        }
    }
    body
}

/// Returns the motion of `body` combined with the motions of `props`.
pub(super) fn beside_props(clip: Option<Clip>, body: Option<&Body>, props: &[Prop]) -> Option<Clip> {
    match body {
        Some(body) if !props.is_empty() => {
            let ways: Vec<Clip> = props.iter().map(|prop| prop.clip.clone()).collect();
            Some(combine_clips(clip, &body.rest_pose(), &ways))
        }
        _ => clip,
    }
}
