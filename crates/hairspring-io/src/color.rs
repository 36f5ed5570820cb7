//! Colors of points in a file.

use glam::Vec3;
use hairspring_scene::linear_from_srgb;

/// Largest component of a linear color that is only too bright [1]. Beyond it, colors are 8-bit.
const BRIGHT: f32 = 2.0;

/// Brings linear colors into the range from 0 to 1. Components of up to 255 are taken for 8-bit sRGB; those that are not
/// finite become 0. Returns a note if a color was changed.
pub(crate) fn into_range(colors: &mut [Vec3]) -> Option<String> {
    let outside = |c: &&mut Vec3| !(c.cmpge(Vec3::ZERO).all() && c.cmple(Vec3::ONE).all());
    let largest = colors.iter().map(|c| c.max_element()).filter(|c| c.is_finite()).fold(0.0, f32::max);
    if largest > BRIGHT && largest <= 255.0 {
        for color in colors {
            *color = within(*color / 255.0).map(linear_from_srgb);
        }
        return Some(format!(
            "colors of up to {largest} are read as 8-bit sRGB; write linear values from 0 to 1 to change it"
        ));
    }
    let mut count = 0;
    for color in colors.iter_mut().filter(outside) {
        *color = within(*color);
        count += 1;
    }
    (count > 0).then(|| format!("{count} colors outside of 0 to 1 are clipped"))
}

/// The color with each component between 0 and 1; NaN becomes 0.
fn within(color: Vec3) -> Vec3 {
    color.map(|c| if c > 0.0 { c.min(1.0) } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_outside_of_the_range_are_reported() {
        let mut fine = [Vec3::new(0.0, 0.5, 1.0)];
        assert_eq!(into_range(&mut fine), None);
        assert_eq!(fine, [Vec3::new(0.0, 0.5, 1.0)]);
        let mut bright = [Vec3::new(0.1, 1.5, -0.1), Vec3::ONE];
        assert_eq!(into_range(&mut bright).unwrap(), "1 colors outside of 0 to 1 are clipped");
        assert_eq!(bright, [Vec3::new(0.1, 1.0, 0.0), Vec3::ONE]);
        let mut broken = [Vec3::new(f32::NAN, 0.5, f32::INFINITY)];
        assert!(into_range(&mut broken).is_some());
        assert_eq!(broken, [Vec3::new(0.0, 0.5, 1.0)]);
        let mut bytes = [Vec3::new(255.0, 0.0, 128.0)];
        assert!(into_range(&mut bytes).unwrap().contains("8-bit sRGB"));
        assert!(bytes[0].distance(Vec3::new(1.0, 0.0, 0.2159)) < 1e-3, "{}", bytes[0]);
    }
}
