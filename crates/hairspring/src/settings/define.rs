//! The macro that defines settings.

/// Defines settings: the type, and for each field its documentation, default, unit, accepted values and the
/// condition under which it has an effect. Everything else is derived from the definition: the `Default`
/// and [`Validate`](crate::settings::Validate) implementations, the table
/// [`Parameter`](crate::settings::Parameter), and through it the errors of the scene reader, the controls of
/// the window and the facts in the book.
///
/// ```
/// use hairspring::settings::{Validate, define_settings};
///
/// define_settings! {
///     /// A lamp.
///     #[derive(Clone, Copy, Debug)]
///     pub struct Lamp {
///         /// Whether it is lit.
///         on: bool = true, "none", {switch};
///         /// Radiant power.
///         power: f32 = 40.0, ["W"], {0 to 100}, when hairspring::settings::When::On("lamp.on");
///         /// Distance to the wall.
///         distance: Option<f32> = None, ["m"], {above 0}, default "automatic";
///     }
/// }
///
/// let error = Lamp { power: 200.0, ..Lamp::default() }.validate().unwrap_err();
/// assert_eq!(error.to_string(), "`power` must be 0 to 100 [W]");
/// assert_eq!(Lamp::PARAMETERS[2].expected, "above 0 [m]");
/// ```
///
/// A field is `name: Type = default, unit, {range}`, then optionally `default "text"`, which describes a default
/// that is not a fixed value, and `when` with a [`When`](crate::settings::When). A unit in brackets is physical and
/// appears in error messages. A unit without brackets describes a count or ratio. The ranges are the arms `@text` of
/// the macro. `{check |s| rule => "text"}` is a rule that needs other values.
///
/// - `pub struct` has a default for every field.
/// - `entry struct` is an entry of a list: fields without a default are required. The serde attribute of a
///   field supplies the same default; a test of the book compares the two.
/// - `entry enum` has variants with such fields, each with its key.
/// - `choice` is an enum of words. The words replace serde's names.
/// - `file struct` is a table of a scene file whose types are those of its reader. It always needs serde. The other
///   types implement serde's traits with the feature `serde` of the crate that defines them.
#[macro_export]
macro_rules! define_settings {
    // A struct of settings with defaults.
    (
        $(#[$attr:meta])*
        pub struct $name:ident {
            $(
                $(#[doc = $doc:literal])+
                $(#[serde($($serde:tt)*)])?
                $field:ident : $ty:ty = $default:expr, $unit:tt, {$($range:tt)*}
                $(, default $text:literal)? $(, when $when:expr)?;
            )*
        }
    ) => {
        $(#[$attr])*
        #[cfg_attr(
            feature = "serde",
            derive(serde::Serialize, serde::Deserialize),
            serde(default, deny_unknown_fields)
        )]
        pub struct $name {
            $(
                $(#[doc = $doc])+
                #[doc = ""]
                #[doc = concat!(
                    "Range: ", $crate::define_settings!(@text $unit {$($range)*}),
                    ". Default: `", stringify!($default), "`."
                )]
                $(#[cfg_attr(feature = "serde", serde($($serde)*))])?
                pub $field: $ty,
            )*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default),* }
            }
        }

        $crate::define_settings! { @common $name $(
            [$($doc)+] $field [$ty] [default: |d: &$name| &d.$field] $unit {$($range)*} [$($text)?] [$($when)?];
        )* }
    };

    // An entry of a list. Fields without a default are required.
    (
        $(#[$attr:meta])*
        entry struct $name:ident {
            $(
                $(#[doc = $doc:literal])+
                $(#[serde($($serde:tt)*)])?
                $field:ident : $ty:ty $(= $default:expr)?, $unit:tt, {$($range:tt)*}
                $(, default $text:literal)? $(, when $when:expr)?;
            )*
        }
    ) => {
        $(#[$attr])*
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
        pub struct $name {
            $(
                $(#[doc = $doc])+
                #[doc = ""]
                #[doc = concat!("Range: ", $crate::define_settings!(@text $unit {$($range)*}), ".")]
                $(#[doc = concat!("Default: `", stringify!($default), "`.")])?
                $(#[cfg_attr(feature = "serde", serde($($serde)*))])?
                pub $field: $ty,
            )*
        }

        $crate::define_settings! { @common $name $(
            [$($doc)+] $field [$ty] [$(typed: $ty = $default)?] $unit {$($range)*} [$($text)?] [$($when)?];
        )* }
    };

    // The table and the rules of a struct.
    (@common $name:ident $(
        [$($doc:literal)+] $field:ident [$ty:ty] [$($default:tt)*] $unit:tt {$($range:tt)*} [$($text:literal)?] [$($when:expr)?];
    )*) => {
        impl $name {
            /// The definition of each parameter, in the order of the fields.
            pub const PARAMETERS: &'static [$crate::settings::Parameter] = &[$(
                $crate::define_settings!(
                    @parameter [$($doc)+] $field $name [$($default)*] $unit {$($range)*} [$($text)?] [$($when)?]
                    [<$ty as $crate::settings::Setting>::WORDS] [<$ty as $crate::settings::Setting>::FIELDS]
                ),
            )*];
        }

        impl $crate::settings::Validate for $name {
            fn checks(&self) -> Vec<$crate::settings::Check> {
                let mut checks = Vec::new();
                $(
                    checks.extend($crate::define_settings!(@check self, &self.$field, stringify!($field), $unit {$($range)*}));
                    let nested = $crate::settings::Setting::table_checks(&self.$field);
                    checks.extend($crate::settings::with_prefix(stringify!($field), nested));
                )*
                checks
            }
        }

        impl $crate::settings::Setting for $name {
            const FIELDS: $crate::settings::Fields = &[("", $name::PARAMETERS)];

            fn table_checks(&self) -> Vec<$crate::settings::Check> {
                $crate::settings::Validate::checks(self)
            }
        }
    };

    // An enum whose variants have fields. Its rules are `range_checks`.
    (
        $(#[$attr:meta])*
        entry enum $name:ident {
            $(
                $(#[doc = $about:literal])+
                $variant:ident = $key:literal {
                    $(
                        $(#[doc = $doc:literal])+
                        $(#[serde($($serde:tt)*)])?
                        $field:ident : $ty:ty $(= $default:expr)?, $unit:tt, {$($range:tt)*}
                        $(, default $text:literal)?;
                    )*
                }
            )*
        }
    ) => {
        $(#[$attr])*
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
        pub enum $name {
            $(
                $(#[doc = $about])+
                #[cfg_attr(feature = "serde", serde(rename = $key))]
                $variant {
                    $(
                        $(#[doc = $doc])+
                        #[doc = ""]
                        #[doc = concat!("Range: ", $crate::define_settings!(@text $unit {$($range)*}), ".")]
                        $(#[doc = concat!("Default: `", stringify!($default), "`.")])?
                        $(#[cfg_attr(feature = "serde", serde($($serde)*))])?
                        $field: $ty,
                    )*
                },
            )*
        }

        impl $name {
            /// The definition of each parameter, by the key of the variant.
            pub const PARAMETERS: $crate::settings::Fields = &[$(($key, &[$(
                $crate::define_settings!(
                    @parameter [$($doc)+] $field $name [$(typed: $ty = $default)?] $unit {$($range)*} [$($text)?] []
                    [<$ty as $crate::settings::Setting>::WORDS] [<$ty as $crate::settings::Setting>::FIELDS]
                ),
            )*])),*];

            /// Returns the rules of the ranges of all fields.
            fn range_checks(&self) -> Vec<$crate::settings::Check> {
                match self {
                    $(Self::$variant { $($field),* } => {
                        let mut checks = Vec::new();
                        $(
                            let key = concat!($key, ".", stringify!($field));
                            checks.extend($crate::define_settings!(@check self, $field, key, $unit {$($range)*}));
                        )*
                        checks
                    })*
                }
            }
        }

        impl $crate::settings::Setting for $name {
            const FIELDS: $crate::settings::Fields = $name::PARAMETERS;

            fn table_checks(&self) -> Vec<$crate::settings::Check> {
                $crate::settings::Validate::checks(self)
            }
        }
    };

    // An enum of words.
    (
        $(#[$attr:meta])*
        choice $name:ident {
            $($(#[$mark:meta])+ $variant:ident = $word:literal,)*
        }
    ) => {
        $(#[$attr])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        pub enum $name {
            $($(#[$mark])+ #[cfg_attr(feature = "serde", serde(rename = $word))] $variant,)*
        }

        impl $name {
            /// All values, in the order of the definition.
            pub const ALL: [Self; [$($word),*].len()] = [$(Self::$variant),*];

            /// Returns the name used in scene files and on the command line.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)*
                }
            }
        }

        impl $crate::settings::Setting for $name {
            const WORDS: &'static [&'static str] = &[$($word),*];

            fn toml(&self) -> String {
                format!("{:?}", self.name())
            }
        }
    };

    // A table of a scene file. The types are those of its reader, so its rules are written there.
    (
        $(#[$attr:meta])*
        file struct $name:ident {
            $(
                $(#[doc = $doc:literal])+
                $(#[serde($($serde:tt)*)])?
                $field:ident : $ty:ty $(= $default:expr)?, $unit:tt, {$($range:tt)*}
                $(, default $text:literal)? $(, when $when:expr)?;
            )*
        }
    ) => {
        #[derive(serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        $(#[$attr])*
        pub(super) struct $name {
            $(
                $(#[doc = $doc])+
                $(#[serde($($serde)*)])?
                pub $field: $ty,
            )*
        }

        impl $name {
            /// The definition of each parameter, in the order of the fields.
            pub(super) const PARAMETERS: &'static [$crate::settings::Parameter] = &[$(
                $crate::define_settings!(
                    @parameter [$($doc)+] $field $name [$($default)?] $unit {$($range)*} [$($text)?] [$($when)?]
                    [$crate::define_settings!(@words {$($range)*})] [&[]]
                ),
            )*];

            /// Returns the rule for a value of the parameter `name`.
            pub(super) fn check(name: &str, value: &impl $crate::settings::Setting) -> $crate::settings::Check {
                $crate::settings::parameter(Self::PARAMETERS, name).check(value)
            }
        }
    };

    (@parameter [$($doc:literal)+] $field:ident $name:ident [$($default:tt)*] $unit:tt {$($range:tt)*}
        [$($text:literal)?] [$($when:expr)?] [$words:expr] [$fields:expr]) => {
        $crate::settings::Parameter {
            name: stringify!($field),
            unit: $crate::define_settings!(@unit $unit),
            range: $crate::define_settings!(@range {$($range)*}),
            expected: $crate::define_settings!(@text $unit {$($range)*}),
            default: $crate::define_settings!(@default $name [$($default)*]),
            default_text: concat!("", $($text)?),
            doc: concat!($($doc, "\n"),+),
            words: $words,
            fields: $fields,
            when: $crate::define_settings!(@when $($when)?),
        }
    };

    (@default $name:ident []) => { None };
    (@default $name:ident [default: $value:expr]) => {
        Some(|| {
            let value: fn(&$name) -> &_ = $value;
            $crate::settings::Setting::toml(value(&$name::default()))
        })
    };
    (@default $name:ident [typed: $ty:ty = $default:expr]) => {
        Some(|| {
            let value: $ty = $default;
            $crate::settings::Setting::toml(&value)
        })
    };
    (@default $name:ident [$default:expr]) => { Some(|| $crate::settings::Setting::toml(&$default)) };

    (@when) => { $crate::settings::When::Always };
    (@when $when:expr) => { $when };

    (@unit [$unit:literal]) => { $unit };
    (@unit $unit:literal) => { $unit };

    (@words {words $words:expr}) => { $words };
    (@words {$($range:tt)*}) => { &[] };

    (@check $settings:expr, $value:expr, $key:expr, $unit:tt {check $rule:expr => $text:literal}) => {
        Some($crate::settings::check(
            $crate::settings::holds($settings, $rule),
            $key,
            $crate::define_settings!(@text $unit {check $rule => $text}),
        ))
    };
    (@check $settings:expr, $value:expr, $key:expr, $unit:tt {$($range:tt)*}) => {
        Some($crate::settings::check(
            $crate::define_settings!(@range {$($range)*}).accepts($value),
            $key,
            $crate::define_settings!(@text $unit {$($range)*}),
        ))
    };

    (@text [$unit:literal] {$($range:tt)*}) => {
        concat!($crate::define_settings!(@text "" {$($range)*}), " [", $unit, "]")
    };
    (@text $unit:literal {switch}) => { "`true`, `false`" };
    (@text $unit:literal {words $($words:expr)?}) => { "one of its values" };
    (@text $unit:literal {table}) => { "a table" };
    (@text $unit:literal {text $text:literal}) => { $text };
    (@text $unit:literal {check $rule:expr => $text:literal}) => { $text };
    (@text $unit:literal {finite}) => { "a finite number" };
    (@text $unit:literal {vector}) => { "three finite numbers" };
    (@text $unit:literal {vector $min:literal to $max:literal}) => {
        concat!("three numbers from ", stringify!($min), " to ", stringify!($max))
    };
    (@text $unit:literal {vector above 0}) => { "three numbers above 0" };
    (@text $unit:literal {direction}) => { "a vector with a length above 0" };
    (@text $unit:literal {color}) => { "three numbers from 0 to 1, or a text such as \"#a0522d\"" };
    (@text $unit:literal {above $min:literal at most $max:literal}) => {
        concat!("above ", stringify!($min), ", at most ", stringify!($max))
    };
    (@text $unit:literal {above $min:literal}) => { concat!("above ", stringify!($min)) };
    (@text $unit:literal {$min:literal to $max:literal}) => {
        concat!(stringify!($min), " to ", stringify!($max))
    };
    (@text $unit:literal {$min:literal or more}) => { concat!(stringify!($min), " or more") };
    (@text $unit:literal {0 or $min:literal to $max:literal}) => {
        concat!("0 (none), or ", stringify!($min), " to ", stringify!($max))
    };

    (@range {switch}) => { $crate::settings::Range::Switch };
    (@range {words $($words:expr)?}) => { $crate::settings::Range::Words };
    (@range {table}) => { $crate::settings::Range::Table };
    (@range {text $text:literal}) => { $crate::settings::Range::Described };
    (@range {check $rule:expr => $text:literal}) => { $crate::settings::Range::Described };
    (@range {finite}) => { $crate::settings::Range::Finite };
    (@range {vector}) => { $crate::settings::Range::Finite };
    (@range {vector $($range:tt)+}) => { $crate::define_settings!(@range {$($range)+}) };
    (@range {direction}) => { $crate::settings::Range::Direction };
    (@range {color}) => { $crate::settings::Range::Color };
    (@range {above $min:literal at most $max:literal}) => {
        $crate::settings::Range::AboveAtMost($min as f32, $max as f32)
    };
    (@range {above $min:literal}) => { $crate::settings::Range::Above($min as f32) };
    (@range {$min:literal to $max:literal}) => { $crate::settings::Range::Between($min as f32, $max as f32) };
    (@range {$min:literal or more}) => { $crate::settings::Range::AtLeast($min as f32) };
    (@range {0 or $min:literal to $max:literal}) => {
        $crate::settings::Range::ZeroOr($min as f32, $max as f32)
    };
}

pub use define_settings;
