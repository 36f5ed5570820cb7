//! Materials: the physical constants of human hair, and presets of hair types.
//!
//! # Example
//! ```
//! use hairspring::material::{Material, Model, preset};
//!
//! let curls = Material { model: Model::Rod, flatness: 0.6, ..preset("curly").expect("a preset") };
//! assert_eq!((curls.bend, curls.flatness), (8.0, 0.6));
//! ```

mod global_shape;

pub use global_shape::GlobalShape;

use crate::settings::{Check, Validate, above_0, check, from_0};

/// The fiber of one group of strands: physical constants, and dimensionless multipliers for artists.
///
/// The constants are those of human hair (Robbins 2012, *Chemical and Physical Behavior of Human Hair*).
///
/// Fields may be added: write `..Default::default()`. For an example, see [`material`](crate::material).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Material {
    /// Elastic model of a strand. Default `auto`.
    pub model: Model,
    /// Fiber radius [m], which replaces the groom's; `None`: the groom's radius. Human hair: 25e-6 to 50e-6.
    pub radius: Option<f32>,
    /// Density of the fiber [kg/m³]. Default 1310: dry hair, 1300 to 1320.
    pub density: f32,
    /// Distribution of mass along a strand: weights at equal spacing in arc length from root to tip, linear
    /// in between. Default `[1.0]`: uniform. Only the ratios count; the total mass is given by the density.
    /// For example, `[1.0, 3.0]` is three times as heavy at the tip as at the root. The profile does not
    /// affect the stiffness or the drag of a length of hair, which depend on the fiber's radius.
    ///
    /// 1 to 64 values above 0, the largest at most 100 times the smallest. A light strand under a heavy tip
    /// is as hard to solve as one with many more points. In the bench's shake at 4 substeps, 32 points do not
    /// jitter with `[1, 1, 1, 100]`; nor do 64 points with `[1, 1, 1, 10]`, or with 30 in place of 10 at 8
    /// substeps.
    pub mass_profile: Vec<f32>,
    /// Young's modulus along the fiber [Pa]. Default 3.9e9.
    pub young: f32,
    /// Shear modulus of the fiber [Pa], above 0. Default 0.89e9. It is independent of Young's modulus because
    /// hair is anisotropic; with the defaults, GJ/EI is 0.46.
    pub shear: f32,
    /// Multiplier of the bending and twisting stiffness EI and GJ, 0 or more. Default 1: a single hair.
    /// Styled hair is also held by products and neighboring hairs, so presets use more.
    pub bend: f32,
    /// Bending stiffness at the tip as a fraction of that at the root, 0 to 1 or more. Default 1.
    pub bend_tip: f32,
    /// Ratio of the short to the long axis of the fiber's cross-section, above 0, at most 1; the area is
    /// kept. Default 1: round. Asian hair is about 0.9, African about 0.6. The long axis is along the normal
    /// of the strand's frame at its root. Only the rod model uses it.
    pub flatness: f32,
    /// Relaxation time of the fiber's bending [s], 0 or more. Larger values damp the hair's own vibrations
    /// faster. Default 0.01: the solver adds almost no damping, and in a head of hair, neighboring hairs
    /// absorb a swing within a second.
    pub damping: f32,
    /// Multiplier of the air drag of a single, smooth fiber, 0 or more. Default 1. In a scene, dense hair
    /// also shields itself from the air according to its density.
    pub drag: f32,
    /// Static Coulomb friction coefficient against the body, 0 to 1. Default 0.3. Hair on skin has 0.1 to 0.3
    /// along the scales, and more against them.
    pub friction: f32,
    /// Ratio of kinetic to static friction, 0 to 1. Kinetic friction acts on a strand that slides faster than
    /// a millimeter per second. Default 1: one coefficient for both, which avoids jerks when a strand comes
    /// loose.
    pub friction_kinetic: f32,
    /// Spring to the rest shape, carried by the root; enabled by `Solver::global_shape`. Default: none.
    pub global_shape: GlobalShape,
    /// Maximum distance of a point from its root, relative to that at rest [1], 1 to 10 (long-range
    /// attachment). 0, the default: no limit. Not physical: it limits how far hair falls. From 1.01 on it has
    /// no effect at rest.
    pub tether: f32,
    /// Static charge per length of hair [C/m], −1e-6 to 1e-6. Default 0. Hair of 35 µm holds at most 6e-9,
    /// where the air at its surface breaks down. From 5e-10 on, a field of 100 kV/m lifts it against gravity.
    pub charge: f32,
}

