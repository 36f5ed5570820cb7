//! Joints that share a name which the scene uses.

use super::{Reader, file::SceneFile};
use hairspring::body::Joint;
use hairspring_scene::Scene;
use std::collections::BTreeSet;

impl Reader<'_> {
    /// Notes the names in a scene that several of the body's `joints` have.
    pub(super) fn note_namesakes(&mut self, file: &SceneFile, scene: &Scene, joints: &[Joint]) {
        let meshes = file.body.iter().flat_map(|body| &body.more).chain(&file.collision).chain(&file.sheet);
        let of_files = meshes
            .map(|mesh| &mesh.joint)
            .chain(
                file.groom.iter().filter_map(|groom| groom.grow.as_ref()).map(|grow| &grow.get_ref().joint),
            )
            .chain(file.prop.iter().map(|prop| &prop.joint));
        let of_settings = scene
            .colliders
            .iter()
            .map(|collider| &collider.joint)
            .chain(scene.wind_sources.iter().map(|source| &source.joint))
            .chain(scene.charged.iter().map(|charged| &charged.joint))
            .chain(scene.hands.iter().map(|hand| &hand.joint));
        let names: BTreeSet<&str> = of_files.chain(of_settings).filter_map(|name| name.as_deref()).collect();
        self.notes.extend(names.into_iter().filter_map(|name| namesakes(joints, name, "body")));
    }
}

/// A note if several joints of a body or a motion have a `name`.
pub(super) fn namesakes(joints: &[Joint], name: &str, owner: &str) -> Option<String> {
    let mut same = joints.iter().filter(|joint| joint.name.eq_ignore_ascii_case(name));
    let first = same.next()?;
    let others = same.count();
    let place = match first.parent {
        Some(parent) => format!("below {:?}", joints[parent as usize].name),
        None => "which has no parent".into(),
    };
    (others > 0).then(|| {
        format!(
            "the {owner} has {} joints called {name:?}, and the first, {place}, is used; rename it in the modeling program to use another",
            others + 1
        )
    })
}
