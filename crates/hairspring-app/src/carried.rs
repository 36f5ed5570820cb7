//! Where joints have carried what a scene lists: a collider is written down as it is at rest, and met where the head has taken it.

use glam::Affine3A;
use hairspring::{collide::Rigid, scene::Scene, stage::Stage};

/// How far each entry of a list has gone since rest, in the order of the scene file.
#[derive(Default)]
pub struct Carried {
    /// Of `[[collider]]`.
    pub colliders: Vec<Rigid>,
    /// Of `[[wind_source]]`.
    pub wind_sources: Vec<Rigid>,
    /// Of `[[charged]]`, without their own ways.
    pub charged: Vec<Rigid>,
    /// Of `[[hand]]`, without their own ways.
    pub hands: Vec<Rigid>,
}

impl Carried {
    /// Takes up a stage as it is now. Of the head dragged by hand, colliders alone know: nobody drags two things at once.
    pub fn fill(&mut self, stage: &Stage) {
        let scene = stage.scene();
        self.colliders.clear();
        self.colliders.extend(stage.colliders().iter().map(|collider| collider.end));
        let joints = Joints::new(stage);
        let of = |list: &mut Vec<Rigid>, names: &mut dyn Iterator<Item = &Option<String>>| {
            list.clear();
            list.extend(names.map(|name| joints.carried(name.as_deref())));
        };
        of(&mut self.wind_sources, &mut scene.wind_sources.iter().map(|s| &s.joint));
        of(&mut self.charged, &mut scene.charged.iter().map(|c| &c.joint));
        of(&mut self.hands, &mut scene.hands.iter().map(|h| &h.joint));
    }
}

/// Joints of the body at rest and now.
struct Joints<'a> {
    scene: &'a Scene,
    rest: Vec<Affine3A>,
    now: Vec<Affine3A>,
}

impl<'a> Joints<'a> {
    /// Of this stage; none where nothing follows a joint.
    fn new(stage: &'a Stage) -> Self {
        let scene = stage.scene();
        let follows = scene.wind_sources.iter().any(|s| s.joint.is_some())
            || scene.charged.iter().any(|c| c.joint.is_some())
            || scene.hands.iter().any(|h| h.joint.is_some());
        let mut joints = Self { scene, rest: Vec::new(), now: Vec::new() };
        if let (true, Some(body)) = (follows, &scene.body) {
            joints.rest = body.world(&body.rest_pose());
            let pose = scene.clip.as_ref().map(|clip| clip.sample(stage.time()));
            joints.now = pose.map_or_else(|| joints.rest.clone(), |pose| body.world(&pose));
        }
        joints
    }

    fn carried(&self, name: Option<&str>) -> Rigid {
        let joint = || {
            let k = self.scene.body.as_ref()?.joint(name?)?;
            Some(Rigid::from_affine(&(*self.now.get(k)? * self.rest.get(k)?.inverse())))
        };
        joint().unwrap_or_default()
    }
}
