//! What a parameter's new value writes in the scene's text: mostly itself, and what cannot stand beside it makes room.

use crate::{AppError, document::Document, key::Key, parameter::Parameter};
use toml_edit::Value;

/// What one step writes: values by their keys; none are taken away.
pub type Edits = Vec<(Key, Option<Value>)>;

/// What writes `value` to a parameter of this groom and group of it; `None`: as it is unsaid.
pub fn of(
    document: &mut Document,
    parameter: &Parameter,
    value: Option<Value>,
    (groom, group): (usize, usize),
) -> Result<Edits, AppError> {
    let key = parameter.place(document, groom, group)?;
    Ok(match parameter.name {
        // A material without a preset is a lone hair.
        "preset" => vec![(key, value.filter(|value| value.as_str() != Some("none")))],
        // A look has pigment or two colours: one makes room for the other, which comes back as the scene was opened with it.
        "look.melanin" => {
            let pigment = value.is_some();
            let colors = ["root_color", "tip_color"].map(|name| {
                let color = key.sibling(name);
                let first = color.look_up(document.opened().said()).filter(|_| !pigment).and_then(written);
                (color, first)
            });
            std::iter::once((key, value)).chain(colors).collect()
        }
        // A camera is said as a whole: of one that stands where a style put it, the rest is written as it is.
        "camera.position" | "camera.target" | "camera.fov" => {
            let whole = ["position", "target", "fov"].map(|name| {
                let key = key.sibling(name);
                let now = key.look_up(document.effective()).and_then(written);
                (key, now)
            });
            let edited =
                |(k, now): (Key, Option<Value>)| if k == key { (k, value.clone()) } else { (k, now) };
            whole.map(edited).into()
        }
        _ => vec![(key, value)],
    })
}

/// What puts a parameter back: as it was when the scene was opened. `None` where that said nothing of it.
pub fn reset(document: &Document, parameter: &Parameter, (groom, group): (usize, usize)) -> Option<Value> {
    if parameter.name == "preset" || parameter.name.starts_with("camera.") {
        // Unsaid, these would be no style's.
        return parameter.key(groom, group).look_up(document.opened().values()).and_then(written);
    }
    parameter.said(document, groom, group)?.look_up(document.opened().said()).and_then(written)
}

/// A value as the text has it.
pub fn written(value: &toml::Value) -> Option<Value> {
    value.to_string().parse().ok()
}
