//! Range checks for the wind and charge settings of a scene file.

use super::{
    check::{Check, finite, first_failure},
    file::SceneFile,
    sentence::line_at,
};
use crate::Problem;
use glam::Vec3;
use hairspring::{
    air::Flow,
    forces::charge::Charged,
    settings::{above_0, from_0},
};

/// Checks `[wind]`, `[[wind_source]]`, `[turbulence]`, `[wind_occlusion]` and `[[charged]]`.
pub(super) fn ranges(text: &str, scene: &SceneFile) -> Result<(), Problem> {
    let (wind, turbulence, occlusion) = (&scene.wind, &scene.turbulence, &scene.wind_occlusion);
    let gusts = |gust: f32, rate: f32| -> [Check; 2] {
        [((0.0..=1.0).contains(&gust), "gust", "0 to 1"), (from_0(rate), "gust_rate", "0 or more [Hz]")]
    };
    let velocity: Check = (finite(wind.velocity), "velocity", "three finite numbers [m/s]");
    let from = first_line(text, "[wind]");
    first_failure(text, from, &[velocity])?;
    first_failure(text, from, &gusts(wind.gust, wind.gust_rate))?;
    for (source, line) in scene.wind_source.iter().zip(lines(text, "[[wind_source]]")) {
        first_failure(text, line, &gusts(source.gust, source.gust_rate))?;
        first_failure(text, line, &[flow(&source.shape)])?;
    }
    let eddies = [
        (from_0(turbulence.strength), "strength", "0 or more [m/s]"),
        (above_0(Some(turbulence.size)), "size", "above 0 [m]"),
        ((1..=6).contains(&turbulence.octaves), "octaves", "1 to 6"),
    ];
    first_failure(text, first_line(text, "[turbulence]"), &eddies)?;
    let lee = [
        (from_0(occlusion.body), "body", "0 or more [1/m]"),
        (from_0(occlusion.hair), "hair", "0 or more [1/m]"),
        (above_0(Some(occlusion.reach)), "reach", "above 0 [m]"),
    ];
    first_failure(text, first_line(text, "[wind_occlusion]"), &lee)?;
    for (charged, line) in scene.charged.iter().zip(lines(text, "[[charged]]")) {
        let balls = [
            (finite(charged.center), "center", "three finite numbers [m]"),
            (above_0(Some(charged.radius)), "radius", "above 0 [m]"),
            ((-1e-3..=1e-3).contains(&charged.charge), "charge", "-1e-3 to 1e-3 [C]"),
            (
                goes_on(charged),
                "path",
                "finite positions [m] at times above 0 [s], each later than the one before",
            ),
        ];
        first_failure(text, line, &balls)?;
    }
    Ok(())
}

/// Checks that a source's flow is finite and has a valid radius, axis and spread.
fn flow(flow: &Flow) -> Check {
    let sound =
        |center: Vec3, radius: f32, speed: f32| finite(center) && above_0(Some(radius)) && speed.is_finite();
    let points = |axis: Vec3| axis.try_normalize().is_some();
    let holds = match *flow {
        Flow::Point { center, radius, speed } => sound(center, radius, speed),
        Flow::Vortex { center, axis, radius, speed } => sound(center, radius, speed) && points(axis),
        Flow::Fan { center, axis, radius, speed, spread } => {
            sound(center, radius, speed) && points(axis) && (0.0..=80.0).contains(&spread)
        }
    };
    (
        holds,
        "shape",
        "finite, with a radius above 0 [m], an axis that is not 0 and a spread of 0 to 80 [degrees]",
    )
}

/// Whether a charged body's path is finite and its times increase.
fn goes_on(charged: &Charged) -> bool {
    let times = || charged.path.iter().map(|p| p.time);
    let before = std::iter::once(0.0).chain(times());
    charged.path.iter().all(|p| finite(p.center) && p.time.is_finite())
        && times().zip(before).all(|(time, before)| time > before)
}

/// Lines of the tables with this header. Tables that are written in another way get the first line.
pub(super) fn lines<'a>(text: &'a str, header: &'a str) -> impl Iterator<Item = usize> + 'a {
    text.match_indices(header).map(|(at, _)| line_at(text, at)).chain(std::iter::repeat(1))
}

/// The line of the table with this header, or the first line.
fn first_line(text: &str, header: &str) -> usize {
    text.find(header).map_or(1, |at| line_at(text, at))
}
