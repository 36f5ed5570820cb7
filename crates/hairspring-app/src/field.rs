//! Fields of list entries: colliders, tools, wind sources, charged bodies, keys. Like `parameter` for values
//! that a scene has once, this gives each field's label, unit and description.

/// The type of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// One number, or three.
    Number,
    /// On or off.
    Switch,
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
    /// Unit, empty for plain numbers.
    pub unit: &'static str,
    /// Whether the field is optional, so that its default applies without it.
    pub optional: bool,
    /// Type.
    pub kind: Kind,
    /// Tooltip.
    pub tip: &'static str,
}

macro_rules! optional {
    (given) => {
        false
    };
    (maybe) => {
        true
    };
}

macro_rules! fields {
    ($($need:ident $name:literal, $label:literal, $unit:literal, $kind:expr, $tip:literal;)*) => {
        &[$(Field { name: $name, label: $label, unit: $unit, optional: optional!($need), kind: $kind, tip: $tip },)*]
    };
}

/// Keys of a tool, which are lists of four numbers.
const WAY: Kind = Kind::Keys(Keys { columns: &["time", "position"], plain: true });
/// Keys of a charged body.
const PLACES: Kind = Kind::Keys(Keys { columns: &["time", "center"], plain: false });
/// Keys of the body.
const MOTION: Kind = Kind::Keys(Keys { columns: &["time", "position", "rotation"], plain: false });
/// Corners of a hull.
const CORNERS: Kind = Kind::Keys(Keys { columns: &["point"], plain: true });

/// All fields. A name has the same meaning in every list, except `path`: see [`of`].
const ALL: &[Field] = fields! {
    given "center", "Middle", "m", Kind::Number, "Its middle. It can be dragged in the picture.";
    given "a", "One end", "m", Kind::Number, "One end of its axis. It can be dragged in the picture.";
    given "b", "Other end", "m", Kind::Number, "The other end of its axis. It can be dragged in the picture.";
    given "point", "A point of it", "m", Kind::Number, "Any point that lies on it.";
    given "normal", "Normal", "", Kind::Number, "Which way is out of what is solid. Any length above 0.";
    given "axis", "Axis", "", Kind::Number, "Its direction. Any length above 0. Pull the arrow's tip in the picture.";
    given "size", "Edges", "m", Kind::Number, "Length of its edges.";
    maybe "rotation", "Rotation", "°", Kind::Number, "How it is turned: about X, then Y, then Z.";
    given "radius", "Radius", "m", Kind::Number, "How far it reaches from its middle or axis, above 0.";
    given "speed", "Speed", "m/s", Kind::Number, "Of the air, at the mouth or the radius. Below 0: the other way round.";
    maybe "spread", "Spread", "°", Kind::Number, "Angle from the jet's axis to its edge, 0 to 80.";
    maybe "gust", "Gust amount", "", Kind::Number, "How much gusts add and take, as a share, 0 to 1.";
    maybe "gust_rate", "Gust rate", "Hz", Kind::Number, "How often they come.";
    given "charge", "Charge", "C", Kind::Number, "Static charge. Hair of the other sign is pulled, of the same sign pushed. A rubbed balloon: -1e-7.";
    maybe "solid", "Solid", "", Kind::Switch, "Whether hair collides with the ball.";
    maybe "joint", "Carried by", "", Kind::Joint, "The body's joint that carries it.";
    maybe "pull", "Pull", "Hz", Kind::Number, "How fast a lone point would swing about its place, 0 to 1000.";
    maybe "damping", "Damping", "×", Kind::Number, "Damping of that pull over the critical: 1 does not swing.";
    maybe "grip", "Grip", "1/s", Kind::Number, "How fast hair takes on the comb's velocity across itself, 0 to 10000.";
    maybe "friction", "Drag along", "1/s", Kind::Number, "How fast hair takes on the comb's velocity along itself, 0 to the grip.";
    given "reach", "Reach", "m", Kind::Number, "Strands that come nearer to the tie than this are gathered.";
    maybe "gather", "Gathers in", "s", Kind::Number, "How long gathering takes.";
    maybe "from", "Takes hold at", "s", Kind::Number, "When it takes hold.";
    maybe "until", "Lets go at", "s", Kind::Maybe(2.0), "When it lets go; left out: never.";
    maybe "path", "Way", "", WAY, "How far it has moved at a time; straight in between, at rest before and after.";
    maybe "thickness", "Thickness", "m", Kind::Number, "How far hair stays from it, on both sides. It begins the scene anew.";
    maybe "keys", "Keys", "", MOTION, "Where the whole body is at a time: it goes from key to key as a rigid piece, and rests at each.";
    maybe "points", "Corners", "", CORNERS, "Points whose convex hull it is.";
    maybe "time", "Time", "s", Kind::Number, "When. Each key is later than the one before.";
    maybe "position", "Position", "m", Kind::Number, "How far it has gone from where it was.";
    maybe "pivot", "Turns about", "m", Kind::Number, "The point of the body that its motion turns it about.";
};

/// The path of a charged body. It gives absolute positions instead of displacements.
const CHARGED_WAY: Field = Field {
    name: "path",
    label: "Way",
    unit: "",
    optional: true,
    kind: PLACES,
    tip: "Where its middle is later; straight on between. Times are above 0.",
};

/// Returns the field `name` of an entry of `list`, if it exists.
pub fn of(list: &str, name: &str) -> Option<&'static Field> {
    match (list, name) {
        ("charged", "path") => Some(&CHARGED_WAY),
        _ => ALL.iter().find(|field| field.name == name),
    }
}

/// Rank of a field among the fields of an entry, for sorting.
pub fn place(name: &str) -> usize {
    ALL.iter().position(|field| field.name == name).unwrap_or(ALL.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_there_once_and_say_what_they_do() {
        for (k, field) in ALL.iter().enumerate() {
            assert!(field.tip.ends_with('.') && !field.label.is_empty(), "{}", field.name);
            assert!(ALL[..k].iter().all(|other| other.name != field.name), "{} is there twice", field.name);
            if let Kind::Keys(keys) = field.kind {
                assert!(keys.columns.iter().all(|c| of("", c).is_some()), "{}", field.name);
            }
        }
    }
}
