//! Conversion from a file's units and axes to meters and Y up.

use crate::strays::Strays;
use glam::{Affine3A, Quat, Vec3};
use hairspring::{
    body::{Body, Clip, Joint, Mesh, Trs},
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

/// Plausible sizes of the longest side of the box around a bust or a whole figure [m].
const BODY: std::ops::RangeInclusive<f32> = 0.14..=2.5;
/// Typical sizes of a body, which a guess tries to match [m]: a bust, an adult.
const TYPICAL_BODIES: [f32; 2] = [0.5, 1.7];
/// Shortest side of the box around a head or a bust, at least, over the longest [1]. A standing adult is flatter.
const COMPACT: f32 = 0.4;

/// Plausible sizes of the longest side of the box around a head of hair [m].
const HAIR: std::ops::RangeInclusive<f32> = 0.1..=1.5;
/// Sizes of the box that a groom may have at most: brows or lashes, and the fur of a large animal [m].
const GROOM: std::ops::RangeInclusive<f32> = 0.02..=3.0;
/// Lengths that the median strand of a groom may have at most [m].
const STRAND: std::ops::RangeInclusive<f32> = 0.002..=2.0;

/// Common units of files.
const UNITS: [(f32, &str); 4] =
    [(1.0, "meters"), (0.1, "decimeters"), (0.01, "centimeters"), (0.001, "millimeters")];

/// A body that a mesh belongs to, such as that of the eyes or a collision mesh. The mesh probably has the same unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WholeBody {
    /// Meters in one unit of the body's file [m].
    pub scale: f32,
    /// The box around the body [m].
    pub bounds: [Vec3; 2],
}

/// Distance of a mesh from the body that it belongs to, at most, over the longest side of the body [1].
const REACH: f32 = 0.25;
/// Longest side of a mesh below which it may rather have a larger unit, over that of the body [1].
const SMALL: f32 = 0.05;

impl WholeBody {
    /// Whether a mesh has the unit of the body. `bounds` is the box around it [file units, Y up], `place` is its
    /// placement in the scene, and `own` is the unit that its size alone suggests [m].
    fn shares_unit(&self, bounds: [Vec3; 2], place: Affine3A, own: f32) -> bool {
        let [lo, hi] = self.bounds;
        let size = (hi - lo).max_element();
        let placed = |scale: f32| {
            let corner = |k: usize| Vec3::from([0, 1, 2].map(|axis| bounds[(k >> axis) & 1][axis]));
            self::bounds((0..8).map(|k| place.transform_point3(corner(k) * scale)))
        };
        let within_reach = |scale: f32| {
            let (low, high) = placed(scale);
            let reach = Vec3::splat(REACH * size);
            low.cmple(hi + reach).all() && high.cmpge(lo - reach).all()
        };
        let (low, high) = placed(self.scale);
        within_reach(self.scale) && ((high - low).max_element() > SMALL * size || !within_reach(own))
    }
}

/// What a scene tells about the unit of a mesh, if its file does not.
#[derive(Clone, Copy)]
pub(crate) enum UnitHint<'a> {
    None,
    /// The body that the mesh belongs to, and the placement of the mesh.
    PartOf(WholeBody, Affine3A),
    /// The grooms that grow on the mesh decide.
    Grown(&'a ChooseUnit<'a>),
}

/// Chooses among units [m] by the grooms of a scene. The second argument returns the mesh that they grow on in a unit.
pub(crate) type ChooseUnit<'a> = dyn Fn(&[f32], &dyn Fn(f32) -> Mesh) -> Option<f32> + 'a;

