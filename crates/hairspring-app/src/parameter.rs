//! Every parameter of a scene file that is a single number, switch, choice, color or direction, with label,
//! unit, range and description. Defaults are those of the library. Fields of list entries (colliders, tools,
//! wind sources, charged bodies, keys) are in `field`.

use crate::{document::Document, key::Key};
use hairspring::material::PRESETS;

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

/// Type of a parameter's values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A number, with the range of its slider. The file may accept a larger range.
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
    /// One of these words.
    Choice(&'static [&'static str]),
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

/// A parameter of the scene file.
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
    /// Unit, empty for plain numbers.
    pub unit: &'static str,
    /// Type and range of the values.
    pub kind: Kind,
    /// Tooltip.
    pub tip: &'static str,
}

const fn number(min: f64, max: f64) -> Kind {
    Kind::Number { min, max, log: false }
}

const fn scale(min: f64, max: f64) -> Kind {
    Kind::Number { min, max, log: true }
}

macro_rules! parameters {
    ($($group:ident { $($of:ident $name:literal, $label:literal, $unit:literal, $kind:expr, $tip:literal;)* })*) => {
        &[$($(Parameter { group: Group::$group, of: Of::$of, name: $name, label: $label, unit: $unit, kind: $kind, tip: $tip },)*)*]
    };
}

