//! The hairstyles of the built-in scene and their parameters.

use crate::{HairColor, HairLook};
use hairspring::material::{self, Material};

/// A hairstyle of the built-in scene, one for each of [`material::PRESETS`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// Sleek and long, to the shoulder blades.
    Straight,
    /// Below the shoulders in loose waves. The default.
    #[default]
    Wavy,
    /// Ringlets to the shoulders.
    Curly,
    /// A round halo of tight coils.
    Coily,
    /// A short coat, combed to the sides.
    ShortFur,
}

/// The parameters of a style. Lengths are in meters.
#[derive(Clone, Copy, Debug)]
pub struct Cut {
    /// Length of hair at the parting, from root to tip along its path [m].
    pub length: f32,
    /// Decrease of length per meter of the root's distance from the parting. With 1, all tips end at the same
    /// level.
    pub level: f32,
    /// Shortest hair [m].
    pub shortest: f32,
    /// Height of the outermost layer above the skull [m].
    pub volume: f32,
    /// Length of hair over which it rises to its layer [m].
    pub rise: f32,
    /// How steeply hair leaves the skin, 0 (flat) to 1 (straight out).
    pub lift: f32,
    /// How much hair grows outward rather than falling, 0 (falls) to 1 (stands).
    pub stand: f32,
    /// Radius of the waves [m].
    pub wave: f32,
    /// Wavelength along the hair's path [m].
    pub wave_length: f32,
    /// Depth of the waves relative to their width: 0 is flat waves, 1 round coils.
    pub roundness: f32,
    /// How strongly hairs gather in locks toward their tips, 0 to 1.
    pub clump: f32,
    /// Spread of single hairs around their lock [m].
    pub frizz: f32,
    /// Number of points per hair that resolves the style well.
    pub points: u32,
}

impl Style {
    /// All styles, in the order of [`material::PRESETS`].
    pub const ALL: [Style; 5] = [Style::Straight, Style::Wavy, Style::Curly, Style::Coily, Style::ShortFur];

    /// Returns the name, one of [`material::PRESETS`].
    pub fn name(self) -> &'static str {
        material::PRESETS[self as usize]
    }

    /// Returns the style with this name; `None` for any name not in [`material::PRESETS`].
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|s| s.name() == name)
    }

    /// Returns its material: the preset of the same name.
    pub fn material(self) -> Material {
        material::preset(self.name()).unwrap_or_default()
    }

    /// Returns the number of points per hair that resolves the style well: straight hair needs few, coils
    /// several per turn.
    pub fn points(self) -> u32 {
        self.cut().points
    }

    /// Returns its parameters.
    pub(super) fn cut(self) -> Cut {
        let wavy = Cut {
            length: 0.40,
            level: 0.9,
            shortest: 0.12,
            volume: 0.016,
            rise: 0.09,
            lift: 0.35,
            stand: 0.0,
            wave: 0.012,
            wave_length: 0.075,
            roundness: 0.5,
            clump: 0.82,
            frizz: 0.0012,
            points: 32,
        };
        match self {
            Style::Straight => Cut {
                length: 0.42,
                volume: 0.014,
                lift: 0.25,
                wave: 0.0012,
                wave_length: 0.16,
                clump: 0.45,
                frizz: 0.0008,
                ..wavy
            },
            Style::Wavy => wavy,
            Style::Curly => Cut {
                length: 0.33,
                level: 0.8,
                volume: 0.024,
                lift: 0.45,
                stand: 0.1,
                wave: 0.0105,
                wave_length: 0.042,
                roundness: 0.9,
                clump: 0.92,
                frizz: 0.0010,
                points: 64,
                ..wavy
            },
            Style::Coily => Cut {
                length: 0.105,
                level: 0.12,
                shortest: 0.06,
                volume: 0.0,
                rise: 0.09,
                lift: 0.9,
                stand: 0.93,
                wave: 0.0038,
                wave_length: 0.011,
                roundness: 1.0,
                clump: 0.55,
                frizz: 0.0022,
                points: 64,
            },
            Style::ShortFur => Cut {
                length: 0.030,
                level: 0.09,
                shortest: 0.012,
                volume: 0.004,
                rise: 0.02,
                lift: 0.55,
                stand: 0.25,
                wave: 0.0006,
                wave_length: 0.03,
                roundness: 0.5,
                clump: 0.35,
                frizz: 0.0008,
                points: 12,
            },
        }
    }

    /// Returns its color.
    pub(super) fn look(self) -> HairLook {
        HairLook::from(match self {
            Style::Straight => HairColor::DarkBrown,
            Style::Wavy => HairColor::Brown,
            Style::Curly => HairColor::Red,
            Style::Coily => HairColor::Black,
            Style::ShortFur => HairColor::Blonde,
        })
    }
}

impl Cut {
    /// Returns the distance between the points of a hair's path while it grows [m]. It is short compared with
    /// the hair's length, the skull's radius and the waves.
    pub fn step(&self) -> f32 {
        (self.length / 48.0).min(self.wave_length / 8.0).min(0.007)
    }
}
