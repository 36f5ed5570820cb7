//! Settings that are valid but probably mistakes: values in another unit than that of the field, a tie together with
//! strand contact, and a camera that is only partly placed.

use super::file::SceneFile;
use hairspring::forces::Manipulator;
use hairspring_scene::Camera;
use toml::Table;

/// Length of grown hair above which it is reported [m]. Few people have longer hair.
const LONG: f32 = 3.0;
/// Radius of a fiber above which it is reported [m]: four times that of a whisker.
const THICK: f64 = 1e-3;

/// Gravity above which it is reported [m/s²]: ten times that of the Earth.
const STRONG: f32 = 100.0;
/// Density of a fiber below which it is reported [kg/m³]. Hair has 1300, and 1.3 if it is given in g/cm³.
const LIGHT: f64 = 100.0;
/// Young's modulus below which it is reported [Pa], that of rubber. Hair has 3.9e9, and 3.9 if it is given in GPa.
const SOFT: f64 = 1e6;
/// Thickness of a sheet above which it is reported [m].
const THICK_SHEET: f32 = 0.1;

/// Returns a note for each of these settings in the scene.
pub(super) fn notes(scene: &SceneFile) -> Vec<String> {
    let grown = scene.groom.iter().filter_map(|groom| groom.grow.as_ref());
    let lengths = grown.map(|grow| grow.get_ref().growth().length).filter(|length| *length > LONG);
    let lengths = lengths.map(|length| {
        format!("`grow` has hair of {length} m; lengths are in meters, so correct `length` if that is wrong")
    });
    let materials = scene.material.iter().flat_map(|(name, table)| of_material(name, table.get_ref()));
    let gravity = Some(scene.gravity.length()).filter(|length| *length > STRONG);
    let gravity = gravity.map(|length| {
        format!("gravity is {length:.0} m/s²; it is in m/s² (9.81 on Earth), so correct `gravity` if that is wrong")
    });
    let sheets = scene.sheet.iter().filter_map(|sheet| sheet.thickness).filter(|thick| *thick > THICK_SHEET);
    let sheets = sheets.map(|thick| {
        format!(
            "a [[sheet]] is {thick} m thick; lengths are in meters, so correct `thickness` if that is wrong"
        )
    });
    lengths.chain(materials).chain(gravity).chain(sheets).chain(held_open(scene)).collect()
}

/// Returns a note for a camera without a position or a target: the defaults suit the built-in head, which may be elsewhere than
/// the hair of the scene. `text` is that of the scene.
pub(super) fn half_placed(text: &str, scene: &SceneFile) -> Option<String> {
    let written = text.parse::<Table>().ok()?;
    let camera =
        written.get("camera").and_then(|camera| camera.as_table()).filter(|_| scene.builtin.is_none())?;
    let defaults = Camera::default();
    let places = [("position", defaults.position), ("target", defaults.target)];
    let (missing, place) = places.into_iter().find(|(key, _)| !camera.contains_key(*key))?;
    Some(format!(
        "[camera] has no `{missing}`, so it is {:?}, which suits the built-in head; write `position` and `target`, or leave \
         [camera] out, and hair and head are framed automatically",
        place.to_array()
    ))
}

/// Returns a note for each of these settings in the material `name`.
fn of_material(name: &str, table: &toml::Table) -> Vec<String> {
    let number = |key: &str| {
        let value = table.get(key)?;
        value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
    };
    let radius = number("radius").filter(|radius| *radius > THICK).map(|radius| {
        format!(
            "[material.{name}] has hair that is {:.3} m thick; lengths are in meters, so correct `radius` if that is wrong",
            2.0 * radius
        )
    });
    let density = number("density").filter(|density| *density < LIGHT).map(|density| {
        format!(
            "[material.{name}] has a density of {density} kg/m³; it is in kg/m³ (hair has 1300), so correct `density` if that \
             is wrong"
        )
    });
    let young = number("young").filter(|young| *young < SOFT).map(|young| {
        format!(
            "[material.{name}] has a Young's modulus of {young} Pa; it is in Pa (hair has 3.9e9), so correct `young` if that \
             is wrong"
        )
    });
    [radius, density, young].into_iter().flatten().collect()
}

/// Returns a note if the scene has a tie and strand contact. A tie pulls strands together, and strand contact keeps them apart.
fn held_open(scene: &SceneFile) -> Option<String> {
    let ties = scene.hand.iter().any(|hand| matches!(hand.tool, Manipulator::Tie(_)));
    (ties && scene.neighbours.on).then(|| {
        "strands with [neighbours] keep each other out of the ring of a tie, and slip out of a narrow one; use [volume] \
         instead, or a `neighbours.radius` at which all of them fit into the ring"
            .into()
    })
}
