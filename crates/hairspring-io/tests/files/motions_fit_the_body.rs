//! Promise: a motion fits the body that it moves, whatever their sizes and the names of their joints.
//!
//! A bust stays at its own height when a whole person's motion moves it, a root that stands still is not
//! lifted, and prefixes that tools put before the names of joints are ignored. What a `.bvh` file says wrongly
//! about its frames is reported with a remedy.

use glam::{Quat, Vec3};
use hairspring::body::{Body, Clip, HeadMotion, Joint, Trs, head_motion, retarget};
use hairspring_io::{ReadOptions, read_motion, read_scene};

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

/// Neck and head of a person of scale `size`, cut off below the neck at `height`.
fn bust(size: f32, height: f32) -> Body {
    let joints = vec![joint("Neck", None, Vec3::Y * height), joint("Head", Some(0), Vec3::Y * 0.1 * size)];
    Body { joints, ..Body::default() }
}

/// A person of scale `size` with the joints of a [`bust`].
fn captured(size: f32) -> Body {
    let mut body = person(size, 0.0, Quat::IDENTITY);
    body.joints[1] = joint("Neck", Some(0), Vec3::Y * 0.5 * size);
    body.joints.push(joint("Head", Some(1), Vec3::Y * 0.1 * size));
    body
}

#[test]
fn a_bust_stays_at_its_own_height_and_walks_in_its_own_scale() {
    for (size, height) in [(1.0, 1.45), (0.5, 0.0), (0.1, -3.0), (1.0, 0.0)] {
        let source = captured(10.0);
        let motion = clip(&source, 30, |t, pose| {
            pose[0].translation += Vec3::new(0.0, 2.0 * t, 5.0 * t);
            pose[7].rotation = Quat::from_rotation_x(t);
        });
        let carried = retarget(&source.joints, &motion, &bust(size, height)).unwrap();
        assert!(!carried.on_floor && (carried.scale - size / 10.0).abs() < 1e-6, "{}", carried.scale);
        let neck = |f: usize| carried.clip.samples[2 * f].translation;
        assert!(neck(0).distance(Vec3::Y * height) < 1e-5, "lifted to {}", neck(0));
        let walked = Vec3::new(0.0, 0.2, 0.5) * size * (29.0 / 60.0);
        assert!((neck(29) - neck(0)).distance(walked) < 1e-4, "walked by {}", neck(29) - neck(0));
    }
}

#[test]
fn a_root_on_the_floor_that_never_moves_is_not_lifted() {
    let above_root = |hips: &Body| {
        let mut joints = vec![joint("Root", None, Vec3::ZERO)];
        joints.extend(
            hips.joints.iter().map(|j| Joint { parent: Some(j.parent.map_or(0, |p| p + 1)), ..j.clone() }),
        );
        Body { joints, ..Body::default() }
    };
    // The hips move below a root that stands still, at half the size.
    let (source, target) = (above_root(&captured(2.0)), above_root(&captured(1.0)));
    let motion = clip(&source, 10, |t, pose| pose[1].translation.z += t);
    let carried = retarget(&source.joints, &motion, &target).unwrap();
    let at = |f: usize, j: usize| target.world(&carried.clip.samples[f * target.joints.len()..])[j];
    assert!(Vec3::from(at(0, 1).translation).distance(Vec3::Y) < 1e-5);
    assert!(Vec3::from(at(9, 1).translation).distance(Vec3::new(0.0, 1.0, 0.075)) < 1e-5);
    // The motion calls its hips `Root`; that of the body is on the floor.
    let mut named = captured(1.0);
    named.joints[0].name = "root".into();
    let carried = retarget(&named.joints, &clip(&named, 2, |_, _| {}), &target).unwrap();
    assert!(carried.clip.samples[0].translation.length() < 1e-5);
    // A body without legs whose hips are the origin.
    let mut torso = Body { joints: captured(1.0).joints[..3].to_vec(), ..Body::default() };
    torso.joints[0].rest.translation = Vec3::ZERO;
    let source = captured(1.0);
    let carried = retarget(&source.joints, &clip(&source, 2, |_, _| {}), &torso).unwrap();
    assert!(carried.clip.samples[0].translation.length() < 1e-5);
}

