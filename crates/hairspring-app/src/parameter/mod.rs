//! The parameters of a scene file that are a single number, switch, choice, color or direction. For each, this
//! table gives the group, order, label and control in the panel. Unit, range, default, description and the
//! condition under which it has an effect are those of its definition. Fields of list entries (colliders, tools, wind
//! sources, charged bodies, keys) are in `field`.

mod table;

pub use table::ALL;

use crate::{document::Document, key::Key};
use hairspring::settings;
use hairspring_io::scene::parameters;

/// Groups of parameters by artistic purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// Hairstyle, amount of hair, and styling effects.
    Style,
    /// How hair holds its shape.
    Stiffness,
    /// Mass of the hair.
    Weight,
    /// Motion of the body.
    Motion,
    /// Wind and turbulence.
    Air,
    /// Collision with bodies.
    Collision,
    /// Contact between hairs.
    Volume,
    /// Color and gloss.
    Look,
    /// Camera.
    Camera,
    /// Time steps and solver.
    Solver,
}

impl Group {
    /// All groups, in the order of the panel.
    pub const ALL: [Self; 10] = [
        Self::Style,
        Self::Stiffness,
        Self::Weight,
        Self::Motion,
        Self::Air,
        Self::Collision,
        Self::Volume,
        Self::Look,
        Self::Camera,
        Self::Solver,
    ];

    /// Heading in the panel.
    pub fn name(self) -> &'static str {
        match self {
            Self::Style => "Style",
            Self::Stiffness => "Stiffness",
            Self::Weight => "Weight",
            Self::Motion => "Motion",
            Self::Air => "Air",
            Self::Collision => "Collision",
            Self::Volume => "Volume",
            Self::Look => "Look",
            Self::Camera => "Camera",
            Self::Solver => "Solver",
        }
    }
}

/// The object that a parameter belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    /// The scene.
    Scene,
    /// The selected groom.
    Groom,
    /// The material of the selected group of the groom.
    Material,
}

/// Control of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A number, with a slider over all accepted values.
    Bounded,
    /// A number, with the range of its slider. More values may be accepted; they can be typed.
    Number {
        /// Minimum.
        min: f64,
        /// Maximum.
        max: f64,
        /// Whether the slider is logarithmic.
        log: bool,
    },
    /// An optional number, with its initial value.
    Maybe {
        /// Minimum.
        min: f64,
        /// Maximum.
        max: f64,
        /// Initial value when it is switched on.
        from: f64,
        /// Text that describes the state without a value.
        without: &'static str,
    },
    /// A whole number of guides, or a keyword.
    Guides {
        /// Maximum.
        max: i64,
    },
    /// A whole number. Its slider is logarithmic if the range spans more than a factor of a thousand.
    Count {
        /// Minimum.
        min: i64,
        /// Maximum.
        max: i64,
    },
    /// On or off.
    Switch,
    /// One of the words of the definition.
    Choice,
    /// Linear red, green, blue.
    Color,
    /// An optional color.
    MaybeColor {
        /// Initial value when it is switched on.
        from: [f64; 3],
        /// Text that describes the state without a value.
        without: &'static str,
    },
    /// Three numbers.
    Vector {
        /// Maximum absolute value of each.
        reach: f64,
    },
    /// Values from root to tip.
    Profile,
}

/// A parameter in the panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Group in the panel.
    pub group: Group,
    /// The object that it belongs to.
    pub of: Of,
    /// Name in that object.
    pub name: &'static str,
    /// Label in the panel.
    pub label: &'static str,
    /// Control.
    kind: Kind,
}

impl Parameter {
    /// Full name of the parameter, as in the book.
    pub fn full_name(&self) -> String {
        match (self.of, self.name) {
            (Of::Scene, name) => name.into(),
            (Of::Groom, "style" | "strands" | "motion") => format!("builtin.{}", self.name),
            (Of::Groom, name) => format!("groom.{name}"),
            (Of::Material, name) => format!("material.{name}"),
        }
    }

