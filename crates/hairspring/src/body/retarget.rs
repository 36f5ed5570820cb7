//! Retargeting of motion to another skeleton: a captured head onto a bust, or a clip onto a rig with the same
//! joint names.

mod usual_height;

use self::usual_height::{HEIGHT_SAMPLES, usual_height};
use super::{Body, Clip, Joint, Trs, cuts};
use crate::{math::RigidTransform, settings::Solver};
use glam::{Affine3A, Quat, Vec3};
use std::collections::BTreeMap;

/// How much of the head's translation [`head_motion`] keeps.
///
/// For an example, see [`head_motion`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Travel {
    /// All of it: the bust walks away with the capture.
    Keep,
    /// Only bobbing and swaying: the path, averaged over a second, is removed, so the bust stays in view. The
    /// default.
    #[default]
    InPlace,
    /// None: the head only rotates about the pivot.
    None,
}

/// Options of [`head_motion`].
///
/// For an example, see [`head_motion`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadMotion {
    /// Point that the bust rotates about [m]: its own head joint, at the top of the neck.
    pub pivot: Vec3,
    /// Scale of the bust relative to the captured person; 1 for life size. Scales translations.
    pub scale: f32,
    /// Frame of the clip in which the head is at rest.
    pub rest_frame: usize,
    /// How much of the translation is kept.
    pub travel: Travel,
    /// Direction that the bust faces, an angle about +Y measured from +Z [rad].
    pub facing: f32,
}

impl Default for HeadMotion {
    fn default() -> Self {
        Self { pivot: Vec3::ZERO, scale: 1.0, rest_frame: 0, travel: Travel::InPlace, facing: 0.0 }
    }
}

/// Returns the motion of joint `name` relative to its rest frame, as a clip of one joint that drives a rigid
/// body ([`Body::rigid`]). Returns `None` if there is no such joint or the clip has no frames. As in
/// [`retarget`], a prefix of the joint's name may be omitted.
///
/// The person's heading in the rest frame, computed from the joints named left and right, is rotated to that
/// of the bust. A nod therefore stays a nod whichever way the captured person faces.
///
/// ```
/// use hairspring::body::{Clip, HeadMotion, Joint, Trs, head_motion};
///
/// let joints = [Joint { name: "Head".into(), parent: None, rest: Trs::default() }];
/// let clip = Clip { name: "nod".into(), rate: 30.0, joint_count: 1, samples: vec![Trs::default(); 10] };
/// let head = head_motion(&joints, &clip, "Head", &HeadMotion::default()).unwrap();
/// assert_eq!((head.joint_count, head.frame_count()), (1, 10));
/// ```
pub fn head_motion(joints: &[Joint], clip: &Clip, name: &str, options: &HeadMotion) -> Option<Clip> {
    let skeleton = Body { joints: joints.to_vec(), ..Body::default() };
    let head = named(joints, name)?;
    let frames = clip.frame_count();
    let rest_frame = options.rest_frame.min(frames.checked_sub(1)?);
    let world = |f: usize| skeleton.world(&clip.samples[f * clip.joint_count..][..clip.joint_count]);
    let rest = world(rest_frame);
    let turn = Quat::from_rotation_y(options.facing - heading(joints, &rest));
    let (rest_rotation, rest_place) = split(&rest[head]);
    let (rotations, mut shifts): (Vec<Quat>, Vec<Vec3>) = (0..frames)
        .map(|f| {
            let (rotation, place) = split(&world(f)[head]);
            let turned = turn * (rotation * rest_rotation.inverse()) * turn.inverse();
            (turned.normalize(), turn * (place - rest_place) * options.scale)
        })
        .unzip();
    match options.travel {
        Travel::Keep => {}
        Travel::InPlace => {
            let pose = |(rotation, shift): (&Quat, &Vec3)| RigidTransform {
                rotation: *rotation,
                translation: *shift,
            };
            let path: Vec<RigidTransform> = rotations.iter().zip(&shifts).map(pose).collect();
            let cuts = cuts::find(&path, clip.rate, Solver::default().teleport_distance);
            stay(&mut shifts, clip.rate, rest_frame, &cuts);
        }
        Travel::None => shifts.fill(Vec3::ZERO),
    }
    let samples = rotations.into_iter().zip(shifts).map(|(rotation, shift)| Trs {
        translation: options.pivot - rotation * options.pivot + shift,
        rotation,
        scale: Vec3::ONE,
    });
    Some(Clip { name: clip.name.clone(), rate: clip.rate, joint_count: 1, samples: samples.collect() })
}

