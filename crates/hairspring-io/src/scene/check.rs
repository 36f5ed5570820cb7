//! Range checks for the values of a scene file: not finite, or outside the documented range of the field.

use super::{
    air::{self, lines},
    file::{BodyFile, BuiltinFile, ClipFile, KeyFile, PropFile, SceneFile},
    groom_file::{GroomFile, Placement, Reverse},
    map_file::{Channel, MapsFile},
    props,
    sentence::{line_at, line_of_key, line_of_setting},
};
use crate::Problem;
use glam::Vec3;
use hairspring::settings::{Check, Validate, check, with_prefix};
use hairspring_scene::Guides;

/// Reports the first check that fails, at the line of its key from line `from` on.
pub(super) fn first_failure(text: &str, from: usize, checks: &[Check]) -> Result<(), Problem> {
    match checks.iter().find(|check| !check.holds) {
        None => Ok(()),
        Some(Check { key, expected, .. }) => {
            let line = line_of_setting(text, from, key).unwrap_or(from);
            Err(Problem::line(line, format!("`{key}` must be {expected}")))
        }
    }
}

/// Reports the first value of `settings` outside of its range, at the line of its key from line `from` on.
pub(super) fn in_range(text: &str, from: usize, settings: &impl Validate) -> Result<(), Problem> {
    first_failure(text, from, &settings.checks())
}

/// Checks all settings except the materials.
pub(super) fn ranges(text: &str, scene: &SceneFile) -> Result<(), Problem> {
    let section = |name: &str| text.find(name).map_or(1, |at| line_at(text, at));
    if scene.groom.is_empty() && scene.builtin.is_none() {
        return Err(Problem::whole("the scene has no [[groom]]: name one with `file = …`"));
    }
    first_failure(text, 1, &[SceneFile::check("gravity", &scene.gravity)])?;
    for body in scene.body.iter().chain(&scene.collision) {
        body_ranges(text, body)?;
        first_failure(text, line_at(text, body.file.span().start), &without_sheet_fields(body))?;
    }
    for sheet in &scene.sheet {
        body_ranges(text, sheet)?;
        let thick = BodyFile::check("thickness", &sheet.thickness);
        first_failure(text, line_at(text, sheet.file.span().start), &[thick])?;
    }
    if let Some(builtin) = &scene.builtin {
        let strands = builtin.strands.as_ref().map(|n| *n.get_ref());
        let checks = [
            BuiltinFile::check("strands", &strands),
            check(builtin.guides != Some(Guides::FromGroom), "guides", "a number above 0 or \"all\""),
        ];
        first_failure(text, section("[builtin]"), &checks)?;
        maps(text, &builtin.maps, false)?;
        for (name, map) in builtin.maps.all() {
            if let Some(map) = map.as_ref().filter(|map| map.get_ref().vertex_colors) {
                let why = format!("the map `{name}` of [builtin] needs a `texture` or `values`");
                return Err(Problem::line(line_at(text, map.span().start), why));
            }
        }
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
            check(keys.is_empty() || clip.file.is_none(), "keys", "omitted if there is a `file`"),
            ordered,
            of_numbers,
            ClipFile::check("scale", &clip.scale),
            ClipFile::check("pivot", &clip.pivot),
            ClipFile::check("facing", &clip.facing),
            ClipFile::check("rate", &clip.rate),
            check(clip.rate.is_none() || clip.file.is_some(), "rate", "given with a `file`"),
            check(clip.scale.is_none() || clip.file.is_some(), "scale", "given with a `file`"),
            check(clip.up.is_none() || clip.file.is_some(), "up", "given with a `file`"),
            check(clip.name.is_none() || keys.is_empty(), "name", "omitted if there are `keys`"),
            check(clip.start == 0 || keys.is_empty(), "start", "omitted if there are `keys`"),
            check(
                clip.pivot.is_none() || clip.joint.is_some() || !keys.is_empty(),
                "pivot",
                "omitted without `joint` or `keys`",
            ),
            check(clip.rest_frame.is_none() || clip.joint.is_some(), "rest_frame", "omitted without `joint`"),
            check(clip.travel.is_none() || clip.joint.is_some(), "travel", "omitted without `joint`"),
            check(clip.facing.is_none() || clip.joint.is_some(), "facing", "omitted without `joint`"),
            check(
                clip.joint.is_none() || clip.file.is_some(),
                "joint",
                "given with a `file`, the motion that has the joint",
            ),
        ];
        first_failure(text, section("[clip]"), &checks)?;
    }
    if let Some(body) = scene.body.as_ref().filter(|body| body.vertex_cache.is_some()) {
        let alone =
            "omitted if there is a [clip] or a [[prop]]: the vertices of the body have a motion already";
        let checks = [check(scene.clip.is_none() && scene.prop.is_empty(), "vertex_cache", alone)];
        first_failure(text, line_at(text, body.file.span().start), &checks)?;
    }
    for body in scene.body.iter().chain(&scene.collision).chain(&scene.sheet) {
        let checks = [check(
            body.vertex_rate.is_none() || body.vertex_cache.is_some(),
            "vertex_rate",
            "given with a `vertex_cache`",
        )];
        first_failure(text, line_at(text, body.file.span().start), &checks)?;
    }
    props::ranges(text, scene)?;
    for groom in &scene.groom {
        let from = line_at(text, groom.start());
        first_failure(text, from, &[GroomFile::check("scale", &groom.scale)])?;
        placement(text, from, &groom.transform)?;
        in_range(text, from, &groom.look)?;
        in_range(text, from, &groom.effects)?;
        in_range(text, from, &groom.thicken)?;
        maps(text, &groom.maps, groom.grow.is_some())?;
        if groom.grow.is_some() {
            let of_a_file = [
                ("scale", groom.scale.is_none()),
                ("up", groom.up.is_none()),
                ("reverse", groom.reverse == Reverse::None),
                ("bones", groom.bones.is_none()),
            ];
            let checks =
                of_a_file.map(|(key, absent)| check(absent, key, "omitted if hair is grown (`grow`)"));
            first_failure(text, from, &checks)?;
        }
        if let Some(grow) = &groom.grow {
            let from = line_at(text, grow.span().start);
            in_range(text, from, &grow.get_ref().growth())?;
            if let Some(shape) = &grow.get_ref().inside {
                let checks: Vec<Check> = with_prefix("inside", shape.checks()).collect();
                first_failure(text, from, &checks)?;
            }
        }
        if groom.file.is_some() == groom.grow.is_some() {
            let line = text.find("[[groom]]").map_or(1, |at| line_at(text, at));
            return Err(Problem::line(line, "a [[groom]] needs `file` or `grow`, and not both"));
        }
    }
    colored_once(text, scene)?;
    for (collider, line) in scene.collider.iter().zip(lines(text, "[[collider]]")) {
        in_range(text, line, collider)?;
    }
    air::ranges(text, scene)?;
    in_range(text, section("[solver]"), &scene.solver)?;
    in_range(text, section("[volume]"), &scene.volume)?;
    in_range(text, section("[neighbours]"), &scene.neighbours)?;
    if let Some(camera) = &scene.camera {
        in_range(text, section("[camera]"), camera)?;
    }
    in_range(text, section("[picture]"), &scene.picture)?;
    in_range(text, section("[ground]"), &scene.ground)?;
    for (hand, line) in scene.hand.iter().zip(lines(text, "[[hand]]")) {
        in_range(text, line, hand)?;
    }
    Ok(())
}

