//! Cuts of a clip: intervals in which the body is placed elsewhere instead of moving there.
//!
//! ```text
//!   position │            ●──●──●      The displacement D over a run of frame intervals differs by more than the threshold
//!            │                         from that predicted by the intervals before and after it, v·T: no real motion does
//!            │  ●──●──●──              that. The body goes on as in the interval before the run until the run's last
//!            └──────────────────► time frame, and changes its place there at once.
//! ```
//!
//! If the body stopped during the run, a cut would throw the hair of a moving head forward.
//!
//! Cuts are found in the frames of the clip, so they do not depend on the playback rate. The frames of a keyed
//! motion have the cuts that are found in its keys, see `keyed.rs`. Connected joints
//! share their cuts. These are found in the motion of one joint: the one that carries the hair, or the
//! topmost.

use super::{Body, Clip, Trs};
use crate::math::{RigidTransform, angle_between};
use glam::{Affine3A, Quat, Vec3};

/// Frame time for which the threshold is the teleport distance [s]. For longer intervals the threshold grows
/// in proportion, since real motion goes farther.
const TELEPORT_FRAME: f64 = 1.0 / 24.0;

/// Rotation in excess of the prediction that counts as a teleport within [`TELEPORT_FRAME`] [rad].
const TELEPORT_ANGLE: f32 = std::f32::consts::FRAC_PI_2;

/// Smallest motion next to a cut that is counted as part of it, as a fraction of the teleport distance [1].
const MIN_CUT_MOTION: f32 = 0.05;

/// Returns whether a deviation from the predicted pose after `dt` [s] is too large for real motion. `off` is
/// the deviation in position [m], `turned` that in rotation [rad], and `distance` [m] the teleport distance
/// for one frame at 24 Hz.
pub(crate) fn is_teleport(off: f32, turned: f32, distance: f32, dt: f64) -> bool {
    let longer = (dt / TELEPORT_FRAME).max(1.0) as f32;
    off > distance * longer || turned > TELEPORT_ANGLE * longer
}

/// The cuts of a clip on a body.
///
/// ```
/// use glam::{Quat, Vec3};
/// use hairspring::body::{Body, Clip, Cuts, Mesh, Trs};
///
/// // A clip of 30 Hz that jumps by 5 m after its second frame.
/// let at = |x| Trs { translation: Vec3::X * x, ..Default::default() };
/// let samples = [0.0, 0.0, 5.0, 5.0].map(at).to_vec();
/// let clip = Clip { name: "cut".into(), rate: 30.0, joint_count: 1, samples };
/// let body = Body::rigid(Mesh::default());
/// let cuts = Cuts::new(&body, &clip, 0, 1.0);
/// let moved = cuts.motion_between(&body, &clip, (0.0, 0.1));
/// assert_eq!(moved[0].map(|by| by.translation), Some(Vec3::X * 5.0));
/// ```
#[derive(Debug, Default)]
pub struct Cuts {
    trees: Vec<Tree>,
    /// Index of the tree that each joint belongs to.
    tree_of: Vec<usize>,
}

/// A tree of connected joints.
#[derive(Debug)]
struct Tree {
    /// The joint in whose motion the cuts are found.
    joint: usize,
    /// The last frame before each cut and the first frame after it, in order.
    cuts: Vec<(usize, usize)>,
}

impl Cuts {
    /// Finds the cuts of `clip`. `distance` is the teleport distance [m], and `anchor` the joint that carries
    /// the hair.
    ///
    /// # Panics
    /// If there is no joint `anchor`, or the clip has other joints than the body.
    pub fn new(body: &Body, clip: &Clip, anchor: usize, distance: f32) -> Self {
        let mut cuts = Self::default();
        for (joint, parent) in body.joints.iter().map(|j| j.parent).enumerate() {
            let tree = parent.map_or(cuts.trees.len(), |p| cuts.tree_of[p as usize]);
            if parent.is_none() {
                cuts.trees.push(Tree { joint, cuts: Vec::new() });
            }
            cuts.tree_of.push(tree);
        }
        if let Some(tree) = cuts.tree_of.get(anchor) {
            cuts.trees[*tree].joint = anchor;
        }
        for tree in &mut cuts.trees {
            let path: Vec<RigidTransform> =
                (0..clip.frame_count()).map(|f| world_of(body, clip.frame(f), tree.joint)).collect();
            tree.cuts = find(&path, clip.rate, distance);
        }
        cuts
    }

