//! Promise: a glTF motion has its keys at their times: all of them at the usual frame rates, and the last at any. A joint
//! that is scaled to 0 keeps the scale before it.

use crate::gltf_file::GltfFile;
use hairspring_io::gltf;
use serde_json::json;

/// A tetrahedron with an animation of its node `Head`: two linear keys, the second after `duration` [s].
fn moving(path: &str, duration: f32, values: [[f32; 3]; 2]) -> GltfFile {
    let mut file = GltfFile::tetrahedron();
    let input = file.floats("SCALAR", &[0.0, duration]);
    let output = file.floats("VEC3", &values.concat());
    let animation = json!({
        "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}],
        "samplers": [{"input": input, "output": output}],
    });
    file.push("animations", animation);
    file
}

#[test]
fn the_last_frame_of_a_motion_is_its_last_key() {
    for frames in [1, 13, 14, 24, 119] {
        let duration = frames as f32 / 24.0;
        let file = moving("translation", duration, [[0.0; 3], [1.0, 0.0, 0.0]]);
        let (character, _) = gltf::parse(&file.glb(), &|_| None).unwrap();
        let clip = &character.clips[0];
        let last = clip.samples.last().unwrap().translation.x;
        assert!((last - 1.0).abs() < 1e-5, "{frames} frames end at {last}");
        assert!(
            (clip.duration() - f64::from(duration)).abs() < 1e-5,
            "{} s for {duration} s",
            clip.duration()
        );
        assert!(clip.rate >= 60.0, "{} Hz", clip.rate);
    }
}

#[test]
fn keys_at_the_frame_rates_of_programs_are_exact() {
    for fps in [15.0, 23.976_023_976, 24.0, 25.0, 29.970_029_97, 30.0, 48.0, 50.0, 60.0, 100.0, 120.0f64] {
        for interpolation in ["STEP", "LINEAR"] {
            // Programs begin at frame 1, and round the times.
            let times: Vec<f32> = (1..=9).map(|k| (f64::from(k) / fps) as f32 + 3e-6).collect();
            let x = |k: usize| if k.is_multiple_of(2) { 0.1 * k as f32 } else { -0.1 };
            let values: Vec<f32> = (1..=9).flat_map(|k| [x(k), 0.0, 0.0]).collect();
            let mut file = GltfFile::tetrahedron();
            let (input, output) = (file.floats("SCALAR", &times), file.floats("VEC3", &values));
            let animation = json!({
                "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                "samplers": [{"input": input, "output": output, "interpolation": interpolation}],
            });
            file.push("animations", animation);
            let (character, _) = gltf::parse(&file.glb(), &|_| None).unwrap();
            let clip = &character.clips[0];
            for k in 1..=9 {
                let at = clip.sample(k as f64 / fps)[0].translation.x;
                assert!(
                    (at - x(k)).abs() < 1e-4,
                    "{interpolation} at {fps} fps, key {k}: {at}, not {}",
                    x(k)
                );
            }
            assert_eq!(clip.samples.last().unwrap().translation.x, x(9), "{interpolation} at {fps} fps");
            assert!((59.9..=120.1).contains(&clip.rate), "{fps} fps are sampled at {} Hz", clip.rate);
        }
    }
}

#[test]
fn a_motion_stands_still_until_its_first_key() {
    let mut file = moving("translation", 2.0, [[0.0; 3], [1.0, 0.0, 0.0]]);
    let times = file.floats("SCALAR", &[1.0, 2.0]);
    file.json["animations"][0]["samplers"][0]["input"] = json!(times);
    let (character, notes) = gltf::parse(&file.glb(), &|_| None).unwrap();
    let clip = &character.clips[0];
    assert!((clip.duration() - 2.0).abs() < 1e-9);
    for (time, x) in [(0.0, 0.0), (1.0, 0.0), (1.5, 0.5), (2.0, 1.0)] {
        assert!((clip.sample(time)[0].translation.x - x).abs() < 1e-5, "at {time} s");
    }
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].contains("first key at 1.00 s") && notes[0].contains("`start = 60`"), "{notes:?}");
    // Hours before the first key, as in a recording with a time code, are left out.
    let times = file.floats("SCALAR", &[36_000.0, 36_001.0]);
    file.json["animations"][0]["samplers"][0]["input"] = json!(times);
    let (character, notes) = gltf::parse(&file.glb(), &|_| None).unwrap();
    assert!((character.clips[0].duration() - 1.0).abs() < 1e-2);
    assert!(notes[0].contains("begins there"), "{notes:?}");
}

#[test]
fn a_joint_that_is_scaled_to_nothing_keeps_its_scale() {
    let file = moving("scale", 1.0, [[1.0; 3], [-1.0; 3]]);
    let (character, notes) = gltf::parse(&file.glb(), &|_| None).unwrap();
    let smallest = character.clips[0].samples.iter().map(|s| s.scale.abs().min_element()).fold(1.0, f32::min);
    assert!(smallest > 1e-3, "{smallest}");
    let notes = notes.join("\n");
    assert!(notes.contains("scales the joint \"Head\" to 0 at 0.50 s"), "{notes}");
}

/// A tetrahedron with rotations of its node `Head` at 0, 1, 2, … s.
fn turning(interpolation: &str, keys: u8, values: &[[f32; 4]]) -> GltfFile {
    let mut file = GltfFile::tetrahedron();
    let times: Vec<f32> = (0..keys).map(f32::from).collect();
    let (input, output) = (file.floats("SCALAR", &times), file.floats("VEC4", values.as_flattened()));
    let animation = json!({
        "name": "turn",
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
        "samplers": [{"input": input, "output": output, "interpolation": interpolation}],
    });
    file.push("animations", animation);
    file
}

