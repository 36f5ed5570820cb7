//! The settings that `Stage::update_settings` applies: a scene without its geometry.

use super::{Reader, builtin, file::SceneFile, material};
use crate::{Format, Result, text};
use glam::Vec3;
use hairspring_scene::{Collider, Scene, SceneGroom, Shape};
use std::path::Path;

/// Whether the portrait of the built-in head shows everything that moves: its own hair in its own motion, without wind.
fn is_portrait(file: &SceneFile) -> bool {
    let SceneFile { groom, clip, prop, wind, wind_source, .. } = file;
    let is_calm = wind.velocity == Vec3::ZERO && wind_source.is_empty();
    is_calm && groom.is_empty() && clip.is_none() && prop.is_empty()
}

impl Reader<'_> {
    /// Returns all settings; grooms have no strands. The built-in groom comes first.
    pub(super) fn settings(&mut self, file: &SceneFile) -> Result<Scene> {
        let body_file = file.body.iter().map(|body| &body.file);
        let moving = body_file.chain(file.clip.iter().filter_map(|clip| clip.file.as_ref()));
        self.played = moving.map(|name| self.resolve(name)).collect();
        let base = match &file.builtin {
            None => Scene::default(),
            Some(named) => builtin::settings(self.text, file, named).map_err(|p| p.in_file(self.path))?,
        };
        let mut grooms = base.grooms;
        for groom in &file.groom {
            let materials = material::of_groom(self.text, file, groom).map_err(|p| p.in_file(self.path))?;
            let stem = groom.file.as_ref().map(|file| stem(file.get_ref()));
            grooms.push(SceneGroom {
                name: text::name(&groom.name.clone().or(stem).unwrap_or_else(|| "Grown hair".into())),
                materials,
                guides: groom.guides,
                effects: groom.effects,
                look: groom.look.clone(),
                ..SceneGroom::default()
            });
        }
        self.find_unit_of_hulls(file);
        Ok(Scene {
            name: text::name(&file.name.clone().unwrap_or_else(|| stem(self.path))),
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
            camera: file.camera.or(base.camera.filter(|_| is_portrait(file))),
            picture: file.picture,
            ground: file.ground,
            hands: file.hand.clone(),
            ..Scene::default()
        })
    }

    /// Reads the unit of the body, if there are hulls whose files may have the same one. What is wrong with the body's
    /// file is reported where the body is read.
    fn find_unit_of_hulls(&mut self, file: &SceneFile) {
        let is_open = |shape: &Shape| match shape {
            Shape::Hull { file: Some(file), scale: None, .. } => {
                matches!(Format::of(file), Some(Format::Obj | Format::TfxMesh))
            }
            _ => false,
        };
        if let Some(named) = &file.body
            && file.collider.iter().any(|collider| is_open(&collider.shape))
        {
            let mut reader = Reader::new(self.path, self.text, self.grooms);
            if reader.piece(named, "body").is_ok() {
                self.whole = reader.whole;
            }
        }
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