    /// Returns local transforms at `time` [s] like [`Clip::sample`], but does not interpolate across a cut: until its
    /// end, the joints go on as in the frame interval before it. Shape `[joints]`.
    pub fn sample(&self, clip: &Clip, time: f64) -> Vec<Trs> {
        let (frame, t) = clip.place(time);
        let place = |tree: &Tree| match tree.cut_at(frame) {
            Some((before, _)) => tree.continued(before, (frame - before) as f32 + t),
            None => (frame, t),
        };
        let places: Vec<(usize, f32)> = self.trees.iter().map(place).collect();
        let local = |(joint, tree): (usize, &usize)| between(clip, joint, places[*tree]);
        self.tree_of.iter().enumerate().map(local).collect()
    }

    /// Returns the rigid motion of each joint due to the cuts after time `from` and up to `to` [s]; `None`
    /// for joints without a cut. Empty if there is no cut at all.
    pub fn motion_between(
        &self,
        body: &Body,
        clip: &Clip,
        (from, to): (f64, f64),
    ) -> Vec<Option<RigidTransform>> {
        let (first, last) = (clip.place(from).0, clip.place(to).0);
        let mut moved = Vec::new();
        for (number, tree) in self.trees.iter().enumerate() {
            for (before, after) in tree.cuts.iter().filter(|(_, after)| (first + 1..=last).contains(after)) {
                let last = tree.continued(*before, (after - before) as f32);
                let all = 0..self.tree_of.len();
                let old = body.world(&all.map(|joint| between(clip, joint, last)).collect::<Vec<_>>());
                let new = body.world(clip.frame(*after));
                moved.resize(self.tree_of.len(), None);
                for joint in (0..self.tree_of.len()).filter(|joint| self.tree_of[*joint] == number) {
                    let by = step(&old[joint], &new[joint]);
                    moved[joint] = Some(moved[joint].map_or(by, |before| by * before));
                }
            }
        }
        moved
    }
}

impl Tree {
    /// Returns the cut that contains the interval after `frame`.
    fn cut_at(&self, frame: usize) -> Option<(usize, usize)> {
        let next = self.cuts.partition_point(|(_, after)| *after <= frame);
        self.cuts.get(next).copied().filter(|(before, _)| *before <= frame)
    }

    /// Returns where [`between`] gives the pose that is `later` frames after the frame `before` a cut, if the motion of
    /// the interval before it goes on. At the start of the clip and right after another cut, the pose is held.
    fn continued(&self, before: usize, later: f32) -> (usize, f32) {
        match before.checked_sub(1) {
            Some(earlier) if self.cut_at(earlier).is_none() => (earlier, 1.0 + later),
            _ => (before, 0.0),
        }
    }
}

/// Returns the local transform of a joint `t` frame intervals after `frame`, on the straight path to the next frame.
/// Beyond 1, the path goes on.
fn between(clip: &Clip, joint: usize, (frame, t): (usize, f32)) -> Trs {
    clip.frame(frame)[joint].lerp(&clip.frame(frame + 1)[joint], t)
}

/// Returns the rigid motion between two matrices of a joint.
fn step(from: &Affine3A, to: &Affine3A) -> RigidTransform {
    RigidTransform::from_affine(to) * RigidTransform::from_affine(from).inverse()
}

/// Returns the world transform of a joint in a pose.
fn world_of(body: &Body, pose: &[Trs], joint: usize) -> RigidTransform {
    let mut world = pose[joint].to_affine();
    let mut parent = body.joints[joint].parent;
    while let Some(p) = parent {
        world = pose[p as usize].to_affine() * world;
        parent = body.joints[p as usize].parent;
    }
    RigidTransform::from_affine(&world)
}

/// Velocity and rotation vector of an interval between two frames [m/frame, rad/frame].
#[derive(Clone, Copy, Default)]
struct Pace {
    velocity: Vec3,
    spin: Vec3,
}

