//! Reader for Biovision `.bvh` motion capture (Meredith & Maddock 2001, "Motion Capture File Formats
//! Explained"). A file holds a hierarchy of joints with offsets and channels in any order, then one line of
//! numbers per frame.

use crate::{
    Axis, Motion, Place, Problem, ReadOptions,
    motion::check_samples,
    text::{Words, as_text, lines, shortened},
    units::{apply_to_motion, turn_of},
};
use glam::{Quat, Vec3};
use hairspring::body::{Body, Clip, Joint, Trs};
use hairspring_scene::stage::FrameRate;
use std::{borrow::Cow, str::FromStr};

/// One number in a frame's line.
#[derive(Clone, Copy)]
enum Channel {
    Position(usize),
    Rotation(Vec3),
}

struct Hierarchy {
    joints: Vec<Joint>,
    /// Ends of limbs: the joint that each belongs to, and its offset from that joint.
    ends: Vec<(u32, Vec3)>,
    /// Channels of each joint, in the file's order.
    channels: Vec<Vec<Channel>>,
}

/// A motion as the file has it.
struct Read {
    motion: Motion,
    /// Ends of limbs, each as a joint and an offset from it.
    ends: Vec<(u32, Vec3)>,
    /// What is wrong with the file's frames.
    notes: Vec<String>,
}

/// Frame times that are read [s]. Outside that range a clip's times are no longer exact.
const FRAME_TIMES: std::ops::RangeInclusive<f64> = 1e-6..=100.0;
/// Rates that captures have [Hz]. Others are reported.
const USUAL_RATES: std::ops::RangeInclusive<f64> = 5.0..=500.0;

/// Reads a `.bvh` file, in its own units.
///
/// Rotations are applied in the order in which the file lists them: the first listed is the outermost.
///
/// # Errors
/// Returns an error if the hierarchy is not closed, if the line of a frame has too few or too many numbers, or if the
/// frame time is not above 0.
pub fn parse(data: &[u8]) -> Result<Motion, Problem> {
    read(data, None).map(|read| read.motion)
}

/// Reads a file. `rate` replaces its frame rate [Hz].
fn read(data: &[u8], rate: Option<f64>) -> Result<Read, Problem> {
    let text = without_comments(as_text(data));
    let mut words = Words::new(&text);
    let Hierarchy { joints, ends, channels } = hierarchy(&mut words)?;
    let mut notes = Vec::new();
    let named: usize = labeled(&mut words, "Frames", "the number of frames")?;
    let line = words.line();
    words.expect("Frame")?;
    let frame_time: f64 = labeled(&mut words, "Time", "the time of a frame")?;
    if rate.is_none() && !FRAME_TIMES.contains(&frame_time) {
        return Err(Problem::line(
            words.line(),
            format!(
                "a frame time of {frame_time} s is not between 0.000001 and 100; correct it, or set `rate` in [clip]"
            ),
        ));
    }
    let width: usize = channels.iter().map(Vec::len).sum();
    let lines = words.lines_left();
    if let Some(problem) = uneven_line(&lines, named, width) {
        return Err(problem);
    }
    let left: usize = lines.iter().map(|(_, words)| words).sum();
    // The skeleton of a file without channels stands still for as long as its size allows.
    let held = left.checked_div(width).unwrap_or(named.min(text.len()));
    // The lines are counted if the header names no frames.
    let frames = if named == 0 { held } else { named.min(held) };
    if frames == 0 {
        return Err(Problem::line(line, "the file holds no frames; export the motion again"));
    }
    notes.extend(miscounted(named, held, left - held * width));
    check_samples(frames, joints.len(), Place::Line(line))?;
    let mut samples = Vec::with_capacity(frames * joints.len());
    for frame in 0..frames {
        for (joint, channels) in joints.iter().zip(&channels) {
            samples.push(local(joint, channels, || words.finite(&format!("a number of frame {frame}")))?);
        }
    }
    // Frame times are rounded to about six digits and stand for a standard rate.
    let hertz = rate.unwrap_or(1.0 / frame_time);
    let rate_used = FrameRate::nearest(hertz).map_or(hertz, FrameRate::hertz);
    if rate.is_none() && !USUAL_RATES.contains(&hertz) {
        notes.push(format!(
            "a frame takes {frame_time} s ({hertz:.3} Hz), which is unusual; if that is wrong, set the rate in [clip], such as `rate = {:?}`",
            likely_rate(frame_time)
        ));
    }
    let clip = Clip { name: String::new(), rate: rate_used, joint_count: joints.len(), samples };
    Ok(Read { motion: Motion { joints, clip }, ends, notes })
}

