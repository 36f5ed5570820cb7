//! Hair color and shading settings. Rendering is implemented in `hairspring-view`.

use crate::deserialize_color;
use glam::Vec3;
use hairspring::settings::{Check, Validate, check};
use serde::{Deserialize, Serialize};

/// Color and gloss of one groom.
///
/// Colors are those of a thick, evenly lit lock of the hair (linear Rec. 709). The renderer converts them to
/// absorption inside the fiber, which tints highlights, transmitted light and shadow. Alternatively `melanin`
/// gives the pigment; the colors are then ignored.
///
/// # Missing
/// A separate melanin value for the tip; a fraction of gray hairs among others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HairLook {
    /// Linear RGB at the root, 0 to 1. Default: dark brown.
    #[serde(deserialize_with = "deserialize_color")]
    pub root_color: Vec3,
    /// Linear RGB at the tip, 0 to 1. Default: a lighter brown, as from sun and washing.
    #[serde(deserialize_with = "deserialize_color")]
    pub tip_color: Vec3,
    /// Pigment in the fiber, 0 (none: white) to 1 (black), perceptually even: the amount is −ln(1 − melanin),
    /// as in the hair shaders of Blender and Unreal. `None`, the default: the colors are used.
    pub melanin: Option<f32>,
    /// Fraction of the pigment that is reddish pheomelanin, 0 (only eumelanin: brown) to 1 (red). Default
    /// 0.3: light brown hair is slightly warm. Only used with `melanin`.
    pub melanin_redness: f32,
    /// Dye: linear RGB that white hair would take on, 0 to 1, applied to the melanin or the colors. Default
    /// white: no dye.
    #[serde(deserialize_with = "deserialize_color")]
    pub dye: Vec3,
    /// Variation of pigment from strand to strand, 0 (none) to 1. Default 0.25: visible only as depth.
    pub variation: f32,
    /// Width of the highlights along the strand, 0.1 (oiled) to 1 (matte). Default 0.32: healthy hair
    /// (Marschner et al. 2003 measured 5° to 10°).
    pub roughness: f32,
    /// Tilt of the cuticle scales [degrees], 0 to 10. It separates the white highlight from the colored one.
    /// Default 3 (Marschner et al. 2003, table 1: 2° to 4°).
    pub cuticle: f32,
    /// Strength of the two highlights, 0 to 4. Default 1: dielectric keratin.
    pub specular: f32,
    /// Strength of light transmitted through strands from behind, 0 to 4. Default 1.
    pub backlight: f32,
    /// Strength of light scattered from strand to strand, 0 to 4. Default 1.
    pub scatter: f32,
    /// Strength of shadows from strands, 0 to 4. Default 1: as opaque as they are wide.
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

/// Natural hair colors.
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
    Gray,
}

impl HairColor {
    /// All colors, from dark to light.
    pub const ALL: [Self; 6] =
        [Self::Black, Self::DarkBrown, Self::Brown, Self::Red, Self::Blonde, Self::Gray];
}

impl From<HairColor> for HairLook {
    fn from(color: HairColor) -> Self {
        let (root, tip, variation) = match color {
            HairColor::Black => ([0.011, 0.009, 0.008], [0.018, 0.014, 0.012], 0.15),
            HairColor::DarkBrown => return Self::default(),
            HairColor::Brown => ([0.115, 0.058, 0.028], [0.21, 0.115, 0.058], 0.25),
            HairColor::Red => ([0.22, 0.058, 0.018], [0.36, 0.115, 0.038], 0.22),
            HairColor::Blonde => ([0.42, 0.27, 0.13], [0.66, 0.49, 0.29], 0.22),
            HairColor::Gray => ([0.36, 0.355, 0.36], [0.46, 0.455, 0.45], 0.6),
        };
        Self { root_color: Vec3::from(root), tip_color: Vec3::from(tip), variation, ..Self::default() }
    }
}

impl Validate for HairLook {
    fn checks(&self) -> Vec<Check> {
        let color = crate::is_color;
        vec![
            check(color(self.root_color), "root_color", "three numbers from 0 to 1"),
            check(color(self.tip_color), "tip_color", "three numbers from 0 to 1"),
            check(self.melanin.is_none_or(|m| (0.0..=1.0).contains(&m)), "melanin", "0 to 1"),
            check((0.0..=1.0).contains(&self.melanin_redness), "melanin_redness", "0 to 1"),
            check(color(self.dye), "dye", "three numbers from 0 to 1"),
            check((0.0..=1.0).contains(&self.variation), "variation", "0 to 1"),
            check((0.1..=1.0).contains(&self.roughness), "roughness", "0.1 to 1"),
            check((0.0..=10.0).contains(&self.cuticle), "cuticle", "0 to 10 [degrees]"),
            check((0.0..=4.0).contains(&self.specular), "specular", "0 to 4"),
            check((0.0..=4.0).contains(&self.backlight), "backlight", "0 to 4"),
            check((0.0..=4.0).contains(&self.scatter), "scatter", "0 to 4"),
            check((0.0..=4.0).contains(&self.shadow), "shadow", "0 to 4"),
        ]
    }
}