/// The elastic model of a strand.
///
/// For an example, see [`material`](crate::material).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Model {
    /// The rod model. Straight, round strands, for which the result is the same, use the cheaper curvature
    /// model.
    #[default]
    Auto,
    /// Stretch, bend, torsion and altitude springs (Selle 2008), with an extra particle beside each segment.
    Springs,
    /// Stretch, and bending by the curvature vector in a frame transported from the root, without twist.
    Curvature,
    /// A discrete elastic rod: curvature, and a twist angle for each segment.
    Rod,
}

impl Model {
    /// All models.
    pub const ALL: [Model; 4] = [Self::Auto, Self::Springs, Self::Curvature, Self::Rod];

    /// Returns the name used in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Springs => "springs",
            Self::Curvature => "curvature",
            Self::Rod => "rod",
        }
    }
}

impl Validate for Material {
    fn checks(&self) -> Vec<Check> {
        let shape = &self.global_shape;
        let shape_in_range =
            (0.0..=60.0).contains(&shape.pull) && from_0(shape.tip) && (0.0..=10.0).contains(&shape.damping);
        let tether = self.tether == 0.0 || (1.0..=10.0).contains(&self.tether);
        vec![
            check(above_0(self.radius), "radius", "above 0 [m]"),
            check(above_0(Some(self.density)), "density", "above 0 [kg/m³]"),
            check(
                is_mass_profile(&self.mass_profile),
                "mass_profile",
                "1 to 64 numbers above 0, the largest at most 100 times the smallest",
            ),
            check(above_0(Some(self.young)), "young", "above 0 [Pa]"),
            check(above_0(Some(self.shear)), "shear", "above 0 [Pa]"),
            check(from_0(self.bend), "bend", "0 or more"),
            check(from_0(self.bend_tip), "bend_tip", "0 or more"),
            check((0.05..=1.0).contains(&self.flatness), "flatness", "0.05 to 1"),
            check(from_0(self.damping), "damping", "0 or more [s]"),
            check(from_0(self.drag), "drag", "0 or more"),
            check((0.0..=1.0).contains(&self.friction), "friction", "0 to 1"),
            check((0.0..=1.0).contains(&self.friction_kinetic), "friction_kinetic", "0 to 1"),
            check(shape_in_range, "global_shape", "`pull` 0 to 60 [Hz], `tip` 0 or more, `damping` 0 to 10"),
            check(tether, "tether", "0 (none), or 1 to 10"),
            check((-1e-6..=1e-6).contains(&self.charge), "charge", "-1e-6 to 1e-6 [C/m]"),
        ]
    }
}

/// Returns whether the weights of a mass profile are valid.
fn is_mass_profile(weights: &[f32]) -> bool {
    let least = weights.iter().copied().fold(f32::INFINITY, f32::min);
    let holds = |w: &f32| w.is_finite() && *w > 0.0 && *w <= least * 100.0;
    (1..=64).contains(&weights.len()) && weights.iter().all(holds)
}

impl Default for Material {
    fn default() -> Self {
        Self {
            model: Model::Auto,
            radius: None,
            density: 1310.0,
            mass_profile: vec![1.0],
            young: 3.9e9,
            shear: 0.89e9,
            bend: 1.0,
            bend_tip: 1.0,
            flatness: 1.0,
            damping: 0.01,
            drag: 1.0,
            friction: 0.3,
            friction_kinetic: 1.0,
            global_shape: GlobalShape::default(),
            tether: 0.0,
            charge: 0.0,
        }
    }
}

/// Names of the presets known to [`preset`].
pub const PRESETS: [&str; 5] = ["straight", "wavy", "curly", "coily", "short-fur"];

/// Returns the preset with this name: `straight`, `wavy`, `curly`, `coily` or `short-fur`; `None` for any
/// other name.
///
/// For an example, see [`material`](crate::material).
pub fn preset(name: &str) -> Option<Material> {
    let base = Material::default();
    Some(match name {
        "straight" => Material { bend: 2.0, ..base },
        "wavy" => Material { bend: 4.0, damping: 0.015, ..base },
        "curly" => Material { bend: 8.0, damping: 0.02, ..base },
        "coily" => Material { bend: 16.0, damping: 0.025, ..base },
        "short-fur" => Material { radius: Some(25e-6), bend: 1.0, bend_tip: 0.5, ..base },
        _ => return None,
    })
}
