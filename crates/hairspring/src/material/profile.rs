//! Profiles: curves from root to tip that multiply a parameter of a material.

use super::Material;
use crate::groom::{MAX_FACTOR, MIN_FACTOR, StrandScale};
use glam::Vec3;

/// Largest number of values in a profile.
pub const MAX_VALUES: usize = 64;

/// Returns the value of a profile at the fraction `along` of the strand's length, 0 at the root and 1 at the
/// tip: linear between values at equal spacing, the first of which is at the root. 1 for an empty profile.
///
/// ```
/// use hairspring::material::profile_at;
///
/// assert_eq!(profile_at(&[1.0, 3.0, 0.0], 0.25), 2.0);
/// assert_eq!(profile_at(&[2.0], 0.7), 2.0);
/// ```
pub fn profile_at(profile: &[f32], along: f64) -> f64 {
    let Some(last) = profile.len().checked_sub(1) else { return 1.0 };
    if last == 0 {
        return f64::from(profile[0]);
    }
    let at = along.clamp(0.0, 1.0) * last as f64;
    let k = (at as usize).min(last - 1);
    let [from, to] = [profile[k], profile[k + 1]].map(f64::from);
    from + (to - from) * (at - k as f64)
}

/// Smallest length of a strand that is divided by [m].
const MIN_LENGTH: f32 = 1e-9;

impl Material {
    /// Returns the radius at each of a strand's `points` [m], by the material's radius, its profile, and the
    /// multipliers of the strand; `None` without a radius: then the groom's own radii are used.
    pub fn radii(&self, points: &[Vec3], scale: StrandScale) -> Option<Vec<f32>> {
        let radius = self.radius? * scale.radius;
        let length: f32 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
        let mut along = 0.0;
        let at = |(i, p): (usize, &Vec3)| {
            along += p.distance(points[i.saturating_sub(1)]);
            radius * profile_at(&self.radius_profile, f64::from(along / length.max(MIN_LENGTH))) as f32
        };
        Some(points.iter().enumerate().map(at).collect())
    }
}

/// Returns whether a profile changes the parameter that it multiplies.
pub(crate) fn varies(profile: &[f32]) -> bool {
    profile.iter().any(|value| *value != 1.0)
}

/// Returns whether the values of a profile are valid: 0 to [`MAX_FACTOR`].
pub(super) fn is_profile(values: &[f32]) -> bool {
    (1..=MAX_VALUES).contains(&values.len()) && values.iter().all(|v| (0.0..=MAX_FACTOR).contains(v))
}

/// Returns whether they are, for a parameter that may not be 0 anywhere.
pub(super) fn is_positive_profile(values: &[f32]) -> bool {
    is_profile(values) && values.iter().all(|v| *v >= MIN_FACTOR)
}

/// Returns whether the weights of a distribution of mass are valid.
pub(super) fn is_mass_profile(weights: &[f32]) -> bool {
    let least = weights.iter().copied().fold(f32::INFINITY, f32::min);
    is_positive_profile(weights) && weights.iter().all(|w| *w <= least * 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_is_linear_between_its_values_and_constant_beyond() {
        let profile = [1.0, 0.5, 2.0];
        for (along, value) in
            [(-1.0, 1.0), (0.0, 1.0), (0.25, 0.75), (0.5, 0.5), (0.75, 1.25), (1.0, 2.0), (3.0, 2.0)]
        {
            assert_eq!(profile_at(&profile, along), value, "at {along}");
        }
        assert_eq!((profile_at(&[], 0.3), profile_at(&[4.0], 0.3)), (1.0, 4.0));
    }
}
