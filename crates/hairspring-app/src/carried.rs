//! Where joints have carried what a scene lists: a collider is written down as it is at rest, and met where the head has taken it.

use hairspring::math::RigidTransform;
use hairspring_scene::stage::Stage;

/// How far each entry of a list has gone since rest, in the order of the scene file.
#[derive(Default)]
pub struct Carried {
    /// Of `[[collider]]`.
    pub colliders: Vec<RigidTransform>,
    /// Of `[[wind_source]]`.
    pub wind_sources: Vec<RigidTransform>,
    /// Of `[[charged]]`, without their own ways.
    pub charged: Vec<RigidTransform>,
    /// Of `[[hand]]`, without their own ways.
    pub hands: Vec<RigidTransform>,
}

impl Carried {
    /// Takes up a stage as it is now.
    pub fn fill(&mut self, stage: &Stage) {
        let scene = stage.scene();
        self.colliders.clear();
        self.colliders.extend(stage.colliders().iter().map(|collider| collider.end));
        let of = |list: &mut Vec<RigidTransform>, names: &mut dyn Iterator<Item = &Option<String>>| {
            list.clear();
            list.extend(names.map(|name| stage.carried(name.as_deref())));
        };
        of(&mut self.wind_sources, &mut scene.wind_sources.iter().map(|s| &s.joint));
        of(&mut self.charged, &mut scene.charged.iter().map(|c| &c.joint));
        of(&mut self.hands, &mut scene.hands.iter().map(|h| &h.joint));
    }
}