#[test]
fn rotations_of_zero_length_are_the_key_before_and_noted() {
    let (half, none) =
        ([0.0, std::f32::consts::FRAC_1_SQRT_2, 0.0, std::f32::consts::FRAC_1_SQRT_2], [0.0; 4]);
    let one = [0.0, 0.0, 0.0, 1.0];
    for (interpolation, values) in [
        ("LINEAR", vec![half, none, one]),
        ("STEP", vec![half, none, one]),
        ("CUBICSPLINE", vec![none, half, none, none, none, none, none, one, none]),
    ] {
        let (character, notes) = gltf::parse(&turning(interpolation, 3, &values).glb(), &|_| None).unwrap();
        assert_eq!(notes.len(), 1, "{interpolation}: {notes:?}");
        assert!(notes[0].starts_with("1 keys of rotations are 0, 0, 0, 0"), "{notes:?}");
        let clip = &character.clips[0];
        for time in [0.5, 1.0] {
            let rotation = clip.sample(time)[0].rotation;
            assert!(rotation.abs_diff_eq(glam::Quat::from_array(half), 1e-5), "{interpolation}: {rotation}");
        }
    }
}

#[test]
fn a_wrong_number_of_values_names_the_animation_and_the_right_one() {
    let one = [0.0, 0.0, 0.0, 1.0];
    for (interpolation, wanted) in [
        ("LINEAR", "animation \"turn\" has 2 keys but 4 values: expected 1 per key"),
        ("CUBICSPLINE", "animation \"turn\" has 2 keys but 4 values of a CUBICSPLINE: expected 3 per key"),
    ] {
        let text = gltf::parse(&turning(interpolation, 2, &[one; 4]).glb(), &|_| None).unwrap_err().text;
        assert!(text.starts_with(wanted), "{text}");
    }
}

/// A tetrahedron with a motion "slide" of its node `Head` along X.
fn sliding(times: &[f32], x: &[f32], interpolation: &str) -> GltfFile {
    let mut file = GltfFile::tetrahedron();
    let values: Vec<f32> = x.iter().flat_map(|x| [*x, 0.0, 0.0]).collect();
    let (input, output) = (file.floats("SCALAR", times), file.floats("VEC3", &values));
    let animation = json!({
        "name": "slide",
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
        "samplers": [{"input": input, "output": output, "interpolation": interpolation}],
    });
    file.push("animations", animation);
    file
}

#[test]
fn keys_that_are_rounded_to_milliseconds_are_exact() {
    for fps in [12.0, 15.0, 24.0, 25.0, 30.0, 48.0, 60.0f64] {
        for (interpolation, first) in [("STEP", 0), ("LINEAR", 0), ("LINEAR", 1)] {
            let keys: Vec<i32> = (first..first + 25).collect();
            let times: Vec<f32> =
                keys.iter().map(|k| ((1e3 * f64::from(*k) / fps).round() / 1e3) as f32).collect();
            let x: Vec<f32> = keys.iter().map(|k| if k % 2 == 0 { 0.1 * *k as f32 } else { -0.1 }).collect();
            let (character, notes) =
                gltf::parse(&sliding(&times, &x, interpolation).glb(), &|_| None).unwrap();
            assert!(notes.is_empty(), "{notes:?}");
            let clip = &character.clips[0];
            for (k, x) in keys.iter().zip(&x) {
                let at = clip.sample(f64::from(*k) / fps)[0].translation.x;
                assert!((at - x).abs() < 1e-4, "{interpolation} at {fps} fps, key {k}: {at}, not {x}");
            }
            assert!(clip.rate <= 120.0, "{fps} fps are sampled at {} Hz", clip.rate);
        }
    }
}

#[test]
fn keys_at_one_time_and_before_0_s_are_noted() {
    let (x, read) = ([0.0, 1.0, 2.0], |file: &GltfFile| gltf::parse(&file.glb(), &|_| None).unwrap());
    let (character, notes) = read(&sliding(&[0.0, 1.0, 1.0], &x, "LINEAR"));
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].starts_with("1 keys of animations are at the time of the key before"), "{notes:?}");
    assert_eq!(character.clips[0].samples.last().unwrap().translation.x, 2.0);
    let (character, notes) = read(&sliding(&[-0.5, 0.0, 1.0], &x, "LINEAR"));
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].contains("first key at -0.50 s and begins there"), "{notes:?}");
    assert!((character.clips[0].duration() - 1.5).abs() < 1e-6);
}

#[test]
fn a_joint_that_is_mirrored_is_noted() {
    let notes_of = |file: GltfFile| {
        let (_, notes) = gltf::parse(&file.glb(), &|_| None).unwrap();
        notes.iter().filter(|note| note.contains("mirrors the joint \"Head\" at 0.")).count()
    };
    let mirrored = |values| notes_of(moving("scale", 1.0, values));
    assert_eq!(mirrored([[1.0; 3], [-1.0; 3]]), 1);
    assert_eq!(mirrored([[1.0; 3], [1.0, -1.0, -1.0]]), 0, "it is turned");
    // From the first key on, but not at rest.
    assert_eq!(mirrored([[-1.0, 1.0, 1.0]; 2]), 1);
    let mut at_rest = moving("scale", 1.0, [[-1.0, 1.0, 1.0]; 2]);
    at_rest.json["nodes"][0]["scale"] = json!([-1.0, 1.0, 1.0]);
    assert_eq!(notes_of(at_rest), 0);
}
