//! Promise: files from third parties are read completely and in the right place.
//!
//! Authors describe their formats, but real files decide what a reader must accept. These tests read real
//! grooms, characters and motions. They compare counts, sizes and lengths with values that were
//! measured in the files by other means (the table in the data's README). A test is skipped, with a reason
//! printed, where its data is missing.

use glam::Vec3;
use hairspring_io::{ReadOptions, read_body, read_bones, read_groom, read_motion};
use hairspring_test::{data, farthest};

/// Length of each strand [m], sorted.
fn lengths(groom: &hairspring::groom::Groom) -> Vec<f32> {
    let mut lengths: Vec<f32> = (0..groom.strand_count()).map(|s| groom.strand_length(s)).collect();
    lengths.sort_by(f32::total_cmp);
    lengths
}

fn assert_near(a: f32, b: f32, tolerance: f32) {
    assert!((a - b).abs() <= tolerance, "{a} is not within {tolerance} of {b}");
}

/// Reads in the file's own units and axes.
const RAW: ReadOptions = ReadOptions { scale: Some(1.0), up: Some(hairspring_io::Axis::Y) };

#[test]
fn grooms_have_their_strands_and_points() {
    for (file, strands, points) in [
        ("grooms/straight/straight.hair", 10_000, 16),
        ("grooms/sintel/SintelHairOriginal-sintel_hair.16points.tfx", 11_400, 16),
        ("grooms/sintel_guides/GEO-sintel_hair_emit.001-sintel_hair.tfx", 228, 32),
        ("grooms/tressfx_ponytail/back.tfx", 517, 16),
        ("grooms/tressfx_ponytail/front_top.tfx", 876, 16),
        ("grooms/tressfx_ponytail/side.tfx", 3_066, 16),
        ("grooms/tressfx_ponytail/tail.tfx", 474, 16),
        ("grooms/tressfx_mohawk/Ratboy_mohawk.tfx", 2_228, 32),
        ("grooms/tressfx_testhair/TestHair1.tfx", 10_027, 4),
    ] {
        let Some(path) = data(file) else { return };
        let loaded = read_groom(&path, &ReadOptions::default()).unwrap();
        assert_eq!(loaded.value.strand_count(), strands, "{file}");
        assert_eq!(loaded.value.point_count(), strands * points, "{file}");
        println!("{file}: {:?} {:?}\n  {:?}", loaded.value.bounds(), loaded.repairs, loaded.notes);
    }
}

#[test]
fn bounds_and_lengths_match_the_files() {
    let Some(path) = data("grooms/straight/straight.hair") else {
        return;
    };
    let straight = read_groom(&path, &RAW).unwrap().value;
    let (lo, hi) = straight.bounds().unwrap();
    assert!(lo.distance(Vec3::new(-32.5, -33.9, -22.7)) < 0.1, "the lowest corner is {lo}");
    assert!(hi.distance(Vec3::new(30.9, 24.1, 63.7)) < 0.1, "the highest corner is {hi}");
    let l = lengths(&straight);
    for (at, want) in [(0, 55.0), (l.len() / 2, 77.0), (l.len() - 1, 107.0)] {
        assert_near(l[at], want, 0.5);
    }
    assert_eq!(straight.colors.len(), straight.point_count());

    let sintel =
        read_groom(&data("grooms/sintel/SintelHairOriginal-sintel_hair.16points.tfx").unwrap(), &RAW)
            .unwrap()
            .value;
    let l = lengths(&sintel);
    for (at, want) in [(0, 0.025), (l.len() / 2, 0.102), (l.len() - 1, 0.248)] {
        assert_near(l[at], want, 0.001);
    }
    let tail = read_groom(&data("grooms/tressfx_ponytail/tail.tfx").unwrap(), &RAW).unwrap().value;
    let l = lengths(&tail);
    for (at, want) in [(0, 28.0), (l.len() / 2, 66.0), (l.len() - 1, 92.0)] {
        assert_near(l[at], want, 0.5);
    }
    let fuzz = read_groom(&data("grooms/tressfx_testhair/TestHair1.tfx").unwrap(), &RAW).unwrap().value;
    lengths(&fuzz).iter().for_each(|l| assert_near(*l, 11.0, 0.01));
}

#[test]
fn mohawk_has_uvs_bones_and_near_zero_segments() {
    let Some(path) = data("grooms/tressfx_mohawk/Ratboy_mohawk.tfx") else {
        return;
    };
    let mohawk = read_groom(&path, &ReadOptions::default()).unwrap();
    assert_eq!(mohawk.scale, 1.0);
    assert_eq!(mohawk.value.root_uvs.len(), 2_228);
    assert!(mohawk.repairs.zero_segments > 0, "no segment of zero length was repaired: {:?}", mohawk.repairs);
    assert_eq!(mohawk.repairs.non_finite_points, 0);
    let bones = read_bones(&data("grooms/tressfx_mohawk/Ratboy_mohawk.tfxbone").unwrap()).unwrap();
    assert_eq!((bones.names.len(), bones.bones.len()), (105, 2_228));
    assert_eq!(bones.names[0], "frenchHornMonster_head_JNT");
}

