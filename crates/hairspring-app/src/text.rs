//! Text of the window: counts with their noun, and shortened names.

use std::borrow::Cow;

/// A number of things, such as `1 frame` or `2 frames`. The noun takes an `s` in the plural.
pub fn counted(number: u64, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// Text of at most `most` characters. Longer text ends with an ellipsis.
pub fn shortened(text: &str, most: usize) -> Cow<'_, str> {
    if text.chars().count() <= most {
        return text.into();
    }
    let kept: String = text.chars().take(most.saturating_sub(1)).collect();
    format!("{}…", kept.trim_end()).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_singular_and_long_text_is_shortened() {
        assert_eq!([0, 1, 2].map(|n| counted(n, "frame")), ["0 frames", "1 frame", "2 frames"]);
        assert_eq!([shortened("äöü", 3), shortened("äöü, x", 5)], ["äöü", "äöü,…"]);
    }
}
