//! Parameters that do not count as the scene stands: what they belong to is off, or something else takes their place. Each is grey in the panel and says why, so that no slider is moved in vain.

use crate::{document::Document, key::Key, parameter::Parameter};

/// What counts in a scene, as its rules ask for it.
struct Asked<'a> {
    document: &'a Document,
    /// Of the chosen groom, and of the chosen group of it.
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

    /// Whether hair bends: follow the leader knows of lengths alone.
    fn bends(&self) -> bool {
        !["ftl", "dftl"].contains(&self.integrator())
    }

    /// Whether any air is moved.
    fn blows(&self) -> bool {
        some(self.scene("wind.velocity"))
            || some(self.scene("turbulence.strength"))
            || some(self.scene("wind_source"))
    }
}

/// Whether a switch is on, a number or one of several is other than 0, a list has entries.
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
    /// Why it does not count in this scene, for this groom and group of it; `None`: it does.
    pub fn idle(&self, document: &Document, (groom, group): (usize, usize)) -> Option<&'static str> {
        let groom = Key::top("groom").place(groom);
        let asked = Asked { document, material: groom.field("material").place(group), groom };
        let ghosts = some(asked.scene("solver.ghost"));
        let method = word(asked.scene("volume.method"));
        let sheltered = ["shelter.body", "shelter.hair"].map(|name| some(asked.scene(name)));
        let (counts, why) = match self.name {
            "motion" => (
                asked.scene("clip").is_none(),
                "Does not count beside the scene's own motion, which moves it.",
            ),
            "thicken.radius" | "thicken.tip" => {
                (some(asked.groom("thicken.copies")), "Counts only with \"Hairs around each\" above 0.")
            }
            "effects.curl_length" => {
                (some(asked.groom("effects.curl_radius")), "Counts only with a curl radius above 0.")
            }
            "ghost.pull" => (ghosts, "Does not count while \"Ghost shapes\" (Solver) is off."),
            "ghost.tip" | "ghost.damping" => (
                ghosts && some(asked.material("ghost.pull")),
                "Counts only while \"Keep the style\" is above 0.",
            ),
            "model" | "bend" | "bend_tip" | "damping" | "flatness" | "young" if !asked.bends() => {
                (false, "Does not count: follow the leader (Solver, Integrator) has no bending.")
            }
            "model" => (
                asked.integrator() != "local-global",
                "Does not count: local-global (Solver, Integrator) has a model of its own.",
            ),
            "shear" => (
                asked.bends()
                    && asked.integrator() != "local-global"
                    && word(asked.material("model")) != "curvature",
                "Does not count: nothing here twists. It takes the model rod or springs, and an integrator that bends hair by it.",
            ),
            "wind.gust" => (some(asked.scene("wind.velocity")), "Counts only while there is wind."),
            "wind.gust_rate" => (
                some(asked.scene("wind.velocity")) && some(asked.scene("wind.gust")),
                "Counts only while there are wind and gusts.",
            ),
            "turbulence.size" | "turbulence.octaves" => {
                (some(asked.scene("turbulence.strength")), "Counts only while Turbulence is above 0.")
            }
            "shelter.body" | "shelter.hair" => {
                (asked.blows(), "Counts only while air moves: by wind, turbulence or a source.")
            }
            "shelter.reach" => (
                asked.blows() && sheltered.contains(&true),
                "Counts only while bodies or hair shelter from moving air.",
            ),
            "friction_kinetic" => {
                (some(asked.material("friction")), "Counts only while Friction is above 0.")
            }
            "charge" => (
                asked.scene("charged").and_then(toml::Value::as_array).is_some_and(|list| !list.is_empty()),
                "Counts only beside a charged body: add one below.",
            ),
            "volume.friction" => (method != "off", "Counts only while \"Hair on hair\" is not off."),
            "volume.pressure" => (method == "density", "Counts only while \"Hair on hair\" is density."),
            "volume.regain" => {
                (method == "incompressible", "Counts only while \"Hair on hair\" is incompressible.")
            }
            "volume.cell" => (
                method != "off" || sheltered[1],
                "Counts only while \"Hair on hair\" is not off, or hair shelters from the wind.",
            ),
            "neighbours.radius" | "neighbours.friction" | "neighbours.stiction" => {
                (some(asked.scene("neighbours.on")), "Counts only while \"Strand on strand\" is ticked.")
            }
            "look.root_color" | "look.tip_color" => (
                asked.groom("look.melanin").is_none(),
                "Does not count while Melanin is ticked, which takes its place.",
            ),
            "look.melanin_redness" => {
                (asked.groom("look.melanin").is_some(), "Counts only while Melanin is ticked.")
            }
            "ground.height" | "ground.color" => {
                (some(asked.scene("ground.on")), "Counts only while Ground is ticked.")
            }
            "solver.projections" => (
                ["backward-euler", "bdf2"].contains(&asked.integrator()),
                "Counts for backward-euler and bdf2 alone.",
            ),
            "solver.quality" => (
                ["backward-euler", "bdf2", "local-global"].contains(&asked.integrator()),
                "Counts for backward-euler, bdf2 and local-global alone.",
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
        parameter.idle(&document, (0, 0)).is_some()
    }

    /// Parameters that do not count in the built-in scene, and what makes them count.
    const WOKEN: [(&str, &str); 23] = [
        ("effects.curl_length", "[builtin.effects]\ncurl_radius = 0.004\n"),
        ("ghost.tip", "[material.m]\nghost = { pull = 2.0 }\n"),
        ("ghost.damping", "[material.m]\nghost = { pull = 2.0 }\n"),
        ("wind.gust", "[wind]\nvelocity = [0.0, 0.0, 2.0]\n"),
        ("wind.gust_rate", "[wind]\nvelocity = [0.0, 0.0, 2.0]\ngust = 0.5\n"),
        ("turbulence.size", "[turbulence]\nstrength = 1.0\n"),
        ("turbulence.octaves", "[turbulence]\nstrength = 1.0\n"),
        ("shelter.body", "[turbulence]\nstrength = 1.0\n"),
        (
            "shelter.hair",
            "[[wind_source]]\nshape.point = { center = [0.2, 1.5, 0.0], radius = 0.05, speed = 2.0 }\n",
        ),
        ("shelter.reach", "[wind]\nvelocity = [0.0, 0.0, 2.0]\n[shelter]\nhair = 20.0\n"),
        ("charge", "[[charged]]\ncenter = [0.0, 1.8, 0.0]\nradius = 0.1\ncharge = 1e-7\n"),
        ("volume.friction", "[volume]\nmethod = \"density\"\n"),
        ("volume.pressure", "[volume]\nmethod = \"density\"\n"),
        ("volume.regain", "[volume]\nmethod = \"incompressible\"\n"),
        ("volume.cell", "[volume]\nmethod = \"density\"\n"),
        ("volume.cell", "[shelter]\nhair = 20.0\n"),
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
            ("solver.projections", "[solver]\nintegrator = \"verlet\"\n"),
            ("solver.quality", "[solver]\nintegrator = \"ftl\"\n"),
            ("ghost.pull", "[solver]\nghost = false\n"),
            ("friction_kinetic", "material = \"m\"\n[material.m]\nfriction = 0.0\n"),
            (
                "motion",
                "[clip]\nkeys = [{ time = 0.0, position = [0.0, 0.0, 0.0], rotation = [0.0, 0.0, 0.0] }]\n",
            ),
        ] {
            assert!(!idle(HEAD, name), "{name} counts by default");
            assert!(idle(&format!("{HEAD}{text}"), name), "{name} with {text}");
        }
        // What takes the place of another.
        assert!(idle(&format!("{HEAD}[builtin.look]\nmelanin = 0.5\n"), "look.root_color"));
    }
}