/// Subtracts the path, averaged over a second, from `shifts`, and makes the rest frame zero. No average
/// extends across one of the `cuts`.
fn stay(shifts: &mut [Vec3], rate: f64, rest_frame: usize, cuts: &[(usize, usize)]) {
    let half = (rate * 0.5).round() as usize;
    let mut sums = vec![glam::DVec3::ZERO];
    for s in shifts.iter() {
        sums.push(sums[sums.len() - 1] + s.as_dvec3());
    }
    let mut starts = vec![0];
    cuts.iter().for_each(|(before, after)| starts.extend(before + 1..=*after));
    starts.push(shifts.len());
    for shot in starts.windows(2) {
        for f in shot[0]..shot[1] {
            // The window is symmetric, so a steady walk still averages to its middle frame near the ends.
            let reach = half.min(f - shot[0]).min(shot[1] - 1 - f);
            let mean = (sums[f + reach + 1] - sums[f - reach]) / (2 * reach + 1) as f64;
            shifts[f] -= mean.as_vec3();
        }
    }
    let at_rest = shifts[rest_frame];
    shifts.iter_mut().for_each(|s| *s -= at_rest);
}

/// Returns the direction that a skeleton faces, an angle about +Y measured from +Z [rad]: perpendicular to
/// the mean of the right-to-left pairs of joints. Returns 0 if there are no such pairs.
fn heading(joints: &[Joint], world: &[Affine3A]) -> f32 {
    let mut left = Vec3::ZERO;
    let names = keys(joints);
    for (j, name) in names.iter().enumerate() {
        let Some(rest) = name.strip_prefix("left") else {
            continue;
        };
        let other = names.iter().position(|o| o.strip_prefix("right") == Some(rest));
        if let Some(o) = other {
            left += Vec3::from(world[j].translation - world[o].translation);
        }
    }
    // Left × up is forward.
    let forward = left.cross(Vec3::Y);
    if forward.length_squared() > 1e-12 { forward.x.atan2(forward.z) } else { 0.0 }
}

/// A clip retargeted to another rig.
///
/// For an example, see [`retarget`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Retargeted {
    /// Motion of the body's joints.
    pub clip: Clip,
    /// Number of joints of the body that the motion drives; the others keep their rest pose.
    pub matched: usize,
    /// Names of the motion's joints that the body does not have.
    pub unmatched: Vec<String>,
    /// Scale of the body's translation relative to the motion's.
    pub scale: f32,
    /// Whether both rigs have a joint near the floor, so that the motion also gives the body's height above
    /// it. Otherwise the body starts at its own place.
    pub on_floor: bool,
    /// Height of the first frame above most others [units of the motion], if it does not decide the height of the
    /// body: a rest pose at the origin, a jump or a crouch. `None` if the body is placed by the first frame.
    pub first_frame_height: Option<f32>,
}

