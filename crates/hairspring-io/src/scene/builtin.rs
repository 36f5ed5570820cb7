//! `[builtin]`: the procedural scene.

use super::{
    Reader, check,
    file::{BuiltinFile, SceneFile},
    material::{named, over},
    sentence::{line_at, line_of_key, unknown},
};
use crate::Problem;
use hairspring::material;
use hairspring_scene::{
    Scene,
    builtin::{self, BuiltinOptions, Style},
};

/// Returns the options of the built-in scene.
pub(super) fn options(text: &str, file: &BuiltinFile) -> Result<BuiltinOptions, Problem> {
    let style = match &file.style {
        None => Style::default(),
        Some(name) => Style::from_name(name.get_ref()).ok_or_else(|| {
            let from = line_at(text, name.span().start);
            let line = line_of_key(text, from, "style").unwrap_or(from);
            Problem::line(line, format!("the style {}", unknown(name.get_ref(), material::PRESETS)))
        })?,
    };
    let base = BuiltinOptions::new(style);
    let strands = file.strands.as_ref().map_or(base.strands, |n| *n.get_ref());
    let guides = file.guides.unwrap_or(base.guides);
    Ok(BuiltinOptions { strands, guides, ..base })
}

/// Returns the settings of the style, overridden by those in `file`.
pub(super) fn settings(text: &str, scene: &SceneFile, file: &BuiltinFile) -> Result<Scene, Problem> {
    let mut made = builtin::settings(&options(text, file)?);
    let start = text.find("[builtin]").unwrap_or(0);
    let hair = &mut made.grooms[0];
    let materials = named(text, scene, file.material.as_ref(), start)?;
    if !materials.is_empty() {
        hair.materials = materials;
    }
    if let Some(look) = &file.look {
        let start = look.span().start;
        hair.look = over(text, start, "builtin.look", &hair.look, look.get_ref().clone())?;
        check::in_range(text, line_at(text, start), &hair.look)?;
    }
    hair.effects = file.effects;
    check::in_range(text, line_at(text, start), &hair.effects)?;
    Ok(made)
}

impl Reader<'_> {
    /// Builds the scene.
    pub(super) fn builtin(&mut self, file: &BuiltinFile) -> crate::Result<Scene> {
        let mut made = builtin::scene(&options(self.text, file).map_err(|p| p.in_file(self.path))?);
        if file.motion == Some(false) {
            made.clip = None;
        }
        self.apply_maps(&file.maps, &mut made.grooms[0].groom, None)?;
        Ok(made)
    }
}
