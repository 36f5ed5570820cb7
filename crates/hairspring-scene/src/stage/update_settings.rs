//! Other settings in the midst of the play.

use super::{Stage, StageError, check_effects, join_grooms, joints::Joints, wind::StagedWind};
use crate::Scene;
use hairspring::settings::Solver;

impl Stage {
    /// Takes up the settings of `settings` in the midst of the play: hair stays where it is and goes on moving as it does, and from the next step on
    /// everything is as in a scene of these settings.
    ///
    /// Geometry stays and is not looked at: `grooms[k].groom`, `grooms[k].guides`, `body`, `collision`, `sheets`, `clip`, `solver.collide_body` and `solver.preroll`. All else
    /// is taken up. A material's `radius` is that of the simulated fibre alone: what is drawn has the groom's.
    ///
    /// - Where materials, gravity, solver, volume, neighbours or shelter change, rest shapes are found anew: with `solver.sag_free`, the groom is in balance under the
    ///   new gravity, as it would be from the start. What did not change costs nothing.
    /// - How deep hair may be in a collider is what it was authored with: a collider that is new pushes out all hair.
    /// - Tools of [`Stage::take`] go on. So does a hand of the scene whose settings are still there; others let go, and new ones begin.
    ///
    /// # Errors
    /// [`StageError::GroomCount`] where there are more or fewer grooms, [`StageError::NoSuchJoint`],
    /// [`StageError::OutOfRange`] for effects that are too large; nothing changes then.
    pub fn update_settings(&mut self, settings: Scene) -> Result<(), StageError> {
        if settings.grooms.len() != self.hair.len() {
            return Err(StageError::GroomCount { settings: settings.grooms.len(), grooms: self.hair.len() });
        }
        check_effects(&settings)?;
        let joints = Joints::new(&settings, self.scene.body.as_ref())?;
        let before = std::mem::take(&mut self.scene);
        self.scene = Scene {
            body: before.body,
            collision: before.collision,
            sheets: before.sheets,
            clip: before.clip,
            solver: Solver {
                collide_body: before.solver.collide_body,
                preroll: before.solver.preroll,
                ..settings.solver
            },
            ..settings
        };
        let grooms = std::mem::take(&mut self.scene.grooms);
        let scene = &self.scene;
        if (&before.colliders, &before.charged) != (&scene.colliders, &scene.charged) {
            self.body.update_settings(scene, &joints, self.clock.time());
        }
        if before.solver.teleport_distance != scene.solver.teleport_distance {
            self.body.find_cuts(scene);
        }
        if before.wind_sources != scene.wind_sources {
            self.wind = StagedWind::new(joints.wind);
        }
        if before.hands != scene.hands {
            self.hands.update_settings((&before.hands, &scene.hands), joints.hands, &mut self.simulation);
        }
        let rests = |scene: &Scene| {
            (scene.gravity, scene.solver, scene.volume, scene.wind_occlusion, scene.neighbours)
        };
        let fresh = (before.gravity, before.solver, before.volume, before.wind_occlusion, before.neighbours)
            != rests(scene);
        let [mut made, mut laid] = [fresh, false];
        for (hair, groom) in self.hair.iter_mut().zip(grooms) {
            let other = hair.update_settings(groom);
            (made, laid) = (made | other.0, laid | other.1);
        }
        if made {
            let mut new =
                join_grooms::simulation(&self.hair, scene, scene.solver, self.body.rest_anchor(), &[]);
            new.take_over(&self.simulation);
            self.simulation = new;
        }
        if laid {
            self.update_render_points();
        }
        Ok(())
    }
}