/// Retargets a clip to the joints of `body` that have the same names. Case, punctuation, a prefix before a
/// colon or a bar, and a prefix that the joints of a rig share (`mixamorig_`, `Bip01_`) are ignored. Returns
/// `None` if no names agree or the clip has no frames.
///
/// Rotations are transferred in world space: a bone of the body points where the motion's bone points, even
/// if the rest poses differ (arms down or out). The spine up to the head keeps the curve of the body's rest
/// pose.
///
/// The topmost joint that moves through the world carries the body. If both rigs have a joint near the floor
/// (a foot), its translation is scaled by the ratio of the hip heights, and the feet are on the same floor.
/// Otherwise it starts at the body's own place, and its translation is scaled by the ratio of the lengths of
/// the bones that both rigs have.
///
/// The first frame gives the height of the floor, or of the body's own place. If few frames have its height and
/// most have another one, the height of these is used.
///
/// ```
/// use hairspring::body::{Body, Clip, Joint, Mesh, Trs, retarget};
///
/// // A motion whose joints the body does not have.
/// let joints = [Joint { name: "Tail".into(), parent: None, rest: Trs::default() }];
/// let clip = Clip { name: "wag".into(), rate: 30.0, joint_count: 1, samples: vec![Trs::default(); 10] };
/// assert!(retarget(&joints, &clip, &Body::rigid(Mesh::default())).is_none());
/// ```
pub fn retarget(joints: &[Joint], clip: &Clip, body: &Body) -> Option<Retargeted> {
    let source = Body { joints: joints.to_vec(), ..Body::default() };
    let map = matches(joints, &body.joints);
    let matched = map.iter().flatten().count();
    if matched == 0 || clip.frame_count() == 0 {
        return None;
    }
    let target_rest = body.world(&body.rest_pose());
    let source_rest = source.world(&source.rest_pose());
    let align = alignments(body, &map, &target_rest, &source_rest);
    let root = carrier(clip, body, &map, &target_rest)?;
    let source_root = map[root]?;
    let frame = |f: usize| source.world(&clip.samples[f * clip.joint_count..][..clip.joint_count]);
    let first = frame(0);
    let floors = hip_ratio(body, root, &map, &target_rest, &source_rest);
    let ratio = floors.unwrap_or_else(|| bone_ratio(body, &map, &target_rest, &source_rest));
    let (mut origin, mut place) =
        (Vec3::from(first[source_root].translation), Vec3::from(target_rest[root].translation));
    // The height of a frame: of its floor, or of the joint that carries the body.
    let height = |world: &[Affine3A]| match floors {
        Some(_) => lowest(map.iter().flatten().map(|s| &world[*s])),
        None => world[source_root].translation.y,
    };
    origin.y = height(&first);
    if floors.is_some() {
        place.y = lowest(driven(&map).map(|j| &target_rest[j]));
    }
    let step = clip.frame_count().div_ceil(HEIGHT_SAMPLES);
    let heights: Vec<f32> = (0..clip.frame_count()).step_by(step).map(|f| height(&frame(f))).collect();
    let usual = usual_height(&heights, &source_rest);
    let first_frame_height = usual.map(|usual| origin.y - usual);
    origin.y = usual.unwrap_or(origin.y);
    let rest_pose = body.rest_pose();
    let mut samples = Vec::with_capacity(clip.frame_count() * body.joints.len());
    for f in 0..clip.frame_count() {
        let posed = frame(f);
        let mut world: Vec<Affine3A> = Vec::with_capacity(body.joints.len());
        for (j, joint) in body.joints.iter().enumerate() {
            let parent = joint.parent.map_or(Affine3A::IDENTITY, |p| world[p as usize]);
            let mut local = rest_pose[j];
            if let Some(s) = map[j] {
                let (rest, now) = (split(&source_rest[s]).0, split(&posed[s]).0);
                let target = now * rest.inverse() * align[j] * split(&target_rest[j]).0;
                local.rotation = (split(&parent).0.inverse() * target).normalize();
            }
            if j == root {
                let at = place + (Vec3::from(posed[source_root].translation) - origin) * ratio;
                local.translation = parent.inverse().transform_point3(at);
            }
            world.push(parent * local.to_affine());
            samples.push(local);
        }
    }
    let used = |s: usize| map.contains(&Some(s));
    let unmatched = (0..joints.len()).filter(|s| !used(*s)).map(|s| joints[s].name.clone()).collect();
    let clip = Clip { name: clip.name.clone(), rate: clip.rate, joint_count: body.joints.len(), samples };
    let on_floor = floors.is_some();
    Some(Retargeted { clip, matched, unmatched, scale: ratio, on_floor, first_frame_height })
}

/// Joints of the body that the motion drives.
fn driven(map: &[Option<usize>]) -> impl Iterator<Item = usize> + '_ {
    (0..map.len()).filter(|j| map[*j].is_some())
}

