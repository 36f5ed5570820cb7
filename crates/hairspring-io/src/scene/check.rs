//! Range checks for the values of a scene file: not finite, or outside the documented range of the field.

use super::{
    air,
    file::{BodyFile, KeyFile, SceneFile},
    props,
    sentence::{line_at, line_of_key},
};
use crate::Problem;
use glam::Vec3;
use hairspring::settings::{Validate, above_0, from_0};
use hairspring_scene::{Guides, is_color};

/// A rule of this reader: whether it holds, the key that it is about, and what is expected.
pub(super) type Check = (bool, &'static str, &'static str);

pub(super) fn finite(v: Vec3) -> bool {
    v.is_finite()
}

/// Reports the first check that fails, at the line of its key from line `from` on.
pub(super) fn first_failure(text: &str, from: usize, checks: &[Check]) -> Result<(), Problem> {
    match checks.iter().find(|(holds, ..)| !holds) {
        None => Ok(()),
        Some((_, key, expected)) => {
            let line = line_of_key(text, from, key).unwrap_or(from);
            Err(Problem::line(line, format!("`{key}` must be {expected}")))
        }
    }
}

/// Reports the first value of `settings` outside of its range, at the line of its key from line `from` on.
pub(super) fn in_range(text: &str, from: usize, settings: &impl Validate) -> Result<(), Problem> {
    let checks: Vec<Check> = settings.checks().iter().map(|c| (c.holds, c.key, c.expected)).collect();
    first_failure(text, from, &checks)
}

/// Checks all settings except the materials.
pub(super) fn ranges(text: &str, scene: &SceneFile) -> Result<(), Problem> {
    let section = |name: &str| text.find(name).map_or(1, |at| line_at(text, at));
    if scene.groom.is_empty() && scene.builtin.is_none() {
        return Err(Problem::whole("the scene has no [[groom]]: name one with `file = …`"));
    }
    first_failure(text, 1, &[(finite(scene.gravity), "gravity", "three finite numbers [m/s²]")])?;
    for body in scene.body.iter().chain(&scene.collision) {
        body_ranges(text, body)?;
        let bare = (body.thickness.is_none(), "thickness", "omitted except in [[sheet]]");
        first_failure(text, line_at(text, body.file.span().start), &[bare])?;
    }
    for sheet in &scene.sheet {
        body_ranges(text, sheet)?;
        let thick = (above_0(sheet.thickness), "thickness", "above 0 [m]");
        first_failure(text, line_at(text, sheet.file.span().start), &[thick])?;
    }
    if let Some(builtin) = &scene.builtin {
        let strands = builtin.strands.as_ref().is_none_or(|n| *n.get_ref() <= 10_000_000);
        let checks = [
            (strands, "strands", "0 to 10000000"),
            (builtin.guides != Some(Guides::FromGroom), "guides", "a number above 0 or \"all\""),
        ];
        first_failure(text, section("[builtin]"), &checks)?;
        if scene.body.is_some() || scene.collision.is_some() {
            return Err(Problem::line(
                section("[builtin]"),
                "`[builtin]` has its own body; remove [body] and [collision]",
            ));
        }
    }
    if let Some(clip) = &scene.clip {
        let keys = &clip.keys;
        let [ordered, of_numbers] = way(keys);
        let checks = [
            (keys.is_empty() || clip.file.is_none(), "keys", "omitted if there is a `file`"),
            ordered,
            of_numbers,
            (above_0(clip.scale), "scale", "above 0 [m per unit]"),
            (clip.rate.is_none_or(|r| (0.01..=1e6).contains(&r)), "rate", "0.01 to 1000000 [Hz]"),
            (clip.rate.is_none() || clip.file.is_some(), "rate", "given with a `file`"),
            (clip.pivot.is_none_or(finite), "pivot", "three finite numbers [m]"),
            (clip.facing.is_none_or(f32::is_finite), "facing", "a finite number [degrees]"),
            (
                clip.pivot.is_none() || clip.joint.is_some() || !keys.is_empty(),
                "pivot",
                "omitted without `joint` or `keys`",
            ),
            (clip.rest_frame.is_none() || clip.joint.is_some(), "rest_frame", "omitted without `joint`"),
            (clip.travel.is_none() || clip.joint.is_some(), "travel", "omitted without `joint`"),
            (clip.facing.is_none() || clip.joint.is_some(), "facing", "omitted without `joint`"),
            (
                clip.joint.is_none() || clip.file.is_some(),
                "joint",
                "given with a `file`, the motion that has the joint",
            ),
        ];
        first_failure(text, section("[clip]"), &checks)?;
    }
    props::ranges(text, scene)?;
    for groom in &scene.groom {
        let t = &groom.transform;
        let checks = [
            (above_0(groom.scale), "scale", "above 0 [m per unit]"),
            (finite(t.position), "position", "three finite numbers [m]"),
            (finite(t.rotation), "rotation", "three finite numbers [degrees]"),
            (finite(t.scale) && t.scale.abs().min_element() > 0.0, "scale", "finite and not 0"),
        ];
        let from = line_at(text, groom.start());
        first_failure(text, from, &checks)?;
        in_range(text, from, &groom.look)?;
        in_range(text, from, &groom.effects)?;
        let thicken = &groom.thicken;
        let thickened = [
            (thicken.copies <= 1_000, "copies", "0 to 1000"),
            (from_0(thicken.radius), "radius", "0 or more [m]"),
            (from_0(thicken.tip), "tip", "0 or more"),
        ];
        first_failure(text, line_at(text, groom.start()), &thickened)?;
        if let Some(grow) = &groom.grow {
            let growth = grow.get_ref().growth();
            let grown = [
                ((1..=10_000_000).contains(&growth.strands), "strands", "1 to 10000000"),
                ((3..=256).contains(&growth.points), "points", "3 to 256"),
                (above_0(Some(growth.length)), "length", "above 0 [m]"),
                ((0.0..=1.0).contains(&growth.spread), "spread", "0 to 1"),
                ((0.0..=1.0).contains(&growth.fall), "fall", "0 to 1"),
            ];
            let from = line_at(text, grow.span().start);
            first_failure(text, from, &grown)?;
            if let Some(Err(error)) = grow.get_ref().inside.as_ref().map(Validate::validate) {
                first_failure(text, from, &[(false, "inside", error.expected)])?;
            }
        }
        if groom.file.is_some() == groom.grow.is_some() {
            let line = text.find("[[groom]]").map_or(1, |at| line_at(text, at));
            return Err(Problem::line(line, "a [[groom]] needs `file` or `grow`, and not both"));
        }
    }
    colored_once(text, scene)?;
    for collider in &scene.collider {
        in_range(text, section("[[collider]]"), &collider.shape)?;
    }
    air::ranges(text, scene)?;
    in_range(text, section("[solver]"), &scene.solver)?;
    in_range(text, section("[volume]"), &scene.volume)?;
    in_range(text, section("[neighbours]"), &scene.neighbours)?;
    if let Some(camera) = &scene.camera {
        in_range(text, section("[camera]"), camera)?;
    }
    in_range(text, section("[ground]"), &scene.ground)?;
    let starts = text.match_indices("[[hand]]").map(|(at, _)| line_at(text, at));
    for (hand, from) in scene.hand.iter().zip(starts.chain(std::iter::repeat(1))) {
        in_range(text, from, hand)?;
    }
    Ok(())
}

