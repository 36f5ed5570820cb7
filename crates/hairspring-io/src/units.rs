//! Conversion from a file's units and axes to meters and Y up.

use glam::{Quat, Vec3};
use hairspring::{
    body::{Body, Clip, Joint, Trs},
    groom::Groom,
};
use serde::{Deserialize, Serialize};

/// The axis that points up in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// Y up, as used internally: nothing is rotated.
    Y,
    /// Z up: +Z becomes +Y and +Y becomes −Z.
    Z,
}

/// What the caller knows about a file's units. Fields that are `None` are taken from the format, or guessed
/// with a note.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Meters in one unit of the file [m], above 0.
    pub scale: Option<f32>,
    /// The axis that points up.
    pub up: Option<Axis>,
}

/// What a file or its format specifies about its units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FileUnits {
    /// Meters in one unit; `None` if not specified.
    pub scale: Option<f32>,
    /// The axis that points up, by the file or by the convention of the format.
    pub up: Option<Axis>,
}

/// The kind of object, which determines the plausible sizes.
#[derive(Clone, Copy)]
pub(crate) enum Subject {
    /// A hairstyle: its box is 0.1 to 1.5 m.
    Hair,
    /// A bust or a whole figure: its box is 0.15 to 2.5 m.
    Body,
}

impl Subject {
    /// Plausible sizes of the box's longest side [m].
    fn range(self) -> std::ops::RangeInclusive<f32> {
        match self {
            Self::Hair => 0.1..=1.5,
            Self::Body => 0.15..=2.5,
        }
    }

    /// Typical sizes, which a guess tries to match [m]: shoulder-length hair; a bust or an adult.
    fn typical(self) -> &'static [f32] {
        match self {
            Self::Hair => &[0.35],
            Self::Body => &[0.5, 1.7],
        }
    }
}

/// Common units of files.
const UNITS: [(f32, &str); 4] =
    [(1.0, "meters"), (0.1, "decimeters"), (0.01, "centimeters"), (0.001, "millimeters")];

/// Returns the scale and rotation to apply, and adds a note about whatever was guessed. `extent` is the box's
/// longest side [file units].
pub(crate) fn settle(
    options: &ReadOptions,
    file: FileUnits,
    subject: Subject,
    extent: f32,
    notes: &mut Vec<String>,
) -> (f32, Quat) {
    let scale = options.scale.or(file.scale).unwrap_or_else(|| {
        let (scale, note) = guess(subject, extent);
        notes.extend(note);
        scale
    });
    (scale, turn_of(options.up.or(file.up).unwrap_or(Axis::Y)))
}

/// The rotation that maps `up` to +Y.
pub(crate) fn turn_of(up: Axis) -> Quat {
    match up {
        Axis::Y => Quat::IDENTITY,
        Axis::Z => Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2),
    }
}

/// Guesses the meters per unit of an object whose box has a longest side of `extent` units, and returns a
/// note about it. The unit is meters if that is plausible, otherwise the unit that gives the size nearest to
/// a typical one.
fn guess(subject: Subject, extent: f32) -> (f32, Option<String>) {
    if !(extent.is_finite() && extent > 0.0) {
        return (1.0, None);
    }
    if subject.range().contains(&extent) {
        let note = format!(
            "the file has no unit; read as meters (its longest side is {extent:.3} m); set `scale` to change it"
        );
        return (1.0, Some(note));
    }
    let off = |scale: f32| {
        let typical = subject.typical().iter();
        typical.map(|t| (extent * scale / t).ln().abs()).fold(f32::INFINITY, f32::min)
    };
    let nearest = UNITS.into_iter().min_by(|a, b| off(a.0).total_cmp(&off(b.0)));
    let (scale, name) = nearest.unwrap_or(UNITS[0]);
    let size = extent * scale;
    let note = if subject.range().contains(&size) {
        format!(
            "the file has no unit; guessed {name} (its longest side is then {size:.3} m); set `scale` to change it"
        )
    } else {
        format!(
            "the file has no unit, and no usual one fits; read as {name} (its longest side is then {size:.3} m); set `scale`"
        )
    };
    (scale, Some(note))
}

/// The longest side of the box around the finite points in `points`; 0 if there are none.
pub(crate) fn extent(points: impl IntoIterator<Item = Vec3>) -> f32 {
    let mut finite = points.into_iter().filter(|p| p.is_finite());
    let Some(first) = finite.next() else {
        return 0.0;
    };
    let (lo, hi) = finite.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)));
    (hi - lo).max_element()
}

/// Rotates `p` by `turn`: exactly if `turn` is the identity, and without rounding for ±90° about X.
fn turned(turn: Quat, p: Vec3) -> Vec3 {
    if turn == Quat::IDENTITY { p } else { Vec3::new(p.x, p.z, -p.y) }
}

/// Converts a groom to meters and Y up.
pub(crate) fn apply_to_groom(groom: &mut Groom, scale: f32, turn: Quat) {
    groom.points.iter_mut().for_each(|p| *p = turned(turn, *p) * scale);
}

/// Converts the local transforms of joints to meters and Y up; shape `[joints]`.
pub(crate) fn apply_to_locals<'a>(
    locals: impl IntoIterator<Item = (&'a mut Trs, bool)>,
    scale: f32,
    turn: Quat,
) {
    for (local, is_root) in locals {
        local.translation *= scale;
        if is_root && turn != Quat::IDENTITY {
            local.translation = turned(turn, local.translation);
            local.rotation = turn * local.rotation;
        }
    }
}

/// Converts a motion's joints and clips to meters and Y up.
pub(crate) fn apply_to_motion(joints: &mut [Joint], clips: &mut [Clip], scale: f32, turn: Quat) {
    let roots: Vec<bool> = joints.iter().map(|j| j.parent.is_none()).collect();
    apply_to_locals(joints.iter_mut().map(|j| (&mut j.rest, j.parent.is_none())), scale, turn);
    for clip in clips {
        let flags = roots.iter().copied().cycle();
        apply_to_locals(clip.samples.iter_mut().zip(flags), scale, turn);
    }
}

/// Converts a body and its clips to meters and Y up.
pub(crate) fn apply_to_body(body: &mut Body, clips: &mut [Clip], scale: f32, turn: Quat) {
    for p in &mut body.mesh.positions {
        *p = turned(turn, *p) * scale;
    }
    for n in &mut body.mesh.normals {
        *n = turned(turn, *n);
    }
    if let Some(skin) = &mut body.skin {
        // B' = S B (R S)⁻¹: the joint's space is scaled, not rotated.
        let back =
            glam::Affine3A::from_scale_rotation_translation(Vec3::splat(scale), turn, Vec3::ZERO).inverse();
        let scaled = glam::Affine3A::from_scale(Vec3::splat(scale));
        skin.inverse_bind.iter_mut().for_each(|b| *b = scaled * *b * back);
    }
    apply_to_motion(&mut body.joints, clips, scale, turn);
}