/// Checks a motion by keys.
pub(super) fn way(keys: &[KeyFile]) -> [Check; 2] {
    let in_order = keys.windows(2).all(|w| w[0].time < w[1].time);
    let inside = keys.iter().all(|key| KeyFile::check("time", &key.time).holds);
    let numbers: Vec<[Vec3; 2]> = keys.iter().map(|k| [k.position, k.rotation]).collect();
    [
        Check { holds: in_order && inside, ..PropFile::check("keys", &Vec::<f32>::new()) },
        check(numbers.iter().flatten().all(|v| v.is_finite()), "keys", "of finite numbers"),
    ]
}

/// Checks that a mesh that is no sheet has none of a sheet's fields.
pub(super) fn without_sheet_fields(body: &BodyFile) -> [Check; 2] {
    [
        check(body.thickness.is_none(), "thickness", "omitted except in [[sheet]]"),
        check(body.initial.is_none(), "initial", "omitted except in [[sheet]] and [[collider]]"),
    ]
}

/// Checks the `transform` of a groom or a mesh, whose table has line `from`.
fn placement(text: &str, from: usize, t: &Placement) -> Result<(), Problem> {
    let not_0 = t.scale.is_finite() && t.scale.abs().min_element() > 0.0;
    let checks = vec![
        Placement::check("position", &t.position),
        Placement::check("rotation", &t.rotation),
        Check { holds: not_0, ..Placement::check("scale", &t.scale) },
    ];
    let checks: Vec<Check> = with_prefix("transform", checks).collect();
    first_failure(text, from, &checks)
}

pub(super) fn body_ranges(text: &str, body: &BodyFile) -> Result<(), Problem> {
    let checks = [
        BodyFile::check("scale", &body.scale),
        BodyFile::check("color", &body.color),
        BodyFile::check("roughness", &body.roughness),
    ];
    let from = line_at(text, body.file.span().start);
    first_failure(text, from, &checks)?;
    if let Some(transform) = &body.transform {
        placement(text, from, transform)?;
    }
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

/// Checks the maps of a groom, whose strands are grown if `grown`.
fn maps(text: &str, maps: &MapsFile, grown: bool) -> Result<(), Problem> {
    for (name, map) in maps.all() {
        let Some(map) = map else { continue };
        let (line, file) = (line_at(text, map.span().start), map.get_ref());
        let wrong = |expected: &str| Err(Problem::line(line, format!("the map `{name}` {expected}")));
        if file.sources() != 1 {
            return wrong("needs one of `texture`, `vertex_colors = true` and `values`");
        }
        if !(file.low.is_finite() && file.high.is_finite()) {
            return wrong("needs finite numbers for `low` and `high`");
        }
        if name == "comb" && !grown {
            return wrong("is the direction of hair that grows from `groom.grow`; other hair has its own");
        }
        if name == "comb" && (file.low != 0.0 || file.high < 0.0 || file.channel != Channel::default()) {
            return wrong(
                "uses red and green, and of the range only `high`, 0 or more; omit `channel` and `low`",
            );
        }
    }
    Ok(())
}