/// Returns the problem of a line that has another number of words than the skeleton has channels (`width`), if each frame
/// has a line of its own. Some files wrap a frame over several lines. `lines` are those of the frames, each with its number
/// of words, and `named` is the number of frames in the header.
fn uneven_line(lines: &[(usize, usize)], named: usize, width: usize) -> Option<Problem> {
    let (_, first) = *lines.first()?;
    if width == 0 {
        return None;
    }
    let words: usize = lines.iter().map(|(_, words)| words).sum();
    let same = lines.len() > 1 && lines.iter().all(|(_, words)| *words == first);
    let divides = width.is_multiple_of(first) || first.is_multiple_of(width);
    let fitting = lines.iter().filter(|(_, words)| *words == width).count();
    let wraps = words == named.saturating_mul(width) || (2 * fitting <= lines.len() && (divides || !same));
    if lines.len() != named && wraps {
        return None;
    }
    let used = if named == 0 { lines } else { &lines[..named.min(lines.len())] };
    // A shorter last line is that of a file that is cut short.
    let cut = |k: usize, words: usize| k > 0 && k + 1 == lines.len() && words < width;
    let uneven = used.iter().enumerate().find(|(k, (_, words))| *words != width && !cut(*k, *words));
    uneven.map(|(_, (line, words))| {
        let text = format!(
            "a frame has {words} numbers here, and the skeleton has {width} channels; export the motion again"
        );
        Problem::line(*line, text)
    })
}

/// Describes a header that names another number of frames than the file holds, and what follows the last frame.
fn miscounted(named: usize, held: usize, rest: usize) -> Option<String> {
    let cut = match rest {
        0 => String::new(),
        _ => format!(" and {rest} numbers of another one, which are not used"),
    };
    if named == 0 {
        Some(format!(
            "the header names 0 frames; {held} were counted in the file{cut} and are used; correct `Frames:` in the file"
        ))
    } else if named > held {
        Some(format!(
            "the header names {named} frames, but the file holds {held}{cut}; these are used; if the file is cut short, export the motion again, otherwise correct `Frames:` in the file"
        ))
    } else if named < held {
        Some(format!(
            "the file holds {held} frames, but its header names {named}; only these are used; correct `Frames:` in the file to use the rest"
        ))
    } else {
        (rest > 0).then(|| {
            format!("{rest} words follow the last frame and are not used; remove them from the file")
        })
    }
}

