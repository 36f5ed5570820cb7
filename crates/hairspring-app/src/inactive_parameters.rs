//! Parameters without effect in the current scene, because a feature is off or another value replaces them.
//! The panel grays them out and shows the reason.

use crate::{document::Document, key::Key, parameter::Parameter};

/// A scene and the selection that the rules are evaluated for.
struct Asked<'a> {
    document: &'a Document,
    /// Keys of the selected groom, and of the material of the selected group.
    groom: Key,
    material: Key,
}

impl Asked<'_> {
    fn value(&self, key: &Key) -> Option<&toml::Value> {
        key.look_up(self.document.effective())
    }

    fn scene(&self, name: &str) -> Option<&toml::Value> {
        self.value(&Key::default().field(name))
    }

    fn groom(&self, name: &str) -> Option<&toml::Value> {
        self.value(&self.groom.field(name))
    }

    fn material(&self, name: &str) -> Option<&toml::Value> {
        self.value(&self.material.field(name))
    }

    fn integrator(&self) -> &str {
        word(self.scene("solver.integrator"))
    }

    /// Whether hair bends: follow the leader only keeps lengths.
    fn bends(&self) -> bool {
        !["ftl", "dftl"].contains(&self.integrator())
    }

    /// Whether there is any air motion.
    fn blows(&self) -> bool {
        some(self.scene("wind.velocity"))
            || some(self.scene("turbulence.strength"))
            || some(self.scene("wind_source"))
    }
}

/// Whether a switch is on, a number or one of several is not 0, or a list has entries.
fn some(value: Option<&toml::Value>) -> bool {
    match value {
        Some(toml::Value::Boolean(on)) => *on,
        Some(toml::Value::Integer(n)) => *n != 0,
        Some(toml::Value::Float(x)) => *x != 0.0,
        Some(toml::Value::Array(list)) => list.iter().any(|x| some(Some(x))),
        other => other.is_some(),
    }
}

fn word(value: Option<&toml::Value>) -> &str {
    value.and_then(toml::Value::as_str).unwrap_or_default()
}

impl Parameter {
    /// Why a parameter has no effect in this scene, for this groom and group; `None` if it has.
    pub fn inactive_reason(
        &self,
        document: &Document,
        (groom, group): (usize, usize),
    ) -> Option<&'static str> {
        let groom = Key::top("groom").place(groom);
        let asked = Asked { document, material: groom.field("material").place(group), groom };
        let global_shapes = some(asked.scene("solver.global_shape"));
        let method = word(asked.scene("volume.method"));
        let occluded = ["wind_occlusion.body", "wind_occlusion.hair"].map(|name| some(asked.scene(name)));
        let (counts, why) = match self.name {
            "motion" => (asked.scene("clip").is_none(), "No effect: the scene has a motion of its own."),
            "thicken.radius" | "thicken.tip" => {
                (some(asked.groom("thicken.copies")), "No effect unless \"Copies per strand\" is above 0.")
            }
            "effects.curl_length" => {
                (some(asked.groom("effects.curl_radius")), "No effect unless \"Curl radius\" is above 0.")
            }
            "global_shape.pull" => (global_shapes, "No effect while \"Use global shape\" (Solver) is off."),
            "global_shape.tip" | "global_shape.damping" => (
                global_shapes && some(asked.material("global_shape.pull")),
                "No effect unless \"Global shape\" is above 0.",
            ),
            "model" | "bend" | "bend_tip" | "damping" | "flatness" | "young" if !asked.bends() => {
                (false, "No effect: the follow-the-leader integrators (Solver) have no bending.")
            }
            "model" => (
                asked.integrator() != "local-global",
                "No effect: the local-global integrator (Solver) has its own elastic model.",
            ),
            "shear" => (
                asked.bends()
                    && asked.integrator() != "local-global"
                    && word(asked.material("model")) != "curvature",
                "No effect: only the models rod and springs twist, with an integrator that uses them.",
            ),
            "wind.gust" => (some(asked.scene("wind.velocity")), "No effect without wind."),
            "wind.gust_rate" => (
                some(asked.scene("wind.velocity")) && some(asked.scene("wind.gust")),
                "No effect without wind and gusts.",
            ),
            "turbulence.size" | "turbulence.octaves" => {
                (some(asked.scene("turbulence.strength")), "No effect unless \"Turbulence\" is above 0.")
            }
            "wind_occlusion.body" | "wind_occlusion.hair" => {
                (asked.blows(), "No effect unless the air moves: by wind, turbulence or a wind source.")
            }
            "wind_occlusion.reach" => (
                asked.blows() && occluded.contains(&true),
                "No effect unless the air moves and bodies or hair occlude it.",
            ),
            "friction_kinetic" => {
                (some(asked.material("friction")), "No effect unless \"Friction\" is above 0.")
            }
            "charge" => (
                asked.scene("charged").and_then(toml::Value::as_array).is_some_and(|list| !list.is_empty()),
                "No effect without a charged body: add one below.",
            ),
            "volume.friction" => (method != "off", "No effect while \"Volume method\" is off."),
            "volume.pressure" => (method == "density", "Only used by the volume method density."),
            "volume.recovery_rate" => {
                (method == "incompressible", "Only used by the volume method incompressible.")
            }
            "volume.cell" => (
                method != "off" || occluded[1],
                "No effect unless \"Volume method\" is on or hair occludes the wind.",
            ),
            "neighbours.radius" | "neighbours.friction" | "neighbours.stiction" => {
                (some(asked.scene("neighbours.on")), "No effect unless \"Strand contacts\" is on.")
            }
            "look.root_color" | "look.tip_color" => (
                asked.groom("look.melanin").is_none(),
                "No effect while \"Melanin\" is on: it replaces the colors.",
            ),
            "look.melanin_redness" => {
                (asked.groom("look.melanin").is_some(), "No effect unless \"Melanin\" is on.")
            }
            "ground.height" | "ground.color" => {
                (some(asked.scene("ground.on")), "No effect unless \"Ground\" is on.")
            }
            "solver.projection_iterations" => (
                ["backward-euler", "bdf2"].contains(&asked.integrator()),
                "Only used by backward-euler and bdf2.",
            ),
            "solver.quality" => (
                ["backward-euler", "bdf2", "local-global"].contains(&asked.integrator()),
                "Only used by backward-euler, bdf2 and local-global.",
            ),
            _ => return None,
        };
        (!counts).then_some(why)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter;