    /// The definition of the parameter.
    pub fn definition(&self) -> &'static settings::Parameter {
        let name = self.full_name();
        parameters::parameter(&name).unwrap_or_else(|| unreachable!("`{name}` has no definition"))
    }

    /// Control of the parameter. A slider over all accepted values has their bounds.
    pub fn kind(&self) -> Kind {
        match self.kind {
            Kind::Bounded => {
                let (min, max) = self.definition().range.bounds().unwrap_or((0.0, 1.0));
                Kind::Number { min: shortest(min), max: shortest(max), log: false }
            }
            kind => kind,
        }
    }

    /// Unit as the panel shows it, empty for plain numbers.
    pub fn unit(&self) -> &'static str {
        unit_of(self.definition())
    }

    /// The words of a choice. A parameter without a default may also have none of them.
    pub fn words(&self) -> impl Iterator<Item = &'static str> {
        let definition = self.definition();
        let none = definition.default.is_none().then_some("none");
        none.into_iter().chain(definition.words.iter().copied())
    }

    /// Key of the effective value, for this groom and group.
    pub fn key(&self, groom: usize, group: usize) -> Key {
        match self.of {
            Of::Scene => Key::default().field(self.name),
            Of::Groom => Key::top("groom").place(groom).field(self.name),
            Of::Material => Key::top("groom").place(groom).field("material").place(group).field(self.name),
        }
    }

    /// Whether the parameter determines hair, body or motion. Changing it restarts the scene.
    pub fn is_geometry(&self) -> bool {
        const NAMES: [&str; 8] = [
            "style",
            "strands",
            "guides",
            "motion",
            "radius",
            "radius_profile",
            "solver.collide_body",
            "solver.preroll",
        ];
        const TABLES: [&str; 5] = ["grow", "thicken", "transform", "clip", "body"];
        NAMES.contains(&self.name) || self.name.split_once('.').is_some_and(|(t, _)| TABLES.contains(&t))
    }

    /// Key in the text; `None` if the text has no place for it yet.
    pub fn text_key(&self, document: &Document, groom: usize, group: usize) -> Option<Key> {
        match self.of {
            Of::Scene => Some(self.key(0, 0)),
            Of::Groom => document.groom_key(groom).map(|key| key.field(self.name)),
            Of::Material => {
                let name = document.material_of(groom, group)?;
                Some(Key::top("material").entry(&name).field(self.name))
            }
        }
    }

    /// Key to write to. If the group has no material of its own, one is created.
    pub fn place(&self, document: &mut Document, groom: usize, group: usize) -> Result<Key, crate::AppError> {
        match self.of {
            Of::Material => document.own_material(groom, group, self.name),
            _ => self.text_key(document, groom, group).ok_or_else(|| {
                crate::AppError::new(format!("the scene file has no entry for groom {groom}"))
            }),
        }
    }
}

/// Unit of a parameter as the panel shows it, empty for plain numbers.
pub fn unit_of(definition: &settings::Parameter) -> &'static str {
    match (definition.unit, definition.physical_unit()) {
        ("degrees", _) => "°",
        ("factor", _) => "×",
        (_, unit) => unit.unwrap_or_default(),
    }
}

/// Description, accepted values and default of a parameter, for tooltips.
pub fn describe(definition: &settings::Parameter, default: &str) -> String {
    let accepted = match definition.range {
        settings::Range::Switch => "on or off".into(),
        settings::Range::Words => definition.words.join(", "),
        _ => definition.expected.to_owned(),
    };
    format!("{}\n\n{accepted}; default {default}", definition.summary())
}

/// The double with the shortest decimal representation of a float: bounds are shown as they are written.
fn shortest(x: f32) -> f64 {
    x.to_string().parse().unwrap_or(f64::from(x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_has_a_definition_and_its_slider_is_in_the_range() {
        for parameter in ALL {
            let (definition, name) = (parameter.definition(), parameter.full_name());
            let ends = match parameter.kind() {
                Kind::Number { min, max, .. } | Kind::Maybe { min, max, .. } => vec![min as f32, max as f32],
                Kind::Count { min, max } => vec![min as f32, max as f32],
                _ => Vec::new(),
            };
            assert!(ends.iter().all(|x| definition.range.accepts(x)), "{name}: {ends:?}");
            let range = definition.range;
            let fits = match parameter.kind() {
                Kind::Choice => range == settings::Range::Words,
                Kind::Switch => range == settings::Range::Switch,
                Kind::Color | Kind::MaybeColor { .. } => range == settings::Range::Color,
                _ => true,
            };
            assert!(fits, "{name}: {range:?}");
        }
    }
}
