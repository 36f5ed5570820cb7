//! Parses frame numbers, sizes and guides from the command line.

use hairspring_scene::{Background, Guides, stage::FrameRate};
use std::str::FromStr;

/// Frames from `first` to `last`, both included, counted from 1; frame 1 is the rest pose at time 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    /// First frame, 1 or more.
    pub first: u32,
    /// Last frame, `first` or more.
    pub last: u32,
}

/// Maximum number of frames of a run: nine hours at 30 frames per second.
const MOST: u32 = 1_000_000;

impl FrameRange {
    /// The frames of a motion of this duration [s] at the rate `fps`, including its last moment; five seconds without a
    /// motion.
    pub fn whole(motion: Option<f64>, fps: FrameRate) -> Self {
        let last = fps.frames_of(motion);
        Self { first: 1, last: last.min(MOST) }
    }

    /// The number of frames.
    pub fn count(self) -> u32 {
        self.last - self.first + 1
    }

    /// The frame numbers.
    pub fn numbers(self) -> std::ops::RangeInclusive<u32> {
        self.first..=self.last
    }
}

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (first, last) = text.split_once('-').unwrap_or((text, text));
        let number = |n: &str| n.trim().parse::<u32>().ok().filter(|n| (1..=MOST).contains(n));
        match (number(first), number(last)) {
            (Some(first), Some(last)) if first <= last => Ok(Self { first, last }),
            _ => Err(format!("expected a frame or a range of frames from 1 to {MOST}, such as 60 or 1-150")),
        }
    }
}

/// Parses the width and height of a picture [pixels], each 1 to 16,384, from text such as `1280x720`.
pub fn size(text: &str) -> Result<(u32, u32), String> {
    let side = |n: &str| n.trim().parse::<u32>().ok().filter(|n| (1..=16_384).contains(n));
    text.split_once(['x', 'X'])
        .and_then(|(w, h)| Some((side(w)?, side(h)?)))
        .ok_or_else(|| "expected width x height in pixels, each 1 to 16384, such as 1280x720".into())
}

/// Parses which strands are simulated: `all`, `file` or a number.
pub fn guides(text: &str) -> Result<Guides, String> {
    match text {
        "all" => Ok(Guides::All),
        "file" => Ok(Guides::FromGroom),
        _ => text.parse().ok().filter(|n| *n > 0).map(Guides::Count).ok_or_else(|| {
            format!(
                "expected a number from 1 to {}, `all`, or `file` for the guides that the groom names",
                u32::MAX
            )
        }),
    }
}

/// Parses a point, `x,y,z` [m].
pub fn point(text: &str) -> Result<glam::Vec3, String> {
    let numbers: Option<Vec<f32>> =
        text.split(',').map(|n| n.trim().parse().ok().filter(|n: &f32| n.is_finite())).collect();
    numbers
        .and_then(|n| <[f32; 3]>::try_from(n).ok())
        .map(Into::into)
        .ok_or_else(|| "expected three numbers in meters, such as 0,1.6,0.5".into())
}

/// Parses an angle of the light [degrees].
pub fn light_angle(text: &str) -> Result<f32, String> {
    angle(text, -360.0)
}

/// Parses the angle of a shutter [degrees].
pub fn shutter(text: &str) -> Result<f32, String> {
    angle(text, 0.0)
}

fn angle(text: &str, least: f32) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|n| (least..=360.0).contains(n));
    number.ok_or_else(|| format!("expected degrees from {least} to 360"))
}

/// Parses what is behind body and hair.
pub fn background(text: &str) -> Result<Background, String> {
    let names = Background::ALL.map(Background::name).join(", ");
    Background::ALL.into_iter().find(|b| b.name() == text).ok_or(format!("expected one of {names}"))
}

/// Parses `yes` or `no`.
pub fn yes_or_no(text: &str) -> Result<bool, String> {
    match text {
        "yes" => Ok(true),
        "no" => Ok(false),
        _ => Err("expected yes or no".into()),
    }
}

/// Parses the duration of a pre-roll, 0 to 60 [s].
pub fn preroll(text: &str) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|n| (0.0..=60.0).contains(n));
    number.ok_or_else(|| "expected a number of seconds from 0 to 60".into())
}

/// Parses a number above 0.
pub fn positive(text: &str) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|n| n.is_finite() && *n > 0.0);
    number.ok_or_else(|| "expected a number above 0".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_read_or_refused() {
        let range = |t: &str| t.parse::<FrameRange>().ok().map(|r| (r.first, r.last));
        assert_eq!(range("1-150"), Some((1, 150)));
        assert_eq!(range("60"), Some((60, 60)));
        for wrong in ["", "0", "0-3", "5-4", "-3", "1-", "a-b", "1-2-3", "99999999999"] {
            assert_eq!(range(wrong), None, "{wrong:?}");
        }
        assert_eq!(size("1280x720"), Ok((1280, 720)));
        assert!(["", "12", "0x5", "5x0", "1x99999", "axb"].iter().all(|t| size(t).is_err()));
        assert!(["0", "nan", "inf", "-1", "241"].iter().all(|t| FrameRate::of_output(t).is_err()));
    }

    #[test]
    fn a_motion_is_played_to_its_last_moment() {
        let whole = |motion: Option<f64>, fps: &str| {
            FrameRange::whole(motion, FrameRate::of_output(fps).unwrap()).last
        };
        assert_eq!(whole(Some(300.0 / 60.0), "30"), 151);
        assert_eq!(whole(Some(342.0 / 120.0), "30"), 86);
        assert_eq!(whole(None, "24"), 120);
    }
}
