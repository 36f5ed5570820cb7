//! What the hair is made of: constants of the human fibre, and presets of style.

mod global_shape;

pub use global_shape::GlobalShape;

use serde::{Deserialize, Serialize};

/// The fibre of one group of strands: physical constants, and dimensionless multipliers for the artist.
///
/// The constants are those of human hair (Robbins 2012, *Chemical and Physical Behavior of Human Hair*).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Material {
    /// What holds a strand's shape. Default `auto`.
    pub model: Model,
    /// Fibre radius [m], over the groom's own; `None`: the groom's. Human hair: 25e-6 to 50e-6.
    pub radius: Option<f32>,
    /// Density of the fibre [kg/m³]. Default 1310: dry hair, 1300 to 1320.
    pub density: f32,
    /// How the mass lies along a strand: weights at equal spacing in arc length from root to tip, linear in between. Default `[1.0]`: evenly.
    /// Only their ratios count, and a strand weighs what its density says: `[1.0, 3.0]` is three times as heavy at the tip as at the
    /// root. Stiffness and the air's force on a length are those of the fibre's radius, whatever its mass.
    ///
    /// 1 to 64 values above 0, the largest at most 100 times the smallest: a light strand under a heavy tip is as hard to solve as one of many
    /// more points. In the bench's shake at 4 substeps, 32 points stay quiet with `[1, 1, 1, 100]`; 64 points do with
    /// `[1, 1, 1, 10]`, and with 30 in place of 10 at 8 substeps.
    pub mass_profile: Vec<f32>,
    /// Young's modulus along the fibre [Pa]. Default 3.9e9.
    pub young: f32,
    /// Shear modulus of the fibre [Pa], above 0. Default 0.89e9: hair is anisotropic, so that it is set by itself and not from
    /// Young's modulus; GJ/EI is then 0.46.
    pub shear: f32,
    /// Multiplier over the bending and twisting stiffness EI and GJ, 0 or more. Default 1: a single hair. A styled head is held
    /// by wax and neighbours, so presets use more.
    pub bend: f32,
    /// Bending stiffness at the tip as a fraction of that at the root, 0 to 1 or more. Default 1.
    pub bend_tip: f32,
    /// Short over long axis of the fibre's section, above 0, at most 1; its area is kept. Default 1: round. Asian hair is about 0.9, African
    /// about 0.6. The long axis lies along the normal of the strand's frame at its root. For the rod model.
    pub flatness: f32,
    /// Relaxation time of the fibre's bending [s], 0 or more: larger stops the hair's own vibrations sooner. Default 0.01: the
    /// solver adds next to none, and in a head of hair neighbours take a swing's energy within a second.
    pub damping: f32,
    /// Multiplier over the drag of the air on a lone, smooth fiber, 0 or more. Default 1. In a scene, dense hair shelters itself from the air
    /// by its density besides.
    pub drag: f32,
    /// Coulomb friction against the body, 0 to 1: static, what holds. Default 0.3: hair on skin, 0.1 to 0.3 along the scales, higher against.
    pub friction: f32,
    /// Kinetic friction over static, 0 to 1: what holds a strand back that slides faster than a millimetre a second. Default 1: one coefficient for both, with
    /// which nothing jerks as it comes loose.
    pub friction_kinetic: f32,
    /// Pull to the rest shape, carried by the root; switched by `Solver::global_shape`. Default: none.
    pub global_shape: GlobalShape,
    /// How far a point may get from its root, over how far it was at rest [1], 1 to 10 (a long range attachment); 0, the default: as far as it goes. Not physics:
    /// for hair that is to fall so far and no farther. From 1.01 on it does not act at rest.
    pub tether: f32,
    /// Static charge of a length of hair [C/m], −1e-6 to 1e-6. Default 0. Hair of 35 µm holds 6e-9 at most, where air breaks down at its surface; a
    /// field of 100 kV/m lifts it against gravity from 5e-10 on.
    pub charge: f32,
}

/// The elastic model of a strand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// The rod; for strands that are straight and round, where it comes to the same, the cheaper curvature model.
    #[default]
    Auto,
    /// Stretch, bend, torsion and altitude springs (Selle 2008), with an extra particle beside each segment.
    Springs,
    /// Stretch and bending by the curvature vector, in a frame carried from the root that knows no twist.
    Curvature,
    /// A discrete elastic rod: curvature, and a twist angle for each segment.
    Rod,
}

impl Model {
    /// All of them.
    pub const ALL: [Model; 4] = [Self::Auto, Self::Springs, Self::Curvature, Self::Rod];

    /// Its name in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Springs => "springs",
            Self::Curvature => "curvature",
            Self::Rod => "rod",
        }
    }
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

/// Names of the presets, in the order that [`preset`] knows them.
pub const PRESETS: [&str; 5] = ["straight", "wavy", "curly", "coily", "short-fur"];

/// The preset of this name: `straight`, `wavy`, `curly`, `coily` or `short-fur`; `None` for any other.
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
