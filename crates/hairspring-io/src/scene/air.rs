//! Range checks for the wind and charge settings of a scene file.

use super::{check::in_range, file::SceneFile, sentence::line_at};
use crate::Problem;

/// Checks `[wind]`, `[[wind_source]]`, `[turbulence]`, `[wind_occlusion]` and `[[charged]]`.
pub(super) fn ranges(text: &str, scene: &SceneFile) -> Result<(), Problem> {
    in_range(text, first_line(text, "[wind]"), &scene.wind)?;
    for (source, line) in scene.wind_source.iter().zip(lines(text, "[[wind_source]]")) {
        in_range(text, line, source)?;
    }
    in_range(text, first_line(text, "[turbulence]"), &scene.turbulence)?;
    in_range(text, first_line(text, "[wind_occlusion]"), &scene.wind_occlusion)?;
    for (charged, line) in scene.charged.iter().zip(lines(text, "[[charged]]")) {
        in_range(text, line, charged)?;
    }
    Ok(())
}

/// Lines of the tables with this header. Tables that are written in another way get the first line.
pub(super) fn lines<'a>(text: &'a str, header: &'a str) -> impl Iterator<Item = usize> + 'a {
    text.match_indices(header).map(|(at, _)| line_at(text, at)).chain(std::iter::repeat(1))
}

/// The line of the table with this header, or the first line.
fn first_line(text: &str, header: &str) -> usize {
    text.find(header).map_or(1, |at| line_at(text, at))
}
