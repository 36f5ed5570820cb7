//! Current transforms of the listed objects of a scene. For example, a collider is written at its rest
//! position, but acts where the head has moved it.

use hairspring::math::RigidTransform;
use hairspring_scene::stage::Stage;

/// Motion of each entry of a list since the rest pose, in the order of the scene file.
#[derive(Default)]
pub struct Carried {
    /// For `[[collider]]`.
    pub colliders: Vec<RigidTransform>,
    /// For `[[wind_source]]`.
    pub wind_sources: Vec<RigidTransform>,
    /// For `[[charged]]`, without their own paths.
    pub charged: Vec<RigidTransform>,
    /// For `[[hand]]`, without their own paths.
    pub hands: Vec<RigidTransform>,
}

impl Carried {
    /// Updates the transforms from the current state of a stage.
    pub fn fill(&mut self, stage: &Stage) {
        let scene = stage.scene();
        self.colliders.clear();
        self.colliders.extend(stage.scene_colliders().iter().map(|collider| collider.end));
        let of = |list: &mut Vec<RigidTransform>, names: &mut dyn Iterator<Item = &Option<String>>| {
            list.clear();
            list.extend(names.map(|name| stage.carried(name.as_deref())));
        };
        of(&mut self.wind_sources, &mut scene.wind_sources.iter().map(|s| &s.joint));
        of(&mut self.charged, &mut scene.charged.iter().map(|c| &c.joint));
        of(&mut self.hands, &mut scene.hands.iter().map(|h| &h.joint));
    }
}
