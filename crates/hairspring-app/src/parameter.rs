//! Every parameter of a scene file that is a single number, switch, choice, color or direction, with what is
//! the panel's own: group, order, label and control. Unit, range, default, description and the condition
//! under which it has an effect are those of its definition. Fields of list entries (colliders, tools, wind
//! sources, charged bodies, keys) are in `field`.

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
    /// Weights from root to tip.
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

const fn number(min: f64, max: f64) -> Kind {
    Kind::Number { min, max, log: false }
}

const fn scale(min: f64, max: f64) -> Kind {
    Kind::Number { min, max, log: true }
}

macro_rules! parameters {
    ($($group:ident { $($of:ident $name:literal, $label:literal, $kind:expr;)* })*) => {
        &[$($(Parameter { group: Group::$group, of: Of::$of, name: $name, label: $label, kind: $kind },)*)*]
    };
}

/// All parameters.
pub const ALL: &[Parameter] = parameters! {
    Style {
        Groom "style", "Hairstyle", Kind::Choice;
        Groom "strands", "Hair count", Kind::Count { min: 100, max: 200_000 };
        Groom "guides", "Guides", Kind::Guides { max: 20_000 };
        Groom "grow.strands", "Hair count", Kind::Count { min: 10, max: 200_000 };
        Groom "grow.length", "Length", scale(0.002, 1.0);
        Groom "grow.spread", "Length variation", Kind::Bounded;
        Groom "grow.fall", "Droop", Kind::Bounded;
        Groom "grow.points", "Points per hair", Kind::Count { min: 3, max: 64 };
        Groom "thicken.copies", "Copies per strand", Kind::Count { min: 0, max: 20 };
        Groom "thicken.radius", "… radius", number(0.0, 0.01);
        Groom "thicken.tip", "… tip spread", number(0.0, 10.0);
        Material "preset", "Material", Kind::Choice;
        Material "tether", "Tether", number(0.0, 3.0);
        Material "global_shape.pull", "Global shape", number(0.0, 20.0);
        Material "global_shape.tip", "… at the tip", number(0.0, 2.0);
        Material "global_shape.damping", "… damping", number(0.0, 4.0);
        Groom "effects.clump", "Clump", Kind::Bounded;
        Groom "effects.curl_radius", "Curl radius", number(0.0, 0.02);
        Groom "effects.curl_length", "Curl length", scale(0.002, 0.2);
        Groom "effects.noise", "Flyaway", number(0.0, 0.02);
        Groom "transform.position", "Position", Kind::Vector { reach: 5.0 };
        Groom "transform.rotation", "Rotation", Kind::Vector { reach: 180.0 };
        Groom "transform.scale", "Scale", Kind::Vector { reach: 10.0 };
    }
    Stiffness {
        Material "model", "Model", Kind::Choice;
        Material "bend", "Bending", scale(0.01, 1000.0);
        Material "bend_tip", "… at the tip", number(0.0, 2.0);
        Material "damping", "Damping", number(0.0, 0.2);
        Material "flatness", "Flatness", Kind::Bounded;
        Material "young", "Young's modulus", scale(1e8, 1e11);
        Material "shear", "Shear modulus", scale(1e7, 1e11);
    }
    Weight {
        Scene "gravity", "Gravity", Kind::Vector { reach: 30.0 };
        Material "density", "Density", number(100.0, 5000.0);
        Material "mass_profile", "Mass profile", Kind::Profile;
        Material "radius", "Fiber radius", Kind::Maybe { min: 1e-5, max: 2e-4, from: 3.5e-5, without: "from the groom" };
    }
    Motion {
        Groom "motion", "Built-in motion", Kind::Switch;
        Scene "clip.start", "First frame", Kind::Count { min: 0, max: 500 };
        Scene "clip.rest_frame", "Rest frame", Kind::Count { min: 0, max: 500 };
        Scene "clip.travel", "Travel", Kind::Choice;
        Scene "clip.facing", "Facing", number(-180.0, 180.0);
        Scene "solver.inertia", "Head inertia", Kind::Bounded;
    }
    Air {
        Scene "wind.velocity", "Wind", Kind::Vector { reach: 20.0 };
        Scene "wind.gust", "Gust amount", Kind::Bounded;
        Scene "wind.gust_rate", "Gust rate", number(0.0, 5.0);
        Scene "turbulence.strength", "Turbulence", number(0.0, 5.0);
        Scene "turbulence.size", "Eddy size", scale(0.01, 2.0);
        Scene "turbulence.octaves", "Octaves", Kind::Count { min: 1, max: 6 };
        Scene "wind_occlusion.body", "Body occlusion", number(0.0, 300.0);
        Scene "wind_occlusion.hair", "Hair occlusion", number(0.0, 300.0);
        Scene "wind_occlusion.reach", "Wake length", number(0.05, 3.0);
        Material "drag", "Drag", number(0.0, 5.0);
        Material "charge", "Static charge", number(-1e-8, 1e-8);
    }
    Collision {
        Scene "solver.collide_body", "Body collision", Kind::Switch;
        Scene "solver.contact", "Contact method", Kind::Choice;
        Scene "solver.segment_contacts", "Segment contacts", Kind::Switch;
        Material "friction", "Friction", Kind::Bounded;
        Material "friction_kinetic", "… kinetic", Kind::Bounded;
        Scene "solver.teleport_distance", "Teleport distance", scale(0.05, 10.0);
    }
    Volume {
        Scene "volume.method", "Volume method", Kind::Choice;
        Scene "volume.friction", "Volume friction", number(0.0, 30.0);
        Scene "volume.pressure", "Pressure", number(0.0, 3.0);
        Scene "volume.recovery_rate", "Volume recovery", number(0.0, 100.0);
        Scene "volume.cell", "Cell size", Kind::Maybe { min: 0.002, max: 0.1, from: 0.015, without: "automatic" };
        Scene "neighbours.on", "Strand contacts", Kind::Switch;
        Scene "neighbours.radius", "Strand radius", Kind::Maybe { min: 0.0002, max: 0.02, from: 0.002, without: "automatic" };
        Scene "neighbours.friction", "Strand friction", number(0.0, 1.0);
        Scene "neighbours.stiction", "Stiction", number(0.0, 1e-4);
    }
    Look {
        Groom "look.root_color", "Root color", Kind::Color;
        Groom "look.tip_color", "Tip color", Kind::Color;
        Groom "look.melanin", "Melanin", Kind::Maybe { min: 0.0, max: 1.0, from: 0.5, without: "the two colors" };
        Groom "look.melanin_redness", "Redness", Kind::Bounded;
        Groom "look.dye", "Dye", Kind::Color;
        Groom "look.variation", "Variation", Kind::Bounded;
        Groom "look.roughness", "Roughness", Kind::Bounded;
        Groom "look.cuticle", "Cuticle", Kind::Bounded;
        Groom "look.specular", "Specular", Kind::Bounded;
        Groom "look.backlight", "Backlight", Kind::Bounded;
        Groom "look.scatter", "Scatter", Kind::Bounded;
        Groom "look.shadow", "Shadow", Kind::Bounded;
        Scene "body.color", "Skin color", Kind::MaybeColor { from: [0.5, 0.3, 0.23], without: "from the file" };
        Scene "body.roughness", "Skin roughness", Kind::Maybe { min: 0.0, max: 1.0, from: 0.5, without: "from the file" };
        Scene "ground.on", "Ground", Kind::Switch;
        Scene "ground.height", "… height", Kind::Maybe { min: -2.0, max: 2.0, from: 0.0, without: "under the body" };
        Scene "ground.color", "… color", Kind::MaybeColor { from: [0.4, 0.37, 0.33], without: "shadow alone" };
    }
    Camera {
        Scene "camera.position", "Camera position", Kind::Vector { reach: 10.0 };
        Scene "camera.target", "Camera target", Kind::Vector { reach: 10.0 };
        Scene "camera.fov", "Field of view", number(5.0, 90.0);
    }
    Solver {
        Scene "solver.integrator", "Integrator", Kind::Choice;
        Scene "solver.substeps", "Substeps", Kind::Count { min: 1, max: 64 };
        Scene "solver.projection_iterations", "Iterations", Kind::Count { min: 0, max: 20 };
        Scene "solver.quality", "Quality", Kind::Choice;
        Scene "solver.sag_free", "Sag-free start", Kind::Switch;
        Scene "solver.preroll", "Pre-roll", number(0.0, 10.0);
        Scene "solver.global_shape", "Use global shape", Kind::Switch;
    }
};

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
                number(shortest(min), shortest(max))
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
        const NAMES: [&str; 7] =
            ["style", "strands", "guides", "motion", "radius", "solver.collide_body", "solver.preroll"];
        const TABLES: [&str; 5] = ["grow", "thicken", "transform", "clip", "body"];
        NAMES.contains(&self.name) || self.name.split_once('.').is_some_and(|(t, _)| TABLES.contains(&t))
    }

    /// Key in the text; `None` if the text has no place for it yet.
    pub fn said(&self, document: &Document, groom: usize, group: usize) -> Option<Key> {
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
            _ => self
                .said(document, groom, group)
                .ok_or_else(|| crate::AppError::new(format!("the scene says nothing of groom {groom}"))),
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
