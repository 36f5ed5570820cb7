//! The cross section of a fiber, and its effect on the stiffness.

use crate::{
    groom::StrandScale,
    material::{Material, profile_at},
};

/// Smallest ratio of the short to the long axis [1].
const MIN_AXIS_RATIO: f32 = 0.05;

/// Effect of a fiber's cross section on its stiffness. An ellipse with semi-axes a ≥ b and b/a = f has, for
/// the same area as the circle of radius r: I_min = πr⁴f/4, I_max = πr⁴/4f, J = πr⁴ / (f + 1/f).
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// I_min over that of the circle [1].
    pub bend: f32,
    /// I_max/I_min − 1 [1].
    pub flat: f32,
    /// GJ/EI_min. The style's multiplier scales both [1].
    pub twist_ratio: f32,
}

impl Section {
    /// The section of a strand's fiber at the fraction `along` of its length, 0 at the root and 1 at the tip.
    pub fn new(material: &Material, scale: StrandScale, along: f64) -> Self {
        let f = material.flatness * scale.flatness * profile_at(&material.flatness_profile, along) as f32;
        let f = f.clamp(MIN_AXIS_RATIO, 1.0);
        Self {
            bend: f,
            flat: 1.0 / (f * f) - 1.0,
            twist_ratio: 4.0 * material.shear / (material.young * (1.0 + f * f)),
        }
    }

    /// A section that bends with the stiffness of this one in its stiff direction.
    pub fn stiff(self) -> Self {
        Self { bend: self.bend * (1.0 + self.flat), ..self }
    }
}

/// Returns whether a strand's fiber is round everywhere.
pub fn is_round(material: &Material, scale: StrandScale) -> bool {
    material.flatness_profile.iter().all(|value| material.flatness * scale.flatness * value >= 1.0)
}
