//! Fields of list entries: colliders, tools, wind sources, charged bodies, keys. Like `parameter` for values
//! that a scene has once, this gives each field's label and control. Unit and description are those of its
//! definition.

use crate::{
    key::Key,
    parameter::{describe, unit_of},
};
use hairspring::settings;
use hairspring_io::scene::parameters;

/// The control of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// One number, or three.
    Number,
    /// On or off.
    Switch,
    /// One of the words of its definition.
    Word,
    /// The name of a joint of the body, or none.
    Joint,
    /// An optional number, with its initial value.
    Maybe(f64),
    /// A list of keys.
    Keys(Keys),
}

/// How a list of keys is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keys {
    /// Fields of a key. A time is one number; all others are three.
    pub columns: &'static [&'static str],
    /// Whether a key is written as a list of its numbers; otherwise it is a table of its fields.
    pub plain: bool,
}

/// A field of an entry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// Name in the scene file.
    pub name: &'static str,
    /// Label in the panel.
    pub label: &'static str,
    /// Control.
    pub kind: Kind,
    /// What the window does with it, for the tooltip; empty for most.
    note: &'static str,
}

macro_rules! fields {
    ($($name:literal, $label:literal, $kind:expr $(, $note:expr)?;)*) => {
        &[$(Field { name: $name, label: $label, kind: $kind, note: concat!("" $(, $note)?) },)*]
    };
}

/// Keys of a tool, which are lists of four numbers.
const PATH: Kind = Kind::Keys(Keys { columns: &["time", "position"], plain: true });
/// Keys of the body.
const MOTION: Kind = Kind::Keys(Keys { columns: &["time", "position", "rotation"], plain: false });
/// Points of a hull.
const POINTS: Kind = Kind::Keys(Keys { columns: &["point"], plain: true });

/// All fields, in the order of the panel. A name has the same control in every list, except `path`: see
/// [`of`].
const ALL: &[Field] = fields! {
    "center", "Center", Kind::Number, "Its handle can be dragged in the picture.";
    "a", "End A", Kind::Number, "Its handle can be dragged in the picture.";
    "b", "End B", Kind::Number, "Its handle can be dragged in the picture.";
    "point", "Point", Kind::Number;
    "normal", "Normal", Kind::Number;
    "axis", "Axis", Kind::Number, "The tip of its arrow can be dragged in the picture.";
    "size", "Size", Kind::Number;
    "rotation", "Rotation", Kind::Number;
    "radius", "Radius", Kind::Number;
    "speed", "Speed", Kind::Number;
    "spread", "Spread", Kind::Number;
    "gust", "Gust amount", Kind::Number;
    "gust_rate", "Gust rate", Kind::Number;
    "charge", "Charge", Kind::Number;
    "solid", "Solid", Kind::Switch;
    "joint", "Joint", Kind::Joint;
    "initial", "Initial contact", Kind::Word, "A change restarts the scene.";
    "pull", "Pull", Kind::Number;
    "damping", "Damping", Kind::Number;
    "grip", "Grip", Kind::Number;
    "friction", "Friction", Kind::Number;
    "reach", "Reach", Kind::Number;
    "gather", "Gather time", Kind::Number;
    "from", "Start time", Kind::Number;
    "until", "End time", Kind::Maybe(2.0);
    "path", "Path", PATH;
    "thickness", "Thickness", Kind::Number, "A change restarts the scene.";
    "keys", "Keys", MOTION, "A change restarts the scene.";
    "points", "Points", POINTS;
    "time", "Time", Kind::Number;
    "position", "Offset", Kind::Number;
    "pivot", "Pivot", Kind::Number, "A change restarts the scene.";
};

/// The path of a charged body, whose keys are tables of absolute positions.
const CHARGED_PATH: Field = Field {
    name: "path",
    label: "Path",
    kind: Kind::Keys(Keys { columns: &["time", "center"], plain: false }),
    note: "",
};

/// Returns the field `name` of an entry of `list`, if it exists.
pub fn of(list: &str, name: &str) -> Option<&'static Field> {
    match (list, name) {
        ("charged", "path") => Some(&CHARGED_PATH),
        _ => ALL.iter().find(|field| field.name == name),
    }
}

/// Rank of a field among the fields of an entry, for sorting.
pub fn place(name: &str) -> usize {
    ALL.iter().position(|field| field.name == name).unwrap_or(ALL.len())
}

/// The definition of the field at `key`, such as `collider[0].shape.sphere.radius`.
fn definition(key: &Key) -> Option<&'static settings::Parameter> {
    let name = key.full_name();
    // The joint of a sheet is that of any mesh.
    parameters::parameter(if name == "sheet.joint" { "collision.joint" } else { &name })
}

/// Unit of the field at `key`, empty for plain numbers.
pub fn unit(key: &Key) -> &'static str {
    definition(key).map_or("", unit_of)
}

/// The words that the field at `key` accepts.
pub fn words(key: &Key) -> &'static [&'static str] {
    definition(key).map_or(&[], |definition| definition.words)
}

/// Tooltip of a field at `key`: description, accepted values and default.
pub fn tip(field: &Field, key: &Key) -> String {
    let Some(definition) = definition(key) else { return field.label.into() };
    let text = describe(definition, definition.default_or_required().trim_matches('`'));
    [&text, field.note].join("\n").trim_end().to_owned()
}

/// Unit and tooltip of a column of the list of keys at `key`. Keys that are plain lists have no definitions of
/// their own for their numbers: times and offsets are those of the keys of a motion, and points have the unit
/// of the list.
pub fn column(key: &Key, column: &str) -> (&'static str, String) {
    let motion = Key::top("clip").field("keys").field(column);
    let definition =
        definition(&key.field(column)).or_else(|| definition(&motion)).or_else(|| definition(key));
    definition.map_or(("", String::new()), |definition| (unit_of(definition), definition.summary()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_is_listed_once_and_has_a_definition() {
        for (k, field) in ALL.iter().enumerate() {
            assert!(!field.label.is_empty(), "{}", field.name);
            assert!(ALL[..k].iter().all(|other| other.name != field.name), "{} is there twice", field.name);
            let suffix = format!(".{}", field.name);
            assert!(parameters::parameters().any(|(name, _)| name.ends_with(&suffix)), "{}", field.name);
            if let Kind::Keys(keys) = field.kind {
                assert!(keys.columns.iter().all(|c| of("", c).is_some()), "{}", field.name);
            }
        }
    }

    #[test]
    fn units_and_descriptions_are_those_of_the_definitions() {
        let key = |text: &str| text.parse::<Key>().unwrap();
        assert_eq!(unit(&key("hand[0].tool.grab.pull")), "Hz");
        let lists = ["collider[0].initial", "sheet[1].initial"];
        assert!(lists.iter().all(|name| words(&key(name)) == ["keep", "push"]));
        assert_eq!(unit(&key("collider[1].shape.box.rotation")), "°");
        assert_eq!(column(&key("hand[0].path"), "position").0, "m");
        assert_eq!(column(&key("charged[0].path"), "time").0, "s");
        assert_eq!(column(&key("collider[0].shape.hull.points"), "point").0, "m");
        let tip = tip(of("hand", "from").unwrap(), &key("hand[0].from"));
        assert_eq!(tip, "Time at which the hand starts to act.\n\n0 or more [s]; default 0.0");
    }
}