/// Returns a text with its lines of comments (`#`) empty.
fn without_comments(text: Cow<'_, str>) -> Cow<'_, str> {
    let is_comment = |line: &str| line.trim_start().starts_with('#');
    if !lines(&text).any(is_comment) {
        return text;
    }
    let kept = lines(&text).map(|line| if is_comment(line) { "" } else { line });
    Cow::Owned(kept.flat_map(|line| [line, "\n"]).collect())
}

/// Reads a label, a colon and a number, with or without spaces between them.
fn labeled<T: FromStr>(words: &mut Words<'_>, label: &str, what: &str) -> Result<T, Problem> {
    let word = words.word();
    let missing = |words: &Words<'_>, found| Err(words.missing(&format!("`{label}:`"), found));
    let head = word.and_then(|word| word.get(..label.len()));
    let (Some(word), true) = (word, head.is_some_and(|head| head.eq_ignore_ascii_case(label))) else {
        return missing(&*words, word);
    };
    let mut rest = &word[label.len()..];
    if rest.is_empty() {
        rest = words.word().unwrap_or("");
    }
    let Some(number) = rest.strip_prefix(':') else { return missing(&*words, Some(word)) };
    if number.is_empty() {
        return words.number(what);
    }
    number.parse().map_err(|_| words.missing(what, Some(number)))
}

/// Returns the rate that an unusual frame time probably stands for [Hz]: it may be the rate itself, or in
/// milliseconds.
fn likely_rate(frame_time: f64) -> f64 {
    const RATES: [f64; 11] = [24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 90.0, 100.0, 120.0, 200.0, 240.0];
    let near = |hertz: f64| RATES.into_iter().find(|rate| (hertz / rate - 1.0).abs() < 0.01);
    near(frame_time).or_else(|| near(1000.0 / frame_time)).unwrap_or(30.0)
}

/// Units that captures use [m]: meters, centimeters, CMU's (1/0.45 inch), inches, decimeters, millimeters.
const UNITS: [(f32, &str); 6] = [
    (1.0, "meters"),
    (0.01, "centimeters"),
    (0.0254 / 0.45, "CMU units of 1/0.45 inch"),
    (0.0254, "inches"),
    (0.1, "decimeters"),
    (0.001, "millimeters"),
];

/// Height of a person's skeleton, from a small child to a tall adult [m]. It ends at the crown or 10 cm below it, and at
/// the ankle or the toe.
const PERSON: std::ops::RangeInclusive<f32> = 0.7..=2.4;
/// The same of an adult, for units that are rarer than meters, centimeters and millimeters [m].
const ADULT: std::ops::RangeInclusive<f32> = 1.35..=1.95;
/// Usual height of a person's skeleton [m], which the guess comes nearest to.
const TYPICAL: f32 = 1.6;

/// Fewest joints of a person's skeleton: hips, spine, neck, head, and two of each leg. Less is a part of one, such as a
/// head, unless it has a leg.
const PERSON_JOINTS: usize = 8;
/// Parts of the names of joints of legs, in lower case.
const LEG: [&str; 8] = ["leg", "foot", "knee", "ankle", "thigh", "shin", "calf", "toe"];
/// Height of a part of a person, such as a neck with a head or a bust [m].
const PART: std::ops::RangeInclusive<f32> = 0.05..=2.4;

/// Reads a `.bvh` file and converts it to meters and Y up. The unit and the up axis are guessed from the height of the
/// person, or the part of one, in the frames; the notes say what was guessed. `rate` replaces the file's frame rate
/// [Hz].
pub(crate) fn read_in_meters(
    data: &[u8],
    options: &ReadOptions,
    rate: Option<f64>,
) -> Result<(Motion, f32, Vec<String>), Problem> {
    let Read { mut motion, ends, mut notes } = read(data, rate)?;
    let size = median_size(&motion, &ends);
    let up = options.up.unwrap_or(if size.z > size.y { Axis::Z } else { Axis::Y });
    if options.up.is_none() && up == Axis::Z {
        notes.push("read as Z up, since the person is tallest along Z; set `up` to change it".into());
    }
    let height = if up == Axis::Z { size.z } else { size.y };
    let scale = options.scale.unwrap_or_else(|| {
        let whole = is_person(&motion.joints);
        let (plausible, what) = if whole { (PERSON, "person is then") } else { (PART, "skeleton is then") };
        let is_metric = |meters: f32| [1.0, 0.01, 0.001].contains(&meters);
        let fits = |meters: f32| {
            let range = if whole && !is_metric(meters) { &ADULT } else { &plausible };
            range.contains(&(height * meters))
        };
        let mut units = UNITS.iter().filter(|(meters, _)| fits(*meters));
        let off = |meters: f32| (height * meters / TYPICAL).ln().abs();
        // A part of a person has no usual height.
        let unit = if whole { units.min_by(|a, b| off(a.0).total_cmp(&off(b.0))) } else { units.next() };
        let (scale, name) = match unit {
            Some((meters, name)) => (*meters, (*name).to_owned()),
            None if whole && height > 0.0 => {
                (TYPICAL / height, format!("units of {:.5} m", TYPICAL / height))
            }
            None => (1.0, "meters".into()),
        };
        notes.push(format!(
            "a .bvh file has no unit; guessed {name} (the {what} {:.2} m tall); set `scale` to change it",
            height * scale
        ));
        scale
    });
    let turn = turn_of(up);
    apply_to_motion(&mut motion.joints, std::slice::from_mut(&mut motion.clip), scale, turn);
    Ok((motion, scale, notes))
}

/// Whether the joints are those of a person, or of a part of one.
fn is_person(joints: &[Joint]) -> bool {
    let is_leg = |joint: &Joint| LEG.iter().any(|leg| joint.name.to_ascii_lowercase().contains(leg));
    joints.len() >= PERSON_JOINTS || joints.iter().any(is_leg)
}

/// Size of the box around the joints and ends along each axis, as the median over some frames [file units].
fn median_size(motion: &Motion, ends: &[(u32, Vec3)]) -> Vec3 {
    let body = Body { joints: motion.joints.clone(), ..Body::default() };
    let clip = &motion.clip;
    let step = clip.frame_count().div_ceil(64).max(1);
    let sizes: Vec<Vec3> = (0..clip.frame_count())
        .step_by(step)
        .map(|f| {
            let world = body.world(&clip.samples[f * clip.joint_count..][..clip.joint_count]);
            let joints = world.iter().map(|w| Vec3::from(w.translation));
            let ends = ends.iter().map(|(j, offset)| world[*j as usize].transform_point3(*offset));
            let (lo, hi) = joints
                .chain(ends)
                .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
            hi - lo
        })
        .collect();
    let median = |axis: usize| {
        let mut along: Vec<f32> = sizes.iter().map(|s| s[axis]).filter(|x| x.is_finite()).collect();
        along.sort_by(f32::total_cmp);
        along.get(along.len() / 2).copied().unwrap_or(0.0)
    };
    Vec3::new(median(0), median(1), median(2))
}

/// A joint's local transform from its channels. A position channel replaces the offset's coordinate.
fn local(
    joint: &Joint,
    channels: &[Channel],
    mut number: impl FnMut() -> Result<f32, Problem>,
) -> Result<Trs, Problem> {
    let mut trs = joint.rest;
    for channel in channels {
        let value = number()?;
        match channel {
            Channel::Position(axis) => trs.translation[*axis] = value,
            Channel::Rotation(axis) => trs.rotation *= Quat::from_axis_angle(*axis, value.to_radians()),
        }
    }
    trs.rotation = if trs.rotation.is_finite() { trs.rotation.normalize() } else { Quat::IDENTITY };
    Ok(trs)
}

fn hierarchy(words: &mut Words<'_>) -> Result<Hierarchy, Problem> {
    let mut read = Hierarchy { joints: Vec::new(), ends: Vec::new(), channels: Vec::new() };
    // Joints whose braces are still open; `None` for an end site.
    let mut open: Vec<Option<u32>> = Vec::new();
    words.expect("HIERARCHY")?;
    loop {
        let word = words.word();
        match word.map(str::to_ascii_uppercase).as_deref() {
            Some(kind @ ("ROOT" | "JOINT")) => {
                if (kind == "ROOT") != open.is_empty() || open.last().is_some_and(Option::is_none) {
                    return Err(Problem::line(words.line(), format!("{kind} is not allowed here")));
                }
                let name = opened(words)?;
                if read.joints.len() > u16::MAX as usize {
                    return Err(Problem::limit(Place::Line(words.line()), "more than 65,536 joints"));
                }
                let parent = open.last().copied().flatten();
                open.push(Some(read.joints.len() as u32));
                read.joints.push(Joint { name, parent, rest: Trs::default() });
                read.channels.push(Vec::new());
            }
            Some("END") => {
                opened(words)?;
                open.push(None);
            }
            Some("OFFSET") => {
                let offset = words.vector("an offset")?;
                match open.last() {
                    Some(Some(j)) => read.joints[*j as usize].rest.translation = offset,
                    Some(None) => {
                        let parent = open.iter().rev().find_map(|j| *j);
                        read.ends.extend(parent.map(|j| (j, offset)));
                    }
                    None => return Err(words.missing("a joint", word)),
                }
            }
            Some("CHANNELS") => {
                let Some(Some(j)) = open.last() else {
                    return Err(words.missing("a joint", word));
                };
                let count: usize = words.number("the number of channels")?;
                for _ in 0..count {
                    let name = words.word();
                    let channel =
                        name.and_then(channel).ok_or_else(|| words.missing("a channel's name", name))?;
                    read.channels[*j as usize].push(channel);
                }
            }
            Some("}") => {
                open.pop().ok_or_else(|| Problem::line(words.line(), "unmatched closing brace"))?;
            }
            Some("MOTION") if open.is_empty() && !read.joints.is_empty() => return Ok(read),
            Some(_) => {
                let word = shortened(word.unwrap_or_default());
                let open = open.len();
                return Err(Problem::line(
                    words.line(),
                    format!("`{word}` is not allowed here ({open} braces are open)"),
                ));
            }
            None => return Err(words.missing("MOTION", None)),
        }
    }
}

/// Reads the rest of a line up to the brace that opens a joint. The brace may be on the next line.
fn opened(words: &mut Words<'_>) -> Result<String, Problem> {
    let mut rest = words.rest_of_line();
    if rest.last() == Some(&"{") {
        rest.pop();
    } else {
        words.expect("{")?;
    }
    Ok(rest.join(" "))
}

fn channel(name: &str) -> Option<Channel> {
    Some(match name.to_ascii_lowercase().as_str() {
        "xposition" => Channel::Position(0),
        "yposition" => Channel::Position(1),
        "zposition" => Channel::Position(2),
        "xrotation" => Channel::Rotation(Vec3::X),
        "yrotation" => Channel::Rotation(Vec3::Y),
        "zrotation" => Channel::Rotation(Vec3::Z),
        _ => return None,
    })
}
