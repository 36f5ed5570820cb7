//! `[builtin]`: the scene that is made by code.

use super::{Reader, file::BuiltinFile, sentence::unknown};
use crate::{Character, Result};
use hairspring::{
    material::{self, Material},
    scene::{
        Scene,
        builtin::{self, BuiltinOptions, Style},
    },
};

impl Reader<'_> {
    /// The scene, and its body with its motion.
    pub(super) fn builtin(
        &self,
        named: &BuiltinFile,
        materials: Vec<Material>,
    ) -> Result<(Scene, Option<Character>)> {
        let style = match &named.style {
            None => Style::default(),
            Some(name) => Style::from_name(name.get_ref()).ok_or_else(|| {
                let text = format!("the style {}", unknown(name.get_ref(), material::PRESETS));
                self.wrong(name.span().start, "style", text)
            })?,
        };
        let base = BuiltinOptions::new(style);
        let strands = named.strands.as_ref().map_or(base.strands, |n| *n.get_ref());
        let guides = named.guides.unwrap_or(base.guides);
        let mut scene = builtin::scene(&BuiltinOptions { strands, guides, ..base });
        if !materials.is_empty() {
            scene.grooms[0].materials = materials;
        }
        let clips = scene.clip.take().filter(|_| named.motion != Some(false)).into_iter().collect();
        let character = scene.body.take().map(|body| Character { body, clips });
        Ok((scene, character))
    }
}
