//! Every parameter of a scene file that is one number, switch, choice, colour or direction, as an artist looks for it: what it is called, its unit, its range, what it does. Their defaults are the
//! library's; entries of lists (colliders, hands, sources of wind, charged bodies, keys) are in `field`.

use crate::{document::Document, key::Key};
use hairspring::material::PRESETS;

/// What an artist thinks of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// What hair it is, how much of it, and what is laid over it.
    Style,
    /// How hair holds its shape.
    Stiffness,
    /// How heavy it is.
    Weight,
    /// How the body moves.
    Motion,
    /// What blows.
    Air,
    /// Bodies.
    Collision,
    /// Hair on hair.
    Volume,
    /// Colour and gloss.
    Look,
    /// Where it is seen from.
    Camera,
    /// How time is cut.
    Solver,
}

impl Group {
    /// All of them, in the order of the panel.
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

    /// Its heading.
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

/// What a parameter is a setting of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    /// The scene.
    Scene,
    /// The chosen groom.
    Groom,
    /// The material of the chosen group of it.
    Material,
}

/// What values it takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A number; the range of its slider, which is not always all that the file takes.
    Number {
        /// Least.
        min: f64,
        /// Most.
        max: f64,
        /// Whether equal ways of the slider are equal factors.
        log: bool,
    },
    /// A number that may be left out, with what to begin from.
    Maybe {
        /// Least.
        min: f64,
        /// Most.
        max: f64,
        /// Where it starts when it is switched on.
        from: f64,
        /// What counts while it is left out.
        without: &'static str,
    },
    /// A whole number of guides, or a word for them.
    Guides {
        /// Most.
        max: i64,
    },
    /// A whole number; where it spans more than a thousandfold, equal ways of the slider are equal factors.
    Count {
        /// Least.
        min: i64,
        /// Most.
        max: i64,
    },
    /// On or off.
    Switch,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// Linear red, green, blue.
    Color,
    /// A colour that may be left out.
    MaybeColor {
        /// Where it starts when it is switched on.
        from: [f64; 3],
        /// What counts while it is left out.
        without: &'static str,
    },
    /// Three numbers.
    Vector {
        /// Farthest from 0 of each.
        reach: f64,
    },
    /// Numbers from root to tip.
    Profile,
}

/// A parameter of the scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Where it stands.
    pub group: Group,
    /// What it is a setting of.
    pub of: Of,
    /// Its name there.
    pub name: &'static str,
    /// What it is called.
    pub label: &'static str,
    /// Its unit, empty for plain numbers.
    pub unit: &'static str,
    /// Values.
    pub kind: Kind,
    /// What it does.
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