/// Returns the joint of the body that carries it through the world: the first driven joint whose translation
/// relative to its parent changes during the motion, or the first driven joint if there is none. A rig may
/// have a root on the floor that never moves, above hips that do.
fn carrier(clip: &Clip, body: &Body, map: &[Option<usize>], target: &[Affine3A]) -> Option<usize> {
    let first = driven(map).next()?;
    // A change by less than a thousandth of the body is rounding, or a bone that the capture stretches.
    let size = driven(map)
        .map(|j| Vec3::from(target[j].translation - target[first].translation).length())
        .fold(0.0, f32::max);
    let moves = |j: &usize| {
        let Some(s) = map[*j] else { return false };
        let at = |f: usize| clip.samples[f * clip.joint_count + s].translation;
        (1..clip.frame_count()).any(|f| at(f).distance(at(0)) > 1e-3 * size.max(1e-3))
    };
    // A joint carries the whole body if most of the driven joints are at or below it.
    let mut at_or_below: Vec<usize> = map.iter().map(|s| usize::from(s.is_some())).collect();
    for j in (0..map.len()).rev() {
        if let Some(parent) = body.joints[j].parent {
            at_or_below[parent as usize] += at_or_below[j];
        }
    }
    let all = map.iter().flatten().count();
    Some(driven(map).filter(|j| at_or_below[*j] * 2 > all).find(moves).unwrap_or(first))
}

/// Returns the ratio of the hip heights, if both rigs have a joint near the floor: a driven joint below the
/// root by at least a fifth of the driven joints' extent.
fn hip_ratio(
    body: &Body,
    root: usize,
    map: &[Option<usize>],
    target: &[Affine3A],
    source: &[Affine3A],
) -> Option<f32> {
    let below = |mut j: usize| {
        while j != root {
            j = body.joints[j].parent? as usize;
        }
        Some(())
    };
    let drop = |world: &[Affine3A], of: &dyn Fn(usize) -> Option<usize>| -> Option<f32> {
        let height = |j: usize| Some(world[of(j)?].translation.y);
        let heights = || driven(map).filter(|j| below(*j).is_some()).filter_map(height);
        let (low, high) =
            heights().fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
        let drop = height(root)? - low;
        (drop > 0.2 * (high - low) && drop > 1e-6).then_some(drop)
    };
    Some(drop(target, &Some)? / drop(source, &|j| map[j])?)
}

/// Returns the ratio of the lengths of the bones that both rigs have, as their median; 1 if there are none.
fn bone_ratio(body: &Body, map: &[Option<usize>], target: &[Affine3A], source: &[Affine3A]) -> f32 {
    let mut ratios: Vec<f32> = driven(map)
        .filter_map(|j| {
            let mut above = body.joints[j].parent;
            while let Some(a) = above.filter(|a| map[*a as usize].is_none()) {
                above = body.joints[a as usize].parent;
            }
            let a = above? as usize;
            let length = |world: &[Affine3A], a: usize, b: usize| {
                Vec3::from(world[a].translation - world[b].translation).length()
            };
            let (ours, theirs) = (length(target, j, a), length(source, map[j]?, map[a]?));
            (ours > 1e-6 && theirs > 1e-6).then_some(ours / theirs)
        })
        .collect();
    ratios.sort_by(f32::total_cmp);
    ratios.get(ratios.len() / 2).copied().filter(|r| r.is_finite()).unwrap_or(1.0)
}

/// Returns the world-space rotation from each target bone's rest direction to that of the source bone.
///
/// A joint with one driven child points at that child. A joint with several or none inherits the rotation of
/// its parent. Joints of the spine are not rotated.
fn alignments(body: &Body, map: &[Option<usize>], target: &[Affine3A], source: &[Affine3A]) -> Vec<Quat> {
    let mut spine = vec![false; map.len()];
    let mut at = named(&body.joints, "head").map(|j| j as u32);
    while let Some(j) = at {
        spine[j as usize] = true;
        at = body.joints[j as usize].parent;
    }
    let mut align: Vec<Quat> = Vec::with_capacity(map.len());
    for (j, joint) in body.joints.iter().enumerate() {
        let inherited = joint.parent.map_or(Quat::IDENTITY, |p| align[p as usize]);
        let mut children =
            (0..map.len()).filter(|c| body.joints[*c].parent == Some(j as u32) && map[*c].is_some());
        let only = children.next().filter(|_| children.next().is_none());
        let turned = map[j].zip(only).and_then(|(s, c)| {
            let from = Vec3::from(target[c].translation - target[j].translation).try_normalize()?;
            let to = Vec3::from(source[map[c]?].translation - source[s].translation).try_normalize()?;
            Some(Quat::from_rotation_arc(from, to))
        });
        align.push(if spine[j] { Quat::IDENTITY } else { turned.unwrap_or(inherited) });
    }
    align
}

