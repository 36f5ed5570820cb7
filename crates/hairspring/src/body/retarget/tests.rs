use super::*;

fn joint(name: &str, parent: Option<u32>, translation: Vec3) -> Joint {
    Joint { name: name.into(), parent, rest: Trs { translation, ..Trs::default() } }
}

/// A person of scale `size` with two bones an arm, held out (`down` 0) or hanging (`down` 1).
fn person(size: f32, down: f32, turned: Quat) -> Body {
    let arm = Quat::from_rotation_z(-down * std::f32::consts::FRAC_PI_2) * Vec3::X * 0.3 * size;
    let mut joints = vec![
        joint("Hips", None, Vec3::Y * size),
        joint("Head", Some(0), Vec3::Y * 0.6 * size),
        joint("LeftArm", Some(0), Vec3::new(0.2, 0.5, 0.0) * size),
        joint("LeftForeArm", Some(2), arm),
        joint("LeftHand", Some(3), arm),
        joint("RightArm", Some(0), Vec3::new(-0.2, 0.5, 0.0) * size),
        joint("LeftFoot", Some(0), Vec3::new(0.1, -1.0, 0.0) * size),
    ];
    // The forearm's local axes are rotated; the result must not depend on it.
    joints[3].rest.rotation = turned;
    joints[4].rest.translation = turned.inverse() * arm;
    Body { joints, ..Body::default() }
}

fn clip(body: &Body, frames: usize, pose: impl Fn(f32, &mut [Trs])) -> Clip {
    let samples = (0..frames).flat_map(|f| {
        let mut locals = body.rest_pose();
        pose(f as f32 / 60.0, &mut locals);
        locals
    });
    Clip { name: "test".into(), rate: 60.0, joint_count: body.joints.len(), samples: samples.collect() }
}

#[test]
fn bones_point_where_the_motions_bones_point_whatever_the_rest_poses_are() {
    let source = person(10.0, 0.0, Quat::IDENTITY);
    let target = person(1.0, 1.0, Quat::from_rotation_y(0.7) * Quat::from_rotation_x(1.1));
    let motion = clip(&source, 30, |t, pose| {
        pose[0].rotation = Quat::from_rotation_y(t);
        pose[0].translation += Vec3::new(0.0, 0.0, 3.0 * t);
        pose[2].rotation = Quat::from_rotation_z(2.0 * t);
        pose[3].rotation = Quat::from_rotation_y(-1.5 * t);
    });
    let carried = retarget(&source.joints, &motion, &target).unwrap();
    assert_eq!((carried.matched, carried.unmatched.len()), (7, 0));
    for f in [0, 10, 29] {
        let time = f as f64 / 60.0;
        let (s, t) = (source.world(&motion.sample(time)), target.world(&carried.clip.sample(time)));
        for (a, b) in [(2, 3), (3, 4)] {
            let direction = |w: &[Affine3A]| (w[b].translation - w[a].translation).normalize();
            assert!(direction(&s).distance(direction(&t)) < 1e-4, "frame {f}, bone {a}");
        }
        // A tenth of the size walks a tenth of the distance, on the same floor.
        assert!(
            (t[0].translation * 10.0).distance(s[0].translation) < 1e-3,
            "frame {f}: {}",
            t[0].translation
        );
        assert!(t[1].translation.distance(s[1].translation / 10.0) < 1e-3);
    }
}

#[test]
fn a_rig_without_a_common_name_is_refused() {
    let source = person(1.0, 0.0, Quat::IDENTITY);
    let other = Body { joints: vec![joint("Bone", None, Vec3::ZERO)], ..Body::default() };
    assert!(retarget(&source.joints, &clip(&source, 2, |_, _| {}), &other).is_none());
}

#[test]
fn a_nod_stays_a_nod_whichever_way_the_person_faces() {
    for yaw in [0.0, 1.0, 3.0f32] {
        let source = person(1.0, 0.0, Quat::IDENTITY);
        let motion = clip(&source, 60, |t, pose| {
            pose[0].rotation = Quat::from_rotation_y(yaw);
            pose[1].rotation = Quat::from_rotation_x(0.5 * t);
        });
        let options = HeadMotion { pivot: Vec3::Y * 1.5, travel: Travel::None, ..HeadMotion::default() };
        let bust = head_motion(&source.joints, &motion, "head", &options).unwrap();
        assert_eq!((bust.joint_count, bust.frame_count()), (1, 60));
        let last = bust.samples[59];
        let want = Quat::from_rotation_x(0.5 * 59.0 / 60.0);
        assert!(last.rotation.dot(want).abs() > 0.99999, "facing {yaw}: {}", last.rotation);
        assert!(last.to_affine().transform_point3(options.pivot).distance(options.pivot) < 1e-5);
    }
}

#[test]
fn travel_is_kept_taken_out_or_left_to_the_bobbing() {
    let source = person(1.0, 0.0, Quat::IDENTITY);
    let motion = clip(&source, 241, |t, pose| {
        pose[0].translation += Vec3::new(0.0, 0.05 * (t * 4.0 * std::f32::consts::PI).sin(), 1.2 * t);
    });
    let shift = |travel, f: usize| {
        let options = HeadMotion { travel, scale: 0.5, ..HeadMotion::default() };
        head_motion(&source.joints, &motion, "Head", &options).unwrap().samples[f].translation
    };
    assert!(shift(Travel::Keep, 240).distance(Vec3::Z * 2.4) < 1e-4);
    assert_eq!(shift(Travel::None, 100), Vec3::ZERO);
    let swing = (60..180).map(|f| shift(Travel::InPlace, f)).fold(Vec3::ZERO, |m, s| m.max(s.abs()));
    assert!(swing.z < 1e-3 && (0.02..0.03).contains(&swing.y), "{swing}");
}

#[test]
fn a_cut_is_no_travel_in_place() {
    let source = person(1.0, 0.0, Quat::IDENTITY);
    let motion = clip(&source, 120, |t, pose| {
        pose[0].translation.z += t + if t < 1.0 { 0.0 } else { 5.0 };
    });
    let head = head_motion(&source.joints, &motion, "Head", &HeadMotion::default()).unwrap();
    let place = |frame: usize| head.samples[frame].translation;
    let most = (1..120).map(|f| place(f).distance(place(f - 1))).fold(0.0, f32::max);
    assert!(most < 0.02, "the head moves by {most} m in a frame");
}