/// Returns the scale and rotation to apply to a mesh, and adds a note about whatever was guessed.
pub(crate) fn settle(
    options: &ReadOptions,
    file: FileUnits,
    mesh: &Mesh,
    hint: UnitHint<'_>,
    notes: &mut Vec<String>,
) -> (f32, Quat) {
    let turn = turn_of(options.up.or(file.up).unwrap_or(Axis::Y));
    let scale = options.scale.or(file.scale).unwrap_or_else(|| {
        let points = mesh.positions.iter();
        let (lo, hi) = bounds(points.filter(|p| p.is_finite()).map(|p| turned(turn, *p)));
        let extent = (hi - lo).max_element();
        let (own, note) = guess_body(hi - lo);
        match hint {
            UnitHint::PartOf(body, place) if body.shares_unit([lo, hi], place, own) => {
                let (unit, size) = (unit_name(body.scale), extent * body.scale);
                notes.push(format!(
                    "the file has no unit; read in that of the body, {unit} (its longest side is then {size:.3} m); set `scale` to change it"
                ));
                return body.scale;
            }
            // Meters are hardly ever another unit.
            UnitHint::Grown(choose) if own != 1.0 => {
                let fits = |scale: &f32| *scale != own && BODY.contains(&(extent * scale));
                let others = UNITS.into_iter().map(|(scale, _)| scale).filter(fits);
                let units: Vec<f32> = std::iter::once(own).chain(others).collect();
                let of_unit = |scale: f32| {
                    let positions = mesh.positions.iter().map(|p| turned(turn, *p) * scale).collect();
                    Mesh { positions, triangles: mesh.triangles.clone(), ..Mesh::default() }
                };
                let grown = (units.len() > 1).then(|| choose(&units, &of_unit)).flatten();
                if let Some(unit) = grown.filter(|unit| *unit != own) {
                    notes.push(format!(
                        "the file has no unit; guessed {}, which puts the roots of the hair on its skin (its longest side is then {:.3} m); set `scale` to change it",
                        unit_name(unit),
                        extent * unit
                    ));
                    return unit;
                }
            }
            _ => {}
        }
        notes.extend(note);
        own
    });
    (scale, turn)
}

/// Chooses a groom's unit by the body that it grows on. Given the two ends of some strands, Y up, in the
/// file's units, and the units to try, the first of which is preferred, it returns the unit that puts the
/// strands on the skin; `None` if none does.
pub(crate) type FitUnit<'a> = &'a dyn Fn(&[[Vec3; 2]], &[f32]) -> Option<f32>;

/// Returns the scale and rotation to apply to a groom, and adds a note about whatever was guessed.
pub(crate) fn settle_groom(
    options: &ReadOptions,
    file: FileUnits,
    groom: &Groom,
    fit: Option<FitUnit<'_>>,
    notes: &mut Vec<String>,
) -> (f32, Quat) {
    let turn = turn_of(options.up.or(file.up).unwrap_or(Axis::Y));
    let scale = options.scale.or(file.scale).unwrap_or_else(|| {
        let (scale, note) = guess_groom(groom, turn, fit);
        notes.extend(note);
        scale
    });
    (scale, turn)
}

/// The rotation that maps `up` to +Y.
pub(crate) fn turn_of(up: Axis) -> Quat {
    match up {
        Axis::Y => Quat::IDENTITY,
        Axis::Z => Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2),
    }
}

/// Guesses the meters per unit of a body whose box has these sides [file units], and returns a note about it. The unit is
/// meters if that is plausible, otherwise the unit that gives a plausible size, and of those the one nearest to a typical
/// size. Few tools use decimeters: in centimeters, a head may have the size of an adult in decimeters, but not its shape.
fn guess_body(sides: Vec3) -> (f32, Option<String>) {
    let extent = sides.max_element();
    if !(extent.is_finite() && extent > 0.0) {
        return (1.0, None);
    }
    if BODY.contains(&extent) {
        return (1.0, Some(note(1.0, extent, true)));
    }
    let is_head = sides.min_element() >= COMPACT * extent && BODY.contains(&(extent * 0.01));
    let off = |scale: f32| {
        let off =
            TYPICAL_BODIES.iter().map(|t| (extent * scale / t).ln().abs()).fold(f32::INFINITY, f32::min);
        // A plausible size comes first.
        let plausible = BODY.contains(&(extent * scale)) && !(scale == 0.1 && is_head);
        if plausible { off } else { off + 100.0 }
    };
    let scale = nearest(off);
    (scale, Some(note(scale, extent * scale, BODY.contains(&(extent * scale)))))
}

/// Guesses the meters per unit of a groom, and returns a note about it: the unit that puts its strands on the
/// body, otherwise the one that gives plausible sizes.
fn guess_groom(groom: &Groom, turn: Quat, fit: Option<FitUnit<'_>>) -> (f32, Option<String>) {
    let strays = Strays::of(groom);
    let extent = strays.extent;
    let length = median_length(groom);
    if !(extent.is_finite() && extent > 0.0) {
        return (1.0, None);
    }
    let by_size = by_size(extent, length);
    let step = groom.strand_count().div_ceil(500).max(1);
    let ends: Vec<[Vec3; 2]> = (0..groom.strand_count())
        .step_by(step)
        .filter_map(|s| Some([*groom.strand(s).first()?, *groom.strand(s).last()?]))
        .filter(|ends| ends.iter().all(|p| p.is_finite() && *p != Vec3::ZERO))
        .map(|ends| ends.map(|p| turned(turn, p)))
        .collect();
    let fits = |scale: &f32| GROOM.contains(&(extent * scale)) && STRAND.contains(&(length * scale));
    let units = UNITS.iter().map(|(scale, _)| *scale).chain([0.0254]);
    let units: Vec<f32> = std::iter::once(by_size).chain(units).filter(fits).collect();
    let of_body = fit.and_then(|fit| fit(&ends, &units));
    let scale = of_body.unwrap_or(by_size);
    let size = extent * scale;
    let mut text = match of_body {
        Some(_) => format!(
            "the file has no unit; guessed {}, which puts its roots on the skin of the body; set `scale` to change it",
            unit_name(scale)
        ),
        None => note(scale, size, GROOM.contains(&size)),
    };
    text.extend(strays.note());
    (scale, Some(text))
}

