//! Numbers as text: what a field shows of a number, and what a typed text means.

use eframe::egui::DragValue;

/// A field for a number. It writes nothing if its text was not changed, even if it shows fewer digits than the
/// number has.
pub fn drag(x: &mut f64) -> DragValue<'_> {
    let parser = parser(*x);
    DragValue::new(x)
        .custom_formatter(|x, _| shown(x))
        .custom_parser(parser)
        .update_while_editing(false)
        .clamp_existing_to_range(false)
}

/// Formats a number with four significant digits, but with all digits of its integer part. Very large and very
/// small numbers are powers of ten with three significant digits.
pub fn shown(x: f64) -> String {
    let rounded = |text: String| text.parse().unwrap_or(x);
    if x == 0.0 {
        "0".into()
    } else if (1e-3..1e6).contains(&x.abs()) {
        let decimals = (3 - x.abs().log10().floor() as i32).max(0) as usize;
        rounded(format!("{x:.decimals$}")).to_string()
    } else {
        format!("{:e}", rounded(format!("{x:.2e}")))
    }
}

/// Returns a parser for the text of a field that shows `now`. The text that was shown means `now` itself.
pub fn parser(now: f64) -> impl Fn(&str) -> Option<f64> {
    let unchanged = shown(now);
    move |text| {
        let text: String = text.split_whitespace().collect::<String>().replace('−', "-");
        if text == unchanged { Some(now) } else { text.parse().ok().filter(|x: &f64| x.is_finite()) }
    }
}

/// Removes the rounding errors of a drag. Single precision, which settings have, needs nine significant digits.
pub fn tidy(x: f64) -> f64 {
    format!("{x:.8e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_with_four_significant_digits_and_no_trailing_zeros() {
        let shown = [0.0, -0.0, 0.055, 0.632, 0.012345, 0.00367, -2.0, 1234.56, 30000.0].map(shown);
        assert_eq!(shown, ["0", "0", "0.055", "0.632", "0.01235", "0.00367", "-2", "1235", "30000"]);
        assert_eq!([-2e-7, 1.2345e-4, 3e9].map(super::shown), ["-2e-7", "1.23e-4", "3e9"]);
    }

    #[test]
    fn unchanged_text_keeps_the_number_and_typed_numbers_are_kept_in_full() {
        let parse = parser(0.632_471);
        assert_eq!(parse("0.6325"), Some(0.632_471));
        assert_eq!(parse("0.0123456"), Some(0.012_345_6));
        assert_eq!(parse(" −1 000.5 "), Some(-1000.5));
        assert_eq!([parse("inf"), parse("a")], [None, None]);
        assert_eq!([tidy(0.1 + 0.2), tidy(0.012_345_6)], [0.3, 0.012_345_6]);
    }
}
