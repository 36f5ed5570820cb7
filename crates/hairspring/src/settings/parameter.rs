//! The definition of a parameter as data. `define_settings!` writes one for each field of a settings struct.

use super::{
    When,
    check::{Check, check},
    range::Range,
};
use glam::Vec3;

/// The definition of one parameter of a scene file.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Name in its table.
    pub name: &'static str,
    /// Unit, such as `m`, or what a plain number counts, such as `fraction`. `none` for other values.
    pub unit: &'static str,
    /// Accepted values.
    pub range: Range,
    /// Accepted values with their unit, as error messages name them, such as `above 0 [m]`.
    pub expected: &'static str,
    /// Returns the default as a TOML value; `None` for a parameter without a default value.
    pub default: Option<fn() -> String>,
    /// Description of the default, if it is not a fixed value; empty otherwise.
    pub default_text: &'static str,
    /// Documentation. The lines are those of the doc comment; an empty line separates paragraphs.
    pub doc: &'static str,
    /// The words that it accepts; empty if it accepts other values.
    pub words: &'static [&'static str],
    /// The parameters of a table, by variant. The variant of a plain table is empty.
    pub fields: Fields,
    /// When it has an effect.
    pub when: When,
}

/// The parameters of a table, by variant.
pub type Fields = &'static [(&'static str, &'static [Parameter])];

impl Parameter {
    /// Returns the rule for `value`.
    pub fn check(&self, value: &impl Setting) -> Check {
        check(self.range.accepts(value), self.name, self.expected)
    }

    /// Returns the unit in the brackets of an error message; `None` for plain numbers and other values.
    pub fn physical_unit(&self) -> Option<&'static str> {
        self.expected.ends_with(&format!(" [{}]", self.unit)).then_some(self.unit)
    }

    /// Returns the accepted values without their unit, such as `above 0`.
    pub fn range_text(&self) -> String {
        match self.range {
            Range::Words => self.words.iter().map(|w| format!("`{w:?}`")).collect::<Vec<_>>().join(", "),
            _ => {
                let unit = format!(" [{}]", self.unit);
                self.expected.strip_suffix(&unit).unwrap_or(self.expected).to_owned()
            }
        }
    }

    /// Returns the default as the documentation shows it: a value in backticks, a description, or
    /// `required`.
    pub fn default_or_required(&self) -> String {
        match (self.default_text, self.default) {
            ("", Some(value)) => format!("`{}`", value()),
            ("", None) => "required".into(),
            (text, _) => text.into(),
        }
    }

    /// Returns the first paragraph of the documentation on one line.
    pub fn summary(&self) -> String {
        let lines = self.doc.lines().map(str::trim).take_while(|line| !line.is_empty());
        lines.collect::<Vec<_>>().join(" ")
    }
}

/// The parameter named `name` of a table.
///
/// # Panics
/// If the table has none. The names are those of the source.
pub fn parameter(table: &'static [Parameter], name: &str) -> &'static Parameter {
    table.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no parameter `{name}`"))
}

/// A type of values that settings have.
pub trait Setting {
    /// The words that scene files use for the values, if the type is a choice.
    const WORDS: &'static [&'static str] = &[];
    /// The parameters of a type that is a table.
    const FIELDS: Fields = &[];

    /// Returns the numbers that a range applies to; none for an absent value.
    fn numbers(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Returns the value in TOML; empty for types without a fixed default.
    fn toml(&self) -> String {
        String::new()
    }

    /// Returns the rules of a table's own parameters.
    fn table_checks(&self) -> Vec<Check> {
        Vec::new()
    }
}

impl Setting for f32 {
    fn numbers(&self) -> Vec<f64> {
        vec![f64::from(*self)]
    }

    fn toml(&self) -> String {
        let is_plain = *self == 0.0 || (1e-3..1e6).contains(&self.abs());
        if is_plain { format!("{self:?}") } else { format!("{self:e}") }
    }
}

impl Setting for f64 {
    fn numbers(&self) -> Vec<f64> {
        vec![*self]
    }

    fn toml(&self) -> String {
        format!("{self:?}")
    }
}

impl Setting for u32 {
    fn numbers(&self) -> Vec<f64> {
        vec![f64::from(*self)]
    }

    fn toml(&self) -> String {
        self.to_string()
    }
}

impl Setting for i32 {
    fn numbers(&self) -> Vec<f64> {
        vec![f64::from(*self)]
    }

    fn toml(&self) -> String {
        self.to_string()
    }
}

impl Setting for bool {
    fn toml(&self) -> String {
        self.to_string()
    }
}

impl Setting for &str {
    fn toml(&self) -> String {
        format!("{self:?}")
    }
}

impl Setting for Vec3 {
    fn numbers(&self) -> Vec<f64> {
        self.to_array().map(f64::from).to_vec()
    }

    fn toml(&self) -> String {
        self.to_array().toml()
    }
}

impl<T: Setting, const N: usize> Setting for [T; N] {
    fn numbers(&self) -> Vec<f64> {
        self.iter().flat_map(T::numbers).collect()
    }

    fn toml(&self) -> String {
        format!("[{}]", self.iter().map(T::toml).collect::<Vec<_>>().join(", "))
    }
}

impl<T: Setting> Setting for Vec<T> {
    const FIELDS: Fields = T::FIELDS;

    fn numbers(&self) -> Vec<f64> {
        self.iter().flat_map(T::numbers).collect()
    }

    fn toml(&self) -> String {
        format!("[{}]", self.iter().map(T::toml).collect::<Vec<_>>().join(", "))
    }
}

impl<T: Setting> Setting for Option<T> {
    const WORDS: &'static [&'static str] = T::WORDS;
    const FIELDS: Fields = T::FIELDS;

    fn numbers(&self) -> Vec<f64> {
        self.iter().flat_map(T::numbers).collect()
    }
}

impl Setting for String {}

impl Setting for std::path::PathBuf {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_written_as_in_a_scene_file() {
        assert_eq!([0.0_f32, 0.03, 30.0, 3.9e9].map(|x| x.toml()), ["0.0", "0.03", "30.0", "3.9e9"]);
        assert_eq!((vec![1.0_f32]).toml(), "[1.0]");
        assert_eq!(Vec3::ONE.toml(), "[1.0, 1.0, 1.0]");
        assert_eq!(("y".toml(), true.toml()), ("\"y\"".into(), "true".into()));
    }
}
