//! Hair color and shading settings. Rendering is implemented in `hairspring-view`.

use glam::Vec3;
use hairspring::settings::{When, define_settings};

/// The condition under which the two colors have an effect.
const COLORS: When = When::NotGiven("groom.look.melanin");

define_settings! {
    /// Color and gloss of one groom.
    ///
    /// Colors are those of a thick, evenly lit lock of the hair (linear Rec. 709). The renderer converts them to
    /// absorption inside the fiber, which tints highlights, transmitted light and shadow. Alternatively `melanin`
    /// gives the pigment; the colors are then ignored.
    ///
    /// # Limitations
    /// The tip has no melanin value of its own, and there are no gray hairs among others.
    #[derive(Clone, Debug, PartialEq)]
    pub struct HairLook {
        /// Color of a thick lock of hair at the root. The default is dark brown.
        #[serde(deserialize_with = "crate::deserialize_color")]
        root_color: Vec3 = Vec3::new(0.045, 0.022, 0.011), "linear RGB", {color}, when COLORS;
        /// Color of a thick lock of hair at the tip. The default is a lighter brown, as from sun and washing.
        #[serde(deserialize_with = "crate::deserialize_color")]
        tip_color: Vec3 = Vec3::new(0.10, 0.05, 0.024), "linear RGB", {color}, when COLORS;
        /// Pigment in the fiber, instead of the two colors: 0 is white, 1 is black.
        ///
        /// It is perceptually even: the amount is −ln(1 − melanin), as in the hair shaders of Blender and Unreal.
        melanin: Option<f32> = None, "fraction", {0 to 1}, default "none, the two colors are used";
        /// Fraction of the pigment that is reddish pheomelanin, 0 (only eumelanin: brown) to 1 (red). The default
        /// is slightly warm, like light brown hair.
        melanin_redness: f32 = 0.3, "fraction", {0 to 1}, when When::Given("groom.look.melanin");
        /// Dye over the melanin or the colors: the color that white hair would take on. White: no dye.
        #[serde(deserialize_with = "crate::deserialize_color")]
        dye: Vec3 = Vec3::ONE, "linear RGB", {color};
        /// Variation of the pigment from strand to strand. The default is visible only as depth.
        variation: f32 = 0.25, "fraction", {0 to 1};
        /// Width of the highlights along the strand, from oiled to matte. The default is healthy hair (Marschner
        /// et al. 2003 measured 5° to 10°).
        roughness: f32 = 0.32, "fraction", {0.1 to 1};
        /// Tilt of the cuticle scales, which separates the white highlight from the colored one. Measured values
        /// are 2° to 4° (Marschner et al. 2003, table 1).
        cuticle: f32 = 3.0, ["degrees"], {0 to 10};
        /// Strength of the two highlights. The default is dielectric keratin.
        specular: f32 = 1.0, "factor", {0 to 4};
        /// Strength of the light transmitted through strands from behind.
        backlight: f32 = 1.0, "factor", {0 to 4};
        /// Strength of the light scattered from strand to strand.
        scatter: f32 = 1.0, "factor", {0 to 4};
        /// Strength of the shadows from strands. With the default, strands are as opaque as they are wide.
        shadow: f32 = 1.0, "factor", {0 to 4};
    }
}

/// Natural hair colors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
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