    const HEAD: &str = "[builtin]\nstrands = 10\nguides = 5\n";

    fn idle(text: &str, name: &str) -> bool {
        let document = Document::new("scene.toml".as_ref(), text.into()).unwrap();
        let parameter = parameter::ALL.iter().find(|p| p.name == name).unwrap();
        parameter.inactive_reason(&document, (0, 0)).is_some()
    }

    /// Parameters without effect in the built-in scene, and text that activates them.
    const WOKEN: [(&str, &str); 23] = [
        ("effects.curl_length", "[builtin.effects]\ncurl_radius = 0.004\n"),
        ("global_shape.tip", "[material.m]\nglobal_shape = { pull = 2.0 }\n"),
        ("global_shape.damping", "[material.m]\nglobal_shape = { pull = 2.0 }\n"),
        ("wind.gust", "[wind]\nvelocity = [0.0, 0.0, 2.0]\n"),
        ("wind.gust_rate", "[wind]\nvelocity = [0.0, 0.0, 2.0]\ngust = 0.5\n"),
        ("turbulence.size", "[turbulence]\nstrength = 1.0\n"),
        ("turbulence.octaves", "[turbulence]\nstrength = 1.0\n"),
        ("wind_occlusion.body", "[turbulence]\nstrength = 1.0\n"),
        (
            "wind_occlusion.hair",
            "[[wind_source]]\nshape.point = { center = [0.2, 1.5, 0.0], radius = 0.05, speed = 2.0 }\n",
        ),
        ("wind_occlusion.reach", "[wind]\nvelocity = [0.0, 0.0, 2.0]\n[wind_occlusion]\nhair = 20.0\n"),
        ("charge", "[[charged]]\ncenter = [0.0, 1.8, 0.0]\nradius = 0.1\ncharge = 1e-7\n"),
        ("volume.friction", "[volume]\nmethod = \"density\"\n"),
        ("volume.pressure", "[volume]\nmethod = \"density\"\n"),
        ("volume.recovery_rate", "[volume]\nmethod = \"incompressible\"\n"),
        ("volume.cell", "[volume]\nmethod = \"density\"\n"),
        ("volume.cell", "[wind_occlusion]\nhair = 20.0\n"),
        ("neighbours.radius", "[neighbours]\non = true\n"),
        ("neighbours.friction", "[neighbours]\non = true\n"),
        ("neighbours.stiction", "[neighbours]\non = true\n"),
        ("look.melanin_redness", "[builtin.look]\nmelanin = 0.5\n"),
        ("ground.height", "[ground]\non = true\n"),
        ("ground.color", "[ground]\non = true\n"),
        ("look.melanin_redness", "[builtin.look]\nmelanin = 0.5\nmelanin_redness = 0.5\n"),
    ];

    #[test]
    fn what_is_off_is_idle_and_wakes_when_it_is_switched_on() {
        for (name, on) in WOKEN {
            assert!(idle(HEAD, name), "{name} while it is off");
            let with = HEAD.replace("guides = 5\n", "guides = 5\nmaterial = \"m\"\n");
            let text =
                if on.starts_with("[material") { format!("{with}{on}") } else { format!("{HEAD}{on}") };
            assert!(!idle(&text, name), "{name} with {on}");
        }
    }

    #[test]
    fn what_the_integrator_or_the_motion_does_not_know_is_idle() {
        for (name, text) in [
            ("bend", "[solver]\nintegrator = \"dftl\"\n"),
            ("shear", "[solver]\nintegrator = \"local-global\"\n"),
            ("model", "[solver]\nintegrator = \"local-global\"\n"),
            ("solver.projection_iterations", "[solver]\nintegrator = \"verlet\"\n"),
            ("solver.quality", "[solver]\nintegrator = \"ftl\"\n"),
            ("global_shape.pull", "[solver]\nglobal_shape = false\n"),
            ("friction_kinetic", "material = \"m\"\n[material.m]\nfriction = 0.0\n"),
            (
                "motion",
                "[clip]\nkeys = [{ time = 0.0, position = [0.0, 0.0, 0.0], rotation = [0.0, 0.0, 0.0] }]\n",
            ),
        ] {
            assert!(!idle(HEAD, name), "{name} counts by default");
            assert!(idle(&format!("{HEAD}{text}"), name), "{name} with {text}");
        }
        // Values that replace others.
        assert!(idle(&format!("{HEAD}[builtin.look]\nmelanin = 0.5\n"), "look.root_color"));
    }
}
