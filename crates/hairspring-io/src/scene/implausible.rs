//! Settings that are valid but probably mistakes: lengths that are not in meters, and a tie together with strand contact.

use super::file::SceneFile;
use hairspring::forces::Manipulator;

/// Length of grown hair above which it is reported [m]. Few people have longer hair.
const LONG: f32 = 3.0;
/// Radius of a fiber above which it is reported [m]: four times that of a whisker.
const THICK: f64 = 1e-3;

/// Returns a note for each of these settings in the scene.
pub(super) fn notes(scene: &SceneFile) -> Vec<String> {
    let grown = scene.groom.iter().filter_map(|groom| groom.grow.as_ref());
    let lengths = grown.map(|grow| grow.get_ref().growth().length).filter(|length| *length > LONG);
    let lengths = lengths.map(|length| {
        format!("`grow` has hair of {length} m; lengths are in meters, so correct `length` if that is wrong")
    });
    let radius = |table: &toml::Table| table.get("radius").and_then(toml::Value::as_float);
    let radii = scene.material.iter().filter_map(|(name, table)| Some((name, radius(table.get_ref())?)));
    let radii = radii.filter(|(_, radius)| *radius > THICK).map(|(name, radius)| {
        format!(
            "[material.{name}] has hair that is {:.3} m thick; lengths are in meters, so correct `radius` if that is wrong",
            2.0 * radius
        )
    });
    lengths.chain(radii).chain(held_open(scene)).collect()
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
