//! Promise: a cut in a clip carries hair along, at any frame rate.
//!
//! In a clip of 30 Hz, the body jumps by 5 m from one frame to the next, or turns, or both. Hair does not
//! move relative to its body, whether the clip is played at 24 frames per second or at 240. If the body moves before
//! and after the cut, hair moves as it does without the cut. A continuous motion is never mistaken for a cut: hair
//! moves as it does without teleports. The same holds for a cut between two keys, at any time.

use glam::{Quat, Vec3};
use hairspring::{
    body::{Body, Clip, Joint, KEYED_RATE, Key, Mesh, Skin, Trs, keyframe_clip},
    groom::Groom,
    math::RigidTransform,
    settings::Solver,
};
use hairspring_scene::{
    Collider, Guides, InitialContact, Scene, SceneGroom, Shape,
    stage::{FrameRate, Stage},
};
use hairspring_test::farthest;

const RATES: [u32; 7] = [24, 25, 30, 48, 60, 120, 240];

/// The number of frames of the clips, at 30 Hz.
const FRAMES: usize = 60;

/// A plate of 20 cm with its center at `middle`.
fn plate(middle: Vec3) -> Mesh {
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    Mesh {
        positions: corners.map(|(x, z)| middle + Vec3::new(x, 0.0, z) * 0.1).into(),
        normals: vec![Vec3::Y; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// Strands that stand offset a plate, which has the pose `pose(frame)`.
fn scene(pose: impl Fn(usize) -> Trs) -> Scene {
    let strand = |k: usize| -> Vec<Vec3> {
        let out = Quat::from_rotation_y(k as f32) * Vec3::new(0.8, 0.6, 0.0);
        (0..10).map(|i| out * (0.02 * i as f32)).collect()
    };
    let groom = SceneGroom {
        groom: Groom::from_strands((0..6).map(strand), 35e-6),
        guides: Guides::All,
        ..SceneGroom::default()
    };
    let samples = (0..FRAMES).map(pose).collect();
    Scene {
        grooms: vec![groom],
        body: Some(Body::rigid(plate(Vec3::ZERO))),
        clip: Some(Clip { name: "cut".into(), rate: 30.0, joint_count: 1, samples }),
        solver: Solver { collide_body: false, ..Solver::default() },
        ..Scene::default()
    }
}

/// The largest distance of any point from its authored place on the moving body [m].
fn offset(stage: &Stage) -> f32 {
    let (anchor, strands) = (stage.body_anchor(), stage.strands().next().unwrap());
    let local: Vec<Vec3> = strands.points.iter().map(|p| anchor.inverse_transform_point(*p)).collect();
    farthest(&local, &strands.groom.points)
}

/// The largest offset in any frame of two seconds [m].
fn largest_offset(scene: Scene, rate: u32) -> f32 {
    let mut stage = Stage::new(scene).unwrap();
    let mut offset_of_next_frame = || {
        stage.step_frame(FrameRate::new(rate, 1).unwrap());
        offset(&stage)
    };
    (0..2 * rate).map(|_| offset_of_next_frame()).fold(0.0, f32::max)
}

/// The pose of a cut: the rest pose before frame `from`, and `to` from that frame on.
fn cut(from: usize, to: Trs) -> impl Fn(usize) -> Trs {
    move |frame| if frame < from { Trs::default() } else { to }
}

fn moved() -> Trs {
    Trs { translation: Vec3::new(5.0, 0.0, 0.0), ..Trs::default() }
}

fn turned() -> Trs {
    Trs { rotation: Quat::from_rotation_y(3.0), ..Trs::default() }
}

#[test]
fn hair_stays_with_its_body_at_any_frame_rate() {
    let both = Trs { rotation: turned().rotation, ..moved() };
    for rate in RATES {
        for (what, to) in [("away", moved()), ("turned", turned()), ("both", both)] {
            // A frame that coincides with a frame of most rates, and one between frames.
            for from in [30, 31] {
                let offset = largest_offset(scene(cut(from, to)), rate);
                assert!(offset < 1e-4, "{what} in frame {from} at {rate} Hz: {offset} m");
            }
        }
    }
}

#[test]
fn single_frame_and_resampled_cuts_are_detected() {
    // There and back, and a cut between keys of 24 Hz that were resampled.
    let blink = |frame: usize| if frame == 30 { moved() } else { Trs::default() };
    for rate in RATES {
        let offset = largest_offset(scene(blink), rate);
        assert!(offset < 1e-4, "there and back at {rate} Hz: {offset} m");
        let mut resampled = scene(|_| Trs::default());
        let at = |k: usize| ((k as f32 / 2.5 - 8.3).clamp(0.0, 1.0) * 5.0) * Vec3::X;
        let samples = (0..FRAMES).map(|k| Trs { translation: at(k), ..Trs::default() }).collect();
        resampled.clip = Some(Clip { name: "resampled".into(), rate: 60.0, joint_count: 1, samples });
        let offset = largest_offset(resampled, rate);
        assert!(offset < 1e-4, "resampled at {rate} Hz: {offset} m");
    }
}

/// The points of all strands relative to the body, in each frame of two seconds.
fn local_points(scene: Scene, rate: u32) -> Vec<Vec<Vec3>> {
    let mut stage = Stage::new(scene).unwrap();
    let mut next_frame = || {
        stage.step_frame(FrameRate::new(rate, 1).unwrap());
        let (anchor, strands) = (stage.body_anchor(), stage.strands().next().unwrap());
        strands.points.iter().map(|p| anchor.inverse_transform_point(*p)).collect()
    };
    (0..2 * rate).map(|_| next_frame()).collect()
}

#[test]
fn a_cut_of_a_moving_body_does_not_move_its_hair() {
    // A body at 1.5 m/s that turns by 60° a second, with a jump of 5 m.
    let at = |frame: usize, jump: f32| Trs {
        translation: Vec3::X * (0.05 * frame as f32 + jump),
        rotation: Quat::from_rotation_y(0.035 * frame as f32),
        ..Trs::default()
    };
    for rate in RATES {
        let with = local_points(scene(|frame| at(frame, if frame < 30 { 0.0 } else { 5.0 })), rate);
        let without = local_points(scene(|frame| at(frame, 0.0)), rate);
        let off = with.iter().zip(&without).map(|(a, b)| farthest(a, b)).fold(0.0, f32::max);
        assert!(off < 1e-4, "{off} m at {rate} Hz");
    }
}

#[test]
fn cuts_between_keys_carry_hair_at_any_time() {
    let key = |time: f32, to: Trs| Key { time, position: to.translation, rotation: to.rotation };
    for start in [0.5, 0.505, 0.51, 0.52] {
        for length in [1.0 / 240.0, 1.0 / 60.0, 1.0 / 30.0, 0.04, 0.041, 1.0 / 24.0] {
            for to in [moved(), turned()] {
                let keys = [key(0.0, Trs::default()), key(start, Trs::default()), key(start + length, to)];
                for rate in [24, 25, 30, 60, 240] {
                    let mut scene = scene(|_| Trs::default());
                    let distance = scene.solver.teleport_distance;
                    scene.clip = Some(keyframe_clip(&keys, Vec3::ZERO, KEYED_RATE, distance));
                    let mut stage = Stage::new(scene).unwrap();
                    for frame in 0..rate * 3 / 4 {
                        stage.step_frame(FrameRate::new(rate, 1).unwrap());
                        let offset = offset(&stage);
                        assert!(
                            offset < 1e-4,
                            "{start} + {length} s, frame {frame} at {rate} Hz: {offset} m"
                        );
                    }
                    let end = keys[2].position;
                    assert!(stage.body_anchor().translation.distance(end) < 1e-5, "{start} + {length} s");
                }
            }
        }
    }
}

#[test]
fn a_continuous_motion_moves_hair_at_any_frame_rate() {
    // A sudden start at 3 m/s, a head that turns by 24° a frame (720° per second), and a sudden start at 20
    // m/s.
    let motions: [fn(usize) -> Trs; 3] = [
        |k| Trs { translation: Vec3::X * (0.1 * k.saturating_sub(20) as f32), ..Trs::default() },
        |k| Trs { rotation: Quat::from_rotation_y(0.419 * k.saturating_sub(20) as f32), ..Trs::default() },
        |k| Trs { translation: Vec3::X * (0.666 * k.saturating_sub(20) as f32), ..Trs::default() },
    ];
    for rate in RATES {
        for (number, motion) in motions.into_iter().enumerate() {
            let [watched, never] = [1.0, f32::MAX].map(|jump| {
                let mut scene = scene(motion);
                scene.solver.teleport_distance = jump;
                largest_offset(scene, rate)
            });
            assert!(watched > 0.02, "motion {number} at {rate} Hz moves hair by only {watched} m");
            assert_eq!(watched, never, "motion {number} at {rate} Hz");
        }
    }
}

#[test]
fn attached_colliders_follow_the_cut_and_others_do_not() {
    // A ball that the body carries rests beside the hair. A second ball, on a joint of its own, crosses the
    // hair in a cut of its own.
    let joint = |name: &str| Joint { name: name.into(), parent: None, rest: Trs::default() };
    let ball = |joint: &str, center: Vec3| Collider {
        joint: Some(joint.into()),
        initial: InitialContact::Keep,
        shape: Shape::Sphere { center, radius: 0.02 },
    };
    for rate in RATES {
        let mut scene = scene(|_| Trs::default());
        let mut mesh = plate(Vec3::ZERO);
        let second_plate = plate(Vec3::Z * 40.0);
        mesh.positions.extend(second_plate.positions);
        mesh.normals.extend(second_plate.normals);
        mesh.triangles.extend([[4, 5, 6], [4, 6, 7]]);
        let skin = Skin {
            joints: (0..8).map(|v| [v / 4, 0, 0, 0]).collect(),
            weights: vec![[1.0, 0.0, 0.0, 0.0]; 8],
            inverse_bind: vec![Default::default(); 2],
        };
        scene.body = Some(Body { mesh, joints: vec![joint("head"), joint("prop")], skin: Some(skin) });
        let frame = |k: usize| {
            let head = if k < 30 { Trs::default() } else { moved() };
            // The prop jumps across the hair, from one side to the other.
            let prop = Trs { translation: Vec3::Z * if k < 20 { -4.0 } else { 4.0 }, ..Trs::default() };
            [head, prop]
        };
        let samples = (0..FRAMES).flat_map(frame).collect();
        scene.clip = Some(Clip { name: "cuts".into(), rate: 30.0, joint_count: 2, samples });
        scene.colliders =
            vec![ball("head", Vec3::new(0.0, 0.5, 0.0)), ball("prop", Vec3::new(0.08, 0.06, 0.0))];
        let offset = largest_offset(scene, rate);
        assert!(offset < 1e-4, "at {rate} Hz: {offset} m");
    }
}

#[test]
fn cuts_work_on_a_body_moved_by_the_app() {
    for rate in RATES {
        let mut stage = Stage::new(scene(cut(30, moved()))).unwrap();
        stage.move_body(RigidTransform {
            rotation: Quat::from_rotation_y(1.0),
            translation: Vec3::new(0.0, 0.0, 20.0),
        });
        for frame in 0..2 * rate {
            stage.step_frame(FrameRate::new(rate, 1).unwrap());
            let offset = offset(&stage);
            assert!(offset < 1e-4, "frame {frame} at {rate} Hz: {offset} m");
        }
    }
}