#[test]
fn a_first_frame_unlike_the_others_does_not_lift_or_sink_the_body() {
    let source = captured(1.0);
    // A rest pose at the origin, a jump, and a crouch, for some of 31 frames.
    for (height, frames) in [(-1.0, 1), (0.4, 5), (-0.5, 5)] {
        let motion = clip(&source, 31, |t, pose| {
            if t * 60.0 < frames as f32 - 0.5 {
                pose[0].translation.y += height;
            }
        });
        for (target, on_floor) in [(captured(1.0), true), (bust(1.0, 1.5), false)] {
            let carried = retarget(&source.joints, &motion, &target).unwrap();
            assert_eq!(carried.on_floor, on_floor);
            assert!((carried.first_frame_height.unwrap() - height).abs() < 1e-4);
            let root = |f: usize| carried.clip.samples[f * target.joints.len()].translation.y;
            assert!((root(30) - target.joints[0].rest.translation.y).abs() < 1e-4, "{height}: {}", root(30));
            assert!((root(0) - root(30) - height).abs() < 1e-4);
        }
    }
    // Frames of many heights, and two halves, keep the first one.
    let climbs = clip(&source, 31, |t, pose| pose[0].translation.y += 4.0 * t);
    let steps = clip(&source, 30, |t, pose| pose[0].translation.y += if t > 0.2 { 2.0 } else { 0.0 });
    for motion in [climbs, steps] {
        let carried = retarget(&source.joints, &motion, &source).unwrap();
        assert_eq!(carried.first_frame_height, None);
        assert!((carried.clip.samples[0].translation.y - 1.0).abs() < 1e-4);
    }
}

#[test]
fn prefixes_of_tools_and_rigs_are_ignored() {
    let source = captured(1.0);
    let motion = clip(&source, 2, |_, _| {});
    let prefixes = [
        "mixamorig_",
        "mixamorig:",
        "mixamorig",
        "mixamorig9:",
        "Armature|",
        "Armature_",
        "Bip01_",
        "Bip001 ",
        "Bip01 ",
        "CC_Base_",
        "ns:rig|",
        "DEF-",
        "Character1_",
        "ValveBiped.Bip01_",
    ];
    for prefix in prefixes {
        let renamed = |body: &Body| {
            let rename = |j: &Joint| Joint { name: format!("{prefix}{}", j.name), ..j.clone() };
            Body { joints: body.joints.iter().map(rename).collect(), ..Body::default() }
        };
        let prefixed = renamed(&source);
        for (from, to) in [(&source, &prefixed), (&prefixed, &source), (&prefixed, &prefixed)] {
            let carried = retarget(&from.joints, &motion, to);
            assert_eq!(carried.map(|c| c.matched), Some(source.joints.len()), "{prefix}");
        }
        let head = head_motion(&prefixed.joints, &motion, "head", &HeadMotion::default());
        assert!(head.is_some(), "{prefix}");
    }
    // A word that most joints share may also be the name.
    let spine = |more: &[&str]| {
        let names = more.iter().chain(&["spine_01", "spine_02", "spine_03"]);
        let joints =
            names.enumerate().map(|(i, name)| joint(name, i.checked_sub(1).map(|p| p as u32), Vec3::Y * 0.1));
        Body { joints: joints.collect(), ..Body::default() }
    };
    let (short, long) = (spine(&[]), spine(&["hips", "belly", "chest"]));
    let carried = retarget(&short.joints, &clip(&short, 2, |_, _| {}), &long).unwrap();
    assert_eq!((carried.matched, carried.unmatched.len()), (3, 0));
}

/// A `.bvh` file of two joints with six numbers a frame, with this header and these lines of frames.
fn bvh(header: &str, frames: usize) -> String {
    let mut text = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Yrotation Xrotation\nJOINT Head\n{\nOFFSET 0 0.6 0\n\
         CHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 0.2 0\n}\n}\n}\nMOTION\n"
        .to_owned();
    text += header;
    for f in 0..frames {
        text += &format!("0 0 0 0 {f} 0\n");
    }
    text
}

/// Reads a motion, and returns it with its notes, or the error as text.
fn read(text: &str) -> Result<(Clip, String), String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bvh");
    std::fs::write(&path, text).unwrap();
    let loaded = read_motion(&path, None, &ReadOptions::default()).map_err(|e| e.to_string())?;
    Ok((loaded.value.clip, loaded.notes.join("; ")))
}

#[test]
fn a_head_alone_is_not_taken_for_a_person() {
    for (height, unit) in [
        ("0.2", "meters (the skeleton is then 0.20 m"),
        ("20", "centimeters (the skeleton is then 0.20 m"),
        ("250", "millimeters (the skeleton is then 0.25 m"),
    ] {
        let text = format!(
            "HIERARCHY\nROOT Head\n{{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{{\nOFFSET 0 \
             {height} 0\n}}\n}}\nMOTION\nFrames: 1\nFrame Time: 0.02\n0 0 0\n"
        );
        let (_, notes) = read(&text).unwrap();
        assert!(notes.contains(unit), "{height}: {notes}");
    }
}