/// Returns the cuts of a joint's path, which has one pose for each frame: the last frame before each cut and
/// the first frame after it, in order.
pub(super) fn find(path: &[RigidTransform], rate: f64, distance: f32) -> Vec<(usize, usize)> {
    let intervals = path.len().saturating_sub(1);
    let pace = |k: usize| {
        let (a, b) = (&path[k], &path[k + 1]);
        let turn = b.rotation * a.rotation.inverse();
        let turn = if turn.w < 0.0 { -turn } else { turn };
        Pace { velocity: b.translation - a.translation, spin: turn.to_scaled_axis() }
    };
    // Outside the clip, the body stands still.
    let before = |k: usize| k.checked_sub(1).map_or(Pace::default(), pace);
    let after = |k: usize| if k < intervals { pace(k) } else { Pace::default() };
    let is_cut = |from: usize, to: usize| {
        let n = (to - from) as f32;
        let (a, b) = (&path[from], &path[to]);
        let moved = b.translation - a.translation;
        let turn = b.rotation * a.rotation.inverse();
        [before(from), after(to)].into_iter().all(|pace| {
            let off = (moved - pace.velocity * n).length();
            let turned = angle_between(turn, Quat::from_scaled_axis(pace.spin * n));
            is_teleport(off, turned, distance, f64::from(n) / rate)
        })
    };
    // Resampling a cut between two 24 Hz keys spreads it over up to this many frame intervals.
    let longest = ((rate * TELEPORT_FRAME).ceil() as usize).saturating_add(1).min(intervals);
    // If the keys lie between frames, the cut touches one more interval.
    let widest = longest + 1;
    // A frame interval next to a cut belongs to it if it moves in the same direction and faster than its
    // other neighbor. The first and the last interval of the clip have none: they are compared with rest and with
    // the motion on the other side of the cut.
    let earlier = |interval: usize, to: usize| match interval {
        0 => [Pace::default(), after(to)],
        _ => [pace(interval - 1); 2],
    };
    let later = |interval: usize, from: usize| match interval + 1 == intervals {
        true => [Pace::default(), before(from)],
        false => [pace(interval + 1); 2],
    };
    let is_rest = |interval: usize, neighbours: [Pace; 2], step: Vec3| {
        let own = pace(interval);
        neighbours.into_iter().all(|neighbour| {
            let off = own.velocity - neighbour.velocity;
            off.dot(step) > MIN_CUT_MOTION * distance * step.length()
                || own.spin.distance(neighbour.spin) > MIN_CUT_MOTION * TELEPORT_ANGLE
        })
    };
    let widen = |(mut from, mut to): (usize, usize), others: &[(usize, usize)]| {
        let free = |interval: usize| others.iter().all(|(a, b)| interval < *a || interval >= *b);
        while to - from < widest {
            let step = path[to].translation - path[from].translation;
            if from > 0 && free(from - 1) && is_rest(from - 1, earlier(from - 1, to), step) {
                from -= 1;
            } else if to < intervals && free(to) && is_rest(to, later(to, from), step) {
                to += 1;
            } else {
                break;
            }
        }
        (from, to)
    };
    let mut cuts: Vec<(usize, usize)> = Vec::new();
    // Try the shortest runs first, so that a frame without motion next to a cut is not counted as part of it.
    for n in 1..=longest {
        for from in 0..=intervals - n {
            let to = from + n;
            let free = cuts.iter().all(|(a, b)| to <= *a || from >= *b);
            if free && is_cut(from, to) {
                let widened = widen((from, to), &cuts);
                cuts.push(widened);
            }
        }
    }
    cuts.sort_unstable();
    cuts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(xs: &[f32]) -> Vec<RigidTransform> {
        xs.iter().map(|x| RigidTransform { translation: Vec3::X * *x, ..RigidTransform::default() }).collect()
    }

    fn turns(angles: &[f32]) -> Vec<RigidTransform> {
        angles
            .iter()
            .map(|a| RigidTransform { rotation: Quat::from_rotation_y(*a), ..RigidTransform::default() })
            .collect()
    }

    #[test]
    fn a_cut_is_what_no_motion_does() {
        let cut = |xs: &[f32], rate: f64| find(&path(xs), rate, 1.0);
        assert_eq!(cut(&[0.0, 0.0, 5.0, 5.0], 30.0), [(1, 2)]);
        assert_eq!(cut(&[0.0, 0.1, 5.1, 5.2], 30.0), [(1, 2)]);
        assert_eq!(cut(&[0.0, 5.0], 30.0), [(0, 1)]);
        assert_eq!(cut(&[0.0, 5.0, 0.0, 0.0], 30.0), [(0, 1), (1, 2)]);
        // Resampled from keys at 24 Hz to 60 Hz.
        assert_eq!(cut(&[0.0, 0.0, 0.5, 2.5, 4.5, 5.0, 5.0], 60.0), [(1, 5)]);
        // Keys between frames: the remainders of the cut before and after the middle interval are part of it.
        assert_eq!(cut(&[0.0, 0.0, 0.6, 4.6, 5.0, 5.0], 30.0), [(1, 4)]);
        assert_eq!(cut(&[0.0, 0.1, 0.2, 4.3, 5.2, 5.3, 5.4], 30.0), [(2, 4)]);
        // The remainder of a cut at the end and at the start of the clip.
        assert_eq!(cut(&[0.0, 0.0, 1.6, 4.7, 5.0], 60.0), [(1, 4)]);
        assert_eq!(cut(&[0.0, 0.5, 3.0, 5.0, 5.0], 60.0), [(0, 3)]);
        // A run that continues after a cut.
        assert_eq!(cut(&[0.0, 0.0, 5.0, 5.1, 5.2, 5.3], 30.0), [(1, 2)]);
        // Running, falling, and a ride that starts abruptly.
        assert_eq!(cut(&[0.0, 0.0, 0.1, 0.2, 0.3, 0.3], 30.0), []);
        assert_eq!(cut(&[0.0, 0.0, 2.0, 4.0, 6.0, 8.0], 24.0), []);
        // Keys that are far apart in time are far apart in space.
        assert_eq!(cut(&[0.0, 10.0, 20.0, 20.0], 0.01), []);
        assert_eq!(cut(&[], 30.0), []);
    }

    /// A head that walks and nods, with jumps in a clip of 60 Hz that are spread over three intervals.
    #[test]
    fn a_moving_body_goes_on_until_the_end_of_a_cut() {
        let (speed, spin) = (0.02f32, 0.01f32);
        let jump = |frame: usize| [0.0, 0.4, 2.5, 5.0][frame.saturating_sub(10).min(3)];
        let frame = |f: usize| Trs {
            translation: Vec3::X * (speed * f as f32 + jump(f)),
            rotation: Quat::from_rotation_x(spin * f as f32),
            scale: Vec3::ONE,
        };
        let samples = (0..30).map(frame).collect();
        let clip = Clip { name: "walk".into(), rate: 60.0, joint_count: 1, samples };
        let body = Body::rigid(crate::body::Mesh::default());
        let cuts = Cuts::new(&body, &clip, 0, 1.0);
        assert_eq!(cuts.trees[0].cuts, [(10, 13)]);
        for k in 0..=116 {
            let time = f64::from(k) / 240.0;
            let frame = 60.0 * time as f32;
            let after = if k < 52 { 0.0 } else { 5.0 };
            let pose = cuts.sample(&clip, time)[0];
            let off = (pose.translation.x - speed * frame - after).abs();
            let turned = angle_between(pose.rotation, Quat::from_rotation_x(spin * frame));
            assert!(off < 1e-5 && turned < 1e-5, "{off} m and {turned} rad off at frame {frame}");
        }
        let moved = cuts.motion_between(&body, &clip, (0.21, 0.22))[0].unwrap();
        assert!(moved.translation.distance(Vec3::X * 5.0) < 1e-5, "{moved:?}");
        assert!(angle_between(moved.rotation, Quat::IDENTITY) < 1e-5, "{moved:?}");
    }

    #[test]
    fn a_turn_is_a_cut_where_no_head_turns_so() {
        let cut = |angles: &[f32], rate: f64| find(&turns(angles), rate, 1.0);
        assert_eq!(cut(&[0.0, 0.0, 2.0, 2.0], 30.0), [(1, 2)]);
        assert_eq!(cut(&[0.0, 0.2, 0.4, 0.6, 0.6], 30.0), []);
        // A wheel that turns by more than a right angle a frame.
        assert_eq!(cut(&[0.0, 1.7, 3.4, 5.1, 6.8], 30.0), []);
    }
}
