//! Parameters without effect in the current scene, because a feature is off or another value replaces them.
//! The panel grays them out and shows the reason.

use crate::{
    document::Document,
    key::Key,
    parameter::{self, Parameter},
};
use hairspring_io::scene::{inactive, parameters};

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
}

impl Parameter {
    /// Why a parameter has no effect in this scene, for this groom and group; `None` if it has.
    pub fn inactive_reason(&self, document: &Document, (groom, group): (usize, usize)) -> Option<String> {
        let groom = Key::top("groom").place(groom);
        let selection = Selection { document, material: groom.field("material").place(group), groom };
        let unmet = inactive::unmet(&self.definition().when, &|name| selection.value(name));
        // A parameter is named by its label, and by its group if that is another one.
        let label = |name: &str| match parameter::ALL.iter().find(|p| p.full_name() == name) {
            Some(other) if other.group == self.group => format!("\"{}\"", other.label),
            Some(other) => format!("\"{}\" ({})", other.label, other.group.name()),
            None => parameters::contents(name).unwrap_or(name).to_owned(),
        };
        let unmet: Vec<String> = unmet.iter().map(|part| part.phrase(&label)).collect();
        (!unmet.is_empty()).then(|| format!("No effect unless {}.", unmet.join(", and ")))
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
