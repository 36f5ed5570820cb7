//! Parameters without effect in the current scene, because a feature is off or another value replaces them.
//! The panel grays them out and shows the reason.

use crate::{
    document::Document,
    key::Key,
    parameter::{self, Parameter},
};
use hairspring::settings::When;
use hairspring_io::scene::parameters;

/// A scene and the selection that conditions are evaluated for.
struct Selection<'a> {
    document: &'a Document,
    /// Keys of the selected groom, and of the material of the selected group.
    groom: Key,
    material: Key,
}

impl Selection<'_> {
    /// The effective value of a parameter or table, named as in the book.
    fn value(&self, name: &str) -> Option<&toml::Value> {
        let key = match name.split_once('.') {
            Some(("groom", name)) => self.groom.field(name),
            Some(("material", name)) => self.material.field(name),
            _ => Key::default().field(name),
        };
        key.look_up(self.document.effective())
    }

    fn holds(&self, when: &When) -> bool {
        let word = |name: &str| self.value(name).and_then(toml::Value::as_str).unwrap_or_default();
        match *when {
            When::Always => true,
            When::On(name) | When::Above0(name) | When::Not0(name) | When::Has(name) => {
                self.value(name).is_some_and(is_set)
            }
            When::Given(name) => self.value(name).is_some(),
            When::NotGiven(name) | When::HasNot(name) => self.value(name).is_none(),
            When::Is(name, words) => words.contains(&word(name)),
            When::IsNot(name, words) => !words.contains(&word(name)),
            When::All(parts) => parts.iter().all(|part| self.holds(part)),
            When::Any(parts) => parts.iter().any(|part| self.holds(part)),
        }
    }

    /// The part of an unmet condition that is unmet, as a phrase.
    fn unmet(&self, when: &When, label: &dyn Fn(&str) -> String) -> String {
        match when {
            When::All(parts) => {
                let unmet = parts.iter().filter(|part| !self.holds(part));
                unmet.map(|part| self.unmet(part, label)).collect::<Vec<_>>().join(", and ")
            }
            when => when.phrase(label),
        }
    }
}

/// Whether a switch is on, a number is above 0, one of several numbers is not 0, or a list has entries.
fn is_set(value: &toml::Value) -> bool {
    match value {
        toml::Value::Boolean(on) => *on,
        toml::Value::Integer(n) => *n > 0,
        toml::Value::Float(x) => *x > 0.0,
        toml::Value::Array(list) => list.iter().any(|x| x.as_float() != Some(0.0)),
        _ => true,
    }
}

impl Parameter {
    /// Why a parameter has no effect in this scene, for this groom and group; `None` if it has.
    pub fn inactive_reason(&self, document: &Document, (groom, group): (usize, usize)) -> Option<String> {
        let groom = Key::top("groom").place(groom);
        let selection = Selection { document, material: groom.field("material").place(group), groom };
        let when = self.definition().when;
        // A parameter is named by its label, and by its group if that is another one.
        let label = |name: &str| match parameter::ALL.iter().find(|p| p.full_name() == name) {
            Some(other) if other.group == self.group => format!("\"{}\"", other.label),
            Some(other) => format!("\"{}\" ({})", other.label, other.group.name()),
            None => parameters::contents(name).unwrap_or(name).to_owned(),
        };
        (!selection.holds(&when)).then(|| format!("No effect unless {}.", selection.unmet(&when, &label)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter;

    const HEAD: &str = "[builtin]\nstrands = 10\nguides = 5\n";

    fn inactive(text: &str, name: &str) -> bool {
        let document = Document::new("scene.toml".as_ref(), text.into()).unwrap();
        let parameter = parameter::ALL.iter().find(|p| p.name == name).unwrap();
        parameter.inactive_reason(&document, (0, 0)).is_some()
    }

    /// Parameters without effect in the built-in scene, and text that activates them.
    const ENABLED_BY: [(&str, &str); 25] = [
        ("effects.curl_length", "[builtin.effects]\ncurl_radius = 0.004\n"),
        ("global_shape.profile", "[material.m]\nglobal_shape = { pull = 2.0 }\n"),
        ("global_shape.damping", "[material.m]\nglobal_shape = { pull = 2.0 }\n"),
        ("radius_profile", "[material.m]\nradius = 3e-5\n"),
        ("charge_profile", "[material.m]\ncharge = 1e-9\n"),
        ("tether_profile", "[material.m]\ntether = 1.1\n"),
        ("wind.gust", "[wind]\nvelocity = [0.0, 0.0, 2.0]\n"),
        ("wind.gust_rate", "[wind]\nvelocity = [0.0, 0.0, 2.0]\ngust = 0.5\n"),
        ("turbulence.size", "[turbulence]\nstrength = 1.0\n"),
        ("turbulence.octaves", "[turbulence]\nstrength = 1.0\n"),
        ("wind_occlusion.body", "[wind]\nvelocity = [0.0, 0.0, 2.0]\n"),
        (
            "wind_occlusion.hair",
            "[[wind_source]]\nshape.point = { center = [0.2, 1.5, 0.0], radius = 0.05, speed = 2.0 }\n",
        ),
        ("wind_occlusion.reach", "[wind]\nvelocity = [0.0, 0.0, 2.0]\n[wind_occlusion]\nhair = 20.0\n"),
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
    fn parameters_of_a_disabled_effect_are_inactive_until_it_is_enabled() {
        for (name, on) in ENABLED_BY {
            assert!(inactive(HEAD, name), "{name} while it is off");
            let with = HEAD.replace("guides = 5\n", "guides = 5\nmaterial = \"m\"\n");
            let text =
                if on.starts_with("[material") { format!("{with}{on}") } else { format!("{HEAD}{on}") };
            assert!(!inactive(&text, name), "{name} with {on}");
        }
    }

    #[test]
    fn parameters_without_effect_on_the_current_settings_are_inactive() {
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
            assert!(!inactive(HEAD, name), "{name} counts by default");
            assert!(inactive(&format!("{HEAD}{text}"), name), "{name} with {text}");
        }
        // Charged hair also repels itself.
        assert!(!inactive(HEAD, "charge"), "a charge acts without charged bodies");
        // Values that replace others.
        assert!(inactive(&format!("{HEAD}[builtin.look]\nmelanin = 0.5\n"), "look.root_color"));
    }
}
