//! The byte order mark and the line endings of a text file.

const MARK: char = '\u{feff}';

/// Byte order mark and line ends of a file. By default it has no mark, and a line ends with `\n`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TextStyle {
    mark: bool,
    /// Whether lines end with `\r\n`. The first line decides for the file.
    carriage_returns: bool,
}

impl TextStyle {
    /// Returns the style of a file, and its text without the mark and with `\n` as line ends.
    pub fn split(content: &str) -> (Self, String) {
        let text = content.strip_prefix(MARK);
        let first = content.split_once('\n');
        let style = Self {
            mark: text.is_some(),
            carriage_returns: first.is_some_and(|(line, _)| line.ends_with('\r')),
        };
        (style, text.unwrap_or(content).replace("\r\n", "\n"))
    }

    /// Returns the content of a file with this text.
    pub fn content(self, text: &str) -> String {
        let text = if self.carriage_returns { text.replace('\n', "\r\n") } else { text.to_owned() };
        if self.mark { format!("{MARK}{text}") } else { text }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_keeps_its_mark_and_line_ends() {
        for content in ["a\nb\n", "a\r\nb\r\n", "\u{feff}a\nb", "\u{feff}a\r\nb\r\n", "a", ""] {
            let (style, text) = TextStyle::split(content);
            assert!(!text.contains(['\r', MARK]), "{content:?}: {text:?}");
            assert_eq!(style.content(&text), content);
        }
    }
}
