//! Values that a scene file may not have: not finite, or outside the range that the field's description gives.

use super::{
    file::{BodyFile, SceneFile},
    sentence::{line_at, line_of_key},
};
use crate::Problem;
use glam::Vec3;
use hairspring::{material::Material, scene::Shape};

/// One check: whether it holds, the key it is about, what is expected.
type Check = (bool, &'static str, &'static str);

fn finite(v: Vec3) -> bool {
    v.is_finite()
}

/// Finite and above 0, or absent.
fn above_0(x: Option<f32>) -> bool {
    x.is_none_or(|x| x.is_finite() && x > 0.0)
}

/// Finite, and 0 or more.
fn from_0(x: f32) -> bool {
    x.is_finite() && x >= 0.0
}

/// Weights of a material's mass profile.
fn profile(weights: &[f32]) -> bool {
    let least = weights.iter().copied().fold(f32::INFINITY, f32::min);
    let holds = |w: &f32| w.is_finite() && *w > 0.0 && *w <= least * 100.0;
    (1..=64).contains(&weights.len()) && weights.iter().all(holds)
}

/// A colour's channels: 0 to 1.
fn color(c: Vec3) -> bool {
    c.is_finite() && c.min_element() >= 0.0 && c.max_element() <= 1.0
}

/// The first check that fails, placed at its key's line from line `from` on.
fn first_failure(text: &str, from: usize, checks: &[Check]) -> Result<(), Problem> {
    match checks.iter().find(|(holds, ..)| !holds) {
        None => Ok(()),
        Some((_, key, expected)) => {
            let line = line_of_key(text, from, key).unwrap_or(from);
            Err(Problem::line(line, format!("`{key}` must be {expected}")))
        }
    }
}

/// Checks all settings but the materials.
pub(super) fn ranges(text: &str, scene: &SceneFile) -> Result<(), Problem> {
    let section = |name: &str| text.find(name).map_or(1, |at| line_at(text, at));
    if scene.groom.is_empty() {
        return Err(Problem::whole("the scene has no [[groom]]: name one with `file = …`"));
    }
    first_failure(text, 1, &[(finite(scene.gravity), "gravity", "three finite numbers [m/s²]")])?;
    for body in scene.body.iter().chain(&scene.collision) {
        body_ranges(text, body)?;
    }
    if let Some(clip) = &scene.clip {
        let checks = [
            (above_0(clip.scale), "scale", "above 0 [m a unit]"),
            (clip.pivot.is_none_or(finite), "pivot", "three finite numbers [m]"),
            (clip.facing.is_none_or(f32::is_finite), "facing", "a finite number [degrees]"),
            (clip.pivot.is_none() || clip.joint.is_some(), "pivot", "left out where there is no `joint`"),
            (
                clip.rest_frame.is_none() || clip.joint.is_some(),
                "rest_frame",
                "left out where there is no `joint`",
            ),
            (clip.travel.is_none() || clip.joint.is_some(), "travel", "left out where there is no `joint`"),
            (clip.facing.is_none() || clip.joint.is_some(), "facing", "left out where there is no `joint`"),
            (
                clip.joint.is_none() || clip.file.is_some(),
                "joint",
                "with a `file`: the motion that the joint is from",
            ),
        ];
        first_failure(text, section("[clip]"), &checks)?;
    }
    for groom in &scene.groom {
        let t = &groom.transform;
        let (effects, look) = (&groom.effects, &groom.look);
        let checks = [
            (above_0(groom.scale), "scale", "above 0 [m a unit]"),
            (finite(t.position), "position", "three finite numbers [m]"),
            (finite(t.rotation), "rotation", "three finite numbers [degrees]"),
            (finite(t.scale) && t.scale.abs().min_element() > 0.0, "scale", "finite and not 0"),
            (color(look.root_color), "root_color", "three numbers from 0 to 1"),
            (color(look.tip_color), "tip_color", "three numbers from 0 to 1"),
            ((0.0..=1.0).contains(&look.variation), "variation", "0 to 1"),
            ((0.1..=1.0).contains(&look.roughness), "roughness", "0.1 to 1"),
            ((0.0..=10.0).contains(&look.cuticle), "cuticle", "0 to 10 [degrees]"),
            ((0.0..=4.0).contains(&look.specular), "specular", "0 to 4"),
            ((0.0..=4.0).contains(&look.backlight), "backlight", "0 to 4"),
            ((0.0..=4.0).contains(&look.scatter), "scatter", "0 to 4"),
            ((0.0..=4.0).contains(&look.shadow), "shadow", "0 to 4"),
            ((0.0..=1.0).contains(&effects.clump), "clump", "0 to 1"),
            (from_0(effects.curl_radius), "curl_radius", "0 or more [m]"),
            (above_0(Some(effects.curl_length)), "curl_length", "above 0 [m]"),
            (from_0(effects.noise), "noise", "0 or more [m]"),
        ];
        first_failure(text, line_at(text, groom.start()), &checks)?;
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
                (
                    grow.get_ref().inside.as_ref().is_none_or(sound),
                    "inside",
                    "finite, with a radius or edges above 0 [m] or a normal that is not 0",
                ),
            ];
            first_failure(text, line_at(text, grow.span().start), &grown)?;
        }
        if groom.file.is_some() == groom.grow.is_some() {
            let line = text.find("[[groom]]").map_or(1, |at| line_at(text, at));
            return Err(Problem::line(line, "a [[groom]] needs `file` or `grow`, and not both"));
        }
    }
    for collider in &scene.collider {
        first_failure(
            text,
            section("[[collider]]"),
            &[(
                sound(&collider.shape),
                "shape",
                "finite, with a radius or edges above 0 [m] or a normal that is not 0",
            )],
        )?;
    }
    let (wind, solver) = (&scene.wind, &scene.solver);
    let winds = [
        (finite(wind.velocity), "velocity", "three finite numbers [m/s]"),
        ((0.0..=1.0).contains(&wind.gust), "gust", "0 to 1"),
        (from_0(wind.gust_rate), "gust_rate", "0 or more [Hz]"),
    ];
    first_failure(text, section("[wind]"), &winds)?;
    let solvers = [
        ((1..=64).contains(&solver.substeps), "substeps", "1 to 64"),
        ((0..=20).contains(&solver.projections), "projections", "0 to 20"),
    ];
    first_failure(text, section("[solver]"), &solvers)?;
    let volume = &scene.volume;
    let volumes = [
        (above_0(volume.cell), "cell", "above 0 [m]"),
        (from_0(volume.friction), "friction", "0 or more [1/s]"),
        (from_0(volume.pressure), "pressure", "0 or more [m/s]"),
        (from_0(volume.regain), "regain", "0 or more [1/s]"),
    ];
    first_failure(text, section("[volume]"), &volumes)?;
    let neighbours = &scene.neighbours;
    let strands = [
        (above_0(neighbours.thickness), "thickness", "above 0 [m]"),
        (from_0(neighbours.regain), "regain", "0 or more [1/s]"),
        ((0.0..=1.0).contains(&neighbours.friction), "friction", "0 to 1"),
        (from_0(neighbours.stiction), "stiction", "0 or more [N]"),
    ];
    first_failure(text, section("[neighbours]"), &strands)?;
    if let Some(camera) = &scene.camera {
        let cameras = [
            (finite(camera.position), "position", "three finite numbers [m]"),
            (
                finite(camera.target) && camera.target != camera.position,
                "target",
                "finite, and not where the camera stands",
            ),
            ((1.0..=170.0).contains(&camera.fov), "fov", "1 to 170 [degrees]"),
        ];
        first_failure(text, section("[camera]"), &cameras)?;
    }
    Ok(())
}

