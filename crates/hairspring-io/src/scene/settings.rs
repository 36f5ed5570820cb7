//! The settings that `Stage::update_settings` applies: a scene without its geometry.

use super::{Reader, builtin, file::SceneFile, material};
use crate::Result;
use hairspring_scene::{Collider, Scene, SceneGroom};
use std::path::Path;

impl Reader<'_> {
    /// Returns all settings; grooms have no strands. The built-in groom comes first.
    pub(super) fn settings(&mut self, file: &SceneFile) -> Result<Scene> {
        let base = match &file.builtin {
            None => Scene::default(),
            Some(named) => builtin::settings(self.text, file, named).map_err(|p| p.in_file(self.path))?,
        };
        let mut grooms = base.grooms;
        for groom in &file.groom {
            let materials = material::of_groom(self.text, file, groom).map_err(|p| p.in_file(self.path))?;
            let stem = groom.file.as_ref().map(|file| stem(file.get_ref()));
            grooms.push(SceneGroom {
                name: groom.name.clone().or(stem).unwrap_or_else(|| "Grown hair".into()),
                materials,
                guides: groom.guides,
                effects: groom.effects,
                look: groom.look.clone(),
                ..SceneGroom::default()
            });
        }
        Ok(Scene {
            name: file.name.clone().unwrap_or_else(|| stem(self.path)),
            grooms,
            colliders: self.colliders(&file.collider)?,
            wind: file.wind,
            wind_sources: file.wind_source.clone(),
            turbulence: file.turbulence,
            wind_occlusion: file.wind_occlusion,
            charged: file.charged.clone(),
            gravity: file.gravity,
            solver: file.solver,
            volume: file.volume,
            neighbours: file.neighbours,
            camera: file.camera.or(base.camera),
            picture: file.picture,
            ground: file.ground,
            hands: file.hand.clone(),
            ..Scene::default()
        })
    }

    /// Returns the colliders, with the points of hulls read from their files.
    fn colliders(&mut self, named: &[Collider]) -> Result<Vec<Collider>> {
        let near = self.text.find("[[collider]]").unwrap_or(0);
        let mut colliders = Vec::with_capacity(named.len());
        for collider in named {
            colliders.push(Collider { shape: self.shape(&collider.shape, near)?, ..collider.clone() });
        }
        Ok(colliders)
    }
}

/// A file's name without folder and extension.
fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
