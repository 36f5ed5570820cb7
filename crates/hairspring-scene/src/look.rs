//! How hair is coloured and lit: settings only, the drawing itself lives in `hairspring-view`.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Colour and gloss of one groom.
///
/// Colours are what a thick, evenly lit lock of the hair looks like (linear Rec. 709). The renderer turns them
/// into absorption inside the fibre, so highlights, transmitted light and shadow take their tints from them. In their place the
/// pigment may be given, `melanin`: then they do not count.
///
/// # Missing
/// Melanin of the tip by itself; grey hairs among others by their share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HairLook {
    /// Linear RGB at the root, 0 to 1. Default: dark brown.
    pub root_color: Vec3,
    /// Linear RGB at the tip, 0 to 1. Default: a lighter brown, as sun and washing leave it.
    pub tip_color: Vec3,
    /// Pigment in the fibre, 0 (none: white) to 1 (black), even to the eye: −ln(1 − melanin) is its amount, as in Blender's and Unreal's
    /// hair shaders. `None`, the default: the colours count.
    pub melanin: Option<f32>,
    /// Share of the pigment that is the reddish one, pheomelanin, 0 (all eumelanin: brown) to 1 (red). Default 0.3: light brown hair is a little
    /// warm. Counts with `melanin`.
    pub melanin_redness: f32,
    /// What the hair is dyed: linear RGB that white hair would take on, 0 to 1, over melanin or the colours. Default white: not dyed.
    pub dye: Vec3,
    /// How much pigment differs from strand to strand, 0 (not at all) to 1. Default 0.25: visible only as depth.
    pub variation: f32,
    /// Spread of the highlights along the strand, 0.1 (oiled) to 1 (matt). Default 0.32: healthy hair
    /// (Marschner et al. 2003 measured 5° to 10°).
    pub roughness: f32,
    /// Tilt of the cuticle scales [degrees], 0 to 10. It parts the white highlight from the coloured one.
    /// Default 3 (Marschner et al. 2003, table 1: 2° to 4°).
    pub cuticle: f32,
    /// Strength of the two highlights, 0 to 4. Default 1: dielectric keratin.
    pub specular: f32,
    /// Strength of light shining through strands from behind, 0 to 4. Default 1.
    pub backlight: f32,
    /// Strength of light scattered from strand to strand, 0 to 4. Default 1.
    pub scatter: f32,
    /// How strongly strands shade what is behind them, 0 to 4. Default 1: as opaque as they are wide.
    pub shadow: f32,
}

impl Default for HairLook {
    fn default() -> Self {
        Self {
            root_color: Vec3::new(0.045, 0.022, 0.011),
            tip_color: Vec3::new(0.10, 0.05, 0.024),
            melanin: None,
            melanin_redness: 0.3,
            dye: Vec3::ONE,
            variation: 0.25,
            roughness: 0.32,
            cuticle: 3.0,
            specular: 1.0,
            backlight: 1.0,
            scatter: 1.0,
            shadow: 1.0,
        }
    }
}

/// Natural hair colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum HairColor {
    /// Nearly all eumelanin.
    Black,
    /// The default of [`HairLook`].
    DarkBrown,
    /// Chestnut.
    Brown,
    /// Mostly pheomelanin.
    Red,
    /// Little pigment, bright by scattering.
    Blonde,
    /// Strands without pigment among dark ones.
    Grey,
}

impl HairColor {
    /// Every colour, dark to light.
    pub const ALL: [Self; 6] =
        [Self::Black, Self::DarkBrown, Self::Brown, Self::Red, Self::Blonde, Self::Grey];
}

impl From<HairColor> for HairLook {
    fn from(color: HairColor) -> Self {
        let (root, tip, variation) = match color {
            HairColor::Black => ([0.011, 0.009, 0.008], [0.018, 0.014, 0.012], 0.15),
            HairColor::DarkBrown => return Self::default(),
            HairColor::Brown => ([0.115, 0.058, 0.028], [0.21, 0.115, 0.058], 0.25),
            HairColor::Red => ([0.22, 0.058, 0.018], [0.36, 0.115, 0.038], 0.22),
            HairColor::Blonde => ([0.42, 0.27, 0.13], [0.66, 0.49, 0.29], 0.22),
            HairColor::Grey => ([0.36, 0.355, 0.36], [0.46, 0.455, 0.45], 0.6),
        };
        Self { root_color: Vec3::from(root), tip_color: Vec3::from(tip), variation, ..Self::default() }
    }
}