/// All parameters.
pub const ALL: &[Parameter] = parameters! {
    Style {
        Groom "style", "Hairstyle", "", Kind::Choice(&PRESETS), "Hairstyle of the built-in head: sets cut, wave, color and material together.";
        Groom "strands", "Hair count", "", Kind::Count { min: 100, max: 200_000 }, "Hairs on the scalp of the built-in head. A human head has about 100,000. Fewer hairs are drawn wider, so that the scalp stays covered. The scene file accepts up to 10,000,000.";
        Groom "guides", "Guides", "", Kind::Guides { max: 20_000 }, "Simulated hairs. The other hairs follow up to three of them. Too few guides move hair in slabs; many cost time. file: the guides that the groom's file names.";
        Groom "grow.strands", "Hair count", "", Kind::Count { min: 10, max: 200_000 }, "Hairs grown from the body, evenly by area.";
        Groom "grow.length", "Length", "m", scale(0.002, 1.0), "Length of the longest hair.";
        Groom "grow.spread", "Length variation", "", number(0.0, 1.0), "How much shorter the shortest hair is than the longest, as a share.";
        Groom "grow.fall", "Droop", "", number(0.0, 1.0), "How far hair bends over as it grows: 0 stands along the skin's normal, 1 ends pointing down.";
        Groom "grow.points", "Points per hair", "", Kind::Count { min: 3, max: 64 }, "More points bend more finely and cost proportionally more time.";
        Groom "thicken.copies", "Copies per strand", "", Kind::Count { min: 0, max: 20 }, "Follow hairs added around each strand of the file.";
        Groom "thicken.radius", "… radius", "m", number(0.0, 0.01), "Radius of the disc on the skin in which the copies grow.";
        Groom "thicken.tip", "… tip spread", "×", number(0.0, 10.0), "Distance of a copy from its strand at the tip, relative to that at the root.";
        Material "preset", "Material", "", Kind::Choice(&["none", "straight", "wavy", "curly", "coily", "short-fur"]), "Preset for everything that is not set below. none: a lone human hair.";
        Material "tether", "Tether", "×", number(0.0, 3.0), "Largest distance of a point from its root, relative to that at rest: 1.1 lets curls stretch by a tenth. 0: no limit. The scene file refuses values between 0 and 1.";
        Material "global_shape.pull", "Global shape", "Hz", number(0.0, 20.0), "Frequency of a spring that pulls each point to the groomed shape, carried by the head. 0: off. From 1 a style lasts; from 4 hair looks set.";
        Material "global_shape.tip", "… at the tip", "×", number(0.0, 2.0), "Strength of that spring at the tip, relative to the root.";
        Material "global_shape.damping", "… damping", "", number(0.0, 4.0), "Damping ratio of that spring: 1 is critical.";
        Groom "effects.clump", "Clump", "", number(0.0, 1.0), "How far the tips of follow hairs are drawn to their guide.";
        Groom "effects.curl_radius", "Curl radius", "m", number(0.0, 0.02), "Radius of the curls added to follow hairs.";
        Groom "effects.curl_length", "Curl length", "m", scale(0.002, 0.2), "Length of hair in one turn of those curls.";
        Groom "effects.noise", "Flyaway", "m", number(0.0, 0.02), "How far the tips of follow hairs stray.";
        Groom "transform.position", "Position", "m", Kind::Vector { reach: 5.0 }, "Position of the hairstyle, applied after scale and rotation.";
        Groom "transform.rotation", "Rotation", "°", Kind::Vector { reach: 180.0 }, "Rotation about X, then Y, then Z.";
        Groom "transform.scale", "Scale", "×", Kind::Vector { reach: 10.0 }, "Scale along X, Y and Z. Negative values mirror; 0 is refused.";
    }
    Stiffness {
        Material "model", "Model", "", Kind::Choice(&["auto", "springs", "curvature", "rod"]), "Elastic model of a strand. auto: rod, or curvature where both give the same result.";
        Material "bend", "Bending", "×", scale(0.01, 1000.0), "Stiffness against bending and twisting, relative to a single hair. Neighbors support each other on a head, so styles use more than 1.";
        Material "bend_tip", "… at the tip", "×", number(0.0, 2.0), "Bending stiffness at the tip, relative to the root.";
        Material "damping", "Damping", "s", number(0.0, 0.2), "Relaxation time of bending: larger values stop the hair's own vibration sooner.";
        Material "flatness", "Flatness", "", number(0.05, 1.0), "Short axis of the fiber's cross section over its long axis. 1: round. Only the rod uses it.";
        Material "young", "Young's modulus", "Pa", scale(1e8, 1e11), "Young's modulus along the fiber. Human hair: 3.9e9.";
        Material "shear", "Shear modulus", "Pa", scale(1e7, 1e11), "Shear modulus, which resists twisting. Human hair: 0.89e9.";
    }
    Weight {
        Scene "gravity", "Gravity", "m/s²", Kind::Vector { reach: 30.0 }, "Direction and magnitude of gravity. With a sag-free start, hair is in static balance under any gravity: it keeps its shape and only swings differently. To see it give way, turn \"Sag-free start\" (Solver) off.";
        Material "density", "Density", "kg/m³", number(100.0, 5000.0), "Density of the fiber. Dry human hair: 1310.";
        Material "mass_profile", "Mass profile", "", Kind::Profile, "Relative mass from root to tip, linear in between. Only ratios count: 1, 3 is three times as heavy at the tip.";
        Material "radius", "Fiber radius", "m", Kind::Maybe { min: 1e-5, max: 2e-4, from: 3.5e-5, without: "from the groom" }, "Radius of the fiber, instead of the one in the groom. Human hair: 25e-6 to 50e-6. Restarts the scene.";
    }
    Motion {
        Groom "motion", "Built-in motion", "", Kind::Switch, "Whether the built-in head nods, turns and shakes when the scene has no motion of its own.";
        Scene "clip.start", "First frame", "", Kind::Count { min: 0, max: 500 }, "First frame of the motion file that is used.";
        Scene "clip.rest_frame", "Rest frame", "", Kind::Count { min: 0, max: 500 }, "Frame in which the joint that drives the body counts as being at rest.";
        Scene "clip.travel", "Travel", "", Kind::Choice(&["keep", "in-place", "none"]), "How much of the travel is kept. in-place: only the vertical motion.";
        Scene "clip.facing", "Facing", "°", number(-180.0, 180.0), "Direction of the body, about the vertical from +Z.";
        Scene "solver.inertia", "Head inertia", "×", number(0.0, 1.0), "Share of the head's motion that hair feels. 0: hair moves as if the head stood still.";
    }
    Air {
        Scene "wind.velocity", "Wind", "m/s", Kind::Vector { reach: 20.0 }, "Mean velocity of the air, the same everywhere.";
        Scene "wind.gust", "Gust amount", "", number(0.0, 1.0), "Amplitude of the gusts, as a share of the wind.";
        Scene "wind.gust_rate", "Gust rate", "Hz", number(0.0, 5.0), "Gusts per second.";
        Scene "turbulence.strength", "Turbulence", "m/s", number(0.0, 5.0), "Speed of the eddies that the wind carries along.";
        Scene "turbulence.size", "Eddy size", "m", scale(0.01, 2.0), "Size of the largest eddy.";
        Scene "turbulence.octaves", "Octaves", "", Kind::Count { min: 1, max: 6 }, "Number of eddy sizes, each half as large as the one before.";
        Scene "wind_occlusion.body", "Body occlusion", "1/m", number(0.0, 300.0), "How fast wind falls off inside a body. 100: to a third in a centimeter.";
        Scene "wind_occlusion.hair", "Hair occlusion", "1/m", number(0.0, 300.0), "How fast wind falls off inside hair.";
        Scene "wind_occlusion.reach", "Wake length", "m", number(0.05, 3.0), "Distance behind an occluder at which the wind has recovered.";
        Material "drag", "Drag", "×", number(0.0, 5.0), "Drag of the air on a hair, relative to that on a lone hair.";
        Material "charge", "Static charge", "C/m", number(-1e-8, 1e-8), "Charge per length. Charged bodies attract and repel it. 5e-10 rises in the field of a rubbed balloon.";
    }
    Collision {
        Scene "solver.collide_body", "Body collision", "", Kind::Switch, "Whether hair collides with the body's mesh. Restarts the scene.";
        Scene "solver.contact", "Contact method", "", Kind::Choice(&["both", "penalty", "projection"]), "How hair is kept out of colliders. penalty: a force in the solve (soft). projection: a move to the nearest free position (hard). both: the two together.";
        Scene "solver.segment_contacts", "Segment contacts", "", Kind::Switch, "Whether segments collide between their points too.";
        Material "friction", "Friction", "", number(0.0, 1.0), "Coulomb friction on bodies. Hair on skin: 0.1 to 0.3.";
        Material "friction_kinetic", "… kinetic", "×", number(0.0, 1.0), "Kinetic over static friction. Below 1, hair that comes loose keeps sliding.";
        Scene "solver.teleport_distance", "Teleport distance", "m", scale(0.05, 10.0), "If the head moves farther than this in one frame, beyond its previous motion, the hair is moved rigidly with it.";
    }
    Volume {
        Scene "volume.method", "Volume method", "", Kind::Choice(&["off", "density", "incompressible"]), "off: strands pass through each other. density: pressure where hair is denser than at rest. incompressible: a projection that keeps the density of the rest pose.";
        Scene "volume.friction", "Volume friction", "1/s", number(0.0, 30.0), "How fast hair takes on the velocity of the hair around it.";
        Scene "volume.pressure", "Pressure", "m/s", number(0.0, 3.0), "density: speed at which a compressed region spreads.";
        Scene "volume.recovery_rate", "Volume recovery", "1/s", number(0.0, 100.0), "incompressible: share of the lost volume that is recovered per second.";
        Scene "volume.cell", "Cell size", "m", Kind::Maybe { min: 0.002, max: 0.1, from: 0.015, without: "automatic" }, "Edge of a grid cell. By default the smallest one that holds eight points at rest.";
        Scene "neighbours.on", "Strand contacts", "", Kind::Switch, "Whether simulated strands collide with each other one by one. Exact and slow: for guides and small scenes.";
        Scene "neighbours.radius", "Strand radius", "m", Kind::Maybe { min: 0.0002, max: 0.02, from: 0.002, without: "automatic" }, "Radius of a strand with the hairs that it stands for, at most half the distance to the nearest strand at rest. By default it is found from the hair.";
        Scene "neighbours.friction", "Strand friction", "", number(0.0, 1.0), "Coulomb friction between strands.";
        Scene "neighbours.stiction", "Stiction", "N", number(0.0, 1e-4), "Force that touching segments resist before they separate. A hair of 25 cm weighs 1.6e-5.";
    }
    Look {
        Groom "look.root_color", "Root color", "", Kind::Color, "Color of a thick lock of hair at the root.";
        Groom "look.tip_color", "Tip color", "", Kind::Color, "Color of a thick lock of hair at the tip.";
        Groom "look.melanin", "Melanin", "", Kind::Maybe { min: 0.0, max: 1.0, from: 0.5, without: "the two colors" }, "Pigment concentration, instead of the two colors: 0 is white, 1 is black.";
        Groom "look.melanin_redness", "Redness", "", number(0.0, 1.0), "Share of reddish pigment: brown to red.";
        Groom "look.dye", "Dye", "", Kind::Color, "Dye over melanin or the colors, as it looks on white hair. White: no dye.";
        Groom "look.variation", "Variation", "", number(0.0, 1.0), "Variation of the pigment from strand to strand.";
        Groom "look.roughness", "Roughness", "", number(0.1, 1.0), "Width of the highlights: from oiled to matte.";
        Groom "look.cuticle", "Cuticle", "°", number(0.0, 10.0), "Tilt of the cuticle scales, which separates the white highlight from the colored one.";
        Groom "look.specular", "Specular", "×", number(0.0, 4.0), "Strength of the highlights.";
        Groom "look.backlight", "Backlight", "×", number(0.0, 4.0), "Strength of the light transmitted from behind.";
        Groom "look.scatter", "Scatter", "×", number(0.0, 4.0), "Strength of the light scattered from strand to strand.";
        Groom "look.shadow", "Shadow", "×", number(0.0, 4.0), "Strength of the shadows cast by strands.";
        Scene "body.color", "Skin color", "", Kind::MaybeColor { from: [0.5, 0.3, 0.23], without: "from the file" }, "Color of the whole body, instead of its file's.";
        Scene "body.roughness", "Skin roughness", "", Kind::Maybe { min: 0.0, max: 1.0, from: 0.5, without: "from the file" }, "From glossy to matte, instead of the body file's.";
        Scene "ground.on", "Ground", "", Kind::Switch, "Whether a level floor receives the shadow of body and hair. It is only drawn: to collide, add a collider.";
        Scene "ground.height", "… height", "m", Kind::Maybe { min: -2.0, max: 2.0, from: 0.0, without: "under the body" }, "Height along the up axis. By default the lowest point of the body at rest. Everything below it is hidden.";
        Scene "ground.color", "… color", "", Kind::MaybeColor { from: [0.4, 0.37, 0.33], without: "shadow alone" }, "Color of the floor, which fades into the backdrop. By default only its shadow is drawn.";
    }
    Camera {
        Scene "camera.position", "Camera position", "m", Kind::Vector { reach: 10.0 }, "Position of the scene's camera, used when the scene is opened and rendered. The window's own camera is turned by hand.";
        Scene "camera.target", "Camera target", "m", Kind::Vector { reach: 10.0 }, "Point that the camera looks at.";
        Scene "camera.fov", "Field of view", "°", number(5.0, 90.0), "Vertical field of view: small for a distant portrait, large for a whole room.";
    }
    Solver {
        Scene "solver.integrator", "Integrator", "", Kind::Choice(&["backward-euler", "bdf2", "explicit-euler", "verlet", "local-global", "ftl", "dftl"]), "Time integrator of a substep. The explicit ones become unstable; they are there for comparison.";
        Scene "solver.substeps", "Substeps", "", Kind::Count { min: 1, max: 64 }, "Substeps per 1/60 s. The scene file accepts up to 1024.";
        Scene "solver.projection_iterations", "Iterations", "", Kind::Count { min: 0, max: 20 }, "Iterations of fast projection per substep, which keep segments at their length.";
        Scene "solver.quality", "Quality", "", Kind::Choice(&["normal", "high"]), "normal: one linear solve per substep. high: Newton iterations to convergence.";
        Scene "solver.sag_free", "Sag-free start", "", Kind::Switch, "Whether rest shapes are solved so that the groom is in static balance as authored.";
        Scene "solver.preroll", "Pre-roll", "s", number(0.0, 10.0), "Time that hair falls before the scene begins; its final shape becomes the start. Use 3 for hair that is grown. Restarts the scene.";
        Scene "solver.global_shape", "Use global shape", "", Kind::Switch, "Whether the global shape of the materials is applied.";
    }
};

impl Parameter {
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