/// All of them.
pub const ALL: &[Parameter] = parameters! {
    Style {
        Groom "style", "Hairstyle", "", Kind::Choice(&PRESETS), "Of the built-in head: cut, wave, colour and material together.";
        Groom "strands", "Hairs", "", Kind::Count { min: 100, max: 200_000 }, "On the scalp of the built-in head. A human head has about 100,000; fewer are drawn wider, so that they still cover it. The file takes up to 10,000,000.";
        Groom "guides", "Guides", "", Kind::Guides { max: 20_000 }, "How many of the hairs are simulated; the others follow up to three of them. Few guides move hair in slabs, many cost time. file: those that the groom's file names.";
        Groom "grow.strands", "Hairs", "", Kind::Count { min: 10, max: 200_000 }, "That are grown from the body, evenly by area.";
        Groom "grow.length", "Length", "m", scale(0.002, 1.0), "Of the longest hair.";
        Groom "grow.spread", "Length varies", "", number(0.0, 1.0), "How much shorter the shortest hair is than the longest.";
        Groom "grow.fall", "Bent down", "", number(0.0, 1.0), "How far hair bends over as it grows: 0 stands along the skin's normal, 1 ends pointing down.";
        Groom "grow.points", "Points of a hair", "", Kind::Count { min: 3, max: 64 }, "More bend finer, and cost as much more time.";
        Groom "thicken.copies", "Hairs around each", "", Kind::Count { min: 0, max: 20 }, "Follow hairs that are added around each strand of the file.";
        Groom "thicken.radius", "… within", "m", number(0.0, 0.01), "Radius of the disc on the skin that they grow in.";
        Groom "thicken.tip", "… at the tip", "×", number(0.0, 10.0), "How many times as far from their strand they are at the tip as at the root.";
        Material "preset", "Material", "", Kind::Choice(&["none", "straight", "wavy", "curly", "coily", "short-fur"]), "What the material begins from: all that is not set below. none: a lone human hair.";
        Material "tether", "Tether", "×", number(0.0, 3.0), "How far a point may get from its root, over how far it was at rest: 1.1 lets curls fall a tenth. 0: as far as they go. Below 1 the scene file is refused.";
        Material "ghost.pull", "Keep the style", "Hz", number(0.0, 20.0), "Pull to the groomed shape, carried by the head: how fast a lone point would swing about its place. 0: none; from 1 a style lasts, from 4 hair is set.";
        Material "ghost.tip", "… at the tip", "×", number(0.0, 2.0), "That pull at the tip, over that at the root.";
        Material "ghost.damping", "… damping", "", number(0.0, 4.0), "Damping of that pull over the critical: 1 does not swing.";
        Groom "effects.clump", "Clump", "", number(0.0, 1.0), "How far the tips of follow hairs are drawn to their guide.";
        Groom "effects.curl_radius", "Curl radius", "m", number(0.0, 0.02), "Radius of the curls laid over follow hairs.";
        Groom "effects.curl_length", "Curl length", "m", scale(0.002, 0.2), "Length of hair in one turn of those curls.";
        Groom "effects.noise", "Flyaway", "m", number(0.0, 0.02), "How far the tips of follow hairs stray.";
        Groom "transform.position", "Moved by", "m", Kind::Vector { reach: 5.0 }, "Where the hairstyle stands: after it is scaled and turned.";
        Groom "transform.rotation", "Turned by", "°", Kind::Vector { reach: 180.0 }, "About X, then Y, then Z.";
        Groom "transform.scale", "Scaled by", "×", Kind::Vector { reach: 10.0 }, "Along x, y and z; below 0 mirrors. 0 is refused.";
    }
    Stiffness {
        Material "model", "Model", "", Kind::Choice(&["auto", "springs", "curvature", "rod"]), "What holds a strand's shape. auto: the rod, or curvature where it comes to the same.";
        Material "bend", "Bending", "×", scale(0.01, 1000.0), "Stiffness against bending and twisting, over that of a single hair. A head of hair is held by its neighbours, so styles use more than 1.";
        Material "bend_tip", "… at the tip", "×", number(0.0, 2.0), "Bending stiffness at the tip over that at the root.";
        Material "damping", "Damping", "s", number(0.0, 0.2), "Relaxation time of bending: more stops the hair's own swinging sooner.";
        Material "flatness", "Flatness", "", number(0.05, 1.0), "Short over long axis of the fibre's section. 1: round. For the rod.";
        Material "young", "Young's modulus", "Pa", scale(1e8, 1e11), "Stiffness of the fibre's substance along it. Human hair: 3.9e9.";
        Material "shear", "Shear modulus", "Pa", scale(1e7, 1e11), "Stiffness of the substance against twisting. Human hair: 0.89e9.";
    }
    Weight {
        Scene "gravity", "Gravity", "m/s²", Kind::Vector { reach: 30.0 }, "Which way things fall, and how fast. Hair that starts in balance is put in balance under every gravity anew: it keeps its shape, and swings otherwise. To see it give way, switch off \"Starts in balance\" (Solver).";
        Material "density", "Density", "kg/m³", number(100.0, 5000.0), "Of the fibre. Dry human hair: 1310.";
        Material "mass_profile", "Mass along it", "", Kind::Profile, "Weights from root to tip, linear in between; only their ratios count: 1, 3 is three times as heavy at the tip.";
        Material "radius", "Fibre radius", "m", Kind::Maybe { min: 1e-5, max: 2e-4, from: 3.5e-5, without: "as the groom has it" }, "Of the fibre, in place of the groom's own. Human hair: 25e-6 to 50e-6. It begins the scene anew.";
    }
    Motion {
        Groom "motion", "Moves by itself", "", Kind::Switch, "Whether the built-in head nods, turns and shakes where the scene has no motion of its own.";
        Scene "clip.start", "Begins at frame", "", Kind::Count { min: 0, max: 500 }, "First frame of the motion's file that is used.";
        Scene "clip.rest_frame", "Rests in frame", "", Kind::Count { min: 0, max: 500 }, "The frame in which the joint that drives the body counts as being at rest.";
        Scene "clip.travel", "Travels", "", Kind::Choice(&["keep", "in-place", "none"]), "What is kept of it. in-place: bobbing only.";
        Scene "clip.facing", "Faces", "°", number(-180.0, 180.0), "Direction of the body, about the vertical from +Z.";
        Scene "solver.inertia", "Head's inertia", "×", number(0.0, 1.0), "How much of the head's motion hair feels: 0, and it moves as if the head stood still.";
    }
    Air {
        Scene "wind.velocity", "Wind", "m/s", Kind::Vector { reach: 20.0 }, "Mean velocity of the air, everywhere.";
        Scene "wind.gust", "Gusts", "", number(0.0, 1.0), "How much gusts add and take, as a share of the wind.";
        Scene "wind.gust_rate", "Gusts a second", "Hz", number(0.0, 5.0), "How often they come.";
        Scene "turbulence.strength", "Turbulence", "m/s", number(0.0, 5.0), "Speed of eddies that the wind carries along.";
        Scene "turbulence.size", "Largest eddy", "m", scale(0.01, 2.0), "Its size.";
        Scene "turbulence.octaves", "Sizes of eddies", "", Kind::Count { min: 1, max: 6 }, "How many, each half as large as the one before.";
        Scene "shelter.body", "Shelter by bodies", "1/m", number(0.0, 300.0), "How fast wind falls off inside a body. 100: to a third in a centimetre.";
        Scene "shelter.hair", "Shelter by hair", "1/m", number(0.0, 300.0), "How fast wind falls off inside hair.";
        Scene "shelter.reach", "Lee", "m", number(0.05, 3.0), "How far behind them the wind is whole again.";
        Material "drag", "Drag", "×", number(0.0, 5.0), "Of the air on a hair, over that on a lone one.";
        Material "charge", "Static charge", "C/m", number(-1e-8, 1e-8), "Of a length of hair: it is pushed and pulled by charged bodies. 5e-10 rises in the field of a rubbed balloon.";
    }
    Collision {
        Scene "solver.collide_body", "Meets the body", "", Kind::Switch, "Whether hair collides with the body's mesh. It begins the scene anew.";
        Scene "solver.contact", "Answered by", "", Kind::Choice(&["both", "penalty", "projection"]), "What keeps hair out of bodies: a force in the solve (penalty: soft), the move to the nearest free place (projection: hard), or both.";
        Scene "solver.segments", "Between points", "", Kind::Switch, "Whether hair stays out of bodies between its points too.";
        Material "friction", "Friction", "", number(0.0, 1.0), "Coulomb friction on bodies. Hair on skin: 0.1 to 0.3.";
        Material "friction_kinetic", "… of what slides", "×", number(0.0, 1.0), "Kinetic friction over static: below 1 hair that comes loose goes on sliding.";
        Scene "solver.jump", "A jump is", "m", scale(0.05, 10.0), "A head that moves farther in a frame, over how it moved before, has jumped, and hair goes with it as it is.";
    }
    Volume {
        Scene "volume.method", "Hair on hair", "", Kind::Choice(&["off", "density", "incompressible"]), "off: strands pass through each other. density: pressure where hair is denser than at rest. incompressible: firm.";
        Scene "volume.friction", "Friction in hair", "1/s", number(0.0, 30.0), "How fast hair takes on the velocity of the hair around it.";
        Scene "volume.pressure", "Pressure", "m/s", number(0.0, 3.0), "density: speed with which a crowd spreads.";
        Scene "volume.regain", "Regain", "1/s", number(0.0, 100.0), "incompressible: share of lost volume that is regained a second.";
        Scene "volume.cell", "Cell", "m", Kind::Maybe { min: 0.002, max: 0.1, from: 0.015, without: "found by itself" }, "Edge of a cell of the lattice; left out, the smallest that holds eight points at rest.";
        Scene "neighbours.on", "Strand on strand", "", Kind::Switch, "Whether simulated strands meet each other one by one: exact, and slow. For guides and small scenes.";
        Scene "neighbours.radius", "Radius of a strand", "m", Kind::Maybe { min: 0.0002, max: 0.02, from: 0.002, without: "found by itself" }, "With the hairs that it stands for; nowhere more than half of the way to the next at rest. Left out, half of that way in the mean.";
        Scene "neighbours.friction", "Friction of strands", "", number(0.0, 1.0), "Coulomb friction of strands on each other.";
        Scene "neighbours.stiction", "Stiction", "N", number(0.0, 1e-4), "Force that touching segments hold together with until more pulls. A hair of 25 cm weighs 1.6e-5.";
    }
    Look {
        Groom "look.root_color", "Root", "", Kind::Color, "What a thick lock of it looks like at the root.";
        Groom "look.tip_color", "Tip", "", Kind::Color, "And at the tip.";
        Groom "look.melanin", "Melanin", "", Kind::Maybe { min: 0.0, max: 1.0, from: 0.5, without: "the two colours" }, "Pigment in place of the two colours: 0 is white, 1 is black.";
        Groom "look.melanin_redness", "Redness", "", number(0.0, 1.0), "Share of the pigment that is the reddish one: brown to red.";
        Groom "look.dye", "Dye", "", Kind::Color, "What white hair would be dyed, over melanin or the colours; white is no dye.";
        Groom "look.variation", "Variation", "", number(0.0, 1.0), "How much pigment differs from strand to strand.";
        Groom "look.roughness", "Roughness", "", number(0.1, 1.0), "Spread of the highlights: oiled to matt.";
        Groom "look.cuticle", "Cuticle", "°", number(0.0, 10.0), "Tilt of the scales, which parts the white highlight from the coloured one.";
        Groom "look.specular", "Highlights", "×", number(0.0, 4.0), "Their strength.";
        Groom "look.backlight", "Backlight", "×", number(0.0, 4.0), "Strength of light that shines through from behind.";
        Groom "look.scatter", "Scatter", "×", number(0.0, 4.0), "Strength of light from strand to strand.";
        Groom "look.shadow", "Shadow", "×", number(0.0, 4.0), "How strongly strands shade what is behind them.";
        Scene "body.color", "Skin", "", Kind::MaybeColor { from: [0.5, 0.3, 0.23], without: "as its file has it" }, "Colour of the body's whole surface, in place of its file's.";
        Scene "body.roughness", "Roughness of skin", "", Kind::Maybe { min: 0.0, max: 1.0, from: 0.5, without: "as its file has it" }, "Glossy to matt, in place of the body's file's.";
        Scene "ground.on", "Ground", "", Kind::Switch, "Whether a level floor takes the shadow of body and hair. It is a matter of the picture: hair meets colliders.";
        Scene "ground.height", "… lies at", "m", Kind::Maybe { min: -2.0, max: 2.0, from: 0.0, without: "under the body" }, "On the axis that points up. Left out, at the lowest point of the body at rest. What is below it is hidden.";
        Scene "ground.color", "… is of colour", "", Kind::MaybeColor { from: [0.4, 0.37, 0.33], without: "shadow alone" }, "A floor's own, which fades into the backdrop; left out, shadow alone is seen.";
    }
    Camera {
        Scene "camera.position", "Stands at", "m", Kind::Vector { reach: 10.0 }, "The scene's own camera, which looks when it is opened and rendered. The window's is turned by hand.";
        Scene "camera.target", "Looks at", "m", Kind::Vector { reach: 10.0 }, "What that camera looks at.";
        Scene "camera.fov", "Opens by", "°", number(5.0, 90.0), "Its vertical field of view: small from far is a portrait, large takes in the room.";
    }
    Solver {
        Scene "solver.integrator", "Integrator", "", Kind::Choice(&["backward-euler", "bdf2", "explicit-euler", "verlet", "local-global", "ftl", "dftl"]), "How a substep is made. The explicit ones blow up: they are there to be compared.";
        Scene "solver.substeps", "Substeps", "", Kind::Count { min: 1, max: 64 }, "In a frame of 1/60 s.";
        Scene "solver.projections", "Projections", "", Kind::Count { min: 0, max: 20 }, "Iterations a substep that keep hair at its length.";
        Scene "solver.quality", "Quality", "", Kind::Choice(&["normal", "high"]), "normal: one linear solve a substep. high: Newton to the end.";
        Scene "solver.sag_free", "Starts in balance", "", Kind::Switch, "Whether rest shapes are solved so that the groom hangs as it was made.";
        Scene "solver.settle", "Falls first", "s", number(0.0, 10.0), "How long hair falls from where it was made before the scene begins; it rests where it lies then. For hair that is grown: 3. It begins the scene anew.";
        Scene "solver.ghost", "Ghost shapes", "", Kind::Switch, "Whether styles are kept by their materials' pull.";
    }
};

