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
mod profile;

pub use global_shape::GlobalShape;
pub use profile::profile_at;
pub(crate) use profile::varies;

use crate::settings::{When, define_settings};
use profile::{is_mass_profile, is_positive_profile, is_profile};

/// Only integrators with bending use the bending parameters.
const HAS_BENDING: When = When::IsNot("solver.integrator", &["ftl", "dftl"]);

define_settings! {
    /// The fiber of one group of strands: physical constants, and dimensionless multipliers for artists.
    ///
    /// The constants are those of human hair (Robbins 2012, *Chemical and Physical Behavior of Human Hair*).
    ///
    /// A profile multiplies a parameter along the strand: values at equal spacing in arc length from root to tip,
    /// linear in between (see [`profile_at`]).
    ///
    /// Fields may be added: write `..Default::default()`. For an example, see [`material`](crate::material).
    #[derive(Clone, Debug, PartialEq)]
    pub struct Material {
        /// Elastic model of a strand. `auto`: rod, or curvature where both give the same result.
        model: Model = Model::Auto, "none", {words},
            when When::IsNot("solver.integrator", &["ftl", "dftl", "local-global"]);
        /// Fiber radius, which replaces the groom's. Human hair: 25e-6 to 50e-6.
        radius: Option<f32> = None, ["m"], {1e-7 to 0.1}, default "the groom's own";
        /// Multiplier of the radius along the strand, from root to tip: the natural taper of a hair that was never
        /// cut is `[1.0, 0.9, 0.3]`. Mass, stiffness and the drawn width follow. A groom's own radii may have a taper
        /// already, so the profile needs a radius.
        radius_profile: Vec<f32> = vec![1.0], "factors", {
            check |m| is_positive_profile(&m.radius_profile) => "1 to 64 numbers, 0.0001 to 10000"
        }, when When::Given("material.radius");
        /// Density of the fiber. Dry human hair: 1300 to 1320.
        density: f32 = 1310.0, ["kg/m³"], {0.01 to 1000000};
        /// Distribution of mass along a strand: weights at equal spacing in arc length from root to tip, linear
        /// in between. Only the ratios count; the total mass is given by the density. For example, `[1.0, 3.0]` is
        /// three times as heavy at the tip as at the root.
        ///
        /// The profile does not affect the stiffness or the drag of a length of hair, which depend on the fiber's
        /// radius. A light strand under a heavy tip is as hard to solve as one with many more points. In the
        /// bench's shake at 4 substeps, 32 points do not jitter with `[1, 1, 1, 100]`; nor do 64 points with
        /// `[1, 1, 1, 10]`, or with 30 in place of 10 at 8 substeps.
        mass_profile: Vec<f32> = vec![1.0], "ratios", {
            check |m| is_mass_profile(&m.mass_profile)
                => "1 to 64 numbers, 0.0001 to 10000, the largest at most 100 times the smallest"
        };
        /// Young's modulus along the fiber. The default is that of human hair.
        young: f32 = 3.9e9, ["Pa"], {1 to 1e25}, when HAS_BENDING;
        /// Shear modulus of the fiber, which resists twisting. The default is that of human hair.
        ///
        /// It is independent of Young's modulus because hair is anisotropic; with the defaults, GJ/EI is 0.46.
        shear: f32 = 0.89e9, ["Pa"], {1 to 1e25}, when When::All(&[
            When::IsNot("solver.integrator", &["ftl", "dftl", "local-global"]),
            When::IsNot("material.model", &["curvature"]),
        ]);
        /// Multiplier of the bending and twisting stiffness EI and GJ. The default is a single hair. Styled hair
        /// is also held by products and neighboring hairs, so presets use more.
        bend: f32 = 1.0, "factor", {0 to 1000000}, when HAS_BENDING;
        /// Multiplier of the bending and twisting stiffness along the strand, from root to tip: `[1.0, 0.5]` is half
        /// as stiff at the tip.
        bend_profile: Vec<f32> = vec![1.0], "factors", {
            check |m| is_profile(&m.bend_profile) => "1 to 64 numbers, 0 to 10000"
        }, when HAS_BENDING;
        /// Ratio of the short to the long axis of the fiber's cross-section; the area is kept. 1: round. Asian
        /// hair is about 0.9, African about 0.6. Only the rod model uses it.
        ///
        /// The long axis is along the normal of the strand's frame at its root.
        flatness: f32 = 1.0, "fraction", {0.05 to 1}, when HAS_BENDING;
        /// Multiplier of the flatness along the strand, from root to tip: `[1.0, 0.6]` is flatter at the tip. The
        /// ratio of the axes is 0.05 to 1 anywhere, so a profile above 1 has no effect on a round fiber.
        flatness_profile: Vec<f32> = vec![1.0], "factors", {
            check |m| is_positive_profile(&m.flatness_profile) => "1 to 64 numbers, 0.0001 to 10000"
        }, when HAS_BENDING;
        /// Relaxation time of the fiber's bending. Larger values damp the hair's own vibrations faster.
        ///
        /// With the default, the solver adds almost no damping, and in a head of hair, neighboring hairs absorb a
        /// swing within a second.
        damping: f32 = 0.01, ["s"], {0 to 10000}, when HAS_BENDING;
        /// Multiplier of the damping along the strand, from root to tip.
        damping_profile: Vec<f32> = vec![1.0], "factors", {
            check |m| is_profile(&m.damping_profile) => "1 to 64 numbers, 0 to 10000"
        }, when When::All(&[HAS_BENDING, When::Above0("material.damping")]);
        /// Multiplier of the air drag of a single, smooth fiber. In a scene, dense hair also shields itself from
        /// the air according to its density.
        drag: f32 = 1.0, "factor", {0 to 1000000};
        /// Multiplier of the air drag along the strand, from root to tip: `[1.0, 3.0]` makes tips follow the wind.
        drag_profile: Vec<f32> = vec![1.0], "factors", {
            check |m| is_profile(&m.drag_profile) => "1 to 64 numbers, 0 to 10000"
        }, when When::Above0("material.drag");
        /// Static Coulomb friction coefficient against the body. Hair on skin has 0.1 to 0.3 along the scales, and
        /// more against them.
        friction: f32 = 0.3, "coefficient", {0 to 1};
        /// Multiplier of the friction along the strand, from root to tip. The coefficient is at most 1 anywhere.
        friction_profile: Vec<f32> = vec![1.0], "factors", {
            check |m| is_profile(&m.friction_profile) => "1 to 64 numbers, 0 to 10000"
        }, when When::Above0("material.friction");
        /// Ratio of kinetic to static friction. Kinetic friction acts on a strand that slides faster than a
        /// millimeter per second. Below 1, hair that comes loose keeps sliding, which may start with a jerk.
        friction_kinetic: f32 = 1.0, "fraction", {0 to 1}, when When::Above0("material.friction");
        /// Spring to the rest shape, carried by the root. `Solver::global_shape` enables it.
        global_shape: GlobalShape = GlobalShape::default(), "none", {table};
        /// Maximum distance of a point from its root, relative to that at rest (long-range attachment). 0: no
        /// limit. It is not physical, and limits how far hair falls. From 1.01 on it has no effect at rest.
        tether: f32 = 0.0, "factor", {0 or 1 to 10};
        /// Multiplier of the tether along the strand, from root to tip: `[2.0, 1.0]` gives the upper half more room
        /// than the tip. The tether is at least 1 anywhere.
        tether_profile: Vec<f32> = vec![1.0], "factors", {
            check |m| is_profile(&m.tether_profile) => "1 to 64 numbers, 0 to 10000"
        }, when When::Above0("material.tether");
        /// Static charge per length of hair. Charged bodies attract and repel it, and it repels itself. Hair of 35 µm holds at most
        /// 6e-9, where the air at its surface breaks down. From 5e-10 on, a field of 100 kV/m lifts it against
        /// gravity.
        charge: f32 = 0.0, ["C/m"], {-1e-6 to 1e-6};
        /// Multiplier of the charge along the strand, from root to tip: `[0.0, 1.0]` charges the tips.
        charge_profile: Vec<f32> = vec![1.0], "factors", {
            check |m| is_profile(&m.charge_profile) => "1 to 64 numbers, 0 to 10000"
        }, when When::Not0("material.charge");
    }
}

define_settings! {
    /// The elastic model of a strand.
    ///
    /// For an example, see [`material`](crate::material).
    #[non_exhaustive]
    choice Model {
        /// The rod model. Straight, round strands, for which the result is the same, use the cheaper curvature
        /// model.
        #[default]
        Auto = "auto",
        /// Stretch, bend, torsion and altitude springs (Selle 2008), with an extra particle beside each segment.
        Springs = "springs",
        /// Stretch, and bending by the curvature vector in a frame transported from the root, without twist.
        Curvature = "curvature",
        /// A discrete elastic rod: curvature, and a twist angle for each segment.
        Rod = "rod",
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
        "short-fur" => Material { radius: Some(25e-6), bend: 1.0, bend_profile: vec![1.0, 0.5], ..base },
        _ => return None,
    })
}