/// Checks a motion by keys.
pub(super) fn way(keys: &[KeyFile]) -> [Check; 2] {
    let ordered = keys.windows(2).all(|w| w[0].time < w[1].time);
    let inside = |key: &KeyFile| (0.0..=3600.0).contains(&key.time);
    [
        (ordered && keys.iter().all(inside), "keys", "in order of `time`, from 0 to 3600 [s]"),
        (keys.iter().all(|k| finite(k.position) && finite(k.rotation)), "keys", "of finite numbers"),
    ]
}

pub(super) fn body_ranges(text: &str, body: &BodyFile) -> Result<(), Problem> {
    let checks = [
        (above_0(body.scale), "scale", "above 0 [m per unit]"),
        (body.color.is_none_or(is_color), "color", "three numbers from 0 to 1"),
        (body.roughness.is_none_or(|r| (0.0..=1.0).contains(&r)), "roughness", "0 to 1"),
    ];
    first_failure(text, line_at(text, body.file.span().start), &checks)?;
    body.more.iter().try_for_each(|file| body_ranges(text, file))
}

/// Checks that no look sets both melanin and explicit colors.
fn colored_once(text: &str, scene: &SceneFile) -> Result<(), Problem> {
    // A key that is left out already has its default in `scene`; only the text shows which keys are present.
    let Some(Ok(all)) = text.contains("melanin").then(|| text.parse::<toml::Table>()) else { return Ok(()) };
    let grooms = all.get("groom").and_then(toml::Value::as_array).into_iter().flatten();
    let starts = scene.groom.iter().map(|groom| line_at(text, groom.start()));
    let builtin = all.get("builtin").map(|b| (b, text.find("[builtin]").map_or(1, |at| line_at(text, at))));
    for (table, from) in grooms.zip(starts).chain(builtin) {
        let says = |key: &str| table.get("look").is_some_and(|look| look.get(key).is_some());
        if says("melanin") && (says("root_color") || says("tip_color")) {
            let line = line_of_key(text, from, "melanin").or(line_of_key(text, from, "look")).unwrap_or(from);
            let why =
                "a look takes `melanin` or colors (`root_color`, `tip_color`), not both; remove one of them";
            return Err(Problem::line(line, why));
        }
    }
    Ok(())
}