impl Parameter {
    /// Where its effective value stands, for this groom and group.
    pub fn key(&self, groom: usize, group: usize) -> Key {
        match self.of {
            Of::Scene => Key::default().field(self.name),
            Of::Groom => Key::top("groom").place(groom).field(self.name),
            Of::Material => Key::top("groom").place(groom).field("material").place(group).field(self.name),
        }
    }

    /// Whether it is of hair, body or motion themselves: the scene begins anew with it.
    pub fn is_geometry(&self) -> bool {
        const NAMES: [&str; 7] =
            ["style", "strands", "guides", "motion", "radius", "solver.collide_body", "solver.settle"];
        const TABLES: [&str; 5] = ["grow", "thicken", "transform", "clip", "body"];
        NAMES.contains(&self.name) || self.name.split_once('.').is_some_and(|(t, _)| TABLES.contains(&t))
    }

    /// Where the text may say it; `None` where it has no place for it yet.
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

    /// Where to write it; a material of its own is made for the group where it has none.
    pub fn place(&self, document: &mut Document, groom: usize, group: usize) -> Result<Key, crate::AppError> {
        match self.of {
            Of::Material => document.own_material(groom, group, self.name),
            _ => self
                .said(document, groom, group)
                .ok_or_else(|| crate::AppError::new(format!("the scene says nothing of groom {groom}"))),
        }
    }
}