/// Prefixes that tools put before the names of joints.
const PREFIXES: [&str; 6] = ["mixamorig", "armature", "valvebiped", "biped", "bip", "character"];

/// Returns the joint of the motion for each joint of the body. Whole names are compared first, then names
/// without the prefix that each rig shares.
fn matches(joints: &[Joint], body: &[Joint]) -> Vec<Option<usize>> {
    let names = [keys(joints), bare_keys(joints)];
    let body_names = [keys(body), bare_keys(body)];
    let find = |ours: &str, theirs: &[String]| theirs.iter().position(|other| other == ours);
    (0..body.len())
        .map(|j| {
            let [whole, bare] = [&body_names[0][j], &body_names[1][j]];
            let of = |ours, theirs: &[String]| find(ours, theirs);
            of(whole, &names[0])
                .or_else(|| of(bare, &names[1]))
                .or_else(|| of(bare, &names[0]))
                .or_else(|| of(whole, &names[1]))
        })
        .collect()
}

/// Normalizes the names of a rig's joints.
fn keys(joints: &[Joint]) -> Vec<String> {
    joints.iter().map(|j| key(&j.name)).collect()
}

/// Normalizes the names of a rig's joints without a first word that most of them share (`CC_Base_Head`). Only
/// words before a separator count, and only if at least three joints and two thirds of the rig have them.
fn bare_keys(joints: &[Joint]) -> Vec<String> {
    let separated = |c: char| !c.is_alphanumeric();
    let mut names: Vec<&str> = joints.iter().map(|j| own_name(&j.name)).collect();
    for _ in 0..3 {
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        for (word, _) in names.iter().filter_map(|name| name.split_once(separated)) {
            *counts.entry(word.to_lowercase()).or_default() += 1;
        }
        let Some((shared, count)) = counts.into_iter().max_by_key(|(_, count)| *count) else { break };
        if count < 3 || count * 3 < joints.len() * 2 || ["left", "right", "l", "r"].contains(&&*shared) {
            break;
        }
        for name in &mut names {
            if let Some((word, rest)) = name.split_once(separated)
                && word.to_lowercase() == shared
            {
                *name = rest;
            }
        }
    }
    names.into_iter().map(key).collect()
}

/// Returns the part of a name after its namespaces (`mixamorig:Hips`, `Armature|Hips`).
fn own_name(name: &str) -> &str {
    name.rsplit([':', '|']).next().unwrap_or(name)
}

/// Normalizes the name of one joint.
fn key(name: &str) -> String {
    let all: String =
        own_name(name).chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect();
    let mut own = all.as_str();
    while let Some(rest) = PREFIXES.iter().find_map(|prefix| own.strip_prefix(prefix)) {
        let rest = rest.trim_start_matches(|c: char| c.is_ascii_digit());
        if rest.is_empty() {
            break;
        }
        own = rest;
    }
    own.to_owned()
}

/// Returns the rotation and position of a joint, without its scale.
fn split(world: &Affine3A) -> (Quat, Vec3) {
    let (_, rotation, translation) = world.to_scale_rotation_translation();
    (if rotation.is_finite() { rotation } else { Quat::IDENTITY }, translation)
}

/// Returns the height of the lowest of these joints [m].
fn lowest<'a>(world: impl Iterator<Item = &'a Affine3A>) -> f32 {
    world.map(|w| w.translation.y).fold(f32::INFINITY, f32::min)
}

/// Returns the joint of a rig with this name: exactly, or with prefixes ignored.
fn named(joints: &[Joint], name: &str) -> Option<usize> {
    let exact = joints.iter().position(|j| j.name.eq_ignore_ascii_case(name));
    let wanted = key(name);
    let by = |keys: Vec<String>| keys.iter().position(|k| *k == wanted);
    exact.or_else(|| by(keys(joints))).or_else(|| by(bare_keys(joints)))
}

#[cfg(test)]
mod tests;
