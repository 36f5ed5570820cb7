//! Converts a new value of a parameter into edits of the scene's text. Mostly this is the value itself;
//! values that exclude each other are removed.

use crate::{AppError, document::Document, key::Key, parameter::Parameter};
use toml_edit::Value;

/// The edits of one step: values by their keys. `None` removes the value.
pub type Edits = Vec<(Key, Option<Value>)>;

/// Returns the edits that write `value` to a parameter of this groom and group; `None` restores the default.
pub fn of(
    document: &mut Document,
    parameter: &Parameter,
    value: Option<Value>,
    (groom, group): (usize, usize),
) -> Result<Edits, AppError> {
    let key = parameter.place(document, groom, group)?;
    Ok(match parameter.name {
        // A material without a preset is a single hair.
        "preset" => vec![(key, value.filter(|value| value.as_str() != Some("none")))],
        // A look has either melanin or two colors. Setting melanin removes the colors; removing melanin
        // restores the colors of the time of opening.
        "look.melanin" => {
            let pigment = value.is_some();
            let colors = ["root_color", "tip_color"].map(|name| {
                let color = key.sibling(name);
                let first =
                    color.look_up(document.opened().parsed_text()).filter(|_| !pigment).and_then(written);
                (color, first)
            });
            std::iter::once((key, value)).chain(colors).collect()
        }
        // A camera is written as a whole. If the style placed it, its other values are written with their
        // current ones.
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

/// Returns the value that resets a parameter to the state at the time of opening; `None` if it was not in the
/// text then.
pub fn reset(document: &Document, parameter: &Parameter, (groom, group): (usize, usize)) -> Option<Value> {
    if parameter.name == "preset" || parameter.name.starts_with("camera.") {
        // Without a value, these would lose the value of the style.
        return parameter.key(groom, group).look_up(document.opened().values()).and_then(written);
    }
    parameter.text_key(document, groom, group)?.look_up(document.opened().parsed_text()).and_then(written)
}

/// Converts a value to the form in which it is written in the text.
pub fn written(value: &toml::Value) -> Option<Value> {
    value.to_string().parse().ok()
}