/// The usual unit that gives a groom of this size and median strand length [file units] plausible sizes.
fn by_size(extent: f32, length: f32) -> f32 {
    if HAIR.contains(&extent) {
        return 1.0;
    }
    // A head of hair of shoulder length; or strands (brows, beard, fur) that are short compared with what they
    // grow on, from a brow to a large animal. Distances are in powers of e. Few tools use decimeters.
    let off = |scale: f32| {
        let (extent, length) = (extent * scale, length.max(f32::MIN_POSITIVE) * scale);
        let beyond = |value: f32, low: f32, high: f32| (low / value).max(value / high).ln().max(0.0);
        let head = (extent / 0.35).ln().abs() + (length / 0.25).ln().abs();
        let short =
            (length / 0.01).ln().abs() + beyond(extent, 0.05, 2.0) + beyond(length / extent, 0.0, 0.1);
        head.min(short) + if scale == 0.1 { 0.5 } else { 0.0 }
    };
    nearest(off)
}

/// The usual unit with the smallest distance.
fn nearest(off: impl Fn(f32) -> f32) -> f32 {
    UNITS.into_iter().map(|(scale, _)| scale).min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(1.0)
}

fn unit_name(scale: f32) -> String {
    let known = UNITS.iter().find(|(s, _)| *s == scale).map(|(_, name)| (*name).to_owned());
    known.unwrap_or_else(|| if scale == 0.0254 { "inches".into() } else { format!("units of {scale} m") })
}

/// A note about a guess from the size of an object [m].
fn note(scale: f32, size: f32, plausible: bool) -> String {
    let name = unit_name(scale);
    match (plausible, scale == 1.0) {
        (true, true) => format!(
            "the file has no unit; read as meters (its longest side is {size:.3} m); set `scale` to change it"
        ),
        (true, false) => format!(
            "the file has no unit; guessed {name} (its longest side is then {size:.3} m); set `scale` to change it"
        ),
        _ => format!(
            "the file has no unit, and no usual one fits; read as {name} (its longest side is then {size:.3} m); set `scale`"
        ),
    }
}

/// The median length of the strands that have one [file units]; 0 if there are none.
fn median_length(groom: &Groom) -> f32 {
    let mut lengths: Vec<f32> = (0..groom.strand_count())
        .map(|s| groom.strand_length(s))
        .filter(|l| l.is_finite() && *l > 0.0)
        .collect();
    lengths.sort_by(f32::total_cmp);
    lengths.get(lengths.len() / 2).copied().unwrap_or(0.0)
}

/// The longest side of the box around the finite points in `points`; 0 if there are none.
pub(crate) fn extent(points: impl IntoIterator<Item = Vec3>) -> f32 {
    let (lo, hi) = bounds(points.into_iter().filter(|p| p.is_finite()));
    (hi - lo).max_element().max(0.0)
}

/// The box around the finite points in `points`; `None` if there are none.
pub(crate) fn bounds_of(points: &[Vec3]) -> Option<[Vec3; 2]> {
    let (lo, hi) = bounds(points.iter().copied().filter(|p| p.is_finite()));
    lo.is_finite().then_some([lo, hi])
}

/// The box around points; inverted if there are none.
pub(crate) fn bounds(points: impl Iterator<Item = Vec3>) -> (Vec3, Vec3) {
    points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)))
}

/// Rotates `p` by `turn`, without rounding if that turns Z or Y up.
fn turned(turn: Quat, p: Vec3) -> Vec3 {
    match turn {
        _ if turn == Quat::IDENTITY => p,
        _ if turn == turn_of(Axis::Z) => Vec3::new(p.x, p.z, -p.y),
        _ => turn * p,
    }
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