/// Whether a shape is finite (its own extent, not the half of space that a plane bounds) and has an inside.
fn sound(shape: &Shape) -> bool {
    match *shape {
        Shape::Sphere { center, radius } => finite(center) && above_0(Some(radius)),
        Shape::Capsule { a, b, radius } => finite(a) && finite(b) && above_0(Some(radius)),
        Shape::Box { center, size, rotation } => {
            finite(center) && finite(size) && size.min_element() > 0.0 && finite(rotation)
        }
        Shape::Plane { point, normal } => finite(point) && normal.try_normalize().is_some(),
    }
}

fn body_ranges(text: &str, body: &BodyFile) -> Result<(), Problem> {
    let checks = [
        (above_0(body.scale), "scale", "above 0 [m a unit]"),
        (body.color.is_none_or(color), "color", "three numbers from 0 to 1"),
        (body.roughness.is_none_or(|r| (0.0..=1.0).contains(&r)), "roughness", "0 to 1"),
    ];
    first_failure(text, line_at(text, body.file.span().start), &checks)?;
    body.more.iter().try_for_each(|file| body_ranges(text, file))
}

/// Checks a material whose table begins in line `from`.
pub(super) fn material(text: &str, from: usize, m: &Material) -> Result<(), Problem> {
    let checks = [
        (above_0(m.radius), "radius", "above 0 [m]"),
        (above_0(Some(m.density)), "density", "above 0 [kg/m³]"),
        (
            profile(&m.mass_profile),
            "mass_profile",
            "1 to 64 numbers above 0, the largest at most 100 times the smallest",
        ),
        (above_0(Some(m.young)), "young", "above 0 [Pa]"),
        (above_0(Some(m.shear)), "shear", "above 0 [Pa]"),
        (from_0(m.bend), "bend", "0 or more"),
        (from_0(m.bend_tip), "bend_tip", "0 or more"),
        ((0.05..=1.0).contains(&m.flatness), "flatness", "0.05 to 1"),
        (from_0(m.damping), "damping", "0 or more [s]"),
        (from_0(m.drag), "drag", "0 or more"),
        ((0.0..=1.0).contains(&m.friction), "friction", "0 to 1"),
    ];
    first_failure(text, from, &checks)
}
