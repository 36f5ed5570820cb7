//! Conditions under which a parameter has an effect.

/// The condition under which a parameter has an effect. Parameters and tables are named as in the book, such
/// as `groom.effects.curl_radius`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    /// The parameter always has an effect.
    Always,
    /// A switch is on.
    On(&'static str),
    /// A number is above 0.
    Above0(&'static str),
    /// A vector is not 0.
    Not0(&'static str),
    /// An optional value is present.
    Given(&'static str),
    /// An optional value is absent.
    NotGiven(&'static str),
    /// A choice is one of these words.
    Is(&'static str, &'static [&'static str]),
    /// A choice is none of these words.
    IsNot(&'static str, &'static [&'static str]),
    /// A list or table of the scene file is present.
    Has(&'static str),
    /// A list or table of the scene file is absent.
    HasNot(&'static str),
    /// All of these hold.
    All(&'static [When]),
    /// One of these holds.
    Any(&'static [When]),
}

impl When {
    /// Returns the condition in words, such as `"Curl radius" is above 0`. `label` returns what a parameter or
    /// table is called.
    pub fn phrase(&self, label: &dyn Fn(&str) -> String) -> String {
        let words = |words: &[&str]| match words {
            [others @ .., last] if !others.is_empty() => format!("{} or {last}", others.join(", ")),
            words => words.concat(),
        };
        match *self {
            Self::Always => "always".into(),
            Self::On(name) => format!("{} is on", label(name)),
            Self::Above0(name) => format!("{} is above 0", label(name)),
            Self::Not0(name) => format!("{} is not 0", label(name)),
            Self::Given(name) => format!("{} is set", label(name)),
            Self::NotGiven(name) => format!("{} is not set", label(name)),
            Self::Is(name, values) => format!("{} is {}", label(name), words(values)),
            Self::IsNot(name, values) => format!("{} is not {}", label(name), words(values)),
            Self::Has(name) => format!("the scene has {}", label(name)),
            Self::HasNot(name) => format!("the scene does not have {}", label(name)),
            Self::All(parts) => joined(parts, ", and ", label),
            Self::Any(parts) => joined(parts, " or ", label),
        }
    }

    /// Returns the names in the condition.
    pub fn names(&self) -> Vec<&'static str> {
        match *self {
            Self::Always => Vec::new(),
            Self::All(parts) | Self::Any(parts) => parts.iter().flat_map(Self::names).collect(),
            Self::On(name)
            | Self::Above0(name)
            | Self::Not0(name)
            | Self::Given(name)
            | Self::NotGiven(name)
            | Self::Is(name, _)
            | Self::IsNot(name, _)
            | Self::Has(name)
            | Self::HasNot(name) => vec![name],
        }
    }
}

fn joined(parts: &[When], link: &str, label: &dyn Fn(&str) -> String) -> String {
    parts.iter().map(|part| part.phrase(label)).collect::<Vec<_>>().join(link)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_condition_is_a_phrase() {
        let label = |name: &str| format!("`{name}`");
        let when = When::All(&[When::On("a"), When::Is("b", &["x", "y", "z"])]);
        assert_eq!(when.phrase(&label), "`a` is on, and `b` is x, y or z");
        assert_eq!(when.names(), ["a", "b"]);
        let when = When::Any(&[When::IsNot("a", &["x"]), When::Has("b")]);
        assert_eq!(when.phrase(&label), "`a` is not x or the scene has `b`");
    }
}