#[test]
fn headers_without_spaces_and_comments_are_read() {
    let (want, _) = read(&bvh("Frames: 2\nFrame Time: 0.02\n", 2)).unwrap();
    for header in [
        "Frames:2\nFrame Time:0.02\n",
        "Frames : 2\nFrame Time : 0.02\n",
        "FRAMES :2\n# made by hand\nFrame time: 0.02\n  # frames\n",
    ] {
        let (clip, _) = read(&bvh(header, 2)).unwrap_or_else(|e| panic!("{header}: {e}"));
        assert_eq!((clip.rate, &clip.samples), (want.rate, &want.samples), "{header}");
    }
    let error = read(&bvh("Frames 2\nFrame Time: 0.02\n", 2)).unwrap_err();
    assert!(error.contains("line 17: expected `Frames:`, found `Frames`"), "{error}");
    let error = read(&bvh("# a comment\nFrames:two\nFrame Time: 0.02\n", 2)).unwrap_err();
    assert!(error.contains("line 18: expected the number of frames, found `two`"), "{error}");
}

#[test]
fn frames_beyond_the_count_of_the_header_are_reported() {
    let (clip, notes) = read(&bvh("Frames: 3\nFrame Time: 0.02\n", 3)).unwrap();
    assert_eq!((clip.frame_count(), clip.rate), (3, 50.0));
    assert!(!notes.contains("frames"), "{notes}");
    let (clip, notes) = read(&bvh("Frames: 3\nFrame Time: 0.02\n", 8)).unwrap();
    assert_eq!(clip.frame_count(), 3);
    assert!(
        notes.contains("holds 8 frames") && notes.contains("names 3") && notes.contains("correct"),
        "{notes}"
    );
    let (clip, notes) = read(&bvh("Frames: 0\nFrame Time: 0.02\n", 8)).unwrap();
    assert_eq!(clip.frame_count(), 8);
    assert!(notes.contains("names 0 frames; 8 were counted"), "{notes}");
    let (clip, notes) = read(&(bvh("Frames: 2\nFrame Time: 0.02\n", 2) + "1 2 3\n")).unwrap();
    assert_eq!(clip.frame_count(), 2);
    assert!(notes.contains("3 words follow the last frame and are not used"), "{notes}");
    let error = read(&bvh("Frames: 0\nFrame Time: 0.02\n", 0)).unwrap_err();
    assert!(error.contains("line 17") && error.contains("no frames"), "{error}");
    // A wrong word is an error, not the end of the file.
    for named in [0, 9] {
        let broken =
            bvh(&format!("Frames: {named}\nFrame Time: 0.02\n"), 9).replace("0 0 0 0 5 0", "0 0 0 0 nan 0");
        let error = read(&broken).unwrap_err();
        assert!(error.contains("line 24: expected a number of frame 5, found `nan`"), "{error}");
    }
}

#[test]
fn files_that_are_cut_short_are_read_to_the_last_whole_frame() {
    for named in [9, 1000, usize::MAX] {
        let header = format!("Frames: {named}\nFrame Time: 0.02\n");
        let (clip, notes) = read(&bvh(&header, 8)).unwrap();
        assert_eq!(clip.frame_count(), 8);
        assert!(
            notes.contains(&format!("names {named} frames, but the file holds 8; these are used")),
            "{notes}"
        );
        assert!(notes.contains("export the motion again"), "{notes}");
        let (clip, notes) = read(&(bvh(&header, 8) + "1 2 3 4")).unwrap();
        assert_eq!(clip.frame_count(), 8);
        assert!(notes.contains("holds 8 and 4 numbers of another one, which are not used"), "{notes}");
    }
    let error = read(&(bvh("Frames: 2\nFrame Time: 0.02\n", 0) + "1 2 3 4")).unwrap_err();
    assert!(error.contains("line 17: the file holds no frames"), "{error}");
}

