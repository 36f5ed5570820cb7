//! Changes the settings of a running scene.

use super::{Stage, StageError, join_grooms, joints::Joints, wind::StagedWind};
use crate::Scene;
use hairspring::settings::Solver;
#[cfg(doc)]
use hairspring::simulation::Simulation;

impl Stage {
    /// Applies the settings of `settings` to the running scene. The hair keeps its positions and velocities.
    /// From the next step on, everything is as in a scene with these settings.
    ///
    /// Geometry is kept and ignored in `settings`: `grooms[k].groom`, `grooms[k].guides`, `body`,
    /// `collision`, `sheets`, `clip`, `solver.collide_body` and `solver.preroll`. Everything else is applied.
    /// The `radius` of a material only affects the simulated fiber; drawn hairs have the groom's radius.
    ///
    /// - Drag, friction, charge, global shape and tether of a material, and contact, quality and inertia of the
    ///   solver, change in place (see [`Simulation::update_settings`]). If another setting of a material or the
    ///   solver changes, or gravity, volume, neighbors or wind occlusion, rest shapes are computed again. With
    ///   `solver.sag_free`, the groom is then in balance under the new gravity, as it would be from the start.
    ///   Unchanged settings cost nothing.
    /// - The allowed depth of hair in a collider is that of the authored groom: a new collider pushes out all
    ///   hair at once, whatever its `initial`.
    /// - Manipulators of [`Stage::add_manipulator`] stay. A hand of the scene with unchanged settings also
    ///   stays; other hands stop, and new ones begin.
    ///
    /// # Errors
    /// [`StageError::GroomCount`] if the number of grooms differs, [`StageError::NoSuchJoint`],
    /// [`StageError::Settings`] for a setting out of range. In case of an error, nothing changes.
    pub fn update_settings(&mut self, settings: Scene) -> Result<(), StageError> {
        if settings.grooms.len() != self.hair.len() {
            return Err(StageError::GroomCount { settings: settings.grooms.len(), grooms: self.hair.len() });
        }
        settings.validate()?;
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
            self.body.pose_mut().find_cuts(scene);
        }
        if before.wind_sources != scene.wind_sources {
            self.wind = StagedWind::new(joints.wind);
        }
        if before.hands != scene.hands {
            self.hands.update_settings((&before.hands, &scene.hands), joints.hands, &mut self.simulation);
        }
        let between_strands = (before.volume, before.wind_occlusion, before.neighbours)
            != (scene.volume, scene.wind_occlusion, scene.neighbours);
        let [mut changed, mut laid] =
            [(before.gravity, before.solver) != (scene.gravity, scene.solver), false];
        for (hair, groom) in self.hair.iter_mut().zip(grooms) {
            let other = hair.update_settings(groom);
            (changed, laid) = (changed | other.0, laid | other.1);
        }
        let materials = join_grooms::materials(&self.hair);
        let in_place = !between_strands
            && (!changed
                || self
                    .simulation
                    .update_settings(&materials, scene.solver, scene.gravity)
                    .expect("the settings were checked above"));
        if !in_place {
            let mut new =
                join_grooms::simulation(&self.hair, scene, scene.solver, self.body.pose().rest_anchor(), &[]);
            new.take_over(&self.simulation);
            self.simulation = new;
        }
        if laid {
            self.update_render_points();
        }
        Ok(())
    }
}