#[test]
fn bodies_have_their_vertices_and_faces() {
    for (file, vertices, triangles) in [
        ("grooms/sintel/sintel.obj", 3_046, 5_952),
        ("grooms/sintel/sintel-collider.obj", 341, 678),
        ("grooms/sintel_guides/sintel.obj", 3_046, 5_952),
        ("grooms/tressfx_mohawk/Ratboy_body.tfxmesh", 12_909, 25_814),
    ] {
        let Some(path) = data(file) else { return };
        let body = read_body(&path, &ReadOptions::default()).unwrap();
        println!("{file}: {:?} {:?}", body.value.body.mesh.bounds(), body.notes);
        assert_eq!(body.value.body.mesh.positions.len(), vertices, "{file}");
        assert_eq!(body.value.body.mesh.triangles.len(), triangles, "{file}");
    }
    let rat =
        read_body(&data("grooms/tressfx_mohawk/Ratboy_left_hand.tfxmesh").unwrap(), &RAW).unwrap().value.body;
    assert_eq!((rat.joints.len(), rat.mesh.positions.len()), (16, 1_247));
    let head =
        read_body(&data("grooms/tressfx_ponytail/ponytail_head.obj").unwrap(), &RAW).unwrap().value.body;
    assert_eq!(head.mesh.positions.len(), 11_744);
    assert!(head.mesh.parts.iter().any(|p| p.name == "Mesh_hairBands_pTorus3"));
    let man = read_body(&data("characters/makehuman/base.obj").unwrap(), &ReadOptions::default()).unwrap();
    assert_eq!(man.value.body.mesh.positions.len(), 19_158);
    assert_near(man.scale, 0.1, 0.0);
}

#[test]
fn the_robot_is_4_5_m_tall_and_bounded_in_every_clip() {
    let Some(path) = data("characters/robot/robot.glb") else {
        return;
    };
    let robot = read_body(&path, &ReadOptions::default()).unwrap();
    let body = &robot.value.body;
    let (lo, hi) = body.mesh.bounds().unwrap();
    println!("robot: {lo} {hi}, {} joints, {} triangles", body.joints.len(), body.mesh.triangles.len());
    assert_near(hi.y - lo.y, 4.5, 0.1);
    assert_near(lo.y, 0.0, 0.1);
    assert_eq!(robot.value.clips.len(), 14);
    assert!(body.joints.iter().enumerate().all(|(j, joint)| joint.parent.is_none_or(|p| (p as usize) < j)));
    // Skinning the rest pose reproduces the mesh.
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    body.skinned(&body.world(&body.rest_pose()), &mut positions, &mut normals);
    let worst = farthest(&positions, &body.mesh.positions);
    assert!(worst < 1e-3, "skinning the rest pose moved a vertex by {worst} m");
    for clip in &robot.value.clips {
        assert_eq!(clip.joint_count, body.joints.len());
        let duration = clip.duration();
        assert!((0.3..=3.4).contains(&duration), "{} lasts {duration} s", clip.name);
        // In every clip the body stays connected: it is no larger than the body with arms and legs
        // stretched out.
        let (lo, hi) = (0..clip.frame_count())
            .step_by(7)
            .map(|f| {
                body.skinned(&body.world(&clip.sample(f as f64 / clip.rate)), &mut positions, &mut normals);
                positions
                    .iter()
                    .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)))
            })
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(lo, hi), (a, b)| (lo.min(a), hi.max(b)));
        println!("{}: {duration:.2} s, {lo} {hi}", clip.name);
        assert!(
            (hi - lo).max_element() < 9.0 && lo.y > -1.0,
            "{}: the body extends from {lo} to {hi}",
            clip.name
        );
    }
    let head = body.joint("Head").unwrap();
    let top = body.world(&body.rest_pose())[head].translation.y;
    assert!((2.0..4.5).contains(&top), "the head joint is at a height of {top} m");
}

#[test]
fn motions_have_their_frames_and_height() {
    for (file, frames, rate) in [
        ("motion/cmu/02_01.bvh", 343, 120.0),
        ("motion/cmu/01_01.bvh", 2_752, 120.0),
        ("motion/animated_drawings/jumping_jacks.bvh", 125, 30.0),
        ("motion/animated_drawings/dab.bvh", 339, 30.0),
        ("motion/animated_drawings/zombie.bvh", 779, 30.0),
        ("motion/animated_drawings/jumping.bvh", 654, 120.0),
        ("motion/animated_drawings/wave_hello.bvh", 839, 120.0),
        ("motion/animated_drawings/jesse_dance.bvh", 1_007, 100.0),
    ] {
        let Some(path) = data(file) else { return };
        let motion = read_motion(&path, None, &ReadOptions::default()).unwrap();
        println!("{file}: {} joints, scale {}, {:?}", motion.value.joints.len(), motion.scale, motion.notes);
        assert_eq!(motion.value.clip.frame_count(), frames, "{file}");
        assert_near(motion.value.clip.rate as f32, rate, 0.2);
        let body = hairspring::body::Body { joints: motion.value.joints.clone(), ..Default::default() };
        let head = body.joint("Head").expect("a head joint");
        let middle = body.world(&motion.value.clip.sample(motion.value.clip.duration() * 0.5));
        let lowest = middle.iter().map(|w| w.translation.y).fold(f32::INFINITY, f32::min);
        let height = middle[head].translation.y - lowest;
        assert!((1.0..2.0).contains(&height), "{file}: the head is {height} m above the lowest joint");
    }
    let cmu = read_motion(&data("motion/cmu/02_01.bvh").unwrap(), None, &ReadOptions::default()).unwrap();
    assert_near(cmu.scale, 0.05644, 1e-4);
}