#[test]
fn a_frame_with_another_number_of_values_than_channels_is_refused() {
    let header = |frames: usize| format!("Frames: {frames}\nFrame Time: 0.02\n");
    let whole = bvh(&header(4), 4);
    for (text, line, count) in [
        (whole.replace("0 0 0 0 2 0", "0 0 0 0 2 0 7"), 21, 7),
        (whole.replace("0 0 0 0 0 0", "0 0 0 0 0"), 19, 5),
        // Every line has too few or too many numbers, also where the header names another number of frames.
        (bvh(&header(4), 0) + &"1 2 3 4 5 6 7\n".repeat(4), 19, 7),
        (bvh(&header(9), 0) + &"1 2 3 4 5\n".repeat(4), 19, 5),
        // The words add up to whole frames.
        (whole.replace("0 0 0 0 1 0", "0 0 0 0 1").replace("0 0 0 0 2 0", "0 0 0 0 2 0 7"), 20, 5),
        (bvh(&header(1), 0) + "1 2 3 4 5\n", 19, 5),
    ] {
        let error = read(&text).unwrap_err();
        let expected =
            format!("line {line}: a frame has {count} numbers here, and the skeleton has 6 channels");
        assert!(error.contains(&expected), "{error}");
    }
    // Frames that are wrapped over several lines, and two frames on a line.
    let (want, _) = read(&whole).unwrap();
    for (from, to) in [("0 0 0 0", "0 0 0\n0"), ("0 0 0 0", "0\n0 0 0"), ("0 0\n0 0 0 0 1", "0 0 0 0 0 0 1")]
    {
        let (clip, notes) = read(&whole.replace(from, to)).unwrap();
        assert_eq!(clip.samples, want.samples, "{to:?}");
        assert!(!notes.contains("frames"), "{notes}");
    }
}

#[test]
fn unusual_frame_times_are_reported_and_replaced_by_the_rate_of_the_scene() {
    for (time, likely) in
        [("30", 30.0), ("33.333", 30.0), ("16.6667", 60.0), ("41.667", 24.0), ("0.0001", 30.0)]
    {
        let (_, notes) = read(&bvh(&format!("Frames: 3\nFrame Time: {time}\n"), 3)).unwrap();
        assert!(
            notes.contains("unusual") && notes.contains(&format!("`rate = {likely:?}`")),
            "{time}: {notes}"
        );
    }
    for time in ["0.008333", "0.0333", "0.04", "0.1"] {
        let (_, notes) = read(&bvh(&format!("Frames: 3\nFrame Time: {time}\n"), 3)).unwrap();
        assert!(!notes.contains("unusual"), "{time}: {notes}");
    }
    let error = read(&bvh("Frames: 3\nFrame Time: 0\n", 3)).unwrap_err();
    assert!(error.contains("line 18") && error.contains("`rate`"), "{error}");
    // In a scene.
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("head.obj", "v 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nf 1 2 3\nf 1 3 4\n");
    let scene = |rate: &str| {
        let text = format!(
            "[body]\nfile = \"head.obj\"\n[[groom]]\ngrow.strands = 3\n[clip]\nfile = \"a.bvh\"\njoint = \"Head\"\npivot = [0, 0, 0]\n{rate}\n"
        );
        write("scene.toml", &text);
        read_scene(&folder.path().join("scene.toml"))
    };
    for time in ["0", "-1", "30", "0.02"] {
        write("a.bvh", &bvh(&format!("Frames: 3\nFrame Time: {time}\n"), 3));
        let loaded = scene("rate = 24").unwrap();
        assert_eq!(loaded.value.clip.unwrap().rate, 24.0, "{time}");
        assert!(!loaded.notes.iter().any(|n| n.contains("unusual")), "{:?}", loaded.notes);
    }
    let error = scene("rate = 0").unwrap_err().to_string();
    assert!(error.contains("line 9") && error.contains("`rate` must be 0.01"), "{error}");
}

#[test]
fn notes_describe_how_a_clip_moves_a_bust() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    // A skinned triangle at the neck; the person has no joint below it in common.
    write("bust.tfxmesh", &crate::samples::skinned_mesh().replace("0 hip\n", "0 mixamorig_Hips\n"));
    write("person.bvh", &bvh("Frames: 3\nFrame Time: 0.02\n", 3).replace("OFFSET 0 1 0", "OFFSET 0 0 0"));
    write(
        "scene.toml",
        "[body]\nfile = \"bust.tfxmesh\"\nscale = 1\n[[groom]]\ngrow.strands = 3\n[clip]\nfile = \"person.bvh\"\n",
    );
    let loaded = read_scene(&folder.path().join("scene.toml")).unwrap();
    let notes = loaded.notes.join("\n");
    assert!(notes.contains("moves 1 of the body's 2 joints"), "{notes}");
    assert!(notes.contains("starts at its own place") && notes.contains("1.00 times"), "{notes}");
}
