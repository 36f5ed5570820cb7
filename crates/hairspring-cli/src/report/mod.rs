//! Common parts of the pages of `validate` and `compare`: a self-contained HTML file and its plots.

pub mod chart;

const STYLE: &str = "
body { font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; max-width: 46rem; margin: 2rem auto; padding: 0 1rem }
h1 { font-size: 1.6rem } h2 { font-size: 1.2rem; margin-top: 2.5rem; border-top: 1px solid #ddd; padding-top: 1rem }
table { border-collapse: collapse; width: 100%; font-size: 0.85rem; font-variant-numeric: tabular-nums }
th { text-align: left; border-bottom: 1px solid #999 } th, td { padding: 0.15rem 0.5rem 0.15rem 0; vertical-align: top }
tr.fail td { color: #b00020; font-weight: 600 }
svg { width: 100%; height: auto } svg text { font: 12px system-ui, sans-serif; fill: #444 }
.grid { stroke: #eee } .axis { stroke: #999; fill: none } .curve { fill: none; stroke-width: 1.6 }
pre { background: #f6f6f6; padding: 0.6rem 0.8rem; overflow-x: auto; font: 14px/1.5 ui-monospace, monospace }
.wide { width: min(94vw, 84rem); margin-left: 50%; transform: translateX(-50%); overflow-x: auto }
img { width: 100%; min-width: 8rem; display: block } td.picture, th.picture { padding: 0.15rem } td.number, th.number { text-align: right; white-space: nowrap }
svg circle { stroke: #fff; stroke-width: 1 }
.legend { font-size: 0.85rem; margin: 0 } .legend span { margin-right: 1.2rem; display: inline-block } .key { width: 28px; height: 10px; margin-right: 0.4rem }
small { color: #666 } nav a { margin-right: 0.8rem; white-space: nowrap }
";

/// Returns a page with this title and this HTML as its content.
pub fn document(title: &str, body: &str) -> String {
    let title = escape(title);
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width\">\
         <title>{title}</title><style>{STYLE}</style></head><body>\n<h1>{title}</h1>\n{body}</body></html>\n"
    )
}

/// Escapes text for use inside an element.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Formats a number with five significant digits, without trailing zeros.
pub fn number(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let digits = 4 - x.abs().log10().floor() as i32;
    if !(0..=9).contains(&digits) {
        // Integers such as 123456 keep their digits; very small numbers get an exponent.
        return if digits < 0 { format!("{x:.0}") } else { format!("{x:.4e}") };
    }
    let text = format!("{x:.*}", digits as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_have_five_digits() {
        for (x, text) in [
            (0.123456, "0.12346"),
            (10.0, "10"),
            (1379.089, "1379.1"),
            (0.667, "0.667"),
            (123456.0, "123456"),
            (0.0, "0"),
        ] {
            assert_eq!(number(x), text);
        }
    }
}
