//! Colors in scene files: three linear numbers, or sRGB in hexadecimal as paint programs show it.

use glam::Vec3;
use serde::{
    Deserialize, Deserializer,
    de::{self, SeqAccess, Unexpected, Visitor},
};
use std::fmt;

/// Returns the linear RGB color of an sRGB color in hexadecimal, `#rrggbb` or `#rgb`. `None` for other text.
///
/// ```
/// let sienna = hairspring_scene::color_from_hex("#a0522d").unwrap();
/// assert!((sienna.x - 0.3515).abs() < 1e-4);
/// ```
pub fn color_from_hex(text: &str) -> Option<Vec3> {
    let digits = text.strip_prefix('#').filter(|digits| digits.bytes().all(|b| b.is_ascii_hexdigit()))?;
    let channel = |i: usize| -> Option<f32> {
        let value = match digits.len() {
            6 => u8::from_str_radix(&digits[2 * i..2 * i + 2], 16),
            3 => u8::from_str_radix(&digits[i..=i], 16).map(|v| v * 17),
            _ => return None,
        };
        Some(linear_from_srgb(f32::from(value.ok()?) / 255.0))
    };
    Some(Vec3::new(channel(0)?, channel(1)?, channel(2)?))
}

/// Returns the linear value of an sRGB channel, 0 to 1 (IEC 61966-2-1).
pub fn linear_from_srgb(v: f32) -> f32 {
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// Reads a color: three linear numbers, or text for [`color_from_hex`]. For `#[serde(deserialize_with)]`.
///
/// # Errors
/// Returns an error for any other value.
pub fn deserialize_color<'de, D: Deserializer<'de>>(from: D) -> Result<Vec3, D::Error> {
    struct Color;
    impl<'de> Visitor<'de> for Color {
        type Value = Vec3;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str(
                "three numbers from 0 to 1, such as [0.35, 0.08, 0.03], or a color such as \"#a0522d\"",
            )
        }

        fn visit_str<E: de::Error>(self, text: &str) -> Result<Vec3, E> {
            color_from_hex(text).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Vec3, A::Error> {
            let mut color = Vec3::ZERO;
            for i in 0..3 {
                color[i] = values.next_element()?.ok_or_else(|| de::Error::invalid_length(i, &self))?;
            }
            let mut more = 0;
            while values.next_element::<de::IgnoredAny>()?.is_some() {
                more += 1;
            }
            if more > 0 { Err(de::Error::invalid_length(3 + more, &self)) } else { Ok(color) }
        }
    }
    from.deserialize_any(Color)
}

/// Like [`deserialize_color`], for a field that may be omitted.
///
/// # Errors
/// Returns an error for a value that is not a color.
pub fn deserialize_optional_color<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Vec3>, D::Error> {
    #[derive(Deserialize)]
    struct Color(#[serde(deserialize_with = "deserialize_color")] Vec3);
    Ok(Option::<Color>::deserialize(from)?.map(|color| color.0))
}

#[cfg(test)]
mod tests {
    use super::color_from_hex;
    use glam::Vec3;

    #[test]
    fn hexadecimal_colors_are_srgb() {
        assert_eq!(color_from_hex("#ffffff"), Some(Vec3::ONE));
        assert_eq!(color_from_hex("#000"), Some(Vec3::ZERO));
        assert_eq!(color_from_hex("#fA3"), color_from_hex("#FFaa33"));
        let half = color_from_hex("#808080").unwrap();
        assert!(half.distance(Vec3::splat(0.2159)) < 1e-4, "{half}");
        for wrong in ["a0522d", "#a0522", "#a0522dff", "#a0522g", "#", "", "red", "#é1", "#+12345"] {
            assert_eq!(color_from_hex(wrong), None, "{wrong}");
        }
    }
}
